"""How fast an engine runs chains of actions that do nothing, with one subscriber that checks every event."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.messages import topics
from parley.messages.ros import String, UmrfGraphStart
from parley.messages.status import GraphEvent
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import write_graph
from parley.umrf.model import ChildRelation, Graph, Node, NodeRef, ParentRelation

__all__ = ["ChainResult", "run_chain"]

PATIENCE_S = 300.0


async def _nothing(ctx: RunHandle) -> None:
    """Do nothing, on the loop."""


def _nothing_in_a_thread(ctx: RunHandle) -> None:
    """Do nothing, in a thread."""


@dataclass(frozen=True, slots=True)
class ChainResult:
    """One run of a chain."""

    actions: int
    kind: str
    """`async` or `threaded`."""
    wall_s: float
    """From publishing the start to the last event."""
    events: int
    gaps: int
    """Events that were missing or out of order; must be 0."""

    @property
    def actions_per_s(self) -> float:
        """Throughput."""
        return self.actions / self.wall_s


def _chain(length: int) -> Graph:
    refs = [NodeRef("Nothing", index) for index in range(length)]
    nodes = tuple(
        Node(
            name="Nothing",
            instance_id=index,
            parents=(ParentRelation(refs[index - 1]),) if index else (),
            children=(ChildRelation(refs[index + 1]),) if index + 1 < length else (),
        )
        for index in range(length)
    )
    return Graph("chain", nodes, (ChildRelation(refs[0]),), (ParentRelation(refs[-1]),))


async def run_chain(length: int, *, threaded: bool) -> ChainResult:
    """Run one chain on an engine of its own.

    Args:
        length: How many actions.
        threaded: Plain functions, which cross to threads, instead of async ones.

    Raises:
        TimeoutError: It did not end within 300 s.
    """
    spec = ActionSpec("Nothing", {}, {}, run=_nothing_in_a_thread if threaded else _nothing)
    sequences: list[int] = []
    done = asyncio.Event()

    def on_event(message: String) -> None:
        event = decode(GraphEvent, message.data)
        sequences.append(event.sequence)
        if event.kind == "graph" and event.state == "FINISHED":
            done.set()

    async with (
        LocalTransport() as transport,
        ActionEngine(
            "bench",
            transport=transport,
            catalogue=Catalogue([spec]),
            clock=WallClock(),
            make_context=lambda run: run,
        ),
    ):
        await transport.subscribe(topics.GRAPH_EVENTS, on_event)
        start = transport.publisher(topics.GRAPH_START)
        text = write_graph(_chain(length), faithful=True)
        began_s = time.perf_counter()
        start.publish(UmrfGraphStart(umrf_graph_json=text, targets=("bench",)))
        async with asyncio.timeout(PATIENCE_S):
            await done.wait()
        wall_s = time.perf_counter() - began_s
    gaps = sum(1 for index, sequence in enumerate(sequences) if index != sequence)
    return ChainResult(length, "threaded" if threaded else "async", wall_s, len(sequences), gaps)
