"""Groups and things that are pointed at: by a pronoun, by what is beside them, by a number behind them."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.scene.choosing import strip_lead_ins
from parley.language.offline.scene.grounding import BESIDE, ground_phrase, uncounted, with_kinds
from parley.language.offline.scene.group_nouns import LONGEST_NOUN, NO_NOUN, Found, GroupNouns
from parley.language.offline.scene.group_words import (
    BETTER,
    Lead,
    labels_at,
    read_lead,
    stops,
)
from parley.language.offline.scene.members import chosen, in_order, neighbour
from parley.language.offline.scene.sided import is_side
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import coordinated
from parley.language.offline.words.text import Phrase, Word, keys, singular
from parley.world.object_map import MapObject

__all__ = ["GroupPointing"]


_PRONOUNS = frozenset({"them", "those", "these"})
_AFTER_PRONOUN = frozenset({"all", "both", "each"})


@dataclass
class GroupPointing(GroupNouns):
    """How groups are pointed at."""

    def _pointed(self, words: Phrase, start: int) -> Found | None:
        """For "them", "each of them", "both" and "one of them" behind a group."""
        flat = keys(words)
        if self._kind and (some := self._elided(words, start)) is not None:
            return some
        group = self._last or self._plural or self._kind
        if not group:
            return None
        if flat[start] == "they":
            link = keys(words[start + 1 : start + 2])
            return Found(group, start + 1, True) if self._last and link and link[0] in lexicon().be else None
        if flat[start] in {"them", "those"}:
            more = flat[start + 1 : start + 2]
            ends = more == () or more[0] not in {"who", "that", "which", "with"}
            noun = flat[start] == "those" and not stops(words, start + 1)
            size = 1 + (more[:1] != () and more[0] in _AFTER_PRONOUN)
            several = self._last or self._plural
            return Found(group, start + size, self._each) if several and ends and not noun else None
        if flat[start] == "it" and self._last and self._each:
            return Found(self._last, start + 1, True)
        lead, at = read_lead(words, start)
        if not (lead.everything or lead.count or lead.free):
            return None
        if start and words[start - 1].key in {"before", "after"}:
            # "Before both of them, V": before both orders.
            return None
        if start and words[start - 1].key in _NOT_BEFORE_ALL and words[start].key == "all":
            return None
        of = lead.of or flat[at - 1] == "of"
        pronoun = of and flat[at : at + 1] and flat[at] in _PRONOUNS
        if pronoun and not (self._last or self._plural):
            # "A, then B. Look at each of them": not all of their kind.
            return None
        alone = lead.everything and not lead.definite and stops(words, at)
        one = flat[at : at + 1] == ("one",) and lead.everything and stops(words, at + 1)
        if not (pronoun or alone or one):
            return None
        picked = chosen(group, lead, self.pose)
        return Found(picked, at + bool(pronoun or one), True) if picked else None

    def _elided(self, words: Phrase, start: int) -> Found | None:
        """For "the first two" and "only the outer ones" behind "doors"."""
        lead, at = read_lead(words, start)
        told = self._told_apart(words, start) if words[start].key == "the" else None
        if told is not None:
            return told
        place = lexicon().ordinals.get(words[at].key, 0) if at < len(words) else 0
        if (
            self._plural
            and lead.definite
            and keys(words[at + 1 : at + 2]) == ("one",)
            and stops(words, at + 2)
        ):
            # "Look at the last two doors and then at the first one".
            row = in_order(self._plural)
            nth = len(row) if words[at].key == "last" else place
            return Found((row[nth - 1],), at + 2) if 0 < nth <= len(row) else None
        if not lead.definite or not (lead.end or lead.where or lead.ordinals or lead.parity >= 0):
            return None
        end = at + (keys(words[at : at + 1]) in {("ones",), ("one",)})
        some = chosen(self._kind, lead, self.pose) if stops(words, end) else ()
        return Found(some, end) if some else None

    def _told_apart(self, words: Phrase, start: int) -> Found | None:
        """For "the new" behind "tractors": the one of them that is called so."""
        for size in (1, 2):
            part = keys(words[start + 1 : start + 1 + size])
            ends = start + 1 + size >= len(words) or not words[start + 1 + size].is_word
            if len(part) < size or not ends or not all(word.isalpha() for word in part):
                continue
            alike = [i for i in self._kind if set(part) <= set(i.description.lower().split()[:-1])]
            if len(alike) == 1 and not self._things(words[start + 1 : start + 1 + size]):
                return Found((alike[0],), start + 1 + size)
        return None

    def _neighbour(self, words: Phrase, start: int) -> Found | None:
        """For "the room after room 12": the next of its kind, by number or in the row they stand in."""
        if words[start].key not in {"the", "that"}:
            return None
        end, items = self._noun(words, start + 1, Lead())
        flat = keys(words)
        step = end + (flat[end : end + 1] in {("right",), ("just",), ("directly",), ("immediately",)})
        way = _STEPS_ALONG.get(flat[step] if step < len(flat) else "", 0)
        if not items or not way:
            return None
        for size in range(min(LONGEST_NOUN, len(words) - step - 1), 0, -1):
            part = words[step + 1 : step + 1 + size]
            if any(not word.is_word for word in part):
                continue
            size_of, found = self._one_of(words, step + 1, items, words[start + 1 : end])
            if not size_of or len(found) != 1:
                return None
            other = neighbour(items, found[0], way)
            return Found((other,), step + 1 + size_of) if other is not None else None
        return None

    def _where_it_is(self, words: Phrase, start: int) -> Found | None:
        """For "the valve next to boiler 3": the one thing that is meant, whatever is to be done with it."""
        if words[start].key in {"what", "whatever"} or keys(words[start : start + 2]) == ("the", "thing"):
            return self._standing_between(words, start)
        exists = keys(words[max(0, start - 2) : start]) in {("there", "is"), ("there", "was")}
        if words[start].key not in {"the", "that"} and not (exists and words[start].key in {"a", "an"}):
            return None
        end, items = self._noun(words, start + 1, Lead())
        noun = words[start + 1 : end]
        flat = keys(words)
        denied = start and flat[start - 1] in {"not", "but", "except", "without"}
        again = not items and self._kind and flat[start : start + 2] == ("the", "one") and not denied
        if again:
            # "The desk by A, then the one by B": which of the desks.
            end, items, noun = start + 2, self._kind, (Word("thing", "thing"),)
        link = end + 2 if flat[end : end + 2] in {("that", "is"), ("which", "is")} else end
        found = lexicon().places.match(flat, link) if items else None
        telling = again or (found is not None and found[1] not in _NOT_TELLING)
        if found is None or not telling or singular(noun[-1].key) != noun[-1].key:
            return None
        first = link + found[0]
        for size in range(min(10, len(words) - first), 0, -1):
            part = words[first : first + size]
            placed = (again and is_side(part)) or self._anchors(part, found[1], noun)
            if any(not word.is_word for word in part) or not placed:
                continue
            phrase = (*noun, *words[link : first + size])
            meant = ground_phrase(phrase, self.objects, self.pose, among=items if again else ())
            if meant.outcome == "match" and meant.candidates[0] in items:
                self._kind = items if len(items) > 1 else self._kind
                return Found(meant.candidates[:1], first + size)
            return None
        return None

    def _standing_between(self, words: Phrase, start: int) -> Found | None:
        """For "(check) what is standing between A and B", "whatever is between them": what is there."""
        flat = keys(words)
        asked = (
            words[start].key == "what" and keys(words[start - 1 : start] if start else ()) not in _LOOKED_AT
        )
        stands = flat[start + 1 : start + 2] != () and flat[start + 1] in lexicon().be | _STANDING | {"thing"}
        at = start + 2
        while at < len(flat) and flat[at] in _STANDING | {"there"}:
            at += 1
        found = lexicon().places.match(flat, at) if stands and not asked else None
        if found is None or "between" not in found[1]:
            return None
        first = at + found[0]
        for size in range(min(10, len(words) - first), 0, -1):
            part = words[first : first + size]
            if any(not word.is_word for word in part):
                continue
            pair = ground_phrase(uncounted(part), self.objects, self.pose, strict=True)
            if self._anchors(part, found[1], ()) or (
                pair.outcome == "ambiguous" and len(pair.candidates) == 2
            ):
                thing = (Word("thing", "thing"), *words[at : first + size])
                meant = ground_phrase(thing, self.objects, self.pose)
                return Found(meant.candidates, first + size) if meant.outcome == "match" else None
        return None

    def _anchors(self, part: Phrase, relation: str, noun: Phrase) -> bool:
        """Whether words name what something is said to be beside, and nothing more."""
        parts = with_kinds(coordinated(part), keys(noun)) if "between" in relation else [part]
        if "between" in relation and len(parts) != 2:
            return False
        found = [ground_phrase(one, self.objects, self.pose, strict=True) for one in parts]
        enough = {"match", "ambiguous"} if relation in BESIDE else {"match"}
        return all(one.outcome in enough for one in found)

    def _best_of(self, words: Phrase, start: int) -> Found | None:
        """For "the bigger of the two racks", "the middle one of the benches": the bigger rack."""
        flat = keys(words)
        of = start + 2 + (flat[start + 2 : start + 3] == ("one",))
        if flat[start] != "the" or flat[of : of + 1] != ("of",) or flat[start + 1] in {"one", "rest", "end"}:
            return None
        lead, at = read_lead(words, of + 1)
        end, items = self._noun(words, at, lead)
        if not lead.definite or not items or singular(words[end - 1].key) == words[end - 1].key:
            return None
        better = BETTER.get(flat[start + 1], flat[start + 1])
        kind = (*words[at : end - 1], Word(singular(words[end - 1].key), singular(words[end - 1].raw)))
        told = (Word(better, better), *kind)
        found = ground_phrase(told, self.objects, self.pose, among=items, strict=True)
        return Found(found.candidates, end) if found.outcome == "match" else None

    def _told_which(self, words: Phrase, start: int) -> Found | None:
        """For "the vase, the white one", "the crane. Not the south one!", "the gate that is called east".

        Several things are called so, and what is said behind it, up to the next sentence, tells which one.
        """
        lead, at = read_lead(words, start)
        several = lead.free and lead.count == 1 and lead.of
        points = words[start].key == "that" and keys(words[max(0, start - 1) : start]) in _BEFORE_THAT
        at = at if lead.definite or several else start + (points or words[start].key in {"a", "an"})
        if at == start or (lead.says_something and not several) or at >= len(words):
            return None
        end, items = self._noun(words, at, Lead())
        noun = words[at:end]
        places = any(lexicon().places.match(keys(noun), i) for i in range(len(noun)))
        if not items or places or (singular(noun[-1].key) == noun[-1].key) is several:
            return None
        direct = None if several else self._called_behind(words, end, items, noun)
        if direct is not None:
            return direct
        seen = 0
        for mark in range(end, min(len(words), end + _FARTHEST_POINTER)):
            if words[mark].is_word:
                continue
            seen += words[mark].key in _SENTENCE_MARKS
            left, after = self._pointers(words, mark, items, noun)
            if len(left) == 1 and after:
                begin = mark if words[mark].key not in _SENTENCE_MARKS else mark + 1
                return Found(tuple(left), end, cut=(begin, after))
            if seen > 1 or (seen and left):
                return None
        return None

    def _pointers(
        self, words: Phrase, mark: int, items: tuple[MapObject, ...], noun: Phrase
    ) -> tuple[list[MapObject], int]:
        """Which of some things the phrases behind a mark mean, and where these end; 0 if none does."""
        left, after = list(items), 0
        while mark < len(words) and not words[mark].is_word:
            if lexicon().verbs.match(keys(words), mark + 1) is not None:
                break
            lead = len(words[mark + 1 :]) - len(strip_lead_ins(words[mark + 1 :]))
            at = mark + 1 + lead
            while keys(words[at : at + 1]) in _BEFORE_POINTER:
                at += 1
            denied = keys(words[at : at + 1]) == ("not",)
            at += denied
            size, found = self._one_of(words, at, items, noun) if at < len(words) else (0, ())
            close = at + size
            while tail := next((m for m in _BEHIND_POINTER if keys(words[close : close + len(m)]) == m), ()):
                close += len(tail)
            ends = close >= len(words) or not words[close].is_word
            if (
                not size
                or not ends
                or not self._points(words[at : at + size], noun, denied=denied or after > 0)
            ):
                break
            left = [item for item in left if (item in found) is not denied]
            mark = after = close
        return left, after

    def _points(self, part: Phrase, noun: Phrase, *, denied: bool) -> bool:
        """Whether words tell one of a kind: "the red one", "the red door" behind "door", "not the red"."""
        flat = keys(part)
        again = singular(noun[-1].key) in {singular(key) for key in flat[1:]} or flat[-1:] == (noun[-1].key,)
        return denied or again or "one" in flat

    def _numbers_behind(
        self, words: Phrase, at: int, end: int, items: tuple[MapObject, ...], lead: Lead
    ) -> Found | None:
        """For "the two rooms, 11 and 13" and "all patient rooms, 11 to 14": those with these numbers."""
        if not items and at + 1 < len(words) and words[at].is_word and words[at].key not in NO_NOUN:
            end, items = self._noun(words, at + 1, lead)
            at += 1
        if not items or not (lead.everything or lead.count > 1 or lead.definite):
            return None
        flat = keys(words)
        start = end + (flat[end : end + 1] == ("please",))
        if flat[start : start + 1] not in {(",",), (":",)}:
            return None
        namely = next((len(m) for m in _NAMELY if flat[start + 1 : start + 1 + len(m)] == m), 0)
        parts, after = labels_at(words, start + 1 + namely)
        numbers = [label for part in parts for label in part]
        fitting = self._labelled(words[at:end], parts) if len(numbers) > 1 and stops(words, after) else ()
        counted = lead.count in {0, len(fitting)}
        return Found(fitting, after, lead.each) if fitting and counted else None

    def _nth(self, words: Phrase, end: int, items: tuple[MapObject, ...], start: int) -> Found | None:
        """For "the last aisle": of things that have numbers."""
        flat = keys(words)
        if flat[start] != "the" or flat[start + 1 : start + 2] != ("last",) or items:
            return None
        end, items = self._noun(words, start + 2, Lead())
        places = lexicon().places.match(flat, end) if items else None
        numbered = items and all(item.description.split()[-1].isdigit() for item in items)
        return Found((in_order(items)[-1],), end) if numbered and places is None else None


_LOOKED_AT = frozenset({("check",), ("see",), ("inspect",), ("at",), ("examine",)})
_STANDING = frozenset({
    "standing", "lying", "parked", "sitting", "placed", "located", "left", "stands", "lies", "sits",
})  # fmt: skip
_NAMELY = (
    ("namely",),
    ("that", "is"),
    ("to", "be", "precise"),
    ("being",),
    ("specifically",),
    ("these", "are"),
)
_BEFORE_THAT = frozenset(
    (word,) for word in ("to", "at", "in", "on", "of", "by", "into", "check", "inspect", "see", "visit")
) | {()}
_FARTHEST_POINTER = 12
_SENTENCE_MARKS = frozenset({".", "!", "?", ";"})
_BEFORE_POINTER = frozenset(
    {("but",), ("and",), ("just",), ("only",), ("specifically",), ("namely",), ("so",)}
)
_BEHIND_POINTER = (
    ("on", "it"), ("in", "it"), ("at", "it"), ("by", "it"), ("there",),
    ("i", "mean"), ("i", "meant"), ("i", "think"), ("i", "believe"), ("i", "guess"), ("that", "is"),
    ("please",), ("though",), ("obviously",), ("of", "course"), ("to", "be", "precise"),
    ("if", "possible"),
)  # fmt: skip
_STEPS_ALONG = {"after": 1, "following": 1, "past": 1, "before": -1, "preceding": -1}
_NOT_BEFORE_ALL = frozenset({"of", "after", "at", "is", "in", "above", "for", "first", "last", "that"})
_NOT_TELLING = frozenset(
    {"on", "in", "at", "into", "onto", "inside", "of", "with", "from", "upon", "around", "along"}
)
