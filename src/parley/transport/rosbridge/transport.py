"""The rosbridge backend: subscribe, publish, call, serve and ask for long tasks over one websocket."""

from __future__ import annotations

import asyncio
import itertools
import uuid
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self, TypeVar

import structlog

from parley.errors import (
    TransportError,
    UnavailableError,
    UnsupportedError,
)
from parley.messages.actions import Action
from parley.messages.topics import Service, Topic
from parley.transport import remote
from parley.transport.base import Endpoint, absolute
from parley.transport.remote import RemoteTransport
from parley.transport.rosbridge.actions import RosbridgeActionClient
from parley.transport.rosbridge.ends import End, RosbridgePublisher, RosbridgeServerEnd, RosbridgeSubscription
from parley.transport.rosbridge.frames import Frame, text_of
from parley.transport.rosbridge.graph import Graph
from parley.transport.rosbridge.line import Line, Outbox
from parley.transport.rosbridge.values import Codec, Ros, spelt

__all__ = ["RosbridgeTransport"]

M = TypeVar("M")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")

PACE_MS: Final = {"sensor_msgs/msg/Image": 200, "sensor_msgs/msg/CompressedImage": 200}
"""By ROS type: how long a bridge waits between two messages; of those between, the newest counts."""
ROSAPI_S: Final = 2.0

log = structlog.get_logger(__name__)


class RosbridgeTransport(RemoteTransport[Graph]):
    """A robot's ROS from a machine without ROS: ``async with RosbridgeTransport("ws://192.168.1.5:9090"):``.

    A connection that is lost is opened again, and the bridge told of all ends once more; until then calls
    fail at once, messages are dropped, and nobody else is seen (`on_endpoints_changed`).

    Args:
        address: Of the bridge: `ws://host:port`, or `wss://...` for encryption.
        ros: Which generation of ROS is behind it.
        silence_s: A bridge that gives no sign of life for so long is taken for gone.
        look_s: How often the bridge is asked who is there; four times as often while not all is known.
        pace_ms: By ROS type, the shortest time between two of its messages.
        authority: Whose certificates are trusted, a file; None: those the machine trusts.
    """

    def __init__(
        self,
        address: str,
        *,
        ros: Ros = 2,
        silence_s: float = 4.0,
        look_s: float = 2.0,
        pace_ms: Mapping[str, int] = PACE_MS,
        authority: Path | None = None,
    ) -> None:
        super().__init__(Graph())
        self._ros, self._look_s, self._pace_ms = ros, look_s, dict(pace_ms)
        self._line = Line(
            address,
            silence_s=silence_s,
            authority=authority,
            on_frame=self._on_frame,
            on_up=self._on_up,
            on_down=self._on_down,
        )
        self._latched: dict[str, Any] = {}
        """The last message of latched topics: a bridge sends it once for all subscriptions of a client."""
        self._actions: list[RosbridgeActionClient[Any, Any, Any]] = []
        self._answers: dict[str, asyncio.Future[Any]] = {}
        self._numbers = itertools.count(1)

    async def __aenter__(self) -> Self:
        await self._line.open()
        self._looking = asyncio.create_task(self._look(), name="rosbridge look")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._looking.cancel()
        await asyncio.gather(self._looking, return_exceptions=True)
        for client in list(self._actions):
            await client.close()
        await self._close_ends()
        await self._end_tasks()
        self._fail_calls("this end was closed")
        await self._line.close()

    @property
    def connected(self) -> bool:
        """Whether the bridge is there."""
        return self._line.up

    @property
    def bad_frames(self) -> int:
        """How many frames came that could not be read."""
        return self._line.bad_frames

    def _make_codec(self, python_type: type[M], ros_type: str) -> Codec[M]:
        return Codec(python_type, ros_type, self._ros)

    def _open_publisher(
        self, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint
    ) -> RosbridgePublisher[M]:
        publisher = RosbridgePublisher(self, topic, codec, endpoint)
        self._opened(publisher)
        return publisher

    async def _open_subscription(
        self, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint, inbox: dict[str, Any],
        *, late: bool,
    ) -> RosbridgeSubscription[M]:  # fmt: skip
        subscription = RosbridgeSubscription(self, topic, codec, endpoint, inbox)
        is_first = not self.has(endpoint)
        self._opened(subscription, tell=is_first)
        if not is_first and topic.qos.latched and endpoint.name in self._latched:
            subscription.take(self._latched[endpoint.name])
        return subscription

    async def _open_server(
        self, service: Service[Any, Any], endpoint: Endpoint, answer: remote.Answer
    ) -> RosbridgeServerEnd:
        server = RosbridgeServerEnd(self, endpoint, answer)
        self._opened(server)
        return server

    async def _look_for(self, service: str) -> None:
        """The bridge says so itself: it may not tell who is there."""

    async def _request(self, service: Service[Any, Any], request: Frame, timeout_s: float) -> Any:
        id_ = f"call:{next(self._numbers)}"
        frame = {"op": "call_service", "id": id_, "service": absolute(service.name), "args": request}
        answer = await self.ask(id_, frame, f"service {service.name}")
        if answer.get("result") is not True:
            raise _refusal(service.name, answer.get("values"))
        return answer.get("values", {})

    async def action_client(
        self, action: Action[Goal, Result, Feedback]
    ) -> RosbridgeActionClient[Goal, Result, Feedback]:
        """See `Transport.action_client`."""
        if self._ros == 1:
            raise UnsupportedError(
                "ROS 1 has no actions of this kind; use the topics of its actionlib server"
            )
        client = RosbridgeActionClient(self, action)
        self._actions.append(client)
        await client.open()
        return client

    # What its ends ask of it

    def send(self, frame: Frame, outbox: Outbox | None = None) -> None:
        """Send soon."""
        self._line.send(frame, outbox)

    def spelt(self, ros_type: str) -> str:
        """A type's name as the bridge knows it."""
        return spelt(ros_type, self._ros)

    def pace(self, ros_type: str) -> Frame:
        """How often the bridge is to send messages of a type."""
        if ros_type not in self._pace_ms:
            return {}
        return {"throttle_rate": self._pace_ms[ros_type], "queue_length": 1}

    def codec(self, python_type: type[M], ros_type: str) -> remote.Codec[M]:
        """What writes and reads a type."""
        return self._codec(python_type, ros_type)

    def new_id(self, kind: str) -> str:
        """A name for one exchange, used by nobody else: a bridge knows goals of all its clients by these."""
        return f"{kind}:{uuid.uuid4().hex}"

    def may_serve(self, name: str) -> bool:
        """Whether somebody might answer this: also where the bridge does not tell who is there."""
        return not self._graph.known or self._graph.serves(name)

    async def ask(self, id_: str, frame: Frame, what: str) -> Frame:
        """Send a frame and wait for what comes back under its id; whoever calls this sets a limit.

        Raises:
            UnavailableError: There is no connection, or it was lost meanwhile.
        """
        if not self._line.up:
            raise UnavailableError(f"{what} cannot be asked: there is no connection to {self._line.address}")
        waiting: asyncio.Future[Frame] = asyncio.get_running_loop().create_future()
        self._answers[id_] = waiting
        self._line.send(frame)
        try:
            return await waiting
        except UnavailableError as error:
            raise UnavailableError(f"{what}: {error}") from None
        finally:
            del self._answers[id_]

    def has(self, endpoint: Endpoint) -> bool:
        """Whether an end of this process is open there."""
        return any(end.endpoint == endpoint for end in self._ends)

    def closed(self, end: End) -> None:
        """An end is closed."""
        self._ends.remove(end)
        self._graph.remove_own(end.endpoint)
        if isinstance(end, RosbridgeSubscription) and not self.has(end.endpoint):
            self._latched.pop(end.endpoint.name, None)

    def forget(self, client: RosbridgeActionClient[Any, Any, Any]) -> None:
        """An action client is closed."""
        if client in self._actions:
            self._actions.remove(client)

    # Inside

    def _opened(self, end: End, *, tell: bool = True) -> None:
        self._ends.append(end)
        self._graph.add_own(end.endpoint)
        if tell and self._line.up:
            end.tell()

    async def _look(self) -> None:
        while True:
            if self._line.up:
                # The types of these are named after another package in ROS 1.
                await self._graph.look(lambda service, request: self._call(service, request, ROSAPI_S))
            await asyncio.sleep(self._look_s if self._graph.is_settled else self._look_s / 4)

    def _on_up(self) -> None:
        told: set[Endpoint] = set()
        for end in self._ends:
            if end.endpoint not in told or isinstance(end, RosbridgePublisher):
                end.tell()
            told.add(end.endpoint)

    def _on_down(self) -> None:
        self._latched.clear()
        self._fail_calls("the connection to the bridge was lost")
        for client in self._actions:
            client.lost()
        self._graph.lost()

    def _fail_calls(self, why: str) -> None:
        for waiting in self._answers.values():
            if not waiting.done():
                waiting.set_exception(UnavailableError(why))

    def _on_frame(self, frame: Frame) -> None:
        match frame["op"]:
            case "publish":
                self._on_publish(text_of(frame, "topic"), frame.get("msg"))
            case "service_response" | "action_result":
                waiting = self._answers.get(str(frame.get("id")))
                if waiting is not None and not waiting.done():
                    waiting.set_result(frame)
            case "action_feedback":
                for client in self._actions:
                    client.on_feedback(frame)
            case "call_service":
                self._on_call(text_of(frame, "service"), frame)
            case "status":
                log.warning("the bridge complains", level=frame.get("level"), text=frame.get("msg"))
            case op:
                log.warning("the bridge sent what is not known here", op=op)

    def _on_publish(self, topic: str, value: Any) -> None:
        for end in [each for each in self._ends if isinstance(each, RosbridgeSubscription)]:
            if end.endpoint.name == absolute(topic):
                if end.latched:
                    self._latched[end.endpoint.name] = value
                end.take(value)

    def _on_call(self, service: str, frame: Frame) -> None:
        for end in self._ends:
            if isinstance(end, RosbridgeServerEnd) and end.endpoint.name == absolute(service):
                end.take(frame)
                return


def _refusal(name: str, told: Any) -> TransportError:
    """What became of a call that failed, by the bridge's words."""
    if told in (f"Service {absolute(name)} does not exist", f"Service {absolute(name)} was unadvertised"):
        return UnavailableError(f"nobody answers service {name}; is its node running? ({told})")
    return TransportError(f"service {name} failed: {told}")
