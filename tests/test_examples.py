"""Everything in `examples` works as its page says."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from parley.cli import command_line
from parley.config import SystemConfig

EXAMPLES = Path(__file__).parent.parent / "examples"
PAGE = (EXAMPLES / "README.md").read_text(encoding="utf-8")
GRAPHS = sorted((EXAMPLES / "graphs").glob("*.graph.json"))


def invoke(*words: str) -> str:
    result = CliRunner().invoke(command_line(words[0]), list(words))
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.mark.parametrize("file", GRAPHS, ids=lambda file: str(file.name))
def test_a_graph_is_accepted_runs_to_its_end_and_can_be_drawn(file: Path) -> None:
    invoke("graph", "check", str(file))
    name = json.loads(file.read_text(encoding="utf-8"))["graph_name"]
    assert f"{name}: FINISHED" in invoke("graph", "run", str(file))
    assert invoke("graph", "show", "--format", "mermaid", str(file)).startswith("flowchart")


def test_the_fallback_goes_where_it_falls_back_to() -> None:
    told = invoke("graph", "run", str(EXAMPLES / "graphs" / "either.graph.json"))
    assert "GetCoordinates_0: ERROR" in told
    assert "GetCoordinates_1: FINISHED" in told


def test_the_situations_are_answered_in_their_order(tmp_path: Path) -> None:
    out = tmp_path / "answers.jsonl"
    invoke("interpret", "--situations", str(EXAMPLES / "situations.jsonl"), "--out", str(out))
    answers = {line["id"]: line["output"] for line in map(json.loads, out.read_text("utf-8").splitlines())}
    assert list(answers) == ["go", "ask", "note"]
    assert [next(iter(step)) for step in answers["go"]["queue"]][-1] == "Inspect"
    assert answers["ask"]["queue"] == []
    assert [next(iter(command)) for command in answers["note"]["system_cmd"]] == ["add_memory"]


def test_settings_are_accepted_and_a_demonstration_runs_with_them(tmp_path: Path) -> None:
    file = EXAMPLES / "parley.yaml"
    config = SystemConfig.load(file)
    assert config.model.prices and config.display_feeds and config.approval_of
    told = [json.loads(line) for line in invoke("doctor", "--json", "--config", str(file)).splitlines()]
    assert told[0] == {
        "subject": "settings", "state": "ok", "text": str(file), "remedy": "", "needed": True,
    }  # fmt: skip
    invoke("demo", "nursing-home", "--script", "--json", "--config", str(file), "--data", str(tmp_path))


def test_settings_that_are_only_shown_are_settings_too() -> None:
    """What stands behind a comment sign may be taken over as it is."""
    lines = (EXAMPLES / "parley.yaml").read_text(encoding="utf-8").splitlines()
    shown = [re.sub(r"^( *)# (?=[a-z_ ]+:)", r"\1", line) for line in lines[4:]]
    provider, own, *_ = [line for line in shown if re.match("language: [a-z]+:", line)]
    for other in (provider, own):
        text = "\n".join(line for line in shown if not line.startswith("language:") or line == other)
        config = SystemConfig.parse(text)
        assert config.embeddings is not None and config.model.key_file is not None


def test_the_page_names_every_example_and_no_other() -> None:
    named = {shlex.split(command)[-1] for command in re.findall(r"`parley (?:graph|demo)[^`]*`", PAGE)}
    named = {word.strip("`") for word in named} | {"examples/situations.jsonl"}
    files = {f"examples/graphs/{file.name}" for file in GRAPHS} | {
        "examples/actions",
        "examples/parley.yaml",
        "examples/situations.jsonl",
    }
    assert named == files
