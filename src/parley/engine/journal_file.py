"""The journal's file: tables, writing one batch, reading what was left. Runs in the file's own thread.

The interpreter is shared with the loop, so as little as possible is done in it: the nodes of a batch become
one JSON text that SQLite takes apart itself.
"""

from __future__ import annotations

import json
import sqlite3
from dataclasses import dataclass, field
from typing import Any, Final

import structlog
from pydantic_core import to_json

from parley.engine.interrupted import Interrupted
from parley.errors import GraphRefusedError
from parley.umrf.io import graph_to_json, read_graph
from parley.umrf.model import Graph, GraphState
from parley.umrf.saved import SavedRun

__all__ = [
    "KEPT_RUNS",
    "TIDY_EVERY",
    "VERSION",
    "Batch",
    "GraphText",
    "prepare",
    "read_left",
    "write",
]

log = structlog.get_logger(__name__)

KEPT_RUNS: Final = 1000
"""Older runs are dropped."""
TIDY_EVERY: Final = 100
"""Runs between two looks for what is too old."""

VERSION: Final = 4
"""Of the form of the file; one of another form is put aside, see `journal_older`."""
_ENDED: Final = (GraphState.FINISHED.value, GraphState.STOPPED.value, GraphState.ERROR.value)

_Newest = dict[tuple[str, str], tuple[int, bool]]
"""Actor and graph -> number of its newest run, and whether it ended or is gone on with inside of another."""

_SCHEMA: Final = """
    CREATE TABLE IF NOT EXISTS run (
        id INTEGER PRIMARY KEY, actor TEXT NOT NULL, graph_name TEXT NOT NULL,
        outer TEXT NOT NULL, state TEXT NOT NULL,
        started_unix_ms INTEGER NOT NULL, changed_unix_ms INTEGER NOT NULL,
        settled INTEGER NOT NULL DEFAULT 0, shared INTEGER NOT NULL DEFAULT 0,
        graph_started TEXT NOT NULL, graph_now TEXT, frame TEXT NOT NULL DEFAULT '{}'
    );
    CREATE INDEX IF NOT EXISTS run_open ON run (actor) WHERE settled = 0;
    CREATE TABLE IF NOT EXISTS node (
        run INTEGER NOT NULL, node TEXT NOT NULL, state TEXT NOT NULL, saved TEXT NOT NULL,
        PRIMARY KEY (run, node)
    ) WITHOUT ROWID;
"""

_ADD_NODES: Final = """
    INSERT OR REPLACE INTO node
    SELECT json_extract(value, '$[0]'), json_extract(value, '$[1]'), json_extract(value, '$[2].state'),
        json_extract(value, '$[2]')
    FROM json_each(?)
"""


@dataclass(frozen=True, slots=True)
class GraphText:
    """A graph that need not be written, as there is the text that it was read from."""

    name: str
    text: str


@dataclass(slots=True)
class Batch:
    """What is still to be written, by the number of the run."""

    begun: list[tuple[int, str, str, bool, Graph | GraphText, int]] = field(default_factory=list)
    """Number, actor, graph inside of which it runs, whether others take part, graph, time."""
    modified: list[tuple[int, Graph]] = field(default_factory=list)
    saved: list[tuple[int, int, dict[str, Any], list[tuple[str, dict[str, Any]]]]] = field(
        default_factory=list
    )
    """Number, time, and what `GraphRun.save` gave."""
    given_up: list[str] = field(default_factory=list)
    """Actors of whom nobody goes on with what an earlier process left."""


def prepare(connection: sqlite3.Connection) -> None:
    """Bring the file to the form that is wanted; an older form could not be gone on with and is dropped."""
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if version != VERSION:
        old = connection.execute(
            "SELECT type, name FROM sqlite_master WHERE name IN ('run', 'node', 'told', 'transition')"
        )
        for kind, name in old.fetchall():
            connection.execute(f"DROP {kind} {name}")
    connection.executescript(_SCHEMA)
    connection.execute(f"PRAGMA user_version = {VERSION}")


def write(connection: sqlite3.Connection, *, batch: Batch, first: int) -> None:
    """Write a batch, all of it or nothing.

    Args:
        connection: To the file.
        batch: What has changed.
        first: The number of the first run of this process.
    """
    connection.execute("BEGIN IMMEDIATE")
    try:
        for actor in batch.given_up:
            _settle(connection, actor, first)
        for begun in batch.begun:
            _write_begun(connection, *begun, first=first)
        for number, graph in batch.modified:
            connection.execute("UPDATE run SET graph_now = ? WHERE id = ?", (_text(graph), number))
        _write_saved(connection, batch)
        _tidy(connection, batch)
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:  # a full disk has rolled back by itself; its own words must be heard
            connection.execute("ROLLBACK")
        raise


def _text(graph: Graph | GraphText) -> str:
    return graph.text if isinstance(graph, GraphText) else _json(graph_to_json(graph))


def _json(value: Any) -> str:
    try:
        return to_json(value).decode()
    except ValueError:  # half a character in it, which can only be written as an escape
        return json.dumps(value)


def _write_begun(
    connection: sqlite3.Connection,
    number: int,
    actor: str,
    outer: str,
    shared: bool,
    graph: Graph | GraphText,
    unix_ms: int,
    *,
    first: int,
) -> None:
    # Whoever begins something new has done with what an earlier process left.
    _settle(connection, actor, first)
    connection.execute(
        "INSERT INTO run (id, actor, graph_name, outer, state, started_unix_ms, changed_unix_ms, shared,"
        " graph_started) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (number, actor, graph.name, outer, GraphState.RUNNING.value, unix_ms, unix_ms, shared, _text(graph)),
    )


def _write_saved(connection: sqlite3.Connection, batch: Batch) -> None:
    frames = [(frame["state"], _json(frame), unix_ms, number) for number, unix_ms, frame, _ in batch.saved]
    connection.executemany("UPDATE run SET state = ?, frame = ?, changed_unix_ms = ? WHERE id = ?", frames)
    rows = [(number, name, kept) for number, _, _, nodes in batch.saved for name, kept in nodes]
    connection.execute(_ADD_NODES, (_json(rows),))


def _tidy(connection: sqlite3.Connection, batch: Batch) -> None:
    if newest := [number for number, *_ in batch.begun if number % TIDY_EVERY == 0]:
        oldest = newest[-1] - KEPT_RUNS
        connection.execute("DELETE FROM run WHERE id <= ?", (oldest,))
        connection.execute("DELETE FROM node WHERE run <= ?", (oldest,))


def _settle(connection: sqlite3.Connection, actor: str, first: int) -> None:
    """Note that nobody goes on with what an earlier process left of `actor`."""
    connection.execute(
        "UPDATE run SET settled = 1 WHERE settled = 0 AND actor = ? AND id < ?", (actor, first)
    )


def read_left(connection: sqlite3.Connection) -> tuple[list[Interrupted], int]:
    """What was under way when earlier processes ended, and the number of the last run."""
    (last,) = connection.execute("SELECT coalesce(max(id), 0) FROM run").fetchone()
    rows = connection.execute(
        "SELECT actor, graph_name, id, state IN (?, ?, ?) OR outer != ''"
        " FROM run WHERE settled = 0 ORDER BY id",
        _ENDED,
    )
    newest: _Newest = {}
    for actor, name, number, passed in rows.fetchall():
        newest.pop((actor, name), None)  # of several runs of one name the last one counts
        newest[actor, name] = (number, bool(passed))
    found = []
    for (actor, name), (number, passed) in newest.items():
        if passed:
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
    text, framed = connection.execute(
        "SELECT coalesce(graph_now, graph_started), frame FROM run WHERE id = ?", (number,)
    ).fetchone()
    nodes = connection.execute("SELECT node, saved FROM node WHERE run = ?", (number,)).fetchall()
    frame = json.loads(framed)
    inner = {
        name: _saved(connection, actor, newest[actor, name][0], newest)
        for name in frame["inner"]
        if (actor, name) in newest
    }
    return SavedRun(read_graph(text), frame, {node: json.loads(kept) for node, kept in nodes}, inner)
