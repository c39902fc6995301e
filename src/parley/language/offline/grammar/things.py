"""What of the map and of memory a message names: found first, so that no word around them swallows them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from parley.language.offline.grammar.groups import Groups, Item, Thing
from parley.language.offline.grammar.small import small, verb_class
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.group_nouns import is_room_for
from parley.language.offline.scene.marks import marks_of, members_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import beside_at, number_of
from parley.language.offline.words.text import Phrase, Word, closest, keys, singular, tokens

__all__ = ["Item", "Thing", "items_of"]

_LONGEST = 7
_BEING = frozenset({("in",), ("at",), ("on",), ("by",)})


def items_of(words: Phrase, scene: Scene) -> list[Item]:
    """The message with what it names put together."""
    words = _without_idioms(tuple(_without_fillers(tuple(_cut_possessives(words)))))
    finder = _Finder(words, scene)
    words = finder.words
    result: list[Item] = []
    at = 0
    while at < len(words):
        end, thing = finder.thing_at(at)
        if thing is None:
            end, thing = finder.label_alone(at, result)
        if thing is None:
            result.append(Item(words[at].key, (words[at],)))
            at += 1
        else:
            result.append(Item("<thing>", words[at:end], thing))
            at = end
    return result


def _without_idioms(words: Phrase) -> Phrase:
    """Without what says nothing ("if I were you"), and the commas around it."""
    result: list[Word] = []
    at = 0
    while at < len(words):
        found = small().idioms.match(keys(words[at : at + 8]))
        if found is None:
            result.append(words[at])
            at += 1
            continue
        at += found[0]
        if (not result or result[-1].key == ",") and keys(words[at : at + 1]) == (",",):
            at += 1
    return tuple(result)


def _cut_possessives(words: Phrase) -> Iterator[Word]:
    for word in words:
        if word.key.endswith("'s") and len(word.key) > 2:
            yield Word(word.key[:-2], word.raw[:-2])
            yield Word("'s", "'s")
        else:
            yield word


def _without_fillers(words: Phrase) -> Iterator[Word]:
    """Without "uh", and the commas around it."""
    for i, word in enumerate(words):
        behind = words[i - 1].key if i else ""
        following = words[i + 1].key if i + 1 < len(words) else ""
        like = word.key == "like" and behind == following == ","
        if (
            word.key in small().sets["fillers"]
            or like
            or (
                word.key == ","
                and (following in small().sets["fillers"] or behind in small().sets["fillers"])
            )
        ):
            continue
        if word.key == "," and i > 1 and "like" in {behind, following} and _is_like(words, i):
            continue
        yield word


def _is_like(words: Phrase, at: int) -> bool:
    return keys(words[at : at + 3]) == (",", "like", ",")


@dataclass
class _Finder(Groups):
    def __post_init__(self) -> None:
        super().__post_init__()
        self.subject_words = {word for item in self.scene.facts for word in keys(item.fact.subject)}
        self.words = tuple(self._mended(word, i) for i, word in enumerate(self.words))
        self.subjects = {
            keys(item.fact.subject): item.fact.subject
            for item in self.scene.facts
            if item.fact.subject and item.fact.place
        }

    def _mended(self, word: Word, at: int) -> Word:
        """A word that nobody knows may be a misspelt name; number words behind a name are labels."""
        if word.key in lexicon().numbers and self._counts(at):
            return Word(str(lexicon().numbers[word.key]), str(lexicon().numbers[word.key]))
        if not word.key.isalpha() or len(word.key) < 4 or number_of(singular(word.key)) in self.names:
            return word
        known = (
            word.key in lexicon().vocabulary or singular(word.key) in lexicon().nouns or verb_class(word.key)
        )
        if (
            known
            or word.key in small().frame | small().adverbs | small().prepositions
            or (word.is_capital and at)
        ):
            return word
        better = closest(word.key, self.names)
        if better is None or better == word.key:
            return word
        near = {w.key for w in self.words[max(0, at - 1) : at] + self.words[at + 1 : at + 2]}
        sure = len(word.key) > 5 or sorted(better) == sorted(word.key) or bool(near & self.names)
        sure = sure or any(key.isdigit() for key in near)
        return Word(better, better) if sure else word

    def _counts(self, at: int) -> bool:
        """Whether a number word stands where a label does ("barrels one to three", "number two")."""
        before = [self.words[i].key for i in range(max(0, at - 2), at)]
        if not before or (
            self.words[at].key == "one" and keys(self.words[at + 1 : at + 2]) not in {("to",), ("and",)}
        ):
            return before[-1:] == ["number"]
        name = number_of(singular(before[-1])) in self.names and not before[-1].isdigit()
        ranges = before[-1] in small().sets["to"] | {"and"} and before[0] in lexicon().numbers
        return name or ranges or before[-1] == "number"

    def label_alone(self, at: int, before: Sequence[Item]) -> tuple[int, Thing | None]:
        """For "zone 1, then 3": a label that goes on with the name before it."""
        if self.words[at].key == "number" and at + 1 < len(self.words):
            end, thing = self.label_alone(at + 1, before) if self._is_label(at + 1) else (at, None)
            return (end, thing) if thing is not None else (at, None)
        behind = self.words[at - 1].key if at else ""
        following = self.words[at + 1] if at + 1 < len(self.words) else None
        if behind not in {
            "number",
            "with",
            ",",
            "and",
            "then",
            "to",
            "or",
            "not",
            "finally",
            "lastly",
            "but",
        } or not self._is_label(at):
            return at, None
        if (
            following is not None
            and following.is_word
            and following.key not in {"and", "then", "or", "too", "last", "first", "please", "next", "for"}
        ):
            return at, None
        last = next((item.thing for item in reversed(before) if item.thing is not None), None)
        if last is None or len(last.members[-1]) < 2:
            return at, None
        name = (*last.members[-1][:-1], self.words[at])
        return (at + 1, Thing((name,), self.words[at : at + 1])) if self._is_one(name) else (at, None)

    def thing_at(self, at: int) -> tuple[int, Thing | None]:
        """What is named from a word on, and where that ends."""
        if not self.words[at].is_word or self.words[at].key == "of" or self._is_verb_here(at):
            return at, None
        if marks_of(self.words[at]):
            together = members_of(self.words[at : at + 1], self.scene.objects)
            members = tuple(tokens(describe(item, self.scene.objects)) for item in together)
            return at + 1, Thing(members, self.words[at : at + 1], group=True)
        owned = self._owned(at)
        if owned[1] is not None:
            return owned
        known = self._remembered(at)
        described = self._described(at)
        if described[1] is not None:
            return described
        start = self._content(at)
        end = start
        while end < len(self.words) and end - start < _LONGEST and self._names(end, start):
            end += 1
        for stop in range(end, start, -1):
            thing = self._grounded(at, start, stop)
            if thing is not None:
                stop, thing = self._more(at, start, stop, thing)
                return known if known[1] is not None and known[0] > stop else (stop, thing)
        return known

    def _is_verb_here(self, at: int) -> bool:
        """For "station yourself", "check the door": a verb, though the map has a thing of that name."""
        word = self.words[at].key
        if not verb_class(word) or at + 1 >= len(self.words):
            return False
        before = self.words[at - 1].key if at else "."
        opens = not before[-1:].isalnum() or before in {"and", "then", "please", "you", "to", "but", "or"}
        following = self.words[at + 1].key
        leads = small().determiners | small().prepositions | {"yourself", "it", "them", "if", "whether"}
        label = self.words[at + 1].raw == "A" or (following == "a" and not self._goes_on(at + 2))
        if label and self._is_one(self.words[at : at + 2]):
            # "Go to lift A", as against "lift a box".
            return False
        return opens and (following in leads) and following not in {"of"}

    def _goes_on(self, at: int) -> bool:
        """Whether a word stands here that is neither small nor the start of an order."""
        word = self.words[at].key if at < len(self.words) and self.words[at].is_word else ""
        return bool(word) and word not in small().frame | small().conjunctions | small().prepositions

    def _owned(self, at: int) -> tuple[int, Thing | None]:
        """For "Anna's desk": what memory knows of whose it is."""
        end = next((i for i in range(at + 1, min(at + 4, len(self.words))) if self.words[i].key == "'s"), 0)
        if not end or self.words[at].key in self.names:
            return at, None
        owner = self.words[end - 1]
        for stop in range(min(len(self.words), end + 4), end + 1, -1):
            whole = (
                *self.words[at : end - 1],
                Word(owner.key + "'s", owner.raw + "'s"),
                *self.words[end + 1 : stop],
            )
            if self._ends_name(stop) and self.scene.ground(whole).outcome == "match":
                return stop, Thing((whole,), self.words[at:stop])
        return at, None

    def _remembered(self, at: int) -> tuple[int, Thing | None]:
        start = at + 1 if self.words[at].key in lexicon().determiners else at
        for subject, named in self.subjects.items():
            end = start + len(subject)
            if keys(self.words[start:end]) == subject:
                elsewhere = self._said_to_be(at, end)
                if elsewhere[1] is not None:
                    return elsewhere
                return end, Thing((named,), self.words[at:end], known=True)
        return at, None

    def _said_to_be(self, at: int, end: int) -> tuple[int, Thing | None]:
        """For "(go to) A in B", whatever is remembered of A: B."""
        before = [
            word.key for word in self.words[max(0, at - 3) : at] if word.key not in {"to", "over", "up"}
        ]
        if [verb_class(verb) for verb in before[-1:]] != ["go"] or keys(
            self.words[end : end + 1]
        ) not in _BEING:
            return at, None
        for stop in range(self._limit(end + 1), end + 1, -1):
            place = self.words[self._content(end + 1) : stop]
            if place and self._ends_name(stop) and self._is_one(place):
                return stop, Thing((place,), self.words[at:stop])
        return at, None

    def _content(self, at: int) -> int:
        """Where determiners, quantifiers and numbers before the name end."""
        start = at
        while start < len(self.words) and start - at < 5:
            key = self.words[start].key
            if (
                key not in small().sets["leads"]
                and key not in lexicon().numbers
                and not (key == "2" and start > at)
            ):
                break
            start += 1
        return start if start < len(self.words) else at

    def _grounded(self, at: int, start: int, stop: int) -> Thing | None:
        """What the words name, if the last of them can end a name."""
        content = self.words[start:stop]
        if content[-1].key in small().sets["modifiers"] or content[-1].key in lexicon().ordinals:
            return None
        lead = keys(self.words[at:start])
        if (
            len(content) == 1
            and not lead
            and lexicon().verbs.match(keys(content))
            and verb_class(content[0].key)
        ):
            before = self.words[at - 1].key if at else "."
            if before in {"to", "and", "you", "please", "not", "then"}:
                return None
        if len(content) == 1 and is_room_for(keys(self.words[: stop + 1]), start):
            return None
        phrase = self.words[at:stop]
        if self.scene.has_its_own(self.words, start, stop) or self._is_part(at, start, stop):
            return None
        found = ground_phrase(content, self.scene.objects, self.scene.situation.robot_pose, strict=True)
        if found.outcome == "none":
            return None
        if found.outcome == "match":
            return Thing((content,), phrase, group=bool({"all", "each", "every", "both"} & set(lead)))
        plural = singular(content[-1].key) != content[-1].key
        count = next((int(lexicon().numbers[k]) for k in lead if k in lexicon().numbers and k != "one"), 0)
        if {"any", "one", "either"} & set(lead[:2]) and "each" not in lead and "every" not in lead:
            single = (*content[:-1], Word(singular(content[-1].key), singular(content[-1].raw)))
            return Thing(((Word("any", "any"), *single),), phrase)
        if {"remaining", "rest", "other", "others"} & set(lead) and plural:
            return Thing(self._members(phrase) or (phrase,), phrase, group=True)
        if plural or {"all", "each", "every", "both"} & set(lead) or count == len(found.candidates):
            if count and count != len(found.candidates):
                return Thing(self._members(phrase) or (phrase,), phrase, group=True)
            members = tuple(tokens(describe(item, self.scene.objects)) for item in found.candidates)
            return Thing(members, phrase, group=True)
        return Thing((content,), phrase)

    def _is_part(self, at: int, start: int, stop: int) -> bool:
        """For "the door is" behind what has a door."""
        said_of = self.words[stop : stop + 1]
        if stop - start != 1 or keys(said_of)[:1] == () or said_of[0].key not in small().sets["links"]:
            return False
        earlier = any(self._is_one(self.words[i - n : i]) for i in range(1, at) for n in (1, 2, 3) if n <= i)
        return earlier and self.scene.is_part(self.words[start])

    def _more(self, at: int, start: int, stop: int, thing: Thing) -> tuple[int, Thing]:
        """What belongs to a name behind it: more labels, a range, an exception, where it is."""
        content = self.words[start:stop]
        if self._is_label(stop - 1) and len(content) > 1:
            end, labels = self._labels(stop, content[:-1], content[-1])
        elif thing.group:
            end, labels = self._labels(stop, content, None)
        else:
            end, labels = stop, []
        if end > stop:
            thing = Thing(tuple(labels), self.words[at:end], group=True)
            stop = end
        flat = keys(self.words[stop : stop + 3])
        if flat[:2] == ("from", "the") and flat[2:] and flat[2] in {"left", "right", "end", "front", "back"}:
            whole = self.words[start : stop + 3]
            if self.scene.ground(whole).outcome == "match":
                return stop + 3, Thing((whole,), self.words[at : stop + 3])
        if thing.group:
            stop, thing = self._group_where(at, stop, thing)
        elif thing.members[0][:1] != (Word("any", "any"),):
            stop, thing = self._where(at, start, stop, thing)
        return stop, thing

    def _where(self, at: int, start: int, stop: int, thing: Thing) -> tuple[int, Thing]:
        """For "the door next to the lift": what tells equals apart belongs to the name."""
        if self._is_one(self.words[start:stop]) and beside_at(keys(self.words), stop) == stop:
            return stop, thing
        for end in range(self._limit(stop), stop + 1, -1):
            whole = self.words[start:end]
            if self._tells_where(stop, end) and self.scene.ground(self.words[at:end]).outcome == "match":
                return end, Thing((whole,), self.words[at:end])
        return stop, thing

    def _limit(self, at: int) -> int:
        """Where a description of a place ends at the latest: "and" belongs to it behind "between"."""
        between = False
        for i in range(at, min(len(self.words), at + 10)):
            key = self.words[i].key
            if not self.words[i].is_word or (key == "and" and not between):
                return i
            between = (between or key == "between") and key != "and"
        return min(len(self.words), at + 10)

    def _group_where(self, at: int, stop: int, thing: Thing) -> tuple[int, Thing]:
        """For "every box in the hall": the place tells which of the group."""
        if lexicon().places.match(keys(self.words[stop : stop + 5])) is None:
            return stop, thing
        for end in range(self._limit(stop), stop + 1, -1):
            if not self._tells_where(stop, end):
                continue
            members = self._members(self.words[at:end])
            if 0 < len(members) < len(thing.members) and all(self._is_one(m) for m in members):
                return end, Thing(members, self.words[at:end], group=True)
        return stop, thing

    def _described(self, at: int) -> tuple[int, Thing | None]:
        """For "the thing next to the door", "whatever is on the desk", "the bigger of the two boxes"."""
        start = at + 1 if self.words[at].key in lexicon().determiners else at
        if start >= len(self.words) or self.words[start].key not in small().sets["things_at_large"]:
            return at, None
        for end in range(self._limit(start + 1), start + 2, -1):
            if self._ends_name(end) and self.scene.ground(self.words[at:end]).outcome == "match":
                return end, Thing((self.words[start:end],), self.words[at:end])
        return at, None

    def _ends_name(self, end: int) -> bool:
        last = self.words[end - 1].key
        if last in {"one", "ones"} and end > 1:
            last = self.words[end - 2].key
        return number_of(singular(last)) in self.names or self._is_label(end - 1)

    def _tells_where(self, stop: int, end: int) -> bool:
        """Whether the words behind a name begin like a place or a description and end with a name."""
        first, last = self.words[stop].key, self.words[end - 1].key
        somebody = any(keys(self.words[stop : stop + len(s)]) == s for s in self.subjects)
        if first in {"that", "which", "where", "whose", "who"} or somebody:
            return True
        begins = lexicon().places.match(keys(self.words[stop : stop + 5])) is not None
        begins = (
            begins or first in {"closest", "nearest", "farthest"} or beside_at(keys(self.words), stop) > stop
        )
        begins = begins or (first == "to" and last in {"left", "right"} and end == stop + 3)
        return begins and (
            self._ends_name(end) or last in small().sets["sides"] or last in self.subject_words
        )
