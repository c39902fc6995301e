"""Many actors under random commands, with everything they tell accounted for."""

from __future__ import annotations

import asyncio
import functools
import json
import os
import random
import resource
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.messages import ros, topics
from parley.messages.principal import person
from parley.messages.status import GraphEvent, Rejection, StopCommand
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport
from tests.umrf.spec_actions import CATALOGUE, chain, node, planner_chain

ACTORS: Final = 20
MARK: Final = "mark"
"""Actor of an event that says only that all events before it have come."""
GOING_ON: Final = 4
"""Graphs of one actor that go on at once."""
OVER: Final = {"FINISHED", "STOPPED", "ERROR", "HALTED"}
ACTIVE: Final = {"RUNNING", "PAUSE_REQUESTED", "PAUSED", "STOPPING"}
RESULTS: Final = ("on_true", "on_false", "on_stopped", "on_error")
RESPONSES: Final = ("run", "stop", "pause", "bypass", "ignore", "restart")


@dataclass
class Account:
    """What is known about one graph."""

    sequence: int = -1
    state: str = ""
    refused: bool = False
    active: set[str] = field(default_factory=set)
    """Nodes that are going on, which they may be beyond the end of their graph."""
    commanded: bool = False
    """Whether any command was sent for it after its start; if not, it cannot move once it is at rest."""

    @property
    def at_rest(self) -> bool:
        """Whether it is over, or dry, and nothing of it goes on."""
        return self.refused or (self.state in OVER and not self.active)


@dataclass
class Sample:
    """The process at one moment."""

    at_s: float
    rss_mb: float
    tasks: int
    threads: int
    files: int
    blocks: int
    """What Python has allocated."""


@dataclass
class Storm:
    """Sends random commands for some seconds and keeps the books."""

    seconds: float
    folder: Path
    seed: int = 1
    commands: Counter[str] = field(default_factory=Counter)
    ends: Counter[str] = field(default_factory=Counter)
    gaps: list[str] = field(default_factory=list)
    unaccounted: list[str] = field(default_factory=list)
    samples: list[Sample] = field(default_factory=list)
    events: int = 0
    handler_failures: int = 0

    def __post_init__(self) -> None:
        self._rng = random.Random(self.seed)
        self._open: dict[str, dict[str, Account]] = {f"R{index}": {} for index in range(ACTORS)}
        self._engines: dict[str, ActionEngine] = {}
        self._count = 0
        self._marks: deque[Callable[[], None]] = deque()

    async def run(self) -> None:
        """Blow, then calm down and look at what is left."""
        async with AsyncExitStack() as stack:
            transport = await stack.enter_async_context(LocalTransport())
            self._journal = await stack.enter_async_context(
                await Journal.open(self.folder / "journal.db", WallClock())
            )
            self._transport = transport
            await transport.subscribe(topics.GRAPH_EVENTS, self._on_event, depth=1_000_000)
            await transport.subscribe(topics.REJECTION, self._on_rejection, depth=1_000_000)
            self._ends = {
                topic.name: transport.publisher(topic)
                for topic in (
                    topics.GRAPH_START, topics.GRAPH_MODIFY, topics.GRAPH_PAUSE, topics.GRAPH_RESUME,
                    topics.GRAPH_STOP, topics.STOP, topics.GRAPH_EVENTS,
                )
            }  # fmt: skip
            for actor in self._open:
                await self._begin(actor)
            watch = asyncio.create_task(self._watch())
            await asyncio.gather(*(self._blow(actor) for actor in self._open))
            watch.cancel()
            await asyncio.wait([watch])
            await self._calm_down()
            for engine in self._engines.values():
                await engine.__aexit__(None, None, None)
            for actor in self._open:
                await self._close_books(actor)
            self.handler_failures = transport.handler_failures

    async def _begin(self, actor: str) -> None:
        engine = ActionEngine(
            actor,
            transport=self._transport,
            catalogue=CATALOGUE,
            clock=WallClock(),
            make_context=lambda handle: handle,
            journal=self._journal,
            stop_timeout_s=1.0,
        )
        self._engines[actor] = await engine.__aenter__()

    async def _blow(self, actor: str) -> None:
        end_s = time.monotonic() + self.seconds
        while time.monotonic() < end_s:
            command = self._rng.choices(
                ("start", "modify", "pause", "resume", "stop", "emergency", "restart"),
                (40, 15, 10, 15, 10, 2, 0.3),
            )[0]
            self.commands[command] += 1
            await getattr(self, f"_{command}")(actor)
            await asyncio.sleep(self._rng.expovariate(1 / 0.15))

    def _send(self, topic: Any, message: Any) -> None:
        self._ends[topic.name].publish(message)

    def _any(self, actor: str) -> str:
        names = list(self._open[actor])
        if not names:
            return "unknown"
        name = self._rng.choice(names)
        self._open[actor][name].commanded = True
        return name

    async def _start(self, actor: str) -> None:
        name = f"{actor}_{self._count}"
        self._count += 1
        going_on = [known for known, item in self._open[actor].items() if not item.at_rest]
        for known in going_on[:-GOING_ON]:  # so that a storm of any length reaches a steady state
            self._open[actor][known].commanded = True
            self._send(topics.GRAPH_STOP, ros.UmrfGraphStop(known, (actor,)))
        self._open[actor][name] = Account()
        self._send(topics.GRAPH_START, ros.UmrfGraphStart("", json.dumps(self._graph(name)), (actor,)))

    async def _modify(self, actor: str) -> None:
        graph = self._graph(self._any(actor))
        action = self._rng.choice(graph["actions"])
        where = self._rng.choice(["", f"{action['name']}_{action['instance_id']}"])
        message = ros.UmrfGraphModify(graph["graph_name"], (actor,), json.dumps(graph), where)
        self._send(topics.GRAPH_MODIFY, message)

    async def _pause(self, actor: str) -> None:
        self._send(topics.GRAPH_PAUSE, ros.UmrfGraphPause(self._any(actor), (actor,)))

    async def _resume(self, actor: str) -> None:
        self._send(topics.GRAPH_RESUME, ros.UmrfGraphResume(self._any(actor), (actor,)))

    async def _stop(self, actor: str) -> None:
        self._send(topics.GRAPH_STOP, ros.UmrfGraphStop(self._any(actor), (actor,)))

    async def _emergency(self, actor: str) -> None:
        self._send(topics.STOP, to_string(StopCommand(targets=(actor,))))
        await asyncio.sleep(0.05)
        self._send(topics.STOP, to_string(StopCommand(command="reset", targets=(actor,), by=person("Kim"))))

    async def _restart(self, actor: str) -> None:
        """The engine ends and another begins, as if its process had been started anew."""
        while any(  # noqa: ASYNC110
            not item.state and not item.refused for item in self._open[actor].values()
        ):
            await asyncio.sleep(0.01)  # what nobody has taken yet would be nobody's
        await self._engines.pop(actor).__aexit__(None, None, None)
        await self._close_books(actor)
        await self._begin(actor)

    def _graph(self, name: str) -> dict[str, Any]:
        rng = self._rng
        steps = [
            rng.choice(
                [
                    node("NoOp", index),
                    node("WaitFor", index, seconds=round(rng.uniform(0, 0.3), 3)),
                    node("Insist", index, seconds=0.05),
                    node("InThread", index, text="a"),
                    node("ThreadLoop", index),
                    node("Crash", index),
                    node("Leave", index),
                    node("Fail", index, reason="on purpose"),
                    node("SameText", index, text="a", expected="b"),
                    node("Chatter", index),
                ]
            )
            for index in range(rng.randint(1, 6))
        ]
        if rng.random() < 0.5:
            return planner_chain(name, steps)
        conditions = [f"{rng.choice(RESULTS)} -> {rng.choice(RESPONSES)}" for _ in range(rng.randint(0, 3))]
        return chain(name, steps, conditions=conditions)

    # -- the books --------------------------------------------------------------------------------------

    def _on_event(self, message: ros.String) -> None:
        event = decode(GraphEvent, message.data)
        if event.actor == MARK:
            self._marks.popleft()()
            return
        self.events += 1
        account = self._open[event.actor].get(event.graph_name)
        if account is None:
            self.gaps.append(f"{event.graph_name} told something after it had been closed: {event.state}")
            return
        if event.sequence != account.sequence + 1:
            self.gaps.append(f"{event.graph_name}: {event.sequence} after {account.sequence}")
        if account.at_rest and not account.commanded:
            self.gaps.append(f"{event.graph_name} went on by itself: {account.state}, then {event.state}")
        account.sequence = event.sequence
        if event.kind == "graph":
            account.state = event.state
        elif event.kind == "node" and event.state in ACTIVE:
            account.active.add(event.node)
        elif event.kind == "node":
            account.active.discard(event.node)

    def _on_rejection(self, message: ros.String) -> None:
        refusal = decode(Rejection, message.data)
        account = self._open.get(refusal.target, {}).get(refusal.graph_name)
        if account is not None and refusal.what == topics.GRAPH_START.name:
            account.refused = True

    async def _close_books(self, actor: str) -> None:
        """Count what has come to rest; what has not, although its engine is gone, is missing."""
        end_s = time.monotonic() + 5
        while (  # noqa: ASYNC110 - the last events are still on their way
            any(not item.at_rest for item in self._open[actor].values()) and time.monotonic() < end_s
        ):
            await asyncio.sleep(0.01)
        for name, account in self._open[actor].items():
            if account.at_rest:
                self.ends["refused" if account.refused else account.state] += 1
            else:
                going_on = f" with {sorted(account.active)}" if account.active else ""
                self.unaccounted.append(f"{name}: {account.state or 'never heard of'}{going_on}")
        self._open[actor].clear()

    async def _watch(self) -> None:
        """Sample the process, and close the books of what ended long ago so that they do not grow."""
        while True:
            await asyncio.sleep(min(5.0, self.seconds / 20))
            self.samples.append(sample())
            for actor, engine in self._engines.items():
                held = {run.name for run in engine.runs.all}
                gone = [
                    name
                    for name, item in self._open[actor].items()
                    if name not in held and (item.state or item.refused)
                ]
                self._marks.append(functools.partial(self._close, actor, gone))
                mark = GraphEvent(actor=MARK, graph_name="", sequence=0, kind="graph")
                self._send(topics.GRAPH_EVENTS, to_string(mark))

    def _close(self, actor: str, names: list[str]) -> None:
        """Close the books of graphs that their engine has forgotten, now that it is known what they told.

        What the engine does not know it can no longer do anything with; so they must be at rest, and whatever
        they tell from now on is a fault.
        """
        for name in names:
            account = self._open[actor].pop(name, None)
            if account is None:  # closed with its engine
                continue
            if not account.at_rest:
                self.unaccounted.append(f"{name}: forgotten as {account.state} with {sorted(account.active)}")
            self.ends["refused" if account.refused else account.state] += 1

    async def _calm_down(self) -> None:
        """Stop what still goes on; who has not come to rest after 15 s is found missing."""
        end_s = time.monotonic() + 15
        for actor in self._open:
            self._send(
                topics.STOP, to_string(StopCommand(command="reset", targets=(actor,), by=person("Kim")))
            )
        while (left := self._going_on()) and time.monotonic() < end_s:
            for actor, name in left:
                self._send(topics.GRAPH_STOP, ros.UmrfGraphStop(name, (actor,)))
            await asyncio.sleep(0.2)

    def _going_on(self) -> list[tuple[str, str]]:
        return [
            (actor, name)
            for actor, accounts in self._open.items()
            for name, account in accounts.items()
            if not account.refused and account.state not in OVER
        ]


def sample() -> Sample:
    """This process now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return Sample(
        at_s=time.monotonic(),
        rss_mb=pages * resource.getpagesize() / 2**20,
        tasks=len(asyncio.all_tasks()),
        threads=threading.active_count(),
        blocks=sys.getallocatedblocks(),
        files=len(os.listdir("/proc/self/fd")),  # noqa: PTH208 - a folder of the kernel
    )
