"""Another seed is another run: other starts, other noise, other ways; and every story holds in it."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path

import pytest

from parley.clock import SimClock
from parley.demos.catalogue import DEMOS, demo_folder, load_demo
from parley.demos.story import Story
from parley.gate.book import RuleBook
from parley.robots.base import NavigationControl
from parley.robots.simulated import SimulatedFleet
from parley.sim.starts import started
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D
from tests.demos.house import played
from tests.sim.worlds import box, two_rooms

Way = list[tuple[float, float]]


async def driven(seed: int, world: WorldFile | None = None, goal: tuple[float, float] = (4.5, 3.2)) -> Way:
    """Where the first robot is, each time that its way changes; by itself from one room into another."""
    way: Way = []
    world = world or two_rooms()
    async with SimulatedFleet(world, speed=None, seed=seed) as fleet:
        robot = fleet.robot(world.robots[0].name, RuleBook(SimClock()))

        def here(_: float) -> None:
            way.append((robot.pose().x_m, robot.pose().y_m))

        await robot.navigate(Pose2D(*goal), NavigationControl(here, lambda: False), timeout_s=120)
    return way


async def test_seeds_drive_other_ways_and_the_same_seed_the_same_again() -> None:
    ways = [await driven(seed) for seed in (0, 1, 2, 1)]
    assert ways[1] == ways[3]
    for one, other in itertools.combinations(ways[:3], 2):
        assert max(map(math.dist, one, other)) > 0.05
    assert all(math.dist(way[-1], (4.5, 3.2)) < 0.1 for way in ways)


@pytest.mark.parametrize(
    ("name", "goal"), [("nursing-home", (1.2, 5.7)), ("parking", (3.4, 10.0)), ("warehouse", (11.4, 11.2))]
)
async def test_in_the_world_of_each_story_seeds_drive_other_ways(
    name: str, goal: tuple[float, float]
) -> None:
    world = load_demo(name).world
    ways = [await driven(seed, world, goal) for seed in (1, 2)]
    assert max(map(math.dist, *ways)) > 0.05
    assert all(math.dist(way[-1], goal) < 0.2 for way in ways)


@pytest.mark.parametrize("seed", range(1, 6))
def test_a_robot_begins_elsewhere_but_never_in_something(seed: int) -> None:
    walled_in = two_rooms({"add": [box("left", 1.0, 1.75)]})
    begun = started(walled_in, seed)
    assert begun.robots[0].pose != walled_in.robots[0].pose
    assert not begun.in_the_way(begun.robots[0])
    narrow = two_rooms({"add": [box("left", 1.0, 1.57), box("right", 1.0, 0.43)]})
    assert started(narrow, seed) == narrow


def test_a_robot_may_begin_on_paint() -> None:
    paint = {"name": "bay", "pose": [1, 1, 0], "parts": [{"size_m": [2, 2, 0.004]}]}
    text = two_rooms({"add": [paint]}).model_dump_json(by_alias=True)
    assert WorldFile.parse(text).robots[0].pose == (1.0, 1.0, 0.0)


@pytest.mark.parametrize(
    ("name", "variant", "seed"),
    [("nursing-home", "other_words", 7), ("nursing-home", "more_words", 2), ("fleet", "more_words", 1)],
)
async def test_story_holds_in_other_words_and_with_another_seed(
    name: str, variant: str, seed: int, tmp_path: Path
) -> None:
    """Those of the other demonstrations are played with two seeds beside their own tests."""
    assert (await played(load_demo(name), tmp_path, variant, seed))[0] == ""


@pytest.mark.parametrize(("variant", "seed"), [("in_two_orders", 3), ("no_bottle", 0)])
async def test_a_robot_with_an_arm_really_brings_the_water(variant: str, seed: int, tmp_path: Path) -> None:
    story = Story.load(demo_folder("nursing-home") / "with_arm.yaml")
    reason, _, system = await played(replace(load_demo("nursing-home"), told=story), tmp_path, variant, seed)
    assert reason.partition(":")[0] == story.variant(variant).fails
    carried = [thing.held_by for thing in system.simulator.world.things if thing.held_by]
    assert carried == []


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(10, 20))
@pytest.mark.parametrize("name", DEMOS)
async def test_story_holds_with_every_seed(name: str, seed: int, tmp_path: Path) -> None:
    variant = ("", "other_words", "more_words")[seed % 3]
    assert (await played(load_demo(name), tmp_path, variant, seed))[0] == ""


async def test_a_look_somewhere_else_is_none_and_a_plan_that_ended_is_not_waited_for(tmp_path: Path) -> None:
    """The right words, and the wrong place."""
    demo = load_demo("fleet")
    for expected, reason in (
        ({"looked": {"at": ["area_b"]}}, "not_looked"),
        ({"state": "held"}, "other_state"),
    ):
        story = Story.model_validate({"robot": "Leo", "steps": [{"say": "Check Area A."}, expected]})
        assert (await played(replace(demo, told=story), tmp_path))[0].partition(":")[0] == reason


async def test_a_robot_that_has_nothing_to_do_is_not_waited_for(tmp_path: Path) -> None:
    steps = [{"say": "Where are you?"}, {"robot": "TIAGo", "told": ["so I begin"]}]
    told = Story.model_validate({"robot": "Leo", "steps": steps})
    result = await played(replace(load_demo("fleet"), told=told), tmp_path)
    assert result[0].partition(":")[0] == "not_told"
