"""A system that was killed says what it was doing, and goes on with it when it is told to."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.messages import topics
from parley.messages.ros import String, UmrfGraphStart
from parley.messages.status import GraphEvent
from parley.messages.wire import decode
from tests.demos.house import PATIENCE_S, House, running

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
        told = 0
        for line in process.stdout:
            event = json.loads(line)
            told += event["event"] == "progress" and event["node"].startswith("NavigateTo")
            if told == 2:  # what ended before the first is written down by then
                break
        process.send_signal(signal.SIGKILL)
    return folder / "data"


async def notice(home: House) -> str:
    await home.observer.until(lambda: any("interrupted" in said.message for said in home.observer.said))
    return next(said.message for said in home.observer.said if "interrupted" in said.message)


async def test_it_says_so_and_carries_on_when_told(killed: Path) -> None:
    demo = load_demo("nursing-home")
    async with running(demo.system(SystemConfig(speed=None, data_dir=killed))) as home:
        await notice(home)  # and it is ended in order before anybody says anything
    async with running(demo.system(SystemConfig(speed=None, data_dir=killed))) as home:
        text = await notice(home)
        assert "dining table" in text
        assert "carry on" in text
        plan = home.observer.plans.get(home.robot)
        assert plan is None or {step.state for step in plan.steps} == {"queued"}, "nothing begins by itself"
        await home.say("carry on")
        assert await home.done() == ["finished"] * 4
        # Where the first place is, is looked up anew: a restart may be long ago.
        assert home.actions() == ["GetCoordinates", "NavigateTo", "GetCoordinates", "NavigateTo"]
    async with running(demo.system(SystemConfig(speed=None, data_dir=killed))) as home:
        reply = await home.say("carry on")
        assert "nothing" in reply.message.lower()
        assert not any("interrupted" in said.message for said in home.observer.said)


async def test_a_plan_that_was_held_when_the_system_ended_is_offered_until_somebody_drops_it(
    tmp_path: Path,
) -> None:
    demo = load_demo("nursing-home")
    async with running(demo.system(SystemConfig(speed=None, data_dir=tmp_path))) as home:
        await home.say("go to the dining table")
        await home.say("wait")
    async with running(demo.system(SystemConfig(speed=None, data_dir=tmp_path))) as home:
        assert "dining table" in await notice(home)
        assert "dropped" in (await home.say("cancel everything")).message
    async with running(demo.system(SystemConfig(speed=None, data_dir=tmp_path))) as home:
        assert "nothing" in (await home.say("carry on")).message.lower()
        assert not any("interrupted" in said.message for said in home.observer.said)


def forked(question: str) -> dict[str, Any]:
    """Finds a place and asks a person at once, and looks for another place when both are done."""
    pose = {
        "position": {axis: {"pvf_type": "number"} for axis in "xyz"},
        "orientation": {axis: {"pvf_type": "number"} for axis in "rpy"},
    }

    def find(index: int, target: str, **more: Any) -> dict[str, Any]:
        inputs = {"target": {"pvf_type": "string", "pvf_value": target}}
        action = {"name": "GetCoordinates", "instance_id": index, "type": "sync"}
        return action | {"input_parameters": inputs, "output_parameters": {"pose": pose}} | more

    first, last = {"name": "GetCoordinates", "instance_id": 0}, {"name": "GetCoordinates", "instance_id": 2}
    ask = {"name": "AskOperator", "instance_id": 1}
    asking = ask | {
        "type": "sync",
        "input_parameters": {"question": {"pvf_type": "string", "pvf_value": question}},
        "output_parameters": {"answer": {"pvf_type": "string"}},
        "children": [last],
    }
    return {
        "graph_name": "forked",
        "graph_entry": [first, ask],
        "graph_exit": [last],
        "actions": [find(0, "TV", children=[last]), asking, find(2, "TV", parents=[first, ask])],
    }


async def test_a_graph_with_branches_goes_on_when_told_and_asks_again_only_what_is_open(
    tmp_path: Path,
) -> None:
    demo = load_demo("nursing-home")
    before, after = tmp_path / "before", tmp_path / "after"
    after.mkdir()
    async with running(demo.system(SystemConfig(speed=None, data_dir=before))) as home:
        found = asyncio.Event()

        def on_end(message: String) -> None:
            event = decode(GraphEvent, message.data)
            if event.node == "GetCoordinates_0" and event.state == "FINISHED":
                found.set()

        await home.system.transport.subscribe(topics.GRAPH_EVENTS, on_end)
        text = json.dumps(forked("Which way?"))
        home.observer.send(topics.GRAPH_START, UmrfGraphStart("", text, (home.robot,)))
        assert (await home.question()).message == "Which way?"
        async with asyncio.timeout(PATIENCE_S):
            await found.wait()  # both branches begin at once, and either may be the slower one
        journal = home.system.engines.journal
        assert journal is not None
        await journal.flush()
        for file in before.glob("journal.db*"):  # what a kill would leave now
            (after / file.name).write_bytes(file.read_bytes())
    async with running(demo.system(SystemConfig(speed=None, data_dir=after))) as home:
        assert "carry on" in await notice(home)
        began: list[str] = []

        def on_event(message: String) -> None:
            event = decode(GraphEvent, message.data)
            if event.graph_name == "forked" and event.kind == "node" and event.state == "RUNNING":
                began.append(event.node)

        await home.system.transport.subscribe(topics.GRAPH_EVENTS, on_event)
        reply = await home.say("carry on")
        assert reply.message == "I am going on."
        assert (await home.question()).message == "Which way?"
        home.observer.say("that way", home.robot, answer=True)
        await home.observer.until(
            lambda: home.observer.graph_states.get((home.robot, "forked")) == "FINISHED"
        )
        assert began == ["AskOperator_1", "GetCoordinates_2"], (
            "the place that was found is not looked for again"
        )
