"""The catalogue: finding, matching, merging, and descriptor files good and bad."""

from __future__ import annotations

from pathlib import Path

import pytest

from parley.messages.pvf import Parameter
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue, descriptor_file_name, merge
from parley.umrf.discovery import ActionFolder
from parley.umrf.io import write_descriptor
from parley.umrf.model import Node

from .spec_actions import CATALOGUE, SPECS


def spec(**inputs: Parameter) -> ActionSpec:
    return ActionSpec("Move", inputs, {"at": Parameter("number")}, description="Move.", phrases=("go",))


@pytest.mark.spec("7.2")
def test_a_node_matches_by_name_and_flat_names_whatever_the_types() -> None:
    catalogue = Catalogue([spec(x=Parameter("number"))])
    outputs = {"at": Parameter("string")}
    assert catalogue.match(
        Node("Move", 3, input_parameters={"x": Parameter("string")}, output_parameters=outputs)
    )
    assert catalogue.match(Node("Move", input_parameters={"x": Parameter("number")})) is None
    assert catalogue.match(Node("Move", output_parameters=outputs)) is None
    assert catalogue.match(Node("Jump")) is None


@pytest.mark.spec("7.2")
def test_the_first_descriptor_of_a_name_wins() -> None:
    first, second = spec(), spec(x=Parameter("number"))
    catalogue = Catalogue([first, second])
    assert catalogue.get("Move") is first
    assert [spec.name for spec in catalogue] == ["Move"]


def test_suggestions_are_near_misses_only() -> None:
    assert CATALOGUE.suggestions("jointext")[0] == "JoinText"
    assert CATALOGUE.suggestions("WiatFor")[0] == "WaitFor"
    assert CATALOGUE.suggestions("Xylophone") == []


def test_infos_tell_parameters_as_types() -> None:
    [info] = Catalogue([spec(x=Parameter("number"))]).infos()
    assert (info.name, info.inputs, info.outputs) == ("Move", {"x": "number"}, {"at": "number"})
    assert (info.description, info.phrases) == ("Move.", ("go",))


@pytest.mark.spec("7.3", "D35", "4.2")
def test_merging_takes_all_but_value_and_allowed_values_from_the_descriptor() -> None:
    known = spec(
        x=Parameter("number", 1.0, required=False, updatable=False, allowed=(1.0,)),
        y=Parameter("number", 2.0),
        z=Parameter("string"),
    )
    node = Node(
        "Move",
        input_parameters={
            "x": Parameter("number"),
            "y": Parameter("number", 5.0, allowed=(5.0,)),
            "z": Parameter("number", 7.0),
        },
    )
    assert merge(node, known).input_parameters == {
        "x": Parameter("number", 1.0, required=False, updatable=False),
        "y": Parameter("number", 5.0, allowed=(5.0,)),
        "z": Parameter("number", 7.0),
    }


@pytest.mark.spec("7.1")
def test_file_names_follow_the_convention() -> None:
    assert descriptor_file_name("GetCoordinates") == "get_coordinates.umrf.json"
    assert descriptor_file_name("A") == "a.umrf.json"


@pytest.mark.spec("7.1")
def test_descriptors_are_read_from_a_folder_and_two_levels_below(tmp_path: Path) -> None:
    for depth, item in enumerate(SPECS[:4]):
        folder = tmp_path.joinpath(*["deeper"] * depth)
        folder.mkdir(exist_ok=True)
        (folder / descriptor_file_name(item.name)).write_text(write_descriptor(item), encoding="utf-8")
    (tmp_path / "bad.umrf.json").write_text("{", encoding="utf-8")
    (tmp_path / "latin.umrf.json").write_bytes(b"\xff")
    index = ActionFolder(tmp_path)
    index.scan()
    assert {item.name for item in index.found.specs} == {item.name for item in SPECS[:3]}
    assert [text.partition(" ")[0] for text in index.found.problems] == ["bad.umrf.json", "latin.umrf.json"]
