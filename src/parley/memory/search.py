"""Asking the full-text index, with the cost of a search bounded whatever is asked for.

A plain "any of these words, best first" visits every memory that holds any of them. Here each word is asked
for its newest memories only, and the older ones with common words are looked up just where they can still
matter (`_complete`).
"""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence

from parley.memory.retrieval import Hits, final_order, fts_phrase, query_terms, scores, worth_completing
from parley.memory.rows import COLUMNS, read_entry
from parley.messages.memory import MemoryEntry

__all__ = ["search_words"]

_PER_TERM = 300
"""How many memories, the newest, are considered per term."""

Term = tuple[str, ...]


def search_words(
    db: sqlite3.Connection, query: str, *, limit: int, scope: str | None = None
) -> list[MemoryEntry]:
    """The current memories that share telling words with `query`, best first."""
    hits = {term: hit for term in query_terms(query) if (hit := _hits(db, term, scope)).ids}
    if not hits:
        return []
    newest_id = max(hit.ids[0] for hit in hits.values())
    weights = {term: hit.weight(newest_id) for term, hit in hits.items()}
    found = {term: set(hit.ids) for term, hit in hits.items()}
    rare = [term for term, hit in hits.items() if hit.complete]
    _complete(db, found, rare, worth_completing(hits, weights), scope)
    score = scores(found, weights)
    ranked = sorted(score, key=lambda identity: (score[identity], identity), reverse=True)
    entries = _by_id(db, ranked[: limit * 4])
    return final_order([(identity, score[identity], entry) for identity, entry in entries], weights)[:limit]


def _hits(db: sqlite3.Connection, term: Term, scope: str | None) -> Hits:
    """The newest memories with `term`; for a word nobody used, those with a longer word of that beginning."""
    ids = _match(db, fts_phrase(term), scope)
    if not ids and len(term) == 1 and len(term[0]) >= 4:
        ids = _match(db, fts_phrase(term) + " *", scope)
    return Hits(tuple(ids), complete=len(ids) < _PER_TERM)


def _complete(
    db: sqlite3.Connection,
    found: dict[Term, set[int]],
    rare: Sequence[Term],
    common: Sequence[Term],
    scope: str | None,
) -> None:
    """Add the older memories with common words that can still matter.

    That is where a common word stands beside a rare one, or common words stand together.
    """
    beside_rare = " OR ".join(fts_phrase(term) for term in rare)
    together: list[Term] = []
    for term in common:
        if rare:
            found[term].update(_match(db, f"({beside_rare}) AND {fts_phrase(term)}", scope))
        joined = [*together, term]
        ids = _match(db, " AND ".join(fts_phrase(part) for part in joined), scope) if together else []
        for part in joined if ids else ():
            found[part].update(ids)
        if ids or not together:
            together = joined


def _match(db: sqlite3.Connection, expression: str, scope: str | None) -> list[int]:
    """Ids of the newest memories that an FTS5 expression matches."""
    rows = db.execute(
        "SELECT s.rowid FROM memory_search s JOIN memory m ON m.id = s.rowid"
        " WHERE memory_search MATCH :expression AND (:scope IS NULL OR m.scope IN ('', :scope))"
        " ORDER BY s.rowid DESC LIMIT :limit",
        {"expression": expression, "scope": scope, "limit": _PER_TERM},
    )
    return [identity for (identity,) in rows]


def _by_id(db: sqlite3.Connection, ids: Sequence[int]) -> list[tuple[int, MemoryEntry]]:
    marks = ", ".join("?" * len(ids))
    rows = db.execute(f"SELECT id, {COLUMNS} FROM memory WHERE id IN ({marks})", tuple(ids))
    return [(row[0], read_entry(row[1:])) for row in rows]
