"""What somebody takes back while speaking: "to the dock, no, I mean the gate".

An editing term after a mark parts what is taken back from what stands in its stead (Shriberg, Preliminaries
to a Theory of Speech Disfluencies, 1994). What is taken back is left out as hums are; where it is not plain
what that is, the words stay, and the doubt about them asks.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Parse, Span, Verb
from parley.language.builtin.tokens import Token

__all__ = ["amended"]

_MARKS = frozenset({",", ".", "?", "-", "–", "—", ";", ":", "…", "!"})
_NAMED = frozenset("TGLSRHN")


def amended(found: Parse, lexicon: Lexicon) -> tuple[Token, ...] | None:
    """The words without what is taken back in them; None if nothing is, or not plainly."""
    low = [token.low for token in found.tokens]
    for at in range(2, len(low) - 1):
        behind = _behind(low, at, lexicon)
        if behind == at or (low[at - 1] not in _MARKS and behind - at < 2):
            continue  # one word may be a part of what is said: "with no bags"
        start = _taken_back(found, low, at, behind, lexicon)
        if start is not None:
            return (*found.tokens[:start], *found.tokens[behind:])
    return None


def _behind(low: Sequence[str], at: int, lexicon: Lexicon) -> int:
    """Where the words end that take something back; where they would begin if there are none."""
    end, strong = at, False
    while end < len(low):
        sizes = (size for size in (3, 2, 1) if " ".join(low[end : end + size]) in _terms(lexicon))
        if (size := next(sizes, 0)) == 0:
            break
        strong |= " ".join(low[end : end + size]) in lexicon.classes["amending"]
        end += size
        while end < len(low) and low[end] in _MARKS:
            end += 1
    return end if strong else at


def _terms(lexicon: Lexicon) -> frozenset[str]:
    return lexicon.classes["amending"] | lexicon.classes["faltering"]


def _taken_back(found: Parse, low: list[str], at: int, behind: int, lexicon: Lexicon) -> int | None:
    """Where that begins which is taken back; None if that is not plain."""
    ordered = [verb for verb in found.verbs if verb.start < at and found.acts[verb.start] == "order"]
    end = next((place for place in range(behind, len(low)) if low[place] in _MARKS), len(low))
    if not ordered or ordered[-1].negated or {*low[behind:end]} & lexicon.classes["adding"]:
        return None
    last = ordered[-1]
    instead = [verb for verb in found.verbs if behind <= verb.start < end]
    if instead and instead[0].start <= behind + 2:
        same = instead[0].frame == last.frame or len(ordered) == 1
        return last.start if same and not instead[0].negated and not _parted(low, last, at) else None
    said = [span for span in found.spans if span.start <= behind + 1 <= span.end]
    if not any(span.role in _NAMED | {"E"} for span in said):
        return None
    span = _place_of(found, low, last, at, behind, lexicon)
    if span is None:
        return None
    led = low[span.start] in lexicon.classes["prepositions"]
    return span.start + (led and low[behind] not in lexicon.classes["prepositions"])


def _parted(low: Sequence[str], verb: Verb, at: int) -> bool:
    """Whether what was ordered last is bound to something else: "if it is open go to the gate, no, ..."."""
    return bool({*low[: verb.start]} & {"if", "unless", "until", "when", "before", "after"})


def _place_of(
    found: Parse, low: Sequence[str], verb: Verb, at: int, behind: int, lexicon: Lexicon
) -> Span | None:
    """The role that what is said instead takes: the one it is led to by the same word, else the last one."""
    leads, me = lexicon.classes["prepositions"], lexicon.classes["me"]
    mine = [
        span
        for span in found.spans
        if verb.end <= span.start < at and span.role in _NAMED and low[span.end - 1] not in me
    ]
    if not mine:
        return None
    if low[behind] in leads:
        alike = [span for span in mine if low[span.start] == low[behind]]
        return alike[-1] if alike and alike[-1] == mine[-1] else None
    return mine[-1] if len(mine) == 1 or low[mine[-1].start] not in leads else None
