"""`parley actions`: what robots can do."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.agents.planner.check import plan_problems
from parley.cli.choosing import KeyFileOption, LanguageOption, language_settings
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, fail, quiet_logs
from parley.config import ModelSettings
from parley.evaluation.say_tests import SayResult, run_say_tests
from parley.language.base import Language
from parley.language.llm import build_language
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue, fully_described
from parley.umrf.discovery import ActionFolder, export_descriptors, installed_actions
from parley.umrf.io import write_descriptor

__all__ = ["FolderOption", "app", "catalogue_with"]

app = typer.Typer(no_args_is_help=True)

FolderOption = Annotated[
    Path | None, typer.Option("--actions", help="Folder with more actions: Python files and *.umrf.json.")
]


def catalogue_with(folder: Path | None) -> tuple[Catalogue, tuple[str, ...]]:
    """Built-in and installed actions, then those of the folder; and what was skipped."""
    found = installed_actions()
    specs: list[ActionSpec] = [*BUILTIN_ACTIONS, *found.specs]
    if folder is not None:
        index = ActionFolder(folder)
        index.scan()
        found += index.found
        specs += index.found.specs
    return Catalogue(specs, found.graphs), found.problems


@app.command("list")
def list_actions(
    actions: FolderOption = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per action.")] = False,
) -> None:
    """List the actions with their parameters. Exit code 1 if a file had to be skipped."""
    catalogue, problems = catalogue_with(actions)
    for info in catalogue.infos():
        if json:
            emit_json(info.model_dump())
            continue
        typer.echo(f"{info.name}: {info.description}")
        for title, names in (("in", info.inputs), ("out", info.outputs)):
            if names:
                typer.echo(f"  {title}: " + ", ".join(f"{name} ({kind})" for name, kind in names.items()))
    for problem in problems:
        fail(problem)
    if problems:
        raise typer.Exit(1)


@app.command("show")
def show(
    name: Annotated[str, typer.Argument(help="The action's name.")], actions: FolderOption = None
) -> None:
    """Print an action's UMRF descriptor (`*.umrf.json`)."""
    catalogue, _ = catalogue_with(actions)
    spec = catalogue.get(name)
    if spec is None:
        near = catalogue.suggestions(name)
        hint = f" Did you mean {', '.join(near)}?" if near else ""
        raise typer.Exit(fail(f"there is no action {name!r}.{hint}"))
    typer.echo(write_descriptor(fully_described(spec)))


@app.command("check")
def check(
    name: Annotated[str, typer.Argument(help="The action's name; all of them if left out.")] = "",
    actions: FolderOption = None,
    language: LanguageOption = "builtin",
    key_file: KeyFileOption = None,
) -> None:
    """Say the test sentences and examples of actions. Exit code 1 if one does not lead to its action."""
    quiet_logs()
    catalogue, problems = catalogue_with(actions)
    if name and catalogue.get(name) is None:
        raise typer.Exit(fail(f"there is no action {name!r}"))
    chosen = language_settings(language, key_file)
    engine = build_language([language], ModelSettings(**chosen["model"]), check=plan_problems)
    specs = [spec for spec in catalogue if name in ("", spec.name)]
    results = on_loop(_say(specs, catalogue, engine))
    for result in results:
        if result.problem:
            problems = (*problems, f"{result.action}: “{result.say}”: {result.problem}")
    typer.echo(f"{sum(not result.problem for result in results)} of {len(results)} sentences are understood")
    for problem in problems:
        fail(problem)
    if problems:
        raise typer.Exit(1)


async def _say(specs: Sequence[ActionSpec], catalogue: Catalogue, engine: Language) -> list[SayResult]:
    async with contextlib.AsyncExitStack() as stack:
        if isinstance(engine, contextlib.AbstractAsyncContextManager):
            await stack.enter_async_context(engine)
        return await run_say_tests(specs, catalogue.infos(), engine)


@app.command("export")
def export(
    folder: Annotated[Path, typer.Argument(help="Where the descriptors go; made if need be.")],
    actions: FolderOption = None,
) -> None:
    """Write the descriptor (`*.umrf.json`) of every action, for other UMRF programs."""
    catalogue, problems = catalogue_with(actions)
    for file in export_descriptors(map(fully_described, catalogue), folder):
        typer.echo(file.name)
    for problem in problems:
        fail(problem)
    if problems:
        raise typer.Exit(1)
