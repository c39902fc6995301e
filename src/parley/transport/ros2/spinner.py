"""The thread in which ROS hears, and the context of the nodes in it."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Sequence
from typing import Any, Final

import rclpy
import structlog
from rclpy.context import Context
from rclpy.exceptions import InvalidHandle, NameValidationException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from parley.errors import UnavailableError

__all__ = ["Spinner"]

CLOSING_S: Final = 5.0
"""How long closing waits for the thread; then the process goes on without."""

log = structlog.get_logger(__name__)


class Spinner:
    """Calls what ROS has for its nodes, one thing after the other, in a thread of its own.

    What it calls hands on to the loop and returns at once, so one thread is enough for all.

    Args:
        arguments: What a user of ROS writes on the command line, `--ros-args` before it.
        domain: Which of ROS's domains; None: as ROS_DOMAIN_ID says.

    Raises:
        UnavailableError: ROS does not start, or does not take these arguments.
    """

    def __init__(self, arguments: Sequence[str], domain: int | None) -> None:
        self.context = Context()
        try:
            # Signals are the process's own: it closes all in order, this too.
            rclpy.init(
                args=list(arguments), context=self.context, domain_id=domain,
                signal_handler_options=SignalHandlerOptions.NO,
            )  # fmt: skip
        except RuntimeError as error:
            raise UnavailableError(f"ROS does not start: {error}") from error
        self._executor = SingleThreadedExecutor(context=self.context)
        self._ending = False
        self.nodes: set[tuple[str, str]] = set()
        """Names and namespaces of those in it."""
        # A daemon: a network that hangs does not keep the process from ending.
        self._thread = threading.Thread(target=self._spin, name="ros2", daemon=True)
        self._thread.start()

    def add(self, name: str, namespace: str) -> Any:
        """A node of ROS, with the parameters that were told it.

        Raises:
            UnavailableError: ROS does not take its name.
        """
        try:
            node = rclpy.create_node(
                name, namespace=namespace, context=self.context,
                allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True,
            )  # fmt: skip
        except (RuntimeError, ValueError, NameValidationException) as error:
            raise UnavailableError(f"ROS does not take the node {name}: {error}") from error
        self._executor.add_node(node)
        self.nodes.add((node.get_name(), node.get_namespace()))
        return node

    def remove(self, node: Any) -> None:
        """Take a node away, and all that it has."""
        self.nodes.discard((node.get_name(), node.get_namespace()))
        self._executor.remove_node(node)
        node.destroy_node()

    async def close(self) -> None:
        """End the thread and what ROS has open."""
        self._ending = True
        self._executor.create_task(lambda: None)  # it waits for something to do
        await asyncio.to_thread(self._thread.join, CLOSING_S)
        if self._thread.is_alive():
            log.warning("ROS did not close in time; going on without")
            return
        self._executor.shutdown()
        rclpy.shutdown(context=self.context)

    def _spin(self) -> None:
        while not self._ending:
            try:
                self._executor.spin_once()
            except ExternalShutdownException:
                return
            except InvalidHandle:
                continue  # an end that it was about to wait for has just been closed
            except Exception:
                # The border of the thread: a defect must not end hearing.
                if not self._ending:
                    log.exception("ROS could not hand something over")
