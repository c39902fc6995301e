"""What a system has to say by itself: kept until somebody is there to hear it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Literal

from parley.agents.base import Node
from parley.messages import topics
from parley.messages.chat import ChatFeedback
from parley.messages.robot import Notice
from parley.messages.topics import Topic
from parley.transport.base import Endpoint, Transport, absolute

__all__ = ["Notices", "Notifier"]


def _listeners(transport: Transport, topic: Topic[Any]) -> list[Endpoint]:
    name = absolute(topic.name)
    return [end for end in transport.endpoints() if end.role == "subscription" and end.name == name]


class Notices(Node):
    """Tells operators things nobody asked for; open it after everything else that listens to conversations.

    Whatever is told before a person's client has come is said as soon as one has.
    """

    name: ClassVar[str] = "notices"

    def __init__(self, transport: Transport) -> None:
        super().__init__(transport)
        self._waiting: list[ChatFeedback] = []
        self._nobody = 0
        """How many listeners of this process are no person."""
        self._heard = False

    async def open(self) -> None:
        """See `Node.open`."""
        self._nobody = sum(not end.elsewhere for end in self._listeners())
        await self.subscribe(
            topics.NOTICE, Notice, lambda told: self.tell(told.message, told.targets, told.type)
        )
        self.opened.callback(self.transport.on_endpoints_changed(self._on_change))
        self._on_change()

    def tell(
        self,
        text: str,
        targets: Sequence[str],
        kind: Literal["info", "error"] = "info",
        *,
        asks_yes: bool = False,
    ) -> None:
        """Say `text` on behalf of the robots `targets`."""
        told = ChatFeedback(message=self.spoken(text), targets=tuple(targets), type=kind, asks_yes=asks_yes)
        self._waiting.append(told)
        if self._heard:
            self._say()

    def _on_change(self) -> None:
        ends = self._listeners()
        if not self._heard and (len(ends) > self._nobody or any(end.elsewhere for end in ends)):
            self._heard = True
            self._say()

    def _listeners(self) -> list[Endpoint]:
        return _listeners(self.transport, topics.CHAT_FEEDBACK)

    def _say(self) -> None:
        waiting, self._waiting = self._waiting, []
        for feedback in waiting:
            self.publish(topics.CHAT_FEEDBACK, feedback)


class Notifier(Node):
    """Hands what robots have to say by themselves to `Notices`, in whichever process and whenever that is."""

    name: ClassVar[str] = "notifier"

    def __init__(self, transport: Transport) -> None:
        super().__init__(transport)
        self._waiting: list[Notice] = []

    async def open(self) -> None:
        """See `Node.open`."""
        self.announce(topics.NOTICE)
        self.opened.callback(self.transport.on_endpoints_changed(self._say))

    def tell(self, text: str, targets: Sequence[str], kind: Literal["info", "error"] = "info") -> None:
        """Say `text` on behalf of the robots `targets`."""
        self._waiting.append(Notice(message=self.spoken(text), targets=tuple(targets), type=kind))
        self._say()

    def _say(self) -> None:
        if self._waiting and _listeners(self.transport, topics.NOTICE):
            waiting, self._waiting = self._waiting, []
            for notice in waiting:
                self.publish(topics.NOTICE, notice)
