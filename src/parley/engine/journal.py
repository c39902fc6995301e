"""What ran, written down as it happens, so that after a crash it can be said what was interrupted.

One SQLite file holds each run of each graph: the graph as it was started and as it is now, every transition,
and each node's newest state with its outputs. Signs of progress are left out. Recording only puts a change on
a list; the list is written in batches in the file's own thread, the next batch while the last one is being
made durable. A crash loses at most the changes of the last few milliseconds.
"""

from __future__ import annotations

import asyncio
import functools
import json
import sqlite3
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

import structlog

from parley.clock import Clock
from parley.errors import GraphRefusedError, StoreError
from parley.memory.database import Database
from parley.messages.pvf import NATIVE_TYPES, Parameter
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import Graph, GraphState, Node, NodeState
from parley.umrf.transition import Transition

__all__ = ["KEPT_RUNS", "KEPT_TRANSITIONS", "Interrupted", "Journal"]

log = structlog.get_logger(__name__)

KEPT_RUNS: Final = 1000
"""Older runs are dropped."""
KEPT_TRANSITIONS: Final = 10_000
"""Of one run; a graph that goes in circles for days must not fill the disk."""
_TIDY_EVERY: Final = 100
"""Runs, and transitions of a run, between two looks for what is too old."""

_ENDED: Final = (GraphState.FINISHED.value, GraphState.STOPPED.value, GraphState.ERROR.value)
_ACTIVE: Final = frozenset(
    {NodeState.RUNNING, NodeState.PAUSE_REQUESTED, NodeState.PAUSED, NodeState.STOPPING}
)

_SCHEMA: Final = """
    CREATE TABLE IF NOT EXISTS run (
        id INTEGER PRIMARY KEY, actor TEXT NOT NULL, graph_name TEXT NOT NULL, state TEXT NOT NULL,
        started_unix_ms INTEGER NOT NULL, changed_unix_ms INTEGER NOT NULL,
        settled INTEGER NOT NULL DEFAULT 0, graph_started TEXT NOT NULL, graph_now TEXT NOT NULL
    );
    CREATE INDEX IF NOT EXISTS run_open ON run (actor) WHERE settled = 0;
    CREATE TABLE IF NOT EXISTS node (
        run INTEGER NOT NULL, node TEXT NOT NULL, state TEXT NOT NULL, outputs TEXT NOT NULL,
        PRIMARY KEY (run, node)
    ) WITHOUT ROWID;
    CREATE TABLE IF NOT EXISTS transition (
        run INTEGER NOT NULL, sequence INTEGER NOT NULL, kind TEXT NOT NULL, state TEXT NOT NULL,
        node TEXT NOT NULL, cause TEXT NOT NULL, result TEXT NOT NULL, outputs TEXT NOT NULL,
        message TEXT NOT NULL, robot_time_s REAL NOT NULL, unix_ms INTEGER NOT NULL,
        PRIMARY KEY (run, sequence)
    ) WITHOUT ROWID;
"""


@dataclass(frozen=True, slots=True)
class Interrupted:
    """A graph that was under way when its engine's process ended without a goodbye."""

    actor: str
    graph: Graph
    """As it was last, with the states its nodes had."""
    unix_ms: int
    """When something was last heard of it."""
    outputs: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """What finished nodes gave: full name -> flat name -> value."""

    @property
    def going_on(self) -> tuple[Node, ...]:
        """The nodes that were being carried out."""
        return tuple(node for node in self.graph.nodes if node.state in _ACTIVE)

    @property
    def remaining(self) -> tuple[Node, ...]:
        """What was not finished, that which was going on included, in the order of the graph."""
        return tuple(node for node in self.graph.nodes if node.state is not NodeState.FINISHED)

    @property
    def is_linear(self) -> bool:
        """Whether it is one step after the other, so that the rest of it is again a graph."""
        nodes = self.graph.nodes
        edges = [(node.ref, [child.node for child in node.children]) for node in nodes]
        return len(self.graph.entry) == 1 and all(
            children == ([nodes[index + 1].ref] if index + 1 < len(nodes) else [])
            for index, (_, children) in enumerate(edges)
        )


@dataclass(slots=True)
class _Batch:
    """What is still to be written."""

    begun: list[tuple[int, str, Graph, int]] = field(default_factory=list)
    changed: list[tuple[int, Graph]] = field(default_factory=list)
    told: list[tuple[int, Transition]] = field(default_factory=list)


class Journal:
    """See `open`. Recording never raises: a full disk is logged, and no reason for a robot to stop."""

    def __init__(
        self, database: Database, clock: Clock, interrupted: Sequence[Interrupted], last: int
    ) -> None:
        self.interrupted = tuple(interrupted)
        """What was under way when an earlier process was killed, oldest first."""
        self._database, self._clock = database, clock
        self._first = self._next = last + 1
        self._ids: weakref.WeakKeyDictionary[GraphRun, int] = weakref.WeakKeyDictionary()
        self._batch = _Batch()
        self._writer: asyncio.Task[None] | None = None
        self._broken = False

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """Open or create the journal; use as ``async with await Journal.open(...)``.

        Args:
            path: The file, or ``:memory:``.
            clock: For time stamps.

        Raises:
            StoreError: The file cannot be created, read or written.
        """
        database = await Database.open(path, prepare=_prepare, unix_ms=clock.unix_ms(), what="journal")
        try:
            interrupted, last = await database.run(_read)
        except BaseException:
            await database.close()
            raise
        return cls(database, clock, interrupted, last)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    def record(self, run: GraphRun, transition: Transition) -> None:
        """Note a transition of `run`; called on the loop, costs microseconds."""
        if transition.kind == "progress":
            return
        number = self._ids.get(run)
        if number is None:
            number = self._ids[run] = self._next
            self._next += 1
            self._batch.begun.append((number, run.actor, run.snapshot(), transition.unix_ms))
        elif transition.kind == "graph" and transition.cause == "modify":
            self._batch.changed.append((number, run.snapshot()))
        self._batch.told.append((number, transition))
        if self._writer is None:
            self._writer = asyncio.get_running_loop().create_task(self._write(), name="journal")

    async def flush(self) -> None:
        """Wait until everything recorded so far is durable."""
        while self._writer is not None:
            await asyncio.wait([self._writer])

    async def close(self) -> None:
        """Write what is left, note that nothing was interrupted, and close the file. Idempotent."""
        await self.flush()
        try:
            await self._database.run(_settle_all)
        except StoreError as error:
            log.error("journal not closed properly", reason=str(error))
        await self._database.close()

    async def _write(self) -> None:
        try:
            while self._batch.told:
                batch, self._batch = self._batch, _Batch()
                try:
                    await self._database.run(functools.partial(_write, batch=batch, first=self._first))
                    self._broken = False
                except StoreError as error:
                    if not self._broken:
                        log.error("journal cannot be written", reason=str(error))
                    self._broken = True
        finally:
            self._writer = None


# -- in the file's thread -----------------------------------------------------------------------------------


def _prepare(connection: sqlite3.Connection) -> None:
    connection.executescript(_SCHEMA)


def _write(connection: sqlite3.Connection, *, batch: _Batch, first: int) -> None:
    connection.execute("BEGIN IMMEDIATE")
    try:
        for begun in batch.begun:
            _write_begun(connection, *begun, first=first)
        for number, graph in batch.changed:
            text = write_graph(graph, faithful=True)
            connection.execute("UPDATE run SET graph_now = ? WHERE id = ?", (text, number))
        for number, transition in batch.told:
            _write_transition(connection, number, transition)
        if tidy := [number for number, *_ in batch.begun if number % _TIDY_EVERY == 0]:
            _drop_old(connection, tidy[-1])
        connection.execute("COMMIT")
    except BaseException:
        connection.execute("ROLLBACK")
        raise


def _write_begun(
    connection: sqlite3.Connection, number: int, actor: str, graph: Graph, unix_ms: int, *, first: int
) -> None:
    # Whoever begins something new has done with what an earlier process left.
    connection.execute(
        "UPDATE run SET settled = 1 WHERE settled = 0 AND actor = ? AND id < ?", (actor, first)
    )
    text = write_graph(graph, faithful=True)
    connection.execute(
        "INSERT INTO run VALUES (?, ?, ?, ?, ?, ?, 0, ?, ?)",
        (number, actor, graph.name, graph.state.value, unix_ms, unix_ms, text, text),
    )


def _drop_old(connection: sqlite3.Connection, newest: int) -> None:
    connection.execute("DELETE FROM run WHERE id <= ?", (newest - KEPT_RUNS,))
    for table in ("node", "transition"):
        connection.execute(f"DELETE FROM {table} WHERE run <= ?", (newest - KEPT_RUNS,))


def _write_transition(connection: sqlite3.Connection, number: int, told: Transition) -> None:
    outputs = _outputs(told.outputs)
    connection.execute(
        "INSERT INTO transition VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (
            number, told.sequence, told.kind, told.state, told.node, told.cause,
            told.result.value if told.result is not None else "", outputs, told.message, told.robot_time_s,
            told.unix_ms,
        ),
    )  # fmt: skip
    if told.kind == "graph":
        connection.execute(
            "UPDATE run SET state = ?, changed_unix_ms = ? WHERE id = ?", (told.state, told.unix_ms, number)
        )
    else:
        connection.execute(
            "INSERT INTO node VALUES (?, ?, ?, ?) ON CONFLICT DO UPDATE SET state = excluded.state,"
            " outputs = CASE excluded.outputs WHEN '{}' THEN outputs ELSE excluded.outputs END",
            (number, told.node, told.state, outputs),
        )
    if told.sequence % _TIDY_EVERY == 0 and told.sequence > KEPT_TRANSITIONS:
        connection.execute(
            "DELETE FROM transition WHERE run = ? AND sequence <= ?",
            (number, told.sequence - KEPT_TRANSITIONS),
        )


def _outputs(outputs: Mapping[str, Parameter]) -> str:
    values = {
        name: item.value for name, item in outputs.items() if item.has_data and item.type in NATIVE_TYPES
    }
    return json.dumps(values, ensure_ascii=False)


def _settle_all(connection: sqlite3.Connection) -> None:
    connection.execute("UPDATE run SET settled = 1 WHERE settled = 0")


def _read(connection: sqlite3.Connection) -> tuple[list[Interrupted], int]:
    """What was under way when the last process ended, and the number of the last run."""
    (last,) = connection.execute("SELECT coalesce(max(id), 0) FROM run").fetchone()
    marks = ", ".join("?" * len(_ENDED))
    rows = connection.execute(
        "SELECT id, actor, graph_name, state, changed_unix_ms, graph_now FROM run"
        f" WHERE settled = 0 AND state NOT IN ({marks}) ORDER BY id",
        _ENDED,
    ).fetchall()
    names = {(actor, name) for _, actor, name, *_ in rows}
    found = []
    for number, actor, name, state, unix_ms, text in rows:
        if any(own == actor and name.startswith(f"{outer}__") for own, outer in names):
            continue  # a graph inside of another, which is the one to go on with
        nodes = connection.execute(
            "SELECT node, state, outputs FROM node WHERE run = ?", (number,)
        ).fetchall()
        try:
            graph = _as_it_was(read_graph(text), state, {node: now for node, now, _ in nodes})
        except GraphRefusedError as error:
            log.error("journal entry skipped", graph=name, reason=str(error))
            continue
        outputs = {node: json.loads(given) for node, _, given in nodes if given != "{}"}
        if _was_interrupted(graph):
            found.append(Interrupted(actor, graph, unix_ms, outputs))
    return found, last


def _as_it_was(graph: Graph, state: str, states: Mapping[str, str]) -> Graph:
    nodes = tuple(
        replace(node, state=NodeState(states.get(node.full_name, NodeState.UNINITIALIZED.value)))
        for node in graph.nodes
    )
    return replace(graph, nodes=nodes, state=GraphState(state))


def _was_interrupted(graph: Graph) -> bool:
    """Whether something was still to come; one that ran dry is over unless it was being repaired."""
    states = {node.state for node in graph.nodes}
    if graph.state is GraphState.HALTED:
        return NodeState.ERROR in states
    return bool(states - {NodeState.FINISHED})
