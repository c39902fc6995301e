"""`parley interpret`: situations in, Chat Actions out (design section 5)."""

from __future__ import annotations

import contextlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, TextIO

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.agents.planner.check import plan_problems
from parley.cli.choosing import ConfigOption, KeyFileOption, LanguageOption, chosen_settings
from parley.cli.on_loop import interruptible, on_loop
from parley.cli.output import quiet_logs
from parley.errors import ConfigError
from parley.evaluation.situations import Explains, interpret_lines
from parley.evaluation.situations import schema as schema_of_lines
from parley.language.base import Language
from parley.language.llm import build_language
from parley.umrf.catalogue import Catalogue

__all__ = ["command"]


def command(
    situations: Annotated[
        Path, typer.Option(help="JSON lines, one situation each; - for standard input.")
    ] = Path("-"),
    out: Annotated[
        Path, typer.Option(help="Where the answers go, a JSON line each; - for standard output.")
    ] = Path("-"),
    language: LanguageOption = "",
    key_file: KeyFileOption = None,
    config: ConfigOption = None,
    explain: Annotated[
        bool, typer.Option(help="Add to each answer how it came about (the built-in engine only).")
    ] = False,
    schema: Annotated[
        bool,
        typer.Option("--schema", help="Print the JSON schema of situations and answers, and nothing else."),
    ] = False,
) -> None:
    """Say what each message asks for. A bad line gives an answer with an error and stops nothing."""
    if schema:
        typer.echo(json.dumps(schema_of_lines(), indent=2, ensure_ascii=False))
        return
    quiet_logs()
    chosen = chosen_settings(config, language, key_file)
    engine = build_language([chosen.language], chosen.model, check=plan_problems)
    if explain and not isinstance(engine, Explains):
        raise ConfigError("only the built-in language engine can explain its answers; use --language builtin")
    with contextlib.ExitStack() as stack:
        source = _open(stack, situations, "r")
        target = _open(stack, out, "w")
        on_loop(_interpret(source, target, engine, explain))


def _open(stack: contextlib.ExitStack, path: Path, mode: str) -> TextIO:
    if str(path) == "-":
        return sys.stdin if mode == "r" else sys.stdout
    try:
        return stack.enter_context(path.open(mode, encoding="utf-8"))  # type: ignore[return-value]
    except OSError as error:
        raise ConfigError(f"{path.name} cannot be opened: {error.strerror}") from error


def _lines(source: TextIO) -> Iterator[str]:
    """One after the other; waiting for one holds up the loop, which has nothing else to do."""
    while True:
        with interruptible():
            line = source.readline()
        if not line:
            return
        yield line


async def _interpret(source: TextIO, target: TextIO, engine: Language, explain: bool) -> None:
    infos = Catalogue(BUILTIN_ACTIONS).infos()
    async with contextlib.AsyncExitStack() as stack:
        if isinstance(engine, contextlib.AbstractAsyncContextManager):
            await stack.enter_async_context(engine)
        async for line in interpret_lines(_lines(source), engine, infos, explain=explain):
            target.write(line.rstrip("\n") + "\n")
            target.flush()
