"""Open questions of robots: seen on `chat_interface_feedback`, settled by an answer or by `closes`."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from parley.latest import KEPT, Latest
from parley.messages.chat import Aside, ChatFeedback, ChatInput

__all__ = ["LastAsked", "OpenQuestions", "SeenIds", "WrongAnswers"]

_KEPT_QUESTIONS: Final = 100
_ASIDE_WITHIN_S: Final = 60.0
"""So long after an answer its robot may still find that it is none."""


class SeenIds:
    """The last ids of messages, to recognise one that is sent twice, e.g. after a reconnect."""

    def __init__(self, kept: int = KEPT) -> None:
        self._ids: Latest[str, None] = Latest(kept)

    def __contains__(self, message_id: str) -> bool:
        return message_id in self._ids

    def is_new(self, message_id: str) -> bool:
        """Take over an id; whether it was not there yet. A message without an id is always new."""
        if not message_id:
            return True
        if message_id in self._ids:
            return False
        self._ids[message_id] = None
        return True


class OpenQuestions:
    """Open questions per robot, oldest first."""

    def __init__(self) -> None:
        self._open: Latest[str, list[ChatFeedback]] = Latest()
        self._names: Latest[str, str] = Latest()
        self._settled = SeenIds()

    def on_feedback(self, feedback: ChatFeedback) -> None:
        """Take over what robots say."""
        for target in feedback.targets:
            self._names[_key(target)] = target
            waiting = self._open[_key(target)] = self._open.get(_key(target), [])
            if feedback.closes:
                self._settled.is_new(feedback.closes)
                waiting[:] = [question for question in waiting if question.id != feedback.closes]
            if feedback.type == "request":
                waiting.append(feedback)
                del waiting[:-_KEPT_QUESTIONS]

    def on_input(self, said: ChatInput) -> None:
        """Take over what the operator answers; what it answers is settled."""
        for robot, question in self.answered(said):
            self._open[_key(robot)].remove(question)
            self._settled.is_new(question.id)

    def is_late(self, said: ChatInput) -> bool:
        """Whether `said` answers a question that is settled, by somebody else or otherwise."""
        if said.type != "response" or said.reply_to not in self._settled:
            return False
        return all(question.id != said.reply_to for waiting in self._open.values() for question in waiting)

    def answered(self, said: ChatInput) -> list[tuple[str, ChatFeedback]]:
        """Robots with the question of theirs that `said` answers.

        The named question counts first; then the robot that is called by name; then the robots that the
        message is for; last, if it is for nobody, the only one that waits. Of several questions of a robot
        the newest is meant.
        """
        if said.type != "response":
            return []
        keys = [_key(target) for target in said.targets]
        if said.reply_to:
            named = [
                (key, q) for key, waiting in self._open.items() for q in waiting if q.id == said.reply_to
            ]
            meant = [(key, q) for key, q in named if key in keys] or named
            return [(self._names[key], question) for key, question in meant]
        waits = [_key(robot) for robot in self.robots()]
        chosen = [key for key in waits if _calls(said.message, self._names[key])]
        if not chosen:
            chosen = [key for key in waits if key in keys] if keys else waits if len(waits) == 1 else []
        return [(self._names[key], self._open[key][-1]) for key in chosen]

    def newest(self, target: str) -> ChatFeedback | None:
        """The question of a robot that an answer is taken for: the one that was shown last, or None."""
        waiting = self._open.get(_key(target))
        return waiting[-1] if waiting else None

    def robots(self) -> list[str]:
        """The robots that wait for an answer."""
        return [self._names[key] for key, waiting in self._open.items() if waiting]


def _calls(message: str, name: str) -> bool:
    """Whether a message calls a robot: its name stands at the start, or behind a comma at the end."""
    called = re.escape(name.strip())
    return bool(re.search(rf"^\W*{called}\b|,\s*{called}\W*$", message, re.IGNORECASE))


def _key(target: str) -> str:
    """Robots are found whatever the capitals."""
    return target.strip().casefold()


class LastAsked:
    """The words of the last questions of robots."""

    def __init__(self) -> None:
        self._words: Latest[str, str] = Latest(_KEPT_QUESTIONS)

    def on_feedback(self, feedback: ChatFeedback) -> None:
        """A robot speaks, and may ask."""
        if feedback.type == "request" and feedback.id:
            self._words[feedback.id] = feedback.message

    def words(self, identity: str) -> str:
        """The question of that id; empty if it is too long ago or there is none."""
        return self._words.get(identity, "")


class WrongAnswers:
    """What people answered to robots, and what robots found to be no answer: both make a message of its own.

    Its words are those that a person was heard to say; each counts once, and not long after.

    Args:
        now_s: The wall's time.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self._answers: Latest[tuple[str, str], tuple[ChatInput, float]] = Latest(_KEPT_QUESTIONS)
        self._early: Latest[tuple[str, str], tuple[Aside, float]] = Latest(_KEPT_QUESTIONS)
        """What is told of before it is heard here, and when: a robot cannot have heard it long before."""

    def on_answer(self, said: ChatInput) -> list[ChatInput]:
        """A person answers; the messages that robots already took it for."""
        keys, now_s = [(_key(target), said.id or said.message) for target in said.targets], self._now_s()
        for key in keys:
            self._answers[key] = said, now_s
        told = [early for key in keys if (early := self._early.pop(key, None))]
        found = [self.on_aside(aside) for aside, at_s in told if now_s - at_s <= _ASIDE_WITHIN_S]
        return [made for made in found if made is not None]

    def on_aside(self, aside: Aside) -> ChatInput | None:
        """A robot found an answer to be none; the message that it is, if a person said so."""
        key = _key(aside.actor), aside.id or aside.message
        said, at_s = self._answers.pop(key, (None, 0.0))
        if said is None:
            self._early[key] = aside, self._now_s()
        if (
            said is None
            or said.reply_to not in ("", aside.reply_to)
            or self._now_s() - at_s > _ASIDE_WITHIN_S
        ):
            return None
        changes = {
            "type": "request",
            "targets": (aside.actor,),
            "id": aside.request_id,
            "reply_to": aside.reply_to,
        }
        return said.model_copy(update=changes)
