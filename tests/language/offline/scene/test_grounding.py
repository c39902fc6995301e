"""Which object a description means."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.language.offline.scene.grounding import ground
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

OBJECTS = (
    MapObject("sofa_1", "small sofa", 1, 1, "sofa"),
    MapObject("sofa_2", "large sofa", 6, 1, "sofa"),
    MapObject("fridge_1", "refrigerator", 0, 5, "refrigerator", aliases=("cold box",)),
    MapObject("plant_1", "plant near the TV", 3, 4, "plant"),
    MapObject("plant_2", "tall plant", 7, 2, "plant"),
    MapObject("tv_1", "TV", 3, 4.5, "tv"),
    MapObject("area_a", "area A", 10, 0, "area", 2, 2),
    MapObject("area_b", "area B", 14, 0, "area", 2, 2),
    MapObject("pallet_1", "pallet", 10.3, 0.2, "pallet"),
    MapObject("pallet_2", "pallet", 14.3, 0.2, "pallet"),
    MapObject("ws", "workstation", 5, 9, "workstation"),
    MapObject("box_1", "green package", 8, 9, "package", 0.2, 0.2),
    MapObject("box_2", "package", 2, 9, "package", 0.8, 0.8),
)


@pytest.mark.parametrize(
    ("description", "expected"),
    [
        ("the small sofa", "sofa_1"),
        ("little couch", "sofa_1"),
        ("fridge", "fridge_1"),
        ("cold box", "fridge_1"),
        ("sofa_2", "sofa_2"),
        ("the television", "tv_1"),
        ("plant near the television", "plant_1"),
        ("the plant by the large sofa", "plant_2"),
        ("area a", "area_a"),
        ("Area B", "area_b"),
        ("in front of the workstation", "ws"),
        ("next to the green package", "box_1"),
        ("work station", "ws"),
        ("the pallet in area B", "pallet_2"),
        ("pallet 1", "pallet_1"),
        ("the second pallet", "pallet_2"),
        ("smal sofa", "sofa_1"),
        ("refridgerator", "fridge_1"),
        ("the tall one", "plant_2"),
        ("the sofa on the left of the tall plant", "sofa_1"),
        ("nearest pallet", "pallet_1"),
        ("the package", "box_2"),
    ],
)
def test_a_description_finds_its_object(description: str, expected: str) -> None:
    found = ground(description, OBJECTS, Pose2D(3, 1))
    assert (found.outcome, [item.id for item in found.candidates]) == ("match", [expected])


@pytest.mark.parametrize(
    ("description", "expected"),
    [("sofa", {"sofa_1", "sofa_2"}), ("the plants", {"plant_1", "plant_2"}), ("area", {"area_a", "area_b"})],
)
def test_equals_are_ambiguous(description: str, expected: set[str]) -> None:
    found = ground(description, OBJECTS)
    assert (found.outcome, {item.id for item in found.candidates}) == ("ambiguous", expected)


@pytest.mark.parametrize("description", ["elephant", "area C", "blue sofa", "", "the", "stop", "sofa 3"])
def test_nothing_is_found_for_what_is_not_there(description: str) -> None:
    assert ground(description, OBJECTS).outcome == "none"


def test_near_misses_are_named() -> None:
    assert {item.id for item in ground("blue sofa", OBJECTS).candidates} == {"sofa_1", "sofa_2"}


def test_sizes_on_the_map_tell_where_words_do_not() -> None:
    chairs = (
        MapObject("a", "chair", 0, 0, "chair", 0.4, 0.4),
        MapObject("b", "chair", 1, 0, "chair", 0.9, 0.9),
    )
    assert [item.id for item in ground("the big chair", chairs).candidates] == ["b"]
    assert [item.id for item in ground("the smallest chair", chairs).candidates] == ["a"]


def test_an_empty_map_has_nothing() -> None:
    assert ground("chair", ()).outcome == "none"


NOUNS = st.text("bdfgklmnprstvw", min_size=2, max_size=3).map(
    lambda letters: "".join(c + "o" for c in letters) + "x"
)


@given(st.lists(NOUNS, min_size=1, max_size=6, unique=True), st.data())
def test_every_object_is_found_by_its_own_words(nouns: list[str], data: st.DataObject) -> None:
    objects = [MapObject(f"id-{'i' * index}", noun, index, 0.0, noun) for index, noun in enumerate(nouns)]
    wanted = data.draw(st.sampled_from(objects))
    assert ground(f"the {wanted.description}", objects).candidates == (wanted,)
