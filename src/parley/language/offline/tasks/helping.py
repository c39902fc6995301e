"""Which action helps with what somebody only complains of, wants or misses ("it is freezing in the hall").

What helps is found by the words of an action's name, inputs and description: a remedy against what is said
(`data/helping.yaml`), something that is wanted by its name, or a deed that was left undone. All that the
action needs has to be said, too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from parley.language.offline.scene.marks import members_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.choices import chosen
from parley.language.offline.tasks.matching import Match
from parley.language.offline.tasks.parts import map_spans
from parley.language.offline.tasks.roles import number_inputs, parameter_role, text_inputs
from parley.language.offline.tasks.slots import Filled, fill_slots
from parley.language.offline.words.concepts import LIGHT_VERBS, Concept, concepts, likeness, opposed
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.naming import kind_of, name_words
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

__all__ = ["for_each", "helping", "is_drastic"]

_NAMES = load_data("names")
_EMPTY = frozenset(_NAMES["empty"] + _NAMES["small"] + _NAMES["vague"])
_COMMON = frozenset({
    "motion", "look", "search", "ask_operator", "speak", "answer", "follow", "guide", "locate", "wait",
})  # fmt: skip
"""What other readings make of telling."""
_ENOUGH = 2.0
_CLEAR = 0.5
"""By how much the best action has to fit better than the next one."""
_LIKE = 0.8
_MOST_WORDS = 45


@cache
def _data() -> Any:
    return load_data("helping")


@cache
def _table(kind: str) -> PhraseTable:
    return PhraseTable.of(_data()[kind])


@cache
def _remedies(kind: str = "remedies") -> tuple[tuple[PhraseTable, frozenset[str]], ...]:
    return tuple((PhraseTable.of(one["signs"]), frozenset(one["helps"])) for one in _data()[kind])


@cache
def _undone() -> frozenset[str]:
    return frozenset(_data()["undone"])


def helping(words: Phrase, scene: Scene, done: frozenset[str] = frozenset()) -> Match | None:
    """The one action that helps with what a message tells, with its inputs; None if none clearly does.

    Args:
        words: What is told, all words and punctuation.
        scene: What is known.
        done: Verbs of what is told to be done already.
    """
    if not 2 <= len(words) <= _MOST_WORDS:
        return None
    if _states_told(keys(words)) > 1:
        # "A is locked and B is closed": of which of them somebody complains is not said.
        return None
    told = _Told(words, scene)
    found: list[tuple[float, Match]] = []
    for info in scene.catalogue.infos:
        if scene.catalogue.roles(info) & _COMMON or _is_done(info, done):
            continue
        score = told.helps(info)
        filled = told.fill(info) if score >= _ENOUGH else None
        if filled is not None:
            score += (
                0.3 * len(filled.phrases) - 0.5 * len(filled.missing) + 0.6 * _is_about(info, filled, scene)
            )
            found.append((score, Match(info, score, True, filled, 1.0, frozenset())))
    found.sort(key=lambda one: -one[0])
    if not found or (len(found) > 1 and found[0][0] - found[1][0] < _CLEAR):
        return None
    return found[0][1]


def _is_about(info: ActionInfo, filled: Filled, scene: Scene) -> bool:
    """Whether what an action is to be done to is called as its name or its input says."""
    about = {singular(word) for one in (info.name, *filled.phrases) for word in name_words(one)} - _EMPTY
    return any(
        about & ({singular(word) for word in keys(phrase)} | _kinds(members_of(phrase, scene.objects)))
        for phrase in filled.phrases.values()
    )


def _is_done(info: ActionInfo, done: frozenset[str]) -> bool:
    """Whether others did what an action does."""
    verbs = concepts(name_words(info.name)[:1], spoken=False)
    return any(likeness(verb, deed) >= _LIKE for verb in verbs for word in done for deed in concepts((word,)))


def _states_told(flat: tuple[str, ...]) -> int:
    """How often something is said to be open or closed."""
    be, states = lexicon().be, {"open", "closed", "shut", "locked", "unlocked"}
    return sum(flat[i - 1] in be and flat[i] in states for i in range(1, len(flat)))


def for_each(match: Match, scene: Scene) -> list[Match]:
    """An action that helps, once for each of several things that it is for ("both bins are full").

    Args:
        match: The action, and what is said for its inputs.
        scene: What is known.
    """
    for name, phrase in match.filled.phrases.items():
        members = scene.several(phrase)
        if len(members) > 1:
            said = [({**match.filled.values, name: plain(one)}, one) for one in members]
            filled = [
                replace(match.filled, values=values, phrases={**match.filled.phrases, name: one})
                for values, one in said
            ]
            return [replace(match, filled=one) for one in filled]
    return [match]


def is_drastic(match: Match) -> bool:
    """Whether an action alarms, locks, switches off or throws away: nothing to do because of mere telling."""
    name = name_words(match.info.name)
    told = re.findall(r"[a-z]+", match.info.description.lower())[:6]
    said = (*name, ".", *(() if {"on", "off"} <= set(told) else told))
    ends = any(value is False for value in match.filled.values.values())
    at = (i for i in range(len(said)) if _table("drastic").match(said, i) is not None)
    return next(at, None) is not None or (ends and not set(name) & _DOORS)


_DOORS = frozenset({"open", "close", "door", "gate", "window", "blinds", "curtains"})


@dataclass(frozen=True, slots=True)
class _Named:
    """Something that is named."""

    before: str
    words: Phrase
    definite: bool
    grounded: bool
    kinds: frozenset[str]


class _Told:
    """What a message tells."""

    def __init__(self, words: Phrase, scene: Scene) -> None:
        self.words, self.scene = words, scene
        self.flat = keys(words)
        self.base = tuple(lemma(word) for word in self.flat)
        self.named = list(_named(words, scene))
        self.lacked = self._lacked()
        self.signs = [helps for signs, helps in _remedies() if self._has(signs)]
        self.own_signs = [helps for signs, helps in _remedies("own_remedies") if self._has(signs)]
        self.wanted = self._wanted() | self.lacked

    def _has(self, signs: PhraseTable) -> bool:
        left = keys(self._left_so())
        none = self.lacked and signs.match(("nothing", "left")) is not None
        return (
            bool(none)
            or signs.match(left) is not None
            or any(
                signs.match(self.flat, i) is not None or signs.match(self.base, i) is not None
                for i in range(len(self.flat))
            )
        )

    def _lacked(self) -> frozenset[str]:
        """For "they have no towels left", "there is nothing left in A": the words for what is used up."""
        end = next((i for i in range(2, len(self.flat)) if self.flat[i] in {"left", "remaining"}), 0)
        at = next((i for i in range(end - 1, max(end - 6, 0), -1) if self.flat[i] in _NONE), 0)
        if not at:
            return frozenset()
        about = self.flat[at:end] if end - at > 1 else (*self.flat[at:end], *self.flat[end + 1 : end + 5])
        return frozenset(singular(word) for word in about)

    def _left_so(self) -> Phrase:
        """For "somebody left the gate open" the words "left open" together."""
        at = next((i for i, key in enumerate(self.flat) if key in {"left", "leaves", "leave", "stands"}), -1)
        so = (key for key in self.flat[at + 1 : at + 8] if key in {"open", "unlocked", "ajar", "on"})
        last = next(so, "") if at >= 0 else ""
        return tokens(f"left {last}") if last else ()

    def _wanted(self) -> frozenset[str]:
        """The words for what is said to be wanted."""
        found: set[str] = set()
        for index in range(1, len(self.flat)):
            before, behind = (
                _table("wanting").match(self.flat, index),
                _table("wanted").match(self.flat, index),
            )
            if before is not None:
                found |= set(self.flat[index + before[0] : index + before[0] + 5])
            if behind is not None:
                found |= set(self.flat[max(0, index - 4) : index])
        return frozenset(singular(word) for word in found)

    def helps(self, info: ActionInfo) -> float:
        """How much speaks for it that an action is wanted."""
        name = set(_bases(name_words(info.name)))
        told = set(_bases(re.findall(r"[a-z]+", info.description.lower())))
        signs = [helps for helps in self.signs if not name & _ENDING or helps & _ENDING]
        if self._is_own(info):
            signs += self.own_signs
        if info.outputs and name & _FINDING:
            # What is found out is no help.
            signs = []
        score = sum(2.0 + 0.5 * bool(helps & name) for helps in signs if helps & (name | told))
        typed = {singular(w) for one in info.inputs for w in name_words(one)}
        things = (name | told) - _EMPTY - typed - LIGHT_VERBS
        nouns = {singular(word) for word in things if lexicon().verbs.match((word,)) is None or word in name}
        choice = {key for text, _ in chosen(info, self.words).values() for key in text.lower().split()}
        if self.wanted & nouns or {singular(one) for one in choice} & self.wanted:
            score += 2.0
        score += 1.5 * self._is_missed(info) + 2.0 * self._starts_what_helps(name)
        score += bool(self.lacked & nouns)
        return score + 0.5 * len(nouns & {singular(word) for word in self.flat})

    def _is_own(self, info: ActionInfo) -> bool:
        """Whether what is told is told of what an action is for by its name ("the board is full")."""
        about = {singular(word) for word in name_words(info.name)[1:]} - _EMPTY - LIGHT_VERBS
        return bool(about & {singular(word) for word in self.flat})

    def _starts_what_helps(self, name: set[str]) -> bool:
        """For "it is too dark, the lamp is off": what helps is off, and this switches things on."""
        things = {singular(word) for one in self.named if one.grounded for word in keys(one.words)}
        return (
            bool({"off", "out"} & set(self.flat)) and bool(_ON & name) and any(h & things for h in self.signs)
        )

    def _is_missed(self, info: ActionInfo) -> bool:
        """For "nobody has been round for the eggs yet": what an action is about is still waited for."""
        about = {singular(word) for word in name_words(info.name)[1:]} - _EMPTY - LIGHT_VERBS
        said = {singular(word) for word in self.flat}
        return bool(about and _undone() & set(self.flat)) and about <= said

    def fill(self, info: ActionInfo) -> Filled | None:
        """What is said for an action's inputs; None if something that only words can give is missing."""
        filled = fill_slots(info, self.words, (), self.scene)
        numbers = set(number_inputs(info))
        listed = chosen(info, self.words)
        kept = {n: v for n, v in filled.values.items() if n in numbers or n in listed}
        phrases = {n: p for n, p in filled.phrases.items() if n in listed}
        free = list(self.named)
        for name in text_inputs(info):
            if name in kept:
                continue
            known = [one for one in free if one.grounded and _fit(name, one, self.scene) >= 1.0]
            among = known if parameter_role(name) == "place" and known else free
            scored = [(_fit(name, one, self.scene), -free.index(one), one) for one in among]
            best = max(scored, key=lambda one: one[:2], default=None)
            if best is None or best[0] < 1.0:
                if name in info.optional:
                    continue
                return None
            kept[name], phrases[name] = plain(bare(best[2].words)), best[2].words
            free.remove(best[2])
        for name, kind in info.inputs.items():
            if kind_of(kind) == "bool":
                state = self._state(name)
                if state is None:
                    return None
                kept[name] = state
        missing = [name for name in info.inputs if name not in kept and name not in info.optional]
        return Filled(values=kept, phrases=phrases, missing=missing)

    def _state(self, name: str) -> bool | None:
        """Whether an input has to be so or not for the action to help; None if that is not plain."""
        helps = frozenset().union(*self.signs)
        words = set(_bases(name_words(name)))
        against = {word for word in words for one in concepts((word,)) if opposed(one, self.against(helps))}
        if words & helps or (words & _ON and helps and not helps & _ENDING):
            return True
        return False if against or helps & _ENDING else None

    @staticmethod
    def against(helps: frozenset[str]) -> tuple[Concept, ...]:
        """What helps, as concepts."""
        return tuple(concept for word in sorted(helps) for concept in concepts((word,)))


_ON = frozenset({"on", "active", "enabled", "running", "state", "power", "switch"})
_NONE = frozenset({"no", "any", "nothing", "none", "hardly", "barely"})
_FINDING = frozenset(_data()["finding"])
_ENDING = frozenset({"close", "shut", "off", "mute", "silence", "stop"})


def _bases(words: tuple[str, ...] | list[str]) -> Iterator[str]:
    for word in words:
        yield word
        yield lemma(word)
        yield singular(word)


_PLACES = frozenset(load_data("helping")["places"])
_NO_THINGS = frozenset(load_data("helping")["no_things"])


def _fit(name: str, named: _Named, scene: Scene) -> float:
    """How well something that is named fits an input; 0 if nothing says that it does."""
    role = parameter_role(name)
    words = {singular(word) for word in name_words(name)}
    words |= {other for word in words for other in lexicon().synonyms.get(word, ())}
    said = named.kinds | {singular(word) for word in keys(named.words)}
    called = bool(words & said) or any(one.endswith(word) for one in said for word in words if len(word) > 3)
    proper = named.words[0].is_capital and not named.grounded and named.before != ""
    person = scene.is_person(named.words) or (role == "person" and named.words[0].is_capital)
    if role == "text" or (role == "person" and not person) or (person and role in {"place", "object"}):
        return 0.0
    lacked = role == "object" and named.before in _LACKED and not named.grounded
    if not (called or named.grounded or person or proper or lacked or role == "place"):
        return 0.0
    if not called and role != "place" and words & {item.class_name for item in scene.objects}:
        # No aisle where windows are known.
        return 0.0
    score = 3.0 * called + 1.5 * named.grounded
    if named.before in _PLACES:
        score += (2.1 if named.before == "of" else 2.0) if role == "place" else 0.5
    return score + (1.0 if named.definite or person or lacked else 0.3)


_LACKED = frozenset({"of", "more", "no", "any", "without", "on"})
"""Before what there is none of ("run out of A", "no more A")."""


def _named(words: Phrase, scene: Scene) -> Iterator[_Named]:
    """The things that are named, each with the word before it."""
    spans = {start: (end, item) for start, end, item in map_spans(words, scene)}
    index = 0
    while index < len(words):
        if index in spans:
            end, item = spans[index]
            kinds = _kinds(members_of(words[index:end], scene.objects) if item is None else (item,))
            begin = index - 1 if index and scene.ground(words[index - 1 : end]).outcome == "match" else index
            begin = index if words[begin].key in lexicon().determiners | _PLACES else begin
            yield _Named(_before(words, begin), words[begin:end], True, True, kinds)
            index = end
            continue
        end = index
        while end < len(words) and end not in spans and not _bounds(words, end, index):
            end += 1
        part = bare(words[index:end])
        if part and not set(keys(part)) & _NO_THINGS:
            group = members_of(part, scene.objects)
            definite = bool(group) or _definite(words, index, end)
            yield _Named(_before(words, index), part, definite, bool(group), _kinds(group))
        index = max(end, index + 1)


def _kinds(items: Sequence[MapObject]) -> frozenset[str]:
    return frozenset(singular(word) for item in items for word in name_words(item.class_name))


def _definite(words: Phrase, index: int, end: int) -> bool:
    before = keys(words[max(0, index - 1) : index + 1])
    return bool({"the", "that", "this", "those", "these"} & set(before)) or words[end - 1].key.isdigit()


def _before(words: Phrase, index: int) -> str:
    at = index - 1
    while at >= 0 and words[at].key in lexicon().determiners:
        at -= 1
    return words[at].key if at >= 0 else ""


def _bounds(words: Phrase, at: int, start: int) -> bool:
    """Whether a name ends before a word."""
    word = words[at]
    lex = lexicon()
    small = (
        lex.be
        | lex.auxiliaries
        | lex.person_pronouns
        | lex.operator_pronouns
        | lex.thing_pronouns
        | lex.determiners
    )
    if not word.is_word or word.key in small | lex.goals_and_places | lex.question_starts | _BOUNDS:
        return True
    if word.key in lex.nouns or word.key.isdigit() or word.is_capital:
        return False
    base = lemma(word.key)
    inflected = base != word.key and singular(word.key) != base
    known = lex.verbs.match((base,)) is not None or word.key.endswith(("ing", "ed"))
    return (known and (inflected or at > start)) or word.key.endswith("ly")


_BOUNDS = frozenset(load_data("helping")["bounds"])
