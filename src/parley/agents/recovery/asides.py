"""What is said in the middle of a repair and settled elsewhere; then the repair asks again. Pure."""

from __future__ import annotations

import uuid

from parley.agents.questions import OpenQuestions
from parley.latest import Latest
from parley.messages.chat import ChatFeedback, ChatInput

__all__ = ["Asides"]


class Asides:
    """At most one of each robot: what it waits for is a reply, or the answer to a question of that reply."""

    def __init__(self) -> None:
        self._awaited: Latest[str, str] = Latest()
        """Id of a message that is to be replied to, or of a question that is to be answered, by robot."""

    def begin(self, said: ChatInput, target: str, question_id: str) -> ChatInput:
        """The message as a request of its own, understood like any other; the question it came after."""
        identity = f"{said.id or uuid.uuid4().hex}~{target}"
        self._awaited[target] = identity
        return said.model_copy(
            update={"type": "request", "targets": (target,), "id": identity, "reply_to": question_id}
        )

    def on_input(self, said: ChatInput, questions: OpenQuestions) -> None:
        """Somebody answers; called before `questions` takes the answer over."""
        for target, question in questions.answered(said):
            if said.id and self._awaited.get(target) == question.id:
                self._awaited[target] = said.id

    def on_feedback(self, feedback: ChatFeedback) -> list[str]:
        """The robots whose own questions are to be put again now."""
        settled: list[str] = []
        for target in feedback.targets:
            awaited = self._awaited.get(target)
            replies = feedback.type != "info" and feedback.reply_to == awaited
            if not awaited or not (replies or feedback.closes == awaited):
                continue
            if feedback.type == "request" and feedback.id:
                self._awaited[target] = feedback.id
            else:
                del self._awaited[target]
                settled.append(target)
        return settled
