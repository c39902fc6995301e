"""A picture of a whole place, put together of several where one does not hold it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from parley.robots.base import CameraImage, Detection, Robot
from parley.world.object_map import MapObject
from parley.world.whereabouts import Place, bearings

__all__ = ["View", "view"]

_SAME_M: Final = 0.6
"""What two pictures show so near to each other is the same, if it is called the same."""
_ON_IT_M: Final = 0.3
_RIM: Final = 0.95
"""Share of a picture's opening that counts: things at its rim are cut."""


@dataclass(frozen=True, slots=True)
class View:
    """What a robot sees of a place."""

    image: CameraImage
    """From left to right, where it is put together."""
    is_whole: bool = True
    """Whether all of the place is in it, as far as that is known."""


async def view(robot: Robot, place: Place | None) -> View:
    """A picture of what is in front, or of all of a place.

    Args:
        robot: Who looks.
        place: What is to be in it; None: whatever is in front.

    Raises:
        ActionFailure: `hardware` if the camera gives none, `not_capable` if there is no camera.
    """
    sight = robot.sight
    if place is None or sight is None:
        return View(await robot.image())
    if isinstance(place, MapObject) and place.gap_m(robot.pose().x_m, robot.pose().y_m) < _ON_IT_M:
        return View(await robot.image(), False)  # it is all around
    low, high = bearings(robot.pose(), place)
    half = sight.fov_rad / 2 * _RIM
    if -half <= low and high <= half:
        return View(await robot.image())
    if not sight.aside_rad:
        return View(await robot.image(), False)
    return await _around(robot, place, (low, high), half, sight.aside_rad)


async def _around(
    robot: Robot, place: Place, span: tuple[float, float], half_rad: float, reach_rad: float
) -> View:
    """Several pictures side by side, as many as a place needs and the camera can turn to."""
    low, high = span
    count = math.ceil((high - low) / (2 * half_rad))
    middles = [high - (at + 0.5) * (high - low) / count for at in range(count)]
    turned = list(dict.fromkeys(min(max(middle, -reach_rad), reach_rad) for middle in middles))
    pictures = [await robot.look(aside_rad) for aside_rad in turned]
    whole = high <= turned[0] + half_rad + 1e-9 and low >= turned[-1] - half_rad - 1e-9
    return View(_side_by_side(pictures), whole)


def _side_by_side(pictures: list[CameraImage]) -> CameraImage:
    found: list[Detection] | None = None
    left = 0
    for picture in pictures:
        for one in picture.detections or ():
            shifted = replace(one, box=(one.box[0] + left, one.box[1], one.box[2] + left, one.box[3]))
            found = _joined(found or [], shifted)
        found = found if picture.detections is None else found or []
        left += picture.width
    seen = None if found is None else tuple(sorted(found, key=lambda one: -one.pixels))
    pixels = np.concatenate([picture.data for picture in pictures], axis=1)
    return replace(pictures[0], width=left, data=pixels, detections=seen)


def _joined(found: list[Detection], new: Detection) -> list[Detection]:
    """With one more, or with what was seen of the same thing in the picture before put together."""
    for at, old in enumerate(found):
        if old.label == new.label and _is_same(old, new):
            return [*found[:at], _both(old, new), *found[at + 1 :]]
    return [*found, new]


def _is_same(one: Detection, other: Detection) -> bool:
    if one.x_m is None or one.y_m is None or other.x_m is None or other.y_m is None:
        return False
    gaps = [
        abs(here - there) - (one.span_m[axis] + other.span_m[axis]) / 2
        for axis, (here, there) in enumerate(((one.x_m, other.x_m), (one.y_m, other.y_m)))
    ]
    return max(gaps) <= _SAME_M


def _both(one: Detection, other: Detection) -> Detection:
    assert None not in (one.x_m, one.y_m, other.x_m, other.y_m)
    ends = [
        (min(a - s / 2, b - t / 2), max(a + s / 2, b + t / 2))
        for a, s, b, t in (
            (one.x_m or 0.0, one.span_m[0], other.x_m or 0.0, other.span_m[0]),
            (one.y_m or 0.0, one.span_m[1], other.y_m or 0.0, other.span_m[1]),
        )
    ]
    larger = max(one, other, key=lambda detection: detection.pixels)
    (x_low, x_high), (y_low, y_high) = ends
    span = (round(x_high - x_low, 3), round(y_high - y_low, 3))
    return replace(larger, x_m=(x_low + x_high) / 2, y_m=(y_low + y_high) / 2, span_m=span)
