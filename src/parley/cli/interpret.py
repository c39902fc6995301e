"""`parley interpret`: situations in, Chat Actions out (design section 5)."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from pathlib import Path
from typing import Annotated, TextIO

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.errors import ConfigError
from parley.language.offline import OfflineLanguage
from parley.language.situations import interpret_lines
from parley.umrf.catalogue import Catalogue

__all__ = ["register"]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("interpret")(interpret)


def interpret(
    situations: Annotated[Path, typer.Option(help="JSON lines, one situation each; - for standard input.")],
    out: Annotated[
        Path, typer.Option(help="Where the answers go, a JSON line each; - for standard output.")
    ] = Path("-"),
    language: Annotated[str, typer.Option(help="Which language engine: offline.")] = "offline",
) -> None:
    """Say what each message asks for. A bad line gives an answer with an error and stops nothing."""
    if language != "offline":
        raise ConfigError(f"there is no language engine {language!r} yet; use offline")
    with contextlib.ExitStack() as stack:
        source = _open(stack, situations, "r")
        target = _open(stack, out, "w")
        asyncio.run(_interpret(source, target))


def _open(stack: contextlib.ExitStack, path: Path, mode: str) -> TextIO:
    if str(path) == "-":
        return sys.stdin if mode == "r" else sys.stdout
    try:
        return stack.enter_context(path.open(mode, encoding="utf-8"))  # type: ignore[return-value]
    except OSError as error:
        raise ConfigError(f"{path.name} cannot be opened: {error.strerror}") from error


async def _interpret(source: TextIO, target: TextIO) -> None:
    infos = Catalogue(BUILTIN_ACTIONS).infos()
    async for line in interpret_lines(source, OfflineLanguage(), infos):
        target.write(line.rstrip("\n") + "\n")
        target.flush()
