"""Descriptions by what is remembered or denied: "the chair A is on", "the door that is not red"."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.facts.remembering import Remembered, find_fact
from parley.language.offline.scene.grounding import ground_phrase, matching
from parley.language.offline.scene.owned import owned_thing
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys
from parley.world.object_map import MapObject

__all__ = ["described_by_facts"]

_PRONOUNS = frozenset({"that", "which", "where", "who"})
_HOLDING = frozenset({"with", "containing", "holding", "has", "holds", "contains", "stores", "keeps"})
_MAX_HOPS = 3


def described_by_facts(
    phrase: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """The one object that a relative clause or a remembered thing in it singles out, and the facts used."""
    words = tuple(word for word in phrase if word.is_word)
    if keys(words[:1]) == ("wherever",):
        words = (Word("where", "where"), *words[1:])
    if not 2 < len(words) <= 14:
        return _the_same(words, objects, facts) or owned_thing(words, objects, facts)
    return (
        _the_same(words, objects, facts)
        or owned_thing(words, objects, facts)
        or _with_adjective(words, objects)
        or _excluded(words, objects)
        or _where_something_is(words, objects, facts)
        or _holding(words, objects, facts)
        or _beside(words, objects, facts)
    )


def _the_same(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "A's car", where it is remembered that A's car is the green one; or that the green one is A's."""
    about = keys(bare(words))
    if not about or any(item.description.lower() == " ".join(about) for item in objects):
        return None
    for known in facts:
        fact = known.fact
        if (
            fact.is_location
            or fact.negated
            or fact.relation not in lexicon().be | {"belongs"}
            or not fact.state
        ):
            continue
        for name, other in ((fact.subject, fact.state), (fact.state, fact.subject)):
            if not _names_same(about, keys(bare(name)), belongs=fact.relation == "belongs"):
                continue
            found = ground_phrase(other, objects, strict=True)
            if found.outcome == "match":
                return found.candidates[0], (known,)
    return None


def _names_same(about: tuple[str, ...], name: tuple[str, ...], *, belongs: bool) -> bool:
    """Whether two names mean the same: word by word, or as owner ("Ben's" and "to Ben" for "Ben's car")."""
    if about == name:
        return True
    at = next((i for i, word in enumerate(about) if word.endswith("'s")), -1)
    if at < 0:
        return False
    owner = (*about[:at], about[at].removesuffix("'s"))
    name = tuple(word for word in name if word not in {"the", "a", "an"})
    return name == (*owner[:-1], f"{owner[-1]}'s") or (belongs and name == ("to", *owner))


def _where_something_is(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the chair (that) A is (not) on", "where A is"."""
    flat = keys(words)
    link, negated = _link(flat)
    if not link:
        return None
    for start in range(1, link):
        subject = words[start:link]
        head = words[: start - 1] if flat[start - 1] in _PRONOUNS else words[:start]
        item, used = _located(subject, objects, facts)
        if item is None:
            continue
        if not bare(head) or keys(bare(head)) in {("place",), ("one",), ("spot",)}:
            return None if negated else (item, used)
        candidates = matching(head, objects)
        left = [c for c in candidates if (c == item) != negated]
        if len(left) == 1 and candidates:
            return left[0], used
    return None


def _link(flat: tuple[str, ...]) -> tuple[int, bool]:
    """Where the verb of a relative clause at the end stands, and whether it is denied; 0 if there is none."""
    lex = lexicon()
    end, negated = len(flat), False
    while end and (
        lex.places.match(flat, end - 1) is not None
        or flat[end - 1] in lex.location_verbs | {"not", "now", "currently", "to", "right"}
    ):
        negated = negated or flat[end - 1] == "not"
        end -= 1
    if 1 < end <= len(flat) and flat[end - 1] in lex.be:
        return end - 1, negated
    # "where A sits": the verb is one of place itself.
    return (end, negated) if 1 < end < len(flat) and flat[end] in lex.location_verbs else (0, False)


def _located(
    subject: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject | None, tuple[Remembered, ...]]:
    """The object that something is remembered to be at, over several facts if need be."""
    used: list[Remembered] = []
    about = bare(subject)
    for _ in range(_MAX_HOPS):
        fact, _several = find_fact(about, facts)
        if fact is None or fact in used:
            return None, ()
        used.append(fact)
        found = ground_phrase(fact.fact.place, objects)
        if found.outcome == "match":
            return found.candidates[0], tuple(used)
        about = fact.fact.place
    return None, ()


def _holding(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the desk with the cup", "the box that contains the keys"."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in _HOLDING), 0)
    if not at:
        return None
    head = words[: at - 1] if flat[at - 1] in _PRONOUNS else words[:at]
    if ground_phrase(words, objects).outcome == "match" or not bare(head):
        return None
    item, used = _located(words[at + 1 :], objects, facts)
    return (item, used) if item is not None and item in matching(head, objects) else None


def _beside(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the chair next to A", where A is no object but remembered to be at one."""
    noun = noun_phrase(words)
    if not noun.core or len(noun.anchors) != 1 or noun.relation in {"of", "from"} or not noun.anchors[0]:
        return None
    if ground_phrase(words, objects).outcome == "match":
        return None
    if ground_phrase(noun.anchors[0], objects).outcome == "match":
        return None
    item, used = _located(noun.anchors[0], objects, facts)
    if item is None:
        return None
    size = next(
        i
        for i in range(len(words))
        if keys(words[i:])[: len(noun.relation.split())] == tuple(noun.relation.split())
    )
    found = matching(words[:size], objects)
    if item in found:
        return item, used
    nearest = sorted(found, key=lambda o: (o.x_m - item.x_m) ** 2 + (o.y_m - item.y_m) ** 2)
    return (nearest[0], used) if nearest else None


def _with_adjective(
    words: Phrase, objects: Sequence[MapObject]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the door that is red" the red door."""
    flat = keys(words)
    for index in range(1, len(flat) - 2):
        if flat[index] in {"that", "which"} and flat[index + 1] in lexicon().be and len(flat) == index + 3:
            found = ground_phrase((words[index + 2], *bare(words[:index])), objects)
            return (found.candidates[0], ()) if found.outcome == "match" else None
    return None


def _excluded(words: Phrase, objects: Sequence[MapObject]) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the door that is not red", "the desk without a lamp", "the box, not the old one"."""
    flat = keys(words)
    for index in range(1, len(flat) - 1):
        size = next(
            (
                len(marker)
                for marker in (
                    ("that", "is", "not"),
                    ("which", "is", "not"),
                    ("without",),
                    ("not",),
                    ("with", "no"),
                )
                if flat[index : index + len(marker)] == marker
            ),
            0,
        )
        if not size or index + size >= len(flat):
            continue
        head, refused = bare(words[:index]), bare(words[index + size :])
        if not head or not refused:
            return None
        candidates = matching(head, objects)
        if lexicon().places.match(keys(refused)):
            there = ground_phrase((*head, *words[index + size :]), objects)
            rest = [item for item in candidates if item not in there.candidates]
            told = there.outcome == "match" and len(rest) == 1
            return (rest[0], ()) if told else None
        wanted = {word for word in noun_phrase(refused).core if word not in {"one"}}
        left = [item for item in candidates if not wanted & set(item.description.lower().split())]
        return (left[0], ()) if wanted and len(left) == 1 and len(candidates) > 1 else None
    return None
