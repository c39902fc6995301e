"""Commands in the order in which they came; those that are lost, and runs that never begin, are told."""

from __future__ import annotations

import asyncio

import pytest

from parley.engine.engine import COMMAND_DEPTH
from parley.messages import topics
from parley.messages.status import StepCommand
from parley.messages.wire import to_string
from parley.umrf.io import read_graph
from parley.umrf.model import Result
from tests.umrf.spec_actions import chain, node

from .rig import engine_of, rigged


@pytest.mark.parametrize(
    ("commands", "state"), [(("pause", "resume", "pause"), "PAUSED"), (("resume", "pause"), "PAUSED")]
)
async def test_commands_of_several_topics_keep_their_order(commands: tuple[str, ...], state: str) -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        for command in commands:
            getattr(rig, command)("g")
        rig.start(chain("last", [node("NoOp", 0)]))
        await rig.until_graph("last", "FINISHED")
        assert rig.graph_states("g")[-1] == state


async def test_a_step_may_be_ended_in_the_breath_in_which_its_graph_is_started() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        command = StepCommand(target="A", graph_name="g", node="WaitFor_0")
        rig.transport.publisher(topics.STEP).publish(to_string(command))
        await rig.until(lambda: rig.rejections or rig.graph_states("g")[-1:] == ["HALTED"])
        assert rig.rejections == []


async def test_commands_that_are_lost_are_told() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        for _ in range(COMMAND_DEPTH + 5):
            rig.pause("g")
        await rig.until(lambda: rig.rejections)
    (problem,) = rig.rejections[0].problems
    assert (rig.rejections[0].what, problem.code) == ("umrf_graph_pause", "commands_lost")
    assert problem.message.startswith("5 commands")


async def test_who_waits_for_a_graph_that_others_do_not_take_up_hears_that_it_is_over() -> None:
    async with rigged() as rig, engine_of("B", rig, peer_timeout_s=0.05) as engine:
        here, there = node("NoOp", 0), node("NoOp", 1)
        here["actor"], there["actor"] = "B", "C"
        run = engine.start(read_graph(chain("g", [here, there])))
        async with asyncio.timeout(5):
            assert await run.wait() is Result.ON_STOPPED
        await rig.until(lambda: rig.rejections)


async def test_commands_keep_their_order_even_where_some_are_lost() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        for _ in range(COMMAND_DEPTH):
            rig.pause("g")
        rig.resume("g")
        rig.pause("g")
        rig.start(chain("last", [node("NoOp", 0)]))
        await rig.until_graph("last", "FINISHED")
        assert rig.graph_states("g")[-1] == "PAUSED"
