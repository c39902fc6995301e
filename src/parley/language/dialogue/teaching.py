"""Teaching a word or a sentence: what a message teaches, and whether it gives what it says."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Final

from parley.language.base import Language, Situation
from parley.language.dialogue.state import Dialogue
from parley.language.dialogue.taught import (
    Taught,
    entry_of,
    key,
    named,
    problem_of,
    reserved,
    taught_in,
    with_names,
)  # fmt: skip
from parley.language.lexicon import load_data
from parley.messages.chat import ActionCall
from parley.sentences import Sentence, listed, sentence
from parley.world.object_map import MapObject

__all__ = ["Learned", "asked_about", "lesson_of", "to_forget", "weighed"]

_LEADS: Final = re.compile(
    r"[\s,.!–-]*(?:(?:no|nope|oh|ok|okay|please|sorry|well|and|actually|look|listen|remember(?: that)?|ei|"
    r"palun)[\s,.!–-]+)*",
    re.IGNORECASE,
)
_MOST_CHARS: Final = 300


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
    if message.rstrip().endswith("?") or len(message) > _MOST_CHARS:
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
