"""Threads of plain actions: as many as there is work, and used again."""

from __future__ import annotations

import asyncio
import queue
import threading
from typing import Any

import pytest

from parley.umrf import threads as room
from parley.umrf.threads import in_thread


async def test_a_thread_that_is_free_is_used_again_and_is_called_after_its_work() -> None:
    def look() -> tuple[threading.Thread, str]:
        return threading.current_thread(), threading.current_thread().name

    first, _ = await in_thread("one", look)
    assert await in_thread("two", look) == (first, "two")


async def test_work_that_hangs_holds_up_nothing_and_its_thread_comes_back() -> None:
    free = threading.Event()
    hung = asyncio.create_task(in_thread("hung", lambda: (free.wait(5), threading.current_thread())[1]))
    abandoned = asyncio.create_task(in_thread("abandoned", free.wait, 5))
    await asyncio.sleep(0)
    abandoned.cancel()
    others = {await in_thread("other", threading.current_thread) for _ in range(3)}
    free.set()
    assert await hung not in others
    await asyncio.gather(abandoned, return_exceptions=True)
    assert abandoned.cancelled()


async def test_what_returns_while_the_loop_is_busy_wakes_it_once(monkeypatch: pytest.MonkeyPatch) -> None:
    loop, free, woken = asyncio.get_running_loop(), threading.Event(), queue.SimpleQueue[object]()
    wake = loop.call_soon_threadsafe

    def note(*args: Any) -> asyncio.Handle:
        woken.put(args)
        return wake(*args)

    monkeypatch.setattr(loop, "call_soon_threadsafe", note)
    busy = [asyncio.create_task(in_thread("busy", free.wait, 5)) for _ in range(5)]
    await asyncio.sleep(0)
    free.set()
    while len(room._returns[loop]._settle) < 5:  # the loop does nothing else meanwhile
        threading.Event().wait(0.001)
    assert await asyncio.gather(*busy) == [True] * 5
    assert woken.qsize() == 1


def test_a_thread_outlives_the_loop_it_worked_for() -> None:
    free, over = threading.Event(), threading.Event()

    def work() -> None:
        free.wait(5)
        over.set()

    async def abandon() -> None:
        task = asyncio.create_task(in_thread("hung", work))
        await asyncio.sleep(0.01)
        task.cancel()

    asyncio.run(abandon())
    free.set()
    assert over.wait(5)
    for _ in range(3):
        asyncio.run(asyncio.wait_for(in_thread("next", lambda: None), 5))


async def test_threads_without_work_end_after_a_while(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "KEPT_S", 0.01)
    monkeypatch.setattr(room, "_idle", [])
    thread = await in_thread("short", threading.current_thread)
    await asyncio.to_thread(thread.join, 5)
    assert not thread.is_alive()
    assert await in_thread("next", threading.current_thread) is not thread
