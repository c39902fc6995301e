"""What people teach, and taught: other words for things, and sentences of their own with what they mean.

It stands in the memory, one entry for each, under a name of its own form (`taught_name`); only what a person
told counts. A word becomes another name of its thing. A sentence is decided as what it
means, and goes through everything that any order goes through.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, Final

from parley.gate.assent import assent_of
from parley.gate.control import control_of
from parley.gate.stop_words import calls_to_stop, is_no
from parley.language.base import Language, Situation
from parley.language.builtin.lexicon import lexicon, stems
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import plain, question_of
from parley.language.dialogue.state import Dialogue
from parley.language.lexicon import load_data
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry, taught_name
from parley.messages.pvf import NATIVE_TYPES, fits_type
from parley.messages.status import ActionInfo
from parley.sentences import Sentence, listed, sentence
from parley.umrf.kinds import parameters_of
from parley.world.object_map import MapObject

__all__ = [
    "Learned", "Taught", "asked_about", "entry_of", "founded", "key", "lesson_of", "meant", "named",
    "problem_of", "reserved", "taught_in", "to_forget", "weighed", "with_names",
]  # fmt: skip

Value = str | int | float | bool

_MOST_WORDS: Final = 8
_MOST_CHARS: Final = 80
_ARTICLE: Final = re.compile(r"^(?:the|a|an|my|our)\s+", re.IGNORECASE)
_SMALL: Final = (
    "small", "logic", "pronouns", "me", "persons", "here", "there", "prepositions", "determiners",
    "quantifiers", "left", "right", "forward", "back",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Taught:
    """Words and what they mean."""

    words: str
    """As they are looked for, in small letters and without article."""
    means: str = ""
    """Words that are understood; empty where an action is meant."""
    action: str = ""
    arguments: Mapping[str, Value] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Of the memory that keeps it."""
        return taught_name(self.words)

    @property
    def meaning(self) -> str:
        """What it means, for people."""
        values = ", ".join(f"{name}: {value}" for name, value in self.arguments.items())
        return self.means or (f"{self.action} ({values})" if values else self.action)


def key(words: str) -> str:
    """Words as they are looked for: in small letters, without article and marks."""
    return _ARTICLE.sub(
        "", " ".join(token.low for token in tokenize(words) if token.low.strip("'") and token.is_word)
    )


def entry_of(taught: Taught, *, source: str, words: str) -> MemoryEntry:
    """The memory that keeps it.

    Args:
        taught: What is kept.
        source: Whose words it is.
        words: Those.
    """
    data = taught.means
    if taught.action:
        told = {"action": taught.action, "arguments": dict(taught.arguments)}
        data = json.dumps(told, ensure_ascii=False)
    return MemoryEntry(
        name=taught.name, data=data, info=taught.meaning, source=source, way="told", words=words[:2000]
    )


def taught_in(memory: Iterable[MemoryEntry]) -> tuple[Taught, ...]:
    """What of a memory was taught, the newest first; what is not to be redefined never counts."""
    found = {words: entry for entry in memory if (words := key(entry.taught)) and not reserved(words)}
    return tuple(one for words, entry in reversed(found.items()) if (one := _read(words, entry.data)))


def _read(words: str, data: str) -> Taught | None:
    """What is kept under these words; None if somebody made of it what nobody can read."""
    if not data.startswith("{"):
        return Taught(words, data.strip()) if data.strip() else None
    try:
        told: Any = json.loads(data)
        action, arguments = told["action"], told.get("arguments", {})
    except (ValueError, RecursionError, KeyError, TypeError):
        return None
    fine = isinstance(arguments, dict) and all(isinstance(value, Value) for value in arguments.values())
    return Taught(words, "", action, arguments) if isinstance(action, str) and fine else None


# -- what cannot be taught --


def reserved(words: str) -> Sentence | None:
    """Why these words cannot be given a meaning; None if they can."""
    said = [token.low for token in tokenize(words) if token.is_word]
    if not said or len(said) > _MOST_WORDS or len(words) > _MOST_CHARS:
        return sentence("A word or phrase that I am to learn has 1 to {most} words.", most=_MOST_WORDS)
    decides = control_of(words) or calls_to_stop(words) or is_no(words) or assent_of(words) is not None
    if decides or {*load_data("teaching")["ruling"]} & {*said}:
        return sentence(
            "“{words}” keeps its meaning: what stops me, says yes or no, or makes a rule cannot be given "
            "another.",
            words=words,
        )
    classes = lexicon().classes
    small = frozenset[str]().union(*(classes[name] for name in _SMALL))
    if all(word in small or word.isdigit() for word in said):
        return sentence("“{words}” stands in too many sentences to be given another meaning.", words=words)
    if question_of(plain(tokenize(words))) is not None:
        return sentence("“{words}” is a question that I answer already.", words=words)
    return None


# -- what it comes to --


def named(words: str, objects: Sequence[MapObject]) -> tuple[MapObject, ...]:
    """The things that are called just so."""
    said = stems(key(words).split())
    return tuple(
        item
        for item in objects
        if any(stems(key(name).split()) == said for name in (item.description, item.id, *item.aliases))
    )


def with_names(objects: Sequence[MapObject], taught: Sequence[Taught]) -> tuple[MapObject, ...]:
    """The things of a map, each with the names that people taught for it; its own name stays its own."""
    names: dict[str, tuple[str, ...]] = {}
    for one in taught:
        if one.means and not named(one.words, objects):
            for item in named(one.means, objects):
                names[item.id] = (*names.get(item.id, ()), one.words)
    return tuple(
        replace(item, aliases=(*item.aliases, *names[item.id])) if item.id in names else item
        for item in objects
    )


def meant(situation: Situation) -> Taught | None:
    """The sentence of somebody's own that a message is, word by word."""
    said = key(plain(tokenize(situation.message), (situation.robot,)))
    found = (one for one in taught_in(situation.memory) if key(plain(tokenize(one.words))) == said)
    return next((one for one in found if one.action or not named(one.means, situation.objects)), None)


def problem_of(taught: Taught, catalogue: Sequence[ActionInfo]) -> Sentence | None:
    """Why a robot with these actions cannot do what a sentence means; None if it can."""
    info = next((info for info in catalogue if info.name == taught.action), None)
    if info is None:
        return sentence("I have no action {action}.", action=taught.action)
    told = parameters_of(info)
    for name, value in taught.arguments.items():
        if name not in info.inputs:
            known = listed(sorted(info.inputs))
            return sentence(
                "{action} takes no {name}: it takes {known}.", action=info.name, name=name, known=known
            )
        kind, choices = info.inputs[name], told[name].choices
        if (kind in NATIVE_TYPES and not fits_type(kind, value)) or (choices and value not in choices):
            return sentence("{name} of {action} cannot be {value}.", action=info.name, name=name, value=value)
    missing = sorted({*info.inputs} - {*info.optional} - {*taught.arguments})
    return (
        sentence("{action} needs {missing}.", action=info.name, missing=listed(missing)) if missing else None
    )


def founded(answer: ChatAction, situation: Situation) -> ChatAction:
    """An answer with what was taught among its reasons, where it rests on that."""
    whole = meant(situation)
    said, taught = f" {key(situation.message)} ", taught_in(situation.memory)
    values = [
        item.value for call in (*answer.queue, *answer.offer) for item in call.input_parameters.values()
    ]
    given = {key(value) for value in values if isinstance(value, str)}
    used = [one.name for one in taught if f" {one.words} " in said and key(one.means) in given]
    used = [whole.name] if whole is not None and (answer.queue or answer.offer) else used
    return answer.model_copy(update={"sources": tuple(dict.fromkeys((*answer.sources, *used)))})


# -- teaching --


_LEADS: Final = re.compile(
    r"[\s,.!–-]*(?:(?:no|nope|oh|ok|okay|please|sorry|well|and|actually|look|listen|remember(?: that)?|ei|"
    r"palun)[\s,.!–-]+)*",
    re.IGNORECASE,
)
_LONGEST: Final = 300


@dataclass(frozen=True, slots=True)
class Learned:
    """What may be kept, and what it comes to."""

    taught: Taught
    steps: tuple[ActionCall, ...] = ()
    """What the robot would do; none where it is a name of a thing."""


def lesson_of(message: str, *, loose: bool = True) -> Taught | None:
    """What a person's message teaches, word for word; None if it teaches nothing.

    Args:
        message: What was said.
        loose: Whether what may as well be a fact counts.
    """
    if message.rstrip().endswith("?") or len(message) > _LONGEST:
        return None
    text = message[_LEADS.match(message).end() :].strip().rstrip(".!")  # type: ignore[union-attr]
    for shape in (*_shapes("shapes"), *(_shapes("loose") if loose else ())):
        found = shape.fullmatch(text)
        if found is None:
            continue
        given = found.groupdict()
        words = next(value for name, value in given.items() if name.startswith("words") and value)
        means = next(value for name, value in given.items() if name.startswith("means") and value)
        if key(words) and not {*load_data("teaching")["pointing"]} & {*key(words).split()}:
            return Taught(key(words), means.strip(" \"“”„'‘’"))
    return None


def asked_about(message: str) -> str | None:
    """The words whose meaning is asked for; empty for all that were taught, None if nothing is asked."""
    return _words_in(message, "asking")


def to_forget(message: str) -> str | None:
    """The words whose meaning is to be forgotten; None if nothing of the kind is wanted."""
    return _words_in(message, "forgetting")


def _words_in(message: str, kind: str) -> str | None:
    text = message[_LEADS.match(message).end() :].strip().rstrip(".!? ")  # type: ignore[union-attr]
    found = next((match for shape in _shapes(kind) if (match := shape.fullmatch(text))), None)
    return None if found is None else key(next((value for value in found.groups() if value), ""))


@cache
def _shapes(kind: str) -> tuple[re.Pattern[str], ...]:
    read: dict[str, Any] = load_data("teaching")
    return tuple(re.compile(_filled(line, read["parts"]), re.IGNORECASE) for line in read[kind].splitlines())


def _filled(shape: str, parts: dict[str, str]) -> str:
    """A shape with its parts written out; a name that stands twice is numbered."""
    text = re.sub(r"(?<!P)<(quoted|words|means|who)>", lambda found: parts[found[1]], shape)
    names = iter(range(9))
    return re.sub(r"\?P<(\w+)>", lambda found: f"?P<{found[1]}{next(names)}>", text)


async def weighed(
    taught: Taught, situation: Situation, language: Language, *, alike: Sequence[str] = ()
) -> Learned | Sentence:
    """Whether that may be taught: what it comes to, or why not.

    Args:
        taught: What is to be taught.
        situation: What is known; what was taught before stands in its memory.
        language: What understands.
        alike: Sentences that must mean afterwards what they mean now.
    """
    if (why := reserved(taught.words)) is not None:
        return why
    older = tuple(entry for entry in situation.memory if key(entry.taught) != taught.words)
    now = Situation(
        "", memory=older, objects=situation.objects, robot=situation.robot, robots=situation.robots,
        catalogue=situation.catalogue, robot_pose=situation.robot_pose, dialogue=Dialogue(),
    )  # fmt: skip
    return await _Weighing(now, language).of(taught, alike)


@dataclass(frozen=True, slots=True)
class _Weighing:
    situation: Situation
    language: Language

    async def of(self, taught: Taught, alike: Sequence[str]) -> Learned | Sentence:
        called = {key(name) for name in (self.situation.robot, *self.situation.robots)}
        if called & {taught.words, *taught.words.split()}:
            return sentence("“{words}” calls a robot, so it cannot mean anything else.", words=taught.words)
        if named(taught.words, self.situation.objects):
            return sentence("“{words}” is what something on my map is called already.", words=taught.words)
        if await self.steps(taught.words):
            return sentence("“{words}” means something to me already.", words=taught.words)
        if taught.action and (problem := problem_of(taught, self.situation.catalogue)) is not None:
            return problem
        thing = not taught.action and len(named(taught.means, self.situation.objects)) == 1
        steps = () if taught.action or thing else await self.steps(taught.means)
        weighing = self._sentence(taught, steps) if taught.action or steps else self._name(taught)
        learned = await weighing
        after = self._with(learned.taught) if isinstance(learned, Learned) else self
        for other in alike:
            if _shown(await self.steps(other)) != _shown(await after.steps(other)):
                return sentence("“{other}” would not mean any more what it means now.", other=other)
        return learned

    async def _sentence(self, taught: Taught, meant: Sequence[ActionCall]) -> Learned | Sentence:
        """For words that mean an order; with an action there is nothing that was said otherwise."""
        steps = await self._with(taught).steps(taught.words)
        if not steps or (meant and _shown(steps) != _shown(meant)):
            return sentence("I would not understand “{words}” when you say it.", words=taught.words)
        return Learned(taught, steps)

    async def _name(self, taught: Taught) -> Learned | Sentence:
        """For words that mean a thing."""
        things = await self._things(taught)
        if len(things) != 1:
            names = listed([item.description for item in things])
            return (
                sentence("“{means}” may be several things: {names}.", means=taught.means, names=names)
                if things
                else sentence(
                    "“{means}” is neither something on my map nor an order that I am certain of.",
                    means=taught.means,
                )
            )
        learned = Learned(replace(taught, means=things[0].description))
        tried = await self._with(learned.taught).steps(f"go to the {taught.words}")
        if _shown(tried) != _shown(await self.steps(f"go to the {learned.taught.means}")):
            return sentence("I would not understand “{words}” in an order.", words=taught.words)
        return learned

    def _with(self, taught: Taught) -> _Weighing:
        entry = entry_of(taught, source="", words="")
        return replace(self, situation=replace(self.situation, memory=(*self.situation.memory, entry)))

    async def _things(self, taught: Taught) -> tuple[MapObject, ...]:
        """What on the map may be meant."""
        objects = with_names(self.situation.objects, taught_in(self.situation.memory))
        words = key(taught.means)
        words = words.removesuffix("one") + taught.words if words.endswith(" one") else words
        found = await self.language.ground(words, objects, self.situation.robot_pose)
        return () if found.outcome == "none" else found.candidates

    async def steps(self, words: str) -> tuple[ActionCall, ...]:
        """What the robot would do at these words, where that is certain."""
        answer = await self.language.interpret(replace(self.situation, message=words))
        return answer.queue


def _shown(steps: Sequence[ActionCall]) -> list[tuple[str, dict[str, Any]]]:
    """What steps do, whatever their reasons."""
    return [
        (step.name, {name: item.value for name, item in step.input_parameters.items() if item.has_data})
        for step in steps
    ]
