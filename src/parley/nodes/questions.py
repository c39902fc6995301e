"""Open questions of robots: seen on `chat_interface_feedback`, settled by an answer or by `closes`."""

from __future__ import annotations

from parley.messages.chat import ChatFeedback, ChatInput

__all__ = ["OpenQuestions"]


class OpenQuestions:
    """Open questions per robot, oldest first."""

    def __init__(self) -> None:
        self._open: dict[str, list[ChatFeedback]] = {}

    def on_feedback(self, feedback: ChatFeedback) -> None:
        """Take over what robots say."""
        for target in feedback.targets:
            waiting = self._open.setdefault(_key(target), [])
            if feedback.closes:
                waiting[:] = [question for question in waiting if question.id != feedback.closes]
            if feedback.type == "request":
                waiting.append(feedback)

    def on_input(self, said: ChatInput) -> None:
        """Take over what the operator answers; the named question, or the oldest, is settled."""
        if said.type != "response":
            return
        for target in said.targets:
            waiting = self._open.get(_key(target), [])
            settled = next((q for q in waiting if said.reply_to in ("", q.id)), None)
            if settled is not None:
                waiting.remove(settled)

    def first(self, target: str) -> ChatFeedback | None:
        """The question of a robot that waits longest, or None."""
        waiting = self._open.get(_key(target))
        return waiting[0] if waiting else None


def _key(target: str) -> str:
    """Robots are found whatever the capitals."""
    return target.strip().casefold()
