"""The journal's file: tables, writing one batch, reading what was left. Runs in the file's own thread.

The interpreter is shared with the loop, so as much as possible is left to SQLite: a batch becomes one JSON
text per table, and one statement puts all its rows in.
"""

from __future__ import annotations

import json
import sqlite3
from dataclasses import dataclass, field
from typing import Any, Final

import structlog

from parley.engine.interrupted import Interrupted
from parley.errors import GraphRefusedError
from parley.messages.pvf import fits_type
from parley.umrf.io import graph_to_json, read_graph
from parley.umrf.model import Graph, GraphState
from parley.umrf.saved import SavedRun
from parley.umrf.transition import Transition

__all__ = [
    "KEPT_RUNS",
    "KEPT_TRANSITIONS",
    "TIDY_EVERY",
    "Batch",
    "prepare",
    "read_left",
    "settle_all",
    "write",
]

log = structlog.get_logger(__name__)

KEPT_RUNS: Final = 1000
"""Older runs are dropped."""
KEPT_TRANSITIONS: Final = 10_000
"""Of one run; a graph that goes in circles for days must not fill the disk."""
TIDY_EVERY: Final = 100
"""Runs, and transitions of a run, between two looks for what is too old."""

_VERSION: Final = 2
_ENDED: Final = (GraphState.FINISHED.value, GraphState.STOPPED.value, GraphState.ERROR.value)

_Newest = dict[tuple[str, str], tuple[int, str]]
"""Actor and graph -> number and state of its newest run."""

_SCHEMA: Final = """
    CREATE TABLE IF NOT EXISTS run (
        id INTEGER PRIMARY KEY, actor TEXT NOT NULL, graph_name TEXT NOT NULL, state TEXT NOT NULL,
        started_unix_ms INTEGER NOT NULL, changed_unix_ms INTEGER NOT NULL,
        settled INTEGER NOT NULL DEFAULT 0, shared INTEGER NOT NULL DEFAULT 0,
        graph_started TEXT NOT NULL, graph_now TEXT NOT NULL, frame TEXT NOT NULL DEFAULT '{}'
    );
    CREATE INDEX IF NOT EXISTS run_open ON run (actor) WHERE settled = 0;
    CREATE TABLE IF NOT EXISTS node (
        run INTEGER NOT NULL, node TEXT NOT NULL, state TEXT NOT NULL, saved TEXT NOT NULL,
        PRIMARY KEY (run, node)
    ) WITHOUT ROWID;
    CREATE TABLE IF NOT EXISTS transition (
        run INTEGER NOT NULL, sequence INTEGER NOT NULL, kind TEXT NOT NULL, state TEXT NOT NULL,
        node TEXT NOT NULL, cause TEXT NOT NULL, result TEXT NOT NULL, outputs TEXT NOT NULL,
        message TEXT NOT NULL, robot_time_s REAL NOT NULL, unix_ms INTEGER NOT NULL,
        PRIMARY KEY (run, sequence)
    ) WITHOUT ROWID;
"""


def _columns(count: int) -> str:
    return ", ".join(f"json_extract(value, '$[{index}]')" for index in range(count))


_ADD_TRANSITIONS: Final = f"INSERT INTO transition SELECT {_columns(11)} FROM json_each(?)"
_ADD_NODES: Final = f"INSERT OR REPLACE INTO node SELECT {_columns(4)} FROM json_each(?)"


@dataclass(slots=True)
class Batch:
    """What is still to be written, by the number of the run."""

    begun: list[tuple[int, str, bool, Graph, int]] = field(default_factory=list)
    """Number, actor, whether others take part, graph, time."""
    modified: list[tuple[int, Graph]] = field(default_factory=list)
    told: list[tuple[int, Transition]] = field(default_factory=list)
    saved: list[tuple[int, dict[str, Any], list[tuple[str, dict[str, Any]]]]] = field(default_factory=list)
    """See `GraphRun.save`."""


def prepare(connection: sqlite3.Connection) -> None:
    """Bring the file to the form that is wanted; an older form could not be gone on with and is dropped."""
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if version != _VERSION:
        for table in ("run", "node", "transition"):
            connection.execute(f"DROP TABLE IF EXISTS {table}")
    connection.executescript(_SCHEMA)
    connection.execute(f"PRAGMA user_version = {_VERSION}")


def write(connection: sqlite3.Connection, *, batch: Batch, first: int) -> None:
    """Write a batch, all of it or nothing.

    Args:
        connection: To the file.
        batch: What has changed.
        first: The number of the first run of this process.
    """
    connection.execute("BEGIN IMMEDIATE")
    try:
        for begun in batch.begun:
            _write_begun(connection, *begun, first=first)
        for number, graph in batch.modified:
            connection.execute("UPDATE run SET graph_now = ? WHERE id = ?", (_text(graph), number))
        connection.execute(_ADD_TRANSITIONS, (json.dumps([_row(*told) for told in batch.told]),))
        _write_saved(connection, batch)
        _tidy(connection, batch)
        connection.execute("COMMIT")
    except BaseException:
        connection.execute("ROLLBACK")
        raise


def _text(graph: Graph) -> str:
    return json.dumps(graph_to_json(graph, faithful=True))


def _write_begun(
    connection: sqlite3.Connection,
    number: int,
    actor: str,
    shared: bool,
    graph: Graph,
    unix_ms: int,
    *,
    first: int,
) -> None:
    # Whoever begins something new has done with what an earlier process left.
    connection.execute(
        "UPDATE run SET settled = 1 WHERE settled = 0 AND actor = ? AND id < ?", (actor, first)
    )
    text = _text(graph)
    connection.execute(
        "INSERT INTO run (id, actor, graph_name, state, started_unix_ms, changed_unix_ms, shared,"
        " graph_started, graph_now) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (number, actor, graph.name, graph.state.value, unix_ms, unix_ms, shared, text, text),
    )


def _row(number: int, told: Transition) -> tuple[Any, ...]:
    outputs = told.outputs.items()
    values = {name: item.value for name, item in outputs if fits_type(item.type, item.value)}
    return (
        number, told.sequence, told.kind, told.state, told.node, told.cause, told.result or "",
        json.dumps(values) if values else "{}",
        told.message, told.robot_time_s, told.unix_ms,
    )  # fmt: skip


def _write_saved(connection: sqlite3.Connection, batch: Batch) -> None:
    changed = {number: told.unix_ms for number, told in batch.told}
    frames = [
        (frame["state"], json.dumps(frame), changed[number], number) for number, frame, _ in batch.saved
    ]
    connection.executemany("UPDATE run SET state = ?, frame = ?, changed_unix_ms = ? WHERE id = ?", frames)
    rows = [
        (number, name, kept["state"], json.dumps(kept))
        for number, _, nodes in batch.saved
        for name, kept in nodes
    ]
    connection.execute(_ADD_NODES, (json.dumps(rows),))


def _tidy(connection: sqlite3.Connection, batch: Batch) -> None:
    if newest := [number for number, *_ in batch.begun if number % TIDY_EVERY == 0]:
        oldest = newest[-1] - KEPT_RUNS
        connection.execute("DELETE FROM run WHERE id <= ?", (oldest,))
        for table in ("node", "transition"):
            connection.execute(f"DELETE FROM {table} WHERE run <= ?", (oldest,))
    for number, told in batch.told:
        if told.sequence % TIDY_EVERY == 0 and told.sequence > KEPT_TRANSITIONS:
            connection.execute(
                "DELETE FROM transition WHERE run = ? AND sequence <= ?",
                (number, told.sequence - KEPT_TRANSITIONS),
            )


def settle_all(connection: sqlite3.Connection) -> None:
    """Note that nothing was interrupted."""
    connection.execute("UPDATE run SET settled = 1 WHERE settled = 0")


def read_left(connection: sqlite3.Connection) -> tuple[list[Interrupted], int]:
    """What was under way when the last process ended, and the number of the last run."""
    (last,) = connection.execute("SELECT coalesce(max(id), 0) FROM run").fetchone()
    rows = connection.execute("SELECT actor, graph_name, id, state FROM run WHERE settled = 0 ORDER BY id")
    newest: dict[tuple[str, str], tuple[int, str]] = {}
    for actor, name, number, state in rows.fetchall():
        newest.pop((actor, name), None)  # of several runs of one name the last one counts
        newest[actor, name] = (number, state)
    found = []
    for (actor, name), (number, state) in newest.items():
        if state in _ENDED or _is_inner(actor, name, newest):
            continue
        try:
            item = _interrupted(connection, actor, number, newest)
        except GraphRefusedError as error:
            log.error("journal entry skipped", graph=name, reason=str(error))
            continue
        if item.is_open:
            found.append(item)
    return found, last


def _interrupted(connection: sqlite3.Connection, actor: str, number: int, newest: _Newest) -> Interrupted:
    (shared, unix_ms) = connection.execute(
        "SELECT shared, changed_unix_ms FROM run WHERE id = ?", (number,)
    ).fetchone()
    return Interrupted.of(actor, _saved(connection, actor, number, newest), unix_ms, shared=bool(shared))


def _saved(connection: sqlite3.Connection, actor: str, number: int, newest: _Newest) -> SavedRun:
    """A run with the sub-graphs that were going on in it.

    Raises:
        GraphRefusedError: Its graph cannot be read.
    """
    text, framed = connection.execute("SELECT graph_now, frame FROM run WHERE id = ?", (number,)).fetchone()
    nodes = connection.execute("SELECT node, saved FROM node WHERE run = ?", (number,)).fetchall()
    frame = json.loads(framed)
    inner = {
        name: _saved(connection, actor, newest[actor, name][0], newest)
        for name in frame["inner"]
        if (actor, name) in newest
    }
    return SavedRun(read_graph(text), frame, {node: json.loads(kept) for node, kept in nodes}, inner)


def _is_inner(actor: str, name: str, newest: _Newest) -> bool:
    """Whether it is a graph inside of another, which is the one to go on with; see `InnerRuns` for names."""
    outer, mark, rest = name.rpartition("__")
    outer = outer.rpartition("__")[0]
    return bool(mark) and rest.isdecimal() and (actor, outer) in newest
