"""Who is called: what somebody is told who is no robot here is asked about, not done by who hears it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.gate.orders import Heard, admit
from parley.language.builtin.decision import Ask, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.principal import person
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()
KIM = person("Kim")
NOBODY = "No robot here is called “Ruth”. Shall I do it?"


@pytest.mark.parametrize("robots", [("Ada",), ("Ada", "Bo")])
@pytest.mark.parametrize(
    "said",
    [
        "Ruth, could you go to the office?",
        "Ruth go to the office",
        "hey Ruth can you go to the office",
        "Please go to the office, Ruth.",
        "Okay, Ruth, go to the office",
        "Inspect the pump. Ruth, go to the office.",
    ],
)
def test_an_order_to_somebody_who_is_not_there_is_offered(said: str, robots: tuple[str, ...]) -> None:
    decision = ENGINE.decide(situation(said, robots=robots))
    assert isinstance(decision, Ask)
    assert decision.question == NOBODY
    assert [deed.arguments.get("place") for deed in decision.offer][-1] == "office"


@pytest.mark.parametrize("said", ["Bo, go to the moon", "Bo, glorp to the zorg"])
def test_what_is_asked_about_the_order_of_another_robot_is_asked_by_that_one(said: str) -> None:
    decision = ENGINE.decide(situation(said, robots=("Ada", "Bo")))
    assert isinstance(decision, Ask)
    assert decision.robots == ("Bo",)


@pytest.mark.parametrize(
    "said",
    [
        "Ada, go to the office",
        "Robot, go to the office",
        "Good morning, go to the office",
        "Something fell over: go to the office",
        "Kim is in the yard, go to the office",
        "In the office, look for Kim",
        "go to the yard, pump, office",
    ],
)
def test_a_word_that_calls_nobody_is_no_name(said: str) -> None:
    decision = ENGINE.decide(situation(said))
    assert "called" not in getattr(decision, "question", "")


def test_a_word_of_assent_before_an_order_is_no_part_of_it() -> None:
    assert isinstance(ENGINE.decide(situation("Perfect, go to the office")), Do)


def test_a_slip_in_the_name_of_who_hears_it_is_asked_about_and_that_of_another_not_done() -> None:
    slip = ENGINE.decide(situation("Aad, go to the office"))
    assert isinstance(slip, Ask)
    assert (slip.question, len(slip.offer)) == ("Do you mean Ada?", 1)
    other = ENGINE.decide(situation("Rthu, go to the office", robots=("Ada", "Ruth")))
    assert isinstance(other, Ask)
    assert (other.question, other.offer) == ("Do you mean Ruth? Please call Ruth by name first.", ())


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ("Ruth, go to the office", "No robot here is called “Ruth”"),
        ("all right, go to the yard", "I did not understand"),
    ],
)
async def test_the_card_says_why_a_yes_is_wanted(said: str, why: str) -> None:
    answer = await ENGINE.interpret(situation(said))
    order = admit(answer.model_copy(update={"queue": answer.offer}), Heard(said, by=KIM, robot="Ada")).order
    assert order.needs_yes.startswith(why)


@pytest.mark.parametrize(
    "said",
    ["{}, inspect the pump", "{} inspect the pump", "hey {}, inspect the pump", "Inspect the pump, {}."],
)
def test_a_robot_whose_name_is_a_deed_too_is_only_called_by_it(said: str) -> None:
    for name in ("Spot", "Ada"):
        heard = replace(situation(said.format(name)), robot=name, robots=(name, "Bo"))
        decision = ENGINE.decide(heard)
        assert decision == ENGINE.decide(replace(heard, message="Inspect the pump.")), name
