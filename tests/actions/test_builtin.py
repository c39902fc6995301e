"""What the built-in actions tell others about themselves; the first five are the thesis's."""

from __future__ import annotations

from parley.actions.builtin import BUILTIN_ACTIONS

POSE = {
    f"pose::{part}::{axis}": "number"
    for part, axes in (("position", "xyz"), ("orientation", "rpy"))
    for axis in axes
}


def test_parameters_are_those_of_the_thesis() -> None:
    found = {
        spec.name: (
            {name: parameter.type for name, parameter in spec.inputs.items()},
            {name: parameter.type for name, parameter in spec.outputs.items()},
        )
        for spec in BUILTIN_ACTIONS
    }
    assert found == {
        "GetCoordinates": ({"target": "string"}, POSE),
        "NavigateTo": (POSE, {}),
        "Inspect": ({"inspect": "string"}, {"inspection_result": "string"}),
        "AskOperator": ({"question": "string"}, {"answer": "string"}),
        "KeepPicture": ({"name": "string"}, {}),
        "MoveBy": ({"distance": "number", "direction": "string"}, {}),
        "TurnBy": ({"angle": "number", "direction": "string"}, {}),
        "TakePicture": ({"target": "string"}, {}),
        "Wait": ({"duration": "number"}, {}),
        "WaitForRobot": ({"robot": "string", "order": "string"}, {}),
        "Say": ({"text": "string", "to": "string"}, {}),
        "Follow": ({"person": "string", "duration": "number"}, {}),
        "Dock": ({}, {}),
        "PickUp": ({"thing": "string"}, {}),
        "Place": ({"thing": "string"}, {}),
    }


def test_effects_say_who_moves_and_who_asks() -> None:
    assert {spec.name: spec.effects for spec in BUILTIN_ACTIONS} == {
        "GetCoordinates": ("locates",), "NavigateTo": ("moves",), "Inspect": ("looks",),
        "AskOperator": ("asks_operator",), "KeepPicture": ("remembers",), "MoveBy": ("moves",),
        "TurnBy": ("turns",), "TakePicture": ("looks", "shows"), "Wait": ("waits",),
        "WaitForRobot": ("waits",), "Say": ("speaks",), "Follow": ("follows", "moves"), "Dock": ("moves",),
        "PickUp": ("grasps",), "Place": ("places",),
    }  # fmt: skip


def test_every_action_explains_itself() -> None:
    assert all(spec.description.endswith(".") for spec in BUILTIN_ACTIONS)
