"""Each part is frozen and killed in turn while a robot drives: it can be stopped, and nothing is lost."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import Any, Literal

import httpx
import pytest

from parley.clock import WallClock
from parley.config import SystemConfig
from parley.messages import topics
from parley.messages.principal import person
from parley.messages.ros_robot import Odometry
from parley.messages.status import StopCommand
from parley.messages.topics import QoS
from parley.messages.wire import to_string
from parley.network import transport_of
from parley.robots.ros_senses import RosTopics
from tests.parts import ROBOT, Parts, parts

pytestmark = pytest.mark.soak

Victim = Literal["agents", "web", "engine", "router", "simulator"]
ODOM = RosTopics().topic("odom", Odometry, QoS(reliable=False, depth=5))


class Page:
    """What a page's server says."""

    def __init__(self, client: httpx.AsyncClient) -> None:
        self._client = client

    async def stop(self) -> None:
        """Press the button."""
        answer = await self._client.post("/api/stop", json={"command": "stop", "id": "now", "targets": []})
        assert answer.status_code == 200, answer.text

    async def robot(self) -> dict[str, Any]:
        """What it shows of the robot."""
        answer = await self._client.get(f"/api/robots/{ROBOT}")
        return dict(answer.json()) if answer.status_code == 200 else {}

    async def until(self, *path: str, is_: object, within_s: float = 30.0) -> None:
        """Wait until it shows something of the robot."""
        async with asyncio.timeout(within_s):
            while True:
                try:
                    found: Any = await self.robot()
                    for name in path:
                        found = found.get(name, {})
                    if found == is_:
                        return
                except httpx.TransportError:
                    pass  # it is not there yet
                await asyncio.sleep(0.1)


EVERY = ("router", "simulator", "engine", "agents", "web")
CUTS = ("engine", "router", "simulator")
"""Without these nobody can tell the robot anything."""


class Eye:
    """Sees the robot itself, whoever else does not."""

    def __init__(self) -> None:
        self.speed_mps, self.where_m, self._changed = 0.0, (0.0, 0.0), asyncio.Event()

    def on_odom(self, told: Odometry) -> None:
        """It tells twenty times a second how fast it is."""
        self.speed_mps = abs(told.twist.twist.linear.x)
        self.where_m = told.pose.pose.position.x, told.pose.pose.position.y
        self._changed.set()

    async def until(self, condition: Callable[[float], bool], within_s: float) -> None:
        """Wait for a speed."""
        async with asyncio.timeout(within_s):
            while not condition(self.speed_mps):
                self._changed.clear()
                await self._changed.wait()


@asynccontextmanager
async def driving(
    folder: Path, *, beside: bool = False, driver: bool = False
) -> AsyncIterator[tuple[Parts, Page, Eye]]:
    """All parts up, and the robot under way; see `parts`."""
    async with AsyncExitStack() as stack:
        system = await stack.enter_async_context(parts(folder, *EVERY, beside=beside, driver=driver))
        page = Page(
            await stack.enter_async_context(
                httpx.AsyncClient(base_url=f"http://127.0.0.1:{system.port}", timeout=10)
            )
        )
        eye, end = Eye(), await stack.enter_async_context(transport_of(SystemConfig(network=system.eye)))
        await end.subscribe(ODOM, eye.on_odom)
        await page.until("connection", is_="here")
        look = "" if driver else ", then check if there is a water bottle"
        system.operator.say(f"go to the fridge{look}", ROBOT)
        await system.operator.until(lambda: system.begun("NavigateTo") == 1)
        await eye.until(lambda speed_mps: speed_mps > 0.1, 10.0)
        yield system, page, eye


async def pressed(system: Parts, page: Page, victim: Victim) -> None:
    """A stop, at the page or, where that is the victim, by another one on the network."""
    if victim == "web":
        stop = StopCommand(id="now", by=person())
        system.transport.publisher(topics.STOP).publish(to_string(stop))
    else:
        await page.stop()


async def says_who_does_not_answer(page: Page, victim: Victim) -> None:
    """The page does."""
    if victim == "simulator":
        await page.until("trouble", is_="silent")
    else:
        await page.until("connection", is_="lost")
    await page.until("stop", "state", is_="silent")


@pytest.mark.parametrize("how", ["freeze", "kill"])
@pytest.mark.parametrize("victim", ["agents", "web", "engine", "router", "simulator"])
async def test_whatever_part_is_gone_the_robot_stands_and_nothing_is_lost_or_done_twice(
    tmp_path: Path, victim: Victim, how: Literal["freeze", "kill"]
) -> None:
    clock = WallClock()
    async with driving(tmp_path) as (system, page, eye):
        operator = system.operator
        began_s = clock.wall_s()
        if how == "freeze":
            system.freeze(victim)
        else:
            await system.kill(victim)
        if victim not in CUTS:
            began_s = clock.wall_s()
            await pressed(system, page, victim)
        if victim != "simulator":
            await eye.until(lambda speed_mps: speed_mps < 0.02, 1.0)
            print(f"stood after {clock.wall_s() - began_s:.2f} s")  # noqa: T201 - a figure for people
        if victim in CUTS:
            await pressed(system, page, victim)
            await says_who_does_not_answer(page, victim)
        if how == "freeze":
            system.thaw(victim)
        else:
            await system.start(victim)
        await page.until("connection", is_="here")
        await page.until("state", is_="stopped")
        await page.until("trouble", is_="")
        await page.until("stop", "state", is_="at_rest")
        assert system.begun("NavigateTo") == 1

        reset = StopCommand(command="reset", by=person())
        system.transport.publisher(topics.STOP).publish(to_string(reset))
        await page.until("stop", "state", is_="none")
        await system.until_met()
        await operator.until(lambda: operator.state(ROBOT) in ("paused", "held"))
        began = system.begun("NavigateTo")
        operator.say("carry on", ROBOT)
        await operator.until(lambda: system.begun("Inspect") == 1, timeout_s=90.0)
        await operator.until(lambda: operator.state(ROBOT) == "idle")
        assert system.begun("NavigateTo") <= began + 1
        assert system.begun("Inspect") == 1
        assert not system.heard("lacks") and not system.heard("did not get here"), "nobody missed anything"


@pytest.mark.parametrize("_", range(4))
async def test_parts_that_are_ended_together_with_their_router_end_at_once(tmp_path: Path, _: int) -> None:
    async with driving(tmp_path) as (system, *_rest):
        for process in system.processes.values():
            process.send_signal(signal.SIGINT)
        async with asyncio.timeout(8.0):
            await asyncio.gather(*(process.wait() for process in system.processes.values()))
