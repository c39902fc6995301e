"""What a system has to say by itself: kept until somebody is there to hear it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from parley.agents.base import Node
from parley.messages import topics
from parley.messages.chat import ChatFeedback
from parley.transport.base import Transport

__all__ = ["Notices"]


class Notices(Node):
    """Tells operators things nobody asked for; open it after everything else that listens to conversations.

    Whatever is told before a person's client has come is said as soon as one has.
    """

    name: ClassVar[str] = "notices"

    def __init__(self, transport: Transport) -> None:
        super().__init__(transport)
        self._waiting: list[ChatFeedback] = []
        self._nobody = 0
        """How many listeners there are that are no person."""
        self._heard = False

    async def open(self) -> None:
        """See `Node.open`."""
        self._nobody = self._listeners()
        self.opened.callback(self.transport.on_endpoints_changed(self._on_change))

    def tell(self, text: str, targets: Sequence[str], kind: Literal["info", "error"] = "info") -> None:
        """Say `text` on behalf of the robots `targets`."""
        self._waiting.append(ChatFeedback(message=self.spoken(text), targets=tuple(targets), type=kind))
        if self._heard:
            self._say()

    def _on_change(self) -> None:
        if not self._heard and self._listeners() > self._nobody:
            self._heard = True
            self._say()

    def _say(self) -> None:
        waiting, self._waiting = self._waiting, []
        for feedback in waiting:
            self.publish(topics.CHAT_FEEDBACK, feedback)

    def _listeners(self) -> int:
        name = topics.CHAT_FEEDBACK.name.lstrip("/")
        return sum(
            end.role == "subscription" and end.name.lstrip("/") == name for end in self.transport.endpoints()
        )
