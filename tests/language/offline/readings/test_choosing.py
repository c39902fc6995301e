"""Of several readings of a message the one that makes the most sense is taken."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.world.object_map import MapObject

OBJECTS = tuple(
    MapObject(id=name.replace(" ", "_"), description=name, x_m=float(3 * at), y_m=0.0)
    for at, name in enumerate(("front desk", "blue door", "store room", "west hall", "lift B"))
)


def situation(message: str) -> Situation:
    return Situation(
        message=message, objects=OBJECTS, catalogue=CATALOGUES["thesis"], robot="Bo", robots=("Bo",)
    )


def steps(message: str) -> list[str]:
    action, _ = OfflineLanguage().explain(situation(message))
    return [
        f"{step.verb} {' '.join(step.arguments)}" for step in read_steps(action.queue, CATALOGUES["thesis"])
    ]


@pytest.mark.parametrize(
    ("message", "plan"),
    [
        (
            "I hardly slept, two people called in sick and the boss is in a mood. Anyway, would you first "
            "run over to the store room and see if the ladder is there, and after that go to the front "
            "desk, they expect you.",
            ["go store room", "look whether the ladder is there", "go front desk"],
        ),
        (
            "So somebody from the west hall says there is water on the floor all over, could you go there "
            "and look at the floor before the guests come, thank you",
            ["go west hall", "look floor"],
        ),
        ("We have to prepare for tomorrow's visit. First look at the blue door and to finish with, go to the "
         "front desk.", ["go blue door", "look blue door", "go front desk"]),
        ("Check the blue door. If you are done there, go to the store room and look for the ladder.",
         ["go blue door", "look blue door", "go store room", "look ladder"]),
        ("check the blue door first and then lift b because people say it is stuck",
         ["go blue door", "look blue door", "go lift B", "look lift B"]),
    ],
)  # fmt: skip
def test_what_is_told_around_orders_stays_out_of_the_plan(message: str, plan: list[str]) -> None:
    assert steps(message) == plan


@pytest.mark.parametrize(
    "message",
    [
        "I have been running between the front desk and the blue door since six.",
        "The lawyers will go to the west hall after lunch.",
        "I don't want you to go to the store room.",
        "Who put the front desk there?",
    ],
)
def test_what_is_no_order_stays_none(message: str) -> None:
    assert steps(message) == []


def test_the_explanation_tells_how_the_readings_were_judged() -> None:
    message = "We had a terrible night, the lift was loud, anyway go and look at the blue door that's it"
    _, decisions = OfflineLanguage().explain(situation(f"{message}, and the store room, they said it leaks"))
    assert any(decision.about == "reading" and "against it" in decision.text for decision in decisions)


def test_what_was_named_in_the_same_message_is_meant_and_else_it_is_asked() -> None:
    doors = (*OBJECTS, MapObject(id="red_door", description="red door", x_m=0.0, y_m=9.0))
    asked = replace(situation("go to the door"), objects=doors)
    named = replace(
        situation("check the blue door, go to lift b and then go to the door again"), objects=doors
    )
    assert OfflineLanguage().explain(asked)[0].choices
    queue = OfflineLanguage().explain(named)[0].queue
    assert [" ".join(step.arguments) for step in read_steps(queue, CATALOGUES["thesis"])][-1] == "blue door"
