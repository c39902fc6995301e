"""The ray-cast camera and what its detector reports."""

from __future__ import annotations

import math

import numpy as np
import pytest

from parley.clock import SimClock
from parley.sim.camera import Sighting
from parley.sim.simulator import Photograph, Simulator
from tests.sim.worlds import box, two_rooms


async def look(*things: dict[str, object], pose: tuple[float, float, float] = (1.0, 2.0, 0.0)) -> Photograph:
    world = two_rooms({"add": list(things), "move": {"A": pose}})
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        return await simulator.photograph("A")


def sighting(photograph: Photograph, name: str) -> Sighting | None:
    return next((seen for seen in photograph.sightings if seen.name == name), None)


CAN = box(
    "can", 1.8, 2.0, (0.1, 0.1, 0.3), label="red can", parts=[{"size_m": (0.1, 0.1, 0.3), "colour": "red"}]
)


async def test_a_thing_ahead_is_seen_where_it_stands() -> None:
    photograph = await look(CAN)
    seen = sighting(photograph, "can")
    assert seen is not None
    assert seen.label == "red can"
    assert seen.distance_m == pytest.approx(1.8 - 0.05 - 1.08, abs=0.03)
    left, top, right, bottom = seen.box
    assert (left + right) / 2 == pytest.approx(160, abs=2)
    assert seen.pixels == pytest.approx((right - left) * (bottom - top), rel=0.05)


async def test_its_pixels_have_its_colour() -> None:
    photograph = await look(CAN)
    seen = sighting(photograph, "can")
    assert seen is not None
    left, top, right, bottom = seen.box
    red, green, blue = photograph.frame.rgb[top:bottom, left:right].reshape(-1, 3).mean(axis=0)
    assert red > 120
    assert max(green, blue) < 10


async def test_left_in_the_world_is_left_in_the_picture() -> None:
    photograph = await look(CAN | {"pose": (1.8, 2.2, 0.0)})
    seen = sighting(photograph, "can")
    assert seen is not None
    assert seen.box[2] < 160


async def test_the_floor_is_below_and_the_wall_ahead_above() -> None:
    photograph = await look()
    ids = photograph.frame.body_ids
    assert ids[-1, 160] == 0
    assert ids[100, 160] > 0
    assert photograph.sightings == ()  # walls and floor are not worth reporting


async def test_what_stands_behind_something_is_not_seen() -> None:
    screen = box("screen", 1.5, 2.0, (0.05, 0.6, 0.6))
    photograph = await look(CAN, screen)
    assert sighting(photograph, "screen") is not None
    assert sighting(photograph, "can") is None


async def test_what_is_behind_the_robot_is_not_seen() -> None:
    assert sighting(await look(CAN, pose=(1.0, 2.0, math.pi)), "can") is None


async def test_what_covers_a_few_pixels_only_is_not_reported() -> None:
    crumb = box("crumb", 2.8, 2.0, (0.01, 0.01, 0.01))
    assert sighting(await look(crumb), "crumb") is None


async def test_robots_see_each_other_but_not_themselves() -> None:
    world = two_rooms({"remove": ["crate_1"]})
    other = world.robot("A").model_copy(update={"name": "B", "pose": (2.0, 1.0, 0.0)})
    world = world.model_copy(update={"robots": (*world.robots, other)})
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        photograph = await simulator.photograph("A")
    assert [seen.label for seen in photograph.sightings] == ["robot B"]


async def test_the_view_from_above_shows_the_whole_world_north_up() -> None:
    async with Simulator(two_rooms(), clock=SimClock(), speed=None) as simulator:
        picture = await simulator.top_down(width_px=130)
    height, width, _ = picture.shape
    assert width == 130
    assert height == pytest.approx(90, abs=3)
    # The crate (5.2, 2.0) is the greenest thing there is.
    greenness = picture[..., 1].astype(int) - picture[..., 0]
    row, column = np.unravel_index(int(greenness.argmax()), greenness.shape)
    assert column == pytest.approx((5.2 + 0.25) / 6.5 * width, abs=8)
    assert row == pytest.approx((4.25 - 2.0) / 4.5 * height, abs=8)
