"""`parley graph convert`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from parley.cli import command_line
from parley.errors import ParleyError

GRAPH = {
    "graph_name": "two",
    "graph_entry": [{"name": "A"}],
    "graph_exit": [{"name": "B"}],
    "actions": [
        {"name": "A", "type": "sync", "children": [{"name": "B"}]},
        {"name": "B", "type": "sync", "parents": [{"name": "A"}]},
    ],
}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "two.umrf.graph.json"
    path.write_text(json.dumps(GRAPH), encoding="utf-8")
    return path


def parley(*arguments: str | Path) -> Result:
    return CliRunner().invoke(command_line(), ["graph", *map(str, arguments)])


def test_a_graph_goes_to_a_tree_and_back(file: Path) -> None:
    tree, back = file.parent / "two.xml", file.parent / "back.json"
    assert parley("convert", file, "--to", "btcpp", "--out", tree).exit_code == 0
    assert '<Action ID="A" name="A_0" on_false="SUCCESS" />' in tree.read_text(encoding="utf-8")
    assert parley("convert", tree, "--to", "umrf", "--out", back).exit_code == 0
    again = parley("convert", back, "--to", "btcpp")
    assert again.stdout == tree.read_text(encoding="utf-8")


def test_what_cannot_be_converted_is_refused_with_reasons_and_writes_nothing(file: Path) -> None:
    file.write_text(json.dumps(GRAPH).replace('"sync"', '"spontaneous"'), encoding="utf-8")
    out = file.parent / "two.xml"
    refused = parley("convert", file, "--to", "btcpp", "--out", out, "--json")
    assert refused.exit_code == 1
    assert [json.loads(line)["code"] for line in refused.stdout.splitlines()] == [
        "spontaneous",
        "spontaneous",
    ]
    assert not out.exists()


def test_a_tree_that_cannot_be_imported_is_refused_with_its_line(file: Path) -> None:
    tree = file.parent / "tree.xml"
    tree.write_text(
        '<root BTCPP_format="4"><BehaviorTree>\n<Switch2/></BehaviorTree></root>', encoding="utf-8"
    )
    refused = parley("convert", tree, "--to", "umrf")
    assert refused.exit_code == 1
    assert refused.stderr.startswith("line 2, <Switch2>: ")
    assert refused.stdout == "", "where the converted graph would stand"


@pytest.mark.parametrize("form", ["umrf", "btcpp"])
def test_what_is_no_graph_is_refused_and_what_is_not_there_is_another_matter(file: Path, form: str) -> None:
    assert isinstance(parley("convert", file.parent / "none", "--to", form).exception, ParleyError)
    file.write_text("{", encoding="utf-8")
    assert parley("convert", file, "--to", form).exit_code == 1
