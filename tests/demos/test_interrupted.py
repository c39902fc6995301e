"""A system that was killed says what it was doing, and goes on with it when it is told to."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from tests.demos.house import House, running

STORY = """
robot: David
steps:
  - {say: "go to the dining table, then go to the TV"}
  - {finished: {}}
"""


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The data of a system that was killed during its first drive."""
    folder = tmp_path_factory.mktemp("killed")
    story = folder / "story.yaml"
    story.write_text(STORY, encoding="utf-8")
    command = [
        sys.executable, "-m", "parley", "demo", "nursing-home", "--script", str(story), "--json",
        "--speed", "2", "--data", str(folder / "data"),
    ]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            event = json.loads(line)
            if event["event"] == "progress" and event["node"].startswith("NavigateTo"):
                break
        process.send_signal(signal.SIGKILL)
    return folder / "data"


async def notice(home: House) -> str:
    await home.observer.until(lambda: any("interrupted" in said.message for said in home.observer.said))
    return next(said.message for said in home.observer.said if "interrupted" in said.message)


async def test_it_says_so_and_carries_on_when_told(killed: Path) -> None:
    demo = load_demo("nursing-home")
    async with running(demo.system(SystemConfig(speed=None, data_dir=killed))) as home:
        text = await notice(home)
        assert "dining table" in text
        assert "carry on" in text
        assert home.actions() == []
        await home.say("carry on")
        assert await home.done() == ["finished"] * 3
        assert home.actions() == ["NavigateTo", "GetCoordinates", "NavigateTo"]
    async with running(demo.system(SystemConfig(speed=None, data_dir=killed))) as home:
        reply = await home.say("carry on")
        assert "nothing" in reply.message.lower()
        assert not any("interrupted" in said.message for said in home.observer.said)
