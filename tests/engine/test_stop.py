"""The emergency stop: at once, latched, reported; nothing moves until a person resets it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from parley.clock import WallClock
from parley.engine.runs import GraphRuns
from parley.engine.stop import EmergencyStop
from parley.errors import Problem
from parley.gate.stop_line import StopLine
from parley.messages import ros, topics
from parley.messages.principal import Principal
from parley.messages.status import StopReport
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph
from parley.umrf.motion import Motions
from tests.umrf.spec_actions import CATALOGUE, chain, node, planner_chain, wait_for

from .rig import DummyRobot, rigged


async def test_stop_halts_the_drive_pauses_graphs_and_latches_until_reset() -> None:
    robot = DummyRobot()
    async with rigged(robot) as rig:
        rig.start(planner_chain("g", [node("WaitFor", 0, seconds=60), node("NoOp", 1)]))
        await rig.until_graph("g", "RUNNING")
        robot.moving = True
        rig.emergency("stop")
        await rig.until(lambda: len(rig.reports) == 2)
        assert [item.state for item in rig.reports] == ["received", "at_rest"]
        assert robot.told == ["halt"]
        assert rig.graph_states("g") == ["RUNNING", "PAUSED"]
        await rig.until(lambda: rig.statuses[-1].state == "stopped")

        rig.start(chain("h", [node("NoOp", 0)]))
        rig.resume("g")
        rig.modify(
            planner_chain("g", [node("WaitFor", 0, seconds=60), node("NoOp", 1)]), continue_from="NoOp_1"
        )
        await rig.until(lambda: len(rig.rejections) == 3)
        assert {item.problems[0].code for item in rig.rejections} == {"stop_latched"}
        assert all(item.problems[0].remedy for item in rig.rejections)

        rig.emergency("reset")
        await rig.until(lambda: rig.reports[-1].state == "reset")
        assert robot.told == ["halt", "release"]
        assert rig.graph_states("g") == ["RUNNING", "PAUSED"], "a reset alone moves nothing"
        rig.resume("g")
        await rig.until_graph("g", "RUNNING")


async def test_stop_for_another_robot_is_not_ours() -> None:
    robot = DummyRobot()
    async with rigged(robot) as rig:
        rig.emergency("stop", targets=("B",))
        rig.emergency("stop", targets=("A",), id="2")
        await rig.until(lambda: rig.reports)
        assert rig.reports[0].id == "2"
        assert robot.told == ["halt"]


async def test_a_stop_that_fails_is_complained_about() -> None:
    robot = DummyRobot()
    robot.broken = True
    async with rigged(robot) as rig:
        rig.emergency("stop")
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "stop_failed"


@asynccontextmanager
async def end_of_line(
    robot: DummyRobot, runs: GraphRuns, reports: list[StopReport], problems: list[Problem]
) -> AsyncIterator[StopLine]:
    line, motions = StopLine(), Motions(WallClock(), lambda _: None)
    stop = EmergencyStop(
        "A", robot, runs, motions, line, report=reports.append, complain=problems.append, rest_timeout_s=0.01
    )
    stop.open()
    yield line
    await stop.close()
    await runs.close()


def graph_runs(catalogue: Catalogue) -> GraphRuns:
    return GraphRuns(
        "A", catalogue, clock=WallClock(), make_context=lambda handle: handle, observer=lambda *_: None
    )


async def test_a_robot_that_goes_on_moving_is_complained_about_until_it_stands() -> None:
    robot, reports, problems = DummyRobot(), list[StopReport](), list[Problem]()
    robot.rolls_on = robot.moving = True
    async with end_of_line(robot, graph_runs(CATALOGUE), reports, problems) as line:
        line.pull(by=None, id="7")
        while not problems:
            await WallClock().sleep(0.005)
        assert problems[0].code == "still_moving"
        robot.moving = False
        while len(reports) < 3:
            await WallClock().sleep(0.005)
        assert [item.state for item in reports] == ["received", "moving", "at_rest"]


async def test_a_robot_that_cannot_say_whether_it_stands_does_not_answer() -> None:
    robot, reports, problems = DummyRobot(), list[StopReport](), list[Problem]()
    robot.silent = True
    async with end_of_line(robot, graph_runs(CATALOGUE), reports, problems) as line:
        line.pull(by=None, id="7")
        while not problems:
            await WallClock().sleep(0.005)
        assert [item.state for item in reports] == ["received", "silent"]


@action(effects=("moves",), pausable=False)
async def roll_on(ctx: RunHandle) -> None:
    """Take no notice of any pause."""
    await asyncio.Event().wait()


@pytest.mark.parametrize(("name", "told"), [("RollOn", ["ignores_stop"]), ("WaitFor", [])])
async def test_an_action_that_moves_and_ignores_the_stop_is_named_while_the_drive_is_held(
    name: str, told: list[str]
) -> None:
    robot, problems = DummyRobot(), list[Problem]()
    runs = graph_runs(Catalogue([roll_on.spec, wait_for.spec]))
    raw = {"name": name, "type": "sync"} if name == "RollOn" else node(name, seconds=60.0)
    run = runs.start(read_graph(chain("g", [raw | {"instance_id": 0}])))
    async with end_of_line(robot, runs, [], problems) as line:
        line.pull(by=None, id="7")
        await WallClock().sleep(0.05)
        assert [problem.code for problem in problems] == told
        assert all("RollOn_0 goes on" in problem.message for problem in problems)
        assert robot.told == ["halt"]
        assert run.holding


async def test_only_a_person_releases() -> None:
    async with rigged(DummyRobot()) as rig:
        rig.emergency("stop")
        await rig.until(lambda: len(rig.reports) == 2)
        for by in (None, Principal(kind="engine", name="model")):
            rig.emergency("reset", by=by)
        await rig.until(lambda: len(rig.rejections) == 2)
        assert {item.problems[0].code for item in rig.rejections} == {"reset_refused"}
        assert rig.robot is not None
        assert rig.robot.told == ["halt"]


async def test_a_hold_goes_on_by_itself_and_pauses_no_graph() -> None:
    async with rigged(DummyRobot()) as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        rig.emergency("hold", id="m1", by=None)
        rig.emergency("go_on", id="m1", by=None)
        rig.pause("g")
        await rig.until_graph("g", "PAUSED")
        assert rig.robot is not None
        assert rig.robot.told == ["halt", "release"]
        assert rig.graph_states("g") == ["RUNNING", "PAUSED"]
        assert rig.reports == []


async def test_a_stop_during_a_reset_wins() -> None:
    robot = DummyRobot()
    async with rigged(robot) as rig:
        rig.emergency("stop", id="1")
        rig.emergency("reset", id="2")
        rig.emergency("stop", id="3")
        await rig.until(lambda: rig.reports and rig.reports[-1].state == "at_rest")
        rig.start(chain("g", [node("NoOp", 0)]))
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "stop_latched"


async def test_unreadable_stop_commands_are_refused() -> None:
    async with rigged() as rig:
        publisher = rig.transport.publisher(topics.STOP)
        publisher.publish(ros.String("{"))
        publisher.publish(ros.String('{"command": "halt"}'))
        await rig.until(lambda: len(rig.rejections) == 2)
        assert [item.problems[0].path for item in rig.rejections] == ["", "command"]
