"""What an action's context does over the transport: speak to the operator, show pictures, remember."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import io
import uuid
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Any, Final, Self

from PIL import Image

from parley.errors import InvalidMessageError
from parley.gate.table import Effect, verdict
from parley.latest import Latest
from parley.memory.client import recall
from parley.messages import topics
from parley.messages.chat import Aside, ChatFeedback, ChatImage, ChatInput
from parley.messages.display import DisplayFeed
from parley.messages.memory import AddToMemory, MemoryBody, MemoryEntry
from parley.messages.principal import Principal
from parley.messages.ros import String
from parley.messages.wire import decode, to_string
from parley.robots.base import CameraImage
from parley.transport.base import Publisher, Subscription, Transport

__all__ = ["JPEG_QUALITY", "ContextServices"]

JPEG_QUALITY: Final = 85
_KEPT_ANSWERS: Final = 8
_REPLY_WITHIN_S: Final = 40.0
"""Wall time; the chat interface itself gives up before."""


class ContextServices:
    """Implements `Operator`, `Display` and `MemoryAccess` of `parley.actions.context` for one actor."""

    def __init__(self, actor: str, transport: Transport) -> None:
        self._actor, self._transport = actor, transport
        self._questions: OrderedDict[str, asyncio.Future[ChatInput]] = OrderedDict()
        self._answers: Latest[str, ChatInput] = Latest(_KEPT_ANSWERS)
        """The last answers by their words, each naming its question, in case it turns out to be none."""
        self._publishers: dict[str, Publisher[String]] = {}
        self._subscription: Subscription | None = None

    async def __aenter__(self) -> Self:
        for topic in (topics.CHAT_FEEDBACK, topics.ASIDE, topics.DISPLAY_FEED, topics.ADD_TO_MEMORY):
            self._publishers[topic.name] = self._transport.publisher(topic)
        self._subscription = await self._transport.subscribe(topics.CHAT_INPUT, self._on_chat_input)
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._subscription is not None:
            await self._subscription.close()
        for answer in self._questions.values():
            answer.cancel()
        for publisher in self._publishers.values():
            publisher.close()

    # -- Operator --------------------------------------------------------------------------------------

    def tell(self, text: str, picture: CameraImage | None = None) -> None:
        """See `Operator.tell`."""
        images = () if picture is None else (ChatImage(data=_jpeg(picture)),)
        self._feedback(
            ChatFeedback(message=text, targets=(self._actor,), type="info", by_step=True, images=images)
        )

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        """See `Operator.ask`."""
        question_id = uuid.uuid4().hex
        answer: asyncio.Future[ChatInput] = asyncio.get_running_loop().create_future()
        self._questions[question_id] = answer
        self._feedback(
            ChatFeedback(
                message=question,
                targets=(self._actor,),
                type="request",
                choices=tuple(choices),
                id=question_id,
            )
        )
        try:
            said = await answer
        except asyncio.CancelledError:
            self._feedback(
                ChatFeedback(
                    message="You need not answer my question any more.",
                    targets=(self._actor,),
                    type="info",
                    closes=question_id,
                )
            )
            raise
        finally:
            del self._questions[question_id]
        self._answers[said.message] = said.model_copy(update={"reply_to": question_id})
        return said.message

    async def refer(self, reply: str) -> None:
        """See `Operator.refer`."""
        said = self._answers.get(reply)
        if said is None:
            return  # nobody said so
        aside = Aside(actor=self._actor, reply_to=said.reply_to, id=said.id, message=reply)
        replied = asyncio.Event()

        def hear(message: String) -> None:
            try:
                feedback = decode(ChatFeedback, message.data)
            except InvalidMessageError:
                return  # whoever shows it to people refuses it
            if feedback.reply_to == aside.request_id and feedback.type in ("response", "error"):
                replied.set()

        subscription = await self._transport.subscribe(topics.CHAT_FEEDBACK, hear)
        try:
            self._publishers[topics.ASIDE.name].publish(to_string(aside))
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(_REPLY_WITHIN_S):
                    await replied.wait()
        finally:
            await subscription.close()

    def _on_chat_input(self, message: String) -> None:
        """Hand an answer to the question it answers: the named one, or the one that waits longest."""
        try:
            said = decode(ChatInput, message.data)
        except InvalidMessageError:
            return  # the chat interface refuses it and tells the sender
        if verdict(said.who, Effect.ANSWER) != "allow":
            return  # whoever says so to people is the chat interface
        names = {name.strip().casefold() for name in said.targets}
        if said.type != "response" or self._actor.casefold() not in names:
            return
        if said.id and any(said.id == answer.id for answer in self._answers.values()):
            return  # sent twice: it was for the question before
        for question_id, answer in self._questions.items():
            if not answer.done() and said.reply_to in ("", question_id):
                answer.set_result(said)
                return

    def _feedback(self, feedback: ChatFeedback) -> None:
        self._publishers[topics.CHAT_FEEDBACK.name].publish(to_string(feedback))

    # -- Display ---------------------------------------------------------------------------------------

    def show(self, feed: str, image: CameraImage, info: Mapping[str, Any] | None = None) -> None:
        """See `Display.show`."""
        message = DisplayFeed(target=self._actor, name=feed, image=_jpeg(image), info=dict(info or {}))
        self._publishers[topics.DISPLAY_FEED.name].publish(to_string(message))

    # -- Memory ----------------------------------------------------------------------------------------

    async def find(self, request: str) -> list[MemoryEntry]:
        """See `MemoryAccess.find`; empty when the memory does not answer."""
        return list(await recall(self._transport, request, scope=self._actor, pictures=True))

    def add(self, entry: MemoryEntry) -> None:
        """See `MemoryAccess.add`."""
        body = MemoryBody(
            type=entry.type,
            data=entry.data,
            info=entry.info,
            scope=entry.scope,
            source=entry.source or self._actor,
            way=entry.way or "seen",
            by=Principal(kind="robot", name=self._actor),
        )
        self._publishers[topics.ADD_TO_MEMORY.name].publish(to_string(AddToMemory({entry.name: body})))


def _jpeg(image: CameraImage) -> str:
    """Base64 of a picture."""
    buffer = io.BytesIO()
    Image.fromarray(image.data).save(buffer, format="JPEG", quality=JPEG_QUALITY)
    return base64.b64encode(buffer.getvalue()).decode("ascii")
