"""How fast an engine is: whole graphs, with one subscriber that checks every event and reads all feedback."""

from __future__ import annotations

import asyncio
import json
import resource
import tempfile
import time
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.messages import topics
from parley.messages.ros import String, UmrfGraphFeedback, UmrfGraphStart
from parley.messages.status import GraphEvent
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import write_graph
from parley.umrf.model import ChildRelation, Graph, Node, NodeRef, ParentRelation

__all__ = [
    "Figures",
    "Listener",
    "chain",
    "engine_with",
    "fan_out",
    "run_chain",
    "run_graphs",
    "run_journaled",
    "share",
]

PATIENCE_S: Final = 300.0
_OVER: Final = ("FINISHED", "HALTED", "STOPPED", "ERROR")


@dataclass(frozen=True, slots=True)
class Figures:
    """One run of one or more graphs."""

    actions: int
    kind: str
    """`async` or `threaded`."""
    wall_s: float
    """From publishing the first start to the last event."""
    cpu_s: float
    """Of the whole process in that time; other work on the machine changes it less than `wall_s`."""
    events: int
    gaps: int
    """Events that were missing or out of order; must be 0."""
    event_ms: tuple[float, ...] = ()
    """From the end of each action to its event's arrival."""
    feedback_ms: tuple[float, ...] = ()
    """From the end of each action to the first whole graph that shows it."""
    rss_mb: float = 0.0
    """Peak of the process so far."""

    @property
    def actions_per_s(self) -> float:
        """Throughput."""
        return self.actions / self.wall_s

    @property
    def cpu_us_per_action(self) -> float:
        """What an action costs, the reading of its events included."""
        return 1e6 * self.cpu_s / self.actions


@dataclass(eq=False)
class Listener:
    """The subscriber: counts what is missing and notes when things arrived."""

    wanted: int
    """Graphs whose end is waited for."""
    ended_s: dict[str, float] = field(default_factory=dict)
    """When each action returned: ``graph/node`` -> time."""
    events: int = 0
    gaps: int = 0
    event_ms: list[float] = field(default_factory=list)
    feedback_ms: list[float] = field(default_factory=list)
    done: asyncio.Event = field(default_factory=asyncio.Event)
    _next: dict[str, int] = field(default_factory=dict)
    _shown: set[str] = field(default_factory=set)
    _over: set[str] = field(default_factory=set)

    def on_event(self, message: String) -> None:
        """One transition."""
        now_s = time.perf_counter()
        event = decode(GraphEvent, message.data)
        self.events += 1
        self.gaps += event.sequence != self._next.get(event.graph_name, 0)
        self._next[event.graph_name] = event.sequence + 1
        if event.kind == "node" and event.state == "FINISHED":
            began_s = self.ended_s.get(f"{event.graph_name}/{event.node}")
            if began_s is not None:
                self.event_ms.append(1000 * (now_s - began_s))
        elif event.kind == "graph" and event.state in _OVER:
            self._over.add(event.graph_name)
            if len(self._over) == self.wanted:
                self.done.set()

    def on_feedback(self, message: UmrfGraphFeedback) -> None:
        """One whole graph."""
        now_s = time.perf_counter()
        for text in message.history:
            graph = json.loads(text)
            for node in graph["actions"]:
                name = f"{graph['graph_name']}/{node['name']}_{node['instance_id']}"
                if node["state"] == "FINISHED" and name not in self._shown and name in self.ended_s:
                    self._shown.add(name)
                    self.feedback_ms.append(1000 * (now_s - self.ended_s[name]))


def chain(name: str, length: int, action: str = "Work") -> Graph:
    """One action after the other."""
    refs = [NodeRef(action, index) for index in range(length)]
    nodes = tuple(
        Node(
            name=action,
            instance_id=index,
            parents=(ParentRelation(refs[index - 1]),) if index else (),
            children=(ChildRelation(refs[index + 1]),) if index + 1 < length else (),
        )
        for index in range(length)
    )
    return Graph(name, nodes, (ChildRelation(refs[0]),), (ParentRelation(refs[-1]),))


def fan_out(name: str, width: int) -> Graph:
    """One action, then `width` at once, then one that waits for all."""
    refs = [NodeRef("Work", index) for index in range(width + 2)]
    first, last, middle = refs[0], refs[-1], refs[1:-1]
    nodes = (
        Node(name="Work", instance_id=0, children=tuple(ChildRelation(ref) for ref in middle)),
        *(
            Node(
                name="Work",
                instance_id=ref.instance_id,
                parents=(ParentRelation(first),),
                children=(ChildRelation(last),),
            )
            for ref in middle
        ),
        Node(name="Work", instance_id=last.instance_id, parents=tuple(ParentRelation(ref) for ref in middle)),
    )
    return Graph(name, nodes, (ChildRelation(first),), (ParentRelation(last),))


@asynccontextmanager
async def engine_with(*specs: ActionSpec, journal: Journal | None = None) -> AsyncIterator[LocalTransport]:
    """A transport with an engine named `bench` that can do `specs`."""
    async with (
        LocalTransport() as transport,
        ActionEngine(
            "bench",
            transport=transport,
            catalogue=Catalogue(specs),
            clock=WallClock(),
            make_context=lambda run: run,
            journal=journal,
        ),
    ):
        yield transport


async def run_graphs(
    graphs: Sequence[Graph],
    *,
    threaded: bool,
    seconds: float = 0.0,
    feedback: bool = False,
    journal: Journal | None = None,
) -> Figures:
    """Run all graphs at once on an engine of its own.

    Args:
        graphs: Made of actions `Work`, with different names.
        threaded: Plain functions, which cross to threads, instead of async ones.
        seconds: What each action takes.
        feedback: Read the whole graphs too, and measure how late they are.
        journal: Write down what runs, as a system does.

    Raises:
        TimeoutError: They did not end within 300 s.
    """
    listener = Listener(len(graphs))

    def ended(run: RunHandle) -> None:
        if feedback:
            listener.ended_s[f"{run.graph_name}/{run.node}"] = time.perf_counter()

    async def work(run: RunHandle) -> None:
        if seconds:
            await asyncio.sleep(seconds)
        ended(run)

    def work_in_a_thread(run: RunHandle) -> None:
        if seconds:
            time.sleep(seconds)
        ended(run)

    spec = ActionSpec("Work", {}, {}, run=work_in_a_thread if threaded else work)
    async with engine_with(spec, journal=journal) as transport:
        await transport.subscribe(topics.GRAPH_EVENTS, listener.on_event, depth=1_000_000)
        if feedback:
            await transport.subscribe(topics.GRAPH_FEEDBACK, listener.on_feedback)
        start = transport.publisher(topics.GRAPH_START)
        texts = [write_graph(graph, faithful=True) for graph in graphs]
        began_s, began_cpu_s = time.perf_counter(), time.process_time()
        for text in texts:
            start.publish(UmrfGraphStart(umrf_graph_json=text, targets=("bench",)))
        async with asyncio.timeout(PATIENCE_S):
            await listener.done.wait()
        wall_s, cpu_s = time.perf_counter() - began_s, time.process_time() - began_cpu_s
        if feedback:
            await asyncio.sleep(0.1)  # the last whole graph may come an interval later
    return Figures(
        actions=sum(len(graph.nodes) for graph in graphs),
        kind="threaded" if threaded else "async",
        wall_s=wall_s,
        cpu_s=cpu_s,
        events=listener.events,
        gaps=listener.gaps,
        event_ms=tuple(listener.event_ms),
        feedback_ms=tuple(listener.feedback_ms),
        rss_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    )


async def run_chain(length: int, *, threaded: bool) -> Figures:
    """Run one chain of actions that do nothing; see `run_graphs`."""
    return await run_graphs([chain("chain", length)], threaded=threaded)


async def run_journaled(length: int, *, threaded: bool) -> Figures:
    """As `run_chain`, with a journal in a file of its own."""
    with tempfile.TemporaryDirectory() as folder:
        async with await Journal.open(Path(folder) / "journal.db", WallClock()) as journal:
            return await run_graphs([chain("chain", length)], threaded=threaded, journal=journal)


def share(values: Sequence[float], part: float) -> float:
    """The value below which `part` of `values` lies; 0.5 is the median."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))]
