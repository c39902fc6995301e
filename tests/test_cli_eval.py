"""`parley eval` as people run it."""

from __future__ import annotations

import json
from pathlib import Path

from parley.language.llm.scripted_server import Say, ScriptedServer
from tests.evaluation.rig import WORLD
from tests.test_cli_language import parley

CASES = """
  going:
    - {in: depot, say: go to the red box, do: [go box_1]}
    - {in: depot, say: go to the secret gate, do: [go door_1]}
"""


def written(folder: Path, *, blind: bool) -> str:
    file = folder / "mine.yaml"
    text = f"blind: {str(blind).lower()}\n{WORLD}\ncases:{CASES}"
    file.write_text(text, encoding="utf-8")
    return str(file)


async def test_engines_are_measured_side_by_side_with_what_they_take(tmp_path: Path) -> None:
    plan = {"queue": [{"action": "GetCoordinates", "parameters": {"target": "red box"}}]}
    async with ScriptedServer() as server:
        server.always(Say(answer={"message_response": "I go.", **plan}))
        model = f"local:m@{server.url}"
        code, out, err = await parley(
            "eval", "--set", written(tmp_path, blind=False), "--language", "builtin", "--language", model,
            "--language", f"auto:{model}",
            "--out", str(tmp_path / "report"), "--json",
        )  # fmt: skip
    assert (code, err) == (0, "")
    report = json.loads(out)
    builtin, asked, both = report["backends"]
    assert {name: part["answered"]["count"] for name, part in both["engines"].items()} == dict.fromkeys(
        both["engines"], 2
    )
    assert sum(part["answered"]["right"] for part in both["engines"].values()) == 2
    assert (builtin["engines"], asked["wrong_deeds"]["right"]) == ({}, 2)
    assert (builtin["language"], builtin["usage"]) == ("builtin", None)
    assert (builtin["accuracy"]["right"], builtin["accuracy"]["count"]) == (1, 2)
    assert [item["case"] for item in builtin["failing"]] == ["going: go to the secret gate"]
    assert asked["accuracy"]["right"] == 0
    assert asked["usage"]["asked"] == 2
    assert asked["usage"]["input_tokens"] > 0
    assert json.loads((tmp_path / "report" / "report.json").read_text(encoding="utf-8")) == report
    assert "`builtin`" in (tmp_path / "report" / "report.md").read_text(encoding="utf-8")


async def test_a_blind_set_gives_its_score_and_its_failures_only_when_told_to(tmp_path: Path) -> None:
    file = written(tmp_path, blind=True)
    code, out, _ = await parley("eval", "--set", file)
    assert code == 0
    assert "50.0 %" in out
    assert "secret" not in out
    _, out, _ = await parley("eval", "--set", file, "--reveal")
    assert "secret" in out


async def test_a_set_or_an_engine_that_there_is_not_is_said() -> None:
    code, _, err = await parley("eval", "--set", "nothing")
    assert code == 2
    assert "there is no set 'nothing'" in err
    code, _, err = await parley("eval", "--language", "wizard")
    assert code == 2
    assert "wizard" in err
