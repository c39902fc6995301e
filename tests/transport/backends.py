"""The backends that the contract suite runs against. A new backend joins by adding its factory here."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from parley.config import NetworkSettings
from parley.transport.base import Server, Subscription, Transport
from parley.transport.local import LocalTransport
from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport
from parley.transport.rosbridge.rosapi import NODES, NodesRequest
from parley.transport.zenoh import ZenohTransport

DEFINITIONS = (Path(__file__).parent / "definitions",)
"""Of types that only tests use."""


@dataclass(frozen=True)
class Network:
    """Two parties on one network; in one process they may be the same object."""

    here: Transport
    there: Transport


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


BACKENDS: dict[str, Callable[[], AbstractAsyncContextManager[Network]]] = {
    "local": local,
    "rosbridge": rosbridge,
    "zenoh": zenoh,
}


async def until(condition: Callable[[], object], *, within_s: float = 10.0) -> None:
    """Wait until `condition` holds; fails the test if it never does."""
    async with asyncio.timeout(within_s):
        while not condition():  # noqa: ASYNC110 - any condition, of any backend
            await asyncio.sleep(0.001)
