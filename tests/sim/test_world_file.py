"""Worlds from YAML and changes to them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from parley.errors import FileFormatError
from parley.sim.entries import Doorway, RobotState, Thing, Wall
from parley.sim.robot_model import PRESETS
from parley.sim.world_file import WorldChanges, WorldFile
from tests.sim.worlds import TWO_ROOMS, box, two_rooms


def test_a_world_is_read_with_its_walls_things_and_robots() -> None:
    world = WorldFile.parse(TWO_ROOMS)
    assert world.name == "two rooms"
    assert len(world.walls) == 5
    assert world.thing("crate_1").words == "green crate"
    assert world.robot("A").model == PRESETS["turtlebot3_waffle"]


def test_a_robot_may_be_described_instead_of_named() -> None:
    model = "{radius_m: 0.3, height_m: 1.1, max_speed_mps: 1.0, max_turn_radps: 2.0, camera: null}"
    world = WorldFile.parse(TWO_ROOMS.replace("turtlebot3_waffle", model))
    assert world.robot("A").model.height_m == 1.1
    assert world.robot("A").model.camera is None


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("name: two rooms", "title: two rooms", "name"),
        ("name: two rooms", "name: two rooms\nsky: blue", "sky"),
        ("to: [6, 0]", "to: [6]", "walls[0].to[1]"),
        ("to: [6, 0]", "to: [0, 0]", "walls[0].to"),
        ("{at_m: 1.0}", "{at_m: -1.0}", "walls[4].doorways[0].at_m"),
        ("{at_m: 3.0}", "{at_m: 3.9}", "walls[4].doorways[1].at_m"),
        ("colour: green", "colour: greenish", "things[0].parts[0].colour"),
        ("size_m: [0.5, 0.5, 0.5]", "size_m: [0.5, 0.5, 0]", "things[0].parts[0].size_m[2]"),
        ("size_m: [0.5, 0.5, 0.5]", "size_m: [0.5, .inf, 0.5]", "things[0].parts[0].size_m[1]"),
        ("size_m: [0.5, 0.5, 0.5]", "shape: cylinder, size_m: [0.5, 0.4, 0.5]", "things[0].parts[0].size_m"),
        ("pose: [5.2, 2.0, 0.0]", "pose: [5.2, 2.0]", "things[0].pose[2]"),
        ("pose: [5.2, 2.0, 0.0]", "pose: [5.2, 2.0, 0.0]\n    inside: crate_2", "things[0].inside"),
        ("pose: [5.2, 2.0, 0.0]", "pose: [5.2, 2.0, 0.0]\n    inside: crate_1", "things[0].inside"),
        ("model: turtlebot3_waffle", "model: unicorn", "robots[0].model"),
        ("name: A", "name: crate_1", "robots[0].name"),
        ("name: A", "name: ''", "robots[0].name"),
        ("pose: [1.0, 1.0, 0.0]", "pose: [2.8, 2.0, 0.0]", "robots[0].pose"),
        ("pose: [1.0, 1.0, 0.0]", "pose: [5.2, 2.4, 0.0]", "robots[0].pose"),
        ("things:", "things: [", ""),
    ],
)
def test_a_malformed_world_is_refused_with_file_and_field(old: str, new: str, field: str) -> None:
    assert old in TWO_ROOMS
    with pytest.raises(FileFormatError) as caught:
        WorldFile.parse(TWO_ROOMS.replace(old, new, 1), file="world.yaml")
    assert (caught.value.file, caught.value.field) == ("world.yaml", field)


STANDBY = "standby:\n  - {name: B, model: turtlebot3_waffle, pose: [1.0, 3.0, 0.0]}\n"


def test_robots_that_stand_by_are_in_the_world_where_they_are_wanted() -> None:
    world = WorldFile.parse(TWO_ROOMS + STANDBY)
    assert [robot.name for robot in world.robots] == ["A"]
    assert [robot.name for robot in world.with_robots(("B", "A")).robots] == ["A", "B"]
    alone = world.with_robots(("B",))
    assert [robot.name for robot in alone.robots] == ["B"]
    assert alone.with_robots(("A", "B")).robot("A") == world.robot("A")
    for names in ((), ("A", "C")):
        with pytest.raises(FileFormatError):
            world.with_robots(names)


def test_an_event_about_a_robot_that_is_left_out_is_refused() -> None:
    near = "near: {thing: crate_1, robot: A, within_m: 1.0}"
    world = WorldFile.parse(
        f"{TWO_ROOMS}{STANDBY}events:\n  - {{name: e, {near}, change: {{remove: [crate_1]}}}}\n"
    )
    with pytest.raises(FileFormatError, match="no robot 'A'"):
        world.with_robots(("B",))


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [("name: B", "name: A", "standby[0].name"), ("[1.0, 3.0, 0.0]", "[5.2, 2.4, 0.0]", "standby[0].pose")],
)
def test_a_robot_that_stands_by_is_checked_like_the_others(old: str, new: str, field: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        WorldFile.parse(TWO_ROOMS + STANDBY.replace(old, new), file="world.yaml")
    assert caught.value.field == field


def test_an_unknown_robot_model_is_answered_with_the_known_ones() -> None:
    with pytest.raises(FileFormatError, match=r"known: .*turtlebot3_waffle"):
        WorldFile.parse(TWO_ROOMS.replace("turtlebot3_waffle", "unicorn"))


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"gone\.yaml: cannot be read"):
        WorldFile.load(tmp_path / "gone.yaml")
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(FileFormatError, match=r"binary\.yaml: is not UTF-8"):
        WorldFile.load(tmp_path / "binary.yaml")


def test_doorways_leave_the_rest_of_the_wall_standing() -> None:
    wall = Wall(
        start=(0, 0),
        end=(4, 0),
        thickness_m=0.2,
        doorways=(Doorway(at_m=3.0, width_m=1.0), Doorway(at_m=1.0)),
    )
    spans = [(solid.extent_m()[0], solid.extent_m()[2]) for solid in wall.solids()]
    assert spans == [
        pytest.approx((-0.1, 0.55)), pytest.approx((1.45, 2.5)), pytest.approx((3.5, 4.1))
    ]  # fmt: skip


def test_the_object_map_holds_the_bounding_box_of_all_parts_and_the_front() -> None:
    thing = Thing.model_validate(
        {
            "name": "case_1", "class": "case", "description": "open case", "aliases": ["chest"],
            "pose": (2.0, 1.0, math.pi / 2), "front_rad": 0.0,
            "parts": [{"size_m": (0.4, 1.0, 0.5)}, {"size_m": (0.2, 0.2, 0.2), "at_m": (0.3, 0, 0)}],
        }
    )  # fmt: skip
    entry = two_rooms().model_copy(update={"things": (thing,)}).object_map().get("case_1")
    assert entry is not None
    assert (entry.width_m, entry.height_m) == (1.0, 0.6)
    assert (entry.x_m, entry.y_m) == (2.0, 1.1)
    assert entry.front_rad == pytest.approx(math.pi / 2, abs=1e-3)
    assert (entry.class_name, entry.description, entry.aliases) == ("case", "open case", ("chest",))


def test_things_that_are_not_listed_stay_off_the_object_map() -> None:
    world = two_rooms({"add": [box("secret", 1.0, 3.0)]})
    assert [item.id for item in world.object_map().objects] == ["crate_1"]


def test_what_stands_inside_something_moves_and_disappears_with_it() -> None:
    inner = box("ball_1", 0.1, 0.2, (0.1, 0.1, 0.1), inside="crate_1")
    nested = box("bead_1", 0.1, 0.0, (0.1, 0.1, 0.1), inside="ball_1")
    world = two_rooms({"add": [inner, nested]})
    moved = world.with_changes({"move": {"crate_1": (1.0, 3.0, math.pi / 2)}})
    base = moved.base_of(moved.thing("bead_1"))
    assert (base.x_m, base.y_m, base.yaw_rad) == pytest.approx((0.8, 3.2, math.pi / 2))
    assert world.with_changes({"remove": ["crate_1"]}).things == ()


def test_changes_leave_the_world_they_are_made_from_as_it_was() -> None:
    world = two_rooms()
    changed = world.with_changes(
        WorldChanges(
            remove=("crate_1",), move={"A": (2.0, 2.0, 1.0)}, robots={"A": RobotState(camera="broken")}
        )
    )
    assert (changed.things, changed.robot("A").pose, changed.robot("A").camera) == (
        (),
        (2.0, 2.0, 1.0),
        "broken",
    )
    assert world == two_rooms()


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"remove": ["crate_2"]}, "remove.crate_2"),
        ({"remove": ["A"]}, "remove.A"),
        ({"move": {"B": (0, 0, 0)}}, "move.B"),
        ({"move": {"A": (0, 0)}}, "move.A[2]"),
        ({"robots": {"crate_1": {"camera": "broken"}}}, "robots.crate_1"),
        ({"robots": {"A": {"camera": "tired"}}}, "robots.A.camera"),
        ({"destroy": ["crate_1"]}, "destroy"),
        ({"add": [box("crate_1", 1, 1)]}, "things[1].name"),
        ({"add": [box("b", 1, 1, inside="nothing")]}, "things[1].inside"),
    ],
)
def test_changes_that_make_no_sense_are_refused_with_the_field(changes: dict[str, Any], field: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        two_rooms().with_changes(changes, file="changes.yaml")
    assert (caught.value.file, caught.value.field) == ("changes.yaml", field)


@pytest.mark.parametrize("name", ["crate_9", "B"])
def test_asking_for_what_is_not_there_raises(name: str) -> None:
    with pytest.raises(KeyError):
        two_rooms().thing(name)
    with pytest.raises(KeyError):
        two_rooms().robot(name)
