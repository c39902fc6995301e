"""How long a message is on its way, and how many get through, within a process and between two.

Where ROS is sourced, rclpy itself is measured beside our transports, in the same run.
"""

from __future__ import annotations

import asyncio
import os
import sys
import time
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol, Self

from parley.bench.engine import share
from parley.config import NetworkSettings
from parley.extras import needs
from parley.messages.ros import CompressedImage, String
from parley.messages.topics import QoS, Topic
from parley.ros_check import Sourced
from parley.transport.base import Transport
from parley.transport.local import LocalTransport

if TYPE_CHECKING:
    from parley.bench.rclpy_alone import Alone

__all__ = ["Compared", "TransportFigures", "TransportReport", "measure_transport"]

_AT_ONCE: Final = 50
_DEPTH: Final = 2 * _AT_ONCE
OUT: Final = Topic("bench/out", CompressedImage, "sensor_msgs/msg/CompressedImage", QoS(depth=_DEPTH))
BACK: Final = Topic("bench/back", CompressedImage, "sensor_msgs/msg/CompressedImage", QoS(depth=_DEPTH))
END: Final = Topic("bench/end", String, "std_msgs/msg/String")
SIZES: Final = {"200_B": 200, "1_MB": 1_000_000}
_ROUNDS: Final = 5
"""What is compared takes turns, so that a busy moment is nobody's alone."""
_PATIENCE_S: Final = 60.0
_SLOWEST_S: Final = 0.5
"""So long may one message take there and back, with those before it."""
_AGAIN_S: Final = 1.0


@dataclass(frozen=True, slots=True)
class Compared:
    """How something stands to rclpy itself in the same run."""

    latency: float
    """How many times as long a message takes, by the median; below 1: it is faster."""
    throughput: float
    """How many times as many get through."""


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

    def compared_with(self, other: TransportFigures) -> Compared:
        """How this stands to `other`."""
        own, its = share(self.latency_ms, 0.5), share(other.latency_ms, 0.5)
        return Compared(own / its, self.messages_per_s / other.messages_per_s)


@dataclass(frozen=True, slots=True)
class TransportReport:
    """What was measured in one run."""

    figures: tuple[TransportFigures, ...]
    rmw: str
    """What carried ROS; empty: ROS is not here."""
    without_ros: str
    """Why ROS was not measured, and what to do; empty: it was."""

    def to_rclpy(self, one: TransportFigures) -> Compared | None:
        """How `one` stands to rclpy itself with messages of its size; None: nothing to compare."""
        for other in self.figures:
            if other.backend == "rclpy" and other.size == one.size and other is not one:
                return one.compared_with(other)
        return None


class _Contender(Protocol):
    """One way to an echo and back."""

    async def one_after_another(self, length: int, times: int) -> list[float]:
        """There and back of each message, in seconds."""

    async def some_at_once(self, length: int, times: int) -> float:
        """How long all take, in seconds."""

    def lost(self) -> int:
        """How many were dropped so far."""


async def measure_transport(times: int, sourced: Sourced | None = None) -> TransportReport:
    """Send to an echo and back: over the local transport, over Zenoh and, where it is sourced, over ROS.

    Over ROS twice: by our transport, and by rclpy itself.

    Args:
        times: How many messages of each size.
        sourced: The ROS of this process, if told.
    """
    found = next(iter((sourced or Sourced(packages=("sensor_msgs", "std_msgs"))).findings()))
    rmw = ""
    async with AsyncExitStack() as stack:
        local = await stack.enter_async_context(LocalTransport())
        await _echo(local)
        zenoh = await stack.enter_async_context(_beside_zenoh())
        contenders: dict[str, _Contender] = {
            "local": await _Over(local).meet(), "zenoh": await _Over(zenoh).meet()
        }  # fmt: skip
        if found.state == "ok":
            from parley.bench.rclpy_alone import rmw as carried_by

            rmw = carried_by()
            namespace = f"/parley_bench_{os.getpid()}"
            own = f"{namespace}/ros2"
            ours = await stack.enter_async_context(
                _beside(_ros("bench", own), f"{echo_over_ros.__name__}({own!r})")
            )
            contenders["ros2"] = await _Over(ours).meet()
            contenders["rclpy"] = await stack.enter_async_context(_rclpy(f"{namespace}/rclpy"))
        figures = [one for size in SIZES for one in await _measure(contenders, size, times)]
    figures.sort(key=lambda one: list(contenders).index(one.backend))
    without = "" if rmw else f"{found.text} {found.remedy}".strip()
    return TransportReport(tuple(figures), rmw, without)


async def _measure(contenders: dict[str, _Contender], size: str, times: int) -> list[TransportFigures]:
    length = SIZES[size]
    latency_ms: dict[str, list[float]] = {name: [] for name in contenders}
    took_s = dict.fromkeys(contenders, 0.0)
    before = {name: one.lost() for name, one in contenders.items()}
    for contender in contenders.values():
        await contender.one_after_another(length, 3)  # the first few are not counted
    rounds = min(_ROUNDS, times)
    for number in range(rounds):
        part = times // rounds + (number < times % rounds)
        for name, contender in contenders.items():
            latency_ms[name] += [500 * s for s in await contender.one_after_another(length, part)]
            took_s[name] += await contender.some_at_once(length, part)
    return [
        TransportFigures(
            name, size, tuple(latency_ms[name]), times / took_s[name], contender.lost() - before[name]
        )
        for name, contender in contenders.items()
    ]


class _Over:
    """Over one of our transports."""

    def __init__(self, transport: Transport) -> None:
        self._transport, self._out = transport, transport.publisher(OUT)
        self._came = asyncio.Semaphore(0)

    async def meet(self) -> Self:
        """Hear the echo for the first time; what it says before its way back is open is lost."""
        self._back = await self._transport.subscribe(BACK, lambda _: self._came.release())
        said, heard = 0, False
        async with asyncio.timeout(_PATIENCE_S):
            while not heard:
                self._out.publish(CompressedImage())
                said += 1
                with suppress(TimeoutError):
                    heard = await asyncio.wait_for(self._came.acquire(), _AGAIN_S)
        if said > 1:  # of those before, some may still come
            await asyncio.sleep(_AGAIN_S)
            while not self._came.locked():
                await self._came.acquire()
        return self

    async def one_after_another(self, length: int, times: int) -> list[float]:
        """See `_Contender`."""
        message, took_s = CompressedImage(data=bytes(length)), []
        async with asyncio.timeout(_PATIENCE_S + times * _SLOWEST_S):
            for _ in range(times):
                begun_s = time.perf_counter()
                self._out.publish(message)
                await self._came.acquire()
                took_s.append(time.perf_counter() - begun_s)
        return took_s

    async def some_at_once(self, length: int, times: int) -> float:
        """See `_Contender`."""
        message, begun_s = CompressedImage(data=bytes(length)), time.perf_counter()
        async with asyncio.timeout(_PATIENCE_S + times * _SLOWEST_S):
            for number in range(times + _AT_ONCE):
                if number < times:
                    self._out.publish(message)
                if number >= _AT_ONCE:
                    await self._came.acquire()
        return time.perf_counter() - begun_s

    def lost(self) -> int:
        """See `_Contender`."""
        return self._back.dropped


class _Alone:
    """By rclpy itself, in a thread that waits."""

    def __init__(self, node: Alone) -> None:
        self._node = node

    async def one_after_another(self, length: int, times: int) -> list[float]:
        """See `_Contender`."""
        return await asyncio.to_thread(self._node.one_after_another, length, times)

    async def some_at_once(self, length: int, times: int) -> float:
        """See `_Contender`."""
        return await asyncio.to_thread(self._node.some_at_once, length, times, _AT_ONCE)

    def lost(self) -> int:
        """See `_Contender`; it waits for each."""
        return 0


async def echo_over_zenoh(at: str) -> None:
    """The other process: send back what comes, until it is told that this was all."""
    await _echo_until_ended(_zenoh(listen=(), connect=(at,)))


async def echo_over_ros(namespace: str) -> None:
    """The same, in ROS."""
    await _echo_until_ended(_ros("echo", namespace))


async def _echo_until_ended(network: Transport) -> None:
    ended = asyncio.Event()
    async with network as transport:
        await transport.subscribe(END, lambda _: ended.set())
        await _echo(transport)
        await ended.wait()


async def _echo(transport: Transport) -> None:
    back = transport.publisher(BACK)
    await transport.subscribe(OUT, back.publish)


def _zenoh(*, listen: tuple[str, ...], connect: tuple[str, ...]) -> Transport:
    with needs("zenoh"):
        from parley.transport.zenoh import ZenohTransport
    return ZenohTransport(NetworkSettings(listen=listen, connect=connect, interface=""))


def _ros(node: str, namespace: str) -> Transport:
    from parley.transport.ros2 import Ros2Transport

    return Ros2Transport(node=node, namespace=namespace)


@asynccontextmanager
async def _beside_zenoh() -> AsyncIterator[Transport]:
    """A network of Zenoh with a process that echoes on it."""
    taken = await asyncio.start_server(lambda *_: None, "127.0.0.1", 0)
    at = f"tcp/127.0.0.1:{taken.sockets[0].getsockname()[1]}"
    taken.close()
    await taken.wait_closed()
    async with _beside(_zenoh(listen=(at,), connect=()), f"{echo_over_zenoh.__name__}({at!r})") as transport:
        yield transport


@asynccontextmanager
async def _beside(network: Transport, echo: str) -> AsyncIterator[Transport]:
    """`network`, with a process on it that runs `echo`."""
    async with network as transport:
        there = asyncio.Event()

        def look() -> None:
            names = [end.name for end in transport.endpoints()]  # in ROS below a namespace
            if all(any(name.endswith(topic.name) for name in names) for topic in (BACK, OUT)):
                there.set()

        transport.on_endpoints_changed(look)
        end = transport.publisher(END)
        code = f"import asyncio, {__name__} as bench; asyncio.run(bench.{echo})"
        async with _process(code):
            async with asyncio.timeout(_PATIENCE_S):
                await there.wait()
            yield transport
            end.publish(String())


@asynccontextmanager
async def _rclpy(namespace: str) -> AsyncIterator[_Alone]:
    """A node of rclpy, with a process that has another and echoes."""
    from parley.bench.rclpy_alone import Alone, echo_until_ended

    with Alone(namespace, OUT.qos, _PATIENCE_S) as node:
        asked = f"echo_until_ended({namespace!r}, {_DEPTH}, {_PATIENCE_S})"
        async with _process(f"from {echo_until_ended.__module__} import echo_until_ended; {asked}"):
            await asyncio.to_thread(node.meet)
            yield _Alone(node)
            await asyncio.to_thread(node.end)


@asynccontextmanager
async def _process(code: str) -> AsyncIterator[None]:
    """Another Python that runs `code`; it ends by itself after what is done with it."""
    other = await asyncio.create_subprocess_exec(sys.executable, "-c", code)
    try:
        yield
        async with asyncio.timeout(_PATIENCE_S):
            await other.wait()
    finally:
        if other.returncode is None:
            other.kill()
            await other.wait()
