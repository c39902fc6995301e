"""`parley graph`: check and run UMRF graphs."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Annotated, Any

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.cli.output import emit_json, fail, quiet_logs
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, load_demo
from parley.demos.observer import Observer
from parley.engine.run_file import check_file
from parley.errors import ConfigError
from parley.messages import topics
from parley.messages.ros import UmrfGraphStart
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState

__all__ = ["app"]

app = typer.Typer(help="Check and run UMRF graphs.", no_args_is_help=True)

_ENDED = {GraphState.FINISHED, GraphState.HALTED, GraphState.STOPPED, GraphState.ERROR}
START_WITHIN_S = 30.0


@app.command("check")
def check(
    file: Annotated[Path, typer.Argument(help="A graph file (JSON).")],
    actions: Annotated[
        Path | None, typer.Option(help="Folder with *.umrf.json descriptors; default: the built-in actions.")
    ] = None,
    actor: Annotated[str, typer.Option(help="Name of the engine that would run it.")] = "",
    json: Annotated[bool, typer.Option("--json", help="One JSON object per problem.")] = False,
) -> None:
    """Say everything that would keep the graph from running."""
    catalogue = Catalogue.load_folder(actions) if actions is not None else Catalogue(BUILTIN_ACTIONS)
    problems = check_file(file, catalogue, actor)
    for problem in problems:
        if json:
            emit_json(
                {
                    "path": problem.path,
                    "message": problem.message,
                    "remedy": problem.remedy,
                    "code": problem.code,
                }
            )
        else:
            typer.echo(str(problem))
    if problems:
        raise typer.Exit(1)
    if not json:
        typer.echo(f"{file.name}: nothing wrong with it")


@app.command("run")
def run(
    file: Annotated[Path, typer.Argument(help="A graph file (JSON).")],
    demo: Annotated[str, typer.Option(help=f"In whose world: {', '.join(DEMOS)}.")] = "nursing-home",
    robot: Annotated[str, typer.Option(help="Which robot; default: the world's first.")] = "",
    json: Annotated[bool, typer.Option("--json", help="One JSON object per event.")] = False,
    timeout: Annotated[float, typer.Option(help="Seconds of wall time it may take.")] = 600.0,
) -> None:
    """Run a graph on a simulated robot, at full speed, and follow it to its end."""
    quiet_logs()
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{file.name} cannot be read: {error}") from error
    raise typer.Exit(asyncio.run(_run(text, demo, robot, json, timeout)))


async def _run(text: str, demo: str, robot: str, as_json: bool, timeout_s: float) -> int:
    name = read_graph(text).name
    async with (
        load_demo(demo).system(SystemConfig(speed=None)) as system,
        Observer(system.transport, system.clock, emit_json if as_json else _tell) as observer,
    ):
        target = robot or system.robot_names[0]
        if target not in system.robot_names:
            raise ConfigError(f"there is no robot {target!r}; there are: {', '.join(system.robot_names)}")
        await observer.until(lambda: target in observer.robots, timeout_s=START_WITHIN_S)
        observer.send(topics.GRAPH_START, UmrfGraphStart(umrf_graph_json=text, targets=(target,)))

        def over() -> bool:
            return bool(observer.refusals) or _state(observer, name) in _ENDED

        try:
            await observer.until(over, timeout_s=timeout_s)
        except TimeoutError:
            return fail(f"{name} did not end within {timeout_s:.0f} s", code=1)
        if observer.refusals:
            problems = [str(problem.message) for problem in observer.refusals[0].problems]
            return fail(f"{name} was refused: {'; '.join(problems)}", code=1)
        failed = [event for event in observer.events if event.state == NodeState.ERROR.value]
        return 1 if failed or _state(observer, name) is GraphState.ERROR else 0


def _state(observer: Observer, graph: str) -> GraphState | None:
    for event in reversed(observer.events):
        if event.kind == "graph" and event.graph_name == graph:
            return GraphState(event.state)
    return None


def _tell(event: dict[str, Any]) -> None:
    match event["event"]:
        case "transition":
            typer.echo(f"{event['robot_time_s']:8.2f} s  {event['node'] or event['graph']}: {event['state']}")
        case "said":
            typer.echo(f"{event['robot']}: {event['text']}")
        case "refused":
            typer.echo(f"refused: {'; '.join(event['problems'])}")
        case "failure" | "progress" | "picture":
            typer.echo(f"{event['robot_time_s']:8.2f} s  {event['event']}: {event.get('text', '')}")
