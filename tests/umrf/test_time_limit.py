"""The time-out of an action counts robot time, leaves pauses out, and ends it."""

from __future__ import annotations

import asyncio
import contextlib
import time
from typing import Any

import pytest

from parley.clock import Clock, SimClock, WallClock
from parley.errors import FailureCode
from parley.messages.failure import FailureReport
from parley.umrf import node_run
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, Result

ended: list[str] = []
released = asyncio.Event()


@action(timeout_s=10.0)
async def limited(ctx: RunHandle) -> None:
    """Wait for a long time."""
    try:
        await ctx.clock.sleep(100.0)
    except asyncio.CancelledError:
        ended.append("cancelled")
        raise


@action(timeout_s=10.0)
async def quick(ctx: RunHandle) -> None:
    """Take a moment."""
    await ctx.clock.sleep(9.0)


@action(timeout_s=0.05)
def plain(ctx: RunHandle) -> None:
    """Work in a thread until told to stop."""
    while not ctx.stop_requested:
        time.sleep(0.002)
    ended.append("noticed")


@action(timeout_s=0.05)
def deaf(ctx: RunHandle) -> None:
    """Work in a thread, whatever happens."""
    time.sleep(0.5)


@action(timeout_s=0.05)
async def stubborn(ctx: RunHandle) -> None:
    """Take a cancellation for nothing."""
    try:
        await asyncio.sleep(60)
    except asyncio.CancelledError:
        ended.append("swallowed")


@action(timeout_s=0.05)
async def numb(ctx: RunHandle) -> None:
    """Take every cancellation for nothing, until it is let go."""
    while not released.is_set():
        with contextlib.suppress(asyncio.CancelledError):
            await released.wait()


@action(capabilities=("arm", "camera"))
async def grasp(ctx: RunHandle) -> None:
    """Needs an arm."""


CATALOGUE = Catalogue(item.spec for item in (limited, quick, plain, deaf, numb, stubborn, grasp))


def graph(name: str) -> dict[str, Any]:
    return {"graph_name": "g", "actions": [{"name": name, "type": "sync"}]}


def started(name: str, clock: Clock) -> GraphRun:
    ended.clear()
    run = GraphRun(
        read_graph(graph(name)), CATALOGUE, actor="A", clock=clock, make_context=lambda handle: handle
    )
    run.start()
    return run


async def settle() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


def code_of(run: GraphRun, node: str) -> FailureCode:
    found = run.snapshot().node(node)
    assert found is not None
    return FailureReport.parse(found.messages[-1].message).code


async def test_it_is_robot_time_that_counts() -> None:
    clock = SimClock()
    run = started("Limited", clock)
    await settle()
    clock.advance(9.9)
    await settle()
    assert run.state is GraphState.RUNNING
    clock.advance(0.2)
    assert await run.wait() is Result.ON_ERROR
    assert code_of(run, "Limited_0") is FailureCode.TIMED_OUT
    assert ended == ["cancelled"]


async def test_who_ends_in_time_hears_nothing_of_it() -> None:
    clock = SimClock()
    run = started("Quick", clock)
    await settle()
    clock.advance(9.5)
    assert await run.wait() is Result.ON_TRUE
    await settle()
    assert not clock.has_sleepers


async def test_a_pause_does_not_count() -> None:
    clock = SimClock()
    run = started("Limited", clock)
    await settle()
    clock.advance(6.0)
    await settle()
    run.pause()
    clock.advance(50.0)
    await settle()
    run.resume()
    await settle()
    clock.advance(3.0)
    await settle()
    assert run.state is GraphState.RUNNING
    clock.advance(1.5)
    assert await run.wait() is Result.ON_ERROR
    assert code_of(run, "Limited_0") is FailureCode.TIMED_OUT


@pytest.mark.parametrize(("name", "how"), [("Plain", ["noticed"]), ("Stubborn", ["swallowed"])])
async def test_a_time_out_is_a_failure_however_the_action_ends(name: str, how: list[str]) -> None:
    run = started(name, WallClock())
    assert await run.wait() is Result.ON_ERROR
    assert code_of(run, f"{name}_0") is FailureCode.TIMED_OUT
    assert ended == how


async def test_a_thread_that_does_not_notice_is_left_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(node_run, "THREAD_GRACE_S", 0.05)
    run = started("Deaf", WallClock())
    assert await run.wait() is Result.ON_ERROR
    assert code_of(run, "Deaf_0") is FailureCode.TIMED_OUT


async def test_an_action_that_takes_its_time_out_for_nothing_has_failed_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(node_run, "DEAF_S", 0.05)
    released.clear()
    run = started("Numb", WallClock())
    assert await asyncio.wait_for(run.wait(), 5) is Result.ON_ERROR
    assert code_of(run, "Numb_0") is FailureCode.TIMED_OUT
    assert not run.idle
    released.set()
    await settle()
    assert run.idle


async def test_a_stop_during_a_limited_action_is_a_stop() -> None:
    clock = SimClock()
    run = started("Limited", clock)
    await settle()
    run.stop()
    assert await run.wait() is Result.ON_STOPPED


def test_what_a_robot_lacks_is_named_before_anything_runs() -> None:
    (problem,) = check(read_graph(graph("Grasp")), CATALOGUE.for_robot({"camera", "drive"}), actor="A")
    assert (problem.code, problem.path) == ("not_capable", "actions[0].name")
    assert "A has no arm, which Grasp needs" in problem.message
    assert check(read_graph(graph("Grasp")), CATALOGUE.for_robot({"camera", "arm"}), actor="A") == []
    assert check(read_graph(graph("Grasp")), CATALOGUE, actor="A") == []
