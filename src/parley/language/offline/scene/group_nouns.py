"""Names of kinds of things in a message, and which of these an exception or a number means."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from parley.language.offline.facts.remembering import Remembered, find_fact
from parley.language.offline.scene import spatial
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.group_words import (
    Lead,
    in_turn_at,
    labels_at,
    parity_at,
    read_lead,
    stops,
)
from parley.language.offline.scene.members import chosen, labelled
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.text import Phrase, Word, keys, singular
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["LONGEST_NOUN", "NO_NOUN", "Found", "GroupNouns", "Uncounted", "is_room_for"]

LONGEST_NOUN = 5

_WHICH_GOES = frozenset({"that", "which", "is", "goes", "going", "called", "named", "marked", "with", "the"})
NO_NOUN = (
    lexicon().determiners
    | lexicon().be
    | frozenset(
        {
            "and",
            "or",
            "but",
            "to",
            "of",
            "then",
            "not",
            "except",
            "for",
            "you",
            "i",
            "we",
            "me",
            "from",
            "than",
            "nor",
        }
    )
)
_LINKING = frozenset({
    "with", "that", "which", "where", "who", "has", "have", "is", "are", "in", "on", "at", "it", "holds",
    "holding", "containing", "contains", "inside", "stands", "lies", "sits", "stays", "lives",
})  # fmt: skip
_LEADING_TO_NAME = frozenset({
    "that", "which", "is", "goes", "going", "leads", "leading", "faces", "facing", "called", "named",
    "marked", "labelled", "labeled", "says", "saying", "up", "over", "out", "down", "round", "in", "to",
    "at", "on", "the",
})  # fmt: skip
_POINTED_OUT = (("that", "one"), ("this", "one"), ("it",), ("that",), ("this",), ("there",))
_JOINTS = frozenset({"so", "and", "because"})
_GENERIC = frozenset({"place", "point", "spot", "way", "side", "end"})


def _ends_noun(flat: tuple[str, ...], at: int) -> bool:
    """Whether words say which of a kind, or in what order, and are no part of its name."""
    return bool(in_turn_at(flat, at)) or parity_at(flat, at)[0] >= 0


@dataclass(frozen=True)
class Found:
    """A group and where its words end."""

    items: tuple[MapObject, ...]
    end: int
    each: bool = False
    cut: tuple[int, int] = (0, 0)
    """Words farther on that said what is left out."""


@dataclass(frozen=True, slots=True)
class Uncounted:
    """So many of a kind, as if there were no more, where there are."""

    words: Phrase
    items: tuple[MapObject, ...]


def is_room_for(flat: tuple[str, ...], at: int) -> bool:
    """Whether "space" or "room" at a word is what there is enough of ("any space left"), and no thing."""
    before = flat[at - 1 : at] if at else ()
    return flat[at] in _ROOM and before not in _COUNTABLE and flat[at + 1 : at + 2] in _ROOM_FOR


_ROOM = frozenset({"room", "space"})
_ROOM_FOR = frozenset({("for",), ("to",), ("left",), ("enough",)})
_COUNTABLE = frozenset(
    (word,) for word in ("the", "this", "that", "each", "every", "which", "a", "my", "your")
)


@dataclass
class GroupNouns:
    """What names kinds of things and members of them."""

    objects: Sequence[MapObject]
    pose: Pose2D | None
    facts: Sequence[Remembered]
    named: Callable[[Phrase], Sequence[MapObject]]
    """The things that words before a group have named, for "the others"."""
    _known: dict[tuple[str, ...], tuple[MapObject, ...]] = field(default_factory=dict)
    _last: tuple[MapObject, ...] = ()
    """The group that was named last."""
    _each: bool = False
    _kind: tuple[MapObject, ...] = ()
    """All things of the kind that was named last, for "only the first two"."""
    _plural: tuple[MapObject, ...] = ()
    """The same, if more than one of them was spoken of ("the doors", "neither door")."""
    _kinds_said: frozenset[str] = field(init=False)
    """Words with which the name of a kind of thing may begin."""

    def __post_init__(self) -> None:
        said = {
            singular(part)
            for item in self.objects
            for part in (*item.description.lower().split(), *item.class_name.lower().split())
        }
        lex = lexicon()
        alike = {other.split()[0] for word in said for other in lex.synonyms.get(word, ())}
        kinds = {kind for kind, members in lex.kinds.items() if members & said}
        self._kinds_said = frozenset(said | {singular(word) for word in alike} | kinds)

    def _noun(self, words: Phrase, at: int, lead: Lead) -> tuple[int, tuple[MapObject, ...]]:
        """The longest name of a kind of thing, and all things it fits."""
        for size in range(min(LONGEST_NOUN, len(words) - at), 0, -1):
            part = words[at : at + size]
            if any(not w.is_word or w.key in NO_NOUN for w in part) or len(part[-1].key) < 3:
                continue
            if bare(part)[-1:] != part[-1:] or part[0].key in lexicon().goals_and_places:
                continue
            if len(part) > 2 and any(q.units for q in quantities(part)):
                # "Both seams at 90 amps".
                continue
            if "between" in keys(part) or any(_ends_noun(keys(words), i) for i in range(at + 1, at + size)):
                continue
            if size == 1 and is_room_for(keys(words), at):
                continue
            items = self._things(part)
            if len(items) > 1 or (items and lead.other and size == 1):
                return at + size, items
        return at, ()

    def _things(self, noun: Phrase) -> tuple[MapObject, ...]:
        flat = keys(noun)
        if flat not in self._known:
            last = noun[-1].key
            generic = last in lexicon().generic_things or last.isdigit() or singular(last) in _GENERIC
            found = None if generic else ground_phrase(noun, self.objects, self.pose, strict=True)
            items = () if found is None or found.outcome == "none" else found.candidates
            self._known[flat] = (
                items if len(items) != 1 or singular(last) == last else self._kinds(noun, items)
            )
        return self._known[flat]

    def _kinds(self, noun: Phrase, found: tuple[MapObject, ...]) -> tuple[MapObject, ...]:
        """All things of a kind whose plural names one of them by chance."""
        kind, rest = singular(noun[-1].key), set(keys(noun[:-1]))
        several = tuple(
            item
            for item in self.objects
            if kind in {item.class_name, *item.description.lower().split()[-1:]}
            and rest <= set(item.description.lower().split())
        )
        return several if len(several) > 1 else found

    def _alike(self, named: Sequence[MapObject]) -> tuple[MapObject, ...]:
        """All things of the kind of what was named last."""
        kind = named[-1].class_name if named else ""
        return tuple(item for item in self.objects if kind and item.class_name == kind)

    def _labelled(self, noun: Phrase, parts: Sequence[tuple[str, ...]]) -> tuple[MapObject, ...]:
        """The things of a kind with these numbers or letters; empty unless each part of the row has one."""
        last = noun[-1]
        kind = (*noun[:-1], Word(singular(last.key), singular(last.raw)))
        items: list[MapObject] = []
        for part in parts:
            listed = [labelled(kind, label, self.objects) for label in part]
            there = [item for item in listed if item is not None]
            if not there:
                return ()
            items += there
        return tuple(dict.fromkeys(items)) if len(items) > 1 else ()

    def _placed(
        self, words: Phrase, at: int, items: tuple[MapObject, ...]
    ) -> tuple[tuple[MapObject, ...], int]:
        """Those of a group that are where the words behind it say, and where these end."""
        flat = keys(words)
        end = at + 1 if flat[at : at + 1] in {("that",), ("which",)} else at
        end += flat[end : end + 1] in {("are",), ("is",)} and end > at
        found = lexicon().places.match(flat, end)
        if found is None or found[1] in {"of", "from", "with"}:
            return items, at
        start = end + found[0]
        for size in range(min(LONGEST_NOUN + 1, len(words) - start), 0, -1):
            part = words[start : start + size]
            if any(not word.is_word for word in part) or not bare(part):
                continue
            where = ground_phrase(part, [o for o in self.objects if o not in items], self.pose, strict=True)
            if where.outcome != "match":
                continue
            there = spatial.all_at(items, found[1], where.candidates[0], self.pose)
            return (tuple(there), start + size) if there else (items, at)
        return items, at

    def _left_out(
        self, words: Phrase, at: int, items: Sequence[MapObject], noun: Phrase
    ) -> tuple[tuple[MapObject, ...], int]:
        """What an exception names, and where it ends; nothing if that cannot be told."""
        flat = keys(words)
        size = next(
            (len(m) for m in _POINTED_OUT if flat[at : at + len(m)] == m and stops(words, at + len(m))), 0
        )
        if size:
            return self._spoken_of(words[:at], items), at + size
        counted = flat[at : at + 1] and (flat[at][0].isdigit() or "one" in flat[at : at + 2])
        lead, start = (Lead(), at) if counted else read_lead(words, at)
        if lead.end or lead.ordinals:
            return chosen(items, lead, self.pose), start
        place = (
            -1
            if flat[start : start + 1] == ("last",)
            else lexicon().ordinals.get("".join(flat[start : start + 1]), 0)
        )
        if place and (stops(words, start + 1) or flat[start + 1] == "one"):
            end = start + 1 + (flat[start + 1 : start + 2] == ("one",))
            return (tuple(items[place - 1 : place]) if place > 0 else tuple(items[-1:])), end
        parts, end = labels_at(words, start)
        if parts:
            kind = (*noun[:-1], Word(singular(noun[-1].key), singular(noun[-1].raw)))
            named = [labelled(kind, label, items) for part in parts for label in part]
            gone = tuple(item for item in named if item is not None)
            return (gone, end) if gone else ((), at)
        return self._named_out(words, start, items, noun)

    def _spoken_of(self, words: Phrase, items: Sequence[MapObject]) -> tuple[MapObject, ...]:
        """The one of a group that the clauses before have named, for "all but that one"."""
        flat = keys(words)
        clause = next(
            (i for i in range(len(flat) - 1, 0, -1) if flat[i] in _JOINTS or not words[i].is_word), 0
        )
        named = [item for item in self.named(words[:clause]) if item in items]
        return tuple(named[-1:])

    def _named_out(
        self, words: Phrase, at: int, items: Sequence[MapObject], noun: Phrase
    ) -> tuple[tuple[MapObject, ...], int]:
        """For "except the red one and the hall": things by their names or by what tells them apart."""
        gone: list[MapObject] = []
        end = at
        while True:
            size, found = self._one_of(words, end, items, noun)
            if not size:
                break
            gone, end = [*gone, *found], end + size
            joint = end
            while keys(words[joint : joint + 1]) in {(",",), ("and",), ("or",), ("the",), ("nor",)}:
                joint += 1
            if joint == end or not self._one_of(words, joint, items, noun)[0]:
                break
            end = joint
        return tuple(gone), end

    def _one_of(
        self, words: Phrase, at: int, items: Sequence[MapObject], noun: Phrase
    ) -> tuple[int, tuple[MapObject, ...]]:
        kind = Word(singular(noun[-1].key), singular(noun[-1].raw))
        for size in range(min(LONGEST_NOUN + 2, len(words) - at), 0, -1):
            part = words[at : at + size]
            is_in = part[-1].key in lexicon().be and bool({"where", "one"} & set(keys(part[1:3])))
            if any(not word.is_word for word in part) or (part[-1].key in NO_NOUN and not is_in):
                continue
            body = bare(part)
            ends = body and body[-1].key in {"one", "ones"}
            # "The red one", and "the one by the window".
            pointed = next((i for i, w in enumerate(body) if w.key in {"one", "ones"}), -1)
            behind = tuple(word for word in body[pointed + 1 :] if word.key not in _WHICH_GOES)
            named = (*body[:pointed], kind, *behind) if pointed >= 0 else body
            if size == 1 and len(named) == 1 and not pointed >= 0:
                alike = [i for i in items if named[0].key in i.description.lower().split()]
                if alike and len(alike) < len(items) and named[0].key not in keys(noun):
                    return 1, tuple(alike)
            for phrase in (named,) if pointed >= 0 or ends else (named, (*body, kind)):
                found = ground_phrase(phrase, self.objects, self.pose, among=items, strict=True)
                if found.outcome == "match" and phrase:
                    return size, found.candidates[:1]
            holder = self._holder(part, items)
            if holder is not None:
                return size, (holder,)
        one = keys(words[at : at + 2]) in {("the", "one"), ("that", "one")}
        called = self._called_behind(words, at + 2, tuple(items), noun) if one else None
        return (called.end - at, called.items) if called is not None else (0, ())

    def _called_behind(
        self, words: Phrase, end: int, items: tuple[MapObject, ...], noun: Phrase
    ) -> Found | None:
        """For "the field up north", "the escalator that goes up", "the lift marked staff"."""
        at = end
        while keys(words[at : at + 1]) and words[at].key in _LEADING_TO_NAME:
            at += 1
        for begin in range(end, at + 1):
            for size in range(min(3, len(words) - begin), 0, -1):
                part = words[begin : begin + size]
                labelled = len(part[-1].key) == 1 or part[-1].key.isdigit()
                if labelled or any(not word.is_word for word in part) or not stops(words, begin + size):
                    continue
                alike = [i for i in items if set(keys(part)) <= set(i.description.lower().split())]
                if len(alike) == 1 and not set(keys(part)) <= set(keys(noun)):
                    return Found((alike[0],), begin + size)
        return None

    def _holder(self, body: Phrase, items: Sequence[MapObject]) -> MapObject | None:
        """For "the one with the box", "the one A is in" and "A's": the one of a group where something is."""
        pointed = next((i for i, word in enumerate(body[:2]) if word.key in {"one", "ones"}), -1)
        if pointed >= 0:
            what = tuple(word for word in body[pointed + 1 :] if word.key not in _LINKING)
        else:
            last = body[-1] if body else None
            if last is None or not last.key.endswith("'s"):
                return None
            what = (*body[:-1], Word(last.key[:-2], last.raw[:-2]))
        what = bare(what)
        known = find_fact(what, self.facts)[0] if what else None
        if known is not None and known.fact.place:
            there = ground_phrase(known.fact.place, self.objects, self.pose, among=items, strict=True)
            return there.candidates[0] if there.outcome == "match" else None
        found = ground_phrase(what, self.objects, self.pose, strict=True) if what and pointed >= 0 else None
        if found is None or found.outcome != "match":
            return None
        near = spatial.nearest_to(items, found.candidates[0].x_m, found.candidates[0].y_m)
        return near[0] if len(near) == 1 and near[0] != found.candidates[0] else None

    def _remembered_so(self, words: Phrase, at: int) -> Found | None:
        """For "the rooms with oxygen", where it is remembered which these are."""
        for known in self.facts:
            fact = known.fact
            about = keys(bare(fact.subject))
            if fact.relation not in lexicon().be or len(about) < 2 or not fact.state or fact.negated:
                continue
            if [singular(k) for k in keys(words[at : at + len(about)])] != [singular(k) for k in about]:
                continue
            found = [ground_phrase(part, self.objects, strict=True) for part in coordinated(fact.state)]
            items = tuple(one.candidates[0] for one in found if one.outcome == "match")
            if len(items) == len(found) > 1:
                return Found(items, at + len(about), True)
        return None
