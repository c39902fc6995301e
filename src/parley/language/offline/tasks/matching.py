"""Which action of a catalogue a clause asks for, by its name, inputs and description, whatever they are."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.choices import says_choice, states_verb
from parley.language.offline.tasks.parts import map_spans, unquoted
from parley.language.offline.tasks.recalled import recall_inputs
from parley.language.offline.tasks.roles import number_inputs, parameter_role, text_inputs
from parley.language.offline.tasks.signature import EMPTY, ENDING, STATES, VAGUE, Signature, signature_of
from parley.language.offline.tasks.slots import Filled, fill_slots
from parley.language.offline.words.concepts import (
    LIGHT_VERBS,
    VERB_LINES,
    Concept,
    concepts,
    likeness,
    opposed,
)
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, singular
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["Match", "best_match"]

_DATA = load_data("names")


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


def best_match(infos: Sequence[ActionInfo], words: Phrase, scene: Scene) -> Match | None:
    """The one action that fits a clause best; None if none does, or two fit alike.

    Args:
        infos: The actions that may be meant.
        words: The clause, its verb first where it has one.
        scene: What is known.
    """
    said = concepts(keys(unquoted(words)))
    told = _told_as_text(words)
    retold = concepts(keys(unquoted(told))) if told != words else said
    found = [
        match
        for info in infos
        if (match := _match(info, *((told, retold) if _takes_text(info) else (words, said)), scene))
        is not None
    ]
    if not found:
        return None
    found = [match for match in found if match.strong or match.complete] or found
    found.sort(key=lambda match: -match.score)
    if len(found) > 1 and found[0].score - found[1].score < _MARGIN:
        return None
    return found[0]


def _takes_text(info: ActionInfo) -> bool:
    return any(parameter_role(name) == "text" for name in text_inputs(info))


def _told_as_text(words: Phrase) -> Phrase:
    """With what is to be told in quotation marks: "that the patient in room 1 is in pain"."""
    flat = keys(words)
    if '"' in flat:
        return words
    begins = lexicon().determiners | lexicon().person_pronouns | {"there", "it", "we", "they", "i", "you"}
    at = next((i for i, w in enumerate(flat[:-2]) if i > 1 and w in {"that", "saying"}), 0)
    if not at or not (flat[at + 1] in begins or words[at + 1].is_capital):
        return words
    return (*words[:at], Word('"', '"'), *words[at + 1 :])


_LEAST_SAYING = frozenset(_DATA["least_saying"])
_MARGIN = 0.15
_LEAST = 0.7
_HALF = 0.4
_TWO = 2


def _match(info: ActionInfo, words: Phrase, said: Sequence[Concept], scene: Scene) -> Match | None:
    signature = signature_of(scene.catalogue.plainly_named(info).name, tuple(info.inputs), info.description)
    if signature.starting and said and said[0].text in ENDING:
        return None
    ending = signature.verb is not None and signature.verb.text in ENDING
    if ending and signature.verb is not None and not any(likeness(signature.verb, c) for c in said):
        # What ends something is not meant by the deed alone.
        return None
    relative = bool(number_inputs(info)) and not text_inputs(info)
    named = (signature.verb, *signature.about)
    if not relative and any(opposed(part, said) for part in named if part is not None):
        return None
    if _NOTHING & set(keys(words[:3])) and not _takes_text(info):
        return None
    found = _Found(info, signature, words, said)
    if not (found.anything or says_choice(info, words)):
        return None
    explained = found.explained
    if found.verb_at[:1] == (0,):
        explained -= _named_on_map(explained - set(found.verb_at), words, info, scene)
    explained -= _named_so(words, explained)
    opening = _opening(words, said, explained)
    retold = _retold(signature, said, explained, words, scene) if found.shared else set()
    filled = fill_slots(info, words, {*explained, *opening, *retold}, scene)
    if any(_goes_on(phrase) for name, phrase in filled.phrases.items() if parameter_role(name) != "text"):
        return None
    _with_their_nouns(info, found, filled, words)
    recall_inputs(info, filled, words, scene)
    evidence = _Evidence(found, filled, bool(opening))
    strong = evidence.strong
    if not (strong or evidence.weak) or evidence.another_left:
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


def _with_their_nouns(info: ActionInfo, found: _Found, filled: Filled, words: Phrase) -> None:
    """What is handled, by its own name where the action has another for it ("red bag": luggage)."""
    alike = [at for score, at in found.about if at and at[0] and _LEAST <= score < 1.0]
    for name in text_inputs(info):
        if parameter_role(name) != "object":
            continue
        for at in alike:
            noun, phrase = words[at[0] : at[-1] + 1], filled.phrases.get(name, ())
            if name in filled.missing:
                filled.missing.remove(name)
            elif not phrase or keys(words[at[0] - len(phrase) : at[0]]) != keys(phrase):
                continue
            filled.values[name], filled.phrases[name] = plain((*phrase, *noun)), (*phrase, *noun)


_DOING = frozenset({"do", "make", "perform", "run", "execute", "start", "begin", "take"})


_QUESTIONS = frozenset({"how", "what", "which", "is", "are", "does", "do"})
_NOTHING = frozenset({"nothing", "nobody", "none", "neither", "noone"})
_WRITING = frozenset({"write", "put", "show", "display", "have", "say", "print"})
"""How a text gets onto a display, whatever the name of the action says."""
_CHOOSING = frozenset({"speak", "talk", "select", "choose", "continue", "go"})


class _Found:
    """Which of an action's words a clause has."""

    def __init__(
        self, info: ActionInfo, signature: Signature, words: Phrase, said: Sequence[Concept]
    ) -> None:
        self.info, self.signature, self.said = info, signature, said
        self.first = keys(words[:1])[0]
        self.shared = _described(signature, said)
        """How many words of the description are said."""
        self.verb, self.verb_at = _verb_likeness(signature, said, self.shared)
        if self.verb < _BY_STATE and states_verb(info, words):
            self.verb, self.verb_at = _BY_STATE, (0,)
        by_second = self.verb_at == (0,) and _names_deed(signature, said[0])
        about = [
            _nearest(part, said) for part in signature.about if not (by_second and part is signature.second)
        ]
        pointed = keys(words[1:3])[:1] in _POINTING and self.verb >= _LEAST
        self.pointed = pointed and not any(score >= _LEAST for score, _ in about)
        """Whether only a pronoun stands for what a name names."""
        if self.pointed:
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
            for (score, _), part in zip(found.about, signature.about, strict=False)
        ]
        self.covered = sum(scores) / len(scores) if scores else 0.0
        self.whole = all(score >= _LEAST for score in scores)
        if signature.verb is None and filled.states and any(score >= _LEAST for score in scores):
            # "Smoke off" for a smoke machine.
            self.whole = True
        self.about = bool(scores)
        named = {at[0] for (score, at) in found.about if score >= _LEAST and at}
        self.unexplained = _unexplained(filled, signature, named)
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

    @property
    def another_left(self) -> bool:
        """Whether another thing of the kind that an input takes is named, and left ("A on and B off")."""
        takes = {word for name in self.filled.phrases for word in name_words(name)}
        left = (part for part in self.filled.left if part.grounded and not part.before)
        return any(takes & part.kinds for part in left)

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
        every = not (filled.left or filled.missing or filled.numbers_left)
        if self.about and self.name_light and filled.chosen and every:
            # "Tilt the lamp to the left" for "adjust_lamp (direction)".
            return True
        all_said = not (filled.left or filled.missing or filled.numbers_left)
        if all_said and self.about and found.first in _WRITING and filled.phrases:
            return True
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
        all_said = several and not (filled.left or filled.missing or filled.numbers_left)
        if self.whole and all_said and verb > 0 and self.found.verb_at[:1] == (0,):
            return True
        if filled.chosen and self.of_kind and self.light and not filled.missing:
            return True
        return bool(self.light and filled.measured and several and (self.of_kind or verb > 0))

    @property
    def score(self) -> float:
        """How much speaks for it."""
        found, filled = self.found, self.filled
        about = self.about and not found.pointed
        score = 2 * found.verb + (2 * self.covered if about else 0.6) + 0.3 * min(found.shared, 3)
        score += 0.5 * filled.fit - 0.5 * len(self.unexplained) - 0.4 * len(filled.missing)
        return score - 0.5 * filled.numbers_left - (0 if self.whole else 1)


def _typed_said(signature: Signature, said: Sequence[Concept]) -> bool:
    """Whether the kind of thing that an input takes is said."""
    types = [concept for one in signature.typed for concept in concepts((one,))]
    return any(likeness(one, concept) >= _LEAST for one in types for concept in said)


def _measures(part: Concept, filled: Filled) -> bool:
    """Whether a number with its unit stands for what a name names: degrees for a temperature."""
    return any(part.text in names for names in filled.measured)


def _retold(
    signature: Signature, said: Sequence[Concept], explained: set[int], words: Phrase, scene: Scene
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
    return {0} if known is not None or any(c.at[0] == 0 and c.lines & VERB_LINES for c in said) else set()


def _named_on_map(explained: set[int], words: Phrase, info: ActionInfo, scene: Scene) -> set[int]:
    """Of the words that say what an action is about, those that name a thing it is to be used on."""
    if not text_inputs(info):
        return set()
    spans = [range(start, end) for start, end, _ in map_spans(words, scene)]
    return {index for index in explained for span in spans if index in span}


def _named_so(words: Phrase, explained: set[int]) -> set[int]:
    """Of the words that say what an action is about, those that begin a name: "Radio" in "Radio 4"."""
    return {
        i
        for i in explained
        if i and words[i].is_capital and i + 1 < len(words) and words[i + 1].key[:1].isdigit()
    }


def _goes_on(phrase: Phrase) -> bool:
    """Whether a name has another clause behind it ("counter 3 once you have wiped it")."""
    flat = keys(phrase)
    return any(a in {"once", "after", "before", "when", "until"} and b == "you" for a, b in pairwise(flat))


_POINTING = frozenset({("it",), ("them",), ("everything",), ("all",)})
_BY_STATE = 0.8
"""How well what an input can be stands for the verb of a name."""
_BY_POINTING = 0.7
"""How well a pronoun stands for what a name names."""


def _verb_likeness(
    signature: Signature, said: Sequence[Concept], shared: int
) -> tuple[float, tuple[int, ...]]:
    """How well the verb of the name, or of the description with more of that, is said; and where."""
    best: tuple[float, tuple[int, ...]] = (0.0, ())
    doing = signature.doing
    more = shared - (doing is not None and doing.text not in LIGHT_VERBS)
    telling = doing is not None and doing.text not in _LEAST_SAYING and _acts_on(signature)
    exact = doing is not None and bool(said) and said[0].text == doing.text and (more > 0 or telling)
    for part, weight in ((signature.verb, 1.0), (doing if exact or shared > 1 else None, 0.8)):
        for concept in said:
            if part is None or concept.within or concept.text in EMPTY - STATES:
                continue
            alike = likeness(_as_deed(part), concept)
            score = alike * weight * (1.0 if concept.at[0] == 0 else 0.9)
            if concept.text in _LEAST_SAYING and part.text != concept.text and len(concept.at) == 1:
                score *= 0.6
            if part is signature.verb and concept.at == (0,) and _names_deed(signature, concept):
                score = max(score, 0.9)
            if score > best[0] or (score and score == best[0] and len(concept.at) > len(best[1])):
                best = score, concept.at
    return best


def _names_deed(signature: Signature, said: Concept) -> bool:
    """Whether a clause opens with a second deed of a name ("paint A red" for "spray_paint")."""
    return signature.second is not None and signature.second.text == said.text


def _as_deed(part: Concept) -> Concept:
    """A verb of a name, without the things that its word may stand for."""
    return replace(part, lines=part.lines & VERB_LINES) if part.lines & VERB_LINES else part


def _acts_on(signature: Signature) -> bool:
    """Whether the verb of a description says enough: it takes something, and is no way to move."""
    found = lexicon().verbs.match((signature.doing.text,)) if signature.doing is not None else None
    return bool(signature.typed) and not (found is not None and found[1].startswith(("motion:", "back:")))


def _nearest(part: Concept, said: Sequence[Concept]) -> tuple[float, tuple[int, ...]]:
    scored = (
        (_same_thing(part, concept), concept.at)
        for concept in said
        if concept.text not in EMPTY - STATES or concept.text == part.text
    )
    return max(scored, key=lambda one: one[0], default=(0.0, ()))


def _same_thing(part: Concept, said: Concept) -> float:
    """How alike two things are; a compound is a kind of what it ends in ("worksheets" are sheets)."""
    alike = likeness(part, said)
    one, other = singular(part.text), singular(said.text)
    return alike or (_COMPOUND if len(one) >= _SHORT and other != one and other.endswith(one) else 0.0)


_COMPOUND = 0.75
_SHORT = 4
"""How much a compound is like its last part, and letters of such a part at least."""


def _described(signature: Signature, said: Sequence[Concept]) -> int:
    """How many words of the description are said."""
    content = [
        c for c in said if c.text not in EMPTY | VAGUE and (len(c.at) > 1 or c.text not in LIGHT_VERBS)
    ]
    return sum(any(likeness(part, c) >= _LEAST for c in content) for part in signature.described)


def _unexplained(filled: Filled, signature: Signature, named: Collection[int]) -> list[str]:
    """Things that are named and that neither the action's name, its inputs nor its description knows."""
    known = (
        *signature.about,
        *signature.described,
        *((signature.verb,) if signature.verb is not None else ()),
        *(concept for one in signature.typed for concept in concepts((one,))),
    )
    left: list[str] = []
    for part in filled.left:
        if part.before not in {"", "of"} or part.grounded or part.start in filled.counted:
            continue
        if part.end in named and len(part.words) == 1:
            # "The print heads" for "clean_heads".
            continue
        for word in keys(part.words):
            if word in EMPTY | _FILLERS or word in lexicon().person_pronouns or lemma(word) in LIGHT_VERBS:
                continue
            if word in lexicon().person_words and not part.grounded and _serves(signature):
                continue
            concept = concepts((word,))[-1]
            if singular(word) not in signature.typed and not any(
                likeness(concept, k) >= _LEAST for k in known
            ):
                left.append(word)
    return left


def _serves(signature: Signature) -> bool:
    """Whether somebody gets something by an action, so that they may be named."""
    found = lexicon().verbs.match((signature.verb.text,)) if signature.verb is not None else None
    return found is not None and found[1].startswith(("transfer:", "speak:"))


_FILLERS = frozenset(_DATA["fillers"] + _DATA["oneself"])
