"""The command line: one file per group of commands (design section 9).

Exit codes: 0 it worked, 1 it ran but the outcome is "no" (a story that broke, a graph that failed), 2 the
command, a setting or a file was wrong, 130 interrupted.
"""

from __future__ import annotations

import typer
from typer.exceptions import TyperException

from parley import __version__
from parley.cli import (
    actions,
    bench,
    demo,
    doctor,
    eval,
    graph,
    incidents,
    interpret,
    memory,
    prompt,
    transcripts,
    web,
    world,
)
from parley.cli.output import fail
from parley.errors import ParleyError

__all__ = ["app", "run"]

app = typer.Typer(
    name="parley",
    help="Run robots by talking to them.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)
demo.register(app)
doctor.register(app)
interpret.register(app)
eval.register(app)
incidents.register(app)
transcripts.register(app)
app.add_typer(graph.app, name="graph")
app.add_typer(actions.app, name="actions")
app.add_typer(memory.app, name="memory")
app.add_typer(world.app, name="world")
app.add_typer(prompt.app, name="prompt")
app.add_typer(bench.app, name="bench")
app.add_typer(web.app, name="web")


@app.callback(invoke_without_command=True)
def _top(version: bool = typer.Option(False, "--version", help="Show the version and leave.")) -> None:
    if version:
        typer.echo(f"parley {__version__}")
        raise typer.Exit


def run() -> int:
    """Run the command line; every error of ours becomes one line and an exit code."""
    try:
        code = app(standalone_mode=False)
    except typer.Exit as leaving:
        code = leaving.exit_code
    except ParleyError as error:
        return fail(str(error))
    except TyperException as error:
        return fail(f"{error.format_message()} (parley --help tells more)")
    return code if isinstance(code, int) else 0
