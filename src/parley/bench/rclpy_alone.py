"""Messages between two processes by rclpy itself: what our transports are compared with.

Import this only where ROS is sourced.
"""

from __future__ import annotations

import time
from array import array
from types import TracebackType
from typing import Any, Final, Self

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from parley.messages.topics import QoS
from parley.transport.ros2.ends import profile
from parley.transport.ros2.types import ros_class

__all__ = ["Alone", "echo_until_ended", "rmw"]

_OUT: Final = "bench/out"
_BACK: Final = "bench/back"
_END: Final = "bench/end"
_LOOK_S: Final = 0.05
_Image: Final = ros_class("sensor_msgs/msg/CompressedImage")
_String: Final = ros_class("std_msgs/msg/String")


def rmw() -> str:
    """Which RMW carries all this."""
    return str(rclpy.utilities.get_rmw_implementation_identifier())


class Alone:
    """A node that publishes, hears, and calls what it heard in the thread that waits for it.

    Its message is filled once and sent many times, and what comes is not looked at.

    Args:
        namespace: Of its topics, for nobody else to hear them.
        qos: Of its topics.
        patience_s: How long it waits for the next message.
    """

    def __init__(self, namespace: str, qos: QoS, patience_s: float) -> None:
        self._patience_s, self._qos = patience_s, profile(qos, publishes=True)
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self._node = rclpy.create_node("rclpy_alone", namespace=namespace, context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._came = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.shutdown(context=self._context)

    def meet(self) -> None:
        """Open both ends, and wait for the echo.

        Raises:
            TimeoutError: It is not there in time.
        """
        self._node.create_subscription(_Image, _BACK, self._count, self._qos)
        self._out = self._node.create_publisher(_Image, _OUT, self._qos)
        self._end = self._node.create_publisher(_String, _END, self._qos)
        self._wait_for(self._out, self._end)

    def one_after_another(self, length: int, times: int) -> list[float]:
        """There and back of each message, in seconds."""
        message, took_s = _message(length), []
        for _ in range(times):
            begun_s, awaited = time.perf_counter(), self._came + 1
            self._out.publish(message)
            self._wait(awaited)
            took_s.append(time.perf_counter() - begun_s)
        return took_s

    def some_at_once(self, length: int, times: int, at_once: int) -> float:
        """How long all take there and back, in seconds."""
        message, begun_s, first = _message(length), time.perf_counter(), self._came
        for number in range(times + at_once):
            if number < times:
                self._out.publish(message)
            if number >= at_once:
                self._wait(first + number - at_once + 1)
        return time.perf_counter() - begun_s

    def end(self) -> None:
        """Tell the echo that this was all."""
        self._end.publish(_String())
        self._end.wait_for_all_acked()

    def echo(self) -> None:
        """Send back what comes, until told that this was all."""
        back = self._node.create_publisher(_Image, _BACK, self._qos)
        self._wait_for(back)
        self._node.create_subscription(_String, _END, self._count, self._qos)
        self._node.create_subscription(_Image, _OUT, back.publish, self._qos)
        while not self._came:
            self._executor.spin_once()

    def _wait_for(self, *publishers: Any) -> None:
        until_s = time.monotonic() + self._patience_s
        while not all(one.get_subscription_count() for one in publishers):
            if time.monotonic() > until_s:
                raise TimeoutError
            self._executor.spin_once(timeout_sec=_LOOK_S)

    def _wait(self, awaited: int) -> None:
        until_s = time.monotonic() + self._patience_s
        while self._came < awaited:
            if time.monotonic() > until_s:
                raise TimeoutError
            self._executor.spin_once(timeout_sec=self._patience_s)

    def _count(self, _: Any) -> None:
        self._came += 1


def echo_until_ended(namespace: str, depth: int, patience_s: float) -> None:
    """The other process."""
    with Alone(namespace, QoS(depth=depth), patience_s) as node:
        node.echo()


def _message(length: int) -> Any:
    return _Image(data=array("B", bytes(length)))
