"""Names of the map that are ordinary words too."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.language.offline.words.proper import Proper, unmarked
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject
from tests.language.dev_set import plan

OBJECTS = (
    MapObject("p1", "pumping station 1", 4.0, 1.0, "station"),
    MapObject("p2", "pumping station 2", 8.0, 1.0, "station"),
    MapObject("wait", "waiting room", 2.0, 6.0, "room"),
    MapObject("hoist_a", "hoist A", 6.0, 6.0, "hoist"),
    MapObject("hoist_b", "hoist B", 9.0, 6.0, "hoist"),
    MapObject("press_2", "stamping press 2", 1.0, 9.0, "press"),
    MapObject("lost", "lost and found", 5.0, 9.0, "office"),
    MapObject("bench", "bench by the wall", 7.0, 9.0, "bench"),
)
KNOWN = Situation(
    message="",
    objects=OBJECTS,
    robot="Fern",
    robots=("Fern",),
    memory=(MemoryEntry(name="key", data="The key is in the waiting room"),),
)
PLACES = (
    ActionInfo(name="drive_to", inputs={"place": "string"}),
    ActionInfo(name="look_at", inputs={"what": "string"}),
)


def marked(text: str) -> str:
    proper = Proper.of(KNOWN)
    assert proper is not None
    return proper.text(text).replace("\ua78f", "*")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("Drive to pumping station 2.", "Drive to pumping* station 2."),
        ("are both pumping stations shut?", "are both pumping* stations shut?"),
        ("somebody is pumping water", "somebody is pumping water"),
        ("I am waiting, room 3 is dirty", "I am waiting, room 3 is dirty"),
        ("Waiting room first", "Waiting* room first"),
        ("look in the lost and found", "look in the lost* and* found*"),
        ("I lost my hat and found a key", "I lost my hat and found a key"),
        ("lift a box", "lift a box"),
        ("go to hoist a", "go to hoist A"),
        ("hoist a box", "hoist a box"),
        ("sit on the bench by the wall", "sit on the bench by the wall"),
    ],
)
def test_the_words_of_a_name_are_marked_where_it_is_meant(text: str, meant: str) -> None:
    assert marked(text) == meant


def test_everything_that_is_known_is_marked_and_the_answer_is_not() -> None:
    proper = Proper.of(KNOWN)
    assert proper is not None
    known = proper.situation(KNOWN)
    assert unmarked(known.objects[0].description) == "pumping station 1" != known.objects[0].description
    assert known.objects[0].aliases == ("pumping station 1",)
    assert unmarked(known.memory[0]) == KNOWN.memory[0] != known.memory[0]


def test_a_map_of_mere_names_and_words_of_the_catalogue_stay_as_they_are() -> None:
    pond = MapObject("pond", "duck pond", 1.0, 1.0)
    assert Proper.of(Situation(message="", objects=(pond,))) is None
    pump = (ActionInfo(name="start_pumping", inputs={}),)
    station = Proper.of(Situation(message="", objects=OBJECTS[:2], catalogue=pump))
    assert station is not None and not station.names


@pytest.mark.parametrize(
    ("say", "steps"),
    [
        ("go to pumping station 2", [("drive_to", "pumping station 2")]),
        ("press 2 is leaking, check it", [("drive_to", "stamping press 2"), ("look_at", "stamping press 2")]),
        ("Check hoist a, then go to the waiting room", [
            ("drive_to", "hoist A"), ("look_at", "hoist A"), ("drive_to", "waiting room"),
        ]),
        ("hoist B please", [("drive_to", "hoist B")]),
        ("go to the lost and found, then hoist A", [("drive_to", "lost and found"), ("drive_to", "hoist A")]),
    ],
)  # fmt: skip
def test_names_are_gone_to_and_not_done(say: str, steps: list[tuple[str, str]]) -> None:
    situation = Situation(message=say, objects=OBJECTS, robot="Fern", robots=("Fern",), catalogue=PLACES)
    action = OfflineLanguage().explain(situation)[0]
    told = [(step.name, next(iter(step.input_parameters.values())).value) for step in action.queue]
    assert told == steps, plan(action)


def test_a_bare_name_answers_a_question() -> None:
    asked = (
        Turn("operator", "Check the hoist."),
        Turn("assistant", "Which one do you mean: hoist A or hoist B?"),
    )
    situation = Situation(
        message="hoist B", objects=OBJECTS, robot="Fern", robots=("Fern",), catalogue=PLACES, history=asked
    )
    action = OfflineLanguage().explain(situation)[0]
    assert [step.name for step in action.queue] == ["drive_to", "look_at"]
    assert "hoist B" in action.message_response
