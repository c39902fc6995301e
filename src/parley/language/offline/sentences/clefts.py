"""What is brought to the fore, put in its place: "it is A I want V-ed", "what I need is A"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from parley.language.offline.sentences.gaps import (
    ASKING_YOU,
    CUTS,
    LATER,
    LONGEST_NAME,
    THERE,
    WANTING,
    Gaps,
    spelt,
)
from parley.language.offline.sentences.subjects import after_openers
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["Clefts"]

_DATA = load_data("forms")
_YOURS = PhraseTable.of(_DATA["yours"])
_ALL = PhraseTable.of(_DATA["all_that"])
_ONES = frozenset({"one", "ones", "thing", "things", "place", "places", "job", "task", "stop", "point"})
_DUTIES = {("job",), ("task",), ("turn",), ("duty",)}
_IS = frozenset({"is", "are", "was", "were"})
_WAITING = frozenset({"that", "which", "waiting", "due", "ready"})
_BEGIN = CUTS | {"today", "now", "this"}
_WHEN = LATER | {",", "and", "before", "after", "when", "for", "with", "once"}
_THAT_IS = {("that", "is"), ("this", "is"), ("those", "are"), ("these", "are"), ("there", "is")}


@dataclass
class Clefts:
    """Puts what stands in front of one sentence back in its place.

    Args:
        gaps: Fills what a clause lacks.
        is_stop: Whether words name something that is known.
    """

    gaps: Gaps
    is_stop: Callable[[Phrase], bool]

    def put(self, sentence: Phrase, before: Phrase) -> Phrase:
        """A sentence with everything in its place; itself if nothing stands in front.

        Args:
            sentence: The words of one sentence.
            before: What was said before it, for what "that" may mean.
        """
        for at in range(len(sentence)):
            if at and sentence[at - 1].key not in _BEGIN:
                continue
            rest = sentence[at:]
            found = (
                self._it_is(rest)
                or self._there_is(rest)
                or self._needed_there(rest)
                or self._that_is(rest, (*before, *sentence[:at]))
                or (self._where_is(rest) if rest[0].key == "where" else self._what(rest))
                or self._last(rest)
            )
            if found is not None:
                return (*sentence[:at], *found)
        return sentence

    def _it_is(self, words: Phrase) -> Phrase | None:
        """For "it is A (that) I want V-ed", "it is your turn to V"."""
        flat = keys(words)
        if flat[:2] not in {("it", "is"), ("it", "was")} or len(flat) < 4:
            return None
        if flat[2] == "not":
            return self._it_is_not(words[3:])
        duty = _YOURS.match(flat, 2)
        if duty is not None and flat[2] in {"your", "up", "for", "yours"}:
            return words[2 + duty[0] :]
        whose = self._whose(words[2:])
        if whose is not None:
            return whose
        for at in range(3, min(len(flat), LONGEST_NAME + 3)):
            named, gap = words[2:at], words[at:]
            found = self.gaps.filled(named, gap, to=False) or self.gaps.stated(named, gap)
            if found is not None and self.gaps.is_named(named):
                return found
        return None

    def _it_is_not(self, words: Phrase) -> Phrase | None:
        """For "it is not A I want V-ed, it is B"."""
        flat = keys(words)
        cut = next((i for i in range(2, len(flat) - 3) if flat[i : i + 3] == (",", "it", "is")), 0)
        other = words[cut + 3 :]
        for at in range(1, min(cut, LONGEST_NAME + 1)):
            named, gap = words[:at], words[at:cut]
            if self.gaps.is_named(named) and self.gaps.is_named(other) and self.gaps.filled(named, gap):
                return self.gaps.filled(other, gap)
        return None

    def _there_is(self, words: Phrase) -> Phrase | None:
        """For "there is a A that needs V-ing", "there is a A waiting to be V-ed"."""
        flat = keys(words)
        if flat[:2] not in {("there", "is"), ("there", "are")} or len(flat) < 5:
            return None
        begin = 2 + (flat[2] in {"a", "an", "the", "still", "another"})
        if begin == 2 and flat[1] == "is":
            return None
        at = next(
            (
                i
                for i in range(begin + 1, len(flat) - 1)
                if flat[i] in _WAITING or flat[i : i + 2] == ("to", "be")
            ),
            0,
        )
        gap = words[at + (flat[at] in {"that", "which"}) :]
        if not at or flat[at] == "to" or flat[at] in {"waiting", "due", "ready"}:
            gap = (*spelt(flat[1]), *gap) if at else ()
        named = (*(spelt("the") if begin == 3 else ()), *words[begin:at])
        return (*named, *gap) if gap and self.gaps.is_thing(named) and self.gaps.lacks_subject(gap) else None

    @staticmethod
    def _needed_there(words: Phrase) -> Phrase | None:
        """For "(after that) you are needed at A"."""
        flat = keys(words)
        start = after_openers(flat)
        at = start + 3
        asked = flat[start : start + 2] == ("you", "are") and flat[start + 2 : at] in {
            ("needed",),
            ("wanted",),
            ("expected",),
        }
        placed = asked and flat[at : at + 1] in {("at",), ("in",), ("on",), ("by",)} and len(flat) > at + 1
        return (*words[:start], *spelt("go to"), *words[at + 1 :]) if placed else None

    def _whose(self, words: Phrase) -> Phrase | None:
        """For "it is up to N to V", "it is N's job to V", "it is for N to V": an order for N."""
        flat = keys(words)
        at = 2 if flat[:2] == ("up", "to") else 1 if flat[:1] == ("for",) else 0
        name = flat[at].removesuffix("'s") if at < len(flat) else ""
        end = at + 1 if at else at + 2
        is_duty = bool(at) or flat[1:2] in _DUTIES
        if name not in self.gaps.robots or flat[end : end + 1] != ("to",) or not is_duty:
            return None
        return (Word(name, name.capitalize()), Word(",", ","), *words[end + 1 :])

    def _that_is(self, words: Phrase, before: Phrase) -> Phrase | None:
        """For "that is the one I want V-ed", "that is where to go": what was named last."""
        flat = keys(words)
        if flat[:2] not in _THAT_IS or len(flat) < 4:
            return None
        if flat[2] == "where":
            return self._where(self._last_place(before), words[3:], here=True)
        gap = self._one_of(words[2:])
        named = self._named_last(before) or spelt("it" if flat[1] == "is" else "them")
        return self.gaps.filled(named, gap) if gap is not None else None

    def _named_last(self, before: Phrase) -> Phrase:
        """The last thing of the map that was named, with its article."""
        pronouns = lexicon().thing_pronouns
        for end in range(len(before), 0, -1):
            spans = (before[start:end] for start in range(max(0, end - LONGEST_NAME), end))
            named = next((span for span in spans if self.is_stop(span)), ())
            if named and named[0].key not in pronouns:
                return named
        return ()

    def _last_place(self, before: Phrase) -> Phrase:
        """What stands right before, set apart by a comma or a colon, or was named last."""
        if keys(before[-1:]) in {(",",), (":",)}:
            body = before[:-1]
            apart = body[next((i + 1 for i in range(len(body) - 1, -1, -1) if not body[i].is_word), 0) :]
            if apart and self.gaps.is_thing(apart):
                return apart
        return self._named_last(before)

    @staticmethod
    def _one_of(words: Phrase) -> Phrase | None:
        """The gap behind "the one", "what", "the thing"."""
        flat = keys(words)
        if flat[:1] == ("what",):
            return words[1:]
        ones = range(1, min(4, len(flat))) if flat[:1] == ("the",) else ()
        at = next((i for i in ones if flat[i] in _ONES), 0)
        return words[at + 1 :] if at and at + 1 < len(flat) else None

    def _what(self, words: Phrase) -> Phrase | None:
        """For "what I want is A V-ed", "the one to V is A", "all you have to do is V"."""
        flat = keys(words)
        size = _ALL.match(flat)
        gap = words[size[0] :] if size is not None else self._one_of(words)
        lead = flat[: len(flat) - len(gap)] if gap is not None else ()
        if gap is None or "last" in lead:
            return None
        gap = gap[1:] if keys(gap[:1]) == ("that",) else gap
        early = next((word for word in lead if word in {"first", "next"}), "")
        for link in range(2, len(gap) - 1):
            found = self._equated(gap[:link], gap[link + 1 :]) if gap[link].key in _IS else None
            if found is not None:
                return (*spelt(early), *found)
        return None

    def _equated(self, gap: Phrase, meant: Phrase) -> Phrase | None:
        """What is meant, in the gap of a clause."""
        flat = keys(gap)
        wanting, asking = WANTING.match(flat), ASKING_YOU.match(flat)
        if asking is not None and flat[asking[0] : asking[0] + 1] == ("do",):
            return self._deed(gap[asking[0] + 1 :], meant)
        if wanting is not None and wanting[0] == len(flat):
            return _wish_for(gap, meant)
        cut = next((i for i, word in enumerate(meant) if word.key == ","), len(meant))
        first = self.gaps.filled(meant[:cut], gap) if self.gaps.is_named(meant[:cut]) else None
        return (*first, *self._listed(gap, meant[cut:])) if first is not None else None

    def _deed(self, when: Phrase, meant: Phrase) -> Phrase | None:
        """For "what you should do (next) is (to) V"."""
        order = meant[1:] if keys(meant[:1]) == ("to",) else meant
        verb = order[0].key if order else "the"
        deeds = self.gaps.deeds
        is_order = verb not in lexicon().determiners and (verb in deeds.known or deeds.may(verb))
        return (*when, *order) if is_order and set(keys(when)) <= LATER else None

    def _listed(self, gap: Phrase, more: Phrase) -> Phrase:
        """For "(what should be V-ed is A), then B", "(the first is A), the second is B"."""
        flat = keys(more)
        at = 1
        if flat[1:2] == ("the",) and flat[2:3] in {("second",), ("other",), ("next",), ("last",)}:
            at = next((i + 1 for i in range(at, len(flat)) if flat[i] in _IS), at)
        while at < len(flat) and flat[at] in {"then", "and", "after", "that"}:
            at += 1
        other = self.gaps.filled(more[at:], gap) if self.gaps.is_named(more[at:]) else None
        return (*spelt("and then"), *other) if other else more

    def _where_is(self, words: Phrase) -> Phrase | None:
        """For "where I want you is A", "where you should look is A"."""
        links = (i for i in range(2, len(words) - 1) if words[i].key in _IS)
        found = (self._where(words[link + 1 :], words[1:link], here=False) for link in links)
        return next((one for one in found if one is not None), None)

    def _where(self, named: Phrase, gap: Phrase, *, here: bool) -> Phrase | None:
        """What is to be done at a place: go there, or something there."""
        flat = keys(gap)
        there, asking = THERE.match(flat), ASKING_YOU.match(flat)
        if there is not None:
            return self._going(named, gap[there[0] :], last=there[1].endswith(("end up", "finish")))
        begin = asking[0] if asking is not None else int(flat[:1] == ("to",))
        if not begin or begin >= len(flat) or flat[begin] in {"be", "do"}:
            return None
        return (*gap[begin:], *(spelt("there") if here else (*spelt("at"), *named)))

    @staticmethod
    def _going(named: Phrase, when: Phrase, *, last: bool) -> Phrase | None:
        """An order to go there, with what is said of when."""
        flat = keys(when)
        size = 2 if flat[:2] in {("to", "be"), ("to", "go")} else int(flat[:1] == ("to",))
        when, flat = when[size:], flat[size:]
        if flat and flat[0] not in _WHEN:
            return None
        place = (*spelt("go to"), *named) if named else spelt("go there")
        return (*place, *when, *(spelt("at the end") if last else ()))

    def _last(self, words: Phrase) -> Phrase | None:
        """For "A is the one I want V-ed", "A is where you go next", "A is yours to V"."""
        flat = keys(words)
        link = next((i for i in range(1, min(len(flat) - 2, LONGEST_NAME)) if flat[i] in _IS), 0)
        named, behind = words[:link], words[link + 1 :]
        listed = "," in flat[:link] and "and" not in flat[:link]
        if not link or listed or not self.gaps.is_named(named):
            return None
        duty = _YOURS.match(keys(behind))
        if duty is not None and duty[0] < len(behind):
            return self.gaps.to_do(named, behind[duty[0] - 1 :])
        if behind[0].key == "where":
            return self._where(named, behind[1:], here=False)
        gap = self._one_of(behind)
        return self.gaps.filled(named, gap) if gap else None


def _wish_for(wish: Phrase, meant: Phrase) -> Phrase | None:
    """For "what I want is for you to V", "what I want is A V-ed"."""
    flat = keys(meant)
    size = 3 if flat[:3] == ("for", "you", "to") else 2 if flat[:2] == ("you", "to") else 0
    if size:
        return meant[size:]
    return (*wish, *meant) if flat[:1] != ("to",) else None
