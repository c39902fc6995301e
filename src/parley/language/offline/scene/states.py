"""Descriptions by how things are remembered to be: "a free bay", "a table that is not taken"."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.scene.grounding import describe, ground_phrase, matching
from parley.language.offline.scene.group_words import read_lead
from parley.language.offline.scene.marks import by_ids
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, singular, tokens
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["Restricted", "all_in_state", "in_state", "restricted"]

_FREE = frozenset(
    {
        "free",
        "empty",
        "available",
        "unoccupied",
        "vacant",
        "unreserved",
        "open",
        "unused",
        "usable",
        "untaken",
    }
)
_TAKEN = frozenset(
    {
        "taken",
        "occupied",
        "reserved",
        "full",
        "blocked",
        "closed",
        "use",
        "used",
        "rented",
        "booked",
        "locked",
        "busy",
        "order",
        "broken",
        "off-limits",
        "bounds",
        "limits",
        "shut",
        "belongs",
        "sold",
        "kept",
        "assigned",
        "needed",
        "repair",
        "construction",
        "maintenance",
        "flooded",
    }
)
_SMALL = frozenset(
    {
        "not",
        "neither",
        "nor",
        "or",
        "and",
        "no",
        "nobody",
        "yet",
        "still",
        "currently",
        "now",
        "already",
        "been",
    }
)
_IN_USE = frozenset({"taken", "occupied", "reserved", "used", "use", "busy", "full", "booked"})
_RELATIVE = frozenset({"that", "which", "who"})
_STATES = (
    _FREE
    | _TAKEN
    | {
        "dirty",
        "clean",
        "wet",
        "dry",
        "damaged",
        "defective",
        "faulty",
        "new",
        "old",
        "unlocked",
        "repaired",
        "checked",
        "done",
        "finished",
        "cleaned",
        "inspected",
        "infected",
        "dangerous",
        "slippery",
        "hot",
        "cold",
        "full",
        "ready",
        "ripe",
        "sick",
        "fragile",
    }
)


def in_state(
    phrase: Phrase,
    objects: Sequence[MapObject],
    facts: Sequence[Remembered],
    pose: Pose2D | None,
    message: str,
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """The object that is remembered to be so, and the facts used; None if no state is said or known.

    Args:
        phrase: The description, with or without its article.
        objects: The map.
        facts: What is remembered, newest first.
        pose: The robot's: of several that will do the nearest is taken.
        message: The whole message; "the" before the description asks for the only one.
    """
    if noun_phrase(phrase).quantifier in {"all", "every", "each", "both"}:
        return None
    found = all_in_state(phrase, objects, facts)
    if found is None:
        return None
    fitting, used = found
    definite = f"the {' '.join(keys(bare(phrase)))}" in message.lower()
    if definite and len(fitting) > 1:
        return None
    if pose is not None:
        fitting = sorted(fitting, key=lambda i: (i.x_m - pose.x_m) ** 2 + (i.y_m - pose.y_m) ** 2)
    return fitting[0], used


def all_in_state(
    phrase: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[list[MapObject], tuple[Remembered, ...]] | None:
    """All objects that are remembered to be so, and the facts used; None if no state is said or known."""
    words = tuple(word for word in bare(phrase) if word.is_word)
    while words and words[0].key in lexicon().quantifiers:
        words = bare(words[1:])
    read = _described(words)
    if read is None or not facts:
        return None
    head, states, denied = read
    candidates = matching(head, objects)
    if len(candidates) < 2 or ground_phrase(words, objects, strict=True).outcome == "match":
        return None
    told = {item.id: _states_of(item, objects, facts) for item in candidates}
    if not any(told.values()):
        return None
    fitting = [item for item in candidates if _fits(told[item.id], states, denied=denied)]
    said_so = [item for item in fitting if any(states & names for names, _ in told[item.id])]
    fitting = said_so or fitting
    used = tuple(fact for item in candidates for _, fact in told[item.id])
    return (fitting, used) if fitting else None


def _described(words: Phrase) -> tuple[Phrase, frozenset[str], bool] | None:
    """Head, states, and whether they are denied; None if no state is said."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat)) if flat[i] in _RELATIVE and flat[i + 1 : i + 2] != ()), 0)
    if at:
        rest = flat[at + 1 :]
        denied = bool({"not", "neither", "no", "nobody"} & set(rest))
        said = frozenset(rest) - lexicon().be - lexicon().auxiliaries - _SMALL
        states = frozenset(word for word in rest if word in _STATES) or (
            said if len(said) < 3 else frozenset()
        )
        verbs = lexicon().be | lexicon().auxiliaries
        return (words[:at], states, denied) if states and rest[0] in verbs | {"nobody"} else None
    lead = next(
        (i for i in range(len(flat)) if flat[i] not in _STATES and flat[i] not in {"and", "or"}), len(flat)
    )
    if not lead or lead >= len(flat):
        return None
    return words[lead:], frozenset(flat[:lead]) & _STATES, False


def _fits(told: list[tuple[frozenset[str], Remembered]], states: frozenset[str], *, denied: bool) -> bool:
    names = frozenset(name for found, _ in told for name in found)
    if denied:
        return not names & states and not (states <= _IN_USE and names & _IN_USE)
    if states & _FREE:
        return not names & _TAKEN
    return bool(names & states)


def _states_of(
    item: MapObject, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> list[tuple[frozenset[str], Remembered]]:
    """How one object is remembered to be: the newest word on it, whose it is, and what is in it."""
    result: list[tuple[frozenset[str], Remembered]] = []
    settled = False
    for known in facts:
        fact = known.fact
        about = fact.place if fact.is_location else fact.subject
        if not _is(item, about, objects):
            continue
        if fact.is_location:
            if not settled and not fact.negated and _fills(fact.subject):
                result.append((frozenset({"occupied", "taken"}), known))
            continue
        words = frozenset(keys(fact.state)) | {lemma(word) for word in keys(fact.state)} | {fact.relation}
        if fact.relation in lexicon().be and not settled:
            settled = True
            found = (
                ((words & _FREE and _TAKEN) or _FREE) if fact.negated and words & (_FREE | _TAKEN) else words
            )
            result.append(
                (
                    frozenset(found) | (frozenset({"taken"}) if "reserved" in found else frozenset()),
                    known,
                )
            )
        elif fact.relation == "belongs":
            result.append((frozenset({"belongs", "taken", "reserved"}), known))
    return result


def _fills(subject: Phrase) -> bool:
    """Whether what is somewhere takes the place up: somebody, or a car."""
    head = keys(subject)[-1]
    return (
        subject[0].is_capital or head in lexicon().person_words or head in lexicon().kinds.get("vehicle", ())
    )


def _is(item: MapObject, phrase: Phrase, objects: Sequence[MapObject]) -> bool:
    if not phrase or not noun_phrase(phrase).core:
        return False
    found = ground_phrase(phrase, objects, strict=True)
    return found.outcome == "match" and found.candidates[0] == item


@dataclass(frozen=True, slots=True)
class Restricted:
    """An order for all of a kind that are so."""

    group: Phrase
    items: tuple[MapObject, ...]
    words: Phrase
    """The message for those that are remembered to be so, or with a look at each, and the order if so."""
    used: tuple[Remembered, ...] = ()
    """What tells which of them are so; empty if nobody knows."""


def restricted(
    words: Phrase,
    objects: Sequence[MapObject],
    facts: Sequence[Remembered],
    is_order: Callable[[Phrase], bool],
) -> Restricted | None:
    """For "close all doors that are open": those that are remembered to be, else a look at each.

    Args:
        words: All words and punctuation.
        objects: The map.
        facts: What is remembered, newest first.
        is_order: Whether words begin with an order.
    """
    flat = keys(words)
    for link in range(2, len(flat) - 2):
        if flat[link] not in {"that", "which"} or flat[link + 1] not in _LINKED:
            continue
        start = next((i + 1 for i in range(link - 1, -1, -1) if not words[i].is_word), 0)
        end = next((i for i in range(link + 2, len(flat)) if _ends(words, i)), len(flat))
        close = next((i for i in range(end, len(flat)) if not words[i].is_word), len(flat))
        group = _all_of(words, start, link, objects)
        asked = flat[close : close + 1] == ("?",) or (group is not None and group[0] == start)
        if group is None or asked or not is_order(words[start:]):
            continue
        at, items = group
        told = all_in_state(words[at:end], objects, facts)
        if told is not None:
            so = by_ids([item.id for item in told[0]], plain(words[at:end]))
            return Restricted(words[at:end], tuple(told[0]), (*words[:at], so, *words[end:]), told[1])
        if not _is_told(words, at, link, end, objects):
            looks = _looks(words, (start, at, link, end, close), items, objects)
            return Restricted(words[at:end], items, looks)
    return None


def _looks(
    words: Phrase,
    marks: tuple[int, int, int, int, int],
    items: Sequence[MapObject],
    objects: Sequence[MapObject],
) -> Phrase:
    """A look at each of some things, and for those that are so the order that was given for them."""
    start, at, link, end, close = marks
    flat = keys(words)
    verb = lexicon().verbs.match(flat, start)
    more = words[end + 1 : close] if flat[end : end + 1] == ("and",) else ()
    going = verb is not None and verb[1].startswith("motion:")
    verb_end = at - (flat[at - 1] in {"only", "just"})
    order = more if going else (*words[start:verb_end], Word("it", "it"), *words[end:close])
    looks = [w for item in items for w in _look_first(item, words[link + 1 : end], order, objects)]
    rest = words[end:] if going and not more else words[close:]
    while rest and (not rest[0].is_word or rest[0].key in {"then", "and"}):
        rest = rest[1:]
    return (*words[:start], *looks, *rest)


_LINKED = frozenset({"is", "are", "has", "have", "needs", "need", "looks", "look"})
_MOST_LOOKS = 12


def _ends(words: Phrase, at: int) -> bool:
    """Whether a description of how things are ends at a word."""
    if not words[at].is_word or words[at].key == "then":
        return True
    then = keys(words[at + 1 : at + 2]) == ("then",)
    return words[at].key == "and" and (then or lexicon().verbs.match(keys(words), at + 1) is not None)


def _all_of(
    words: Phrase, start: int, link: int, objects: Sequence[MapObject]
) -> tuple[int, tuple[MapObject, ...]] | None:
    """Where "all doors" begins that ends at a word, and what these are."""
    for at in range(start, link):
        lead, noun = read_lead(words, at)
        several = lead.everything or (lead.definite and singular(words[link - 1].key) != words[link - 1].key)
        if noun >= link or not several or lead.count:
            continue
        found = ground_phrase(words[noun:link], objects, strict=True)
        if found.outcome == "ambiguous" and len(found.candidates) <= _MOST_LOOKS:
            return at, found.candidates
    return None


def _is_told(words: Phrase, at: int, link: int, end: int, objects: Sequence[MapObject]) -> bool:
    """Whether the map tells which of a kind are so, or it is said where they are."""
    state = tuple(word for word in words[link + 2 : end] if word.key not in {"not", "still", "already"})
    _, noun = read_lead(words, at)
    called = ground_phrase((*state, *words[noun:link]), objects, strict=True).outcome != "none"
    placed = not state or any(lexicon().places.match(keys(state), i) for i in range(len(state)))
    return called or placed


def _look_first(item: MapObject, state: Phrase, order: Phrase, objects: Sequence[MapObject]) -> Phrase:
    named = tokens(the(describe(item, objects)))
    verb = {"are": "is", "have": "has", "need": "needs", "look": "looks"}.get(state[0].key, state[0].key)
    denied = keys(state[1:2]) == ("not",)
    look = (*tokens("check whether"), *named, Word(verb, verb), *state[1 + denied :], *tokens("."))
    if not order:
        return look
    then = tuple(part for word in order for part in (named if word.key == "it" else (word,)))
    return (*look, *tokens("if not ," if denied else "if so ,"), *then, *tokens("."))
