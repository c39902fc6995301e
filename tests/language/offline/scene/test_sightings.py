"""What robots noted, what was told, and what is so no more."""

from __future__ import annotations

from parley.language.base import Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

OBJECTS = (MapObject("k", "kitchen", 1, 1, "room"), MapObject("h", "hall", 5, 5, "room"))
TOLD = MemoryEntry(name="ben_location", data="Ben is in the kitchen", source="operator")
SEEN = MemoryEntry(name="seen_1", data="Ben is in the hall", source="A/Inspect")
DENIED = MemoryEntry(name="ben_location", data="Ben is not in the kitchen any more", source="operator")


def answer(message: str, *memory: MemoryEntry, history: tuple[Turn, ...] = ()) -> ChatAction:
    situation = Situation(message, memory=memory, objects=OBJECTS, robot="A", robots=("A",), history=history)
    return OfflineLanguage().explain(situation)[0]


def test_what_people_said_counts_for_more_than_what_a_robot_saw_later() -> None:
    assert "kitchen" in answer("where is Ben?", TOLD, SEEN).message_response


def test_what_a_robot_saw_is_told_where_nobody_said_anything() -> None:
    assert "hall" in answer("where is Ben?", SEEN).message_response


def test_what_is_so_no_more_is_said_as_such() -> None:
    assert "not in the kitchen" in answer("where is Ben?", DENIED).message_response
    assert answer("is Ben in the kitchen?", DENIED).message_response.startswith("As far as I know, no")


def test_forgetting_that_means_the_fact_that_was_just_told() -> None:
    said = (Turn("operator", "Ben is in the kitchen"), Turn("assistant", "I will remember that."))
    newer = MemoryEntry(name="cup_location", data="The cup is in the hall")
    forgotten = [c.arguments for c in answer("forget that", TOLD, newer, history=said).system_cmd]
    assert forgotten == [{"name": "ben_location"}]
