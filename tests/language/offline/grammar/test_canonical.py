"""From any wording to plain orders."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.grammar.canonical import Plainly, plainly_ordered
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject
from tests.language.dev_set import CATALOGUES

MAP = (
    *(MapObject(f"bay_{n}", f"bay {n}", float(n), 0.0, class_name="bay") for n in (1, 2, 3)),
    MapObject("door_n", "north door", 0.0, 5.0, class_name="door"),
    MapObject("door_s", "south door", 0.0, -5.0, class_name="door"),
    MapObject("press", "big press", 4.0, 4.0, class_name="press"),
    MapObject("desk", "front desk", 8.0, 4.0, class_name="desk"),
)
SCENE = Situation(
    message="",
    objects=MAP,
    memory=(MemoryEntry(name="ana", data="Ana is at the front desk"),),
    catalogue=CATALOGUES["thesis"],
)


def read(message: str) -> Plainly | None:
    return plainly_ordered(tokens(message), Scene.of(SCENE))


def orders(message: str) -> list[str]:
    found = read(message)
    assert found is not None
    assert found.against == (), found.against
    return [part.strip() for part in plain(found.words).split(".") if part.strip()]


@pytest.mark.parametrize(
    "message",
    [
        "It would be lovely if you went to the big press.",
        "I want that you are going to the big press",
        "Your next job is to go to the big press",
        "What I need from you is a visit to the big press.",
        "The robot shall first approach the big press",
        "shift yourself to the big press",
    ],
)
def test_going_may_be_asked_for_in_any_frame(message: str) -> None:
    assert orders(message) == ["go to the big press"]


@pytest.mark.parametrize(
    "message",
    [
        "Check the big press for oil.",
        "The big press needs a check for oil",
        "I'd like the big press looked at for oil",
        "The big press should be inspected for oil",
        "It would be nice if the big press got checked for oil",
        "The big press, oil?",
        "Give the big press a quick look for oil",
    ],
)
def test_what_is_looked_for_is_found_wherever_it_stands(message: str) -> None:
    assert orders(message) == ["look for oil at the big press"]


def test_each_of_a_group_is_looked_at_and_what_is_left_out_is_not() -> None:
    assert orders("Do a round of the bays, all but bay 2, and look for bags") == [
        "look for bags at bay 1",
        "look for bags at bay 3",
    ]
    assert orders("Every bay bar the third needs a check for bags") == [
        "look for bags at bay 1",
        "look for bags at bay 2",
    ]


def test_ranges_run_in_the_direction_in_which_they_are_said() -> None:
    assert orders("Visit the bays from 3 down to 1, leave out bay 2 because it is wet") == [
        "go to bay 3",
        "go to bay 1",
    ]


def test_what_is_said_to_come_before_is_done_before() -> None:
    assert orders("Prior to inspecting the big press for dust, go to bay 1") == [
        "go to bay 1",
        "look for dust at the big press",
    ]
    assert orders("Visit bay 2, but before that bay 3") == ["go to bay 3", "go to bay 2"]
    assert orders("Go to bay 1, but only after bay 2") == ["go to bay 2", "go to bay 1"]


def test_the_same_is_done_elsewhere() -> None:
    assert orders("Look for bags in bay 1, same for bay 3.") == [
        "look for bags at bay 1",
        "look for bags at bay 3",
    ]


def test_background_is_no_order() -> None:
    assert orders(
        "Ben had such a bad night, so before I get swamped please check bay 1 for cups, and once you "
        "have done that wait for me by the big press."
    ) == ["look for cups at bay 1", "go to the big press"]


def test_a_correction_takes_the_order_before_it_back() -> None:
    assert orders("Go to bay 1, no wait, bay 2, and look for bags") == ["look for bags at bay 2"]


def test_a_condition_about_what_was_looked_for_needs_no_second_look() -> None:
    assert orders("Check bay 1 for a nurse. If nobody is there, go to bay 2.") == [
        "look for nurse at bay 1",
        "otherwise, go to bay 2",
    ]


def test_words_around_a_name_do_not_swallow_it() -> None:
    assert orders("Take a peek at the big press display") == ["look for display at the big press"]
    assert orders("Have a look round bay 2") == ["look at bay 2"]


def test_a_misspelt_name_is_found() -> None:
    assert orders("inspect the big pres") == ["look at the big press"] or orders("go to the front dsek") == [
        "go to the front desk"
    ]


@pytest.mark.parametrize(
    "message",
    [
        "I went to the big press and looked for my gloves for an hour.",
        "Who told you to go to the big press?",
        "My sister drives to the big press every day",
        "The big press was built by my uncle.",
        "Nice work at the big press!",
        "I'll go to bay 1 later and see whether it is free",
        "Do not go to bay 2.",
        "Have you ever been to bay 1?",
    ],
)
def test_what_asks_for_nothing_gives_no_orders(message: str) -> None:
    found = read(message)
    assert found is None or found.against


def test_one_of_two_is_not_chosen_by_the_grammar() -> None:
    found = read("go to bay 1 or bay 2")
    assert found is None or found.against


def test_an_order_in_a_verb_of_its_own_is_kept_as_it_was_said() -> None:
    found = read("Could you replace the fan in bay 3?")
    assert found is not None
    assert plain(found.unable) == "replace the fan in bay 3"


@pytest.mark.parametrize(
    ("message", "plainly"),
    [
        ("start at bay 3, work your way down to bay 1", ["go to bay 3", "go to bay 2", "go to bay 1"]),
        ("The last stop is the big press. Start with bay 2.", ["go to the bay 2", "go to the big press"]),
        (
            "Wind up at the front desk, having been to the big press and, before that, bay 1",
            ["go to the bay 1", "go to the big press", "go to the front desk"],
        ),
        (
            "Once bay 1 is done and bay 2 is done you may carry on to the big press",
            ["go to the bay 1", "go to the bay 2", "go to the big press"],
        ),
        ("The big press wants looking at, only do bay 1 first", ["go to the bay 1", "look at the big press"]),
    ],
)
def test_stops_come_in_the_order_that_is_meant(message: str, plainly: list[str]) -> None:
    def bare(order: str) -> str:
        return order.replace("the bay", "bay")

    assert [bare(order) for order in orders(message)] == [bare(order) for order in plainly]


@pytest.mark.parametrize(
    ("message", "plainly"),
    [
        ("what you will do is you go to the big press", "go to the big press"),
        ("Look, the phones never stop, so could you go to the big press", "go to the big press"),
        ("it is wet at the big press if you ask me, so leave bay 2 alone and go to bay 3", "go to bay 3"),
        ("to top it all I am late, so drive to the big press if you can", "go to the big press"),
    ],
)
def test_talk_around_an_order_is_passed_over(message: str, plainly: str) -> None:
    assert [order.replace("the bay", "bay") for order in orders(message)] == [plainly]


def test_what_a_story_brings_up_is_looked_for_in_all_places_it_names() -> None:
    found = orders(
        "I was at bay 1 and later I was at bay 2 and now my grey hat is gone. Look for it at both places."
    )
    assert [order.split(" for ")[1] for order in found] == ["grey hat at bay 1", "grey hat at bay 2"]


@pytest.mark.parametrize(
    ("message", "plainly"),
    [
        ("Your first stop is bay 1, your second the big press and your last bay 2",
         ["go to the bay 1", "go to the big press", "go to the bay 2"]),
        ("I'd like the big press to be your final stop. Start with bay 1",
         ["go to the bay 1", "go to the big press"]),
        ("do not go to the big press until you have inspected bay 1",
         ["look at the bay 1", "go to the big press"]),
        ("once bay 1 and bay 2 have been inspected, go to the big press",
         ["look at the bay 1", "look at the bay 2", "go to the big press"]),
        ("go to bay 1, bay 2, in reverse order", ["go to the bay 2", "go to the bay 1"]),
        ("bay 1 and bay 2 were wet, so look for oil at each of them",
         ["look for oil at the bay 1", "look for oil at the bay 2"]),
        ("look for a hat in bay 1 and in bay 2", ["look for hat at the bay 1", "look for hat at the bay 2"]),
    ],
)  # fmt: skip
def test_stops_have_ranks_and_lists_share_what_is_said_of_them(message: str, plainly: list[str]) -> None:
    found = [order.replace("the bay", "bay") for order in orders(message)]
    assert found == [order.replace("the bay", "bay") for order in plainly]
