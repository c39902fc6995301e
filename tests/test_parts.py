"""Engine and nodes in processes of their own: each is stopped, killed and started anew under way."""

from __future__ import annotations

import asyncio
import math
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any, Self

import httpx
import pytest

from parley.clock import WallClock
from parley.demos.catalogue import load_demo
from parley.demos.runner import play
from parley.engine.hearing import TELL_S
from parley.messages import topics
from parley.messages.principal import person
from parley.messages.status import ActorStatus, StopCommand
from parley.messages.wire import to_string
from parley.transport.base import Transport
from tests.parts import ROBOT, parts, until_open
from tests.soak.test_parts import driving, pressed, says_who_does_not_answer


async def test_each_half_is_killed_under_way_and_nothing_is_lost_or_done_twice(tmp_path: Path) -> None:
    async with parts(tmp_path, "engine", "agents") as system:
        operator, stops = system.operator, system.transport.publisher(topics.STOP)
        operator.say("go to the fridge, then check if there is a water bottle", ROBOT)
        await operator.until(lambda: system.begun("NavigateTo") == 1)

        await system.kill("agents")
        stops.publish(to_string(StopCommand(id="now", by=person())))
        async with asyncio.timeout(1.0):  # what protects people is measured in wall time
            await operator.until(
                lambda: any(r.id == "now" and r.state == "at_rest" for r in operator.stop_reports)
            )
        await system.start("agents")
        await operator.until(lambda: system.heard("could not be reached"))
        assert operator.state(ROBOT) == "paused"
        assert [step.state for step in operator.plans[ROBOT].steps] == ["finished", "paused", "queued"]

        await system.kill("engine")
        await system.start("engine", "--speed", "8")
        await operator.until(lambda: system.heard("plan was interrupted"))
        assert system.statuses[ROBOT].state == "stopped", "an engine keeps who was stopped"
        stops.publish(to_string(StopCommand(command="reset", by=person())))
        await operator.until(lambda: any(report.state == "reset" for report in operator.stop_reports))
        await system.settled()
        assert system.begun("NavigateTo") == 1, "nothing begins by itself"

        operator.say("carry on", ROBOT)
        await operator.until(lambda: operator.state(ROBOT) == "idle")
        assert [step.state for step in operator.plans[ROBOT].steps][-2:] == ["finished", "finished"]
        assert (system.begun("NavigateTo"), system.begun("Inspect")) == (2, 1)


async def test_a_robot_whose_engine_hears_no_page_any_more_stands_and_a_stop_of_meanwhile_wins(
    tmp_path: Path,
) -> None:
    async with driving(tmp_path, beside=True) as (system, page, eye):
        system.freeze("router")
        await eye.until(lambda speed_mps: speed_mps < 0.02, 1.0)
        await asyncio.sleep(TELL_S)  # of less it would not speak
        system.thaw("router")
        await eye.until(lambda speed_mps: speed_mps > 0.1, 10.0)
        await system.operator.until(lambda: system.heard("I heard no page"))

        system.freeze("router")
        await eye.until(lambda speed_mps: speed_mps < 0.02, 1.0)
        await pressed(system, page, "router")
        await says_who_does_not_answer(page, "router")
        system.thaw("router")
        await page.until("stop", "state", is_="at_rest")
        await asyncio.sleep(2.0)
        assert eye.speed_mps < 0.02 and system.begun("NavigateTo") == 1


async def test_a_base_that_hung_stands_when_it_is_back_and_the_page_says_meanwhile_that_it_does_not_answer(
    tmp_path: Path,
) -> None:
    async with driving(tmp_path, driver=True) as (system, page, eye):
        system.freeze("simulator")
        await page.until("trouble", is_="silent", within_s=2.0)
        where_m = eye.where_m
        system.thaw("simulator")
        await page.until("trouble", is_="")
        assert math.dist(eye.where_m, where_m) < 0.05 and eye.speed_mps < 0.02
        await system.operator.until(lambda: system.heard("My base does not answer."))

        system.freeze("engine")
        await page.until("connection", is_="lost", within_s=3.0)
        system.thaw("engine")
        await page.until("connection", is_="here")
        assert system.begun("NavigateTo") == 1


@pytest.mark.timeout(300)
async def test_a_robot_of_a_team_is_killed_under_way_and_another_one_does_its_part_once(
    tmp_path: Path,
) -> None:
    team = ("Spot", "TIAGo", "Leo")
    async with parts(tmp_path, *(f"engine {name}" for name in team), "agents") as system:
        operator = system.operator
        operator.say("Check Area A, Area B and Area C, split between you.", "Spot")
        await operator.until(
            lambda: {robot for robot in team if operator.state(robot) == "running"} == {*team}
        )

        await system.kill("engine Leo")
        offers = "Let Spot take over from Leo"
        await operator.until(lambda: any(offers in said.choices for said in operator.said))
        operator.say(offers, "Spot")
        await operator.until(lambda: system.heard("Leo gives up what is left of its plan."))
        await operator.until(lambda: {operator.state("Spot"), operator.state("TIAGo")} == {"idle"})

        del system.statuses["Leo"]
        await system.start("engine Leo")
        async with asyncio.timeout(60.0):
            while "Leo" not in system.statuses:
                await system.settled()
        await system.settled()
        looked = sorted(
            str(step.action.input_parameters["inspect"].value)
            for plan in operator.plans.values()
            for step in plan.steps
            if step.action.name == "Inspect" and step.state == "finished"
        )
        assert looked == ["Area A", "Area B", "Area C"]
        assert system.begun("Inspect") == 3, "no place is looked at twice"


async def test_a_button_that_is_pressed_while_nobody_plans_is_told_of_and_does_nothing_later(
    tmp_path: Path,
) -> None:
    async with parts(tmp_path, "engine", "agents", "web") as system:
        await until_open(f"tcp/127.0.0.1:{system.port}")
        operator = system.operator
        operator.say("go to the fridge", ROBOT)
        await operator.until(lambda: system.begun("NavigateTo") == 1)
        async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{system.port}", timeout=20) as page:

            async def press(command: str) -> int:
                body = {"command": command}
                return (await page.post(f"/api/plans/{ROBOT}/command", json=body)).status_code

            async with asyncio.timeout(60):
                while await press("pause") != 200:  # noqa: ASYNC110 - until it knows the robot
                    await asyncio.sleep(0.2)
            await operator.until(lambda: operator.state(ROBOT) == "paused")
            await system.kill("agents")
            assert await press("skip") == 200
            told = ""
            async with asyncio.timeout(60):
                while "planning does not answer" not in told:
                    await asyncio.sleep(0.2)
                    told = (await page.get("/api/chat")).text
            for command, state in (("resume", "running"), ("pause", "paused")):
                assert await press(command) == 200
                async with asyncio.timeout(10):  # its engine is told itself
                    while (now := system.statuses[ROBOT]).state != state or now.at_rest is (
                        state == "running"
                    ):
                        system.beat.clear()
                        await system.beat.wait()
            await system.start("agents")
            await system.until_met()
            assert system.statuses[ROBOT].state == "paused", "nothing begins by itself"
            assert len(operator.plans[ROBOT].steps) == 2
            assert await press("resume") == 200
            await operator.until(lambda: operator.state(ROBOT) == "running")


async def test_a_robot_is_paused_and_goes_on_while_those_who_plan_hang(tmp_path: Path) -> None:
    async with parts(tmp_path, "router", "engine", "agents", "web") as system:
        await until_open(f"tcp/127.0.0.1:{system.port}")
        operator, clock = system.operator, WallClock()

        async def until(state: str, *, rests: bool, within_s: float = 10.0) -> None:
            async with asyncio.timeout(within_s):
                while (now := system.statuses[ROBOT]).state != state or now.at_rest is not rests:
                    system.beat.clear()
                    await system.beat.wait()

        operator.say("go to the fridge, then check if there is a water bottle", ROBOT)
        await until("running", rests=False)
        async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{system.port}", timeout=20) as page:

            async def press(command: str) -> None:
                answer = await page.post(f"/api/plans/{ROBOT}/command", json={"command": command})
                assert answer.status_code == 200, answer.text

            async def states() -> set[str]:
                return {plan["state"] for plan in (await page.get(f"/api/plans/{ROBOT}")).json()}

            async def shown(state: str) -> None:
                async with asyncio.timeout(10):
                    while state not in await states():  # noqa: ASYNC110 - the page is asked as a program does
                        await asyncio.sleep(0.05)

            await shown("running")
            system.freeze("agents")
            began_s = clock.wall_s()
            await press("pause")
            await until("paused", rests=True, within_s=2.0)
            print(f"stood after {clock.wall_s() - began_s:.2f} s")  # noqa: T201 - a figure for people
            await shown("paused")
            await press("resume")
            await until("running", rests=False)
            await shown("running")
            await press("resume")
            await press("pause")
            await until("paused", rests=True, within_s=2.0)
            await system.kill("engine")
            await system.start("engine", "--speed", "4")
            system.statuses[ROBOT] = ActorStatus(actor=ROBOT, holds=())
            async with asyncio.timeout(60.0):  # started anew, it is held as it was
                while not system.statuses[ROBOT].holds:
                    system.beat.clear()
                    await system.beat.wait()
            system.thaw("agents")
            await operator.until(lambda: operator.state(ROBOT) == "paused")
            await system.settled()
            await system.settled()
            assert system.statuses[ROBOT].at_rest, "what was pressed before it does nothing late"
            operator.say("carry on", ROBOT)
            await until("running", rests=False)
            assert not system.statuses[ROBOT].holds
            await operator.until(lambda: operator.state(ROBOT) == "idle")
            assert (system.begun("NavigateTo"), system.begun("Inspect")) == (2, 1)


class Apart:
    """What a story is played on: router, simulator, engine, those who plan and the page, each a process."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.clock, self.simulator = folder, WallClock(), None
        self.robot_names, self.known = (ROBOT,), load_demo("nursing-home").objects
        self.transport: Transport

    async def __aenter__(self) -> Self:
        self._stack = AsyncExitStack()
        every = ("router", "simulator", "engine", "agents", "web")
        system = await self._stack.enter_async_context(parts(self.folder, *every, speed="6"))
        self.transport = system.transport
        return self

    async def __aexit__(self, *exc: Any) -> None:
        await self._stack.aclose()


async def test_the_nursing_home_is_played_by_five_processes_that_meet_at_a_router(tmp_path: Path) -> None:
    result = await play(load_demo("nursing-home").story, lambda _: Apart(tmp_path))
    assert result.held, result.text
