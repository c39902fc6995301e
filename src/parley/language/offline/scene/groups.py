"""Groups of things named in a message: "aisles 2 to 4", "all doors but the red one", "the last two boxes".

Each is found on the map before the sentence around it is read, and stands in it as one word (`marks`), so
that no way of putting a sentence has to know the ways of naming groups.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.group_nouns import Found
from parley.language.offline.scene.group_pointing import GroupPointing
from parley.language.offline.scene.group_words import (
    Lead,
    exception_at,
    in_turn_at,
    labels_at,
    may_lead,
    open_range_at,
    read_lead,
    stops,
)
from parley.language.offline.scene.marks import marked
from parley.language.offline.scene.members import chosen, in_order, numbered_from
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["GroupReader"]


_SAYING_STATE = frozenset({"is", "are", "if", "whether", "that", "see", "sure"})


@dataclass
class GroupReader(GroupPointing):
    """Finds the groups of one message, from its start to its end."""

    def read(self, words: Phrase) -> Phrase:
        """The message with a word for each group."""
        result: list[Word] = []
        index, skip = 0, (0, 0)
        while index < len(words):
            if index == skip[0] < skip[1]:
                index = skip[1]
                continue
            found = self._at(words, index) if self._may_begin(words[index]) else None
            if found is None:
                result.append(words[index])
                index += 1
                continue
            said = plain(words[index : found.end])
            if len(found.items) == 1:
                the = (Word("the", "the"),)
                result += (*the, *tokens(describe(found.items[0], self.objects)))
            else:
                word = marked(found.items, said)
                if keys(result[-2:]) == (word.key, ","):
                    # "The doors, all of them".
                    result[-2:] = []
                result.append(word)
                self._last, self._each = found.items, found.each
            index, skip = found.end, found.cut if found.cut[1] else skip
        return tuple(result)

    def _may_begin(self, word: Word) -> bool:
        """Whether a group may begin with a word; most words are passed over by this."""
        return word.is_word and (may_lead(word.key) or singular(word.key) in self._kinds_said)

    def _at(self, words: Phrase, start: int) -> Found | None:
        """The group that begins at a word, if one does."""
        beside = (
            self._neighbour(words, start) or self._where_it_is(words, start) or self._pointed(words, start)
        )
        if beside is not None:
            return beside
        lead, at = read_lead(words, start)
        end, items = self._noun(words, at, lead)
        self._kind = items or self._kind
        before = keys(words[start - 1 : start])[:1] if start else ()
        if (before in {("not",), ("than",)} and lead.everything) or (
            lead.free and lead.count < 2 and before and before[0] in _CHOOSING
        ):
            return None
        told = self._remembered_so(words, at) if lead.everything or lead.definite else None
        told = (
            told or self._numbers_behind(words, at, end, items, lead) or self._nth(words, end, items, start)
        )
        if told is not None:
            return told
        if not items and lead.other and stops(words, at):
            items = self._alike((*self.named(words[:start]), *self._last))
        if not items:
            return None
        noun = words[at:end] or tokens(items[0].class_name or items[0].description)
        open_end = open_range_at(keys(words), end)
        if open_end is not None:
            low, high, end = open_end
            items = numbered_from(items, low, high)
            return Found(items, end, lead.each) if items else None
        parts, after = labels_at(words, end)
        if parts:
            items, end = self._labelled(noun, parts), after
            lead.listed = not lead.says_something
            if not items:
                return None
        elif not self._plural_or_counted(noun, lead):
            return None
        group = self._with_rest(words, start, Found(items, end, lead.each), lead, noun)
        several = parts or lead.says_something
        return group if group is not None and (several or group.end > end or group.cut[1]) else None

    def _with_rest(self, words: Phrase, start: int, found: Found, lead: Lead, noun: Phrase) -> Found | None:
        """With what is said behind the noun, and what the words before it choose."""
        items, end = self._placed(words, found.end, found.items)
        before = (*self.named(words[:start]), *self._last) if lead.other else ()
        items = tuple(item for item in items if item not in before)
        if lead.other and (not before or not items):
            return None
        flat = keys(words)
        negated = next((len(m) for m in _THAT_IS_NOT if flat[end : end + len(m)] == m), 0)
        size = exception_at(flat, end) or negated
        if lead.none and not size and (told := self._left_out_later(words, end, items, noun)) is not None:
            return Found(told[0], end, cut=told[1])
        if lead.none:
            return self._none_but(words, start, end, size, items, noun)
        if not size and (later := self._left_out_later(words, end, items, noun)) is not None:
            gone, cut = later
            lead.count = 0
            some = self._chosen(words, start, tuple(i for i in items if i not in gone), end, lead, noun)
            return None if some is None else replace(some, cut=cut)
        if size:
            left_out, after = self._left_out(words, end + size, items, noun)
            if not left_out:
                return (
                    None
                    if flat[end + size - 1] != "but" or _names_one(flat[end + size :])
                    else self._chosen(words, start, items, end, lead, noun)
                )
            items, end = tuple(item for item in items if item not in left_out), after
            lead.count = 0
        elif not (lead.says_something or len(found.items) != len(items)) and len(items) < 2:
            return None
        return self._chosen(words, start, items, end, lead, noun)

    def _none_but(
        self, words: Phrase, start: int, end: int, size: int, items: tuple[MapObject, ...], noun: Phrase
    ) -> Found | None:
        """For "no room except the hall", and for "(make sure that) no door is open"."""
        if size:
            wanted, after = self._left_out(words, end + size, items, noun)
            return Found(wanted, after) if wanted else None
        flat = keys(words)
        said = _SAYING_STATE & set(flat[max(0, start - 3) : start])
        return Found(items, end, True) if said and set(flat[end : end + 1]) & lexicon().be else None

    def _left_out_later(
        self, words: Phrase, at: int, items: Sequence[MapObject], noun: Phrase
    ) -> tuple[tuple[MapObject, ...], tuple[int, int]] | None:
        """For "all boxes and the desk, but not the red box": what is left out, and where that is said."""
        flat = keys(words)
        for index in range(at + 1, min(at + 12, len(flat))):
            if flat[index] in {".", "!", "?", ";", "then"}:
                return None
            size = exception_at(flat, index)
            said = flat[index : index + size]
            if not size or not ("not" in said or set(said) & _PLAINLY_WITHOUT):
                continue
            gone, end = self._left_out(words, index + size, items, noun)
            told = flat[at] in _RELATIVE
            return (gone, (at if told else index, end)) if gone and stops(words, end) else None
        return None

    def _chosen(
        self, words: Phrase, start: int, items: tuple[MapObject, ...], end: int, lead: Lead, noun: Phrase
    ) -> Found | None:
        flat = keys(words)
        if lead.free and lead.count == 1 and flat[end : end + 2] in {("after", "the"), ("after", "another")}:
            return Found(items, end + (3 if flat[end + 1] == "the" else 2), True)
        if (
            lead.free
            and lead.count == 1
            and flat[end : end + 1]
            and flat[end] in lexicon().be | {"needs", "has"}
        ):
            # "One of the doors is open": that tells, and chooses none.
            return None
        if lead.free and lead.count < 2 and _SAYING_STATE & set(flat[max(0, start - 4) : start]):
            # "Whether any door is open": each of them has to be looked at.
            return Found(items, end, True)
        end += in_turn_at(flat, end)
        near, size = _whichever(flat, end)
        if near:
            lead.where, end = near, end + size
        if lead.free and lead.count == 1 and flat[end : end + 1] == (",",):
            # "One door, the red one".
            size, told = self._one_of(words, end + 1, items, noun)
            if size and stops(words, end + 1 + size):
                return Found(told, end + 1 + size)
        if not lead.where:
            end += _no_matter(flat, end)
        if lead.every_other:
            begun = self._begun_with(words, items, end, noun)
            if begun is not None:
                row = in_order(items)
                return Found(tuple(row[row.index(begun[0][0]) :: 2]), begun[1])
        some = chosen(items, lead, self.pose)
        if not some:
            return None
        some, end = self._ranked(words, some, end, noun)
        return Found(some, end, lead.each)

    def _ranked(
        self, words: Phrase, items: tuple[MapObject, ...], end: int, noun: Phrase
    ) -> tuple[tuple[MapObject, ...], int]:
        """For "all doors, the red one last": the group in that order."""
        flat = keys(words)
        begun = self._begun_with(words, items, end, noun)
        if begun is not None:
            return begun
        start = end + (flat[end : end + 1] == (",",))
        start += flat[start : start + 1] in {("but",), ("with",), ("and",)} and start > end
        size, found = self._one_of(words, start, items, noun) if start > end and len(items) > 2 else (0, ())
        if not size or len(found) > 1:
            return items, end
        rank = next((r for r in _RANKS if flat[start + size : start + size + len(r)] == r), ())
        if not rank:
            return items, end
        rest = tuple(item for item in items if item not in found)
        first = rank[-1] in {"first", "with", "begin"}
        return ((*found, *rest) if first else (*rest, *found)), start + size + len(rank)

    def _begun_with(
        self, words: Phrase, items: tuple[MapObject, ...], end: int, noun: Phrase
    ) -> tuple[tuple[MapObject, ...], int] | None:
        """For "all doors, starting with the red one": that one first; for "ending with" last."""
        flat = keys(words)
        at = end
        while flat[at : at + 1] and flat[at] in {",", "but", "and", "please"}:
            at += 1
        if flat[at : at + 1] == () or flat[at] not in _BEGINNING | _ENDING:
            return None
        link = at + 1
        if flat[link : link + 1] not in {("with",), ("at",), ("by",), ("from",), ("in",), ("on",)}:
            return None
        size, found = self._one_of(words, link + 1, items, noun)
        if not size or len(found) != 1 or not stops(words, link + 1 + size):
            return None
        rest = tuple(item for item in items if item not in found)
        ordered = (*found, *rest) if flat[at] in _BEGINNING else (*rest, *found)
        return ordered, link + 1 + size

    def _plural_or_counted(self, noun: Phrase, lead: Lead) -> bool:
        plural = singular(noun[-1].key) != noun[-1].key or (lead.other and lead.count > 1)
        return plural or lead.none or lead.each or lead.free or bool(lead.ordinals) or lead.every_other


_RANKS = (
    ("last", "of", "all"),
    ("at", "the", "end"),
    ("at", "last"),
    ("to", "finish"),
    ("to", "begin", "with"),
    ("to", "start", "with"),
    ("last",),
    ("first",),
)


def _names_one(behind: tuple[str, ...]) -> bool:
    """Whether words behind "but" begin to name something, rather than an order or a remark."""
    return behind[1:2] in {("one",), ("ones",)} and behind[0] in {"the", "that", "those"}


_NO_MATTER = tuple(
    tuple(text.split())
    for text in (
        "i do not mind",
        "i do not care",
        "i have no preference",
        "no preference",
        "it does not matter",
        "i do not care which one",
        "i do not care which",
        "i do not mind which one",
        "i do not mind which",
        "no matter which one",
        "no matter which",
        "whichever you like",
        "whichever",
        "it does not matter which",
        "does not matter which",
        "whichever one you like",
        "your choice",
        "you choose",
        "you pick",
    )
)
_BEGINNING = frozenset({"start", "starting", "begin", "beginning"})
_ENDING = frozenset({"end", "ending", "finish", "finishing"})
_PLAINLY_WITHOUT = frozenset({"except", "excepting", "apart", "excluding", "barring", "other"})
_RELATIVE = frozenset({"that", "which", "i", "we", "you", "they", "who"})
_THAT_IS_NOT = tuple((who, link, "not") for who in ("that", "which") for link in ("is", "are"))
_CHOOSING = frozenset({"pick", "choose", "select", "take"})


def _no_matter(flat: tuple[str, ...], at: int) -> int:
    """How many words at `at` say that any will do."""
    comma = int(flat[at : at + 1] == (",",))
    size = next((len(m) for m in _NO_MATTER if flat[at + comma : at + comma + len(m)] == m), 0)
    return size + comma if size else 0


def _whichever(flat: tuple[str, ...], at: int) -> tuple[str, int]:
    """For ", whichever are closest (to you)": "near" or "far", and how many words say so."""
    start = at + (flat[at : at + 1] == (",",))
    if flat[start : start + 1] not in {("whichever",), ("whatever",), ("that",), ("which",)}:
        return "", 0
    link = start + 1
    how = link + 1 + (flat[link + 1 : link + 2] == ("the",))
    if flat[link : link + 1] not in {("are",), ("is",)} or not flat[how : how + 1]:
        return "", 0
    where = "near" if flat[how] in _NEARER else "far" if flat[how] in _FARTHER else ""
    end = how + 1 + (2 if flat[how + 1 : how + 3] in _TO_YOU else 0)
    return (where, end - at) if where else ("", 0)


_NEARER = frozenset({"nearest", "closest", "nearer", "closer"})
_FARTHER = frozenset({"farthest", "furthest", "farther", "further"})
_TO_YOU = frozenset({("to", "you"), ("from", "you"), ("from", "here"), ("to", "here")})
