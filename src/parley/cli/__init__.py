"""The command line: one file per group of commands (design section 9).

Exit codes: 0 it worked, 1 it ran but the outcome is "no" (a story that broke, a graph that failed), 2 the
command, a setting or a file was wrong, 130 ended by Ctrl-C, 143 by SIGTERM.
"""

from __future__ import annotations

import importlib

import typer
from typer.exceptions import TyperException

from parley import __version__
from parley.cli.output import fail
from parley.errors import MissingExtraError, ParleyError
from parley.extras import needs

__all__ = ["command_line", "run"]

_COMMANDS = {
    "demo": "sim", "doctor": "", "interpret": "", "eval": "", "incidents": "", "audit": "",
    "transcripts": "sim",
    "graph": "sim", "actions": "", "robot": "", "language": "", "memory": "", "rules": "", "world": "sim",
    "prompt": "", "bench": "sim", "web": "web", "people": "web", "node": "zenoh",
    "engine": "zenoh", "up": "zenoh",
}  # fmt: skip
"""Command -> the extra that it needs, if any. Each is a module of this package: with `register` if it is one
command, with an `app` if it is several."""


def command_line(only: str | None = None) -> typer.Typer:
    """Put the command line together.

    Args:
        only: The one command to load, by name. A list of memories need not wait for the simulator and the
            language engine. Without it, or if there is no such command, all are loaded: help lists them all.
            ``--version`` needs none.
    """
    app = typer.Typer(
        name="parley",
        help="Run robots by talking to them.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        add_completion=False,
    )
    app.callback(invoke_without_command=True)(_top)
    needed = () if only == "--version" else _COMMANDS if only not in _COMMANDS else (only,)
    for name in needed:
        try:
            with needs(_COMMANDS[name]):
                module = importlib.import_module(f"parley.cli.{name}")
        except MissingExtraError as missing:
            _stand_in(app, name, missing)
            continue
        if hasattr(module, "register"):
            module.register(app)
        else:
            app.add_typer(module.app, name=name)
    return app


def _stand_in(app: typer.Typer, name: str, missing: MissingExtraError) -> None:
    """A command that is not installed: help lists it, and whoever calls it is told how to get it."""
    anything = {"ignore_unknown_options": True, "allow_extra_args": True, "help_option_names": []}

    @app.command(
        name, help=f"Not installed: pip install 'parley-hri\\[{missing.extra}]'", context_settings=anything
    )
    def tell(_: typer.Context) -> None:
        raise missing


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
    except ParleyError as error:
        return fail(str(error))
    except TyperException as error:
        if not error.format_message():  # nothing was asked for, and the help has been shown
            return error.exit_code
        return fail(f"{error.format_message()} (parley --help tells more)")
    return code if isinstance(code, int) else 0
