"""What kind of message one is that only tells: an order in other words, a complaint, news, or what is usual.

What is told to be undone is put as the order that it means ("nobody has cleaned A": "clean A"), beside an
order of its own it only explains.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache

from parley.language.offline.scene.report_words import phrase_of, place_named
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.sentences.telling import Telling, telling
from parley.language.offline.sentences.units import Unit
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = [
    "complains",
    "done_by_others",
    "only_news",
    "only_to_be_seen_to",
    "tellings",
    "with_undone_deeds",
    "without_vague_orders",
]


def with_undone_deeds(words: Phrase, parts: Sequence[Unit], scene: Scene) -> Phrase:
    """A message with orders in place of what tells that a deed was not done, or should be by now.

    Args:
        words: All words and punctuation.
        parts: Its parts.
        scene: What is known.
    """
    ordered = any(part.kind in {"order", "condition", "asked"} for part in parts)
    result, at = list(words), len(words)
    for part, told in reversed(tellings(parts, scene)):
        asked = _asked_for(part, parts)
        explains = ordered and asked is None and told.kind in {"undone", "expected"}
        order = () if explains else _order(told, part, scene)
        if not order:
            continue
        if asked is not None:
            del result[asked.start : asked.end]
        begin = part.start
        while begin < part.end and keys(words[begin : part.end])[: len(part.words)] != keys(part.words):
            begin += 1
        if begin < part.end <= at:
            result[begin : begin + len(part.words)] = order
            at = part.start
            scene.trace.note("recast", f"“{told.deed}” is {told.kind}")
    return tuple(result)


def _asked_for(part: Unit, parts: Sequence[Unit]) -> Unit | None:
    """For "nobody has V-ed A. Please do that" the order behind it, which only says to do what is told."""
    behind = next((one for one in parts if one.start >= part.end and one.kind != "reason"), None)
    if behind is None or behind.kind not in {"order", "asked"}:
        return None
    flat = keys(word for word in behind.words if word.is_word)
    while flat[:1] in {("please",), ("and",), ("so",)}:
        flat = flat[1:]
    if (
        flat[:1] == ("do",)
        and set(flat[1:]) <= _DOING_SO
        and (_POINTING & set(flat) or "please" in keys(behind.words))
    ):
        # "Please do so".
        return behind
    does = behind.kind == "order" and _vague().match(flat) is not None
    return behind if does and _POINTING & set(flat) and set(flat[1:]) <= _DOING_SO else None


def without_vague_orders(words: Phrase, parts: Sequence[Unit]) -> Phrase:
    """A message without "could you see to it" beside the order that it means.

    Args:
        words: All words and punctuation.
        parts: Its parts.
    """
    vague = [part for part in parts if _is_vague(part) and set(keys(part.words[-1:])) <= _POINTING]
    if not vague or not any(part.kind == "order" and not _is_vague(part) for part in parts):
        return words
    gone = {index for part in vague for index in range(part.start, part.end)}
    return tuple(word for index, word in enumerate(words) if index not in gone)


_POINTING = frozenset({"it", "that", "this", "them", "to"})
_DOING_SO = _POINTING | {
    "so", "now", "please", "then", "first", "next", "today", "right", "away", "straight", "for", "me", "us",
    "of", "care", "both", "all", "soon", "quickly", "at", "once", "too", "as", "well", "and", "you", "could",
}  # fmt: skip


def tellings(parts: Sequence[Unit], scene: Scene) -> list[tuple[Unit, Telling]]:
    """The parts of a message that only tell something of a deed, each with what that is."""
    deeds = Deeds.of(scene)
    told = (
        (part, telling(part.words, deeds))
        for part in _with_since(parts)
        if part.kind in {"told", "wish", "idle"}
    )
    return [(part, found) for part, found in told if found is not None]


def only_to_be_seen_to(parts: Sequence[Unit]) -> bool:
    """For "see to A, it is nearly empty": what is to be done is only told."""
    orders = [part for part in parts if part.kind == "order"]
    return bool(orders) and any(part.kind == "told" for part in parts) and all(map(_is_vague, orders))


def complains(parts: Sequence[Unit], scene: Scene) -> bool:
    """Whether nothing is asked for in so many words, and what is told is not just usual."""
    asks = any(
        part.kind in {"asked", "condition"} or (part.kind == "order" and not _is_vague(part))
        for part in parts
    )
    return not asks and not any(found.kind == "usual" for _, found in tellings(parts, scene))


def _is_vague(part: Unit) -> bool:
    flat = keys(part.words)
    return part.kind == "order" and _vague().match(flat, int(flat[:1] == ("and",))) is not None


@cache
def _vague() -> PhraseTable:
    return PhraseTable.of(load_data("helping")["vague"])


def only_news(parts: Sequence[Unit], scene: Scene) -> bool:
    """Whether a message asks for nothing and tells what was done, or what is usual."""
    if any(part.kind in {"order", "asked", "condition", "wish"} for part in parts):
        return False
    return any(found.kind in {"done", "usual"} for _, found in tellings(parts, scene))


def _with_since(parts: Sequence[Unit]) -> Iterator[Unit]:
    """The parts of a message, with "it is a week" and "since anybody V-ed A" as one."""
    parts = list(parts)
    for part, behind in itertools.zip_longest(parts, parts[1:]):
        long = behind is not None and behind.kind == "reason" and keys(behind.words[:1]) == ("since",)
        if long and behind is not None and part.kind == "told" and len(part.words) < _SHORT:
            yield replace(part, end=behind.end, words=(*part.words, *behind.words))
        else:
            yield part


_SHORT = 7


def done_by_others(parts: Sequence[Unit], scene: Scene) -> frozenset[str]:
    """The verbs of what a message tells to be done already."""
    return frozenset(found.deed for _, found in tellings(parts, scene) if found.kind == "done")


def _order(told: Telling, part: Unit, scene: Scene) -> Phrase:
    """The order that is meant; empty if none is."""
    if told.kind == "expected":
        return told.order if scene.catalogue.with_role("look") is not None else ()
    if told.kind != "undone":
        return ()
    found = lexicon().verbs.match((told.deed,))
    looks = found is not None and found[1].partition(":")[0] in {"look", "whether", "motion"}
    where = place_named(part.words, scene) if looks else None
    if where is not None:
        return phrase_of("inspect the", bare(part.words[where[0] : where[1]]))
    return () if looks and len(scene.several(told.order[1:])) < _SEVERAL else told.order


_SEVERAL = 2
