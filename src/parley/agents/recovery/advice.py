"""What a language engine makes of a failed step, and how far that may go on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import structlog

from parley.agents.presence import Presence
from parley.agents.recovery.repair import Repair, failed_situation, memory_query
from parley.agents.shown_pictures import sent_pictures
from parley.agents.thinking import Thinking
from parley.errors import FailureCode, LanguageError
from parley.gate.control import control_of
from parley.gate.orders import Heard, admit_repair, engine, is_chosen
from parley.language.base import ErrorSituation, Language
from parley.memory.client import recall
from parley.messages.chat import ChatAction, ChatImage, ChatInput
from parley.messages.failure import ErrorHandlingMessage
from parley.transport.base import Transport
from parley.world.object_map import MapObject

__all__ = ["Advice", "plain_question"]

log = structlog.get_logger(__name__)


class Advice:
    """Asks the engine.

    Args:
        transport: Where memories are asked for.
        language: What understands.
        thinking: How long it may take.
        presence: Who is there.
        objects: The things a robot's map knows, by the robot's name.
    """

    def __init__(
        self,
        transport: Transport,
        language: Language,
        thinking: Thinking,
        presence: Presence,
        objects: Callable[[str], Sequence[MapObject]],
    ) -> None:
        self._transport, self._language, self._thinking = transport, language, thinking
        self._presence, self._objects = presence, objects

    async def on(
        self, repair: Repair, reply: str | None, images: Sequence[ChatImage], slow: Callable[[], None]
    ) -> ChatAction:
        """Ask the language engine; when it cannot answer, fall back to the failure's own sentence.

        Args:
            repair: Of the failure.
            reply: What the operator answered; None: they were not asked yet.
            images: What they showed with it.
            slow: Called if it takes long.
        """
        target = repair.failure.target
        if reply is None and repair.failure.code is FailureCode.FORBIDDEN:
            return plain_question(repair.failure)  # what people forbade is not worked around alone
        try:
            async with self._thinking.about(target, slow):
                return await self._language.resolve(await self._situation(repair, reply, images))
        except (LanguageError, TimeoutError) as error:
            log.warning("no resolution", target=target, error=repr(error))
            return plain_question(repair.failure)

    async def _situation(
        self, repair: Repair, reply: str | None, images: Sequence[ChatImage]
    ) -> ErrorSituation:
        failure = repair.failure
        status = self._presence.get(failure.target)
        found = await recall(self._transport, memory_query(failure, reply), scope=failure.target)
        # What a robot is to do about a failure counts only if a person said so.
        memory = [entry for entry in found if entry.way != "concluded"]
        objects = self._objects(failure.target)
        known = failed_situation(failure, memory=memory, objects=objects, status=status)
        return replace(
            known,
            dialogue=tuple(repair.dialogue),
            reply=reply,
            tried=tuple(repair.tried),
            pictures=await sent_pictures(images),
        )

    def admitted(self, repair: Repair, resolution: ChatAction, answer: ChatInput | None) -> ChatAction:
        """The answer of the engine as far as it may go on, and on whose account."""
        name, target = self._language.label, repair.failure.target
        words = answer.message if answer is not None else ""
        heard = Heard(
            words,
            answer.who if answer is not None else engine(name),
            target,
            engine=name,
            earlier=(repair.failure.error_message,),  # what "it" in an answer is
        )
        order = admit_repair(resolution.model_copy(update={"targets": (target,)}), heard)
        choices = repair.question.choices if repair.question is not None else ()
        if answer is None:
            return order
        chosen = is_chosen(repair.failure.action_called, resolution, words, choices)
        if chosen or self._goes_on(repair, resolution, words):
            return order.model_copy(update={"by": answer.who, "needs_yes": ""})
        return order

    def _goes_on(self, repair: Repair, resolution: ChatAction, words: str) -> bool:
        """Whether a person has seen what was found and says, read by code, to go on with what is agreed."""
        more = resolution.queue or resolution.system_cmd or resolution.afterwards
        seen = repair.failure.code is FailureCode.ATTENTION
        return seen and not more and control_of(words, self._presence.names()) == "start"


def plain_question(failure: ErrorHandlingMessage) -> ChatAction:
    """The failure's own sentence, for when nothing better is at hand."""
    return ChatAction(message_response=f"{failure.error_message} What should I do?", success=False)
