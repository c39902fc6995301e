"""How the command line is put together: only what was asked for is loaded."""

from __future__ import annotations

import subprocess
import sys

import pytest
from typer.testing import CliRunner

from parley.cli import command_line, run


def loaded(*arguments: str) -> set[str]:
    """Which of the heavy rooms a command loads."""
    code = (
        "import sys; from parley.cli import command_line\n"
        f"command_line({arguments[0]!r})\n"
        "print(*{'.'.join(name.split('.')[:2]) for name in sys.modules if name.startswith('parley.')})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.mark.parametrize("command", ["memory", "incidents"])
def test_lists_wait_for_neither_the_simulator_nor_the_language_engine(command: str) -> None:
    assert not loaded(command) & {"parley.sim", "parley.language", "parley.bench", "parley.demos"}


def test_help_lists_every_command() -> None:
    shown = CliRunner().invoke(command_line(), ["--help"]).output
    every = (
        "actions",
        "bench",
        "demo",
        "doctor",
        "eval",
        "graph",
        "incidents",
        "interpret",
        "memory",
        "prompt",
    )
    assert [name for name in (*every, "transcripts", "web", "world") if name not in shown] == []


@pytest.mark.parametrize(("words", "code", "said"), [
    ([], 2, ""),
    (["--version"], 0, ""),
    (["memroy"], 2, "memroy"),
    (["memory", "lsit"], 2, "lsit"),
])  # fmt: skip
def test_what_is_no_command_is_named_and_no_command_at_all_is_no_error_of_a_word(
    words: list[str], code: int, said: str
) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "parley", *words], capture_output=True, text=True, check=False
    )
    assert done.returncode == code
    assert said in done.stderr
    assert bool(done.stderr) is bool(said)


@pytest.mark.parametrize(
    ("command", "library", "extra"), [("world", "mujoco", "sim"), ("people", "argon2", "web")]
)
def test_a_command_that_is_not_installed_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: str,
    library: str,
    extra: str,
) -> None:
    for name in [
        name for name in sys.modules if name.startswith(("parley.cli.", "parley.sim.", "parley.web."))
    ]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.setattr(sys, "argv", ["parley", command, "list", "--data", "nowhere"])
    assert run(command_line(command)) == 2
    assert f"pip install 'parley-hri[{extra}]'" in capsys.readouterr().err
