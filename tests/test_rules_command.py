"""`parley rules`: shown in words, checked, tried without driving."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from parley.cli import command_line, run
from parley.sim.export import export_maps
from tests.sim.worlds import two_rooms

RULES = """\
rules:
- {id: north, kind: keep_out, name: north door, rectangle: [2.6, 2.5, 3.4, 3.5], exempt: [supervisor]}
"""


def parley(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["parley", "rules", *arguments])
    return run(command_line())


def test_rules_are_shown_checked_and_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "rules.yaml"
    file.write_text(RULES, encoding="utf-8")
    export_maps(two_rooms(), tmp_path)
    assert parley(monkeypatch, "show", str(tmp_path)) == 0
    assert "north: Stays out of “north door”: every robot, but not on the order of: supervisor." in (
        capsys.readouterr().out
    )
    assert parley(monkeypatch, "check", str(file)) == 0
    assert "1 rule, nothing wrong" in capsys.readouterr().out
    tried = ("try", str(file), "--map", str(tmp_path / "map.yaml"), "--from", "1,1", "--json")
    assert parley(monkeypatch, *tried, "--to", "3,3") == 1
    assert json.loads(capsys.readouterr().out)["forbidden"] == [
        "Step 1 leads into “north door”, where robot must not go."
    ]
    assert parley(monkeypatch, *tried, "--to", "4.5,3") == 0, "there is the other door"
    assert parley(monkeypatch, *tried, "--to", "3,3", "--role", "supervisor") == 0
    capsys.readouterr()
    file.write_text(RULES.replace("name", "nam"), encoding="utf-8")
    assert parley(monkeypatch, "check", str(file)) == 2
    assert "rules.yaml, line 2: rules[0].nam: there is no such setting" in capsys.readouterr().err
