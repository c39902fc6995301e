"""`parley audit`: shown, checked and exported from the file alone."""

from __future__ import annotations

import csv
import io
import json
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from typer.testing import CliRunner

from parley.cli import command_line, run
from parley.clock import WallClock
from parley.gate.audit_store import AuditStore
from parley.messages.audit import AuditEvent
from parley.messages.principal import person


@pytest.fixture
async def data(tmp_path: Path) -> Path:
    async with await AuditStore.open(tmp_path / "audit.db", WallClock()) as store:
        await store.append([
            AuditEvent(effect="speak", by=person("Kim"), robot="Ada", words="=go to the box", unix_ms=1000),
            AuditEvent(effect="stop", by=person("Lee"), robot="Bo", unix_ms=2000),
        ])  # fmt: skip
    return tmp_path


def parley(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(command_line(), ["audit", *words])
    return result.exit_code, result.stdout


def test_what_happened_is_shown_newest_first_and_can_be_narrowed(data: Path) -> None:
    _, text = parley("show", "--data", str(data))
    assert [line.split("  ")[-1] for line in text.splitlines()] == [
        "Lee stopped Bo.",
        "Kim said “=go to the box” to Ada.",
    ]
    _, text = parley("show", "--data", str(data), "--by", "kim", "--json")
    assert [json.loads(line)["words"] for line in text.splitlines()] == ["=go to the box"]
    nothing = CliRunner().invoke(command_line(), ["audit", "show", "--data", str(data), "--by", "pat"])
    assert (nothing.stdout, nothing.stderr) == ("", "Nothing of that kind is written.\n")


def test_a_whole_log_says_its_end_and_a_changed_one_ends_with_1(data: Path) -> None:
    code, text = parley("verify", "--data", str(data))
    assert code == 0
    mark = text.split()[-1]
    assert parley("verify", "--data", str(data), "--mark", mark)[0] == 0
    with closing(sqlite3.connect(data / "audit.db")) as db, db:
        db.execute("DROP TRIGGER entry_as_it_is")
        db.execute("UPDATE entry SET record = replace(record, 'Kim', 'Pat')")
    code, text = parley("verify", "--data", str(data))
    assert (code, text) == (1, "The log is not whole. Entry 1: it was changed.\n")


def test_a_table_is_exported_that_no_spreadsheet_carries_out(data: Path) -> None:
    rows = list(csv.DictReader(io.StringIO(parley("export", "--data", str(data))[1])))
    assert [(row["name"], row["words"]) for row in rows] == [("Lee", ""), ("Kim", "'=go to the box")]
    lines = parley("export", "--data", str(data), "--form", "json")[1].splitlines()
    assert [json.loads(line)["number"] for line in lines] == [2, 1]


def test_a_folder_without_a_log_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["parley", "audit", "verify", "--data", str(tmp_path)])
        assert run(command_line()) == 2
    assert "there is no audit.db" in capsys.readouterr().err
