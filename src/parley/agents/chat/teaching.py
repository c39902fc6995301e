"""Words and sentences of people's own, taught in the chat: a person says what they mean, and it is kept.

Wiring only; what a message teaches and whether it may is read in `parley.language.dialogue.teaching`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final

from parley.agents.base import Node
from parley.agents.chat.situations import Situations
from parley.agents.planner.asking import counted
from parley.agents.planner.check import complete_calls
from parley.errors import LanguageError
from parley.gate.cards import labels_of, lines_of
from parley.gate.table import Effect, verdict
from parley.language.base import Language, Situation
from parley.language.dialogue.teaching import (
    Learned,
    Taught,
    asked_about,
    entry_of,
    lesson_of,
    taught_in,
    to_forget,
    weighed,
)
from parley.memory.because import OPERATOR
from parley.memory.client import recall
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.memory import MemoryEntry, RemoveMemory
from parley.messages.principal import Principal
from parley.sentences import Sentence, listed, sentence

__all__ = ["Teaching"]

_WITHIN_S: Final = 60.0
"""Wall time in which it must be known whether what is taught is understood."""
_ONLY_PEOPLE: Final = "Only people teach me what words mean."
_NOTHING: Final = "Nobody has taught me words of their own yet."
_NO_ANSWER: Final = (
    "I could not find out whether I understand that, so I did not learn it. Please say it again later."
)


class Teaching:
    """Helper of one chat interface.

    Args:
        node: Through whom it speaks.
        language: What understands.
        known: What is known of each robot.
        remember: Stores a memory and waits until it is durable; returns the plain reason if it is not.
    """

    def __init__(
        self,
        node: Node,
        language: Language,
        known: Situations,
        remember: Callable[[MemoryEntry, Principal], Awaitable[str]],
    ) -> None:
        self._node, self._language, self._known, self._remember = node, language, known, remember

    async def handles(self, target: str, said: ChatInput) -> str | None:
        """Learn, forget or tell what words mean.

        Returns:
            None if a message is not about that; else the order that was asked about before, if it is certain
            by what was taught, or an empty text.
        """
        lesson = lesson_of(said.message)
        if lesson is None:
            return "" if await self._about_taught(target, said) else None
        return await self._learn(lesson, target, said)

    async def _about_taught(self, target: str, said: ChatInput) -> bool:
        """Tell or forget what was taught; what nobody taught is left to whoever knows of words."""
        asked, lost = asked_about(said.message), to_forget(said.message)
        if asked is None and lost is None:
            return False
        known = taught_in(await recall(self._node.transport, said.message, scope=target))
        if asked == "":
            told = listed([f"“{one.words}”" for one in known])
            text = sentence("I was taught: {words}.", words=told) if known else _NOTHING
            self._tell(target, said, text)
            return True
        found = next((one for one in known if one.words == (asked or lost)), None)
        if found is None:
            return False
        if asked:
            text = sentence("“{words}” means “{means}”.", words=found.words, means=found.meaning)
        else:
            if verdict(said.who, Effect.FORGET) != "allow":
                self._tell(target, said, _ONLY_PEOPLE, "error")
                return True
            self._node.publish(topics.REMOVE_MEMORY, RemoveMemory.of(found.name, said.who))
            text = sentence("I have forgotten what “{words}” means.", words=found.words)
        self._tell(target, said, text)
        return True

    async def _learn(self, lesson: Taught, target: str, said: ChatInput) -> str | None:
        if not said.who.is_person or verdict(said.who, Effect.REMEMBER) != "allow":
            self._tell(target, said, _ONLY_PEOPLE, "error")
            return ""
        try:
            async with asyncio.timeout(_WITHIN_S):
                situation = await self._known.of(target, said.message, said, sees_pictures=False)
                found = await weighed(lesson, situation, self._language)
        except (LanguageError, TimeoutError) as error:
            self._node.log.warning("not learned", target=target, error=repr(error))
            self._tell(target, said, _NO_ANSWER, "error")
            return ""
        if isinstance(found, Sentence) and lesson_of(said.message, loose=False) is None:
            return None  # a fact, perhaps
        if isinstance(found, Sentence):
            self._tell(target, said, sentence("I did not learn that. {why}", why=found))
            return ""
        entry = entry_of(found.taught, source=said.author or OPERATOR, words=said.message)
        if problem := await self._remember(entry, said.who):
            self._tell(target, said, problem, "error")
            return ""
        asked = situation.dialogue.asked
        self._tell(target, said, _learned(found, situation))
        answers = asked is not None and not found.steps and found.taught.means in asked.choices
        return asked.words if asked is not None and answers else ""

    def _tell(self, target: str, said: ChatInput, text: str, kind: str = "response") -> None:
        self._known.note(target, said.message, text)
        feedback = ChatFeedback.model_validate(
            {
                "message": self._node.spoken(text),
                "targets": (target,),
                "type": kind,
                "reply_to": said.id,
            }
        )
        self._node.publish(topics.CHAT_FEEDBACK, feedback)


def _learned(found: Learned, situation: Situation) -> Sentence:
    """What will be understood from now on."""
    taught: Taught = found.taught
    if not found.steps:
        return sentence("I will remember: “{words}” is the {thing}.", words=taught.words, thing=taught.means)
    calls = complete_calls(found.steps, situation.catalogue)
    labels = labels_of(calls, situation.catalogue, situation.objects)
    steps = counted(lines_of(calls, labels, situation.catalogue))
    return sentence("I will remember what “{words}” means: {steps}.", words=taught.words, steps=steps)
