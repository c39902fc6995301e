"""What is particular to rosbridge: frames, spelling of types, lost connections and held-back pictures."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
import structlog
from websockets.asyncio.server import ServerConnection, serve

from parley.config import SystemConfig
from parley.errors import (
    TransportError,
    TransportTimeoutError,
    TypeMismatchError,
    UnavailableError,
    UnsupportedError,
)
from parley.messages.actions import Action, GoalId
from parley.messages.ros import ChatRequest, ChatResponse, CompressedImage, Header, String, Time
from parley.messages.topics import QoS, Service, Topic
from parley.network import transport_of
from parley.transport.base import Endpoint
from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport
from parley.transport.rosbridge.graph import Graph
from parley.transport.rosbridge.values import Codec
from tests.transport.backends import free_port, until

TALK = Topic("bridge/talk", String, "std_msgs/msg/String", QoS(depth=3))
LATCHED = Topic("bridge/latched", String, "std_msgs/msg/String", QoS(latched=True, depth=1))
STOP = Topic("bridge/stop", String, "std_msgs/msg/String", QoS(keep_all=True))
CAMERA = Topic("bridge/camera", CompressedImage, "sensor_msgs/msg/CompressedImage")
ECHO = Service("bridge/echo", ChatRequest, ChatResponse, "nl_interface_msgs/srv/Chat")


async def echo(request: ChatRequest) -> ChatResponse:
    if request.message == "hang":
        await asyncio.Event().wait()
    return ChatResponse(request.message)


class Scripted:
    """A bridge that says what it is told to, and reads only when it may."""

    def __init__(self) -> None:
        self.heard: list[dict[str, Any]] = []
        self.reads = asyncio.Event()
        self.reads.set()
        self.connections: list[ServerConnection] = []

    async def on_client(self, connection: ServerConnection) -> None:
        self.connections.append(connection)
        while True:
            await self.reads.wait()
            self.heard.append(json.loads(await connection.recv()))

    async def say(self, frame: Any) -> None:
        await self.connections[0].send(frame if isinstance(frame, str | bytes) else json.dumps(frame))


@asynccontextmanager
async def scripted() -> AsyncIterator[tuple[Scripted, RosbridgeTransport]]:
    bridge = Scripted()
    async with serve(bridge.on_client, "127.0.0.1", 0, max_queue=1, close_timeout=0.1) as server:
        port = next(iter(server.sockets)).getsockname()[1]
        async with RosbridgeTransport(f"ws://127.0.0.1:{port}") as transport:
            yield bridge, transport


async def test_where_nobody_listens_the_error_names_the_address() -> None:
    address = f"ws://127.0.0.1:{free_port()}"
    with pytest.raises(UnavailableError, match=f"{address}.*rosbridge_server"):
        async with RosbridgeTransport(address):
            pass


async def test_where_something_else_listens_the_error_names_the_address() -> None:
    async with RosbridgeServer() as first:
        port = int(first.address.rpartition(":")[2])
        with pytest.raises(TransportError, match=f"port {port}: something else is there"):
            await RosbridgeServer(port).__aenter__()


async def test_a_bridge_that_comes_back_is_told_of_all_ends_and_meanwhile_calls_fail_at_once() -> None:
    port, heard, latched = free_port(), [], []
    async with RosbridgeServer(port) as first:
        robot = RosbridgeTransport(first.address, look_s=0.02)
        here = RosbridgeTransport(first.address, look_s=0.02)
        await robot.__aenter__()
        await here.__aenter__()
        await robot.serve(ECHO, echo)
        await robot.subscribe(TALK, lambda message: heard.append(message.data))
        robot.publisher(LATCHED).publish(String("kept"))
        talk, stop = here.publisher(TALK), here.publisher(STOP)
        server = Endpoint("/bridge/echo", ECHO.ros_type, "server")
        await until(lambda: server in here.endpoints())
        hung = asyncio.create_task(here.call(ECHO, ChatRequest("hang"), timeout_s=60.0))
        await asyncio.sleep(0.01)
    with pytest.raises(UnavailableError, match=r"bridge/echo.*lost"):
        await hung
    await until(lambda: not here.connected and not robot.connected)
    assert server not in here.endpoints()
    with pytest.raises(UnavailableError, match="no connection"):
        await here.call(ECHO, ChatRequest("x"), timeout_s=60.0)
    talk.publish(String("stale"))
    stop.publish(String("stop"))
    async with RosbridgeServer(port):
        await until(lambda: server in here.endpoints())
        assert await here.call(ECHO, ChatRequest("again"), timeout_s=5.0) == ChatResponse("again")
        await here.subscribe(LATCHED, lambda message: latched.append(message.data))
        await here.subscribe(STOP, lambda message: latched.append(message.data))
        talk.publish(String("fresh"))
        await until(lambda: heard and latched)
        await robot.__aexit__(None, None, None)
        await here.__aexit__(None, None, None)
    assert heard == ["fresh"]
    assert latched == ["kept"]


async def test_a_bridge_is_asked_to_keep_what_is_said_in_one_go_and_of_the_latched_what_counts() -> None:
    async with scripted() as (bridge, transport):
        for topic in (STOP, TALK, LATCHED):
            transport.publisher(topic)
        await until(lambda: sum(frame["op"] == "advertise" for frame in bridge.heard) == 3)
    kept = {frame["topic"]: frame["queue_size"] for frame in bridge.heard if frame["op"] == "advertise"}
    assert kept == {"/bridge/stop": 1000, "/bridge/talk": 100, "/bridge/latched": 1}


async def test_a_stop_goes_before_all_else_that_waits() -> None:
    async with scripted() as (bridge, transport):
        stop, talk = transport.publisher(STOP), transport.publisher(TALK)
        await until(lambda: {"advertise"} <= {frame["op"] for frame in bridge.heard})
        bridge.reads.clear()
        for number in range(200):  # far more than fits on the way
            talk.publish(String(f"{number} " + "x" * 100_000))
        stop.publish(String("stop"))
        bridge.reads.set()
        await until(
            lambda: any(frame.get("topic") == "/bridge/stop" and "msg" in frame for frame in bridge.heard)
        )
        await until(lambda: str(bridge.heard[-1].get("msg", "")).startswith("{'data': '199 "))
    said = [frame["msg"]["data"].split()[0] for frame in bridge.heard if "msg" in frame]
    assert said.index("stop") < said.index("197")
    assert said[-3:] == ["197", "198", "199"]
    assert len(said) < 200


async def test_a_stop_is_kept_for_the_next_connection_and_nothing_else_is() -> None:
    async with scripted() as (bridge, transport):
        stop, talk = transport.publisher(STOP), transport.publisher(TALK)
        await until(lambda: bridge.connections)
        bridge.reads.clear()
        for _ in range(200):  # far more than fits on the way
            talk.publish(String("x" * 100_000))
        stop.publish(String("on its way"))
        stop.publish(String("waits"))
        bridge.connections[0].transport.abort()
        await until(lambda: not transport.connected)
        talk.publish(String("stale"))
        stop.publish(String("stop"))
        bridge.reads.set()
        await until(lambda: any(frame.get("msg") == {"data": "stop"} for frame in bridge.heard))
    said = [frame["msg"]["data"] for frame in bridge.heard if "msg" in frame]
    assert [text for text in said if not text.startswith("x")] == ["on its way", "waits", "stop"]


def test_a_system_may_live_in_the_ros_behind_a_bridge() -> None:
    config = SystemConfig.parse("network: {rosbridge: ws://robot:9090}")
    assert isinstance(transport_of(config), RosbridgeTransport)


@pytest.mark.parametrize(
    ("frame", "why"),
    [
        ("{", "not valid JSON"),
        ("[]", "no object"),
        ("{}", "op: a text is expected"),
        (b"\x00", "BSON"),
        ({"op": "publish", "msg": {}}, "rosbridge publish.topic"),
        (
            {"op": "publish", "topic": "/bridge/talk", "msg": {"data": 1}},
            "String.data should be a text, not 1",
        ),
        ({"op": "publish", "topic": "/bridge/talk", "msg": {}}, "String.data is missing"),
        ({"op": "fragment", "id": "1", "data": "", "num": 3, "total": 2}, "3 of 2"),
    ],
)
async def test_a_frame_that_cannot_be_read_is_told_by_name_and_the_next_one_is_heard(
    frame: Any, why: str
) -> None:
    heard: list[str] = []
    async with scripted() as (bridge, transport):
        await transport.subscribe(TALK, lambda message: heard.append(message.data))
        await until(lambda: bridge.connections)
        with structlog.testing.capture_logs() as logged:
            await bridge.say(frame)
            await bridge.say({"op": "publish", "topic": "/bridge/talk", "msg": {"data": "next", "newer": 1}})
            await until(lambda: heard)
    assert heard == ["next"]
    assert [why in line["why"] for line in logged if line["log_level"] == "warning"] == [True]


async def test_what_comes_in_pieces_is_put_together_as_rosbridge_cuts_it() -> None:
    heard: list[str] = []
    async with scripted() as (bridge, transport):
        await transport.subscribe(TALK, lambda message: heard.append(message.data))
        await until(lambda: bridge.connections)
        text = json.dumps({"op": "publish", "topic": "/bridge/talk", "msg": {"data": "long" * 10}})
        size = 32
        total = (len(text) - 1) / size + 1  # a fraction, as rosbridge_suite 2.1 sends it
        for number, start in enumerate(range(0, len(text), size)):
            data = text[start : start + size]
            await bridge.say({"op": "fragment", "id": 0, "data": data, "num": number, "total": total})
        await until(lambda: heard)
    assert heard == ["long" * 10]


async def test_of_pictures_that_come_too_fast_the_newest_is_sent() -> None:
    heard: list[bytes] = []
    async with (
        RosbridgeServer() as bridge,
        RosbridgeTransport(bridge.address) as robot,
        RosbridgeTransport(bridge.address, pace_ms={CAMERA.ros_type: 50}) as here,
    ):
        await here.subscribe(CAMERA, lambda picture: heard.append(picture.data))
        camera = robot.publisher(CAMERA)
        await until(lambda: Endpoint("/bridge/camera", CAMERA.ros_type, "subscription") in here.endpoints())
        for number in range(5):
            camera.publish(CompressedImage(data=bytes([number])))
        await until(lambda: len(heard) == 2)
    assert heard == [b"\x00", b"\x04"]


async def test_two_subscriptions_get_each_message_once_and_the_latched_one_too() -> None:
    heard: tuple[list[str], list[str]] = ([], [])
    async with RosbridgeServer() as bridge, RosbridgeTransport(bridge.address) as transport:
        transport.publisher(LATCHED).publish(String("kept"))
        await transport.subscribe(LATCHED, lambda message: heard[0].append(message.data))
        await until(lambda: heard[0])
        await transport.subscribe(LATCHED, lambda message: heard[1].append(message.data))
        transport.publisher(LATCHED).publish(String("new"))
        await until(lambda: all("new" in each for each in heard))
    assert heard == (["kept", "new"], ["kept", "new"])


def test_values_are_spelt_as_each_generation_of_ros_has_them() -> None:
    picture = CompressedImage(Header(Time(1, 2), "camera"), "jpeg", b"\xff\xd8")
    for ros, (sec, nanosec) in {1: ("secs", "nsecs"), 2: ("sec", "nanosec")}.items():
        codec = Codec(CompressedImage, CAMERA.ros_type, 1 if ros == 1 else 2)
        header = {"stamp": {sec: 1, nanosec: 2}, "frame_id": "camera"}
        assert codec.encode(picture) == {"header": header, "format": "jpeg", "data": "/9g="}
        assert codec.decode(codec.encode(picture) | {"seq": 7}) == picture
    with pytest.raises(TypeMismatchError, match=r"CompressedImage\.data should be bytes in base64"):
        Codec(CompressedImage, CAMERA.ros_type).decode(
            {"header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": ""}, "format": "", "data": "?"}
        )


async def test_who_is_there_is_asked_again_and_again_of_ros_1_too() -> None:
    async with (
        RosbridgeServer(ros=1) as bridge,
        RosbridgeTransport(bridge.address, ros=1) as robot,
        RosbridgeTransport(bridge.address, ros=1, look_s=0.02) as here,
    ):
        await until(lambda: any(end.name == "/rosapi/nodes" for end in here.endpoints()))
        await robot.serve(ECHO, echo)
        await until(lambda: Endpoint("/bridge/echo", ECHO.ros_type, "server") in here.endpoints())
        assert await here.call(ECHO, ChatRequest("x"), timeout_s=5.0) == ChatResponse("x")


async def test_it_is_known_which_ends_are_of_others() -> None:
    async with (
        RosbridgeServer() as bridge,
        RosbridgeTransport(bridge.address, look_s=0.02) as here,
        RosbridgeTransport(bridge.address) as there,
    ):
        await there.subscribe(TALK, lambda _: None)
        here.publisher(TALK)
        await until(lambda: len([end for end in here.endpoints() if end.name == "/bridge/talk"]) == 2)
        told = {end.role: end.elsewhere for end in here.endpoints() if end.name == "/bridge/talk"}
        assert told == {"subscription": True, "publisher": False}


async def test_a_bridge_that_does_not_tell_who_is_there_is_logged_once_for_each_link() -> None:
    async def nobody(*_: object) -> Any:
        raise UnavailableError("no rosapi")

    graph = Graph()
    with structlog.testing.capture_logs() as told:
        for _ in range(3):
            await graph.look(nobody)
        graph.lost()
        await graph.look(nobody)
    assert len(told) == 2


async def test_ros_1_gets_its_own_names_of_types_and_has_no_actions() -> None:
    bridge = Scripted()
    async with serve(bridge.on_client, "127.0.0.1", 0) as server:
        port = next(iter(server.sockets)).getsockname()[1]
        async with RosbridgeTransport(f"ws://127.0.0.1:{port}", ros=1) as transport:
            await transport.subscribe(CAMERA, lambda _: None)
            with pytest.raises(UnsupportedError, match="ROS 1"):
                await transport.action_client(Action("go", GoalId, GoalId, GoalId, "nav2_msgs/action/Wait"))
            await until(lambda: any(frame["op"] == "subscribe" for frame in bridge.heard))
    (told,) = [frame for frame in bridge.heard if frame["op"] == "subscribe"]
    assert told == {
        "op": "subscribe",
        "topic": "/bridge/camera",
        "type": "sensor_msgs/CompressedImage",
        "throttle_rate": 200,
        "queue_length": 1,
    }


async def test_a_goal_is_called_off_until_that_is_heard_whether_somebody_waits_or_not() -> None:
    go = Action("go", String, String, String, "std_msgs/action/Go")
    async with scripted() as (bridge, transport):
        client = await transport.action_client(go)

        def heard(op: str) -> list[dict[str, Any]]:
            return [frame for frame in bridge.heard if frame.get("op") == op]

        sending = asyncio.create_task(client.send(String("a"), timeout_s=20.0))
        await until(lambda: heard("send_action_goal"))
        asked = heard("send_action_goal")[0]["id"]
        await bridge.say({"op": "action_feedback", "id": asked, "action": "/go", "values": {"data": ""}})
        calling_off = asyncio.create_task((await sending).cancel(timeout_s=20.0))
        await until(lambda: len(heard("cancel_action_goal")) == 2)  # the first came to nothing
        ended = {"op": "action_result", "id": asked, "action": "/go", "status": 5, "result": True}
        await bridge.say(ended | {"values": {"data": ""}})
        assert await calling_off
        with pytest.raises(TransportTimeoutError):
            await client.send(String("b"), timeout_s=0.01)
        given_up = heard("send_action_goal")[-1]["id"]
        await until(lambda: [one["id"] for one in heard("cancel_action_goal")].count(given_up) == 2)
        await client.close()
