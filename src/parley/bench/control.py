"""How soon a command reaches what it commands: from publishing the message to the action that notices."""

from __future__ import annotations

import asyncio
import gc
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from parley.bench.engine import chain, engine_with
from parley.messages import topics
from parley.messages.ros import (
    String,
    UmrfGraphModify,
    UmrfGraphPause,
    UmrfGraphResume,
    UmrfGraphStart,
    UmrfGraphStop,
)
from parley.messages.status import GraphEvent
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.io import write_graph
from parley.umrf.model import Graph

__all__ = ["COMMANDS", "Crowd", "measure_control", "measure_crowd"]

COMMANDS: Final = ("pause", "resume", "modify", "stop")
_LOOK_S: Final = 0.0005
"""How often a plain action looks up; part of what is measured."""
_TARGETS: Final = ("bench",)


@dataclass(eq=False)
class _Noticed:
    """When the action noticed what; set from the loop or from its thread."""

    loop: asyncio.AbstractEventLoop
    at_s: dict[str, float] = field(default_factory=dict)
    changed: asyncio.Event = field(default_factory=asyncio.Event)

    def note(self, what: str) -> None:
        self.at_s[what] = time.perf_counter()
        self.loop.call_soon_threadsafe(self.changed.set)

    async def until(self, what: str) -> float:
        async with asyncio.timeout(30):
            while what not in self.at_s:
                self.changed.clear()
                await self.changed.wait()
        return self.at_s[what]


def _work(noticed: _Noticed) -> Callable[[RunHandle], object]:
    async def work(run: RunHandle) -> None:
        noticed.note("begun")
        try:
            while not run.paused:  # noqa: ASYNC110 - there is nothing to wait for
                await asyncio.sleep(0)
            noticed.note("pause")
            await run.wait_while_paused()
            noticed.note("resume")
            await asyncio.sleep(60)
        except asyncio.CancelledError:
            noticed.note("stop")
            raise

    return work


def _work_in_a_thread(noticed: _Noticed) -> Callable[[RunHandle], object]:
    def wait(condition: Callable[[], bool]) -> None:
        while not condition():
            time.sleep(_LOOK_S)

    def work(run: RunHandle) -> None:
        noticed.note("begun")
        wait(lambda: run.paused)
        noticed.note("pause")
        wait(lambda: not run.paused)
        noticed.note("resume")
        wait(lambda: run.stop_requested)
        noticed.note("stop")

    return work


async def measure_control(times: int, *, threaded: bool) -> dict[str, list[float]]:
    """Milliseconds from each command's publication to its effect, by command.

    A pause, a resume and a stop have reached the action; a modify has changed the running graph and said so.

    Args:
        times: How often.
        threaded: Plain functions, which cross to threads, instead of async ones.

    Raises:
        TimeoutError: A command did not arrive within 30 s.
    """
    found: dict[str, list[float]] = {command: [] for command in COMMANDS}
    noticed = _Noticed(asyncio.get_running_loop())
    run = (_work_in_a_thread if threaded else _work)(noticed)
    async with engine_with(ActionSpec("Work", {}, {}, run=run)) as transport:

        def on_event(message: String) -> None:
            event = decode(GraphEvent, message.data)
            if event.kind == "graph":
                noticed.note("modify" if event.cause == "modify" else event.state)

        await transport.subscribe(topics.GRAPH_EVENTS, on_event)
        for index in range(times):
            noticed.at_s.clear()
            await _one(transport, noticed, f"g{index}", found)
    return found


async def _one(
    transport: LocalTransport, noticed: _Noticed, name: str, found: dict[str, list[float]]
) -> None:
    text = write_graph(chain(name, 1), faithful=True)
    longer = write_graph(chain(name, 2), faithful=True)
    transport.publisher(topics.GRAPH_START).publish(UmrfGraphStart("", text, _TARGETS))
    await noticed.until("begun")
    sends: dict[str, Callable[[], None]] = {
        "pause": lambda: transport.publisher(topics.GRAPH_PAUSE).publish(UmrfGraphPause(name, _TARGETS)),
        "resume": lambda: transport.publisher(topics.GRAPH_RESUME).publish(UmrfGraphResume(name, _TARGETS)),
        "modify": lambda: transport.publisher(topics.GRAPH_MODIFY).publish(
            UmrfGraphModify(name, _TARGETS, longer, "")
        ),
        "stop": lambda: transport.publisher(topics.GRAPH_STOP).publish(UmrfGraphStop(name, _TARGETS)),
    }
    for command in COMMANDS:
        began_s = time.perf_counter()
        sends[command]()
        found[command].append(1000 * (await noticed.until(command) - began_s))
    await noticed.until("STOPPED")


@dataclass(frozen=True, slots=True)
class Crowd:
    """Commands to one graph while the engine is busy with others."""

    pause_ms: list[float]
    """From publishing to the action, one per round."""
    stop_ms: list[float]
    longest_step_ms: list[float]
    """The longest time for which the loop did not turn, one per round."""
    longest_collection_ms: list[float]
    """The longest look of the garbage collector, one per round, part of some step; 0 if there was none."""


@dataclass(eq=False)
class _Turns:
    """Notes the longest time between two turns of the loop, and the garbage collector's longest look."""

    longest_s: float = 0.0
    longest_collection_s: float = 0.0
    _collection_began_s: float = 0.0
    _last_s: float = field(default_factory=time.perf_counter)
    _on: bool = True

    def turn(self) -> None:
        now_s = time.perf_counter()
        self.longest_s = max(self.longest_s, now_s - self._last_s)
        self._last_s = now_s
        if self._on:
            asyncio.get_running_loop().call_soon(self.turn)

    def start(self) -> None:
        gc.callbacks.append(self._collecting)
        self.turn()

    def stop(self) -> None:
        self._on = False
        gc.callbacks.remove(self._collecting)

    def _collecting(self, phase: str, _: dict[str, int]) -> None:
        now_s = time.perf_counter()
        if phase == "start":
            self._collection_began_s = now_s
        else:
            self.longest_collection_s = max(self.longest_collection_s, now_s - self._collection_began_s)


async def measure_crowd(others: Callable[[int], Sequence[Graph]], times: int) -> Crowd:
    """Pause and stop one graph while the engine takes up and runs others.

    Both commands are published right after the others' starts; what is measured is when the action notices.

    Args:
        others: The graphs of a round (from 0), made of actions `Work`, with names never used before.
        times: How many rounds.

    Raises:
        TimeoutError: A command did not arrive within 30 s.
    """
    noticed = _Noticed(asyncio.get_running_loop())
    found = Crowd([], [], [], [])
    rest = asyncio.Event()

    async def watched(run: RunHandle) -> None:
        noticed.note("begun")
        try:
            while not run.paused:  # noqa: ASYNC110 - there is nothing to wait for
                await asyncio.sleep(0)
            noticed.note("pause")
            await asyncio.sleep(60)
        except asyncio.CancelledError:
            noticed.note("stop")
            raise

    async def work(run: RunHandle) -> None:
        return None

    specs = ActionSpec("Work", {}, {}, run=work), ActionSpec("Watched", {}, {}, run=watched)
    async with engine_with(*specs) as transport:
        over: set[str] = set()
        wanted: set[str] = set()

        def on_event(message: String) -> None:
            event = decode(GraphEvent, message.data)
            if event.kind == "graph" and event.state in ("FINISHED", "STOPPED"):
                over.add(event.graph_name)
                if over >= wanted:
                    rest.set()

        await transport.subscribe(topics.GRAPH_EVENTS, on_event, depth=1_000_000)
        start = transport.publisher(topics.GRAPH_START)
        pause, stop = transport.publisher(topics.GRAPH_PAUSE), transport.publisher(topics.GRAPH_STOP)
        for index in range(times):
            name = f"watched{index}"
            graph = chain(name, 1, action="Watched")
            texts = [write_graph(item, faithful=True) for item in others(index)]
            wanted = {name, *(item.name for item in others(index))}
            noticed.at_s.clear()
            rest.clear()
            start.publish(UmrfGraphStart("", write_graph(graph, faithful=True), _TARGETS))
            await noticed.until("begun")
            turns = _Turns()
            turns.start()
            for text in texts:
                start.publish(UmrfGraphStart("", text, _TARGETS))
            began_s = time.perf_counter()
            pause.publish(UmrfGraphPause(name, _TARGETS))
            found.pause_ms.append(1000 * (await noticed.until("pause") - began_s))
            began_s = time.perf_counter()
            stop.publish(UmrfGraphStop(name, _TARGETS))
            found.stop_ms.append(1000 * (await noticed.until("stop") - began_s))
            async with asyncio.timeout(30):
                await rest.wait()
            turns.stop()
            found.longest_step_ms.append(1000 * turns.longest_s)
            found.longest_collection_ms.append(1000 * turns.longest_collection_s)
    return found
