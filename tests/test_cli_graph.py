"""`parley graph` on files."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from parley.cli import command_line
from parley.errors import ConfigError, ParleyError

GRAPH = {
    "graph_name": "two",
    "graph_entry": [{"name": "A"}],
    "graph_exit": [{"name": "B"}],
    "actions": [
        {"name": "A", "type": "sync", "state": "RUNNING", "children": [{"name": "B"}]},
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


@pytest.mark.parametrize(
    ("how", "start"), [("text", "graph two"), ("mermaid", "flowchart TD"), ("svg", "<svg ")]
)
def test_a_graph_is_shown(file: Path, how: str, start: str) -> None:
    shown = parley("show", file, "--format", how)
    assert shown.exit_code == 0
    assert shown.stdout.startswith(start)
    assert "RUNNING" in shown.stdout


def test_what_is_shown_can_go_to_a_file(file: Path) -> None:
    out = file.parent / "picture.svg"
    assert parley("show", file, "--format", "svg", "--out", out).stdout == ""
    assert out.read_text(encoding="utf-8") == parley("show", file, "--format", "svg").stdout


def test_converting_says_what_to_install(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "parley_bt", None)
    refused = parley("convert", file, "--to", "btcpp")
    assert isinstance(refused.exception, ConfigError), "which ends the process with 2"
    assert "pip install parley-bt" in str(refused.exception)


@pytest.mark.parametrize("command", ["run", "show", "check"])
def test_what_is_no_graph_is_refused_and_what_is_not_there_is_another_matter(
    file: Path, command: str
) -> None:
    broken = file.parent / "broken.json"
    broken.write_text("{", encoding="utf-8")
    refused = parley(command, broken)
    assert refused.exit_code == 1
    assert "not valid JSON" in refused.output
    missing = parley(command, file.parent / "missing.json")
    assert isinstance(missing.exception, ConfigError), "which ends the process with 2"


def test_a_loop_that_nobody_gives_data_again_is_told_of_a_graph_that_can_run(tmp_path: Path) -> None:
    item: dict[str, Any] = {"item": {"pvf_type": "string"}}
    find: dict[str, Any] = {
        "name": "Find",
        "type": "sync",
        "output_parameters": item,
        "children": [{"name": "Take"}],
    }
    parents = [{"name": name, "required": False} for name in ("Find", "Shake")]
    take: dict[str, Any] = {"name": "Take", "type": "sync", "input_parameters": item, "parents": parents}
    shake: dict[str, Any] = {
        "name": "Shake",
        "type": "sync",
        "parents": [{"name": "Take"}],
        "children": [{"name": "Take"}],
    }
    actions = [find, take | {"children": [{"name": "Shake"}]}, shake]
    graph = {"graph_name": "g", "graph_entry": [{"name": "Find"}], "graph_exit": [], "actions": actions}
    (file := tmp_path / "g.json").write_text(json.dumps(graph), encoding="utf-8")
    for action in actions:
        described = {key: action[key] for key in action if key not in ("parents", "children")}
        (tmp_path / f"{action['name']}.umrf.json").write_text(json.dumps(described), encoding="utf-8")
    checked = parley("check", file, "--actions", tmp_path)
    assert checked.exit_code == 0
    assert "Take_0 has no data for item when it runs again after Shake_0" in checked.stdout
    assert checked.stdout.splitlines()[-1] == "g.json: it can run"


def test_a_folder_of_actions_that_is_not_there_is_an_error_and_not_an_empty_one(file: Path) -> None:
    checked = parley("check", file, "--actions", file.parent / "none")
    assert isinstance(checked.exception, ConfigError)


def test_python_actions_of_a_folder_count_and_broken_ones_are_told(file: Path) -> None:
    folder = file.parent / "actions"
    folder.mkdir()
    code = "from parley.umrf.action import action\n\n@action\nasync def {}(ctx):\n    pass\n"
    (folder / "a.py").write_text(code.format("a"), encoding="utf-8")
    (folder / "b.py").write_text(code.format("b"), encoding="utf-8")
    assert parley("check", file, "--actions", folder).exit_code == 0
    (folder / "b.py").write_text("import nothing_of_that_name\n", encoding="utf-8")
    refused = parley("check", file, "--actions", folder)
    assert refused.exit_code == 1
    assert "b.py skipped" in refused.stderr
    assert "actions[1].name" in refused.stdout


def test_a_file_that_is_not_there_is_an_error_of_the_command(tmp_path: Path) -> None:
    assert isinstance(parley("show", tmp_path / "none.json").exception, ParleyError)
