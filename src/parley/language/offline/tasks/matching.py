"""Which action of a catalogue a clause asks for, by its name, inputs and description, whatever they are."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.choices import says_choice, states_verb
from parley.language.offline.tasks.parts import map_spans, unquoted
from parley.language.offline.tasks.recalled import recall_inputs
from parley.language.offline.tasks.roles import number_inputs, parameter_role, text_inputs
from parley.language.offline.tasks.slots import Filled, fill_slots
from parley.language.offline.words.concepts import LIGHT_VERBS, Concept, concepts, likeness, opposed
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.text import Phrase, keys, lemma, singular
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["Match", "best_match"]

_DATA = load_data("names")
_EMPTY = frozenset(_DATA["empty"] + _DATA["small"])
_VAGUE = frozenset(_DATA["vague"])
"""Words of names and descriptions that tell no action from another."""


@dataclass(frozen=True, slots=True)
class _Signature:
    """An action's name taken apart."""

    verb: Concept | None
    about: tuple[Concept, ...]
    """What its name names besides."""
    typed: frozenset[str]
    described: tuple[Concept, ...]
    doing: Concept | None
    """The verb of its description."""


@dataclass(frozen=True, slots=True)
class Match:
    """An action with what is said for it."""

    info: ActionInfo
    score: float
    strong: bool
    """Whether its name says what is asked for."""
    filled: Filled
    verb: float
    explained: frozenset[int]
    verb_first: bool = False
    """Whether the clause begins with its verb."""
    plain: bool = True
    """Whether nothing is named that the action knows nothing of."""

    @property
    def complete(self) -> bool:
        """Whether all that it needs is said, and nothing else."""
        if self.filled.missing and any(part.grounded for part in self.filled.left):
            return False
        known = all(part.before in {"", "of"} and not part.grounded for part in self.filled.left)
        used = known or self.verb >= _LEAST
        return self.plain and used and not self.filled.missing and not self.filled.numbers_left


@lru_cache(maxsize=2048)
def _signature(name: str, inputs: tuple[str, ...], description: str) -> _Signature:
    words = name_words(name)
    typed = frozenset(singular(word) for one in inputs for word in name_words(one.replace("::", "_")))
    parts = _segments(words)
    verb = next((part for part in parts if _is_verb(part)), None)
    if (
        verb is not None
        and parts[0] is not verb
        and not parts[0].lines
        and parts[0].text not in lexicon().nouns
        and verb.text in lexicon().nouns
    ):
        verb = parts[0]
    if verb is None and len(parts) > 1 and not parts[0].lines and parts[0].text not in lexicon().nouns:
        verb = parts[0]
    if verb is not None and verb.text in lexicon().be | lexicon().auxiliaries | {"be", "have"}:
        verb = None
    # The "reading" of a "reading light" is no deed.
    parts = [
        p
        if p is verb or len(p.at) != 1 or not words[p.at[0]].endswith("ing")
        else replace(p, lines=frozenset())
        for p in parts
    ]
    people = any(parameter_role(one) == "person" for one in inputs)
    alike = frozenset(line for one in typed for concept in concepts((one,)) for line in concept.lines)
    about = tuple(
        p
        for p in parts
        if p is not verb
        and p.text not in _EMPTY | _VAGUE
        and singular(p.text) not in typed
        and not p.lines & alike
        and not (people and singular(p.text) in _PEOPLE)
    )
    if verb is None and not about:
        # "is_done" is about being done.
        about = tuple(part for part in parts[-1:] if part.text not in lexicon().be)
    told = re.findall(r"[a-z]+", description.lower())
    doing = next(iter(_segments(tuple(told[:3]))), None)
    described = tuple(
        p for p in _segments(tuple(told)) if p.text not in _EMPTY | _VAGUE and singular(p.text) not in typed
    )
    return _Signature(verb, about, typed, described, doing)


def _segments(words: tuple[str, ...]) -> list[Concept]:
    """Words in a row as phrases where they are known phrases, else one by one."""
    found = concepts(words, spoken=False)
    parts: list[Concept] = []
    index = 0
    while index < len(words):
        here = [c for c in found if c.at[:1] == (index,) and c.at[-1] == index + len(c.at) - 1]
        longest = max(
            here, key=lambda concept: len(concept.at), default=Concept(words[index], frozenset(), (index,))
        )
        parts.append(longest)
        index += len(longest.at)
    return parts


def _is_verb(part: Concept) -> bool:
    first = part.text.split()[0]
    return lexicon().verbs.match((first,)) is not None or bool(part.lines & _verb_lines())


@lru_cache(maxsize=1)
def _verb_lines() -> frozenset[int]:
    return frozenset(range(len(load_data("deeds")["verbs"])))


def best_match(infos: Sequence[ActionInfo], words: Phrase, scene: Scene) -> Match | None:
    """The one action that fits a clause best; None if none does, or two fit alike.

    Args:
        infos: The actions that may be meant.
        words: The clause, its verb first where it has one.
        scene: What is known.
    """
    said = concepts(keys(unquoted(words)))
    found = [match for info in infos if (match := _match(info, words, said, scene)) is not None]
    if not found:
        return None
    found = [match for match in found if match.strong or match.complete] or found
    found.sort(key=lambda match: -match.score)
    if len(found) > 1 and found[0].score - found[1].score < _MARGIN:
        return None
    return found[0]


_STATES = frozenset({"on", "off", "up", "down"})
_LEAST_SAYING = frozenset(_DATA["least_saying"])
_PEOPLE = lexicon().person_words | {"human", "people", "staff", "crew", "team"}
_MARGIN = 0.15
_LEAST = 0.7
_HALF = 0.4
_TWO = 2


def _match(info: ActionInfo, words: Phrase, said: Sequence[Concept], scene: Scene) -> Match | None:
    signature = _signature(scene.catalogue.plainly_named(info).name, tuple(info.inputs), info.description)
    relative = bool(number_inputs(info)) and not text_inputs(info)
    named = (signature.verb, *signature.about)
    if not relative and any(opposed(part, said) for part in named if part is not None):
        return None
    found = _Found(info, signature, words, said)
    if not (found.anything or says_choice(info, words)):
        return None
    explained = found.explained
    if found.verb_at[:1] == (0,):
        explained -= _named_on_map(explained - set(found.verb_at), words, info, scene)
    opening = _opening(words, said, explained)
    retold = _retold(signature, said, explained, words, scene) if found.shared else set()
    filled = fill_slots(info, words, {*explained, *opening, *retold}, scene)
    recall_inputs(info, filled, words, scene)
    evidence = _Evidence(found, filled, bool(opening))
    strong = evidence.strong
    if not (strong or evidence.weak):
        return None
    return Match(
        info,
        evidence.score,
        strong,
        filled,
        found.verb,
        frozenset(explained),
        verb_first=found.verb_at[:1] == (0,),
        plain=not evidence.unexplained,
    )


_DOING = frozenset({"do", "make", "perform", "run", "execute", "start", "begin", "take"})


_QUESTIONS = frozenset({"how", "what", "which", "is", "are", "does", "do"})
_CHOOSING = frozenset({"speak", "talk", "select", "choose", "continue", "go"})


class _Found:
    """Which of an action's words a clause has."""

    def __init__(
        self, info: ActionInfo, signature: _Signature, words: Phrase, said: Sequence[Concept]
    ) -> None:
        self.info, self.signature, self.said = info, signature, said
        self.first = keys(words[:1])[0]
        self.shared = _described(signature, said)
        """How many words of the description are said."""
        self.verb, self.verb_at = _verb_likeness(signature, said, self.shared)
        if self.verb < _BY_STATE and states_verb(info, words):
            self.verb, self.verb_at = _BY_STATE, (0,)
        about = [_nearest(part, said) for part in signature.about]
        pointed = keys(words[1:3])[:1] in _POINTING and self.verb >= _LEAST
        if pointed and not any(score >= _LEAST for score, _ in about):
            about = [(_BY_POINTING, at) for _, at in about]
        self.about = about
        self.typed = bool(signature.typed & {singular(word) for word in keys(words)})
        """Whether what an input takes is said."""

    @property
    def anything(self) -> bool:
        return bool(self.verb or self.shared or self.typed or any(score for score, _ in self.about))

    @property
    def explained(self) -> set[int]:
        """The words that say what is to be done."""
        return {i for score, at in (*self.about, (self.verb, self.verb_at)) if score >= _LEAST for i in at}


class _Evidence:
    """What speaks for an action, and how much."""

    def __init__(self, found: _Found, filled: Filled, opened: bool) -> None:
        self.found, self.filled = found, filled
        signature = found.signature
        scores = [
            max(score, _LEAST) if _measures(part, filled) else score
            for (score, _), part in zip(found.about, signature.about, strict=True)
        ]
        self.covered = sum(scores) / len(scores) if scores else 0.0
        self.whole = all(score >= _LEAST for score in scores)
        if signature.verb is None and filled.states and any(score >= _LEAST for score in scores):
            # "Smoke off" for a smoke machine.
            self.whole = True
        self.about = bool(scores)
        self.unexplained = _unexplained(filled, signature)
        self.light = not opened or found.first in LIGHT_VERBS
        if signature.verb is None and not found.info.inputs:
            # "Sound the horn" for an action called "horn".
            starting = concepts(("turn", "on"))[0]
            self.light = self.light or any(likeness(starting, c) > 0 for c in found.said if c.at[0] == 0)
        self.name_light = signature.verb is None or signature.verb.text in LIGHT_VERBS
        if found.first in _QUESTIONS and found.info.outputs:
            self.light = self.name_light = True
        self.nameless = not opened and found.verb_at[:1] != (0,)
        self.some = bool(filled.values)
        self.of_kind = filled.of_kind or _typed_said(signature, found.said)

    @property
    def strong(self) -> bool:
        """Whether the name says what is asked for, and nothing else is named."""
        found = self.found
        elsewhere = bool(self.filled.missing) and any(part.grounded for part in self.filled.left)
        if self.unexplained or elsewhere or (len(self.filled.missing) > 1 and not (self.some or found.verb)):
            return False
        return (self.whole and (self._by_name() or self._by_inputs())) or self._nearly()

    def _nearly(self) -> bool:
        """Whether half of what its name is about is said, and everything else that it needs, and no more."""
        found, filled = self.found, self.filled
        all_else = found.verb == 1.0 and len(filled.values) > _TWO
        if filled.missing or filled.numbers_left or filled.left or (self.covered < _HALF and not all_else):
            return False
        texts = text_inputs(found.info)
        return found.verb >= _LEAST and filled.exact and (self.of_kind or len(filled.phrases) == len(texts))

    def _by_name(self) -> bool:
        verb, inputs = self.found.verb, self.found.info.inputs
        if verb >= _LEAST and (self.about or verb == 1.0 or self.some or not inputs):
            return True
        return self.about and self.light and (self.name_light or verb > 0)

    def _by_inputs(self) -> bool:
        filled, found = self.filled, self.found
        asked = self.light or found.first in _CHOOSING
        if (asked and filled.chosen and not self.about) or (
            found.typed and found.first in _DOING and filled.phrases
        ):
            return True
        named = found.verb > 0 or (self.about and (self.light or self.name_light))
        if filled.measured and named and not text_inputs(found.info):
            return True
        all_said = not (filled.left or filled.missing or filled.numbers_left)
        typed = self.some and found.typed and (self.name_light or found.verb > 0)
        return self.nameless and all_said and (self.about or typed)

    @property
    def weak(self) -> bool:
        """Whether it may be meant if nothing else is."""
        verb = self.found.verb
        shared = self.found.shared
        if verb >= _LEAST and (shared or self.whole or (self.some and (self.of_kind or verb == 1.0))):
            return True
        if (shared > 1 or (shared and self.some)) and (self.light or verb > 0):
            return True
        return self._partly(verb)

    def _partly(self, verb: float) -> bool:
        filled = self.filled
        several = len(filled.values) > 1
        named = (
            self.covered
            and self.light
            and (self.name_light or verb > 0 or self.found.first in _DOING or several)
        )
        if self.whole and (named or (verb > 0 and filled.phrases and self.of_kind)):
            return True
        if filled.chosen and self.of_kind and self.light and not filled.missing:
            return True
        return bool(self.light and filled.measured and several and (self.of_kind or verb > 0))

    @property
    def score(self) -> float:
        """How much speaks for it."""
        found, filled = self.found, self.filled
        score = 2 * found.verb + (2 * self.covered if self.about else 0.6) + 0.3 * min(found.shared, 3)
        score += 0.5 * filled.fit - 0.5 * len(self.unexplained) - 0.4 * len(filled.missing)
        return score - 0.5 * filled.numbers_left - (0 if self.whole else 1)


def _typed_said(signature: _Signature, said: Sequence[Concept]) -> bool:
    """Whether the kind of thing that an input takes is said."""
    types = [concept for one in signature.typed for concept in concepts((one,))]
    return any(likeness(one, concept) >= _LEAST for one in types for concept in said)


def _measures(part: Concept, filled: Filled) -> bool:
    """Whether a number with its unit stands for what a name names: degrees for a temperature."""
    return any(part.text in names for names in filled.measured)


def _retold(
    signature: _Signature, said: Sequence[Concept], explained: set[int], words: Phrase, scene: Scene
) -> set[int]:
    """Words of the description itself, which are no values; names of things on the map stay what they are."""
    spans = [range(start, end) for start, end, _ in map_spans(words, scene)]
    same = {c.at for c in said for part in signature.described if likeness(part, c) == 1.0}
    found = {i for at in same for i in at} - explained
    return {i for i in found if not any(i in span for span in spans)}


def _opening(words: Phrase, said: Sequence[Concept], explained: set[int]) -> set[int]:
    """The clause's own verb, if it has one and nothing of the action explains it: it is no value."""
    if 0 in explained:
        return set()
    first = keys(words[:1])
    known = lexicon().verbs.match((lemma(first[0]), *keys(words[1:])))
    return {0} if known is not None or any(c.at[0] == 0 and c.lines & _verb_lines() for c in said) else set()


def _named_on_map(explained: set[int], words: Phrase, info: ActionInfo, scene: Scene) -> set[int]:
    """Of the words that say what an action is about, those that name a thing it is to be used on."""
    if not text_inputs(info):
        return set()
    spans = [range(start, end) for start, end, _ in map_spans(words, scene)]
    return {index for index in explained for span in spans if index in span}


_POINTING = frozenset({("it",), ("them",), ("everything",), ("all",)})
_BY_STATE = 0.8
"""How well what an input can be stands for the verb of a name."""
_BY_POINTING = 0.7
"""How well a pronoun stands for what a name names."""


def _verb_likeness(
    signature: _Signature, said: Sequence[Concept], shared: int
) -> tuple[float, tuple[int, ...]]:
    """How well the verb of the name, or of the description with more of that, is said; and where."""
    best: tuple[float, tuple[int, ...]] = (0.0, ())
    doing = signature.doing
    more = shared - (doing is not None and doing.text not in LIGHT_VERBS)
    exact = (
        doing is not None and bool(said) and said[0].text == doing.text and (more > 0 or _acts_on(signature))
    )
    for part, weight in ((signature.verb, 1.0), (doing if exact or shared > 1 else None, 0.8)):
        for concept in said:
            if part is None or concept.text in _EMPTY - _STATES:
                continue
            score = likeness(part, concept) * weight * (1.0 if concept.at[0] == 0 else 0.9)
            if concept.text in _LEAST_SAYING and part.text != concept.text and len(concept.at) == 1:
                score *= 0.6
            if score > best[0] or (score and score == best[0] and len(concept.at) > len(best[1])):
                best = score, concept.at
    return best


def _acts_on(signature: _Signature) -> bool:
    """Whether the verb of a description says enough: it takes something, and is no way to move."""
    found = lexicon().verbs.match((signature.doing.text,)) if signature.doing is not None else None
    return bool(signature.typed) and not (found is not None and found[1].startswith(("motion:", "back:")))


def _nearest(part: Concept, said: Sequence[Concept]) -> tuple[float, tuple[int, ...]]:
    scored = (
        (likeness(part, concept), concept.at)
        for concept in said
        if concept.text not in _EMPTY - _STATES or concept.text == part.text
    )
    return max(scored, key=lambda one: one[0], default=(0.0, ()))


def _described(signature: _Signature, said: Sequence[Concept]) -> int:
    """How many words of the description are said."""
    content = [
        c for c in said if c.text not in _EMPTY | _VAGUE and (len(c.at) > 1 or c.text not in LIGHT_VERBS)
    ]
    return sum(any(likeness(part, c) >= _LEAST for c in content) for part in signature.described)


def _unexplained(filled: Filled, signature: _Signature) -> list[str]:
    """Things that are named and that neither the action's name, its inputs nor its description knows."""
    known = (
        *signature.about,
        *signature.described,
        *((signature.verb,) if signature.verb is not None else ()),
        *(concept for one in signature.typed for concept in concepts((one,))),
    )
    left: list[str] = []
    for part in filled.left:
        if part.before not in {"", "of"} or part.grounded:
            continue
        for word in keys(part.words):
            if word in _EMPTY | _FILLERS or word in lexicon().person_pronouns or lemma(word) in LIGHT_VERBS:
                continue
            concept = concepts((word,))[-1]
            if singular(word) not in signature.typed and not any(
                likeness(concept, k) >= _LEAST for k in known
            ):
                left.append(word)
    return left


_FILLERS = frozenset(_DATA["fillers"] + _DATA["oneself"])
