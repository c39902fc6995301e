"""Asking the full-text index, with the cost of a search bounded whatever is asked for.

A plain "any of these words, best first" visits every memory that holds any of them. Here each word is asked
for its newest memories only, and the older ones with common words are looked up just where they can still
matter: beside a rare word, and together.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence

from parley.memory.retrieval import Hits, common_terms, final_order, fts_phrase, query_terms, scores, telling
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
    common = common_terms(hits, weights)
    _find_beside_rare(db, found, [term for term, hit in hits.items() if hit.complete], common, scope)
    _find_together(db, found, telling(common, weights), scope)
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


def _find_beside_rare(
    db: sqlite3.Connection,
    found: dict[Term, set[int]],
    rare: Sequence[Term],
    common: Sequence[Term],
    scope: str | None,
) -> None:
    """Add the older memories in which a common word stands beside a rare one."""
    if rare:
        any_rare = " OR ".join(fts_phrase(term) for term in rare)
        for term in common:
            found[term].update(_match(db, f"({any_rare}) AND {fts_phrase(term)}", scope))


def _find_together(
    db: sqlite3.Connection, found: dict[Term, set[int]], common: Sequence[Term], scope: str | None
) -> None:
    """Add the older memories in which common words stand together, as many of them as do."""
    together = list(common[:1])
    for term in common[1:]:
        joined = [*together, term]
        if ids := _match(db, " AND ".join(fts_phrase(part) for part in joined), scope):
            for part in joined:
                found[part].update(ids)
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
