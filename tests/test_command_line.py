"""How the command line is put together: only what was asked for is loaded."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
import typer
from typer.testing import CliRunner

from parley.cli import command_line, run
from parley.errors import UnavailableError


def loaded(*words: str, **environ: str) -> tuple[str, set[str]]:
    """What a command line says, and which rooms and libraries it loads for it."""
    code = (
        "import sys; from parley.cli import command_line, run\n"
        f"try: sys.argv = ['parley', *{words!r}]; run(command_line())\n"
        "finally: print(*{'.'.join(name.split('.')[:2]) for name in sys.modules})"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environ},
    )
    *said, modules = done.stdout.splitlines()
    return "\n".join(said), set(modules.split())


@pytest.mark.parametrize("command", ["memory", "incidents"])
def test_lists_wait_for_neither_the_simulator_nor_the_language_engine(command: str) -> None:
    said, modules = loaded(command, "--help")
    assert f"parley {command}" in said
    assert not modules & {"parley.sim", "parley.language", "parley.bench", "parley.demos"}


def test_list_of_commands_and_their_completion_load_none_of_them() -> None:
    listed, modules = loaded("--help")
    assert [name for name in ("demo", "doctor", "memory", "up") if f" {name} " not in listed] == []
    asked = {"COMP_WORDS": "parley me", "COMP_CWORD": "1", "_PARLEY_COMPLETE": "complete_bash"}
    completed, others = loaded(**asked)
    assert completed == "memory"
    small = {"parley.cli", "parley.errors", "parley.extras"}
    assert {name for name in modules | others if name.startswith("parley.")} == small
    assert not (modules | others) & {"numpy", "structlog", "yaml"}


def test_a_demonstration_loads_solvers_and_the_prompt_only_where_they_are_asked_for() -> None:
    said, modules = loaded("demo", "--help")
    assert "parley demo" in said
    assert not modules & {"scipy.optimize", "prompt_toolkit", "prompt_toolkit.application"}


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
    assert run(command_line()) == 2
    assert f"pip install 'parley-hri[{extra}]'" in capsys.readouterr().err


def test_help_says_of_what_is_not_installed_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert CliRunner().invoke(command_line(), ["--help"]).output.count("parley-hri[sim]") == 5


def test_who_is_not_there_yet_is_told_apart_from_what_is_wrong(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["parley"])
    app = typer.Typer()

    @app.command()
    def reach() -> None:
        raise UnavailableError("nobody answers at ws://robot:9090")

    assert run(app) == 3
    assert "nobody answers" in capsys.readouterr().err
