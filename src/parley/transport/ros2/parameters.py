"""The parameters that a node of ROS is started with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from parley.transport.ros2.spinner import Spinner

__all__ = ["parameters"]


async def parameters(node: str, arguments: Sequence[str]) -> dict[str, Any]:
    """What a user of ROS, a launch file or a file of parameters says to a node, before the node is there.

    Raises:
        UnavailableError: ROS does not take these arguments.
    """
    spinner = Spinner(arguments, None)
    try:
        made = spinner.add(node, "")
        return {name: one.value for name, one in made.get_parameters_by_prefix("").items()}
    finally:
        await spinner.close()
