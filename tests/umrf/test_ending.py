"""Ending many actions, and such as do not want to end."""

from __future__ import annotations

import asyncio
import threading
import time
from typing import Any

import pytest

from parley.bench.engine import fan_out
from parley.clock import WallClock
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import GraphRun
from parley.umrf.model import GraphState, NodeState, Result
from parley.umrf.slices import SLICE


def fan(width: int, run: Any) -> GraphRun:
    """One action, then `width` at once, all of them `run`."""
    catalogue = Catalogue([ActionSpec("Work", {}, {}, run=run)])
    return GraphRun(
        fan_out("g", width), catalogue, actor="A", clock=WallClock(), make_context=lambda handle: handle,
        stop_timeout_s=0.05,
    )  # fmt: skip


async def until_running(run: GraphRun, count: int) -> None:
    async with asyncio.timeout(20):
        while sum(node.state is NodeState.RUNNING for node in run.snapshot().nodes) < count:  # noqa: ASYNC110
            await asyncio.sleep(0.05)


@pytest.mark.soak
async def test_stopping_four_thousand_actions_is_linear() -> None:
    async def wait(handle: RunHandle) -> None:
        if handle.node != "Work_0":
            await asyncio.Event().wait()

    run = fan(4000, wait)
    run._stop_timeout_s = 30.0
    run.start()
    await until_running(run, 4000)
    began_s = time.process_time()
    run.stop()
    assert await run.wait() is Result.ON_STOPPED
    assert time.process_time() - began_s < 0.6, "it took 1.1 s when each end looked at all the others"


async def test_stopping_many_lets_others_have_their_turn() -> None:
    async def wait(handle: RunHandle) -> None:
        if handle.node != "Work_0":
            await asyncio.Event().wait()

    run = fan(SLICE + 1, wait)
    run.start()
    await until_running(run, SLICE + 1)
    run.stop()
    states = [node.state for node in run.snapshot().nodes]
    assert (states.count(NodeState.STOPPING), states.count(NodeState.RUNNING)) == (SLICE, 1)
    assert await run.wait() is Result.ON_STOPPED


def test_an_action_that_will_not_end_does_not_keep_the_process_from_ending() -> None:
    async def deaf(_: RunHandle) -> None:
        while True:
            try:
                await asyncio.Event().wait()
            except asyncio.CancelledError:
                continue

    async def main() -> None:
        run = fan(1, deaf)
        run.start()
        await until_running(run, 1)
        await run.close()

    thread = threading.Thread(target=lambda: asyncio.run(main()), daemon=True)
    thread.start()
    thread.join(10)
    assert not thread.is_alive()


async def raise_it(_: RunHandle) -> None:
    raise KeyboardInterrupt


def raise_it_in_a_thread(_: RunHandle) -> None:
    raise KeyboardInterrupt


@pytest.mark.parametrize("work", [raise_it, raise_it_in_a_thread])
async def test_a_keyboard_interrupt_of_an_action_fails_that_action_only(work: Any) -> None:
    run = fan(1, work)
    run.start()
    await run.wait()
    first = run.snapshot().nodes[0]
    assert (first.state, run.state) == (NodeState.ERROR, GraphState.FINISHED)
