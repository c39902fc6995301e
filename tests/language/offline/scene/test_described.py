"""Things by whose they are and how they are remembered to be, and by bare labels."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.scene.labels import with_kinds
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.states import all_in_state
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=f"box_{n}", description=f"box {n}", x_m=float(n), y_m=0.0, class_name="box")
    for n in (1, 2, 3)
)
VANS = (
    MapObject(id="van_1", description="green van", x_m=1.0, y_m=5.0, class_name="car"),
    MapObject(id="van_2", description="grey van", x_m=2.0, y_m=5.0, class_name="car"),
)


def scene(*told: str) -> Scene:
    memory = tuple(MemoryEntry(name=f"fact_{i}", data=text) for i, text in enumerate(told))
    return Scene.of(
        Situation(message="", objects=(*MAP, *VANS), memory=memory, robot_pose=Pose2D(9.0, 0.0, 0.0))
    )


def test_a_free_one_is_one_that_nobody_is_said_to_use() -> None:
    known = scene("Box 1 is reserved for Ada", "Box 3 is full")
    assert known.place(tokens("free box")).value == "box 2"


def test_of_several_free_ones_the_nearest_is_taken() -> None:
    assert scene("Box 1 is full").place(tokens("an empty box")).value == "box 3"


def test_the_last_word_on_a_thing_counts() -> None:
    known = scene("Box 3 is full", "Box 2 is full", "Box 3 is empty again")
    assert known.place(tokens("the empty box")).value == "box 3"


def test_all_that_are_not_so_are_found() -> None:
    known = scene("Box 2 is closed")
    found = all_in_state(tokens("every box that is not closed"), known.objects, known.facts)
    assert found is not None
    assert [item.id for item in found[0]] == ["box_1", "box_3"]


@pytest.mark.parametrize(
    "told",
    [
        "The green van belongs to Mr Hill",
        "The green van is Mr Hill's",
        "Mr Hill drives the green van",
        "The green van was sold to Mr Hill",
        "The driver of the green van is called Mr Hill",
        "The green van is reserved for Mr Hill",
    ],
)
def test_whose_something_is_tells_which_it_is(told: str) -> None:
    assert scene(told).place(tokens("Mr Hill's van")).value == "green van"


def test_a_bare_label_gets_the_noun_of_its_kind() -> None:
    assert (
        plain(with_kinds(tokens("check 2 and 3 for cracks"), MAP, ())) == "check box 2 and box 3 for cracks"
    )


@pytest.mark.parametrize("said", ["wait 2 minutes", "check box 2", "check boxes 1 and 2", "go to the lamp"])
def test_numbers_that_are_no_labels_stay_alone(said: str) -> None:
    assert plain(with_kinds(tokens(said), MAP, ())) == said
