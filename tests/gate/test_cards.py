"""Cards say what is done, whatever a language engine would have people read."""

from __future__ import annotations

from typing import Any

import pytest

from parley.gate.cards import command_label, digest_of, labels_of, lines_of
from parley.messages.chat import ActionCall, Flow, SystemCommand
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

X, Y = "pose::position::x", "pose::position::y"
FIND = ActionInfo(name="Find", inputs={"target": "string"}, outputs={X: "number", Y: "number"},
                  label="Find out where {target} is", effects=("locates",))  # fmt: skip
GO = ActionInfo(name="GoTo", inputs={X: "number", Y: "number"}, phrases=("go to {place}",))
HONK = ActionInfo(name="HonkLoudly", inputs={"times": "number"})
CATALOGUE = (FIND, GO, HONK)
BOX = MapObject("box_1", "red box", 3.0, 2.0)


def call(name: str, reason: str = "", **inputs: Any) -> ActionCall:
    kinds = {str: "string", float: "number", int: "number"}
    given = {key: Parameter(kinds[type(value)], value) for key, value in inputs.items()}
    return ActionCall(name=name, input_parameters=given, reason=reason)


def drive(x: float | None = None, y: float = 0.0, reason: str = "") -> ActionCall:
    inputs = {X: Parameter("number", x), Y: Parameter("number", y if x is not None else None)}
    return ActionCall(name="GoTo", input_parameters=inputs, reason=reason)


def find(target: str, reason: str = "") -> ActionCall:
    outputs = {X: Parameter("number"), Y: Parameter("number")}
    return call("Find", reason, target=target).model_copy(update={"output_parameters": outputs})


def test_a_card_is_made_of_action_and_arguments_and_never_of_the_reason() -> None:
    told = labels_of([find("red box", "Look at the clock"), drive(reason="Look at the clock")], CATALOGUE)
    assert told == ("Find out where “red box” is", "Go to “red box”")


def test_a_pose_is_told_by_the_map() -> None:
    assert labels_of([drive(3.2, 2.1)], CATALOGUE, [BOX]) == ("Go to a place near “red box”",)
    assert labels_of([drive(30.0, 2.0)], CATALOGUE, [BOX]) == ("Go to a place 27 m from “red box”",)
    assert labels_of([drive(30.0, 2.0)], CATALOGUE) == ("Go to “x 30.0 m, y 2.0 m”",)


def test_an_action_without_words_of_its_own_is_told_by_its_name_and_every_argument() -> None:
    assert labels_of([call("HonkLoudly", times=3)], CATALOGUE) == ("Honk loudly: times 3",)
    assert labels_of([call("Unknown_Thing", where="hall")], CATALOGUE) == ("Unknown thing: where “hall”",)


def test_a_search_for_the_next_step_only_is_no_line_of_its_own_and_is_not_counted() -> None:
    hurry = drive().model_copy(update={"flow": Flow(together_with=3)})
    calls = [find("box"), call("Look"), find("shelf"), drive(), hurry, find("bell")]
    labels = labels_of(calls, CATALOGUE)
    together = "At the same time as step 3: Go to “shelf”"
    assert labels[1:] == ("Look", "Find out where “shelf” is", "Go to “shelf”", together, labels[-1])
    shown = ("Find out where “box” is", "Look", "Go to “shelf”", together, "Find out where “bell” is")
    assert lines_of(calls, labels, CATALOGUE) == shown


@pytest.mark.parametrize(
    ("target", "shown"),
    [
        ("box” is, then nothing more “", "“box’ is, then nothing more ‘”"),
        ("box\nKim: yes", "“box / Kim: yes”"),
        ("go\u202eback", "“go⟨U+202E⟩back”"),
    ],
)
def test_an_argument_cannot_end_its_quotation_nor_hide_anything(target: str, shown: str) -> None:
    assert labels_of([find(target)], CATALOGUE) == (f"Find out where {shown} is",)


def test_what_a_command_changes_is_told() -> None:
    assert command_label(SystemCommand(command="pop"), "Go to “box”") == "Leave out: Go to “box”"
    forget = SystemCommand(command="remove_memory", arguments={"name": "key place"})
    assert command_label(forget) == "Forget “key place”"


def test_a_digest_names_robot_arguments_changes_and_where_things_stand_but_no_words() -> None:
    plan = [find("red box"), drive()]
    digest = digest_of("Ada", plan, (), [BOX])
    assert digest == digest_of("Ada", [find("red box", "another reason"), drive()], (), [BOX])
    pop = SystemCommand(command="pop", arguments={"parameters": 0})
    others = [
        digest_of("Bo", plan, (), [BOX]),
        digest_of("Ada", plan[::-1], (), [BOX]),
        digest_of("Ada", [find("red boxes"), drive()], (), [BOX]),
        digest_of("Ada", plan, (pop,), [BOX]),
        digest_of("Ada", plan, (), [MapObject("box_1", "red box", 9.0, 2.0)]),
    ]
    assert len({digest, *others}) == 6
