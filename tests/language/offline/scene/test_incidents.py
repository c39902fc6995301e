"""What people report so that somebody has a look."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.scene.incidents import happened
from parley.language.offline.scene.missing import left_by_somebody
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="room_1", description="store room", x_m=1.0, y_m=1.0, class_name="room"),
    MapObject(id="door_1", description="side door", x_m=4.0, y_m=1.0, class_name="door"),
)


def order_of(said: str) -> str:
    found = happened(
        tokens(said), Scene.of(Situation(message=said, objects=MAP, catalogue=CATALOGUES["thesis"]))
    )
    return "" if found is None else plain(found)


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("I hear strange noises from the store room", "inspect the store room for strange noises"),
        (
            "somebody has just rung to say that water is dripping in the store room",
            "inspect the store room for water",
        ),
        ("the box never arrived in the store room", "inspect the store room for the box"),
        ("something toppled over in the store room", "inspect the store room"),
        ("I think I left my coat in the store room", "inspect the store room for my coat"),
        ("the side door has come loose", "inspect the side door"),
        ("smoke in the store room", "inspect the store room for smoke"),
        ("the store room is full of smoke", "inspect the store room for smoke"),
        ("the camera in the store room went dark", "inspect the store room for camera"),
        ("some fool has driven a cart into the side door", "inspect the side door for cart"),
        ("a leak was reported in the store room", "inspect the store room for leak"),
        ("the keys have disappeared from the store room", "inspect the store room for the keys"),
        ("the alarm in the store room is going off and nobody is there", "inspect the store room for alarm"),
        ("I can not find the ladder", "look for the ladder"),
    ],
)
def test_a_report_is_an_order_to_have_a_look(said: str, order: str) -> None:
    assert order_of(said) == order


@pytest.mark.parametrize(
    "said",
    [
        "the side door is broken",
        "a man is cleaning the side door with water",
        "nothing is burning in the store room",
        "I have been running around in the store room",
        "the store room looks nice",
        "yesterday something fell in the store room",
        "Ada is in the store room",
    ],
)
def test_what_is_so_or_was_so_is_no_report(said: str) -> None:
    assert order_of(said) == ""


def test_how_something_seems_is_a_report_only_by_itself() -> None:
    scene = Scene.of(Situation(message="", objects=MAP, catalogue=CATALOGUES["thesis"]))
    words = tokens("the side door looks crooked")
    assert happened(words, scene, alone=True) is not None
    assert happened(words, scene, alone=False) is None


def test_what_somebody_put_somewhere_is_looked_for_there() -> None:
    scene = Scene.of(Situation(message="", objects=MAP, catalogue=CATALOGUES["thesis"]))
    found = left_by_somebody(tokens("somebody put a bag in the store room"), scene)
    assert found is not None
    assert plain(found) == "inspect the store room for a bag"
    assert left_by_somebody(tokens("somebody put the bag in the store room"), scene) is None
