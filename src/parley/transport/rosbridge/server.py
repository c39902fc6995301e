"""A small rosbridge server with no ROS behind it: clients of it see each other in the node of the bridge.

It speaks the protocol of rosbridge_suite 2.x and answers what `rosapi` answers, so that programs and tests
run without a robot. Messages are passed on as they come: whether they fit their types, their ends find out.
"""

from __future__ import annotations

import asyncio
import base64
import errno
import itertools
import uuid
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Any, Final, Self

import structlog
from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from parley.errors import InvalidMessageError, TransportError
from parley.messages.actions import GoalState
from parley.transport.rosbridge.actions import REFUSED
from parley.transport.rosbridge.census import BRIDGE
from parley.transport.rosbridge.frames import MAX_BYTES, Frame, read_frame, text_of, write_frame
from parley.transport.rosbridge.throttle import Throttle
from parley.transport.rosbridge.values import Ros

__all__ = ["RosbridgeServer"]

WAITING: Final = 10_000
"""So many frames wait for a client that takes too little; then its connection is closed."""

ROSAPI: Final = "/rosapi"
"""The node that tells who is there."""

_DEAD: Final = "rosapi ended: it was asked about a node that is not there, as that of ROS 2 does"

log = structlog.get_logger(__name__)


class _RefusedError(Exception):
    """A call or goal that comes to nothing; the text is told."""


class _Client:
    """One connection: what it publishes, hears and answers."""

    def __init__(self, connection: ServerConnection, name: str) -> None:
        self.connection, self.name = connection, name
        self.publishes: dict[str, str] = {}
        self.hears: dict[str, tuple[str, Throttle]] = {}
        self.answers: dict[str, str] = {}
        self.goals: dict[str, tuple[str, str]] = {}
        """Id at the client -> name of the action, and the goal's id there."""
        self.tasks: set[asyncio.Task[None]] = set()
        self._out: asyncio.Queue[Frame] = asyncio.Queue(WAITING)

    def send(self, frame: Frame) -> None:
        try:
            self._out.put_nowait(frame)
        except asyncio.QueueFull:
            log.warning("a client takes too little; it is let go", client=self.name)
            self.start(self.connection.close(1008, "takes too little"))

    def start(self, work: Any) -> None:
        task = asyncio.ensure_future(work)
        self.tasks.add(task)
        task.add_done_callback(self.tasks.discard)

    async def write(self) -> None:
        try:
            while True:
                await self.connection.send(write_frame(await self._out.get()))
        except ConnectionClosed:
            log.debug("a client went", client=self.name)


class RosbridgeServer:
    """See the module. ``async with RosbridgeServer() as bridge: ... bridge.address``.

    Args:
        port: Where it listens, on this machine; 0: any free one.
        host: The address of this machine that it listens on.
        ros: Whose spelling of types it has.
    """

    def __init__(self, port: int = 0, host: str = "127.0.0.1", ros: Ros = 2) -> None:
        self._host, self._port = host, port
        self._clients: list[_Client] = []
        self._latched: dict[str, Any] = {}
        self._calls: dict[str, tuple[_Client, str, asyncio.Future[Any]]] = {}
        self._ears: dict[str, tuple[str, Callable[[Any], None]]] = {}
        """Of each goal: where its feedback comes, and who passes it on."""
        self._numbers = itertools.count(1)
        self._operations: dict[str, Callable[[_Client, Frame], None]] = {
            "advertise": self._advertise,
            "unadvertise": lambda client, frame: self._unadvertise(client, text_of(frame, "topic")),
            "publish": self._publish,
            "subscribe": self._subscribe,
            "unsubscribe": lambda client, frame: self._unsubscribe(client, text_of(frame, "topic")),
            "advertise_service": self._advertise_service,
            "unadvertise_service": lambda client, frame: self._unserve(client, text_of(frame, "service")),
            "call_service": lambda client, frame: client.start(self._call_service(client, frame)),
            "service_response": self._service_response,
            "send_action_goal": lambda client, frame: client.start(self._send_goal(client, frame)),
            "cancel_action_goal": lambda client, frame: client.start(self._cancel_goal(client, frame)),
        }
        package = "rosapi_msgs/srv" if ros == 2 else "rosapi"
        self._rosapi: dict[str, tuple[str, Callable[[Any], Frame]]] = {
            "/rosapi/topics": (f"{package}/Topics", self._topics),
            "/rosapi/services": (f"{package}/Services", self._services),
            "/rosapi/nodes": (f"{package}/Nodes", self._nodes),
            "/rosapi/node_details": (f"{package}/NodeDetails", self._node_details),
            "/rosapi/publishers": (
                f"{package}/Publishers",
                lambda args: {"publishers": self._holders(args, lambda client: client.publishes)},
            ),
            "/rosapi/subscribers": (
                f"{package}/Subscribers",
                lambda args: {"subscribers": self._holders(args, lambda client: client.hears)},
            ),
            "/rosapi/service_node": (f"{package}/ServiceNode", self._service_node),
            "/rosapi/service_type": (f"{package}/ServiceType", self._service_type),
            "/rosapi/action_servers": (f"{package}/GetActionServers", self._action_servers),
        }

    async def __aenter__(self) -> Self:
        at = self._host, self._port
        try:
            self._server: Server = await serve(
                self._on_client, *at, compression=None, max_size=MAX_BYTES, close_timeout=1.0
            )
        except OSError as error:
            why = "something else is there" if error.errno == errno.EADDRINUSE else error.strerror or error
            raise TransportError(f"cannot listen on {at[0]} port {at[1]}: {why}") from error
        self._port = next(iter(self._server.sockets)).getsockname()[1]
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.close()
        await self._server.wait_closed()

    @property
    def address(self) -> str:
        """Where clients connect."""
        return f"ws://{self._host}:{self._port}"

    async def _on_client(self, connection: ServerConnection) -> None:
        client = _Client(connection, f"/client_{next(self._numbers)}")
        self._clients.append(client)
        client.start(client.write())
        try:
            async for text in connection:
                self._take(client, text)
        except ConnectionClosed as closed:
            log.debug("a client went", client=client.name, why=str(closed))
        finally:
            self._clients.remove(client)
            for topic in list(client.publishes):
                self._unadvertise(client, topic)
            for service in list(client.answers):
                self._unserve(client, service)
            for task in client.tasks:
                task.cancel()
            await asyncio.gather(*client.tasks, return_exceptions=True)

    def _take(self, client: _Client, text: str | bytes) -> None:
        try:
            frame = read_frame(text)
            operation = self._operations.get(frame["op"])
            if operation is None:
                raise InvalidMessageError("rosbridge frame", "op", f"there is no operation {frame['op']!r}")
            operation(client, frame)
        except InvalidMessageError as error:
            log.warning("a client sent what cannot be read", client=client.name, why=str(error))
            client.send({"op": "status", "level": "error", "msg": str(error)})

    # Topics

    def _type_of(self, topic: str) -> str | None:
        for client in self._clients:
            if topic in client.publishes:
                return client.publishes[topic]
            if topic in client.hears:
                return client.hears[topic][0]
        return None

    def _check_type(self, topic: str, ros_type: str) -> None:
        known = self._type_of(topic)
        if known not in (None, ros_type):
            raise InvalidMessageError("rosbridge topic", topic, f"it has the type {known}, not {ros_type}")

    def _advertise(self, client: _Client, frame: Frame) -> None:
        topic, ros_type = text_of(frame, "topic"), text_of(frame, "type")
        self._check_type(topic, ros_type)
        client.publishes[topic] = ros_type

    def _unadvertise(self, client: _Client, topic: str) -> None:
        client.publishes.pop(topic, None)
        if not any(topic in each.publishes for each in self._clients):
            self._latched.pop(topic, None)

    def _publish(self, client: _Client, frame: Frame) -> None:
        topic, message = text_of(frame, "topic"), frame.get("msg", {})
        if topic not in client.publishes:
            known = self._type_of(topic)
            if known is None:
                raise InvalidMessageError(
                    "rosbridge publish", topic, "the topic is not advertised, its type unknown"
                )
            client.publishes[topic] = known
        if frame.get("latch"):
            self._latched[topic] = message
        for each in self._clients:
            if topic in each.hears:
                each.hears[topic][1].put(message)
        for heard, tell in list(self._ears.values()):
            if heard == topic:
                tell(message)

    def _subscribe(self, client: _Client, frame: Frame) -> None:
        topic = text_of(frame, "topic")
        ros_type = frame.get("type") or self._type_of(topic)
        if not isinstance(ros_type, str):
            raise InvalidMessageError(
                "rosbridge subscribe", topic, "nobody publishes it, and no type is given"
            )
        self._check_type(topic, ros_type)
        rate, length = frame.get("throttle_rate", 0), frame.get("queue_length", 0)
        if not isinstance(rate, int) or not isinstance(length, int):
            raise InvalidMessageError("rosbridge subscribe", "throttle_rate", "a whole number is expected")
        throttle = Throttle(
            rate / 1000,
            length,
            lambda message: client.send({"op": "publish", "topic": topic, "msg": message}),
        )
        self._unsubscribe(client, topic)
        client.hears[topic] = ros_type, throttle
        if topic in self._latched:
            throttle.put(self._latched[topic])

    def _unsubscribe(self, client: _Client, topic: str) -> None:
        if topic in client.hears:
            client.hears.pop(topic)[1].close()

    # Services

    def _advertise_service(self, client: _Client, frame: Frame) -> None:
        service, ros_type = text_of(frame, "service"), text_of(frame, "type")
        for each in self._clients:
            self._unserve(each, service)  # the newest has it, as in rosbridge
        client.answers[service] = ros_type

    def _unserve(self, client: _Client, service: str) -> None:
        if client.answers.pop(service, None) is None:
            return
        for server, name, waiting in list(self._calls.values()):
            if server is client and name == service and not waiting.done():
                waiting.set_exception(_RefusedError(f"Service {service} was unadvertised"))

    async def _call(self, service: str, args: Any) -> Any:
        """The answer of whoever serves it."""
        if service in self._rosapi:
            return self._rosapi[service][1](args)
        server = next((each for each in self._clients if service in each.answers), None)
        if server is None:
            raise _RefusedError(f"Service {service} does not exist")
        id_ = f"service_request:{service}:{next(self._numbers)}"
        waiting: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._calls[id_] = server, service, waiting
        server.send({"op": "call_service", "id": id_, "service": service, "args": args})
        try:
            return await waiting
        finally:
            del self._calls[id_]

    async def _call_service(self, client: _Client, frame: Frame) -> None:
        service, args = str(frame.get("service")), frame.get("args", {})
        answer = {"op": "service_response", "id": frame.get("id"), "service": service}
        try:
            client.send(answer | {"values": await self._call(service, args), "result": True})
        except _RefusedError as refused:
            client.send(answer | {"values": str(refused), "result": False})

    def _service_response(self, client: _Client, frame: Frame) -> None:
        _, _, waiting = self._calls.get(str(frame.get("id")), (None, None, None))
        if waiting is None or waiting.done():
            return
        if frame.get("result") is True:
            waiting.set_result(frame.get("values", {}))
        else:
            waiting.set_exception(_RefusedError(str(frame.get("values"))))

    # Actions: to the services and topics that an action server has in ROS 2

    async def _send_goal(self, client: _Client, frame: Frame) -> None:
        id_, action = str(frame.get("id")), str(frame.get("action"))
        goal_id = {"uuid": base64.b64encode(uuid.uuid4().bytes).decode()}
        answer = {"op": "action_result", "id": frame.get("id"), "action": action, "status": GoalState.UNKNOWN}

        def tell(message: Any) -> None:
            if isinstance(message, dict) and message.get("goal_id") == goal_id:
                told = {
                    "op": "action_feedback",
                    "id": id_,
                    "action": action,
                    "values": message.get("feedback"),
                }
                client.send(told)

        client.goals[id_] = action, goal_id["uuid"]
        self._ears[id_] = f"{action}/_action/feedback", tell
        try:
            wanted = {"goal_id": goal_id, "goal": frame.get("args", {})}
            taken = await self._call(f"{action}/_action/send_goal", wanted)
            if not isinstance(taken, dict) or taken.get("accepted") is not True:
                raise _RefusedError(REFUSED)
            ended = await self._call(f"{action}/_action/get_result", {"goal_id": goal_id})
            if not isinstance(ended, dict):
                raise _RefusedError(f"{action} gave no result")
            values = {"values": ended.get("result"), "status": ended.get("status"), "result": True}
            client.send(answer | values)
        except _RefusedError as refused:
            client.send(answer | {"values": str(refused), "result": False})
        finally:
            del self._ears[id_], client.goals[id_]

    async def _cancel_goal(self, client: _Client, frame: Frame) -> None:
        action, goal_id = client.goals.get(str(frame.get("id")), (None, None))
        if action is None:
            return
        info = {"goal_id": {"uuid": goal_id}, "stamp": {"sec": 0, "nanosec": 0}}
        try:
            await self._call(f"{action}/_action/cancel_goal", {"goal_info": info})
        except _RefusedError as refused:
            log.info("a goal was not called off", action=action, why=str(refused))

    # What rosapi tells; as there, names with a part that begins with _ are hidden

    def _topics(self, _: Any) -> Frame:
        types: dict[str, str] = {}
        for client in self._clients:
            types |= client.publishes | {topic: ros_type for topic, (ros_type, _) in client.hears.items()}
        shown = {topic: ros_type for topic, ros_type in types.items() if "/_" not in topic}
        return {"topics": list(shown), "types": list(shown.values())}

    def _services(self, _: Any) -> Frame:
        return {"services": [*self._rosapi, *self._shown(each.answers for each in self._clients)]}

    def _nodes(self, _: Any) -> Frame:
        return {"nodes": [BRIDGE, ROSAPI]}

    def _node_details(self, args: Any) -> Frame:
        if args == {"node": ROSAPI}:
            return {"subscribing": [], "publishing": [], "services": list(self._rosapi)}
        if args != {"node": BRIDGE}:
            self._rosapi.clear()
            log.error(_DEAD)
            raise _RefusedError(_DEAD)
        return {
            "subscribing": self._shown(each.hears for each in self._clients),
            "publishing": self._shown(each.publishes for each in self._clients),
            "services": self._shown(each.answers for each in self._clients),
        }

    def _holders(self, args: Any, has: Callable[[_Client], Iterable[str]]) -> list[str]:
        topic = args.get("topic", "") if isinstance(args, dict) else ""
        return [BRIDGE] if topic in self._shown(has(each) for each in self._clients) else []

    @staticmethod
    def _shown(names: Iterable[Iterable[str]]) -> list[str]:
        return sorted({name for some in names for name in some if "/_" not in name})

    def _service_node(self, args: Any) -> Frame:
        service = args.get("service", "") if isinstance(args, dict) else ""
        answered = any(service in each.answers for each in self._clients)
        return {"node": ROSAPI if service in self._rosapi else BRIDGE if answered else ""}

    def _service_type(self, args: Any) -> Frame:
        service = args.get("service", "") if isinstance(args, dict) else ""
        known = next((each.answers[service] for each in self._clients if service in each.answers), "")
        return {"type": self._rosapi[service][0] if service in self._rosapi else known}

    def _action_servers(self, _: Any) -> Frame:
        served = {
            name for client in self._clients for name in client.answers if name.endswith("/_action/send_goal")
        }
        return {"action_servers": sorted(name.removesuffix("/_action/send_goal") for name in served)}
