"""What alarms beside an order: a nuisance does not, a real one is told and asked about, with the order."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.language.base import Turn
from parley.language.builtin.decision import Answer, Ask, Control, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Asked, Dialogue
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()


@pytest.mark.parametrize(
    "message",
    [
        "my knees are killing me so please drive to the desk",
        "the driver is stuck in traffic. Go to the desk.",
        "My neck hurts today, would you go to the desk?",
    ],
)
def test_a_nuisance_beside_a_clear_order_is_no_emergency(message: str) -> None:
    made = ENGINE.decide(situation(message))
    assert isinstance(made, Do) and [deed.arguments for deed in made.deeds] == [{"place": "desk"}]


@pytest.mark.parametrize(
    ("told", "order"),
    [
        ("Kim fell,", "go to the desk"),
        ("my back is killing me and there is smoke in the yard,", "go to the desk"),
        ("SOS,", "go to the desk"),
        ("someone is bleeding.", "Go to the office and then look for the red box"),
        ("the old man does not wake up,", "please go to the desk"),
    ],
)
def test_a_real_one_is_told_and_the_order_beside_it_is_offered(told: str, order: str) -> None:
    message = f"{told} {order}"
    asked = ENGINE.decide(situation(message))
    assert isinstance(asked, Ask) and asked.alarms and asked.choices == (order, "Stay here")
    past = (Turn("operator", message), Turn("assistant", asked.question))
    open_question = Dialogue(asked=Asked(message, asked.choices))
    agreed = ENGINE.decide(situation("yes", history=past, dialogue=open_question))
    assert isinstance(agreed, Do) and replace(agreed, about="") == ENGINE.decide(situation(order))


@pytest.mark.parametrize("told", ["a crate is blocking the front gate", "the pump is making a strange noise"])
def test_what_is_amiss_with_a_thing_is_offered_to_be_looked_at_and_alarms_nobody(told: str) -> None:
    asked = ENGINE.decide(situation(told))
    assert isinstance(asked, Ask) and not asked.alarms and asked.offer
    assert "have a look?" in asked.question


@pytest.mark.parametrize(
    "told",
    ["a crate has fallen on Kim at the ramp", "the pump is on fire", "a man is stuck in the front gate"],
)
def test_people_and_danger_alarm_everybody(told: str) -> None:
    asked = ENGINE.decide(situation(told))
    assert isinstance(asked, Ask) and asked.alarms


def test_an_order_that_depends_on_something_is_not_taken_out_of_it() -> None:
    asked = ENGINE.decide(situation("if the pump is on, Kim fell, go to the desk"))
    assert isinstance(asked, Ask) and asked.alarms and "go to the desk" not in asked.choices


def test_a_name_that_sounds_like_danger_calls_nobody() -> None:
    for message in ("Spark, go to the desk", "Spark, stop!"):
        made = ENGINE.decide(situation(message, robot="Spark", robots=("Spark",)))
        assert isinstance(made, Do | Control), message


def test_that_all_is_well_may_be_said_twice() -> None:
    alarm = ENGINE.decide(situation("Kim fell at the desk"))
    assert isinstance(alarm, Ask) and alarm.alarms
    past = (Turn("operator", "Kim fell at the desk"), Turn("assistant", alarm.question))
    assert isinstance(ENGINE.decide(situation("she is fine, it was a false alarm", history=past)), Answer)


TEAM = ("Ada", "Bob", "Mr. Brush")


@pytest.mark.parametrize(
    ("message", "helped"),
    [
        ("Ada, help Bob", "Bob"),
        ("help Bob!", "Bob"),
        ("please go and help out Mr. Brush", "Mr. Brush"),
        ("Ada, can you give Bob a hand?", "Bob"),
        ("Bob, help Ada", "Ada"),
        ("Ada, assist Bob with that", "Bob"),
    ],
)
def test_to_help_another_robot_is_no_emergency_and_it_is_asked_what_is_meant(
    message: str, helped: str
) -> None:
    asked = ENGINE.decide(situation(message, robots=TEAM))
    assert isinstance(asked, Ask) and not asked.alarms and not asked.stops
    assert asked.question.startswith(f"What is to be done to help {helped}?")


def test_what_another_robot_is_to_be_helped_with_is_done() -> None:
    for message in ("Ada, help Bob to look for the red box", "help Bob look for the red box"):
        made = ENGINE.decide(situation(message, robots=TEAM))
        assert made == ENGINE.decide(situation("look for the red box", robots=TEAM)), message


@pytest.mark.parametrize(
    "message",
    ["help, Ada!", "Ada, help", "help me", "help Kim", "help Bob, Kim fell", "Ada, help Bob, fire!"],
)
def test_a_cry_for_help_alarms_among_robots_too(message: str) -> None:
    asked = ENGINE.decide(situation(message, robots=TEAM))
    assert isinstance(asked, Ask) and asked.alarms, message


@pytest.mark.parametrize(
    "message",
    [
        "I can't breathe, where are you",
        "Ruth is on the floor, come to the desk",
        "grandma is not responding",
        "My chest hurts",
        "Kim isn't breathing, what shall I do?",
    ],
)
def test_what_no_healthy_person_does_alarms_whatever_else_is_said(message: str) -> None:
    asked = ENGINE.decide(situation(message))
    assert isinstance(asked, Ask) and asked.alarms


@pytest.mark.parametrize(
    "message",
    [
        "check whether Ruth is on the floor",
        "the red box is on the floor",
        "Water is on the floor",
        "the Blue Crate is on the floor",
        "she doesn't respond to my letters",
        "the pump is not responding",
    ],
)
def test_what_lies_there_or_is_only_asked_about_alarms_nobody(message: str) -> None:
    assert not getattr(ENGINE.decide(situation(message)), "alarms", False)


@pytest.mark.parametrize("message", ["can you help me?", "Hi, could you please help me with something"])
def test_who_politely_asks_for_help_is_asked_for_what(message: str) -> None:
    asked = ENGINE.decide(situation(message))
    assert isinstance(asked, Ask) and not asked.alarms and "If a person is in danger" in asked.question


@pytest.mark.parametrize(
    ("message", "alarms"),
    [
        ("if there is smoke, raise the alarm", False),
        ("let me know if anyone is hurt", False),
        ("call me if you can hear me, I have fallen", True),
        ("call me when you can. There is smoke in the office!", True),
    ],
)
def test_to_be_told_of_danger_is_no_danger_yet(message: str, alarms: bool) -> None:
    made = ENGINE.decide(situation(message))
    assert (isinstance(made, Ask) and made.alarms) is alarms


@pytest.mark.parametrize(
    ("said", "alarms"),
    [
        ("the fire is out", False),
        ("The smoke has cleared.", False),
        ("ok the fire has been put out", False),
        ("the dog is gone", False),
        ("the forklift is gone", False),
        ("the fire is out of control", True),
        ("the smoke is back", True),
        ("the fire is out, but Ruth is hurt", True),
        ("the child is gone", True),
    ],
)
def test_what_is_over_alarms_nobody(said: str, alarms: bool) -> None:
    made = ENGINE.decide(situation(said))
    assert (isinstance(made, Ask) and made.alarms) is alarms
    if not alarms and ("fire" in said or "smoke" in said):
        assert made == Answer("I am glad to hear that.")
