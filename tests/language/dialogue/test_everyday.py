"""What is said in passing: greetings with a place, thanks with an order, looks at nothing that is named."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.language.base import Situation, Turn
from parley.language.builtin.decision import Answer, Ask, Do, Edit, Forget, Remember
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Asked, Dialogue, Order
from parley.messages.chat import ActionCall
from parley.messages.memory import MemoryEntry
from parley.messages.pvf import Parameter
from parley.messages.status import PlanProposal
from parley.world.object_map import MapObject
from tests.language.builtin.test_sights import ABLE

ENGINE = BuiltinLanguage()
THINGS = (
    MapObject("l", "long bench in the hall", 2.0, 1.0),
    MapObject("s", "short bench in the hall", 3.0, 1.0),
    MapObject("g", "gate", 8.0, 1.0),
)
ROOMS = (MapObject("hall", "hall", 2.0, 2.0), MapObject("shop", "paint shop", 8.0, 2.0))


def at(message: str, **more: object) -> Situation:
    return Situation(
        message,
        objects=THINGS,
        rooms=ROOMS,
        robot="Ada",
        robots=("Ada",),
        catalogue=ABLE,
        **more,  # type: ignore[arg-type]
    )


def calls(message: str, **more: object) -> list[str]:
    made = ENGINE.decide(at(message, **more))
    assert isinstance(made, Do), made
    return [f"{d.skill.action.name} {' '.join(map(str, d.arguments.values()))}".strip() for d in made.deeds]


@pytest.mark.parametrize(
    "message", ["she's in her classroom", "Kim is sleeping in the hall", "a person is resting in the hall"]
)
def test_somebody_at_rest_somewhere_is_no_emergency(message: str) -> None:
    made = ENGINE.decide(at(message))
    assert not (isinstance(made, Ask) and made.alarms)


@pytest.mark.parametrize(
    "message",
    ["Kim is lying in the hall and does not move", "Kim! Kim!! help", "she is unconscious in her classroom"],
)
def test_somebody_in_need_still_is_one(message: str) -> None:
    made = ENGINE.decide(at(message))
    assert isinstance(made, Ask) and made.alarms


def test_a_greeting_with_a_name_does_not_hide_where_somebody_is() -> None:
    made = ENGINE.decide(at("Good morning Ada. My name is Ana, I'm at the gate"))
    assert isinstance(made, Remember) and made.told[0].text == "the operator is at the gate"


def test_thanks_do_not_hide_an_order() -> None:
    assert calls("thank you, go to the gate") == ["drive_to gate"]
    made = ENGINE.decide(at("thank you, go back to where you charge"))
    assert isinstance(made, Ask)


def test_thanks_before_what_comes_next_are_not_all_of_it() -> None:
    assert isinstance(ENGINE.decide(at("thanks, then the gate")), Ask)
    assert isinstance(ENGINE.decide(at("thank you, that's all for today")), Answer)


@pytest.mark.parametrize(
    "message", ["is the gate free?", "hi, is the gate free?", "Ada, is the gate free?", "is the gate on?"]
)
def test_how_something_is_now_is_looked_at_however_the_question_begins(message: str) -> None:
    made = ENGINE.decide(at(message))
    assert isinstance(made, Ask) and made.offer


def test_who_is_sent_to_look_at_it_looks() -> None:
    assert calls("go look at the gate") == ["look gate"]


def test_what_is_not_meant_is_not_done_as_well() -> None:
    given = {"place": Parameter("string", "long bench in the hall")}
    went = ActionCall(name="drive_to", input_parameters=given, reason="go to the long bench in the hall")
    before = Dialogue(orders=(Order("go to the long bench", calls=(went,)),), now_unix_ms=1)
    made = ENGINE.decide(at("wait, not the short bench, the gate", dialogue=before))
    assert isinstance(made, Edit)
    assert [str(call.input_parameters["place"].value) for call in made.change.add] == ["gate"]


@pytest.mark.parametrize("message", ["look around", "have a look around please"])
def test_who_is_to_look_at_nothing_named_looks_where_it_is(message: str) -> None:
    assert calls(message) == ["look what can be seen here"]


def test_a_room_is_looked_around_in_and_not_looked_for() -> None:
    assert calls("have a look around the paint shop")[-1] == "look what can be seen in the paint shop"


def test_a_look_that_is_only_led_to_is_one_look() -> None:
    assert calls("please look around and tell me what is at the gate") == ["look what is at the gate"]


def test_which_of_two_is_asked_of_a_question_that_only_a_look_answers() -> None:
    made = ENGINE.decide(at("is anybody on the bench?"))
    assert isinstance(made, Ask) and len(made.choices) == 2


def test_what_it_is_asked_to_be_able_to_do_and_cannot_is_said() -> None:
    made = ENGINE.decide(at("can you dance?"))
    assert isinstance(made, Answer) and "cannot dance" in made.text


def test_what_was_just_said_to_be_remembered_can_be_forgotten() -> None:
    told = MemoryEntry(name="nuts", data="Kim is allergic to nuts")
    turns = (Turn("operator", "what do you know about Kim"), Turn("assistant", f"I remember: {told.data}."))
    made = ENGINE.decide(at("forget that", memory=(told,), history=turns))
    assert isinstance(made, Forget) and made.names == ("nuts",)


def test_yes_go_there_takes_what_was_offered() -> None:
    asked = Dialogue(
        asked=Asked("smoke in the hall", ("Go to the hall", "Stay here"), alarm=True), now_unix_ms=1
    )
    assert calls("yes go there", dialogue=asked) == ["drive_to hall"]


def test_an_alarm_that_was_none_is_taken_as_that_later_too() -> None:
    made = ENGINE.decide(at("false alarm, he is fine"))
    assert isinstance(made, Answer) and "glad" in made.text


DOCK = (*THINGS, MapObject("d", "charging dock", 0.0, 0.0))
GATES = tuple(MapObject(f"g{n}", f"Gate {n}", float(n), 5.0) for n in "123")


def test_home_is_where_it_charges_if_no_place_is_called_so() -> None:
    made = ENGINE.decide(replace(at("go home"), objects=DOCK))
    assert isinstance(made, Do) and made.deeds[-1].arguments == {"place": "charging dock"}
    made = ENGINE.decide(replace(at("go to the nursing home"), objects=DOCK))
    assert isinstance(made, Ask)


def test_the_other_two_are_those_that_were_not_spoken_of() -> None:
    turns = (Turn("operator", "check gate 2"), Turn("assistant", "I looked."))
    made = ENGINE.decide(replace(at("check the other two as well", history=turns), objects=GATES))
    assert isinstance(made, Do)
    assert [deed.arguments["what"] for deed in made.deeds if deed.frame == "LOOK"] == ["Gate 1", "Gate 3"]


def test_it_is_what_was_proposed_last_and_not_what_that_stands_next_to() -> None:
    find = {"what": Parameter("string", "short bench in the hall")}
    waits = PlanProposal(
        id="p", target="Ada", words="now the bench next to it",
        steps=(ActionCall(name="locate", input_parameters=find),),
    )  # fmt: skip
    turns = (Turn("operator", "go to the gate"), Turn("operator", "now the bench next to it"))
    made = ENGINE.decide(at("look at it", history=turns, dialogue=Dialogue(proposal=waits, now_unix_ms=1)))
    assert isinstance(made, Do)
    assert [deed.arguments["what"] for deed in made.deeds] == ["short bench in the hall"]


def test_there_is_where_it_was_sent_last() -> None:
    turns = (Turn("operator", "go to the gate"), Turn("assistant", "I will go to the gate."))
    made = ENGINE.decide(at("look if the red crate is there", history=turns))
    assert isinstance(made, Do) and made.deeds[0].arguments == {"place": "gate"}


def test_a_robot_that_is_called_like_a_verb_knows_its_name() -> None:
    made = ENGINE.decide(replace(at("Spot, come to the gate"), robot="Spot", robots=("Spot",)))
    assert isinstance(made, Do)


def test_who_says_who_they_are_is_greeted() -> None:
    made = ENGINE.decide(at("I'm Maria, the night nurse"))
    assert isinstance(made, Answer) and made.text.startswith("Hello, Maria.")


def test_whether_something_is_in_a_room_is_offered_to_be_looked_at() -> None:
    made = ENGINE.decide(at("is there anything on the floor in the paint shop"))
    assert isinstance(made, Ask) and [deed.frame for deed in made.offer] == ["GO", "LOOK"]


def test_what_is_looked_for_where_it_was_sent_needs_no_second_place() -> None:
    looks = tuple(info for info in ABLE if info.name in ("drive_to", "look"))
    made = ENGINE.decide(replace(at("go to the gate and look for boxes, then tell me"), catalogue=looks))
    assert isinstance(made, Do)
    assert [[*deed.arguments.values()] for deed in made.deeds] == [["gate"], ["boxes"]]
