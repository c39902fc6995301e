"""Local first: the built-in engine where it is certain, a model for what it would ask about or decline.

Both see the same situation, so there is one conversation. Who answered stands in each answer. What could do
harm is put to both; where they disagree, the person is asked.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final, Protocol

from parley.gate.risk import always_asks
from parley.language.base import (
    DraftHandler,
    ErrorSituation,
    Grounding,
    InspectionReport,
    Language,
    ReplyReading,
    Situation,
)
from parley.language.llm.chain import signed
from parley.language.llm.naming import chosen, named
from parley.language.llm.opened import Opened
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage
from parley.sentences import sentence
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = ["AutoLanguage", "SaysWhenCertain"]

_ARTICLE: Final = re.compile(r"^(?:the|a|an)\s+")


class SaysWhenCertain(Language, Protocol):
    """A language engine that knows when it has understood."""

    def certain(self, situation: Situation) -> ChatAction | None:
        """What a message asks for; None where it would ask, decline or guess."""
        ...


class AutoLanguage(Opened):
    """Two engines as one. Use as ``async with``.

    Args:
        local: Asked first; costs nothing.
        rest: Asked for the rest, and says who answers if it is several.
    """

    def __init__(self, local: SaysWhenCertain, rest: Language) -> None:
        super().__init__((local, rest))
        self._local, self._rest = local, rest

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return f"{self._local.label}; for what it is not certain of: {self._rest.label.partition(';')[0]}"

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return self._rest.sees_pictures

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`."""
        sure = self._local.certain(situation)
        if sure is not None and _is_urgent(sure):
            return signed(sure, self._local)
        sure = None if _is_beyond(situation) else sure
        weighty = sure is not None and _is_weighty(sure, situation)
        if sure is not None and not weighty:
            return signed(sure, self._local)
        answer = await self._rest.interpret(situation, on_draft=None if weighty else on_draft)
        if sure is None or not _does(answer):  # a question is better than a deed that one is not sure of
            return signed(answer, self._rest)
        return signed(sure, self._local) if _agree(sure, answer, situation.objects) else _which(sure, answer)

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`; a choice that was offered is taken as it is."""
        if situation.reply is not None and not situation.pictures and _is_candidate(situation):
            return signed(await self._local.resolve(situation), self._local)
        return signed(await self._rest.resolve(situation), self._rest)

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`."""
        return await self._rest.select_memories(query, index)

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """See `Language.ground`."""
        return named(description, objects) or await self._rest.ground(description, objects, pose)

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> InspectionReport:
        """See `Language.inspect`."""
        eyes = self._rest if self._rest.sees_pictures else self._local
        return await eyes.inspect(image, request, rules, known)

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """See `Language.read_reply`; a choice that is given word for word needs no model."""
        if (choice := chosen(reply, choices)) is not None:
            return ReplyReading("choice", choice)
        return await self._rest.read_reply(question, reply, choices)


def _is_beyond(situation: Situation) -> bool:
    """Whether a message is about more than the local engine looks at: a failure, a question, a picture."""
    sent = any(picture.sent for picture in situation.pictures)
    return situation.failure is not None or bool(situation.question) or sent


def _is_urgent(answer: ChatAction) -> bool:
    """Whether a robot is to stand still, or somebody is in danger: that waits for no model."""
    return answer.alarm or any(command.command in ("stop", "pause") for command in answer.system_cmd)


def _is_weighty(answer: ChatAction, situation: Situation) -> bool:
    """Whether steps do more than look and move: two understand it alike, or a person is asked."""
    infos = {info.name: info for info in situation.catalogue}
    return any(always_asks(infos.get(call.name)) for call in answer.queue)


def _does(answer: ChatAction) -> bool:
    """Whether something would be done or changed."""
    return bool(answer.queue or answer.system_cmd or answer.others)


def _agree(first: ChatAction, second: ChatAction, objects: Sequence[MapObject]) -> bool:
    """Whether both would do the same; what they say about it does not count."""
    return _deeds(first, objects) == _deeds(second, objects)


def _deeds(answer: ChatAction, objects: Sequence[MapObject]) -> object:
    steps = [(call.name, _arguments(call, objects), call.flow) for call in answer.queue]
    commands = [command.command for command in answer.system_cmd if command.command != "add_memory"]
    return steps, commands, [_deeds(other, objects) for other in answer.others]


def _arguments(call: ActionCall, objects: Sequence[MapObject]) -> Mapping[str, object]:
    return {
        name: _meant(item.value, objects) for name, item in call.input_parameters.items() if item.has_data
    }


def _meant(value: object, objects: Sequence[MapObject]) -> object:
    """The things that words name, or the words without what does not matter; numbers as they are."""
    if not isinstance(value, str):
        return value
    found = named(value, objects)
    return _plain(value) if found is None else tuple(sorted(thing.id for thing in found.candidates))


def _which(first: ChatAction, second: ChatAction) -> ChatAction:
    """Ask which of two readings is meant; nothing is done yet."""
    ways = (_in_words(first), _in_words(second))
    if ways[0] == ways[1] or not all(ways):  # their words do not tell them apart
        return ChatAction(
            message_response=sentence("I am not sure what you mean. Please say it another way.")
        )
    asked = sentence(
        "I read that in two ways: {first}, or {second}. Which one do you mean?", first=ways[0], second=ways[1]
    )
    return ChatAction(message_response=asked, choices=ways, engine="both")


def _in_words(answer: ChatAction) -> str:
    told = [call.reason for call in answer.queue if call.reason]
    return ", then ".join(dict.fromkeys(told)) or answer.message_response


def _is_candidate(situation: ErrorSituation) -> bool:
    """Whether the reply names one of the candidates in just its words."""
    listed = situation.details.get("candidates")
    items = [item for item in listed if isinstance(item, dict)] if isinstance(listed, list) else []
    return chosen(situation.reply or "", [str(item.get("description")) for item in items]) is not None


def _plain(text: str) -> str:
    return _ARTICLE.sub("", text.casefold().strip(" .,!?“”\"'"))
