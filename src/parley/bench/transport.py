"""How long a message is on its way, and how many get through, within a process and between two."""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Final

from parley.config import NetworkSettings
from parley.extras import needs
from parley.messages.ros import CompressedImage, String
from parley.messages.topics import QoS, Topic
from parley.transport.base import Transport
from parley.transport.local import LocalTransport

__all__ = ["TransportFigures", "measure_transport"]

OUT: Final = Topic("bench/out", CompressedImage, "sensor_msgs/msg/CompressedImage", QoS(depth=100_000))
BACK: Final = Topic("bench/back", CompressedImage, "sensor_msgs/msg/CompressedImage", QoS(depth=100_000))
END: Final = Topic("bench/end", String, "std_msgs/msg/String")
SIZES: Final = {"200_B": 200, "1_MB": 1_000_000}
_AT_ONCE: Final = 50
_PATIENCE_S: Final = 60.0


@dataclass(frozen=True, slots=True)
class TransportFigures:
    """Messages of one size over one backend, there and back."""

    backend: str
    size: str
    latency_ms: tuple[float, ...]
    """One way: half of the time of one there and back, one after the other."""
    messages_per_s: float
    """There and back, some at once."""
    lost: int


async def measure_transport(times: int) -> list[TransportFigures]:
    """Send to an echo and back, over the local transport and over Zenoh to another process.

    Args:
        times: How many messages of each size.
    """
    figures = []
    async with LocalTransport() as transport:
        await _echo(transport)
        figures += await _measure("local", transport, times)
    async with _beside() as transport:
        figures += await _measure("zenoh", transport, times)
    return figures


async def echo_until_ended(at: str) -> None:
    """The other process: send back what comes, until it is told that this was all."""
    ended = asyncio.Event()
    async with _network(listen=(), connect=(at,)) as transport:
        await transport.subscribe(END, lambda _: ended.set())
        await _echo(transport)
        await ended.wait()


async def _echo(transport: Transport) -> None:
    back = transport.publisher(BACK)
    await transport.subscribe(OUT, back.publish)


def _network(*, listen: tuple[str, ...], connect: tuple[str, ...]) -> Transport:
    with needs("zenoh"):
        from parley.transport.zenoh import ZenohTransport
    return ZenohTransport(NetworkSettings(listen=listen, connect=connect, interface=""))


@asynccontextmanager
async def _beside() -> AsyncIterator[Transport]:
    """A network with a process that echoes on it."""
    taken = await asyncio.start_server(lambda *_: None, "127.0.0.1", 0)
    at = f"tcp/127.0.0.1:{taken.sockets[0].getsockname()[1]}"
    taken.close()
    await taken.wait_closed()
    async with _network(listen=(at,), connect=()) as transport:
        there = asyncio.Event()

        def look() -> None:
            if {BACK.name, OUT.name} <= {end.name.strip("/") for end in transport.endpoints()}:
                there.set()

        transport.on_endpoints_changed(look)
        end = transport.publisher(END)
        code = f"import asyncio; from {__name__} import echo_until_ended as e; asyncio.run(e({at!r}))"
        other = await asyncio.create_subprocess_exec(sys.executable, "-c", code)
        try:
            async with asyncio.timeout(_PATIENCE_S):
                await there.wait()
            yield transport
            end.publish(String())
            async with asyncio.timeout(_PATIENCE_S):
                await other.wait()
        finally:
            if other.returncode is None:
                other.kill()
                await other.wait()


async def _measure(backend: str, transport: Transport, times: int) -> list[TransportFigures]:
    came = asyncio.Semaphore(0)
    subscription = await transport.subscribe(BACK, lambda _: came.release())
    out = transport.publisher(OUT)
    figures = []
    for size, length in SIZES.items():
        message = CompressedImage(data=bytes(length))
        latency_ms = []
        async with asyncio.timeout(_PATIENCE_S):
            for number in range(-3, times):  # the first few are not counted
                begun_s = time.perf_counter()
                out.publish(message)
                await came.acquire()
                if number >= 0:
                    latency_ms.append(500 * (time.perf_counter() - begun_s))
            begun_s = time.perf_counter()
            for number in range(times + _AT_ONCE):
                if number < times:
                    out.publish(message)
                if number >= _AT_ONCE:
                    await came.acquire()
            took_s = time.perf_counter() - begun_s
        figures.append(
            TransportFigures(backend, size, tuple(latency_ms), times / took_s, subscription.dropped)
        )
    await subscription.close()
    out.close()
    return figures
