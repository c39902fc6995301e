"""The parameter tree (`pvf_type`, `pvf_value`, name levels) and its flat form."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.errors import InvalidMessageError
from parley.messages.pvf import NATIVE_TYPES, Parameter, fits_type, read_parameters, write_parameters

numbers = st.floats(allow_nan=False, allow_infinity=False)
VALUES: dict[str, st.SearchStrategy[Any]] = {
    "string": st.text(),
    "number": numbers,
    "bool": st.booleans(),
    "strings": st.lists(st.text()),
    "numbers": st.lists(numbers),
    "bools": st.lists(st.booleans()),
}


@st.composite
def parameters(draw: st.DrawFn) -> Parameter:
    kind = draw(st.sampled_from(NATIVE_TYPES))
    value = VALUES[kind]
    return Parameter(
        kind,
        draw(st.none() | value),
        updatable=draw(st.booleans()),
        allowed=tuple(draw(st.lists(value, max_size=3))),
    )


# Leaves and levels never share a name, as in any tree.
levels = st.sampled_from(["pose", "position", "orientation"])
leaves = st.sampled_from(["x", "y", "target", "pvf_value"])
names = st.builds(lambda path, leaf: "::".join([*path, leaf]), st.lists(levels, max_size=3), leaves)


@given(st.dictionaries(names, parameters(), max_size=6))
def test_what_was_written_is_read_back_the_same(flat: dict[str, Parameter]) -> None:
    tree = write_parameters(flat)
    assert read_parameters(tree) == flat
    assert write_parameters(read_parameters(tree)) == tree


def test_levels_are_joined_to_flat_names() -> None:
    tree = {"pose": {"position": {"x": {"pvf_type": "number", "pvf_value": 2}}}, "t": {"pvf_type": "string"}}
    flat = read_parameters(tree)
    assert flat == {"pose::position::x": Parameter("number", 2.0), "t": Parameter("string")}
    assert type(flat["pose::position::x"].value) is float


def test_flags_are_read_and_a_missing_value_means_no_data_yet() -> None:
    tree = {
        "a": {
            "pvf_type": "string",
            "pvf_required": False,
            "pvf_updatable": False,
            "pvf_allowed_values": ["x", "y"],
        }
    }
    (parameter,) = read_parameters(tree).values()
    assert parameter == Parameter("string", None, required=False, updatable=False, allowed=("x", "y"))
    assert not parameter.has_data
    assert parameter.with_value("x").has_data


@pytest.mark.parametrize("nothing", [None, {}, {"level": {}}])
def test_no_parameters_may_be_spelt_in_several_ways(nothing: Any) -> None:
    assert read_parameters(nothing) == {}


def test_an_opaque_type_is_kept_but_its_value_is_never_written() -> None:
    flat = {"image": Parameter("sensor_msgs::Image", object())}
    assert write_parameters(flat) == {"image": {"pvf_type": "sensor_msgs::Image"}}


@pytest.mark.parametrize(
    ("tree", "path"),
    [
        ([], "input_parameters"),
        ("text", "input_parameters"),
        ({"a": 3}, "input_parameters.a"),
        ({"a": {"b": None}}, "input_parameters.a.b"),
        ({"a": {"pvf_type": 3}}, "input_parameters.a.pvf_type"),
        ({"a": {"pvf_type": ""}}, "input_parameters.a.pvf_type"),
        ({"a": {"pvf_type": "number", "pvf_value": "3"}}, "input_parameters.a.pvf_value"),
        ({"a": {"pvf_type": "number", "pvf_value": True}}, "input_parameters.a.pvf_value"),
        ({"a": {"pvf_type": "number", "pvf_value": None}}, "input_parameters.a.pvf_value"),
        ({"a": {"pvf_type": "number", "pvf_value": 10**400}}, "input_parameters.a.pvf_value"),
        ({"a": {"pvf_type": "numbers", "pvf_value": [1, "2"]}}, "input_parameters.a.pvf_value"),
        ({"a": {"pvf_type": "bool", "pvf_value": 1}}, "input_parameters.a.pvf_value"),
        ({"a": {"pvf_type": "string", "pvf_required": "yes"}}, "input_parameters.a.pvf_required"),
        ({"a": {"pvf_type": "string", "pvf_updatable": 1}}, "input_parameters.a.pvf_updatable"),
        ({"a": {"pvf_type": "string", "pvf_allowed_values": "x"}}, "input_parameters.a.pvf_allowed_values"),
    ],
)
def test_what_is_no_parameter_is_refused_with_its_path(tree: Any, path: str) -> None:
    with pytest.raises(InvalidMessageError) as refused:
        read_parameters(tree)
    assert refused.value.path == path


@pytest.mark.parametrize("kind", NATIVE_TYPES)
def test_values_of_other_types_do_not_fit(kind: str) -> None:
    others: list[Any] = [None, {}, object(), float("nan"), float("inf"), (1,)]
    assert not any(fits_type(kind, value) for value in others)


def test_an_opaque_type_fits_no_json_value() -> None:
    values: list[Any] = [None, 1, "x", [], {}]
    assert not any(fits_type("Pose", value) for value in values)
