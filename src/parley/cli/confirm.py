"""Asking for a yes before something that cannot be taken back."""

from __future__ import annotations

import sys

import typer

from parley.cli.on_loop import interruptible
from parley.cli.output import fail
from parley.errors import ConfigError

__all__ = ["confirm"]


def confirm(question: str, *, yes: bool) -> None:
    """Ask whoever sits at the terminal, unless `yes` was given on the command line.

    Raises:
        ConfigError: Nobody sits there.
        typer.Exit: The answer was no.
    """
    if yes:
        return
    if not sys.stdin.isatty():
        raise ConfigError(f"{question} There is nobody to ask; repeat with --yes")
    with interruptible():
        agreed = typer.confirm(question)
    if not agreed:
        raise typer.Exit(fail("nothing was done", code=1))
