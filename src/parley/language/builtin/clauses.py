"""Clauses: how a message falls into what is wanted and what that depends on.

Closed words ("if", "until", "otherwise", "after", "except" ...) open a clause; where it ends is said by the
tagger's span, else by the next mark. Nothing is rewritten: a clause is a piece of the row of words.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from parley.language.builtin.amounts import amount_of
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Parse
from parley.language.builtin.tokens import Token
from parley.language.lexicon import word_set

__all__ = ["Clause", "Link", "clauses"]

Link = Literal[
    "main", "if", "unless", "else", "so", "until", "before", "after", "when", "not", "first", "next",
    "except", "times", "delay",
]  # fmt: skip
_LINKS = tuple(link for link in get_args(Link) if link not in ("main", "next", "times", "delay"))
_STOPS = frozenset({",", ".", ";", ":", "!", "?", "-", "–", "—"})
_ENDS = frozenset({".", ";", "!", "?"})
_JOINS = frozenset({"and", "then", "but", "or"})
_PREFIXES = frozenset({"else", "so", "first", "next"})
"""Links that stand before a clause of their own, and open no part of another."""
_SKIPPING = frozenset({"skip", "skipping", "leave", "leaving", "ignore", "omit"})
_LEADS_IN = word_set("i you please just 'd would could can should must like to")


@dataclass(frozen=True, slots=True)
class Clause:
    """A piece of a message and what it is to its neighbours."""

    link: Link
    start: int
    end: int
    sentence: int
    fronted: bool = False
    """Whether it governs what follows; else what stands before it."""
    joined: bool = False
    """Whether "and" or the like leads to it."""


def clauses(parse: Parse, lexicon: Lexicon) -> tuple[Clause, ...]:
    """The clauses of a message, in order; one alone if nothing links several."""
    tokens, low = parse.tokens, [token.low for token in parse.tokens]
    sentence_of = _sentences(low)
    found: list[Clause] = []
    opened: list[tuple[int, int, Link]] = []
    at = 0
    while at < len(tokens):
        link = _opened(parse, low, at, lexicon)
        if link is None:
            at += 1
            continue
        kind, size = link
        opened.append((at, size, kind))
        at += size
    if not opened:
        mains = _mains(tokens, low, 0, len(tokens), sentence_of)
        return tuple(mains) if len(mains) > 1 else (Clause("main", 0, len(tokens), 0),)
    cursor, last = 0, len(tokens)
    for number, (start, size, kind) in enumerate(opened):
        if start < cursor:
            continue
        found += _mains(tokens, low, cursor, start, sentence_of)
        later = opened[number + 1][0] if number + 1 < len(opened) else last
        content = start + size
        end = content if kind in _PREFIXES else _end(parse, low, start, size, kind, later, lexicon)
        if kind in ("times", "delay"):
            content, end = start, start + size
        after = _next_word(low, end)
        follows = after is not None and sentence_of[after] == sentence_of[start] and after < later
        joined = after is not None and low[after] in _JOINS
        before = not _mains(tokens, low, _sentence_start(sentence_of, start), start, sentence_of)
        apart = before or low[start - 1] in _STOPS | _JOINS
        fronted = kind in _PREFIXES or (apart and follows and not (joined and not before))
        leads = start > 0 and low[start - 1] in _JOINS
        found.append(Clause(kind, content, end, sentence_of[start], fronted, leads))
        cursor = end
    found += _mains(tokens, low, cursor, last, sentence_of)
    return tuple(found)


def _sentences(low: Sequence[str]) -> list[int]:
    numbers, number = [], 0
    for word in low:
        numbers.append(number)
        number += word in _ENDS
    return numbers


def _sentence_start(sentence_of: Sequence[int], at: int) -> int:
    return sentence_of.index(sentence_of[at])


def _next_word(low: Sequence[str], at: int) -> int | None:
    return next((place for place in range(at, len(low)) if low[place] not in _STOPS), None)


def _opened(parse: Parse, low: Sequence[str], at: int, lexicon: Lexicon) -> tuple[Link, int] | None:
    """What is opened by the words at a place, and how many words do it."""
    counted = _counted(low, at)
    if counted is not None:
        told = at > 0 and parse.acts[at - 1] in ("told", "need") and low[at - 1] not in _STOPS | _JOINS
        often = any(span.role == "O" and span.start <= at < span.end for span in parse.spans)
        return None if often or (told and counted[0] == "delay") else counted
    best: tuple[Link, int] | None = None
    for link in _LINKS:
        for size in range(5, 0, -1):
            if " ".join(low[at : at + size]) in lexicon.classes[f"link_{link}"] and at + size <= len(low):
                if (best is None or size > best[1]) and _is_link(parse, low, at, size, link, lexicon):
                    best = (link, size)
                break
    if low[at] == "but" and best is None and "first" in low[_until(low, at) - 1 : _until(low, at)]:
        return "first", 1
    return best if best is None else _pointing_back(low, at, *best)


def _until(low: Sequence[str], at: int) -> int:
    """Where the sentence ends that a word stands in."""
    return next((end for end in range(at, len(low)) if low[end] in _ENDS), len(low))


def _pointing_back(low: Sequence[str], at: int, link: Link, size: int) -> tuple[Link, int]:
    """For "after that", "before both of them": what was said last comes before, or behind, what follows."""
    end = at + size
    while low[end : end + 1] in (["all"], ["both"], ["of"]):
        end += 1
    bare = link in ("before", "after") and low[end : end + 1] and low[end] in _BACK
    if not bare or {*low[end + 1 : end + 2]} & _BEING:
        return link, size
    return "first" if link == "before" else "next", end + 1 - at


_BACK = frozenset({"that", "this", "it", "which", "them", "those", "these"})
_BEING = frozenset({"is", "'s", "was", "has", "are", "were", "have", "one", "you", "i", "we", "they"})


def _counted(low: Sequence[str], at: int) -> tuple[Link, int] | None:
    """For "three times", "twice", "in five minutes", "after an hour"."""
    if low[at] in ("twice", "thrice"):
        return "times", 1
    if low[at + 1 : at + 2] in (["times"], ["rounds"]) and amount_of([low[at]]) is not None:
        return "times", 2
    if low[at] in ("in", "after"):
        for size in (5, 4, 3):
            amount = amount_of(low[at + 1 : at + size]) if at + size <= len(low) else None
            if amount is not None and amount.kind == "duration":
                later = low[at + size : at + size + 1]
                return ("delay", size + 1) if later in (["from"], ["time"]) else ("delay", size)
    return None


def _is_link(parse: Parse, low: Sequence[str], at: int, size: int, link: Link, lexicon: Lexicon) -> bool:
    """Whether a word that may link does so here: "see if" asks, "look after" is a verb."""
    before = low[at - 1] if at else ""
    apart = not before or before in _STOPS | _JOINS
    if low[at] == "till" and before in lexicon.classes["determiners"]:
        return False  # where one pays
    if low[at] == "should":
        return apart and "be" in low[at + 2 :] and low[at + 1] not in ("i", "you", "we")
    if link in ("if", "when", "unless"):
        asks = before in lexicon.classes["asking"] and not apart
        inside = any(span.role in "KX" and span.start <= at < span.end for span in parse.spans)
        return not asks and (apart or not inside)
    if low[at] in _SKIPPING:
        ordered = any(verb.start < at and parse.acts[verb.start] == "order" for verb in parse.verbs)
        return ordered and apart and before not in _ENDS and at + size < len(low)
    if any(verb.start <= at < verb.end or at in verb.particles for verb in parse.verbs) and link != "not":
        return False
    if low[at] == "else":
        return apart
    if link == "after" and before and lexicon.exactly([before, "after"]) and not low[at + 1].endswith("ing"):
        return low[at + 1] in _BEING | _BACK  # "go after Kim" is following
    if low[at] == "once":
        return at + 2 < len(low) and low[at + 1] not in _STOPS | _JOINS
    if link == "not" and low[at] in lexicon.classes["dismissing"]:
        end = next((place for place in range(at, len(low)) if low[place] in _STOPS), len(low))
        orders = [verb.start for verb in parse.verbs if parse.acts[verb.start] == "order"]
        named = at + size < end and not {*low[at + size : end]} & lexicon.classes["remaining"]
        return apart and named and any(start < at or start > end for start in orders)
    if link == "not" and low[at] == "not":
        return apart and at > 0 and before != "or"
    if link == "not" and low[at] == "without":
        return True
    return at + size < len(low)


def _end(
    parse: Parse, low: Sequence[str], start: int, size: int, link: Link, later: int, lexicon: Lexicon
) -> int:
    """Where the clause ends that is opened at a place."""
    content = start + size
    stop = next((at for at in range(content, later) if low[at] in _STOPS), later)
    if link in ("except", "not"):
        stop = _past_list(low, content, stop, later)
    stop = next((at for at in range(content, stop) if low[at] == "then"), stop)
    if link == "except":
        return stop
    if link == "not":
        starts = {verb.start - ahead for verb in parse.verbs for ahead in (1, 2)}  # "not A and B" leaves both
        ends = (at for at in range(content + 1, stop) if low[at] in _JOINS)
        return next((at for at in ends if low[at] not in ("and", "or") or at in starts), stop)
    reach = max((s.end for s in parse.spans if s.role in "CUW" and s.start <= start + 1), default=0)
    if content < reach < stop and low[reach] in _JOINS:
        return reach
    return _order_in(parse, low, content, stop, link, lexicon) or stop


def _order_in(
    parse: Parse, low: Sequence[str], content: int, stop: int, link: Link, lexicon: Lexicon
) -> int | None:
    """Where what is wanted begins, if no mark parts it from what it depends on."""
    verbs = [
        verb.start
        for verb in parse.verbs
        if content < verb.start < stop and verb.frame not in ("BELOC", "BECAT", "REMEMBER")
        and parse.acts[verb.start] == "order"
    ]  # fmt: skip
    if link in ("before", "after"):
        own = low[content] in ("you", "we", "it", "this", "that") or any(at < content + 2 for at in verbs)
        return next((at for at in verbs if not own or at > content + 2), None)
    said = next((at for at in range(content, stop) if low[at] in lexicon.classes["predicates"]), None)
    if said is None:
        return None
    leads = lexicon.classes["determiners"] | {"to", "of", "at", "for", "with", "by", "who", "that", "which"}
    words = [
        at
        for at in range(max(said, content + 1) + 1, stop)
        if ((low[at],) in lexicon.verbs or low[at] in lexicon.classes["imperatives"])
        and low[at] not in lexicon.classes["states"] | lexicon.classes["predicates"]
        and low[at - 1] not in leads
    ]
    first = min([*(at for at in verbs if at > said + 1), *words], default=None)
    while first is not None and first - 1 > said and low[first - 1] in _LEADS_IN:
        first -= 1
    return first


def _past_list(low: Sequence[str], content: int, stop: int, later: int) -> int:
    """The end of "2, 3 and 4": a comma between numbers ends nothing."""
    while stop + 1 < later and low[stop] == "," and low[stop + 1].isdigit() and low[stop - 1].isdigit():
        stop = next((at for at in range(stop + 1, later) if low[at] in _STOPS), later)
    return stop


def _mains(
    tokens: Sequence[Token], low: Sequence[str], start: int, end: int, sentence_of: Sequence[int]
) -> list[Clause]:
    """The sentences between two places, without what only joins them; none if no word is left."""
    found: list[Clause] = []
    at = start
    while at < end:
        stop = next((place for place in range(at, end) if low[place] in _ENDS), end)
        first, last = at, stop
        while first < last and (low[first] in _STOPS or low[first] in _JOINS):
            first += 1
        while last > first and (low[last - 1] in _STOPS or low[last - 1] in _JOINS):
            last -= 1
        if any(token.is_word for token in tokens[first:last]):
            found.append(Clause("main", first, last, sentence_of[first]))
        at = stop + 1
    return found
