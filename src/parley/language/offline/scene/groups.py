"""Groups of things named in a message: "aisles 2 to 4", "all doors but the red one", "the last two boxes".

Each is found on the map before the sentence around it is read, and stands in it as one word (`marks`), so
that no way of putting a sentence has to know the ways of naming groups.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.scene.floating import with_how_many
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.group_nouns import Found, Uncounted
from parley.language.offline.scene.group_pointing import GroupPointing
from parley.language.offline.scene.group_words import (
    Lead,
    exception_at,
    in_turn_at,
    labels_at,
    may_lead,
    open_range_at,
    parity_at,
    read_lead,
    stops,
)
from parley.language.offline.scene.marks import marked
from parley.language.offline.scene.members import alike, chosen, in_order, in_series, numbered_from
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["GroupReader"]


_AFTER_COUNTED = frozenset(
    {"and", "or", "then", "please", "for", "if", "whether", "first", "now", "today", "too", "but", "so"}
)


_SAYING_STATE = frozenset({"is", "are", "if", "whether", "that", "see", "sure"})


def _asks_of_each(flat: tuple[str, ...], start: int) -> bool:
    """Whether what stands before a group asks how things are there."""
    if _SAYING_STATE & set(flat[max(0, start - 4) : start]):
        return True
    begin = next((i + 1 for i in range(start - 1, -1, -1) if flat[i] in _MARKS), 0)
    before = flat[begin:start]
    return before[:1] != () and before[0] in lexicon().be and not {"to", "it", "you"} & set(before)


_MARKS = frozenset(".,;:!?")
_WHOLE_MAP = frozenset({"everything", "everywhere"})


@dataclass
class GroupReader(GroupPointing):
    """Finds the groups of one message, from its start to its end.

    Args:
        pronouns: Whether "them" and "each of them" are groups too.
    """

    pronouns: bool = True
    uncounted: Uncounted | None = None
    """So many of more that nothing tells which."""
    _plural_at: tuple[int, int] = (-1, 0)
    """Where several of a kind were spoken of that are no group yet."""

    def read(self, words: Phrase) -> Phrase:
        """The message with a word for each group."""
        words = with_how_many(words, self._kinds_said.__contains__)
        result: list[Word] = []
        places: dict[int, int] = {}
        index, skip = 0, (0, 0)
        while index < len(words):
            if index == skip[0] < skip[1]:
                index = skip[1]
                continue
            found = self._at(words, index) if self._may_begin(words[index]) else None
            if found is None:
                places[index] = len(result)
                result.append(words[index])
                index += 1
                continue
            first, last = self._plural_at
            behind = last + in_turn_at(keys(words), last)
            if (
                found.items == self._plural
                and first in places
                and keys(words[behind : behind + 1]) in _ENDING_ORDER
            ):
                # "Go to the doors and look at each of them": the doors, one by one.
                result[places[first] : places[first] + last - first] = [
                    marked(found.items, plain(words[first:last]))
                ]
            self._plural_at = (-1, 0)
            said = plain(words[index : found.end])
            name = tokens(describe(found.items[0], self.objects))
            if len(found.items) == 1 and self._is_name(name, found.items[0]):
                labelled = name[-1].key.isdigit() or len(name[-1].key) == 1
                result += name if labelled else (Word("the", "the"), *name)
                self._last = found.items if self._chosen_freely(words, index) else self._last
            else:
                word = marked(found.items, said)
                if keys(result[-2:]) == (word.key, ","):
                    # "The doors, all of them".
                    result[-2:] = []
                if keys(result[-1:]) == ("take",) and self._in_turn(words, found.end):
                    # "Take the rooms one by one": that is going there.
                    result[-1:] = tokens("go to")
                result.append(word)
                self._last, self._each = found.items, found.each
            index, skip = found.end, found.cut if found.cut[1] else skip
        return tuple(result)

    def _is_name(self, words: Phrase, item: MapObject) -> bool:
        """Whether words that name one thing are read so wherever they stand."""
        if words[-1].key in _PARTICLES:
            return False
        # An identifier ("watch_1") may look like an order.
        return describe(item, self.objects) != item.id or lexicon().verbs.match(keys(words)) is None

    def _in_turn(self, words: Phrase, end: int) -> bool:
        """Whether the words before `end` say that it is one after the other."""
        flat = keys(words[:end])
        return any(in_turn_at(flat, at) == end - at for at in range(max(0, end - 6), end))

    def _chosen_freely(self, words: Phrase, start: int) -> bool:
        """Whether one of several was taken, so that "one of them" is that one."""
        return read_lead(words, start)[0].free

    def _behind_comma(self, words: Phrase, start: int) -> bool:
        """For "the doors, all of them": no more than the doors."""
        return keys(words[start - 1 : start]) == (",",) and words[start].key in {"all", "both", "each"}

    def _may_begin(self, word: Word) -> bool:
        """Whether a group may begin with a word; most words are passed over by this."""
        leads = may_lead(word.key) or word.key in {"what", "whatever"} | _WHOLE_MAP
        return word.is_word and (leads or singular(word.key) in self._kinds_said)

    def _at(self, words: Phrase, start: int) -> Found | None:
        """The group that begins at a word, if one does."""
        pointed = self._pointed if self.pronouns or self._behind_comma(words, start) else self._elided
        beside = (
            self._all_but(words, start)
            or self._neighbour(words, start)
            or self._where_it_is(words, start)
            or self._best_of(words, start)
            or self._told_which(words, start)
            or (pointed(words, start) if self._last or self._kind else None)
        )
        if beside is not None:
            return beside
        lead, at = read_lead(words, start)
        end, items = self._noun(words, at, lead)
        self._kind = items or self._kind
        if items and (
            singular(words[end - 1].key) != words[end - 1].key or words[start - 1].key == "neither"
        ):
            self._plural, self._plural_at = items, (start, end)
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
        parity, after = parity_at(keys(words), end)
        if parity >= 0:
            lead.parity, end = parity, after
        in_turn = in_turn_at(keys(words), end)
        open_end = None if in_turn else open_range_at(keys(words), end)
        if open_end is not None:
            low, high, end = open_end
            items = numbered_from(items, low, high)
            return Found(items, end, lead.each) if items else None
        much = next(iter(quantities(words[end : end + 3])), None)
        measured = much is not None and bool(much.units) and not much.start
        parts, after = ([], end) if in_turn or measured else labels_at(words, end)
        them = 0 if parts else _all_of_them(keys(words), end)
        lead.everything, end = lead.everything or them > 0, end + them
        if parts:
            items, end = self._labelled(noun, parts), after
            lead.listed = not lead.says_something
            if not items:
                return None
        elif not (at == end and keys(words[start:at]) in _OTHERS) and not self._plural_or_counted(noun, lead):
            return None
        group = self._with_rest(words, start, Found(items, end, lead.each), lead, noun)
        several = parts or lead.says_something
        return group if group is not None and (several or group.end > end or group.cut[1]) else None

    def _all_but(self, words: Phrase, start: int) -> Found | None:
        """For "look at everything but A and B": all that is on the map but those."""
        flat = keys(words)
        size = exception_at(flat, start + 1) if flat[start] in _WHOLE_MAP else 0
        begin = next((i + 1 for i in range(start - 1, -1, -1) if flat[i] in _MARKS), 0)
        verbs = (lexicon().verbs.match(flat, i) for i in range(begin, start)) if size else ()
        if not any(verb is not None and verb[1].startswith(("look:", "motion:")) for verb in verbs):
            # What robots do in their own ways is done to one kind of thing.
            return None
        gone, end = self._left_out(words, start + 1 + size, self.objects, tokens("thing"))
        if not gone:
            # "But the doors": all of a kind.
            lead, at = read_lead(words, start + 1 + size)
            end, gone = self._noun(words, at, lead)
        items = tuple(item for item in self.objects if item not in gone)
        return Found(items, end, True) if gone and len(items) > 1 and stops(words, end) else None

    def _with_rest(self, words: Phrase, start: int, found: Found, lead: Lead, noun: Phrase) -> Found | None:
        """With what is said behind the noun, and what the words before it choose."""
        items, end = self._placed(words, found.end, found.items)
        before = (*self.named(words[:start]), *self._last) if lead.other else ()
        items = alike(tuple(item for item in items if item not in before), before)
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
            items, end = tuple(item for item in items if item not in left_out), _past_reason(words, after)
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
            end = _past_reason(words, end)
            told = flat[at] in _RELATIVE
            return (gone, (at if told else index, end)) if gone and stops(words, end) else None
        return None

    def _chosen(
        self, words: Phrase, start: int, items: tuple[MapObject, ...], end: int, lead: Lead, noun: Phrase
    ) -> Found | None:
        flat = keys(words)
        if lead.free and lead.count == 1 and flat[end : end + 2] in {("after", "the"), ("after", "another")}:
            return Found(items, end + (3 if flat[end + 1] == "the" else 2), True)
        enough = next((len(m) for m in _ENOUGH if flat[end : end + len(m)] == m), 0)
        if lead.free and enough and stops(words, end + enough):
            # "Any door will do, go to one of them".
            return Found(chosen(items, lead, self.pose), end + enough)
        if (
            lead.free
            and lead.count == 1
            and flat[end : end + 1]
            and flat[end] in lexicon().be | {"needs", "has"}
        ):
            # "One of the doors is open": that tells, and chooses none.
            return None
        if lead.free and lead.count < 2 and _asks_of_each(flat, start):
            # "Whether any door is open", "is there a bag at any of them": each of them has to be looked at.
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
            return self._counted_before(words, start, items, end, lead)
        some, end = self._ranked(words, some, end, noun)
        return Found(some, end, lead.each)

    def _counted_before(
        self, words: Phrase, start: int, items: tuple[MapObject, ...], end: int, lead: Lead
    ) -> Found | None:
        """For "the two doors" where there are three: those that were spoken of; noted if nothing tells."""
        if lead.free or not 1 < lead.count < len(items) or not (lead.definite or lead.everything):
            return None
        spoken_of = (*self.named(words[:start]), *self._last)
        before = tuple(dict.fromkeys(item for item in spoken_of if item in items))
        kind = singular(words[end - 1].key)
        called = tuple(item for item in items if kind in item.description.lower().split())
        of_kind = tuple(item for item in items if item.class_name.lower() == kind)
        for some in (before, called, of_kind, *in_series(items)):
            if len(some) == lead.count:
                return Found(some, end, lead.each)
        if end >= len(words) or not words[end].is_word or words[end].key in _AFTER_COUNTED:
            self.uncounted = Uncounted(words[start:end], items)
        return None

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
        first = rank[-1] in {"first", "with", "begin"} or rank[0] in {"before", "ahead"}
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


_OTHERS = frozenset({("the", "others"), ("all", "others"), ("all", "the", "others"), ("others",)})
_RANKS = (
    ("before", "the", "others"),
    ("before", "all", "others"),
    ("before", "all", "the", "others"),
    ("before", "the", "rest"),
    ("before", "any", "of", "the", "others"),
    ("ahead", "of", "the", "others"),
    ("after", "the", "others"),
    ("after", "all", "the", "others"),
    ("after", "the", "rest"),
    ("last", "of", "all"),
    ("at", "the", "end"),
    ("at", "last"),
    ("to", "finish"),
    ("to", "begin", "with"),
    ("to", "start", "with"),
    ("last",),
    ("first",),
)


def _all_of_them(flat: tuple[str, ...], at: int) -> int:
    """How many words at `at` say no more than that all of a group are meant (", all of them")."""
    if flat[at : at + 1] != (",",) or flat[at + 1 : at + 2] not in {("all",), ("both",), ("each",)}:
        return 0
    end = at + 2 + 2 * (flat[at + 2 : at + 4] in {("of", "them"), ("of", "those")})
    return (
        end - at if flat[end : end + 1] in {(), (",",), (".",), ("!",), ("?",), ("and",), ("please",)} else 0
    )


def _past_reason(words: Phrase, at: int) -> int:
    """For "except the hall where there is a lesson": the end of what only says why."""
    if keys(words[at : at + 1]) not in {("where",), ("which",), ("since",), ("because",)}:
        return at
    return next((i for i in range(at, len(words)) if not words[i].is_word), len(words))


def _names_one(behind: tuple[str, ...]) -> bool:
    """Whether words behind "but" begin to name something, rather than an order or a remark."""
    return behind[1:2] in {("one",), ("ones",)} and behind[0] in {"the", "that", "those"}


_WHICH = ("", "which", "which one")
_CARELESS = ("i do not mind", "i do not care", "it does not matter", "does not matter", "no matter")
_FREELY = ("i have no preference", "no preference", "whichever", "whichever you like", "your choice",
           "you choose", "whichever one you like", "you pick")  # fmt: skip
_NO_MATTER = sorted(
    (*(tuple(f"{said} {which}".split()) for said in _CARELESS for which in _WHICH),
     *(tuple(said.split()) for said in _FREELY)), key=len, reverse=True
)  # fmt: skip
_ENOUGH = (("will", "do"), ("would", "do"), ("is", "fine"), ("is", "ok"), ("is", "enough"), ("is", "good"))
_ENDING_ORDER = frozenset({(",",), ("and",), ("then",), (".",), (";",)})
_PARTICLES = frozenset({"up", "down", "in", "out", "on", "off", "over"})
"""A name that ends so would be read as part of the verb."""
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
