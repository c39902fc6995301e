"""Indexed graphs for tests, and a catalogue that holds them beside the actions."""

from __future__ import annotations

from typing import Any

from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph

from .spec_actions import SPECS, chain, node

LONG = 60.0


def ref(item: dict[str, Any], **more: Any) -> dict[str, Any]:
    """How a relation names a node."""
    return {"name": item["name"], "instance_id": item["instance_id"]} | more


def greet_twice() -> dict[str, Any]:
    """The example of section 15.4: input `right`, output `text`."""
    raw = chain("GreetTwice", [node("JoinText", 0, left="hello"), node("JoinText", 1, right="again")])
    raw["actions"][0]["children"][0]["remap"] = [{"from": "text", "to": "left"}]
    return raw


def bare(name: str) -> dict[str, Any]:
    """A node without parameters."""
    return {"name": name, "instance_id": 0, "type": "sync"}


RAW: list[dict[str, Any]] = [
    greet_twice(),
    chain("WaitLong", [node("WaitFor", 0, seconds=LONG)]),
    chain("InsistAWhile", [node("Insist", 0, seconds=0.01), node("NoOp", 1)]),
    chain("StubbornInside", [node("Stubborn", 0, seconds=0.2)]),
    chain("FailInside", [node("Fail", 0, reason="A box is in the way."), node("NoOp", 1)]),
    chain("RunDry", [node("NoOp", 0)], exit_conditions=["on_true -> ignore"]),
    chain("SayFalse", [node("SameText", 0, text="a", expected="b")]),
    chain("First", [bare("Second")]),
    chain("Second", [bare("First")]),
]
CATALOGUE = Catalogue(SPECS, map(read_graph, RAW))


def use(name: str, instance_id: int = 0, **values: Any) -> dict[str, Any]:
    """A node behind which an indexed graph stands."""
    spec = CATALOGUE.get(name)
    assert spec is not None
    inputs: dict[str, Any] = {key: {"pvf_type": item.type} for key, item in spec.inputs.items()}
    for key, value in values.items():
        inputs[key]["pvf_value"] = value
    outputs = {key: {"pvf_type": item.type} for key, item in spec.outputs.items()}
    return {
        "name": name,
        "instance_id": instance_id,
        "type": "sync",
        "input_parameters": inputs,
        "output_parameters": outputs,
    }


RAW += [
    chain("GreetThrice", [use("GreetTwice", 0), node("JoinText", 1, right="!")]),
    chain("WaitDeep", [use("WaitLong", 0)]),
]
RAW[-2]["actions"][0]["children"][0]["remap"] = [{"from": "text", "to": "left"}]

CATALOGUE.replace(SPECS, map(read_graph, RAW))
