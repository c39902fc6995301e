"""A blocked loop is noticed from outside: its robots are held, and the action that blocks is named."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from parley.clock import WallClock
from parley.engine.watchdog import BLOCKED_S, TELL_S, LoopWatchdog
from parley.gate.stop_line import StopLine
from parley.umrf.threads import in_thread

LONG_S = TELL_S + 0.3


class Drive:
    def __init__(self, line: StopLine) -> None:
        self.log: list[tuple[str, float]] = []
        line.attach("Ada", halt=lambda: self.note("halt"), resume=lambda: self.note("go on"), told=print)

    def note(self, what: str) -> None:
        self.log.append((what, time.monotonic()))


@asynccontextmanager
async def watched(told: list[str]) -> AsyncIterator[tuple[Drive, LoopWatchdog]]:
    line = StopLine()
    drive, dog = Drive(line), LoopWatchdog(line, ["Ada"], WallClock(), told.append)
    dog.open()
    yield drive, dog
    await dog.close()


async def test_an_action_that_blocks_the_loop_holds_its_robot_and_is_named_afterwards() -> None:
    told = list[str]()
    async with watched(told) as (drive, _):

        async def work() -> float:
            began_s = time.monotonic()
            time.sleep(LONG_S)  # noqa: ASYNC251 - the defect that is to be noticed
            return began_s

        began_s = await asyncio.create_task(work(), name="graph_1/Grind_0")
        async with asyncio.timeout(5):
            while not told:  # noqa: ASYNC110 - said by another thread
                await asyncio.sleep(0.01)
        (halted, halted_s), (went_on, _) = drive.log
        assert (halted, went_on) == ("halt", "go on")
        assert halted_s - began_s < BLOCKED_S + 0.4
        assert "because Grind kept" in told[0]


async def test_a_plain_action_in_its_thread_blocks_nothing() -> None:
    told = list[str]()
    async with watched(told) as (drive, _):
        await in_thread("action Grind_0", time.sleep, BLOCKED_S + 0.2)
    assert (drive.log, told) == ([], [])


async def test_who_hears_a_topic_is_no_action_to_be_blamed() -> None:
    told = list[str]()
    async with watched(told) as (drive, _):

        async def hear() -> None:
            time.sleep(LONG_S)  # noqa: ASYNC251 - the defect that is to be noticed

        await asyncio.create_task(hear(), name="sub /parley/actor_status")
        async with asyncio.timeout(5):
            while len(drive.log) < 2:  # noqa: ASYNC110 - done by another thread
                await asyncio.sleep(0.01)
        await asyncio.sleep(0)
    assert told == []
