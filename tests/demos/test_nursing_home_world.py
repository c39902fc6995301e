"""The nursing home's world: its maps are true, and what a story needs can be reached and seen there."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from parley.clock import SimClock
from parley.demos.story import Story
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import CameraImage, NavigationControl
from parley.robots.simulated import SimulatedRobot
from parley.sim.export import export_maps
from parley.sim.simulator import Simulator
from parley.sim.world_file import WorldFile
from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OccupancyMap

FOLDER = Path(str(resources.files("parley.demos") / "nursing_home"))
ROBOT = "David"
QUIETLY = NavigationControl(lambda remaining_m: None, lambda: False)


@dataclass(frozen=True)
class Demo:
    world: WorldFile
    objects: ObjectMap
    occupancy: OccupancyMap
    story: Story


@pytest.fixture(scope="module")
def demo() -> Demo:
    return Demo(
        WorldFile.load(FOLDER / "world.yaml"),
        ObjectMap.load(FOLDER / "object_map.json"),
        OccupancyMap.load(FOLDER / "map.yaml"),
        Story.load(FOLDER / "story.yaml"),
    )


def in_front_of(demo: Demo, name: str) -> Pose2D:
    target = demo.objects.get(name)
    assert target is not None
    pose = approach_pose(demo.occupancy, target, Pose2D(*demo.world.robot(ROBOT).pose), radius_m=0.2)
    assert pose is not None, f"{name} cannot be reached"
    return pose


async def picture_from(demo: Demo, pose: Pose2D, variant: str = "") -> CameraImage:
    world = demo.world.with_changes(demo.story.variant(variant).world)
    world = world.with_changes({"move": {ROBOT: (pose.x_m, pose.y_m, pose.yaw_rad)}})
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        return await SimulatedRobot(simulator, ROBOT, demo.occupancy).image()


def pixels_of(image: CameraImage, label: str) -> int:
    assert image.detections is not None
    return sum(found.pixels for found in image.detections if found.label == label)


def test_its_map_files_are_what_a_survey_of_the_world_gives(demo: Demo, tmp_path: Path) -> None:
    """After a change to world.yaml: `parley.sim.export.export_maps` writes them anew, but for the rooms."""
    export_maps(demo.world, tmp_path)
    assert (FOLDER / "map.yaml").read_text() == (tmp_path / "map.yaml").read_text()
    assert (FOLDER / "map.pgm").read_bytes() == (tmp_path / "map.pgm").read_bytes()
    assert ObjectMap.load(FOLDER / "object_map.json").objects == demo.world.object_map().objects


def test_what_lies_in_the_refrigerator_is_on_no_map(demo: Demo) -> None:
    assert demo.objects.get("water_bottle") is None
    without = demo.world.with_changes({"remove": ["water_bottle"]})
    assert np.array_equal(demo.occupancy.cells, Simulator(without, clock=SimClock()).occupancy(ROBOT).cells)


async def test_everything_on_the_object_map_can_be_reached_and_is_seen_from_there(demo: Demo) -> None:
    async with Simulator(demo.world, clock=SimClock(), speed=None) as simulator:
        for item in demo.objects.objects:
            pose = in_front_of(demo, item.id)
            simulator.change({"move": {ROBOT: (pose.x_m, pose.y_m, pose.yaw_rad)}})
            photograph = await simulator.photograph(ROBOT)
            seen = {sighting.name: sighting.pixels for sighting in photograph.sightings}
            assert seen.get(item.id, 0) > 5000, f"{item.description}: {seen}"


async def test_the_robot_drives_to_the_refrigerators_open_side_and_sees_the_bottle(demo: Demo) -> None:
    async with Simulator(demo.world, clock=SimClock(), speed=None) as simulator:
        robot = SimulatedRobot(simulator, ROBOT, demo.occupancy)
        goal = in_front_of(demo, "refrigerator_1")
        end = await robot.navigate(goal, QUIETLY, timeout_s=120)
        assert end.distance_to(goal) < 0.1
        assert pixels_of(await robot.image(), "water bottle") > 500


@pytest.mark.parametrize("place", ["sofa_large", "sofa_small", "dining_table_1", "tv_1", "bed_1"])
async def test_the_bottle_is_not_seen_from_elsewhere(demo: Demo, place: str) -> None:
    assert pixels_of(await picture_from(demo, in_front_of(demo, place)), "water bottle") == 0


async def test_the_bottle_can_be_missing_or_hidden_by_something_that_is_seen(demo: Demo) -> None:
    pose = in_front_of(demo, "refrigerator_1")
    assert pixels_of(await picture_from(demo, pose, "no_bottle"), "water bottle") == 0
    hidden = await picture_from(demo, pose, "hidden_bottle")
    assert pixels_of(hidden, "water bottle") == 0
    assert pixels_of(hidden, "cardboard box") > 1000


async def test_the_kitchen_can_be_closed_off_by_things_that_no_map_knows(demo: Demo) -> None:
    world = demo.world.with_changes(demo.story.variant("blocked_door").world)
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        robot = SimulatedRobot(simulator, ROBOT, demo.occupancy)
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(in_front_of(demo, "refrigerator_1"), QUIETLY, timeout_s=180)
    assert caught.value.code is FailureCode.BLOCKED
