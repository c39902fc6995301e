"""Functions as actions: the descriptor that is derived, and values in and out."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Literal

import pytest

from parley.errors import ActionFailure
from parley.messages.pvf import Parameter
from parley.umrf.action import ActionSpec, Outcome, action, bind_inputs, outcome_of

if TYPE_CHECKING:
    from somewhere_else import OnlyForTypeCheckers  # type: ignore[import-not-found]


@dataclass(frozen=True)
class Position:
    x: float
    y: float
    z: float = 0.0


@dataclass(frozen=True)
class Pose:
    position: Position
    yaw: float


@dataclass(frozen=True)
class Found:
    pose: Pose
    names: list[str]
    count: int
    note: str | None = None


class Colour(StrEnum):
    RED = "red"
    GREEN = "green"


class Picture:
    """Opaque to JSON."""


@action(phrases=("look for {thing}",), effects=("looks",), risk="none", capabilities=("camera",))
async def look_for(ctx: OnlyForTypeCheckers, thing: str, near: Pose, tries: int = 3) -> Found:  # noqa: D417
    """Look for a thing.

    It may take a while.

    Args:
        thing: What to look for,
            in words.
        near (Pose): Where to begin.

    Returns:
        What was found.
    """
    return Found(near, [thing], tries)


def test_the_descriptor_is_derived_from_the_signature() -> None:
    spec = look_for.spec
    assert spec.name == "LookFor"
    assert spec.inputs == {
        "thing": Parameter("string"),
        "near::position::x": Parameter("number"),
        "near::position::y": Parameter("number"),
        "near::position::z": Parameter("number", 0.0, required=False),
        "near::yaw": Parameter("number"),
        "tries": Parameter("number", 3.0, required=False),
    }
    assert list(spec.outputs) == [
        "pose::position::x",
        "pose::position::y",
        "pose::position::z",
        "pose::yaw",
        "names",
        "count",
        "note",
    ]
    assert [spec.outputs[name].type for name in ("names", "count", "note")] == ["strings", "number", "string"]


def test_the_descriptor_carries_how_people_ask_and_what_it_means() -> None:
    spec = look_for.spec
    assert spec.phrases == ("look for {thing}",)
    assert (spec.effects, spec.risk, spec.capabilities) == (("looks",), "none", ("camera",))
    assert spec.description == "Look for a thing. It may take a while."
    assert spec.help == {"thing": "What to look for, in words.", "near": "Where to begin."}


async def test_an_action_can_still_be_called() -> None:
    pose = Pose(Position(1.0, 2.0), 0.5)
    assert (await look_for(None, "box", pose)).names == ["box"]
    assert look_for.__doc__ is not None
    assert look_for.__doc__.startswith("Look for a thing.")


def test_flat_values_become_python_values() -> None:
    values = {
        "thing": "box",
        "near::position::x": 1.0,
        "near::position::y": 2.0,
        "near::yaw": 0.5,
        "tries": 4.0,
    }
    bound = bind_inputs(look_for.spec, values)
    assert bound == {"thing": "box", "near": Pose(Position(1.0, 2.0), 0.5), "tries": 4}
    assert type(bound["tries"]) is int


def test_inputs_without_data_are_left_to_their_defaults() -> None:
    values = {"thing": "box", "near::position::x": 1.0, "near::position::y": 2.0, "near::yaw": 0.5}
    assert "tries" not in bind_inputs(look_for.spec, values)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"near::position::x": 1.0}, "near::position::y is missing"),
        ({"tries": 2.5}, "tries must be a whole number"),
    ],
)
def test_values_that_do_not_fit_are_a_failure_in_words(values: dict[str, Any], words: str) -> None:
    with pytest.raises(ActionFailure, match=words):
        bind_inputs(look_for.spec, values)


@action
def colours(
    ctx: object,
    colour: Colour,
    mood: Literal["calm", "gay"],
    sizes: Sequence[float],
    corners: tuple[float, ...],
    flags: list[bool],
    picture: Picture | None = None,
    place: Pose | None = None,
) -> None:
    """Take every kind of argument."""


def test_every_kind_of_argument_has_its_type() -> None:
    inputs = colours.spec.inputs
    assert {name: inputs[name].type for name in list(inputs)[:6]} == {
        "colour": "string",
        "mood": "string",
        "sizes": "numbers",
        "corners": "numbers",
        "flags": "bools",
        "picture": "Picture",
    }
    assert inputs["colour"].allowed == ("red", "green")
    assert inputs["mood"].allowed == ("calm", "gay")
    assert not inputs["place::yaw"].required
    assert not inputs["picture"].required


def test_words_and_lists_become_what_the_function_expects() -> None:
    values = {"colour": "red", "mood": "calm", "sizes": [1.0], "corners": [1.0, 2.0], "flags": [True]}
    bound = bind_inputs(colours.spec, values)
    assert bound["colour"] is Colour.RED
    assert bound["corners"] == (1.0, 2.0)
    assert "place" not in bound
    with pytest.raises(ActionFailure, match="mood must be one of calm, gay"):
        bind_inputs(colours.spec, values | {"mood": "wild"})


@pytest.mark.parametrize(
    ("returned", "outcome"),
    [
        (None, Outcome(True)),
        (True, Outcome(True)),
        (False, Outcome(False)),
        (Outcome(False, {"count": 2}), Outcome(False, {"count": 2.0})),
        (
            Outcome(True, {"pose": Pose(Position(1, 2), 3)}),
            Outcome(
                True,
                {
                    "pose::position::x": 1.0,
                    "pose::position::y": 2.0,
                    "pose::position::z": 0.0,
                    "pose::yaw": 3.0,
                },
            ),
        ),
        (Outcome(True, {"note": "half \ud800"}), Outcome(True, {"note": "half ?"})),
    ],
)
def test_what_is_returned_becomes_a_result_with_flat_outputs(returned: Any, outcome: Outcome) -> None:
    assert outcome_of(look_for.spec, returned) == outcome


def test_a_returned_dataclass_is_flattened_without_its_gaps() -> None:
    outcome = outcome_of(look_for.spec, Found(Pose(Position(1, 2), 3), ["box"], 1))
    assert outcome.outputs["names"] == ["box"]
    assert "note" not in outcome.outputs


@pytest.mark.parametrize(
    "returned",
    [
        "text",
        Outcome(True, {"nonsense": 1}),
        Outcome(True, {"count": "many"}),
        Outcome(True, {"count": float("nan")}),
        Outcome(True, {"names": [1]}),
    ],
)
@pytest.mark.spec("D23")
def test_what_was_not_declared_is_a_failure(returned: Any) -> None:
    with pytest.raises(ActionFailure):
        outcome_of(look_for.spec, returned)


def test_names_types_and_parameters_can_be_spelt_by_hand() -> None:
    @action(
        name="Odd",
        description="An odd one.",
        inputs={"a::b": "string", "c": Parameter("number", 1.0, required=False)},
        outputs={"d::e": "bool"},
        units={"c": "m"},
        pausable=False,
        type="async",
    )
    def anything(ctx: object, a__b: str, c: float = 1.0) -> Outcome:
        return Outcome(True, {"d::e": a__b == "x"})

    spec = anything.spec
    assert (spec.name, spec.description, spec.type, spec.pausable) == ("Odd", "An odd one.", "async", False)
    assert spec.inputs["a::b"] == Parameter("string")
    assert spec.units == {"c": "m"}
    bound = bind_inputs(spec, {"a::b": "x", "c": 2.0})
    assert outcome_of(spec, anything(None, **bound)).outputs == {"d::e": True}


class Counter:
    """Count its own runs."""

    def __init__(self) -> None:
        self.runs = 0

    def run(self, ctx: object, step: float) -> bool:
        self.runs += 1
        return self.runs > step


@pytest.mark.spec("10.1")
def test_a_class_action_has_an_object_of_its_own_each_time() -> None:
    spec = action(Counter).spec
    assert (spec.name, spec.description, list(spec.inputs)) == ("Counter", "Count its own runs.", ["step"])
    first, second = spec.runner(), spec.runner()
    assert first is not None and second is not None
    assert [first(None, 1.0), first(None, 1.0), second(None, 1.0)] == [False, True, False]


def untyped(ctx, thing): ...  # type: ignore[no-untyped-def]


def starred(ctx: object, *things: str) -> None: ...


def listing(ctx: object) -> list[str]:
    return []


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (untyped, "'thing' needs a type annotation"),
        (starred, r"\*things"),
        (listing, "an action returns None, bool, a dataclass or Outcome"),
    ],
)
def test_what_cannot_be_described_is_refused_where_it_is_written(function: Any, words: str) -> None:
    with pytest.raises(TypeError, match=words):
        action(function)


def test_a_bare_descriptor_has_nothing_that_runs_it() -> None:
    assert ActionSpec("A", {}, {}).runner() is None


def test_async_and_plain_functions_are_told_apart() -> None:
    assert asyncio.iscoroutinefunction(look_for.spec.run)
    assert not asyncio.iscoroutinefunction(colours.spec.run)
