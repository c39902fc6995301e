"""The logic of orders: conditions, sets, exceptions, counts, waits, what comes first; what is asked about."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps
from parley.language.base import Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.memory import MemoryEntry
from parley.world.geometry import Pose2D
from parley.world.object_map import MapArea, MapObject

ENGINE = BuiltinLanguage()
PLACES = (
    ("gate 1", 2, 0), ("gate 2", 4, 0), ("gate 3", 6, 0), ("gate 4", 8, 0), ("red crate", 1, 5),
    ("blue crate", 3, 5), ("green crate", 9, 5), ("desk", 3, 7), ("office", -4, 2), ("north ramp", 0, 9),
    ("south ramp", 0, -9), ("pump", 9, 7),
)  # fmt: skip
OBJECTS = tuple(MapObject(f"id{n}", name, x, y) for n, (name, x, y) in enumerate(PLACES))
MEMORY = (MemoryEntry(name="kim_location", type="text", data="Kim is in the office"),)


def situation(message: str, catalogue: str = "thesis") -> Situation:
    return Situation(
        message,
        objects=OBJECTS,
        memory=MEMORY,
        catalogue=CATALOGUES[catalogue],
        robot="Rob",
        robots=("Rob",),
        robot_pose=Pose2D(0.0, 0.0, 0.0),
    )


async def plan(message: str) -> list[str]:
    """The steps that come of a message, in short: "go gate 1", "look ...", "if 2: go desk"."""
    answer = await ENGINE.interpret(situation(message))
    steps = read_steps(answer.queue, situation(message).catalogue)
    flows = [f"{step.flow}: " if step.flow else "" for step in steps]
    return [
        f"{flow}{step.verb} {' '.join(step.arguments)}".strip()
        for flow, step in zip(flows, steps, strict=True)
    ]


def rounds(*names: str) -> list[str]:
    return [f"go {name}" for name in names]


WAIT = "ask Please tell me when I may go on: I am to wait"
PLANS = {
    # sets
    "go to gates 2 to 4": rounds("gate 2", "gate 3", "gate 4"),
    "go to both ramps": rounds("north ramp", "south ramp"),
    "visit the last two gates": rounds("gate 3", "gate 4"),
    "go to all the crates": rounds("red crate", "blue crate", "green crate"),
    "go to every crate except the blue one": rounds("red crate", "green crate"),
    "go to all gates apart from gate 2 and gate 3": rounds("gate 1", "gate 4"),
    "go to every crate but skip the blue one": rounds("red crate", "green crate"),
    "go to all gates, you can leave out gate 2 and gate 3 please": rounds("gate 1", "gate 4"),
    "go to all gates but not to gate 2 and gate 3": rounds("gate 1", "gate 4"),
    "go to all gates but not to gate 2 and go to the desk": rounds("gate 1", "gate 3", "gate 4", "desk"),
    "go to gates 1, 2 and 4": rounds("gate 1", "gate 2", "gate 4"),
    "look at each crate": [
        step for name in ("red", "blue", "green") for step in (f"go {name} crate", f"look {name} crate")
    ],
    # one of several, by where it is
    "go to the crate next to the desk": rounds("blue crate"),
    "go to the nearest gate": rounds("gate 1"),
    "go to the crate between the red crate and the green crate": rounds("blue crate"),
    "don't go to gate 1, go to the other gates": rounds("gate 2", "gate 3", "gate 4"),

    "The pallet is at the pump. Go to it.": rounds("pump"),
    # conditions
    "if the pump is on, go to the desk, otherwise go to the office": [
        "go pump", "look whether the pump is on", "if 2: go desk", "unless 2: go office",
    ],
    "go to the desk unless gate 1 is open": ["go gate 1", "look whether gate 1 is open", "unless 2: go desk"],
    "check whether gate 2 is shut, and if not go to the desk": [
        "go gate 2", "look whether gate 2 is shut", "unless 2: go desk",
    ],
    "go to the office; if somebody is there come back": [
        "go office", "look whether somebody is there", "if 2: at",
    ],
    "if gate 1 isn't open go to the office and then to the desk": [
        "go gate 1", "look whether gate 1 is open", "unless 2: go office", "unless 2: go desk",
    ],
    "if gate 1 is open, go to the desk": ["go gate 1", "look whether gate 1 is open", "if 2: go desk"],
    # what comes first
    "After the pump, go to the desk": rounds("pump", "desk"),
    "before you go to the desk go to the office": rounds("office", "desk"),
    "go to the desk after visiting the office": rounds("office", "desk"),
    "go to the desk, but first go to the office": rounds("office", "desk"),
    "once you have been at the pump, go to the desk": rounds("pump", "desk"),
    "go to the pump. After that come to the desk": rounds("pump", "desk"),
    "inspect gate 1. Before that, go to gate 2. And before both of them go to the office": [
        "go office", "go gate 2", "go gate 1", "look gate 1",
    ],
    "go to gate 1 and gate 2, but go to the pump first": rounds("pump", "gate 1", "gate 2"),
    "once you have inspected the pump, go to the desk": ["go pump", "look pump", "go desk"],
    "before you go to the desk, the office please": rounds("office", "desk"),
    # what is said once, and meant of the next thing too
    "go to the office, and once you have been there, the desk": rounds("office", "desk"),
    "if gate 1 is open go to the desk, otherwise the pump": [
        "go gate 1", "look whether gate 1 is open", "if 2: go desk", "unless 2: go pump",
    ],
    "go to both ramps and see if the doors are shut": [
        step for name in ("north", "south") for step in (f"go {name} ramp", "look whether the doors are shut")
    ],
    "see if the lamps are off at gates 1 and 2": [
        step
        for name in ("gate 1", "gate 2")
        for step in (f"go {name}", f"look whether the lamps are off at {name}")
    ],
    # once is enough
    "inspect the pump, and if it is dripping go to the desk": [
        "go pump", "look whether the pump is dripping", "if 2: go desk",
    ],
    "unless the pump is running, go there": ["go pump", "look whether the pump is running"],
    # no need, another way
    "no need to inspect the pump, just go to the desk": rounds("desk"),
    "take gate 3 instead": rounds("gate 3"),
    # how often, how long
    "go to the desk three times": rounds("desk", "desk", "desk"),
    "in five minutes go to the desk": [f"{WAIT} for five minutes.", "go desk"],
    "stay at the desk for ten minutes": ["go desk", f"{WAIT} for 10 min."],
    "wait until Kim comes, then go to the desk": [f"{WAIT} until Kim comes.", "go desk"],
    # what is not wanted
    "don't go to gate 1, go to gate 2": rounds("gate 2"),
    "go to gate 3, not to gate 4": rounds("gate 3"),
    "go to the desk without stopping at the office": rounds("desk"),
}  # fmt: skip
ASKED = """go to the crate; go to the desk or to the office; go to the desk at noon; go to both crates
go to the desk every morning; go to gates 3 to 9; go to all crates except the yellow one
if I call you go to the desk; if Kim wants tea go to the desk; go to the desk forty times
go to the office until somebody comes
if it is late go to the desk; otherwise go to the desk; when the pump stops go to the desk
go to the office and to the desk if the pump is on; check the zebras and then go to the desk
if gate 1 is open go to the desk, otherwise the zebra
check the pump, then if it leaks go to the office, otherwise carry on to gate 1
visit the desk, the zebra and the pump; the box and both ramps are to be inspected"""


@pytest.mark.parametrize("message", PLANS)
async def test_logic_becomes_steps(message: str) -> None:
    assert await plan(message) == PLANS[message]


@pytest.mark.parametrize("message", [text.strip() for text in ASKED.replace("\n", ";").split(";")])
async def test_what_has_no_place_in_a_plan_is_asked_about(message: str) -> None:
    answer = await ENGINE.interpret(situation(message))
    assert answer.queue == () and "?" in answer.message_response + "?"


async def test_which_of_several_is_asked_with_choices() -> None:
    answer = await ENGINE.interpret(situation("look at the crate"))
    assert answer.choices == ("red crate", "blue crate", "green crate")


async def test_reply_says_what_depends_on_what() -> None:
    message = "if the pump is on, go to the desk, otherwise go to the office"
    answer = await ENGINE.interpret(situation(message))
    assert answer.message_response == (
        "I will go to the pump and then check whether the pump is on; if so, go to the desk; if not, "
        "go to the office."
    )


async def test_waiting_is_done_by_an_action_for_it_where_there_is_one() -> None:
    answer = await ENGINE.interpret(situation("in five minutes go to the desk", "tools"))
    assert [call.name for call in answer.queue] == ["Wait", "DriveTo"]
    assert answer.queue[0].input_parameters["duration_s"].value == 300


@pytest.mark.parametrize(
    ("message", "targets"),
    [
        ("Kit, go to the desk", ("Kit",)),
        ("Rob and Kit, go to the desk", ("Rob", "Kit")),
        ("both of you go to the desk", ("Rob", "Kit")),
        ("go to the desk", ("Rob",)),
    ],
)
async def test_an_order_is_for_the_robots_that_are_called(message: str, targets: tuple[str, ...]) -> None:
    answer = await ENGINE.interpret(replace(situation(message), robots=("Rob", "Kit")))
    assert (answer.targets, [call.name for call in answer.queue][-1:]) == (targets, ["NavigateTo"])


@pytest.mark.parametrize(
    "message", ["it is up to Kit: go to the desk", "Zed! Go to the desk!", "Kip, go to the desk"]
)
async def test_an_order_that_may_be_for_another_robot_is_not_carried_out(message: str) -> None:
    answer = await ENGINE.interpret(replace(situation(message), robots=("Rob", "Kit")))
    assert answer.queue == ()


@pytest.mark.parametrize(
    "message", ["If you see smoke, stop and tell me.", "when the way is blocked wait a minute"]
)
async def test_what_to_do_in_a_case_that_may_come_is_remembered(message: str) -> None:
    answer = await ENGINE.interpret(situation(message))
    assert [command.arguments["data"] for command in answer.system_cmd] == [message.rstrip(".")]
    assert answer.queue == ()


@pytest.mark.parametrize(
    ("message", "goal"),
    [
        ("drive into the Gate Hall", "gate hall"),
        ("go to the office", "office"),
        ("go to gate 1", "gate 1"),
        ("go to the hall", None),
    ],
)
async def test_a_room_of_the_map_is_a_goal_by_its_whole_name(message: str, goal: str | None) -> None:
    square = ((0.0, 0.0), (5.0, 0.0), (5.0, 5.0))
    rooms = tuple(MapArea(name, square).goal for name in ("gate hall", "office"))
    answer = await ENGINE.interpret(replace(situation(message), rooms=rooms))
    steps = read_steps(answer.queue, situation(message).catalogue)
    assert [step.arguments for step in steps if step.verb == "go"] == ([(goal,)] if goal else [])


SHARED = tuple(replace(item, aliases=("crate store",)) for item in OBJECTS if "crate" in item.description)


@pytest.mark.parametrize(
    "message", ["check if the parcel is in the crate store", "check if the crate store is clear"]
)
async def test_a_name_that_several_places_have_is_asked_about_before_one_is_looked_at(message: str) -> None:
    asked = await ENGINE.interpret(replace(situation(message), objects=SHARED))
    assert asked.queue == ()
    assert asked.choices == ("red crate", "blue crate", "green crate")


async def test_a_place_is_looked_through_for_something_else() -> None:
    assert await plan("check gate 2 for leaks") == ["go gate 2", "look gate 2 for leaks"]
    every = [step for number in "123" for step in (f"go gate {number}", f"look gate {number} for parcels")]
    assert await plan("look for parcels at gates 1, 2 and 3") == every
    none = [
        step
        for number in "12"
        for step in (f"go gate {number}", f"look whether there are no leaks in gate {number}")
    ]
    assert await plan("make sure there are no leaks in gates 1, 2") == none
    seen = [
        step for name in ("pump", "desk", "gate 1") for step in (f"go {name}", "look whether there is a leak")
    ]
    assert await plan("visit the pump, the desk and gate 1 and see whether there is a leak") == seen
    two = ["go pump", "look pump for parcels", "go desk", "look desk for parcels"]
    assert await plan("look for parcels at the pump and at the desk") == two
    until_seen = ["go gate 1", "look parcel", "unless 2: go gate 2", "unless 2: look parcel"]
    assert await plan("search gates 1 and 2 for the parcel") == until_seen
    assert await plan("search gates 1 and 2 for the parcel, and if you find it, go to the desk") == []
    assert await plan("look for parcels at the pump and then at the desk") == []
    assert await plan("inspect gates 1 and 2 for strange parcels") == [
        step for name in ("gate 1", "gate 2") for step in (f"go {name}", f"look {name} for strange parcels")
    ]  # fmt: skip


@pytest.mark.parametrize(
    "told",
    [
        "Remember: the places of interest are gate 1, the pump and gate 3",
        "Just so you know, our places of interest are gate 1, the pump and 3.",
        "You should know that there are three places of interest, gate 1, the pump and gate 3.",
        "the three places of interest are called gate 1, the pump and gate 3",
    ],
)
async def test_a_list_may_be_told_in_other_words(told: str) -> None:
    (command,) = (await ENGINE.interpret(situation(told))).system_cmd
    memory = MemoryEntry(name="told", type="text", data=str(command.arguments["data"]))
    later = replace(situation("go to all places of interest"), memory=(memory,))
    goals = [str(c.input_parameters["target"].value) for c in (await ENGINE.interpret(later)).queue[::2]]
    assert goals == ["gate 1", "pump", "gate 3"]


@pytest.mark.parametrize("listed", ["gate 1, the pump, and gate 3", "gate 1, pump and 3"])
async def test_what_was_listed_is_meant_by_its_name_later(listed: str) -> None:
    told = await ENGINE.interpret(situation(f"There are three places of interest: {listed}."))
    (kept,) = (command.arguments for command in told.system_cmd if command.command == "add_memory")
    assert told.queue == ()
    memory = MemoryEntry(name=str(kept["name"]), data=str(kept["data"]), way="told")
    later = replace(situation("inspect each place of interest"), memory=(memory,))
    assert [step.input_parameters["target"].value for step in (await ENGINE.interpret(later)).queue[::3]] == [
        "gate 1", "pump", "gate 3",
    ]  # fmt: skip
    before = await ENGINE.interpret(situation("inspect each place of interest"))
    assert before.queue == ()
    for text in ("inspect the places of interest except gate 3", "check all places of interest but gate 3"):
        answer = await ENGINE.interpret(replace(situation(text), memory=(memory,)))
        assert [step.input_parameters["target"].value for step in answer.queue[::3]] == ["gate 1", "pump"]


@pytest.mark.parametrize("text", ["check only P and R", "just check P and R"])
async def test_a_word_for_no_others_is_no_part_of_a_name(text: str) -> None:
    bays = tuple(MapObject(f"bay_{name}", f"Bay {name}", float(at), 1.0) for at, name in enumerate("PQR"))
    answer = await ENGINE.interpret(replace(situation(text), objects=bays))
    assert [step.input_parameters["target"].value for step in answer.queue[::3]] == ["Bay P", "Bay R"]


async def test_a_list_with_something_else_in_it_is_no_such_fact() -> None:
    other = await ENGINE.interpret(
        situation("There are two places of interest: gate 1, and open the window.")
    )
    assert not any("interest" in str(command.arguments) for command in other.system_cmd)


async def test_the_reason_before_an_order_is_taken_as_such() -> None:
    answer = await ENGINE.interpret(situation("We need to prepare for tomorrow's visit. Go to gate 2."))
    assert [step.name for step in answer.queue] == ["GetCoordinates", "NavigateTo"]
    assert "“We need to prepare for tomorrow's visit” for the reason" in answer.message_response
    named = await ENGINE.interpret(situation("We need to prepare the pump. Go to gate 2."))
    assert "for the reason" not in named.message_response
