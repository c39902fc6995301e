"""An answer that names no robot while several wait: kept until the operator says for whom it is."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence

from parley.messages.chat import ChatFeedback, ChatInput
from parley.sentences import sentence

__all__ = ["WhichRobot"]


class WhichRobot:
    """At most one answer waits for its addressee; a newer one takes its place."""

    def __init__(self) -> None:
        self._answer: ChatInput | None = None
        self._question_id = ""

    @staticmethod
    def needed(said: ChatInput, waiting: Sequence[str]) -> bool:
        """Whether nobody can tell which of the robots that wait is meant."""
        return said.type == "response" and not said.targets and not said.reply_to and len(waiting) > 1

    def ask(
        self, said: ChatInput, waiting: Sequence[str], question_id: str, spoken: Callable[[str], str] = str
    ) -> ChatFeedback:
        """Keep the answer; the question to put, as `spoken` says it."""
        self._answer, self._question_id = said, question_id
        names = f"{', '.join(waiting[:-1])} or {waiting[-1]}"
        text = sentence("Which robot do you mean, {names}?", names=names)
        return ChatFeedback(message=spoken(text), type="request", choices=tuple(waiting), id=question_id)

    def addressed(self, said: ChatInput, waiting: Sequence[str]) -> ChatInput | None:
        """The kept answer with its robot, if `said` only names one; it is kept no longer in any case."""
        answer = self._answer
        if answer is None:
            return None
        words = said.message.casefold().strip(" .!,")
        robot = next((name for name in waiting if words in _ways_to_name(name)), None)
        self._answer = None
        if robot is None:
            return None
        return answer.model_copy(update={"targets": (robot,), "id": uuid.uuid4().hex})


def _ways_to_name(robot: str) -> frozenset[str]:
    name = robot.strip().casefold()
    return frozenset({name, *(f"{lead} {name}" for lead in ("for", "to", "i mean", "i meant", "it is for"))})
