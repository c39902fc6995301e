"""Robots that stand still for a word of stopping: while it is read, and on if it was a call to stop.

Whoever takes a message in may hold the robots before it gets here (the page's server does); the same id holds
nobody a second time. What was a call keeps a robot's drive still below its actions until a person lets it go
on, so that an action that knows no pause does not drive on either.
"""

from __future__ import annotations

import uuid
from collections.abc import Callable

from parley.gate.stop_words import has_stop_word
from parley.messages.chat import ChatInput
from parley.messages.status import ActorStatus, PlanUpdate, StopCommand

__all__ = ["Holds"]


class Holds:
    """Of one chat interface.

    Args:
        send: Publishes a command on `/parley/stop`.
    """

    def __init__(self, send: Callable[[StopCommand], None]) -> None:
        self._send = send
        self._kept: dict[str, tuple[tuple[str, ...], bool]] = {}
        """By robot: the ids of its holds, and whether its plan was seen to be held since."""
        self._met: set[str] = set()
        self._asked: dict[str, StopCommand] = {}
        """By open question: the hold until it is answered."""

    def begin(self, said: ChatInput, targets: tuple[str, ...], why: str = "") -> str:
        """Let robots stand while a message is read, if there is a word of stopping in it; its id, or none.

        `why` tells holds for one message apart.
        """
        if not has_stop_word(said.message):
            return ""
        identity = f"{said.id.partition('~')[0] or uuid.uuid4().hex}{why and f'/{why}'}"
        self._send(StopCommand(command="hold", targets=targets, id=identity, by=said.who, words=said.message))
        return identity

    def begin_for(self, question: str, said: ChatInput, targets: tuple[str, ...]) -> None:
        """Let robots stand until a question is answered."""
        command = StopCommand(command="hold", targets=targets, id=question, by=said.who, words=said.message)
        self._asked[question] = command
        self._send(command)

    def on_reset(self) -> None:
        """An emergency stop is released, and every hold with it: who waits for an answer stands on."""
        for command in self._asked.values():
            self._send(command)

    def end(self, identity: str) -> None:
        """The message is read, or the question answered."""
        self._asked.pop(identity, None)
        if identity:
            self._send(StopCommand(command="go_on", id=identity))

    def keep(self, target: str, said: ChatInput) -> None:
        """It was a call to stop: the robot stands until somebody lets it go on."""
        before, _ = self._kept.get(target, ((), False))
        identity = f"{said.id or uuid.uuid4().hex}/{target}"
        self._kept[target] = ((identity,), False)
        self._send(
            StopCommand(command="hold", targets=(target,), id=identity, by=said.who, words=said.message)
        )
        for other in before:  # only now: between two holds it would drive
            if other != identity:
                self.end(other)

    def on_status(self, status: ActorStatus) -> bool:
        """Take over what holds a robot when it is met: whoever held it may be gone, and would never end it.

        Returns:
            Whether it carries something out by that, which has to be paused: else nobody could let it go on.
        """
        if status.actor in self._met:
            return False
        self._met.add(status.actor)
        kept, seen = self._kept.get(status.actor, ((), False))
        left = tuple(one for one in status.holds if one not in kept and one not in self._asked)
        if left:
            self._kept[status.actor] = ((*kept, *left), seen)
        return bool(left) and status.state == "running"

    def on_update(self, update: PlanUpdate) -> None:
        """A plan changed: nobody holds it any more, or there is none."""
        ids, seen = self._kept.get(update.target, ((), False))
        if not ids:
            return
        if update.held_by is not None or update.state == "paused":
            self._kept[update.target] = (ids, True)
        elif seen or update.state in ("idle", "awaiting_approval"):
            del self._kept[update.target]
            for identity in ids:
                self.end(identity)
