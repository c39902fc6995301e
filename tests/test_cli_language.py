"""The commands that choose a language engine, and the one that shows what a model is told."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog

from parley.cli import command_line, run
from parley.language.llm.scripted_server import Say, ScriptedServer
from parley.language.prompts import KINDS
from tests.language.llm.rig import LOOK_PLAN

SITUATION = {
    "id": "one",
    "message": "look at the zebra crate",
    "robot": "Ada",
    "catalogue": [{"name": "Look", "inputs": {"what": "string"}}],
}


async def parley(*arguments: str) -> tuple[int, str, str]:
    """Run a command to its end."""
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        "parley",
        *arguments,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
    )
    async with asyncio.timeout(60):
        out, err = await process.communicate()
    return process.returncode or 0, out.decode(), err.decode()


@pytest.fixture(autouse=True)
def logs_as_before() -> Iterator[None]:
    """Commands choose where logs go; in one process that would outlast the test."""
    yield
    structlog.reset_defaults()


@pytest.fixture
def situations(tmp_path: Path) -> Path:
    file = tmp_path / "situations.jsonl"
    file.write_text(json.dumps(SITUATION) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("in_a_file", [False, True])
async def test_situations_are_answered_by_the_model_that_is_named(situations: Path, in_a_file: bool) -> None:
    async with ScriptedServer() as server:
        server.will(Say(answer=LOOK_PLAN))
        name = f"local:m@{server.url}"
        settings = situations.with_name("parley.yaml")
        settings.write_text(f"language: {name}\nmodel: {{temperature: 0.7}}\n", encoding="utf-8")
        chosen = ["--config", str(settings)] if in_a_file else ["--language", name]
        code, out, err = await parley("interpret", "--situations", str(situations), *chosen)
        assert server.requests[0].body["temperature"] == (0.7 if in_a_file else 0.1)
    assert code == 0, err
    line = json.loads(out)
    assert line["id"] == "one"
    assert list(line["output"]["queue"][0]) == ["Look"]


async def test_model_without_an_answer_gives_a_line_with_the_error(situations: Path) -> None:
    async with ScriptedServer() as server:
        server.will(Say(body="{}", status=401))
        name = f"local:m@{server.url}"
        code, out, _ = await parley("interpret", "--situations", str(situations), "--language", name)
    assert code == 0
    assert "401" in json.loads(out)["error"]


async def test_prompt_shows_exactly_what_the_model_gets(situations: Path) -> None:
    async with ScriptedServer() as server:
        server.will(Say(answer=LOOK_PLAN))
        name = f"local:m@{server.url}"
        await parley("interpret", "--situations", str(situations), "--language", name)
        told = server.requests[0].texts
        schema = server.requests[0].body["tools"][0]["function"]["parameters"]
    code, out, err = await parley("prompt", "show", "--situation", str(situations), "--json")
    assert code == 0, err
    shown = json.loads(out)
    assert told == [shown["instructions"], shown["content"]]
    assert schema["properties"].keys() == shown["answer"]["properties"].keys()
    assert schema["required"] == shown["answer"]["required"]


@pytest.mark.parametrize("kind", KINDS)
def test_every_question_can_be_shown(
    kind: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["parley", "prompt", "show", "--kind", kind])
    assert run(command_line()) == 0
    out = capsys.readouterr().out
    assert f"({kind}-" in out
    assert "--- form of the answer" in out


@pytest.mark.parametrize(
    "arguments",
    [
        ["prompt", "show", "--kind", "guess"],
        ["interpret", "--situations", "-", "--language", "gpt"],
        ["interpret", "--situations", "-", "--language", "nobody:m"],
        ["interpret", "--situations", "-", "--language", "local:m"],
        ["demo", "nursing-home", "--script", "--language", "gpt"],
    ],
    ids=" ".join,
)
def test_what_does_not_exist_is_refused_in_one_line(
    arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["parley", *arguments])
    assert run(command_line()) == 2
    err = capsys.readouterr().err
    assert err.startswith("parley: ")
    assert len(err.splitlines()) == 1


GOOD = "{say: evening round, means: turn left by ninety degrees}"


@pytest.mark.parametrize(
    ("entry", "why"),
    [
        ("{say: stop, means: take a picture}", "teach[1]: “stop” keeps its meaning"),
        ("{say: hoop}", "teach[1]: say what it means by either means or action"),
        ("{say: hoop, meens: take a picture}", "teach[1].meens: there is no such setting"),
        ("{say: hoop, means: the moon}", "teach[1]: “the moon” is neither something on my map nor an order"),
        ("{say: hoop, action: Fly}", "teach[1]: I have no action Fly"),
        ("{say: hoop, action: Wait, arguments: {duration: long}}", "duration of Wait cannot be long"),
        ("{say: hoop, action: Wait}", "teach[1]: Wait needs duration"),
        ("{say: Evening round!, action: TakePicture}", "stands there twice"),
    ],
)
def test_file_with_one_bad_sentence_teaches_nothing_and_says_which_and_why(
    entry: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file, data = tmp_path / "words.yaml", tmp_path / "data"
    data.mkdir()
    file.write_text(f"teach: [{GOOD}, {entry}]", encoding="utf-8")
    monkeypatch.setattr(sys, "argv", ["parley", "language", "teach", str(file), "--data", str(data)])
    assert run(command_line()) == 2
    assert why in capsys.readouterr().err
    monkeypatch.setattr(sys, "argv", ["parley", "language", "teach", "--list", "--data", str(data)])
    assert run(command_line()) == 0
    assert capsys.readouterr().out == ""
