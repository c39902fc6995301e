"""A look at a place takes in all of it, as far as the camera can be turned."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from parley.actions.looking import View, view
from parley.clock import SimClock
from parley.robots.simulated import SimulatedRobot
from parley.sim.simulator import Simulator
from parley.sim.world_file import WorldFile
from parley.world.object_map import MapObject
from tests.sim.worlds import TWO_ROOMS, box

BAY = MapObject("bay", "bay", 2.0, 1.0, "area", width_m=1.0, height_m=2.4)
"""Before the robot, wider than one picture."""


@asynccontextmanager
async def seen(model: str, *things: dict[str, Any]) -> AsyncIterator[View]:
    world = WorldFile.parse(TWO_ROOMS.replace("turtlebot3_waffle", model)).with_changes({"add": [*things]})
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        robot = SimulatedRobot(simulator, "A", simulator.occupancy("A"))
        yield await view(robot, BAY)


async def test_what_stands_at_the_rim_of_a_place_is_seen_by_turning_the_camera() -> None:
    async with seen("tiago", box("parcel", 1.7, 2.0, (0.2, 0.2, 0.3))) as looked:
        (parcel,) = (one for one in looked.image.detections or () if one.label == "parcel")
        assert looked.is_whole
        assert math.dist((parcel.x_m or 0, parcel.y_m or 0), (1.7, 2.0)) < 0.2
        assert parcel.box[2] <= looked.image.width == looked.image.data.shape[1]


async def test_what_only_looks_ahead_does_not_see_it_and_knows_that() -> None:
    async with seen("turtlebot3_waffle", box("parcel", 1.7, 2.0, (0.2, 0.2, 0.3))) as looked:
        assert "parcel" not in [one.label for one in looked.image.detections or ()]
        assert not looked.is_whole


async def test_what_stands_in_two_pictures_is_one_thing() -> None:
    async with seen("tiago", box("beam", 2.3, 1.0, (0.2, 2.2, 0.3))) as looked:
        (beam,) = (one for one in looked.image.detections or () if one.label == "beam")
        assert looked.image.width > 320
        assert beam.span_m[1] > 2.0
