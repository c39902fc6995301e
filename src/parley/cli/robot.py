"""`parley robot`: whether a robot class keeps what robots promise."""

from __future__ import annotations

import importlib
import inspect
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from parley.cli.on_loop import interruptible, on_loop
from parley.cli.output import emit_json, fail, quiet_logs
from parley.clock import WallClock
from parley.errors import ConfigError
from parley.robots.base import Robot
from parley.robots.check import check_robot
from parley.robots.own import RobotBase
from parley.site import Site
from parley.world.geometry import Pose2D

__all__ = ["app", "found_class", "made_robot"]

FLOOR_M = 10.0
"""Where no map is given, so much free floor is taken for granted around the robot."""

app = typer.Typer(help="Robot classes.", no_args_is_help=True)


@app.callback()
def _robot() -> None:
    """Robot classes."""


@app.command("check")
def check(
    robot: Annotated[
        str,
        typer.Argument(
            metavar="MODULE:CLASS", help="The class, or a function that makes the robot; also FILE.py:CLASS."
        ),
    ],
    name: Annotated[str, typer.Option(help="The robot's name, for a class that takes one.")] = "robot",
    world: Annotated[
        Path | None, typer.Option(help="Folder with its map.yaml; default: free floor around it.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="There is room before it: do not ask.")] = False,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per promise.")] = False,
) -> None:
    """Try out whether a robot stops, lets commands expire, knows where it is, and can be held. It moves!"""
    quiet_logs()
    made = made_robot(found_class(robot), name)
    if not yes:
        with interruptible():
            yes = typer.confirm(f"{made.name} will drive forward, at most two metres. Is there room?")
    if not yes:
        raise typer.Exit(fail("nothing was done", code=1))
    broken = on_loop(_check(made, world, json))
    raise typer.Exit(1 if broken else 0)


async def _check(robot: Robot, world: Path | None, as_json: bool) -> int:
    """Tell what became of each promise; how many are broken."""
    if isinstance(robot, RobotBase):
        given = Site.load(world).occupancy if world is not None else None
        robot.settle(given or _floor_around(robot.pose()), WallClock(), None)
    broken = 0
    try:
        async for kept in check_robot(robot):
            broken += not kept.kept
            if as_json:
                emit_json(asdict(kept))
            else:
                typer.echo(f"{'kept  ' if kept.kept else 'BROKEN'}  {kept.promise}")
                if kept.text:
                    typer.echo(f"        {kept.text}")
    finally:
        if isinstance(robot, RobotBase):
            robot.close()
    return broken


def _floor_around(pose: Pose2D) -> Any:
    from dataclasses import replace

    floor = Site.floor(FLOOR_M, FLOOR_M).occupancy
    assert floor is not None
    return replace(floor, origin_x_m=pose.x_m - FLOOR_M / 2, origin_y_m=pose.y_m - FLOOR_M / 2)


def found_class(text: str) -> Any:
    """The class or function that is named.

    Raises:
        ConfigError: There is none.
    """
    module, _, attribute = text.rpartition(":")
    if not module or not attribute:
        raise ConfigError(f"{text!r} names no class: write MODULE:CLASS or FILE.py:CLASS")
    path = Path(module)
    if path.suffix == ".py" and not path.is_file():
        raise ConfigError(f"there is no file {module}")
    sys.path.insert(0, str(path.parent if path.suffix == ".py" else Path.cwd()))
    try:
        loaded = importlib.import_module(path.stem if path.suffix == ".py" else module)
    except ImportError as error:
        raise ConfigError(f"{module} cannot be imported: {error}") from error
    if not hasattr(loaded, attribute):
        raise ConfigError(f"{module} has no {attribute}")
    return getattr(loaded, attribute)


def made_robot(make: Any, name: str) -> Robot:
    """The robot that a class or function makes.

    Raises:
        ConfigError: It makes none.
    """
    if not callable(make):
        raise ConfigError(f"{make!r} is no class and no function")
    try:
        takes_name = bool(inspect.signature(make).parameters)
        made: Robot = make(name) if takes_name else make()
    except TypeError as error:
        raise ConfigError(
            f"{getattr(make, '__name__', make)} cannot be made with a name or without: {error}. "
            "Write a function that makes the robot and name that."
        ) from error
    return made
