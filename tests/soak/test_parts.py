"""Each part is frozen and killed in turn while a robot drives: it can be stopped, and nothing is lost."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Literal

import httpx
import pytest

from parley.messages import topics
from parley.messages.principal import person
from parley.messages.status import StopCommand
from parley.messages.wire import to_string
from tests.parts import ROBOT, Parts, parts

pytestmark = pytest.mark.soak

Victim = Literal["agents", "web", "engine"]


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


@asynccontextmanager
async def driving(folder: Path) -> AsyncIterator[tuple[Parts, Page]]:
    """All parts up, and the robot under way."""
    async with parts(folder, "engine", "agents", "web") as system:
        base = f"http://127.0.0.1:{system.port}"
        async with httpx.AsyncClient(base_url=base, timeout=10) as client:
            page = Page(client)
            await page.until("connection", is_="here")
            system.operator.say("go to the fridge, then check if there is a water bottle", ROBOT)
            await system.operator.until(lambda: system.begun("NavigateTo") == 1)
            yield system, page


async def pressed(system: Parts, page: Page, victim: Victim) -> None:
    """A stop, at the page or, where that is the victim, by another one on the network."""
    if victim == "web":
        stop = StopCommand(id="now", by=person())
        system.transport.publisher(topics.STOP).publish(to_string(stop))
    else:
        await page.stop()


def stands(system: Parts) -> bool:
    return any(r.id == "now" and r.state == "at_rest" for r in system.operator.stop_reports)


@pytest.mark.parametrize("how", ["freeze", "kill"])
@pytest.mark.parametrize("victim", ["agents", "web", "engine"])
async def test_a_stop_reaches_the_robot_whatever_part_is_gone(
    tmp_path: Path, victim: Victim, how: Literal["freeze", "kill"]
) -> None:
    async with driving(tmp_path) as (system, page):
        operator = system.operator
        if how == "freeze":
            system.freeze(victim)
        else:
            await system.kill(victim)
        await pressed(system, page, victim)
        if victim != "engine":
            async with asyncio.timeout(1.0):
                await operator.until(lambda: stands(system))
        else:
            await page.until("stop", "state", is_="silent")
            await page.until("connection", is_="lost")
        if how == "freeze":
            system.thaw(victim)
        else:
            await system.start(victim)
        await page.until("connection", is_="here")
        await page.until("state", is_="stopped")
        await page.until("at_rest", is_=True)
        assert system.begun("NavigateTo") == 1

        reset = StopCommand(command="reset", by=person())
        system.transport.publisher(topics.STOP).publish(to_string(reset))
        await operator.until(lambda: any(report.state == "reset" for report in operator.stop_reports))
        await system.settled()
        await operator.until(lambda: operator.state(ROBOT) == "paused")
        began = system.begun("NavigateTo")
        operator.say("carry on", ROBOT)
        await operator.until(lambda: system.begun("Inspect") == 1)
        await operator.until(lambda: operator.state(ROBOT) == "idle")
        assert system.begun("NavigateTo") <= began + 1
        assert system.begun("Inspect") == 1
