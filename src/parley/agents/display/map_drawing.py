"""The map as a picture: floor, things with their names, the robot, its way, what its lidar sees. Pure."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from parley.messages.map import MapView
from parley.world.object_map import MapObject
from parley.world.occupancy import FREE, OCCUPIED, OccupancyMap

__all__ = ["MapPicture"]

LONG_SIDE_PX: Final = 720
"""About how long the longer side of the picture is."""
_FLOOR, _WALL, _UNKNOWN = (250, 250, 247), (58, 64, 72), (205, 207, 210)
_THING, _THING_EDGE, _NAME = (214, 226, 240), (120, 144, 172), (38, 50, 66)
_ROBOT, _WAY, _SCAN = (196, 66, 28), (30, 110, 200), (200, 40, 120)

_HALO = (255, 255, 255)
_NAME_PX, _NAME_CHARACTERS = 14, 18

Point = tuple[float, float]


class MapPicture:
    """Draws one map again and again; what does not move is drawn once.

    Args:
        occupancy: The floor.
        objects: What stands on it.
        robot_radius_m: Of the footprint.
    """

    def __init__(
        self, occupancy: OccupancyMap, objects: Iterable[MapObject], *, robot_radius_m: float
    ) -> None:
        self._map, self._radius_m = occupancy, robot_radius_m
        rows, columns = occupancy.cells.shape
        self._scale = max(1, round(LONG_SIDE_PX / max(rows, columns)))
        """Pixels per cell."""
        self._still = self._draw_still(objects)

    def draw(self, view: MapView) -> Image.Image:
        """The map with one robot on it."""
        picture = self._still.copy()
        pen = ImageDraw.Draw(picture)
        for x, y in view.scan:
            self._dot(pen, (x, y), 2, _SCAN)
        way: list[Point] = [(view.pose.x, view.pose.y), *view.path] if view.path else []
        if len(way) > 1:
            pen.line([self._pixel(*point) for point in way], fill=_WAY, width=4, joint="curve")
            self._dot(pen, way[-1], 7, _WAY)
        self._draw_robot(pen, view)
        return picture

    def _draw_still(self, objects: Iterable[MapObject]) -> Image.Image:
        cells = self._map.cells[::-1]
        colours = np.full((*cells.shape, 3), _UNKNOWN, np.uint8)
        colours[cells == FREE] = _FLOOR
        colours[cells == OCCUPIED] = _WALL
        rows, columns = cells.shape
        size = (columns * self._scale, rows * self._scale)
        picture = Image.fromarray(colours).resize(size, Image.Resampling.NEAREST)
        pen = ImageDraw.Draw(picture)
        things = list(objects)
        for thing in things:
            pen.rectangle(self._box(thing), fill=_THING, outline=_THING_EDGE, width=2)
        self._write_names(pen, things)
        return picture

    def _write_names(self, pen: ImageDraw.ImageDraw, things: Sequence[MapObject]) -> None:
        """Largest thing first; a name that would cover another one is shortened to the kind, or left out."""
        font = ImageFont.load_default(_NAME_PX)
        written: list[tuple[float, float, float, float]] = []
        for thing in sorted(things, key=lambda item: -item.width_m * item.height_m):
            for name in (textwrap.fill(thing.description, _NAME_CHARACTERS), thing.class_name):
                at = self._within_picture(pen, self._pixel(thing.x_m, thing.y_m), name, font)
                box = pen.multiline_textbbox(at, name, font, anchor="mm", align="center")
                if name and not any(_overlap(box, other) for other in written):
                    written.append(box)
                    pen.multiline_text(
                        at, name, _NAME, font, anchor="mm", align="center", stroke_width=2, stroke_fill=_HALO
                    )
                    break

    def _within_picture(
        self,
        pen: ImageDraw.ImageDraw,
        at: Point,
        name: str,
        font: ImageFont.FreeTypeFont | ImageFont.ImageFont,
    ) -> Point:
        left, _, right, _ = pen.multiline_textbbox(at, name, font, anchor="mm", align="center")
        width = self._map.cells.shape[1] * self._scale
        return at[0] + max(0.0, 4 - left) - max(0.0, right + 4 - width), at[1]

    def _draw_robot(self, pen: ImageDraw.ImageDraw, view: MapView) -> None:
        """An arrowhead that points where the robot looks, at least large enough to be seen."""
        x, y = self._pixel(view.pose.x, view.pose.y)
        radius = max(self._radius_m / self._map.resolution_m * self._scale, 9.0)
        corners = [
            (
                x + radius * length * math.cos(view.pose.yaw + turn),
                y - radius * length * math.sin(view.pose.yaw + turn),
            )
            for turn, length in ((0.0, 1.4), (2.5, 1.0), (math.pi, 0.4), (-2.5, 1.0))
        ]
        pen.polygon(corners, fill=_ROBOT, outline=(255, 255, 255), width=2)

    def _dot(self, pen: ImageDraw.ImageDraw, at: Point, radius_px: int, colour: tuple[int, int, int]) -> None:
        x, y = self._pixel(*at)
        pen.ellipse((x - radius_px, y - radius_px, x + radius_px, y + radius_px), fill=colour)

    def _box(self, thing: MapObject) -> tuple[Point, Point]:
        half_x, half_y = thing.width_m / 2, thing.height_m / 2
        return (
            self._pixel(thing.x_m - half_x, thing.y_m + half_y),
            self._pixel(thing.x_m + half_x, thing.y_m - half_y),
        )

    def _pixel(self, x_m: float, y_m: float) -> Point:
        left, _, _, top = self._map.bounds_m
        per_m = self._scale / self._map.resolution_m
        return (x_m - left) * per_m, (top - y_m) * per_m


def _overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
