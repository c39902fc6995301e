"""`parley actions`: what robots can do."""

from __future__ import annotations

from typing import Annotated

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.cli.output import emit_json, fail
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import write_descriptor

__all__ = ["app"]

app = typer.Typer(help="What robots can do.", no_args_is_help=True)


@app.command("list")
def list_actions(
    json: Annotated[bool, typer.Option("--json", help="One JSON object per action.")] = False,
) -> None:
    """List the built-in actions with their parameters."""
    for info in Catalogue(BUILTIN_ACTIONS).infos():
        if json:
            emit_json(info.model_dump())
            continue
        typer.echo(f"{info.name}: {info.description}")
        for title, names in (("in", info.inputs), ("out", info.outputs)):
            if names:
                typer.echo(f"  {title}: " + ", ".join(f"{name} ({kind})" for name, kind in names.items()))


@app.command("show")
def show(name: Annotated[str, typer.Argument(help="The action's name.")]) -> None:
    """Print an action's UMRF descriptor (`*.umrf.json`)."""
    catalogue = Catalogue(BUILTIN_ACTIONS)
    spec = catalogue.get(name)
    if spec is None:
        near = catalogue.suggestions(name)
        hint = f" Did you mean {', '.join(near)}?" if near else ""
        raise typer.Exit(fail(f"there is no action {name!r}.{hint}"))
    typer.echo(write_descriptor(spec))
