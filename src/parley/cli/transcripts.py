"""`parley transcripts`: play the dialogues of a demonstration and write down what was said."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from parley.cli.on_loop import on_loop
from parley.cli.output import fail, quiet_logs
from parley.demos.catalogue import DEMOS, load_demo
from parley.demos.transcripts import Dialogues, page, played
from parley.errors import ConfigError

__all__ = ["command"]


def command(
    name: Annotated[str, typer.Argument(help=f"One of: {', '.join(DEMOS)}.")] = "nursing-home",
    out: Annotated[Path | None, typer.Option(help="The file to write; default: the screen.")] = None,
) -> None:
    """Play what goes wrong in a demonstration, and write the dialogues down as a page."""
    quiet_logs()
    demo = load_demo(name)
    file = Path(str(resources.files("parley.demos") / DEMOS[name] / "recovery.yaml"))
    if not file.exists():
        raise ConfigError(f"the demonstration {name} has no dialogues to write down")
    dialogues = Dialogues.load(file)
    results = [on_loop(played(demo, story)) for story in dialogues.dialogues.values()]
    text = page(dialogues, [transcript for _, transcript in results])
    if out is None:
        typer.echo(text, nl=False)
    else:
        out.write_text(text, encoding="utf-8")
    broken = next(((result, told) for result, told in results if not result.held), None)
    if broken is not None:
        raise typer.Exit(fail(f"{broken[1].story.title}: {broken[0].text}", code=1))
