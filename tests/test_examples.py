"""Everything in `examples` works as its page says."""

from __future__ import annotations

import importlib
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from fastapi.testclient import TestClient
from typer.testing import CliRunner

from parley.cli import command_line
from parley.config import SystemConfig
from parley.robots.nav2_simulated import LOCK_S
from parley.robots.ros_robot import HOLD_S
from parley.robots.ros_senses import RosTopics

EXAMPLES = Path(__file__).parent.parent / "examples"
PAGE = (EXAMPLES / "README.md").read_text(encoding="utf-8")
GRAPHS = sorted((EXAMPLES / "graphs").glob("*.graph.json"))


def invoke(*words: str) -> str:
    result = CliRunner().invoke(command_line(), list(words))
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.mark.parametrize("file", GRAPHS, ids=lambda file: str(file.name))
def test_a_graph_is_accepted_runs_to_its_end_and_can_be_drawn(file: Path) -> None:
    invoke("graph", "check", str(file))
    name = json.loads(file.read_text(encoding="utf-8"))["graph_name"]
    assert f"{name}: FINISHED" in invoke("graph", "run", str(file))
    assert invoke("graph", "show", "--format", "mermaid", str(file)).startswith("flowchart")


def test_twist_mux_locks_what_parley_and_nav2_say_by_what_parley_says() -> None:
    text = (EXAMPLES / "twist_mux.yaml").read_text(encoding="utf-8")
    told = yaml.safe_load(text)["twist_mux"]["ros__parameters"]
    names, velocities, locks = RosTopics(emergency="e_stop"), told["topics"], told["locks"]
    assert velocities["parley"]["topic"] == names.cmd_vel
    assert (locks["parley"]["topic"], locks["e_stop"]["topic"]) == (names.hold, names.emergency)
    assert 2 * HOLD_S < locks["parley"]["timeout"] <= LOCK_S
    driven = [velocities[who]["priority"] for who in ("nav2", "parley")]
    assert driven[0] < driven[1] < locks["parley"]["priority"] < velocities["joystick"]["priority"]
    assert velocities["joystick"]["priority"] < locks["e_stop"]["priority"]


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


def run(name: str) -> list[str]:
    """What a script of the examples prints; it must come to its end."""
    done = subprocess.run(
        [sys.executable, name], cwd=EXAMPLES, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.splitlines()


def test_a_script_drives_a_robot_of_ones_own() -> None:
    said, steps = run("script.py")
    assert "red box" in said
    assert steps.count("finished") == 2


def test_a_robot_without_a_map_is_turned_from_python() -> None:
    said, steps = run("without_a_map.py")
    assert "turn left by 90 degrees" in said
    assert steps.count("finished") == 1


def test_a_notebook_remembers_asks_and_waits_for_a_yes() -> None:
    remembered, answer, asks, _, states = run("notebook.py")
    assert "bookshelf" in remembered
    assert "bookshelf" in answer
    assert asks.endswith("Shall I?")
    assert states == "['finished', 'finished']"


def test_a_web_app_of_ones_own_lets_a_person_order_and_a_program_propose(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLES))
    with TestClient(importlib.import_module("web_app").app) as client:
        (robot,) = client.get("/robots").json()
        said = f"/robots/{robot}/say?text=go to the bookshelf"
        assert client.post(said).json()["state"] == "awaiting_approval"
        assert client.post("/robots/Nobody/say?text=hello").status_code == 404
        assert client.post("/stop").json() == {"stopped": True}
    with TestClient(importlib.import_module("web_app").app) as client:
        assert client.post(said, headers={"authorization": "secret of Ada"}).json()["state"] == "running"


def test_the_page_names_every_example_and_no_other() -> None:
    named = set(re.findall(r"^\| `([^`]+)`", PAGE, re.MULTILINE))
    files = {path.relative_to(EXAMPLES).as_posix() for path in EXAMPLES.rglob("*.*") if path.suffix != ".pyc"}
    assert named == files - {"README.md"}
