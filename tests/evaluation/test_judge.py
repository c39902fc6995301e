"""Each way of being wrong is caught, each equivalent form is accepted."""

from __future__ import annotations

from typing import Any

import pytest

from parley.messages.chat import ActionCall, ChatAction
from tests.evaluation.rig import answer, call, go, look, problems

INSPECT_RED = "{in: depot, say: inspect the red box, do: [go box_1, look red box]}"
GO_RED = "{in: depot, say: go to the red box, do: [go box_1]}"
TELL = "{in: depot, say: the lamp is on the door, remember: [[lamp, door]]}"
WHICH = "{in: depot, say: go to the box, asks: true}"
ADD_LAMP = {"add_memory": {"name": "lamp", "data": "The lamp is on the north door."}}


@pytest.mark.parametrize(
    "queue",
    [
        [*go("red box"), look("red box")],
        [*go("box_1"), look("the red box")],
        [*go("Red Box"), look("whether the red box is closed")],
        [call("NavigateTo", pose__position__x=3.0, pose__position__y=4.1), look("red box")],
    ],
    ids=["its description", "its id", "other case and more words", "its coordinates"],
)
def test_equivalent_plans_are_right(queue: list[ActionCall]) -> None:
    assert problems(INSPECT_RED, answer(*queue)) == []


@pytest.mark.parametrize(
    "queue",
    [
        [],
        go("red box"),
        [look("red box"), *go("red box")],
        [*go("blue box"), look("red box")],
        [*go("red box"), look("blue box")],
        [*go("box"), look("red box")],
        [*go("red box or blue box"), look("red box")],
        [*go("red box"), look("red box"), look("red box")],
        [*go("red box"), look("red box"), *go("north door")],
        [call("NavigateTo", pose__position__x=8.0, pose__position__y=4.0), look("red box")],
        [*go("red box"), call("Inspect", {"if": {"step": 0, "result": True}}, inspect="red box")],
        [*go("red box"), call("Inspect", {"together_with": 1}, inspect="red box")],
        [*go("red box"), call("Inspect", {"repeat": 2}, inspect="red box")],
    ],
    ids=[
        "nothing",
        "a step too few",
        "another order",
        "another place",
        "another thing looked at",
        "a word that fits several",
        "several named",
        "a step twice",
        "a step too many",
        "coordinates of another place",
        "a condition nobody asked for",
        "at the same time",
        "repeated",
    ],
)
def test_other_plans_are_wrong(queue: list[ActionCall]) -> None:
    assert problems(INSPECT_RED, answer(*queue))


def test_an_action_that_the_robot_does_not_have_is_wrong() -> None:
    assert problems("{in: depot, say: fly, any_do: true}", answer(call("Fly")))


def test_what_is_optional_may_be_there_or_not() -> None:
    text = "{in: depot, say: fetch the keys, do: [go box_1, look~ keys, ask]}"
    assert problems(text, answer(*go("red box"), call("AskOperator", question="Done?"))) == []
    assert problems(text, answer(*go("red box"), look("keys"), call("AskOperator", question="?"))) == []
    assert problems(text, answer(*go("red box"), look("keys")))


def test_arguments_count_by_name_and_not_by_the_order_in_which_they_are_given() -> None:
    text = '{in: store, say: give Kim the cup, do: ["HandOver(cup, Kim)"]}'
    assert problems(text, answer(call("HandOver", to="Kim", thing="the cup"))) == []
    assert problems(text, answer(call("HandOver", to="the cup", thing="Kim")))
    assert problems(text, answer(call("HandOver", thing="the cup")))


def test_numbers_are_compared_as_numbers() -> None:
    text = '{in: store, say: wait half a minute, do: ["Wait(30)"]}'
    assert problems(text, answer(call("Wait", duration_s=30.0))) == []
    assert problems(text, answer(call("Wait", duration_s=3)))


def test_back_is_where_the_robot_was() -> None:
    text = "{in: depot, say: go to the door and come back, do: [go door_1, back]}"
    back = call("NavigateTo", pose__position__y=2.0, pose__position__x=1.1)
    away = call("NavigateTo", pose__position__y=1.0, pose__position__x=2.0)
    assert problems(text, answer(*go("north door"), back)) == []
    assert problems(text, answer(*go("north door"), away))


def test_places_given_by_numbers_have_a_tolerance() -> None:
    text = '{in: depot, say: go to 3 4, do: ["at 3 4"]}'
    assert problems(text, answer(call("NavigateTo", pose__position__x=3.1, pose__position__y=3.9))) == []
    assert problems(text, answer(call("NavigateTo", pose__position__x=4.0, pose__position__y=3.0)))


def test_a_condition_has_to_be_the_right_one() -> None:
    text = '{in: depot, say: if it is open go to the red box, do: [go door_1, look open, "if 2: go box_1"]}'
    start = [*go("north door"), look("whether it is open")]
    then, unless, other = (
        go("red box", {"if": {"step": step, "result": result}})
        for step, result in ((2, True), (2, False), (1, True))
    )
    assert problems(text, answer(*start, *then)) == []
    assert problems(text, answer(*start, *unless))
    assert problems(text, answer(*start, *other))
    assert problems(text, answer(*start, *go("red box")))


@pytest.mark.parametrize(
    ("commands", "right"),
    [([{"stop": {}}], True), ([{"pause": {}}], True), ([], False), ([{"clear": {}}], False),
     ([{"stop": {}}, {"skip": {}}], False)],
)  # fmt: skip
def test_commands_have_to_be_the_same(commands: list[Any], right: bool) -> None:
    text = "{in: depot, say: stop, status: running, queue: [go box_1], commands: [stop]}"
    assert (problems(text, answer(commands=commands)) == []) is right


@pytest.mark.parametrize(
    ("commands", "right"),
    [
        ([ADD_LAMP], True),
        ([], False),
        ([{"add_memory": {"data": "The lamp is in the red box."}}], False),
        ([ADD_LAMP, {"add_memory": {"data": "Ada is nice."}}], False),
        ([ADD_LAMP, {"remove_memory": {"name": "keys_location"}}], False),
        ([ADD_LAMP, {"stop": {}}], False),
    ],
    ids=["told", "not kept", "kept wrongly", "more kept", "another forgotten", "stopped besides"],
)
def test_what_is_told_is_remembered_and_nothing_else(commands: list[Any], right: bool) -> None:
    assert (problems(TELL, answer(commands=commands)) == []) is right


def test_remembering_what_nobody_asked_to_remember_is_wrong_unless_it_is_let_pass() -> None:
    added = answer(*go("red box"), commands=[ADD_LAMP])
    assert problems(GO_RED, added)
    assert problems(GO_RED.replace("}", ", may_remember: true}"), added) == []


def test_a_memory_is_forgotten_by_its_name() -> None:
    text = "{in: depot, say: forget where the keys are, forget: [keys_location]}"
    assert problems(text, answer(commands=[{"remove_memory": {"name": "keys_location"}}])) == []
    assert problems(text, answer(commands=[{"remove_memory": {"name": "other"}}]))
    assert problems(text, answer())


def test_a_memory_that_may_be_forgotten_may_also_be_kept() -> None:
    text = "{in: depot, say: the keys are at the door, remember: [[keys, door]], may_forget: [keys_location]}"
    added = {"add_memory": {"data": "The keys are at the door."}}
    assert problems(text, answer(commands=[added])) == []
    assert problems(text, answer(commands=[{"remove_memory": {"name": "keys_location"}}, added])) == []


@pytest.mark.parametrize(
    ("given", "right"),
    [
        (answer(says="Which one: the red box or the blue box?"), True),
        (answer(says="I will go."), False),
        (answer(says="I am not sure what you mean. What can I do?"), False),
        (answer(*go("red box"), says="Shall I go to the red box?"), False),
        (answer(*go("box"), says="Which one?"), False),
    ],
    ids=["asked", "no question", "not understood", "guessed", "went off"],
)
def test_between_equals_a_question_is_due(given: ChatAction, right: bool) -> None:
    assert (problems(WHICH, given) == []) is right


@pytest.mark.parametrize(
    ("given", "right"),
    [
        (answer(says="I cannot paint."), True),
        (answer(call("AskOperator", question="Please paint the box."), says="I can't do that alone."), True),
        (answer(says="I will paint the box."), False),
        (answer(*go("red box"), says="I cannot paint, but I go there."), False),
    ],
    ids=["declined", "asked a person", "promised", "did something else"],
)
def test_what_cannot_be_done_is_declined(given: ChatAction, right: bool) -> None:
    assert (problems("{in: depot, say: paint the red box, declines: true}", given) == []) is right


def test_an_answer_says_what_was_asked_for_in_any_case_of_letters() -> None:
    text = "{in: depot, say: where are the keys, says: [red box|crimson box], says_not: [blue]}"
    assert problems(text, answer(says="In the Red Box.")) == []
    assert problems(text, answer(says="In the box."))
    assert problems(text, answer(says="In the red box or the blue one."))
    assert problems(text, answer(says=""))


def test_a_robot_that_says_nothing_is_wrong() -> None:
    assert problems(GO_RED, answer(*go("red box"), says=" "))


def test_a_message_that_is_to_be_understood_is_not_answered_by_saying_that_it_was_not() -> None:
    text = "{in: depot, say: thank you, understands: true}"
    assert problems(text, answer(says="You are welcome.")) == []
    assert problems(text, answer(says="I did not understand that."))


def test_the_robots_that_are_meant_have_to_be_the_same() -> None:
    text = "{in: depot, say: both go to the red box, do: [go box_1], targets: [Ada, Ben]}"
    assert problems(text, answer(*go("red box"), targets=["Ben", "Ada"])) == []
    assert problems(text, answer(*go("red box"), targets=["Ada"]))


def test_choices_that_are_offered_have_to_be_all_and_no_others() -> None:
    text = "{in: depot, say: go to the box, asks: true, choices: [box_1, box_2]}"
    asked = "Which one?"
    assert problems(text, answer(says=asked, choices=["blue box", "red box"])) == []
    assert problems(text, answer(says=asked, choices=["blue box"]))
    assert problems(text, answer(says=asked, choices=["blue box", "north door"]))


def test_sources_that_have_to_be_named_are_named() -> None:
    text = "{in: depot, say: where are the keys, says: [red], uses: [keys_location]}"
    assert problems(text, answer(says="In the red box.", sources=["keys_location"])) == []
    assert problems(text, answer(says="In the red box."))


def test_several_right_plans_and_any_order() -> None:
    either = "{in: depot, say: go to a box, do_any: [[go box_1], [go box_2]]}"
    assert problems(either, answer(*go("blue box"))) == []
    assert problems(either, answer(*go("red box"), *go("blue box")))
    both = "{in: depot, say: go to both, do: [go box_1, go box_2], any_order: true}"
    assert problems(both, answer(*go("blue box"), *go("red box"))) == []
    assert problems(both, answer(*go("blue box"), *go("blue box")))


def test_either_of_several_readings_is_right_and_a_mixture_is_not() -> None:
    text = "{in: depot, say: box, do: [go box_1], either: [{}, {do: [], asks: true}]}"
    assert problems(text, answer(*go("red box"))) == []
    assert problems(text, answer(says="What about the box?")) == []
    assert problems(text, answer(*go("blue box"), says="Shall I?"))
    assert problems(text, answer(says="No."))


def test_a_changed_plan_is_judged_by_what_is_pending_then() -> None:
    text = (
        "{in: depot, say: not the door, status: running, queue: [go box_1, go door_1, go box_2],"
        " final: [go box_1, go box_2]}"
    )
    dropped = [{"pop": {"parameters": 3}}, {"pop": {"parameters": "2"}}]
    assert problems(text, answer(commands=dropped)) == []
    anew = answer(*go("red box"), *go("blue box"), commands=[{"clear": {}}])
    assert problems(text, anew) == []
    assert problems(text, answer(commands=dropped[:1]))
    assert problems(text, answer(*go("blue box")))


def test_a_repair_says_whether_it_is_one() -> None:
    text = (
        "{in: depot, failed: [locate box], code: ambiguous, error: several boxes, reply: the red one,"
        " pending: [driving], success: true, do: [locate box_1]}"
    )
    repaired = call("GetCoordinates", target="red box")
    assert problems(text, answer(repaired, success=True)) == []
    assert problems(text, answer(repaired, success=False))
    assert problems(text, answer(call("GetCoordinates", target="blue box"), success=True))
