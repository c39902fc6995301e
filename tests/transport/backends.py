"""The backends that the contract suite runs against. A new backend joins by adding its factory here."""

from __future__ import annotations

import asyncio
import os
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import pytest

from parley.config import NetworkSettings
from parley.messages.ros import String
from parley.messages.topics import Topic
from parley.ros_check import examine_ros
from parley.transport.base import Endpoint, Server, Subscription, Transport
from parley.transport.local import LocalTransport
from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport
from parley.transport.rosbridge.rosapi import NODES, NodesRequest
from parley.transport.zenoh import ZenohTransport

if TYPE_CHECKING:
    from parley.transport.ros2 import Ros2Transport

DEFINITIONS = (Path(__file__).parent / "definitions",)
"""Of types that only tests use."""


@dataclass(frozen=True)
class Network:
    """Two parties on one network; in one process they may be the same object."""

    here: Transport
    there: Transport
    says_no: bool = True
    """Whether whoever asks for a long task hears that it is refused, or that nobody is there; else the same.

    rosbridge_suite 2.1 waits for such a goal for ever, and has no words for the parts of an action.
    """


@asynccontextmanager
async def local() -> AsyncIterator[Network]:
    async with LocalTransport() as transport:
        yield Network(transport, transport)


class Settled:
    """A transport whose ends are open when the other party sees them: on a network that takes a moment."""

    def __init__(self, transport: Transport, other: Transport) -> None:
        self._transport, self._other = transport, other

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    async def subscribe(self, *args: Any, **options: Any) -> Subscription:
        seen = self._seen("subscription")
        end = await self._transport.subscribe(*args, **options)
        await until(lambda: self._seen("subscription") > seen)
        return end

    async def serve(self, *args: Any) -> Server:
        seen = self._seen("server")
        end = await self._transport.serve(*args)
        await until(lambda: self._seen("server") > seen)
        return end

    def _seen(self, role: str) -> int:
        return sum(end.role == role for end in self._other.endpoints())


def free_port() -> int:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


@asynccontextmanager
async def zenoh() -> AsyncIterator[Network]:
    """Two sessions, each as of a process of its own, that find each other at a port of this machine."""
    at = (f"tcp/127.0.0.1:{free_port()}",)
    async with (
        ZenohTransport(NetworkSettings(listen=at, interface=""), definitions=DEFINITIONS) as here,
        ZenohTransport(
            NetworkSettings(listen=(), connect=at, interface=""), definitions=DEFINITIONS
        ) as there,
    ):
        yield Network(cast(Transport, Settled(here, there)), cast(Transport, Settled(there, here)))


class Bridged:
    """A transport whose ends are open when the bridge knows of them."""

    def __init__(self, transport: RosbridgeTransport) -> None:
        self._transport = transport

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    async def subscribe(self, *args: Any, **options: Any) -> Subscription:
        end = await self._transport.subscribe(*args, **options)
        await self._transport.call(NODES, NodesRequest(), timeout_s=5.0)
        return end

    async def serve(self, *args: Any) -> Server:
        end = await self._transport.serve(*args)
        await self._transport.call(NODES, NodesRequest(), timeout_s=5.0)
        return end


@asynccontextmanager
async def rosbridge() -> AsyncIterator[Network]:
    """Two clients of one bridge."""
    async with (
        RosbridgeServer() as bridge,
        RosbridgeTransport(bridge.address, look_s=0.02) as here,
        RosbridgeTransport(bridge.address, look_s=0.02) as there,
    ):
        yield Network(cast(Transport, Bridged(here)), cast(Transport, Bridged(there)))


MEETING: Final = Topic("contract/meeting", String, "std_msgs/msg/String")
REAL_BRIDGE: Final = os.environ.get("PARLEY_TEST_ROSBRIDGE", "")
"""Address of a rosbridge_suite with rosapi, to try the suite against that, too: `ws://127.0.0.1:9090`.

It has to be in the ROS that is sourced, and in the domain that `ROS_DOMAIN_ID` says.
"""


@asynccontextmanager
async def rosbridge_of_ros() -> AsyncIterator[Network]:
    """A client of a bridge, and a node of the ROS behind it that the bridge has met.

    Under Fast DDS that takes seconds; what is said to a node before is not heard there, bridge or not.
    """
    from parley.transport.ros2 import Ros2Transport

    async with (
        RosbridgeTransport(REAL_BRIDGE, look_s=0.1) as here,
        Ros2Transport(node="contract_there", look_s=0.02) as there,
    ):
        met = asyncio.Event()
        ear, voice = await there.subscribe(MEETING, lambda _: met.set()), here.publisher(MEETING)
        async with asyncio.timeout(20.0):
            while not met.is_set():
                voice.publish(String())
                await asyncio.sleep(0.1)
        voice.close()
        await ear.close()
        yield Network(cast(Transport, Bridged(here)), cast(Transport, Met(there, here)), says_no=False)


class Met:
    """A node of ROS whose ends are open when a bridge tells of them."""

    def __init__(self, transport: Ros2Transport, other: Transport) -> None:
        self._transport, self._other = transport, other

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    async def subscribe(self, *args: Any, **options: Any) -> Subscription:
        end = await self._transport.subscribe(*args, **options)
        name = self._transport.node.resolve_topic_name(args[0].name)
        told = Endpoint(name, args[0].ros_type, "subscription")
        await until(lambda: told in self._other.endpoints())
        await asyncio.sleep(0.3)  # who tells of it is another node than the bridge, and may know it earlier
        return end

    async def serve(self, *args: Any) -> Server:
        end = await self._transport.serve(*args)
        await until(lambda: any(one.name == end.endpoint.name for one in self._other.endpoints()))
        return end


class Matched:
    """A transport whose ends are open when the other node of ROS has met them."""

    def __init__(self, transport: Ros2Transport, other: Ros2Transport) -> None:
        self._transport, self._other = transport, other

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    async def subscribe(self, *args: Any, **options: Any) -> Subscription:
        name = self._transport.node.resolve_topic_name(args[0].name)
        known = self._other.node.count_subscribers(name)
        end = await self._transport.subscribe(*args, **options)
        await until(lambda: self._other.node.count_subscribers(name) > known and self._other.meets_all())
        return end

    async def serve(self, *args: Any) -> Server:
        end = await self._transport.serve(*args)
        await until(lambda: any(one.name == end.endpoint.name for one in self._other.endpoints()))
        return end


def ros2_node(name: str, *, look_s: float) -> Ros2Transport:
    """A node as of a process of its own, in whatever RMW is sourced; nothing leaves this machine."""
    from parley.transport.ros2 import Ros2Transport

    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    return Ros2Transport(node=name, domain=1 + os.getpid() % 100, look_s=look_s)


@asynccontextmanager
async def ros2() -> AsyncIterator[Network]:
    """Two nodes of ROS."""
    async with (
        ros2_node("contract_here", look_s=0.02) as here,
        ros2_node("contract_there", look_s=0.02) as there,
    ):
        await until(lambda: here.endpoints() and there.endpoints())
        both = Matched(here, there), Matched(there, here)
        yield Network(cast(Transport, both[0]), cast(Transport, both[1]))


_ROS: Final = next(iter(examine_ros()))
NEEDS_ROS: Final = (
    pytest.mark.ros,
    pytest.mark.skipif(_ROS.state != "ok", reason=f"ROS 2: {_ROS.text}"),
)
"""Marks of what can be tried only where ROS is sourced."""


NEEDS_BRIDGE: Final = (
    pytest.mark.ros,
    pytest.mark.skipif(not REAL_BRIDGE, reason="PARLEY_TEST_ROSBRIDGE names no bridge"),
)


def each() -> list[Any]:
    """All backends, as parameters of tests; those of a real ROS only where there is one."""
    marks = {"ros2": NEEDS_ROS, "rosbridge_of_ros": NEEDS_BRIDGE}
    return [pytest.param(name, marks=marks.get(name, ())) for name in sorted(BACKENDS)]


BACKENDS: dict[str, Callable[[], AbstractAsyncContextManager[Network]]] = {
    "local": local,
    "ros2": ros2,
    "rosbridge": rosbridge,
    "rosbridge_of_ros": rosbridge_of_ros,
    "zenoh": zenoh,
}


async def until(condition: Callable[[], object], *, within_s: float = 10.0) -> None:
    """Wait until `condition` holds; fails the test if it never does."""
    async with asyncio.timeout(within_s):
        while not condition():  # noqa: ASYNC110 - any condition, of any backend
            await asyncio.sleep(0.001)
