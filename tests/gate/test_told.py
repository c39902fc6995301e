"""What people tell as a rule becomes one by code; everything else is left to whoever understands orders."""

from __future__ import annotations

from typing import Any

import pytest

from parley.gate.told import DraftRule, NotUnderstood, lifted_place, told_rule
from parley.gate.told_hours import hours_in
from parley.messages.rules import Rule
from parley.messages.status import ActionInfo
from parley.world.object_map import MapArea, MapObject

PLACES = (
    MapObject("r1", "storeroom", 5, 0, "room", 2, 2),
    MapObject("r2", "hall", 0, 0, "room", 6, 4, aliases=("saal",)),
    MapObject("b1", "cot in the ward", 8, 8, "cot", 2, 1),
    MapObject("b2", "desk in the ward", 10, 8, "desk", 1, 1),
    MapObject("d1", "door", 1, 1, "door"),
    MapObject("d2", "door", 2, 1, "door"),
)
CATALOGUE = (
    ActionInfo(name="NavigateTo", phrases=("go to {place}",), effects=("moves",)),
    ActionInfo(name="OpenDoor", phrases=("open {door}",), effects=("opens",)),
    ActionInfo(name="OpenBox", phrases=("open the box",), effects=("opens",)),
    ActionInfo(name="LiftBox", phrases=("lift {box}",), effects=("lifts",)),
)
WARD = {"name": "ward", "rectangle": (6.0, 6.5, 11.5, 9.5)}
STORE = {"kind": "keep_out", "name": "storeroom", "rectangle": (3.7, -1.3, 6.3, 1.3)}
HALL = {"name": "hall", "rectangle": (-3.3, -2.3, 3.3, 2.3)}
NIGHT = {"start": "22:00", "end": "06:00"}


def told(text: str) -> DraftRule | NotUnderstood | None:
    return told_rule(text, places=PLACES, catalogue=CATALOGUE, robots=("Ada", "Bob"), robot="Ada")


def fields(rule: Rule) -> dict[str, Any]:
    found = rule.model_dump(exclude_defaults=True, exclude={"id", "words"})
    if rule.when is not None:
        found["when"] = rule.when.model_dump(exclude_defaults=True)
    return found


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("nobody into the ward between two and three",
         {"kind": "keep_out", "when": {"start": "14:00", "end": "15:00"}} | WARD),
        ("Nobody goes into the ward from 10 pm to 6 am.", {"kind": "keep_out", "when": NIGHT} | WARD),
        ("never go into the storeroom", STORE | {"robots": ("Ada",)}),
        ("Please never drive into the storeroom!", STORE | {"robots": ("Ada",)}),
        ("No robot may enter the storeroom", STORE),
        ("stay away from the storeroom from now on", STORE),
        ("Stay at least 2 metres away from the storeroom", STORE | {"rectangle": (2.0, -3.0, 8.0, 3.0)}),
        ("nobody may come closer than 1 m to the storeroom", STORE | {"rectangle": (3, -2, 7, 2)}),
        ("nobody should go into the storeroom today", STORE),
        ("I'd rather you didn't go into the storeroom", STORE | {"robots": ("Ada",)}),
        ("I don't want you to go into the storeroom", STORE | {"robots": ("Ada",)}),
        ("the hall is off limits today", {"kind": "keep_out"} | HALL),
        ("Bob must not go into the storeroom", STORE | {"robots": ("Bob",)}),
        ("Ada and Bob must never enter the storeroom on weekends",
         STORE | {"robots": ("Ada", "Bob"), "when": {"days": ("sat", "sun")}}),
        ("never go into the storeroom after 1 am",
         STORE | {"robots": ("Ada",), "when": {"start": "01:00", "end": "06:00"}}),
        ("nobody may drive before 6:00",
         {"kind": "action", "classes": ("moves",), "when": {"start": "00:00", "end": "06:00"}}),
        ("ära kunagi sõida saali pärast kella 22",
         {"kind": "keep_out", "name": "saali", "when": NIGHT, "robots": ("Ada",),
          "rectangle": HALL["rectangle"]}),
        ("stay out of the storeroom at night", STORE | {"when": NIGHT}),
        ("always ask me before you drive at night",
         {"kind": "action", "verdict": "ask", "classes": ("moves",), "robots": ("Ada",), "when": NIGHT}),
        ("always ask me before you open a door",
         {"kind": "action", "verdict": "ask", "actions": ("OpenDoor",), "robots": ("Ada",)}),
        ("Always ask me before anybody goes into the storeroom",
         {"kind": "ask_zone", "name": "storeroom", "rectangle": STORE["rectangle"]}),
        ("never go into the storeroom without asking me first",
         {"kind": "ask_zone", "name": "storeroom", "rectangle": STORE["rectangle"], "robots": ("Ada",)}),
        ("not faster than half a metre per second in the hall",
         {"kind": "slow", "max_speed_mps": 0.5} | HALL),
        ("never drive faster than 3.6 km/h", {"kind": "speed", "max_speed_mps": 1.0}),
        ("Ada must not open doors", {"kind": "action", "actions": ("OpenDoor",), "robots": ("Ada",)}),
        ("Bob may not open anything",
         {"kind": "action", "actions": ("OpenDoor", "OpenBox"), "robots": ("Bob",)}),
        ("robots must not touch anything", {"kind": "action", "classes": ("handles_things",)}),
        ("from now on, nobody may drive between 22:00 and 6:00",
         {"kind": "action", "classes": ("moves",), "when": NIGHT}),
        ("Ada must not drive on Monday and on Sunday",
         {"kind": "action", "classes": ("moves",), "robots": ("Ada",), "when": {"days": ("mon", "sun")}}),
        ("ära kunagi sõida saali", {"kind": "keep_out", "robots": ("Ada",), "name": "saali",
                                    "rectangle": HALL["rectangle"]}),
        ("keegi ei tohi sõita saali öösel",
         {"kind": "keep_out", "name": "saali", "rectangle": HALL["rectangle"], "when": NIGHT}),
        ("Bob ei tohi uksi avada",
         {"kind": "action", "actions": ("OpenDoor", "OpenBox"), "robots": ("Bob",)}),
        ("küsi alati minult enne kui sa sõidad öösel",
         {"kind": "action", "verdict": "ask", "classes": ("moves",), "robots": ("Ada",), "when": NIGHT}),
        ("mitte kiiremini kui pool meetrit sekundis", {"kind": "speed", "max_speed_mps": 0.5}),
    ],
)  # fmt: skip
def test_what_is_told_becomes_a_rule(text: str, expected: dict[str, Any]) -> None:
    found = told(text)
    assert isinstance(found, DraftRule), found
    assert fields(found.rule) == expected
    assert found.rule.words == text


@pytest.mark.parametrize(
    "text",
    [
        "go to the storeroom", "don't go into the storeroom", "never mind", "nobody is in the ward", "no",
        "Kim must not lift boxes", "never again", "nobody knows", "I never go into the storeroom",
        "is Ada allowed to open doors?",
        "nobody may go into the hall without asking Kim",
        "ask me later", "what rules are there?", "drive faster", "stop",
        "The cup is in the hall, nobody wants it", "no, not faster", "remember that the hall is green",
        "never", "nobody", "must not", "Ada", "", "x" * 1000, "the red door is closed",
        "I'd rather you didn't hurry", "the shop is closed",
    ],
)  # fmt: skip
def test_everything_else_is_no_rule(text: str) -> None:
    assert told(text) is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("never go into the cellar", "I do not know where “cellar” is. You can draw it on the page Rules."),
        (
            "never go behind the cars any more",
            "I do not know where “behind the cars” is. You can draw it on the page Rules.",
        ),
        ("nobody through the door", "I know several places that are called “door”."),
        ("Ada must not juggle knives", "I know no action of mine that is called “juggle knives”."),
        ("not faster than 900 km/h", "I cannot drive at such a speed."),
    ],
)
def test_a_rule_that_cannot_be_made_says_what_is_missing(text: str, said: str) -> None:
    assert told(text) == NotUnderstood(said)


def test_a_number_of_things_is_no_hour() -> None:
    assert hours_in("never open a door after two knocks") == ((None,), "never open a door after two knocks")


def test_what_can_be_meant_in_two_ways_is_offered_in_both() -> None:
    found = told("never go into the ward between two and three")
    assert isinstance(found, DraftRule)
    meant = [(rule.robots, rule.when.start if rule.when else None) for rule in (found.rule, *found.others)]
    assert meant == [(("Ada",), "14:00"), (("Ada",), "02:00"), ((), "14:00"), ((), "02:00")]


def test_a_zone_that_was_drawn_is_a_place_too_and_ids_stay_apart() -> None:
    drawn = Rule(
        id="keep-out-lab", kind="slow", name="lab", polygon=((0, 0), (1, 0), (0, 1)), max_speed_mps=1
    )
    found = told_rule("nobody into the lab", places=(), catalogue=(), robots=("Ada",), zones=(drawn,))
    assert isinstance(found, DraftRule)
    assert (found.rule.id, found.rule.polygon) == ("keep-out-lab-2", drawn.polygon)
    again = told_rule(
        "nobody into the lab", places=(), catalogue=(), robots=("Ada",), zones=(drawn, found.rule)
    )
    assert isinstance(again, DraftRule)
    assert again.rule.id == "keep-out-lab-3"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("don't go into the storeroom today, it is wet", "storeroom"),
        ("never drive into the storeroom because it is wet", "storeroom"),
        ("nobody goes into the storeroom until the floor is dry", "storeroom"),
        ("nobody goes into the storeroom before I say so", "storeroom"),
        ("keep out of the storeroom while they are painting", "storeroom"),
        ("do not go to the storeroom for now", "storeroom"),
        ("don't worry", ""),
        ("don't open the door", ""),
    ],
)
def test_of_a_robot_with_nothing_to_do_a_dont_is_a_rule_whatever_its_reason(text: str, name: str) -> None:
    found = told_rule(text, places=PLACES, catalogue=CATALOGUE, robots=("Ada",), robot="Ada", busy=False)
    assert (found.rule.name if isinstance(found, DraftRule) and found.rule.kind == "keep_out" else "") == name


@pytest.mark.parametrize(
    ("text", "doing", "name"),
    [
        ("don't go into the storeroom", "Go to “lift”", "storeroom"),
        ("don't go into the storeroom", "Go to “shelf in the storeroom”", ""),
        ("don't go into the storeroom", "", ""),  # it is not known what it is about
        ("don't go in there", "Go to “lift”", ""),
    ],
)
def test_a_dont_that_is_about_nothing_the_robot_does_is_a_rule(text: str, doing: str, name: str) -> None:
    found = told_rule(text, places=PLACES, catalogue=CATALOGUE, robots=("Ada",), robot="Ada", doing=doing)
    assert (found.rule.name if isinstance(found, DraftRule) else "") == name
    assert name or found is None


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("Kim is awake now, you may go to the storeroom again", "storeroom"),
        ("ok the floor is dry, the storeroom is fine again", "storeroom"),
        ("the storeroom's open again", "storeroom"),
        ("they've opened the storeroom again", "storeroom"),
        ("the storeroom isn't closed any more", "storeroom"),
        ("the storeroom has been reopened", "storeroom"),
        ("the storeroom is closed", ""),
        ("they opened the storeroom", ""),
        ("the storeroom is open", ""),
        ("may you go into the storeroom?", ""),
        ("you must not go into the storeroom", ""),
    ],
)
def test_a_place_is_free_again(text: str, place: str) -> None:
    assert lifted_place(text) == place


def test_a_room_is_what_the_map_shows_as_that_room() -> None:
    corners = ((4.0, 4.0), (12.0, 4.0), (12.0, 10.0), (4.0, 10.0))
    draft = told_rule(
        "stay out of the ward", places=PLACES, catalogue=CATALOGUE, robots=("Ada",), robot="Ada",
        areas=(MapArea("Ward", corners),),
    )  # fmt: skip
    assert isinstance(draft, DraftRule)
    assert (draft.rule.name, draft.rule.polygon, draft.rule.rectangle) == ("Ward", corners, None)


@pytest.mark.parametrize("behind", ["again", "any more", "again until 6:00"])
def test_again_and_any_more_are_no_part_of_a_place(behind: str) -> None:
    made = told(f"never go into the hall {behind}")
    assert isinstance(made, DraftRule) and made.rule.name == "hall"


def test_a_rule_for_a_case_that_nobody_can_measure_is_not_taken_for_a_place() -> None:
    made = told("never enter the hall when I sleep")
    assert isinstance(made, NotUnderstood) and "not “when i sleep”" in made.sentence
