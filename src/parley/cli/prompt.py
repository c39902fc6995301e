"""`parley prompt`: what a language model would be told."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Final

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.cli.output import emit_json
from parley.errors import ConfigError
from parley.evaluation.situations import read_situation
from parley.files import parse_json, read_text
from parley.language.base import ErrorSituation, Situation
from parley.language.llm.forms import Known, form_of
from parley.language.prompts import (
    KINDS,
    Kind,
    Prompt,
    compose_ground,
    compose_inspect,
    compose_interpret,
    compose_reply,
    compose_resolve,
    compose_selection,
)
from parley.umrf.catalogue import Catalogue

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)

_EXAMPLE: Final = {
    "message": "go to the box by the door",
    "robot": "Robot",
    "robots": ["Robot"],
    "objects": [{"id": "box_1", "description": "box by the door", "class": "box", "x": 2.0, "y": 1.0}],
    "memory": [{"name": "door", "type": "text", "data": "The door sticks.", "info": "about the door"}],
}
_EXAMPLE_ERROR: Final = {
    "kind": "error",
    "error_message": "There is something in the way.",
    "code": "blocked",
    "failed_action": {"NavigateTo": {"input_parameters": {}, "output_parameters": {}}},
    "robot": "Robot",
}


@app.command("show")
def show(
    situation: Annotated[
        Path | None, typer.Option(help="A situation as for `parley interpret`; default: an example.")
    ] = None,
    kind: Annotated[str, typer.Option(help=f"Which question: {', '.join(KINDS)}.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object.")] = False,
) -> None:
    """Print exactly what a model gets: instructions, content, and the form its answer must have."""
    if kind and kind not in KINDS:
        raise ConfigError(f"there is no question {kind!r}; use one of {', '.join(KINDS)}")
    default = _EXAMPLE_ERROR if kind == "resolve" else _EXAMPLE
    value = default if situation is None else parse_json(_first_line(situation), situation.name)
    known = read_situation(value, Catalogue(BUILTIN_ACTIONS).infos())
    prompt = _composed(known, kind)
    schema = form_of(_about(prompt.kind, known))
    if as_json:
        emit_json(
            {
                "kind": prompt.kind,
                "version": prompt.version,
                "instructions": prompt.instructions,
                "content": prompt.content,
                "answer": schema,
            }
        )
        return
    typer.echo(f"--- instructions ({prompt.version})\n{prompt.instructions}")
    typer.echo(f"--- content\n{prompt.content}")
    typer.echo(f"--- form of the answer\n{json.dumps(schema, indent=1)}")


def _about(kind: Kind, known: Situation | ErrorSituation) -> Known:
    things = tuple(thing.id for thing in known.objects)
    robots = known.robots if isinstance(known, Situation) else ()
    return Known(kind, known.catalogue, known.robot, robots, things)


def _first_line(file: Path) -> str:
    """The first situation of a file of JSON lines, or the one JSON object that the file is."""
    text = read_text(file)
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[0] if lines and lines[0].rstrip().endswith("}") else text


def _composed(known: Situation | ErrorSituation, kind: str) -> Prompt:
    wanted: Kind = next((k for k in KINDS if k == kind), "interpret")
    if isinstance(known, ErrorSituation):
        if kind not in ("", "resolve"):
            raise ConfigError(f"the situation is one of a failure, which asks for resolve, not {kind}")
        return compose_resolve(known)
    match wanted:
        case "resolve":
            raise ConfigError("resolve needs the situation of a failure, with kind: error")
        case "select_memories":
            return compose_selection(known.message, known.memory)
        case "ground":
            return compose_ground(known.message, known.objects, known.robot_pose)
        case "inspect":
            return compose_inspect(known.message, None)
        case "read_reply":
            asked = [turn.content for turn in known.history if turn.role == "assistant"]
            return compose_reply(asked[-1] if asked else "", known.message, ())
    return compose_interpret(known)
