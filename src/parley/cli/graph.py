"""`parley graph`: check, run, show and convert UMRF graphs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, fail, quiet_logs
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, load_demo
from parley.demos.observer import Observer
from parley.errors import ConfigError, GraphRefusedError, Problem
from parley.files import read_text
from parley.messages import topics
from parley.messages.ros import UmrfGraphStart
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check as check_graph
from parley.umrf.check import doubts, reasons
from parley.umrf.discovery import ActionFolder
from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import Graph, GraphState, NodeState, Response, Result
from parley.umrf.remote import actors_of
from parley.umrf.show import show as show_graph

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)

_ENDED = {
    state.value for state in (GraphState.FINISHED, GraphState.HALTED, GraphState.STOPPED, GraphState.ERROR)
}
START_WITHIN_S = 30.0
NO_TREES = (
    "behaviour trees are another package: pip install parley-bt (from the sources: ./packages/parley-bt)"
)


@app.command("check")
def check(
    file: Annotated[Path, typer.Argument(help="A graph file (JSON).")],
    actions: Annotated[
        Path | None, typer.Option(help="Folder with actions and descriptors; default: the built-in actions.")
    ] = None,
    actor: Annotated[str, typer.Option(help="Name of the engine that would run it.")] = "",
    json: Annotated[bool, typer.Option("--json", help="One JSON object per problem.")] = False,
) -> None:
    """Say everything that would keep the graph from running."""
    catalogue = _catalogue(actions)
    text = read_text(file)
    try:
        problems = check_graph(read_graph(text), catalogue, actor=actor)
    except GraphRefusedError as error:
        problems = reasons(error, catalogue, actor=actor)
    if problems:
        _tell_problems(problems, as_json=json)
        raise typer.Exit(1)
    unsure = doubts(read_graph(text), catalogue)
    _tell_problems(unsure, as_json=json)
    if not json:
        typer.echo(f"{file.name}: {'it can run' if unsure else 'nothing wrong with it'}")


def _catalogue(folder: Path | None) -> Catalogue:
    """What is to be checked against; what of the folder cannot be used is told."""
    if folder is None:
        return Catalogue(BUILTIN_ACTIONS)
    index = ActionFolder(folder)
    index.scan()
    for problem in index.found.problems:
        typer.echo(problem, err=True)
    return Catalogue(index.found.specs, index.found.graphs)


def _tell_problems(problems: Sequence[Problem], *, as_json: bool, err: bool = False) -> None:
    """Print problems, on the error stream if what is asked for would stand on the other."""
    for problem in problems:
        if as_json:
            emit_json(asdict(problem))
        else:
            typer.echo(str(problem), err=err)


class ShowFormat(StrEnum):
    """What `parley graph show` can write."""

    TEXT = "text"
    MERMAID = "mermaid"
    SVG = "svg"


class ConvertTo(StrEnum):
    """What `parley graph convert` can write."""

    BTCPP = "btcpp"
    UMRF = "umrf"


@app.command("show")
def show(
    file: Annotated[Path, typer.Argument(help="A graph file (JSON), also as an engine publishes it.")],
    format: Annotated[ShowFormat, typer.Option(help="How to show it.")] = ShowFormat.TEXT,
    out: Annotated[Path | None, typer.Option(help="Write to this file instead.")] = None,
) -> None:
    """Show a graph: as text, as a Mermaid flowchart or as an SVG picture."""
    try:
        graph = read_graph(read_text(file))
    except GraphRefusedError as error:
        _tell_problems(error.problems, as_json=False, err=True)
        raise typer.Exit(1) from error
    _write(show_graph(graph, format.value), out)


@app.command("convert")
def convert(
    file: Annotated[Path, typer.Argument(help="A UMRF graph (JSON) or a BehaviorTree.CPP 4 tree (XML).")],
    to: Annotated[ConvertTo, typer.Option("--to", help="What to make of it.")],
    out: Annotated[Path | None, typer.Option(help="Write to this file instead.")] = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per problem.")] = False,
) -> None:
    """Convert a graph to a BehaviorTree.CPP 4 tree, or a tree to a graph: all of it, or nothing and why."""
    try:
        from parley_bt import export_tree, import_tree
    except ModuleNotFoundError as error:
        if error.name != "parley_bt":
            raise
        raise ConfigError(NO_TREES) from error
    try:
        if to is ConvertTo.BTCPP:
            text = export_tree(read_graph(read_text(file)))
        else:
            text = write_graph(import_tree(read_text(file)), faithful=True) + "\n"
    except GraphRefusedError as error:
        _tell_problems(error.problems, as_json=json, err=not json)
        raise typer.Exit(1) from error
    _write(text, out)


def _write(text: str, out: Path | None) -> None:
    if out is None:
        typer.echo(text, nl=False)
        return
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{out.name} cannot be written: {error.strerror}") from error


@app.command("run")
def run(
    file: Annotated[Path, typer.Argument(help="A graph file (JSON).")],
    demo: Annotated[str, typer.Option(help=f"In whose world: {', '.join(DEMOS)}.")] = "nursing-home",
    robot: Annotated[
        str, typer.Option(help="Which robot; default: those that the graph names, or the world's first.")
    ] = "",
    json: Annotated[bool, typer.Option("--json", help="One JSON object per event.")] = False,
    timeout: Annotated[float, typer.Option(help="Seconds of wall time it may take.")] = 600.0,
) -> None:
    """Run a graph on simulated robots, at full speed, and follow it to its end."""
    quiet_logs()
    text = read_text(file)
    try:
        graph = read_graph(text)
    except GraphRefusedError as error:
        _tell_problems(error.problems, as_json=json, err=not json)
        raise typer.Exit(1) from error
    raise typer.Exit(on_loop(_run(text, graph, demo, robot, json, timeout)))


async def _run(text: str, graph: Graph, demo: str, robot: str, as_json: bool, timeout_s: float) -> int:
    name = graph.name
    async with (
        load_demo(demo).system(SystemConfig(speed=None)) as system,
        Observer(system.transport, system.clock, emit_json if as_json else _tell) as observer,
    ):
        targets = {robot} if robot else actors_of(graph) or {system.robot_names[0]}
        for target in sorted(targets - {*system.robot_names}):
            raise ConfigError(f"there is no robot {target!r}; there are: {', '.join(system.robot_names)}")
        await observer.until(lambda: targets <= observer.robots, timeout_s=START_WITHIN_S)
        observer.send(topics.GRAPH_START, UmrfGraphStart(umrf_graph_json=text, targets=tuple(targets)))

        def states() -> list[str]:
            return [observer.graph_states.get((target, name), "") for target in sorted(targets)]

        def over() -> bool:
            return bool(observer.refusals) or {*states()} <= _ENDED

        try:
            await observer.until(over, timeout_s=timeout_s)
        except TimeoutError:
            return fail(f"{name} did not end within {timeout_s:.0f} s", code=1)
        if observer.refusals:
            problems = [str(problem.message) for problem in observer.refusals[0].problems]
            return fail(f"{name} was refused: {'; '.join(problems)}", code=1)
        failed = {event.node for event in observer.events if event.state == NodeState.ERROR.value}
        if open_ones := {*states()} - {GraphState.FINISHED.value}:
            return fail(f"{name} did not come to its exit: it is {' and '.join(sorted(open_ones))}", code=1)
        return 0 if failed <= _expected_failures(graph) else 1


def _expected_failures(graph: Graph) -> set[str]:
    """The actions whose failure the graph has an answer to: another one that runs then."""
    return {
        relation.node.full_name
        for node in graph.nodes
        for relation in node.parents
        if relation.response(Result.ON_ERROR) is Response.RUN
    }


def _tell(event: dict[str, Any]) -> None:
    match event["event"]:
        case "transition":
            typer.echo(f"{event['robot_time_s']:8.2f} s  {event['node'] or event['graph']}: {event['state']}")
        case "said":
            typer.echo(f"{event['robot']}: {event['text']}")
        case "refused":
            typer.echo(f"refused: {'; '.join(event['problems'])}")
        case "failure" | "progress" | "picture":
            what = event.get("text") or event.get("feed", "")
            typer.echo(f"{event['robot_time_s']:8.2f} s  {event['event']}: {what}")
