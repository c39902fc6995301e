"""Clauses that only say where somebody is, or that somebody is helped, as parts of the order beside them."""

from __future__ import annotations

import itertools
from dataclasses import replace

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Parse, Span, Verb
from parley.language.lexicon import word_set

__all__ = ["folded", "requested"]


_WHO = frozenset({"he", "she", "they", "who", "that"})
_WHAT = frozenset({"it", "that", "which"})
_WHOM = frozenset({"him", "her", "them", "it"})
_IS = frozenset({"is", "are", "'s", "’s", "'re", "’re"})
_AT = frozenset({"at", "in", "on", "by", "near", "beside", "behind", "inside", "under", "over"})
_BREAKS = frozenset({",", ";", ".", ":", "!", "?", "and", "then", "but", "or", "please", "so"})
_APART = frozenset({",", ";", ".", ":", "!", "?", "but", "now", "then"})
_FETCHED = frozenset({"BRING", "TAKE", "GIVE"})
_MEETING = frozenset({"FOLLOW", "FIND", "GUIDE"})
_WAYS = frozenset({"way", "direction"})
_LONGEST_NAME = 4


def folded(parse: Parse, lexicon: Lexicon) -> Parse:
    """What was read, with one order of what was two clauses.

    "Follow Kim, she's at the desk" says where Kim is to be met; "help Kim get to the gate" has Kim led there.
    """
    return _helped(_placed(_purposed(_done_already(parse), lexicon)), lexicon)


def _done_already(parse: Parse) -> Parse:
    """With what somebody is thanked for, and what somebody did, as no order: "thanks for checking bay 2"."""
    low, acts = [token.low for token in parse.tokens], [*parse.acts]
    for verb in parse.verbs:
        start = max((at + 1 for at in range(verb.start) if low[at] in _APART), default=0)
        led = low[start : verb.start]
        thanked = bool({*led} & {"thanks", "thank", "cheers"}) and led[-1:] == ["for"]
        who = parse.tokens[start].text if len(led) == 1 else ""
        behind = any(span.start == verb.end and span.role == "T" for span in parse.spans)
        did = who.istitle() and low[verb.start].endswith("ed") and behind
        if thanked or did:
            end = next((at for at in range(verb.end, len(low)) if low[at] in _APART), len(low))
            acts[start:end] = ["social" if thanked else "told"] * (end - start)
    return replace(parse, acts=tuple(acts))


def _purposed(parse: Parse, lexicon: Lexicon) -> Parse:
    """With what a way is for as an order of its own: "go to the desk to meet Kim"."""
    low = [token.low for token in parse.tokens]
    for place, span in enumerate(parse.spans):
        at, behind = span.start + 1, parse.spans[place + 1 : place + 2]
        meets = span.role == "G" and low[at - 1] == "to" and at < span.end
        if not meets or lexicon.frames_of([low[at]], []) != {"FIND"}:
            continue
        number = sum(verb.start < at for verb in parse.verbs)
        verbs = (*parse.verbs[:number], Verb("FIND", at, at + 1, span.share), *parse.verbs[number:])
        spans = [
            one if one.owner is None or one.owner < number else replace(one, owner=one.owner + 1)
            for one in parse.spans
        ]
        if at + 1 < span.end:
            spans[place] = replace(span, role="T", start=at + 1, owner=number)
        elif behind and behind[0].start == span.end and behind[0].role in "GT":
            spans[place : place + 2] = [replace(behind[0], role="T", owner=number)]
        else:
            continue
        return replace(parse, verbs=verbs, spans=tuple(spans))
    return parse


def _placed(parse: Parse) -> Parse:
    """With "she's at the desk", behind an order about her, as the place of that order."""
    low = [token.low for token in parse.tokens]
    for at in range(2, len(low) - 2):
        verb = next((n for n, one in reversed([*enumerate(parse.verbs)]) if one.end <= at), None)
        told = _told_from(low, at)
        if not told or verb is None or parse.acts[parse.verbs[verb].start] != "order":
            continue
        word, place = told
        end = next((n for n in range(place + 1, len(low)) if low[n] in _BREAKS), len(low))
        role = _place_of(parse, verb, word, at)
        others = [one for one in parse.verbs if at <= one.start < end and one.frame not in ("BELOC", "FIND")]
        within = any(span.start < at < span.end for span in parse.spans) and low[at + 1] in _IS
        # a part of what it stands in: "the mug that is on the desk"
        if role and not (others or within) and end > place + 1:
            return _with_place(parse, at, place, end, Span(role, place, end, end - 1, verb, 1.0))
    return parse


def _told_from(low: list[str], at: int) -> tuple[str, int] | None:
    """Of whom something is told from a word on, and where its place begins; None if no place is told."""
    if low[at + 1] in _IS and low[at + 2] in _AT:
        return low[at], at + 2
    start = at + (low[at] in ("who", "whom", "that"))
    found = low[start : start + 1] == ["you"] and next(
        (n for n in (start + 1, start + 2) if low[n : n + 1] == ["find"]), 0
    )
    if not found:
        return None
    who = low[found + 1 : found + 2] and low[found + 1] in _WHOM
    place = found + 1 + bool(who)
    return ("they", place) if low[place : place + 1] and low[place] in _AT else None


def _place_of(parse: Parse, verb: int, word: str, start: int) -> str:
    """Which role of an order says where that is of which more is told; none if it has it already."""
    frame = parse.verbs[verb].frame
    roles = {span.role for span in parse.spans if span.owner == verb and span.end <= start}
    if word in _WHO and (frame == "ANSWER" or roles & {"R"} or (frame in _MEETING and roles & {"T"})):
        role = "S" if frame == "GUIDE" else "L"
    elif word in _WHAT and "T" in roles:
        role = "S" if frame in _FETCHED else "L" if frame == "FIND" else ""
    else:
        role = ""
    return role if role and role not in roles else ""


def _with_place(parse: Parse, start: int, place: int, end: int, span: Span) -> Parse:
    """With a clause as one role of a verb before it."""
    kept = [n for n, one in enumerate(parse.verbs) if not start <= one.start < end]
    spans = [one for one in parse.spans if one.start < start or one.start >= end]
    spans = [
        replace(one, end=start, head=min(one.head, start - 1)) if one.end > start > one.start else one
        for one in spans
    ]
    spans.append(span)
    spans.sort(key=lambda one: one.start)
    spans = [replace(one, owner=kept.index(one.owner) if one.owner in kept else None) for one in spans]
    acts = list(parse.acts)
    acts[start:end] = ["told"] * (place - start) + ["order"] * (end - place)
    verbs = tuple(parse.verbs[n] for n in kept)
    return replace(parse, verbs=verbs, spans=tuple(spans), acts=tuple(acts))


def _helped(parse: Parse, lexicon: Lexicon) -> Parse:
    """With "help me" before a verb as a word of courtesy, and with whom else is helped as who is led."""
    low = [token.low for token in parse.tokens]
    at = next((n for n, word in enumerate(low) if word == "help"), len(low))
    number = next((n for n, verb in enumerate(parse.verbs) if verb.start > at + 1), None)
    if (
        number is None
        or lexicon.classes["danger"] - {"help"} & {*low}
        or any(v.start == at for v in parse.verbs)
    ):
        return parse
    verb = parse.verbs[number]
    end = verb.start - (low[verb.start - 1] == "to")
    who = low[at + 1 : end]
    if not who or len(who) > _LONGEST_NAME or {*who} & _BREAKS or parse.acts[verb.start] != "order":
        return parse
    acts = list(parse.acts)
    acts[at : verb.start] = ["order"] * (verb.start - at)
    parse = replace(parse, acts=tuple(acts))
    if {*who} <= lexicon.classes["me"]:
        return replace(parse, acts=(*acts[:at], *["social"] * (end - at), *acts[end:]))
    return _led(parse, number, at, end, low)


def _led(parse: Parse, number: int, at: int, end: int, low: list[str]) -> Parse:
    """Who is helped to get somewhere as who is led there."""
    verb, mine = parse.verbs[number], [span for span in parse.spans if span.owner == number]
    finds = verb.frame == "FIND" and {*low[verb.end :]} & _WAYS
    if not any(span.role == "G" for span in mine) or not (verb.frame == "GO" or finds):
        return parse
    kept = [span for span in parse.spans if span.end <= at or span.start >= end]
    kept = [span for span in kept if span.owner != number or span.role not in "TXS"]
    start = next(span.start for span in mine if span.role == "G")
    source = next((n for n in range(verb.end, start) if low[n] == "from"), None)
    if source is not None:
        kept.append(Span("S", source, start, start - 1, number, verb.share))
    kept.append(Span("T", at + 1, end, end - 1, number, verb.share))
    first, behind = start if source is None else source, len(low) - end
    acts = (*parse.acts[:end], *["social"] * (first - end), *["order"] * behind)[: len(low)]
    kept.sort(key=lambda span: span.start)
    verbs = list(parse.verbs)
    verbs[number] = replace(verb, frame="GUIDE", start=at, end=at + 1)
    return replace(parse, verbs=tuple(verbs), spans=tuple(kept), acts=acts)


_MODALS = frozenset({"can", "could", "would"})
_KNOWING = word_set("tell say see hear explain show feel smell swim read speak")
"""Who asks whether the robot can do so wants to know something."""


def requested(parse: Parse, lexicon: Lexicon) -> Parse:
    """What was read, with orders where somebody asks "can you ..." for something that can be done."""
    acts = list(parse.acts)
    for verb in parse.verbs:
        start = _opening(parse, verb, lexicon)
        if start is None or not _is_deed(parse, verb, lexicon):
            continue
        end = verb.start
        while end < len(acts) and acts[end] in ("question", "order") and _runs_on(parse, end):
            end += 1
        acts[start:end] = ["order"] * (end - start)
    return replace(parse, acts=tuple(acts))


def _opening(parse: Parse, verb: Verb, lexicon: Lexicon) -> int | None:
    """Where "can you", "do you think you could" before a verb begins; None if nothing of that kind does."""
    low = [token.low for token in parse.tokens]
    start = verb.start
    while (
        start and parse.tokens[start - 1].is_word and low[start - 1] in lexicon.classes["small"] | {"think"}
    ):
        start -= 1
    opener = low[start : verb.start]
    pairs = set(itertools.pairwise(opener))
    asked = any((modal, "you") in pairs for modal in _MODALS) or ("you", "can") in pairs
    return start if asked and parse.acts[verb.start] in ("question", "order") else None


def _runs_on(parse: Parse, at: int) -> bool:
    token = parse.tokens[at]
    return token.is_word and token.low not in ("and", "then", "but", "or")


def _is_deed(parse: Parse, verb: Verb, lexicon: Lexicon) -> bool:
    words = [token.low for token in parse.tokens[verb.start : verb.end]]
    particles = [parse.tokens[at].low for at in verb.particles]
    known = verb.frame in lexicon.frames_of(words, particles)
    return known and not verb.negated and words[0] not in _KNOWING | lexicon.classes["mental"]
