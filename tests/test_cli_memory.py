"""`parley memory` as people and programs use it: what it prints, exit codes, clear errors."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest

from tests.memory.photos import opened, photo
from tests.test_cli import parley


def lines(*arguments: str) -> list[dict[str, Any]]:
    """The JSON lines of a command that works."""
    done = parley("memory", *arguments, "--json")
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_memories_are_added_replaced_found_forgotten_and_restored(tmp_path: Path) -> None:
    where = ("--data", str(tmp_path))
    (added,) = lines("add", "box", "The box is by the door.", *where)
    assert (added["name"], added["source"], added["scope"]) == ("box", "operator", "")
    lines("add", "box", "The box is in the hall.", "--source", "Kim", *where)
    lines("add", "dock", "The dock is blue.", "--scope", "Ada", *where)
    assert [entry["name"] for entry in lines("list", *where)] == ["box", "dock"]
    assert [entry["name"] for entry in lines("list", "--scope", "Bob", *where)] == ["box"]
    assert [entry["data"] for entry in lines("list", "--history", *where)] == ["The box is by the door."]
    assert [entry["data"] for entry in lines("search", "hall", *where)] == ["The box is in the hall."]
    shown = parley("memory", "list", "--file", str(tmp_path / "memory.db")).stdout
    assert shown == "box: The box is in the hall.\ndock [Ada]: The dock is blue.\n"
    assert parley("memory", "forget", "box", "--yes", *where).returncode == 0
    assert [entry["name"] for entry in lines("list", *where)] == ["dock"]
    again = parley("memory", "forget", "box", "--yes", *where)
    assert (again.returncode, "'box'" in again.stderr) == (1, True)
    (restored,) = lines("restore", "box", *where)
    assert (restored["data"], restored["source"]) == ("The box is in the hall.", "Kim")
    assert parley("memory", "restore", "box", *where).returncode == 1
    nothing = parley("memory", "list", "--name", "unicorn", *where)
    assert (nothing.returncode, nothing.stdout, nothing.stderr) == (0, "", "Nothing is remembered.\n")
    assert parley("memory", "search", "unicorn", *where).returncode == 1


def test_export_and_import_carry_everything_pictures_included(tmp_path: Path) -> None:
    here, there, file = str(tmp_path / "a"), str(tmp_path / "b"), str(tmp_path / "all.json")
    picture = tmp_path / "desk.png"
    picture.write_bytes(base64.b64decode(photo(kind="PNG")))
    lines("add", "desk", "--image", str(picture), "--data", here)
    lines("add", "box", "old", "--data", here)
    lines("add", "box", "new", "--data", here)
    assert parley("memory", "export", file, "--history", "--data", here).returncode == 0
    assert lines("import", file, "--yes", "--data", there) == [
        {"added": 2, "replaced": 0, "kept": 0, "unchanged": 0}
    ]
    assert lines("list", "--data", there) == lines("list", "--data", here)
    assert lines("list", "--history", "--data", there) == lines("list", "--history", "--data", here)
    (kept,) = [entry for entry in lines("list", "--data", there) if entry["name"] == "desk"]
    assert opened(kept["data"]).size == (8, 6)
    told = parley("memory", "export", file, "--data", here)
    assert (told.returncode, "--yes" in told.stderr) == (2, True), "a file that is there is not overwritten"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("list",), "--data FOLDER or --file FILE"),
        (("list", "--data", "{}", "--file", "x"), "--data FOLDER or --file FILE"),
        (("list", "--data", "{}"), "no memory.db"),
        (("forget", "box", "--data", "{}"), "--yes"),
        (("add", "box", "--data", "{}"), "either a text or --image"),
        (("add", "", "text", "--data", "{}"), "1 to 200"),
        (("add", "box", "--image", "{}/gone.jpg", "--data", "{}"), "gone.jpg cannot be read"),
        (("import", "{}/gone.json", "--yes", "--data", "{}"), "gone.json: cannot be read"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_with_exit_code_2(
    tmp_path: Path, arguments: tuple[str, ...], words: str
) -> None:
    done = parley("memory", *(text.replace("{}", str(tmp_path)) for text in arguments))
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""
    assert not (tmp_path / "memory.db").exists()


def test_bad_import_is_refused_with_its_place_and_loses_nothing(tmp_path: Path) -> None:
    where = ("--data", str(tmp_path))
    lines("add", "box", "ours", *where)
    bad = tmp_path / "bad.json"
    memories = [{"name": "box", "data": "theirs", "updated_unix_ms": 9_999_999_999_999}, {"name": "x"}]
    bad.write_text(json.dumps({"format": "parley-memory", "version": 1, "memories": memories}), "utf-8")
    done = parley("memory", "import", str(bad), "--yes", *where)
    assert (done.returncode, "bad.json: memories[1].data" in done.stderr) == (2, True)
    assert [entry["data"] for entry in lines("list", *where)] == ["ours"]


def test_damaged_file_is_put_aside_and_nothing_is_exported_over_a_good_export(tmp_path: Path) -> None:
    where, file = ("--data", str(tmp_path)), tmp_path / "all.json"
    lines("add", "box", "x", *where)
    assert parley("memory", "export", str(file), *where).returncode == 0
    good = file.read_text("utf-8")
    (tmp_path / "memory.db").write_bytes(b"this is no database\n" * 500)
    done = parley("memory", "export", str(file), "--yes", *where)
    assert (done.returncode, "memory.db.corrupt-" in done.stderr) == (2, True)
    assert file.read_text("utf-8") == good
    assert len(list(tmp_path.glob("memory.db.corrupt-*"))) >= 1
