"""The last order once more, but changed: "again, but skip A", "the other way round this time"."""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = ["changed_again"]

_DATA = load_data("once_more")
_AGAIN = tuple(tuple(text.split()) for text in _DATA["again"])
_TURNED = frozenset(_DATA["turned"])
_LEADS = tuple(sorted((tuple(text.split()) for text in _DATA["leads"]), key=len, reverse=True))


def changed_again(words: Phrase) -> Phrase:
    """What is to be different when the last order is done once more; empty if that is not asked for."""
    body = tuple(w for w in strip_openers(words, requests=True) if w.is_word or w.key == ",")
    flat = keys(body)
    if not flat:
        return ()
    at, size = next(
        ((i, len(m)) for i in range(len(flat)) for m in _AGAIN if flat[i : i + len(m)] == m), (-1, 0)
    )
    if at < 0 and flat[:1] in {("repeat",), ("redo",)}:
        at, size = 0, 1
    turned = bool(_TURNED & set(flat)) and flat[0] in {"do", "go", "the", "other", "in", "run", "now"}
    if (at < 0 and not turned) or len(flat) > 18:
        return ()
    rest = body if at < 0 else (*body[:at], *body[at + size :])
    if at >= 0:
        # "Again, but this time only A".
        flat = keys(rest)
        more = next(
            ((i, len(m)) for i in range(len(flat)) for m in _AGAIN if flat[i : i + len(m)] == m), (0, 0)
        )
        rest = (*rest[: more[0]], *rest[more[0] + more[1] :])
    only = at >= 0 or turned
    while rest:
        lead = next((lead for lead in _LEADS if keys(rest[: len(lead)]) == lead), ())
        if not lead or (lead == ("the",)):
            break
        rest = rest[len(lead) :]
    while rest and (not rest[-1].is_word or rest[-1].key in {"please", "and", "but"}):
        rest = rest[:-1]
    return rest if only else ()
