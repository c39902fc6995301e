"""`parley people` as people use it: exit codes, clear errors."""

from __future__ import annotations

import json
from pathlib import Path

from tests.test_cli import parley


def test_accounts_are_made_listed_changed_and_removed(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("correct horse battery\n")
    where, word = ("--data", str(tmp_path)), ("--password-file", str(secret))
    none = parley("people", "list", *where)
    assert (none.returncode, "parley people add" in none.stderr) == (2, True)
    first = parley("people", "add", "Kim", "--role", "viewer", *word, *where)
    assert (first.returncode, "Kim is supervisor now" in first.stdout) == (0, True)
    assert parley("people", "add", "Ann", *word, *where).returncode == 0
    last = parley("people", "remove", "kim", "--yes", *where)
    assert (last.returncode, "last supervisor" in last.stderr) == (2, True)
    assert parley("people", "role", "Ann", "supervisor", *where).returncode == 0
    assert parley("people", "disable", "Kim", *where).returncode == 0
    assert parley("people", "password", "Ann", *word, *where).returncode == 0
    shown = parley("people", "list", "--json", *where)
    assert [(p["name"], p["role"], p["disabled"]) for p in map(json.loads, shown.stdout.splitlines())] == [
        ("Ann", "supervisor", False),
        ("Kim", "supervisor", True),
    ]
    assert parley("people", "remove", "Kim", "--yes", *where).returncode == 0
    assert parley("people", "list", *where).stdout.startswith("Ann: supervisor, ")
    secret.write_text("short")
    weak = parley("people", "add", "Ben", *word, *where)
    assert (weak.returncode, "8 characters" in weak.stderr) == (2, True)
    assert b"correct horse" not in (tmp_path / "people.db").read_bytes()
