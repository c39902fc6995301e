"""A plan that waits for a yes when the process is killed waits again afterwards, on the page too."""

from __future__ import annotations

import json
import shutil
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.messages import topics
from parley.messages.chat import ActionCall
from parley.messages.principal import person
from parley.messages.pvf import Parameter
from parley.messages.ros import String
from parley.messages.status import PlanDecision, PlanProposal
from parley.messages.wire import decode_plan
from tests.demos.house import House, running

STORY = """
robot: David
steps:
  - {say: go to the dining table}
  - {finished: {}}
"""


def kept(data: Path) -> int:
    with closing(sqlite3.connect(f"file:{data / 'proposals.db'}?mode=ro", uri=True)) as file:
        found: int = file.execute("SELECT count(*) FROM proposal").fetchone()[0]
        return found


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The data of a system that was killed while a plan waited for a yes."""
    folder = tmp_path_factory.mktemp("killed")
    story = folder / "story.yaml"
    story.write_text(STORY, encoding="utf-8")
    command = [
        sys.executable, "-m", "parley", "demo", "nursing-home", "--script", str(story), "--json",
        "--ask-first", "--data", str(folder / "data"),
    ]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            event = json.loads(line)
            if event["event"] == "said":
                assert event["text"].endswith("Shall I?"), event
                break
        while not kept(folder / "data"):
            assert process.poll() is None
        process.send_signal(signal.SIGKILL)
    return folder / "data"


@pytest.fixture
def data(killed: Path, tmp_path: Path) -> Iterator[Path]:
    """A copy of it."""
    shutil.copytree(killed, tmp_path / "data")
    yield tmp_path / "data"


async def offered(home: House) -> PlanProposal:
    """What waits, as somebody hears it who comes now."""
    heard: list[PlanProposal] = []

    def on_plan(message: String) -> None:
        told = decode_plan(message.data)
        if isinstance(told, PlanProposal):
            heard.append(told)

    await home.system.transport.subscribe(topics.PLAN, on_plan)
    await home.observer.until(
        lambda: bool(heard) and any("started anew" in said.message for said in home.observer.said)
    )
    return heard[-1]


def decide(home: House, proposal: PlanProposal, **decision: Any) -> None:
    home.observer.publish(
        topics.PLAN_DECISION,
        PlanDecision.model_validate(
            {
                "id": proposal.id,
                "target": proposal.target,
                "digest": proposal.digest,
                "by": person(),
                **decision,
            }
        ),
    )


def system(data: Path) -> Any:
    config = SystemConfig(speed=None, data_dir=data, approval="ask_first")
    return load_demo("nursing-home").system(config)


async def test_it_waits_again_and_is_carried_out_after_a_yes(data: Path) -> None:
    async with running(system(data)) as home:
        proposal = await offered(home)
        assert proposal.labels == ("Find out where “dining table” is", "Go to “dining table”")
        assert [call.name for call in proposal.steps] == ["GetCoordinates", "NavigateTo"]
        assert proposal.lines == ("Go to “dining table”",)
        (told,) = [said.message for said in home.observer.said if "started anew" in said.message]
        assert "please look at it again" in told
        assert home.observer.state(home.robot) == "awaiting_approval"
        decide(home, proposal, decision="approve")
        await home.state("running")
        assert await home.done() == ["finished"] * 2
        assert any("All right: Go to" in said.message for said in home.observer.said)
        assert home.distance_m("dining_table_1") < 1.2
    assert kept(data) == 0
    async with running(system(data)) as home:
        await home.say("hello")
        assert not any("started anew" in said.message for said in home.observer.said)


async def test_it_can_be_turned_down(data: Path) -> None:
    async with running(system(data)) as home:
        decide(home, await offered(home), decision="reject")
        await home.state("idle")
        assert home.actions() == []
    assert kept(data) == 0


async def test_it_can_be_changed_and_the_changed_one_is_carried_out(data: Path) -> None:
    async with running(system(data)) as home:
        proposal = await offered(home)
        first, second = proposal.steps
        other = first.model_copy(update={"input_parameters": {"target": Parameter("string", "TV")}})
        decide(home, proposal, decision="edit", steps=[call.model_dump() for call in (other, second)])
        await home.state("running")
        assert await home.done() == ["finished"] * 2
        assert home.distance_m("tv_1") < home.distance_m("dining_table_1")


async def test_a_yes_in_words_is_enough(data: Path) -> None:
    async with running(system(data)) as home:
        await offered(home)
        home.observer.say("yes, please", home.robot)
        await home.state("running")
        assert await home.done() == ["finished"] * 2


async def test_what_is_not_possible_any_more_is_dropped_and_said(data: Path) -> None:
    with closing(sqlite3.connect(data / "proposals.db")) as file, file:
        (text,) = file.execute("SELECT record FROM proposal").fetchone()
        record = json.loads(text)
        record["proposal"]["steps"] = [json.loads(ActionCall(name="Fly").model_dump_json())]
        file.execute("UPDATE proposal SET record = ?", (json.dumps(record),))
    async with running(system(data)) as home:
        await home.observer.until(
            lambda: any("not possible any more" in said.message for said in home.observer.said)
        )
        assert home.observer.state(home.robot) == "idle"
    assert kept(data) == 0


def test_the_terminal_shows_it_again_and_takes_the_yes(data: Path) -> None:
    command = [
        sys.executable, "-m", "parley", "demo", "nursing-home", "--terminal", "--ask-first",
        "--speed", "20", "--data", str(data),
    ]  # fmt: skip
    done = subprocess.run(command, input="yes\n", capture_output=True, text=True, timeout=100, check=False)
    told = " ".join(done.stdout.split())
    order = ["David would do this:", "Answer yes or no.", "All right: Go to", "I have finished"]
    places = [told.find(text) for text in order]
    assert places == sorted(places), done.stdout
    assert places[0] >= 0, done.stdout
