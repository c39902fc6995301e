"""What is said to be due or wanted in the passive, as the order that it means.

"A should be V-ed", "A needs V-ing", "I want A V-ed", "make sure A gets V-ed", "could A be V-ed and B W-ed?":
what something is done to is the subject, the deed a form of its verb. Only these words are put in another
order; what stands around them stays.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, field, replace

from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.sentences.joined import Found, Joined, ordered
from parley.language.offline.sentences.spoken import Names
from parley.language.offline.sentences.subjects import ADVERBS, CUTS, LONGEST_SUBJECT, Subjects, is_free
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["Passives"]

_DATA = load_data("forms")
_TIMES = frozenset(_DATA["times"])
_BY_NOBODY = frozenset(_DATA["by_nobody"])
_BEFORE_NOUNS = frozenset(_DATA["before_nouns"])
_BE = tuple(_DATA["be"])
_STRONG = PhraseTable.of(f"{modal} {be}" for modal in _DATA["modals"] for be in _BE)
_WEAK = PhraseTable.of(
    (*(f"{modal} {be}" for modal in _DATA["weak_modals"] for be in _BE), *_DATA["getting"])
)
_NEEDING = PhraseTable.of(_DATA["wants_doing"])
_WANTING = PhraseTable.of(_DATA["wanting"])
_GOOD = (f"{lead} {good} if" for lead in _DATA["would_be"] for good in load_data("attitudes")["good"])
_CLAUSE_WANTED = PhraseTable.of((*_DATA["wanting_clause"], *_GOOD))
_OTHERS_WANT = PhraseTable.of(_DATA["others_want"])
_DEGREES = frozenset(_DATA["degrees"])
_NONE = frozenset({"neither", "none", "no"})
_SEEN_TO = {("seen", "to"), ("seeing", "to")}
_USUAL = PhraseTable.of(load_data("telling")["usual"])
_BEING = frozenset({"is", "are", "was", "were", "be", "gets", "get", "got", "being"})
_ASKING = frozenset({"could", "can", "would", "may", "might", "will"})
_HELPING = frozenset({"to", "could", "can", "would", "might", "should", "has", "have"})
_LIGHT = frozenset({"have", "get", "see", "let", "make", "can", "could", "any"})
_BEHIND_NOUN = CUTS | ADVERBS | {"before", "after", "please"}
_REACH = 9
_NEAR = 6
_LONGEST_WHO = 4


@dataclass
class Passives:
    """Puts what is due or wanted in one sentence as orders.

    Args:
        deeds: The verbs and their forms.
        names: What is on the map.
        robots: What the robots are called, lower case.
        alone: Whether nothing else is said: then what no robot could do is asked for too.
        before: What was said before the sentence.
    """

    deeds: Deeds
    names: Names
    robots: frozenset[str] = frozenset()
    alone: bool = True
    before: Phrase = ()
    subjects: Subjects = field(init=False)
    joined: Joined = field(init=False)

    def __post_init__(self) -> None:
        self.subjects = Subjects(self.names)
        self.joined = Joined(self.deeds, self.subjects)

    def put(self, sentence: Phrase) -> Phrase:
        """A sentence with orders in place of what is due or wanted in it; itself if nothing is."""
        at, result = 0, self._as_usual(sentence)
        while at < len(result):
            found = self._wanted(result, at) or self._asked(result, at) or self._due(result, at)
            if found is None or "know" in keys(found.subject):
                # "Let N know that A is V-ed" only tells of it.
                at += 1
                continue
            result, at = self._as_order(result, found)
        return result

    def _as_usual(self, words: Phrase) -> Phrase:
        """For "A gets V-ed at noon" "A is V-ed at noon", which is usually so and no order."""
        flat = keys(words)
        at = next((i for i in range(1, len(flat) - 3) if flat[i] in _GETS), 0)
        if not at or flat[at - 1] in _WISHED | CUTS or not self.deeds.done(flat[at + 1]):
            return words
        end = next((i for i in range(at + 2, len(flat)) if flat[i] in CUTS), len(flat))
        if not _is_timed(flat[at + 2 : end]):
            return words
        return (*words[:at], Word(_GETS[flat[at]], _GETS[flat[at]]), *words[at + 1 :])

    def without_agent(self, rest: Phrase) -> tuple[Phrase, Phrase | None]:
        """What follows without "by you" and "by noon", and the robot that is to do it; None if another is."""
        flat = keys(rest)
        at = next((i for i, key in enumerate(flat[:_NEAR]) if key in CUTS | {"by"}), len(flat))
        if flat[at : at + 1] != ("by",):
            return rest, ()
        begin = at + 1 + (flat[at + 1 : at + 2] in {("the",), ("one",), ("a",)})
        who = rest[begin : begin + 1]
        name = who[0].key if who else ""
        if name in self.robots | _BY_NOBODY:
            return (*rest[:at], *rest[begin + 1 :]), who if name in self.robots else ()
        end = next((i for i in range(begin, len(flat)) if flat[i] in CUTS), len(flat))
        if {*flat[begin:end]} <= _TIMES | lexicon().numbers.keys() and _TIMES & {*flat[begin:end]}:
            return (*rest[:at], *rest[end:]), ()
        timed = not name or name in _TIMES | lexicon().numbers.keys() or name.isdigit()
        return rest, () if timed or begin > at + 1 else None

    def _as_order(self, words: Phrase, found: Found) -> tuple[Phrase, int]:
        """The sentence with an order for what was found, and where to read on."""
        called = found.subject[1:2] and found.subject[1].key == "," and found.subject[0].key in self.robots
        if called and len(found.subject) > 2:
            # "Name, A needs V-ing": the robot is only called.
            found = replace(found, start=found.start + 2, subject=found.subject[2:])
        before = words[: found.start]
        if found.negated:
            instead = self.joined.denied(words[found.end :], found)
            return ((*before, *instead), found.start + len(instead)) if instead else (words, found.end)
        rest, agent = self.without_agent(words[found.end :])
        if agent is None:
            return words, found.end
        subject, rest = self.joined.with_others(self._meant(found.subject, before, rest), rest)
        order, rest = ordered(found.verb, subject, rest)
        rest = self.joined.behind(rest, found)
        if agent and not any(word.key in self.robots for word in before):
            order = (*agent, Word(",", ","), *order)
        return (*before, *order, *rest), len(before) + len(order)

    def _meant(self, subject: Phrase, before: Phrase, rest: Phrase) -> Phrase:
        """What a subject stands for: "it", "what you are doing"."""
        subject = self.subjects.topic(subject, (before, self.before))
        if is_free(keys(subject)) and "doing" in keys(subject):
            return Word("this", "this"), Word("step", "step")
        told = keys(subject) == ("it",) and "that" in keys(rest) and not before
        return () if told else subject

    def _due(self, words: Phrase, at: int) -> Found | None:
        """For "A should be V-ed", "A needs V-ing", from its helping words on."""
        flat = keys(words)
        if at and flat[at - 1] in ADVERBS - CUTS:
            return None
        near = [i for i in range(at, min(len(flat), at + _REACH)) if flat[i] not in ADVERBS]
        said = tuple(flat[i] for i in near)
        strong, weak, needing = (table.match(said) for table in (_STRONG, _WEAK, _NEEDING))
        match = strong or weak or needing
        if match is None or match[0] >= len(near):
            return None
        deed = near[match[0]]
        verb, end = self._done(flat, deed)
        if match is needing:
            verb, end = self._needed(flat, near[match[0] - 1] + 1)
        begin = next((i for i in range(max(0, at - _NEAR), at) if flat[i] in _NONE), at)
        none = begin < at and self.subjects.begins(words, begin)
        start = None if not self.deeds.may(verb) else begin if none else self.subjects.start(words, at)
        if start is None or (start and match is needing and keys(words[start:at]) in {("it",), ("they",)}):
            return None
        subject = words[start : at - (flat[at - 1] == ",")]
        if not self._is_meant(subject, verb, weak=weak is not None) or self._is_rule(flat, start, end):
            return None
        negated = none or bool({"not", "never"} & set(flat[at:deed]))
        return Found(start, subject, verb, end, negated, doing=match is needing)

    def _done(self, flat: tuple[str, ...], at: int) -> tuple[str, int]:
        """The deed of a past participle, and where it ends; what is to be "seen to" is to be looked at."""
        return ("inspect", at + 2) if flat[at : at + 2] in _SEEN_TO else (self.deeds.done(flat[at]), at + 1)

    def _needed(self, flat: tuple[str, ...], at: int) -> tuple[str, int]:
        """The deed behind "needs", and where it ends: "V-ing", "a V"."""
        begin = at
        while at < len(flat) and flat[at] in _BEFORE_NOUNS | ADVERBS:
            at += 1
        word = flat[at] if at < len(flat) else ""
        if flat[at : at + 2] in _SEEN_TO:
            return "inspect", at + 2
        verb = self.deeds.doing(word)
        if verb:
            return verb, at + 1
        behind = flat[at + 1] if at + 1 < len(flat) else ""
        ends = not behind.isalpha() or behind in _BEHIND_NOUN
        noun = self.deeds.noun(word) if at > begin and ends else ""
        return (noun, at + 1) if noun and " " not in noun and self.deeds.can(noun) else ("", at)

    def _asked(self, words: Phrase, at: int) -> Found | None:
        """For "could A be V-ed", "might A be V-ed", "can A not be V-ed"."""
        flat = keys(words)
        if flat[at] not in _ASKING or (at and flat[at - 1] not in CUTS | {"please"}):
            return None
        begin = at + 1
        while flat[begin : begin + 1] in {("not",), ("please",)}:
            begin += 1
        link = next(
            (i for i in range(begin + 1, min(len(flat) - 1, begin + LONGEST_SUBJECT)) if flat[i] in _BE), 0
        )
        end, deed = link, link + 1
        while end > begin and flat[end - 1] in ADVERBS:
            end -= 1
        while deed < len(flat) - 1 and flat[deed] in ADVERBS:
            deed += 1
        subject = words[begin:end] if link else ()
        verb, deed_end = self._done(flat, deed) if subject else ("", 0)
        meant = subject and not self.deeds.is_state(verb) and self.subjects.are_things(subject)
        return Found(at, subject, verb, deed_end) if meant else None

    def _wanted(self, words: Phrase, at: int) -> Found | None:
        """For "I want A V-ed", "N wants A V-ed", "have A V-ed", "make sure A is V-ed"."""
        flat = keys(words)
        if not self.subjects.begins(words, at):
            return None
        found = None
        if begin := _end(_CLAUSE_WANTED, flat, at):
            found = self._by_you(words, at, begin) or self._done_to(words, at, begin, clause=True)
        if (begin := _end(_WANTING, flat, at)) and found is None:
            found = self._done_to(words, at, begin, clause=False)
        for link in range(at + 1, min(len(flat), at + _LONGEST_WHO)):
            begin = _end(_OTHERS_WANT, flat, link)
            if begin and found is None and not self.names.is_stop(words[at:link]):
                found = self._done_to(words, at, begin, clause=False)
        return found

    def _done_to(self, words: Phrase, at: int, begin: int, *, clause: bool) -> Found | None:
        """What is to be done to what, behind words that want it."""
        flat = keys(words)
        for deed in range(begin + 1, min(len(flat), begin + LONGEST_SUBJECT)):
            verb, after = self._done(flat, deed)
            end = self._before_helping(flat, begin, deed, _HELPING if clause else {"to"}) if verb else begin
            passive = bool(_BEING & set(flat[end:deed]))
            if end == begin or "not" in flat[end:deed] or (clause and not passive):
                continue
            if not self.subjects.are_things(words[begin:end]) or self.subjects.modifies(words, begin, deed):
                continue
            free = self.alone and not clause and flat[at] not in _LIGHT
            sure = self.deeds.can(verb) or (free and self.deeds.may(verb))
            return Found(at, words[begin:end], verb, after) if sure else None
        return None

    @staticmethod
    def _before_helping(flat: tuple[str, ...], begin: int, end: int, helping: Set[str]) -> int:
        """Where what is named ends, before "to be" and the like."""
        while end > begin and flat[end - 1] in ADVERBS:
            end -= 1
        end -= end > begin and flat[end - 1] in _BEING
        end -= end > begin and flat[end - 1] in helping
        return end

    def _by_you(self, words: Phrase, at: int, begin: int) -> Found | None:
        """For "it would be good if you V-ed A"."""
        flat = keys(words)
        if flat[begin : begin + 1] not in {("you",), ("somebody",), ("someone",)} or begin + 2 >= len(flat):
            return None
        deed = begin + 1
        while deed < len(flat) - 1 and flat[deed] in ADVERBS | {"could", "would"}:
            deed += 1
        verb = flat[deed] if flat[deed - 1] in {"could", "would"} else self.deeds.done(flat[deed])
        base = verb if self.deeds.may(verb) or verb in {"go", "find", "see"} else ""
        return Found(at, (), base, deed + 1) if base else None

    def _is_meant(self, subject: Phrase, verb: str, *, weak: bool) -> bool:
        """Whether it is an order, and no rule of what may be or must be."""
        if not self.deeds.may(verb):
            return False
        return self.deeds.can(verb) or (not weak and self.alone and self.subjects.is_definite(subject))

    @staticmethod
    def _is_rule(flat: tuple[str, ...], start: int, end: int) -> bool:
        """For "should be V-ed at night", "must be V-ed every day", "should be V-ed by now"."""
        tail = flat[end:]
        until = next((i for i, key in enumerate(tail) if key in CUTS), len(tail))
        expected = "already" in flat[start:end] or tail[max(0, until - 2) : until] == ("by", "now")
        return expected or any(_USUAL.match(flat, i) for i in range(start + 1, end + until))


_GETS = {"gets": "is", "get": "are"}
_WISHED = frozenset({"should", "must", "to", "will", "shall", "would", "better", "can", "could"})
_AT_TIMES = frozenset({"at", "in", "on", "around", "every", "before", "after", "the", "past", "daily"})


def _is_timed(flat: tuple[str, ...]) -> bool:
    """Whether words only say at what time of day: "A gets V-ed at noon" is usually so."""
    timed = all(key in _AT_TIMES | _TIMES | lexicon().numbers.keys() or key[:1].isdigit() for key in flat)
    return timed and flat[:1] != () and flat[0] in _AT_TIMES


def _end(table: PhraseTable, flat: tuple[str, ...], at: int) -> int:
    """Where words of a table that begin at a place end, whatever degrees stand among them; 0 if none do."""
    near = [i for i in range(at, min(len(flat), at + _REACH)) if i == at or flat[i] not in _DEGREES]
    size = table.match(tuple("i" if flat[i] == "we" else flat[i] for i in near))
    return near[size[0] - 1] + 1 if size is not None else 0
