"""One process per data folder, with real processes."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from parley.errors import StoreError
from parley.memory.folder import held_folder

HOLDS = """
import sys
from pathlib import Path
from parley.memory.folder import held_folder
with held_folder(Path(sys.argv[1]), unix_ms=1_790_000_000_000):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def holder(folder: Path) -> Iterator[subprocess.Popen[str]]:
    """Another process that holds the folder."""
    command = [sys.executable, "-c", HOLDS, str(folder), "two words"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "held\n"
        try:
            yield child
        finally:
            child.kill()


def test_the_second_process_is_told_who_holds_the_folder(tmp_path: Path) -> None:
    with holder(tmp_path) as child, pytest.raises(StoreError) as refused, held_folder(tmp_path, unix_ms=1):
        raise AssertionError("both hold it")
    told = str(refused.value)
    assert f"process {child.pid} on " in told
    assert "since 2026-" in told
    assert "'two words'" in told
    assert "--data" in told


def test_the_lock_of_a_killed_process_holds_nothing(tmp_path: Path) -> None:
    with holder(tmp_path) as child:
        child.kill()
        child.wait()
        with held_folder(tmp_path, unix_ms=1):
            assert json.loads((tmp_path / "in-use").read_text())["since_unix_ms"] == 1
    assert (tmp_path / "in-use").read_text() == ""


@pytest.mark.parametrize("said", ["", "nonsense", "{}", "[" * 9000, '{"since_unix_ms": 1e99}'])
def test_who_holds_it_may_be_unreadable(tmp_path: Path, said: str) -> None:
    with held_folder(tmp_path, unix_ms=1):
        (tmp_path / "in-use").write_text(said)
        with pytest.raises(StoreError, match="in use by another process"), held_folder(tmp_path, unix_ms=2):
            raise AssertionError("both hold it")


def test_a_folder_that_cannot_be_written_to_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with (
        pytest.raises(StoreError, match=r"file cannot be written to .*--data"),
        held_folder(tmp_path / "file", unix_ms=1),
    ):
        raise AssertionError("held")
