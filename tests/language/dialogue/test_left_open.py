"""What a reply leaves open is kept as data: nobody reads the robot's own words again."""

from __future__ import annotations

from parley.agents.chat.log import Log
from parley.language.base import Situation, Turn
from parley.language.builtin.decision import Answer, Ask, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Asked, Order
from parley.messages.chat import ActionCall, LeftOpen
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()


async def left_by(message: str) -> LeftOpen:
    return (await ENGINE.interpret(situation(message))).left_open


def after(log: Log, message: str, *said: str) -> Situation:
    turns = tuple(Turn("assistant", text) for text in said)
    return situation(message, history=turns, dialogue=log.state(None, None, 1))


async def test_an_order_that_waits_is_done_once_when_it_is_told() -> None:
    message, log = "when Ada is back, go to the desk", Log()
    log.on_left_open(message, await left_by(message))
    assert isinstance(ENGINE.decide(after(log, "Ada is back")), Do)
    log.on_order(Order("Ada is back", calls=(ActionCall(name="go"),)))
    assert not isinstance(ENGINE.decide(after(log, "Ada is back")), Do)


async def test_a_fact_beside_a_question_counts_later() -> None:
    log, message = Log(), "Kim is in the yard. Go to the moon."
    log.on_left_open(message, await left_by(message))
    found = ENGINE.decide(after(log, "where is Kim?"))
    assert isinstance(found, Answer) and "yard" in found.text


def test_an_emergency_stays_one_through_a_second_question() -> None:
    log = Log()
    log.on_asked(Asked("Kim fell", alarm=True))
    log.on_asked(Asked("Kim fell", ("red box", "blue box")))
    assert "glad" in str(ENGINE.decide(after(log, "it was a false alarm")))


def test_what_the_robot_only_said_opens_nothing() -> None:
    made = ENGINE.decide(after(Log(), "it was a false alarm", "That sounds like an emergency"))
    assert "glad" not in str(made)
    asked = "I do not know where you are. Which place is it near?"
    assert isinstance(ENGINE.decide(after(Log(), "near the gate", asked)), Ask | Answer)


def test_a_place_answers_what_was_ordered_behind_a_stop() -> None:
    log = Log()
    log.on_asked(Asked("come back to me", where="you"))
    said = (Turn("operator", "stop and come back to me"), Turn("assistant", "I do not know where you are."))
    told = situation("I'm at the desk", history=said, dialogue=log.state(None, None, 1))
    made = ENGINE.decide(told)
    assert isinstance(made, Do) and made.told and not made.notes
