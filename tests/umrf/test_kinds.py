"""What inputs take: as their makers say, else derived from name, type and description."""

from __future__ import annotations

import json

import pytest

from parley.errors import GraphRefusedError
from parley.messages.status import ActionInfo
from parley.umrf.action import action
from parley.umrf.catalogue import fully_described, info_of
from parley.umrf.io import read_descriptor, write_descriptor
from parley.umrf.kinds import parameters_of


def derived(pvf_type: str, name: str, description: str = "") -> tuple[str, str, tuple[str, ...]]:
    info = ActionInfo(name="a", inputs={name: pvf_type}, description=description)
    told = parameters_of(info)[name]
    return told.kind, told.unit, told.choices


@pytest.mark.parametrize(
    ("pvf_type", "name", "description", "expected"),
    [
        ("string", "dropPlace", "", ("place", "", ())),
        ("string", "who", "", ("person", "", ())),
        ("string", "spoken_text", "", ("text", "", ())),
        ("string", "lever", "", ("thing", "", ())),
        ("number", "height_cm", "", ("distance", "centimetres", ())),
        ("int", "value", "Turn by so many degrees.", ("angle", "degrees", ())),
        ("number", "deg_c", "", ("number", "celsius", ())),
        ("float", "m_per_min", "", ("number", "", ())),
        ("string", "mode", "Run; mode is slow, middle or full.", ("choice", "", ("slow", "middle", "full"))),
        ("slow|full", "x", "", ("choice", "", ("slow", "full"))),
        ("bool", "x", "", ("choice", "", ("yes", "no"))),
    ],
)
def test_what_a_foreign_input_takes_is_derived(
    pvf_type: str, name: str, description: str, expected: tuple[str, str, tuple[str, ...]]
) -> None:
    assert derived(pvf_type, name, description) == expected


def test_a_unit_of_one_number_is_not_that_of_another() -> None:
    inputs = {"joint": "number", "degrees": "number"}
    told = parameters_of(ActionInfo(name="a", inputs=inputs, description="Turn a joint by so many degrees."))
    assert (told["joint"].kind, told["degrees"].kind) == ("number", "angle")


@action(
    kinds={"target": "person"}, units={"depth": "feet"}, tests={"dig for Kim": {"target": "Kim"}, "dig": None}
)
def dig(ctx: object, target: str, depth: float = 2.0) -> None:
    """Dig a hole.

    Args:
        ctx: What it sees.
        target: For whom.
        depth: How deep.
    """


def test_what_the_maker_says_counts_and_a_descriptor_keeps_it() -> None:
    for spec in (dig.spec, read_descriptor(write_descriptor(fully_described(dig.spec)))):
        told = info_of(spec).parameters
        assert (told["target"].kind, told["target"].help) == ("person", "For whom.")
        assert (told["depth"].kind, told["depth"].unit, told["depth"].default) == ("distance", "feet", 2.0)
        assert spec.tests == dig.spec.tests


def test_a_kind_of_no_input_is_refused() -> None:
    with pytest.raises(ValueError, match="there is no input 'tarrget'"):
        action(kinds={"tarrget": "person"})(lambda ctx: None)


@pytest.mark.parametrize(
    ("extras", "path"),
    [
        ({"phrazes": []}, "parley.phrazes"),
        ({"parameters": {"x": {"kynd": "place"}}}, "parley.parameters.x.kynd"),
        ({"parameters": {"x": {"kind": "planet"}}}, "parley.parameters.x.kind"),
        ({"parameters": {"y": {}}}, "parley.parameters.y"),
        ({"tests": [{"say": "go", "inputs": {"z": 1}}]}, "parley.tests[0].inputs.z"),
        ({"timeout_s": -1}, "parley.timeout_s"),
    ],
)
def test_what_nobody_knows_in_a_descriptor_is_refused_with_its_place(extras: object, path: str) -> None:
    raw = {"name": "A", "type": "sync", "input_parameters": {"x": {"pvf_type": "string"}}, "parley": extras}
    with pytest.raises(GraphRefusedError) as error:
        read_descriptor(json.dumps(raw))
    assert [problem.path for problem in error.value.problems] == [path]
