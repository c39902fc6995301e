"""The parts of a message by what they do: orders, names, what is told, asked, or only explains.

People talk around their orders. Here a message is cut where a part begins, and every part gets its kind from
how it begins and whether it has a subject with a finite verb.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.sentences.signs import (
    BE,
    HELPING,
    JOINTS,
    LEADING,
    MARKS,
    OPEN,
    REASONS,
    IsStop,
    Kind,
    Opens,
    Signs,
    spans,
)
from parley.language.offline.sentences.talk import TALK
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["MARKS", "Kind", "Unit", "spans", "units"]


@dataclass(frozen=True, slots=True)
class Unit:
    """One part of a message."""

    kind: Kind
    start: int
    """Its first word in the message, with what joins it to the one before."""
    end: int
    words: Phrase
    """What it says: an order without its frame."""
    free: bool = True
    """Whether a mark or a joining word stands before it."""
    names: tuple[Phrase, ...] = ()
    """The things on the map that it names."""
    why: str = ""
    """Why it is of its kind."""
    same: bool = False
    """Whether what was asked for last is asked for at this place too ("then the desk, same thing")."""

    @property
    def refuses(self) -> bool:
        """Whether it is an order not to do something."""
        flat = keys(self.words)[:4]
        return self.kind == "order" and (
            flat[:2] in {("do", "not"), ("no", "need")} or flat[:1] in {("never",), ("avoid",)}
        )


def units(words: Phrase, is_stop: IsStop, opens: Opens) -> list[Unit]:
    """The parts of a message, in their order.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one thing on the map.
        opens: Whether a command begins with these words.
    """
    return _Message(words, is_stop, opens).units()


@dataclass
class _Message(Signs):
    """A message that is cut into its parts."""

    def units(self) -> list[Unit]:
        result: list[Unit] = []
        start = 0
        for end in range(len(self.words) + 1):
            if end == len(self.words) or self.flat[end] in MARKS or self.flat[end].startswith(".."):
                if any(word.is_word for word in self.words[start:end]):
                    asked = self.flat[end : end + 1] == ("?",)
                    result += self._sentence(start, end, asked=asked)
                start = end + 1
        return result

    def _sentence(self, start: int, end: int, *, asked: bool) -> list[Unit]:
        cuts: list[tuple[int, bool]] = [(start, True)]
        for index in range(start + 1, end):
            begun = cuts[-1][0]
            if self._free(index, start) and self._begins(index, begun, end):
                back = index
                while back - 1 > begun and (
                    not self.words[back - 1].is_word or self.flat[back - 1] in JOINTS
                ):
                    back -= 1
                cuts.append((back, True))
            elif self._runs_on(index, begun, end):
                cuts.append((index, False))
        bounds = zip(cuts, [*(at for at, _ in cuts[1:]), end], strict=True)
        return self._led(
            [self._unit(at, stop, free=free, asked=asked and stop == end) for (at, free), stop in bounds]
        )

    def _led(self, found: list[Unit]) -> list[Unit]:
        """With "and before that," at the front of what it says something about."""
        result: list[Unit] = []
        lead: Unit | None = None
        for unit in found:
            if unit.kind == "idle" and self._behind_leading(unit.start) >= unit.end:
                lead = unit if lead is None and unit.words else lead
                continue
            if lead is not None and unit.kind in {"order", "name"}:
                words = (*self._when(lead.start, lead.end), *unit.words)
                unit = replace(unit, start=lead.start, words=words)
            lead = None
            result.append(unit)
        return result

    def _free(self, index: int, start: int) -> bool:
        """Whether a part may begin here because of what stands before it."""
        before = self.flat[index - 1]
        return index > start and (before in {",", ":"} or before in JOINTS - {"who", "which", "where"})

    def _begins(self, index: int, begun: int, end: int) -> bool:
        """Whether a part begins behind a comma or a joining word."""
        if self.flat[index] in {",", ":"} or self.flat[index] in {"and", "but", "or", "&"}:
            return False
        if self._being_said(index, begun):
            return False
        talked = self.flat[index - 1] in {",", ":"} and self._kind(begun, index - 1) in TALK
        if talked or self._talk_ahead(index, end) or self._same_at(index, end):
            return True
        if self._waits(begun, index) and (self.flat[index - 1] == "and" or self._order_at(index, end) >= 0):
            # "Once A and B have been checked, V".
            return False
        return self._begins_otherwise(index, begun, end)

    def _talk_ahead(self, index: int, end: int) -> bool:
        """Whether nothing but talk stands between two commas, or a comma and the end."""
        if self.flat[index - 1] != ",":
            return False
        stop = next((i for i in range(index, end) if self.flat[i] == ","), end)
        return self._talk(index, self._behind_leading(index), stop) is not None

    def _begins_otherwise(self, index: int, begun: int, end: int) -> bool:
        """Whether a reason, an order, a condition, something told or a name begins."""
        kind = self._kind(begun, end)
        if self.flat[index - 1] in JOINTS and REASONS.match(self.flat, index - 1) is not None:
            return True
        if self._order_at(index, end) >= 0:
            return not self._serial(begun, index)
        if self._conditional(index):
            return self._order_behind(index, end)
        if REASONS.match(self.flat, index) is not None:
            return kind != "told" or self._order_behind(index, end)
        if self.flat[index - 1] == "or":
            return False
        if self.flat[index - 1] == "and" and index - 2 in self.named and self.flat[index].isdigit():
            # "Tanks 1 and 2".
            return False
        if self._told(index, end):
            if self.flat[index - 1] == "and" and self._lists(begun, index):
                return False
            return kind not in {"reason"} or self.flat[index - 1] == ","
        if self.flat[index - 1] == "and" and index - 2 in self.named:
            # "Between the desk and the hall".
            return False
        if kind == "told" and self.flat[index - 1] != "," and self.flat[index - 2] != ",":
            # "We went to the desk and then to the hall".
            return False
        at = self._behind_leading(index)
        return kind in {"told", "reason", "idle"} and at in self.begun and self._only_names(at, end)

    def _lists(self, begun: int, index: int) -> bool:
        """For "(the desk) and (the door) were open": what is told is told of both."""
        small = lexicon().determiners | {",", "and", "only", "both"}
        before = [i for i in range(begun, index - 1) if i not in self.named and self.flat[i] not in small]
        first = index + (self.flat[index] in lexicon().determiners)
        return not before and begun < index - 1 and {index, first} & self.begun != set()

    def _waits(self, begun: int, index: int) -> bool:
        """Whether the part so far is a condition without what depends on it."""
        at = self._behind_leading(begun)
        if not self._conditional(at):
            return False
        return not any(
            self._order_at(i, index) >= 0 and (self._free(i, begun) or self._strong(i))
            for i in range(at + 2, index)
        )

    def _serial(self, begun: int, index: int) -> bool:
        """Whether only "go (and)" stands before this."""
        return index - begun <= 3 and set(self.flat[begun : index - 1]) <= _SERIAL

    def _runs_on(self, index: int, begun: int, end: int) -> bool:
        """Whether a part begins here though nothing marks it."""
        before, word = self.flat[index - 1], self.flat[index]
        if index - begun < 2 or before in OPEN or index in self.named - self.begun or before in JOINTS:
            return False
        if not self.words[index - 1].is_word or not self.words[index].is_word or word in JOINTS:
            return False
        if self._being_said(index, begun) or self._asks_of_another(begun, index):
            return False
        if word == "to":
            return self._purpose(index, begun)
        if self._order_at(begun, end) >= index:
            return False
        verb = self._order_at(index, end)
        told = verb == index == self._several_do(self._behind_leading(begun), end)
        if told or set(self.flat[begun:index]) <= _SERIAL | {",", "so"}:
            return False
        if verb >= 0 and (verb > index or self._clearly(verb)):
            return not self._waits(begun, index)
        if word in {"if", "unless"} and before not in _ASKING_WHETHER:
            return not self._waits(begun, index) and any(
                self._strong(i) and self._order_at(i, end) >= 0 and self._clearly(self._order_at(i, end))
                for i in range(index + 2, end)
            )
        if index - 1 in self.named and word in lexicon().determiners and index not in self.begun:
            # "Go to the desk the guests are waiting".
            return any(self._finite(i) for i in range(index + 2, min(index + 5, end)))
        if index - 1 in self.named and word.endswith("'s") and index not in self.named:
            # "Go to the desk somebody's box is in the way".
            return any(self._finite(i) for i in range(index + 2, min(index + 5, end)))
        subject = self.flat[index] in _RUN_SUBJECTS
        following = self.flat[index + 1 : index + 2]
        finite = following and (following[0] in BE or following[0] in HELPING - {"have", "do"})
        # "Check how full it is": no statement.
        embedded = "how" in self.flat[max(begun, index - 3) : index]
        begins = bool(subject and finite and not embedded) or self.flat[index : index + 3] in _UNSURE
        return begins and self._kind(begun, end) in {"order", "name"} and index - begun > 2

    def _asks_of_another(self, begun: int, index: int) -> bool:
        """For "does A (drive the tractor)": the verb of a question about somebody else is no order."""
        at = self._behind_leading(begun)
        if self.flat[at] in lexicon().question_starts:
            # "What day did A (get the key)".
            at = next((i for i in range(at + 1, index) if self.flat[i] in _ASKING_HELP), at)
        subject = self.flat[at + 1 : index]
        return self.flat[at] in _ASKING_HELP and 0 < len(subject) < 6 and not _TO_ROBOT & set(subject)

    def _being_said(self, index: int, begun: int) -> bool:
        """Whether words are what an order is to say to somebody: "(tell A at the desk) that S"."""
        first = keys(strip_openers(self.words[begun:index], requests=True))
        found = lexicon().verbs.match((lemma(first[0]), *first[1:])) if first else None
        kind = found[1].partition(":")[0] if found is not None else ""
        return kind in {"speak", "ask"} and "that" in {self.flat[index], self.flat[index - 1]}

    def _purpose(self, index: int, begun: int) -> bool:
        """For "go to the desk to look for it": looking is an order of its own."""
        there = index - 1 in self.named or self.flat[index - 1] in {"there", "over"}
        found = lexicon().verbs.match(self.flat, index + 1)
        kind = found[1].partition(":")[0] if found is not None else ""
        going = lexicon().verbs.match(self.flat, max(self._order_at(begun, index), 0))
        moves = (
            going is not None
            and going[1].startswith(("motion:", "back:"))
            and self._order_at(begun, index) >= 0
        )
        return there and moves and kind in {"look", "search", "whether", "count"}

    def _unit(self, start: int, end: int, *, free: bool, asked: bool) -> Unit:
        same = self._same_at(start, end)
        kind, why = ("name", "the same at another place") if same else self._label(start, end)
        if asked and kind in {"told", "name"}:
            kind, why = "asked", "ends with a question mark"
        names = tuple(
            self.words[a:b] for a, b in self.found if start <= a and b <= end and not self._anchors(a, start)
        )
        return Unit(kind, start, end, self._said(start, end, kind), free, names, why, bool(same))

    def _anchors(self, at: int, start: int) -> bool:
        """Whether a name only says where something else is ("the box next to the desk")."""
        while at > start and self.flat[at - 1] in lexicon().determiners:
            at -= 1
        before = self.flat[max(start, at - 2) : at]
        if before[-1:] in {("and",), ("or",)} and "between" in self.flat[start:at]:
            return True
        if before[-1:] == ("to",):
            return before[0] in _COMPARED
        if before[-1:] and before[-1] in {"in", "on", "at", "inside", "from", "with"}:
            return bool(lexicon().quantifiers & set(self.flat[start:at]))
        return bool(before) and before[-1] in _BESIDE

    def _said(self, start: int, end: int, kind: Kind) -> Phrase:
        """The words of a part, of an order without its frame."""
        if kind == "name":
            at = self._behind_leading(start)
            end = self._same_at(start, end) or end
            named = [a for a, b in self.found if b == end and a >= at]
            at = named[0] if named and self._same_at(start, end) else at
            return _trimmed((*self._when(start, at), *self.words[at:end]))
        if kind != "order":
            return _trimmed(self.words[start:end])
        verb = self._order_at(start, end)
        if verb >= 0:
            return _trimmed((*self._when(start, verb), *self._plain_order(start, verb, end)))
        at = self._behind_leading(start)
        verb = next((i for i in range(at + 2, end) if self._order_at(i, end) >= 0 and self._strong(i)), end)
        condition = _without_marks(self.words[at:verb])
        if verb == end or self._idle_condition(condition):
            order = self.words[self._order_at(verb, end) : end] if verb < end else self.words[at:end]
            return _trimmed(order)
        order = self.words[self._order_at(verb, end) : end]
        return _trimmed((*self._when(start, at), *condition, Word(",", ","), *order))

    def _plain_order(self, start: int, verb: int, end: int) -> Phrase:
        """An order in its plain form, whatever its frame makes of it."""
        done = self._participial(verb, end)
        if done:
            return self._active(done, end)
        refused = _words("do not") if self._refused(start, verb) else ()
        if self._wanted_at(verb):
            link = verb + (self.flat[verb] in {"over", "down", "up", "back"})
            return (*refused, *_words("go to"), *self.words[link + 1 : end])
        base = lemma(self.flat[verb])
        first = Word(base, base) if self._doing(verb) else self.words[verb]
        return (*refused, first, *self.words[verb + 1 : end])

    def _active(self, done: int, end: int) -> Phrase:
        """For "the desk looked at": "look at the desk"."""
        base = lemma(self.flat[done])
        named = next(self.words[a:b] for a, b in self.found if b == done)
        found = lexicon().verbs.match((base, *self.flat[done + 1 : end]))
        behind = done + (found[0] if found is not None else 1)
        return (Word(base, base), *self.words[done + 1 : behind], *named, *self.words[behind:end])

    def _refused(self, start: int, verb: int) -> bool:
        """Whether the frame of an order forbids it ("I do not want you to V")."""
        frame = self.flat[self._behind_leading(start) : verb]
        return "not" in frame and not {"why", "mind", "if", "could"} & set(frame)

    def _idle_condition(self, condition: Phrase) -> bool:
        """For "while you are out there": when it is done changes nothing."""
        flat = keys(condition)
        about = set(range(len(condition)))
        names = any(self.is_stop(condition[i : i + n]) for i in about for n in (1, 2, 3))
        ahead = flat[:1] in {("before",), ("until",), ("while",), ("since",), ("as",), ("till",)} and flat[
            1:2
        ] not in {("you",), ("that",)}
        return (flat[:2] in {("while", "you"), ("since", "you"), ("now", "that")} or ahead) and not names

    def _when(self, start: int, end: int) -> Phrase:
        """What the words in front of an order say about when it is due."""
        kept: list[Word] = []
        at = start
        while at < end:
            found = LEADING.match(self.flat, at)
            if found is None or at + found[0] > end:
                at += 1
                continue
            kept += self.words[at : at + found[0]]
            at += found[0]
        return tuple(word for word in kept if word.key not in {"so", "or"})


_ASKING_HELP = frozenset({"does", "did", "can", "could", "will", "would", "should", "may", "must"})
_TO_ROBOT = frozenset({"you", "we", "somebody", "someone", "please", ",", "anybody", "anyone"})
_COMPARED = frozenset({
    "next", "close", "closest", "closer", "nearest", "nearer", "near", "opposite", "adjacent", "farthest",
    "furthest", "belonging", "left", "right", "parallel", "compared",
})  # fmt: skip
_BESIDE = frozenset({
    "between", "of", "by", "beside", "near", "behind", "under", "from", "than", "opposite", "above",
    "below", "nearest", "closest", "around", "outside", "past", "facing", "besides", "except", "not",
})  # fmt: skip
_ASKING_WHETHER = frozenset({
    "look", "see", "check", "know", "ask", "tell", "me", "us", "out", "sure", "wonder", "wondering",
    "verify", "confirm", "test", "determine", "inspect", "report", "say", "as", "even", "only",
})  # fmt: skip
_SERIAL = frozenset(
    {"go", "come", "run", "please", "just", "and", "head", "drive", "you", "now", "then", "hurry"}
)
_RUN_SUBJECTS = frozenset(
    {"it", "they", "he", "she", "there", "nobody", "everybody", "somebody", "someone", "i", "we"}
)
_UNSURE = frozenset({("i", "do", "not"), ("we", "do", "not"), ("they", "do", "not"), ("i", "think", "it")})


def _words(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())


def _trimmed(words: Phrase) -> Phrase:
    while words and not words[0].is_word:
        words = words[1:]
    while words and (not words[-1].is_word or words[-1].key in {"and", "but", "so", "or"}):
        words = words[:-1]
    return words


def _without_marks(words: Phrase) -> Phrase:
    while words and (not words[-1].is_word or words[-1].key in {"then", "please", "just"}):
        words = words[:-1]
    return words
