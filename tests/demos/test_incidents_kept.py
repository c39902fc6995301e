"""Records of failures over the lives of real processes, as the command line shows them."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from tests.demos.house import running
from tests.test_cli import parley

STORY = """
robot: David
faults: {NavigateTo: [{code: blocked, message: Somebody stands in the way.}]}
steps:
  - {say: go to the bookshelf}
  - {asked: [in the way], answer: try again}
  - {finished: {near: bookshelf_1}}
  - {incident: solved}
"""
QUIET = """
robot: David
steps:
  - {say: hello}
"""
WAITING = STORY.replace("answer: try again", 'answer: "why?"').replace(
    "{finished: {near: bookshelf_1}}", "{state: idle}"
)


def play(folder: Path, story: str) -> None:
    (folder / "story.yaml").write_text(story, encoding="utf-8")
    done = parley("demo", "nursing-home", "--script", str(folder / "story.yaml"), "--data", str(folder))
    assert done.returncode == 0, done.stderr


def incidents(folder: Path, *arguments: str) -> list[dict[str, Any]]:
    done = parley("incidents", "--data", str(folder), "--json", *arguments)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_record_is_there_after_the_system_has_ended(tmp_path: Path) -> None:
    play(tmp_path, STORY)
    play(tmp_path, QUIET)
    (incident,) = incidents(tmp_path, "--robot", "david")
    assert (incident["robot"], incident["code"], incident["ending"]) == ("David", "blocked", "solved")
    assert incident["attempts"][0]["answered"] == "try again"
    assert incidents(tmp_path, "--robot", "Ruth") == []
    told = parley("incidents", "--data", str(tmp_path))
    assert "David: Somebody stands in the way." in told.stdout
    assert "you said: try again" in told.stdout


def test_folder_without_records_is_named(tmp_path: Path) -> None:
    done = parley("incidents", "--data", str(tmp_path))
    assert (done.returncode, str(tmp_path) in done.stderr) == (2, True)


@pytest.mark.timeout(200)
def test_record_that_kill_9_left_open_is_closed_by_the_next_start(tmp_path: Path) -> None:
    (tmp_path / "story.yaml").write_text(WAITING, encoding="utf-8")
    command = [
        sys.executable, "-m", "parley", "demo", "nursing-home", "--script", str(tmp_path / "story.yaml"),
        "--json", "--data", str(tmp_path),
    ]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    asked = 0
    for line in process.stdout:
        event = json.loads(line)
        asked += event["event"] == "said" and event["type"] == "request"
        if asked == 2:  # what was written down for the first question is durable by now or never
            break
    while not incidents(tmp_path):
        assert process.poll() is None
    process.send_signal(signal.SIGKILL)
    process.stdout.close()
    process.wait(timeout=30)
    assert incidents(tmp_path)[0]["ending"] == "open"
    play(tmp_path, QUIET)
    (incident,) = incidents(tmp_path)
    assert (incident["ending"], "ended before" in incident["note"]) == ("cancelled", True)


async def test_operator_is_told_after_a_restart_in_the_middle_of_a_repair(tmp_path: Path) -> None:
    demo, config = load_demo("nursing-home"), SystemConfig(speed=None, data_dir=tmp_path)
    async with running(demo.system(config)) as house:
        await house.say("John is on the sofa")
        await house.say("go to John")
        assert "sofa" in (await house.question()).message
    async with running(demo.system(config)) as house:
        await house.observer.until(
            lambda: any("I was interrupted" in said.message for said in house.observer.said), timeout_s=10
        )
        assert house.observer.questions.newest(house.robot) is None
        await house.say("carry on")
        assert "sofa" in (await house.question()).message
        house.observer.say("the small one", house.robot, answer=True)
        assert set(await house.done()) == {"finished"}
