"""What somebody takes back while speaking: "to the dock, no, I mean the gate".

An editing term after a mark parts what is taken back from what stands in its stead (Shriberg, Preliminaries
to a Theory of Speech Disfluencies, 1994). What is taken back is left out as hums are; where it is not plain
what that is, the words stay, and the doubt about them asks.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Parse, Span, Verb

__all__ = ["amended"]

_MARKS = frozenset({",", ".", "?", "-", "–", "—", ";", ":", "…", "!"})
_NAMED = frozenset("TGLSRHN")
_BINDING = frozenset({"if", "unless", "until", "when", "before", "after"})


def amended(found: Parse, lexicon: Lexicon) -> tuple[int, int] | None:
    """Where what is taken back begins in the text and where it ends; None if nothing is, or not plainly."""
    low = [token.low for token in found.tokens]
    for at in range(2, len(low) - 1):
        behind = _behind(low, at, lexicon)
        breaks = low[at] in lexicon.classes["breaking"] and behind - at > 1
        if behind in (at, len(low)) or not (breaks or low[at - 1] in _MARKS):
            continue  # one word may be a part of what is said: "with no lid"
        start = _taken_back(found, low, at, behind, lexicon)
        if start is not None:
            return found.tokens[start].start, found.tokens[behind].start
    return None


def _behind(low: Sequence[str], at: int, lexicon: Lexicon) -> int:
    """Where the words end that take something back; where they would begin if there are none."""
    end, strong, terms = at, False, lexicon.classes["amending"] | lexicon.classes["faltering"]
    while end < len(low):
        sizes = (n for n in (4, 3, 2, 1) if " ".join(low[end : end + n]) in terms)
        if (size := next(sizes, 0)) == 0:
            break
        strong |= " ".join(low[end : end + size]) in lexicon.classes["amending"]
        end = min(end + size, len(low))
        while end < len(low) and low[end] in _MARKS:
            end += 1
    return end if strong else at


def _taken_back(found: Parse, low: list[str], at: int, behind: int, lexicon: Lexicon) -> int | None:
    """Where that begins which is taken back; None if that is not plain."""
    bare = low[at:behind] == ["no"] and low[behind] not in lexicon.classes["determiners"]  # "no lids"
    if bare or "yes" in low[:at] or found.acts[behind] in ("told", "need", "question", "alarm"):
        return None  # "yes: go to the gate, no: stay here"
    ordered = [verb for verb in found.verbs if verb.start < at and found.acts[verb.start] == "order"]
    end = next((place for place in range(behind, len(low)) if low[place] in _MARKS), len(low))
    if not ordered or ordered[-1].negated or {*low[behind:end]} & lexicon.classes["adding"]:
        return None
    last = ordered[-1]
    instead = [verb for verb in found.verbs if behind <= verb.start < end]
    if instead and instead[0].start <= behind + 2:
        same = instead[0].frame == last.frame or len(ordered) == 1
        parted = {*low[: last.start]} & _BINDING or any(word in ".?!;" for word in low[last.start : at - 1])
        return last.start if same and not instead[0].negated and not parted else None
    said = [span for span in found.spans if span.start <= behind + 1 <= span.end]
    if not any(span.role in _NAMED | {"E"} for span in said):
        return None
    span = _place_of(found, low, last, at, behind, lexicon)
    if span is None:
        return None
    led = low[span.start] in lexicon.classes["prepositions"]
    return span.start + (led and low[behind] not in lexicon.classes["prepositions"])


def _place_of(
    found: Parse, low: Sequence[str], verb: Verb, at: int, behind: int, lexicon: Lexicon
) -> Span | None:
    """The role that what is said instead takes: the one it is led to by the same word, else the last one."""
    leads, me = lexicon.classes["prepositions"], lexicon.classes["me"]
    mine = [
        span
        for span in found.spans
        if verb.end <= span.start < at
        and span.role in _NAMED
        and low[span.end - 1] not in me
        and found.acts[span.start] == "order"
    ]
    if not mine or mine[-1].end + (low[at - 1] in _MARKS) != at:
        return None
    if low[behind] in leads:
        alike = [span for span in mine if low[span.start] == low[behind]]
        return alike[-1] if alike and alike[-1] == mine[-1] else None
    return mine[-1] if len(mine) == 1 or low[mine[-1].start] not in leads else None
