"""Robot time and wall time."""

from __future__ import annotations

import asyncio
import time

import pytest

from parley.clock import Clock, SimClock, WallClock


async def settle() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


def as_clock(clock: Clock) -> Clock:
    return clock  # the type checker holds both to the protocol


@pytest.mark.parametrize("clock", [as_clock(WallClock()), as_clock(SimClock())], ids=["wall", "sim"])
def test_wall_time_and_time_stamps_are_real_whatever_robot_time_is(clock: Clock) -> None:
    before_s, before_ms = time.monotonic(), time.time_ns() // 1_000_000
    assert before_s <= clock.wall_s() <= time.monotonic()
    assert before_ms <= clock.unix_ms() <= time.time_ns() // 1_000_000


async def test_on_a_wall_clock_robot_time_passes_by_itself() -> None:
    clock = WallClock()
    before_s = clock.now_s()
    await clock.sleep(0.002)
    assert clock.now_s() >= before_s + 0.002
    with pytest.raises(TimeoutError):
        async with clock.timeout(0.001):
            await asyncio.Event().wait()
    with clock.hold():
        pass


async def test_simulated_time_moves_only_when_advanced() -> None:
    clock = SimClock(start_s=5.0)
    await asyncio.sleep(0.002)
    assert clock.now_s() == 5.0
    clock.advance(0.25)
    assert clock.now_s() == 5.25


async def test_sleepers_wake_in_the_order_of_their_times_and_equals_in_the_order_they_came() -> None:
    clock = SimClock()
    woken: list[str] = []

    async def sleep(label: str, seconds: float) -> None:
        await clock.sleep(seconds)
        woken.append(label)

    async with asyncio.TaskGroup() as group:
        for label, seconds in [("late", 3.0), ("first", 1.0), ("second", 1.0), ("middle", 2.0)]:
            group.create_task(sleep(label, seconds))
        await settle()
        assert clock.has_sleepers
        clock.advance(0.5)
        await settle()
        assert woken == []
        clock.advance(0.5)
        await settle()
        assert woken == ["first", "second"]
        clock.advance(10.0)
    assert woken == ["first", "second", "middle", "late"]
    assert not clock.has_sleepers


async def test_small_steps_add_up_without_losing_a_sleeper_to_rounding() -> None:
    clock = SimClock()
    sleeper = asyncio.create_task(clock.sleep(1.0))
    await settle()
    for _ in range(10):
        clock.advance(0.1)
    assert clock.now_s() < 1.0, "ten tenths are not quite one"
    await settle()
    assert sleeper.done()


@pytest.mark.parametrize("seconds", [0.0, -1.0])
async def test_sleeping_for_no_time_lets_others_run_and_returns(seconds: float) -> None:
    clock = SimClock()
    others: list[str] = []
    asyncio.get_running_loop().call_soon(others.append, "ran")
    await clock.sleep(seconds)
    assert others == ["ran"]


async def test_a_cancelled_sleeper_is_forgotten() -> None:
    clock = SimClock()
    sleeper = asyncio.create_task(clock.sleep(1.0))
    await settle()
    sleeper.cancel()
    await settle()
    assert not clock.has_sleepers
    clock.advance(2.0)


async def test_a_timeout_ends_what_takes_longer_in_robot_time() -> None:
    clock = SimClock()
    outcome: list[str] = []

    async def work() -> None:
        try:
            async with clock.timeout(2.0):
                await asyncio.Event().wait()
        except TimeoutError:
            outcome.append(f"timed out at {clock.now_s()}")

    task = asyncio.create_task(work())
    await settle()
    clock.advance(1.9)
    await settle()
    assert outcome == []
    clock.advance(0.2)
    await task
    assert outcome == ["timed out at 2.1"]


async def test_work_that_is_quick_enough_is_not_disturbed_and_leaves_no_sleeper() -> None:
    before = asyncio.all_tasks()
    clock = SimClock()
    async with clock.timeout(2.0):
        await settle()
        assert clock.has_sleepers
    await settle()
    assert not clock.has_sleepers
    assert asyncio.all_tasks() == before
    clock.advance(5.0)


async def test_work_that_ends_in_the_moment_of_its_timeout_ends_cleanly() -> None:
    clock = SimClock()
    done = asyncio.Event()

    async def work() -> str:
        async with clock.timeout(2.0):
            await done.wait()
        return "done"

    task = asyncio.create_task(work())
    await settle()
    done.set()
    clock.advance(2.0)
    assert await task == "done"


async def test_cancelling_from_outside_is_not_mistaken_for_a_timeout() -> None:
    clock = SimClock()

    async def work() -> None:
        async with clock.timeout(2.0):
            await asyncio.Event().wait()

    task = asyncio.create_task(work())
    await settle()
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task


def test_time_is_held_while_anybody_holds_it() -> None:
    clock = SimClock()
    with clock.hold():
        with clock.hold():
            assert clock.held
        assert clock.held
    assert not clock.held


async def test_whoever_starts_to_wait_or_lets_go_is_noticed_by_the_simulator() -> None:
    clock = SimClock()
    assert not clock.wanted.is_set()
    sleeper = asyncio.create_task(clock.sleep(1.0))
    await settle()
    assert clock.wanted.is_set()
    clock.wanted.clear()
    with clock.hold():
        assert not clock.wanted.is_set()
    assert clock.wanted.is_set()
    clock.advance(1.0)
    await sleeper
