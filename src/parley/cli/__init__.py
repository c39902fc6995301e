"""The command line: one file per group of commands (design section 9).

Exit codes: 0 it worked, 1 it ran but the outcome is "no" (a story that broke, a graph that failed), 2 the
command, a setting or a file was wrong, 130 ended by Ctrl-C, 143 by SIGTERM.
"""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from typing import Any, Final, NamedTuple

import typer
from typer.core import TyperCommand
from typer.exceptions import TyperException

from parley import __version__
from parley.cli.output import fail
from parley.errors import ParleyError, TransportError
from parley.extras import needs

__all__ = ["command", "command_line", "run"]


class _Later(NamedTuple):
    line: str
    """What it is for."""
    extra: str = ""
    """What has to be installed for it."""


_COMMANDS: Final = {
    "demo": _Later("Run a demonstration, or your own world.", "sim"),
    "doctor": _Later("Check this machine."),
    "interpret": _Later("Say what each message asks for."),
    "eval": _Later("Say how well each engine understands a set of messages."),
    "incidents": _Later("List what went wrong, and how it ended."),
    "audit": _Later("Who did what."),
    "transcripts": _Later("Write down what is said where a demonstration goes wrong.", "sim"),
    "graph": _Later("Check, run, show and convert UMRF graphs.", "sim"),
    "actions": _Later("What robots can do."),
    "robot": _Later("Try a class of your own for robots; simulate one that others drive."),
    "language": _Later("Teach words of your own; check what the built-in engine learns from."),
    "memory": _Later("Look into a memory file and change it."),
    "rules": _Later("What robots may do: look at rules, check a file, try a drive."),
    "places": _Later("Take what people put on a map, as an object map."),
    "world": _Later("Check world files, make maps and pictures of them.", "sim"),
    "prompt": _Later("See what a language model would be told."),
    "bench": _Later("Measure on this machine.", "sim"),
    "web": _Later("The page for operators.", "web"),
    "people": _Later("Who may use the page, and as what.", "web"),
    "node": _Later("One part of a system, in a process of its own.", "zenoh"),
    "engine": _Later("Carry out plans that are made in another process or on another machine.", "zenoh"),
    "up": _Later("Run what belongs on this machine, and start again what ends.", "zenoh"),
}
"""Each is a module of this package: with a `command`, or with an `app` if it is several."""


class _Loaded(TyperCommand):
    """Loads its module when it is called: to list it, its name and its line are enough."""

    def make_context(self, info_name: str | None, args: list[str], *more: Any, **kept: Any) -> Any:
        return command(str(self.name)).make_context(info_name, args, *more, **kept)


def command_line() -> typer.Typer:
    """The whole command line; what a command needs is loaded when it is called."""
    app = typer.Typer(
        name="parley",
        help="Run robots by talking to them.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
    )
    app.callback(invoke_without_command=True)(_top)
    for name, later in _COMMANDS.items():
        extra = f" Not installed: pip install 'parley-hri\\[{later.extra}]'" if _lacks(later.extra) else ""
        app.command(name, cls=_Loaded, help=later.line + extra)(lambda: None)
    return app


def command(name: str) -> Any:
    """One command, loaded.

    Raises:
        MissingExtraError: A library that it needs is not installed.
    """
    line, extra = _COMMANDS[name]
    with needs(extra):
        module = importlib.import_module(f"parley.cli.{name}")
    app = typer.Typer()
    if hasattr(module, "app"):
        app.add_typer(module.app, name=name, help=line)
    else:
        app.command(name)(module.command)
    return typer.main.get_group(app).commands[name]


def _lacks(extra: str) -> bool:
    return bool(extra) and find_spec({"sim": "mujoco", "web": "fastapi", "zenoh": "zenoh"}[extra]) is None


def _top(version: bool = typer.Option(False, "--version", help="Show the version and leave.")) -> None:
    if version:
        typer.echo(f"parley {__version__}")
        raise typer.Exit


def run(app: typer.Typer) -> int:
    """Run the command line; every error of ours becomes one line and an exit code."""
    try:
        code = app(standalone_mode=False)
    except typer.Exit as leaving:
        code = leaving.exit_code
    except typer.Abort:  # Ctrl-D where something was asked
        typer.echo()
        return fail("nothing was done", code=1)
    except TransportError as error:
        return fail(str(error), code=3)
    except ParleyError as error:
        return fail(str(error))
    except TyperException as error:
        if not error.format_message():  # nothing was asked for, and the help has been shown
            return error.exit_code
        return fail(f"{error.format_message()} (parley --help tells more)")
    return code if isinstance(code, int) else 0
