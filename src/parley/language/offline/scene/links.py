"""Things by what is remembered to have to do with them: "the lane for A", "the room B meets in", "C's bus".

What is named need not be on the map itself. The facts about it lead to one thing of the kind that is said,
at once or over another thing that is spoken of in both ("C drives line 9", "line 9 runs with bus 41").
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

from parley.language.offline.facts.remembering import WORKING, Remembered
from parley.language.offline.facts.sharing import content_of, shared
from parley.language.offline.scene.grounding import ground_phrase, matching
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.world.object_map import MapObject

__all__ = ["linked_thing", "worked_with"]

Found = tuple[MapObject, tuple[Remembered, ...]]

_BETWEEN = frozenset({"for", "of", "from"})
_RELATIVE = frozenset({"that", "which", "where", "who", "whose"})
_ANY = frozenset({
    ("one",), ("thing",), ("place",), ("spot",), ("machine",), ("device",), ("instrument",), ("tool",),
    ("vehicle",),
})  # fmt: skip
"""Heads that nothing on the map need be called: what the facts say tells the one."""
_MAX_HOPS = 2


def linked_thing(words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]) -> Found | None:
    """The one object of the kind a description says that facts connect with what else it names.

    Args:
        words: The description, without marks.
        objects: The map.
        facts: What is remembered, newest first.
    """
    if not facts or len(words) < 2:
        return None
    for head, about, told in _split(words):
        kind = keys(head)
        if not kind or kind[0] in lexicon().question_starts | {"not", "no"}:
            continue
        candidates = matching(head, objects) or (list(objects) if kind in _ANY else [])
        if not candidates or ground_phrase(about, objects, strict=True).outcome != "none":
            continue
        found = _told(about, candidates, objects, facts) if told else None
        found = found or (_reached(about, candidates, objects, facts) if not told else None)
        if found is not None:
            return found
    return None


def worked_with(
    who: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, Remembered] | None:
    """The one thing of the map that somebody is remembered to drive, run or mind: there they are found.

    Args:
        who: A name.
        objects: The map.
        facts: What is remembered, newest first.
    """
    core = _core(who)
    for item in _latest(facts):
        if item.fact.relation not in WORKING or not core or _core(item.fact.subject) != core:
            continue
        found = {thing.id: thing for thing in _named_in(item, objects, subject=False)}
        if len(found) == 1:
            return next(iter(found.values())), item
    return None


def _split(words: Phrase) -> Iterator[tuple[Phrase, Phrase, bool]]:
    """What kind of thing is said, what else is named, and whether that is a clause of its own."""
    flat = keys(words)
    for at in range(len(flat) - 1):
        last = words[at]
        if last.key.endswith("'s") or last.raw.endswith("s'"):
            stem = Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s").removesuffix("'"))
            yield bare(words[at + 1 :]), bare((*words[:at], stem)), False
            return
    for at in range(1, len(flat) - 1):
        if flat[at] in _BETWEEN:
            yield bare(words[:at]), bare(words[at + 1 :]), False
            return
        relative = flat[at] in _RELATIVE
        # "The room | the choir meets in", "the machine | Mika runs".
        begins = relative or flat[at] in {"the", "a", "an", "our"} or words[at].is_capital
        if begins and at < len(flat) - 1 and bare(words[:at]) and not _names_on(words, at):
            yield bare(words[:at]), bare(words[at + relative :]), True
            return


def _names_on(words: Phrase, at: int) -> bool:
    """Whether a capital belongs to the name before it ("table A", "Bay B")."""
    return len(words[at].key) < 2 or (words[at].is_capital and words[at - 1].is_capital)


def _told(
    about: Phrase, candidates: Sequence[MapObject], objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> Found | None:
    """By the one fact that says all of that."""
    wanted = content_of(about)
    found: dict[str, Found] = {}
    for item in _latest(facts):
        if not (_begins_so(about, item) or len(wanted) > 1) or shared(wanted, item) < len(wanted):
            continue
        for thing in _named_in(item, objects):
            if thing in candidates:
                found.setdefault(thing.id, (thing, (item,)))
    return next(iter(found.values())) if len(found) == 1 else None


def _begins_so(about: Phrase, item: Remembered) -> bool:
    """Whether a clause has the subject and the verb of a fact ("the samples are (for)")."""
    subject = keys(item.fact.subject)
    verbs = {lemma(key) for key in keys(about)[len(subject) :]}
    return keys(about)[: len(subject)] == subject and lemma(item.fact.relation) in verbs


def _reached(
    about: Phrase,
    candidates: Sequence[MapObject],
    objects: Sequence[MapObject],
    facts: Sequence[Remembered],
    hops: int = 0,
) -> Found | None:
    """By the facts about what is named, or about what those speak of."""
    core = _core(about)
    mine = [item for item in _latest(facts) if core and _core(item.fact.subject) == core]
    found: dict[str, Found] = {}
    for item in mine:
        for thing in _named_in(item, objects, subject=False):
            if thing in candidates:
                found.setdefault(thing.id, (thing, (item,)))
    if not found and hops < _MAX_HOPS:
        for item in mine:
            for other in (item.fact.place, *_objects_of(item)):
                further = _reached(bare(other), candidates, objects, facts, hops + 1) if other else None
                if further is not None:
                    found.setdefault(further[0].id, (further[0], (item, *further[1])))
    return next(iter(found.values())) if len(found) == 1 else None


def _latest(facts: Sequence[Remembered]) -> list[Remembered]:
    """The last of what was said in the same way of the same thing; nothing that is denied."""
    newest: dict[tuple[object, ...], Remembered] = {}
    for item in facts:
        fact = item.fact
        if not fact.subject:
            continue
        kind = "where" if fact.is_location else fact.relation
        newest.setdefault((keys(fact.subject), item.entry.name if fact.another else kind), item)
    return [item for item in newest.values() if not item.fact.negated]


def _named_in(item: Remembered, objects: Sequence[MapObject], *, subject: bool = True) -> Iterator[MapObject]:
    """The things of the map that a fact names."""
    whole = (item.fact.place, *_objects_of(item), *((item.fact.subject,) if subject else ()))
    for phrase in whole:
        found = ground_phrase(bare(phrase), objects, strict=True) if bare(phrase) else None
        if found is not None and found.outcome == "match":
            yield found.candidates[0]


def _objects_of(item: Remembered) -> Iterator[Phrase]:
    """What a fact says something with: "bus 41" in "runs with bus 41"."""
    state = item.fact.state
    said_twice = keys(state[:1]) == (item.fact.relation,)
    return iter(_after_small(state[1:] if said_twice else state))


@lru_cache(maxsize=1024)
def _after_small(state: Phrase) -> tuple[Phrase, ...]:
    """What is said, from its start and from behind each small word on."""
    starts = [i + 1 for i, word in enumerate(state[:-1]) if _is_link(word.key)]
    return tuple(bare(state[start:]) for start in (0, *starts) if bare(state[start:]))


def _is_link(key: str) -> bool:
    return key in lexicon().determiners or key in _LINKS


_LINKS = frozenset({
    "from", "to", "at", "in", "on", "through", "via", "by", "into", "with", "for", "of", "after", "near",
})  # fmt: skip


def _core(phrase: Phrase) -> tuple[str, ...]:
    return noun_phrase(phrase).core if phrase else ()
