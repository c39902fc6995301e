"""Small worlds for tests."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from parley.sim.world_file import WorldFile

__all__ = ["box", "two_rooms"]

TWO_ROOMS = """
name: two rooms
walls:
  - {from: [0, 0], to: [6, 0]}
  - {from: [6, 0], to: [6, 4]}
  - {from: [6, 4], to: [0, 4]}
  - {from: [0, 4], to: [0, 0]}
  - {from: [3, 0], to: [3, 4], doorways: [{at_m: 1.0}, {at_m: 3.0}]}
things:
  - name: crate_1
    class: crate
    description: green crate
    pose: [5.2, 2.0, 0.0]
    parts: [{size_m: [0.5, 0.5, 0.5], colour: green}]
robots:
  - {name: A, model: turtlebot3_waffle, pose: [1.0, 1.0, 0.0]}
"""


def two_rooms(changes: Mapping[str, Any] | None = None) -> WorldFile:
    """6 x 4 m, a wall at x = 3 with doorways at y = 1 and y = 3, robot "A" west of it, a crate east."""
    return WorldFile.parse(TWO_ROOMS).with_changes(changes or {})


def box(
    name: str, x: float, y: float, size_m: tuple[float, float, float] = (0.7, 0.7, 0.7), **more: Any
) -> dict[str, Any]:
    """A box that nobody knows of, as one of the things to `add`."""
    return {
        "name": name,
        "pose": (x, y, 0.0),
        "parts": [{"size_m": size_m, "colour": "saddlebrown"}],
        "mapped": False,
        "listed": False,
    } | more
