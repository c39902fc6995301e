"""`parley robot`: whether a robot class keeps what robots promise."""

from __future__ import annotations

import asyncio
import importlib
import inspect
import sys
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, cast, get_args

import typer

from parley.cli.confirm import confirm
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, quiet_logs
from parley.clock import WallClock
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, demo_folder
from parley.errors import ConfigError
from parley.extras import needs
from parley.messages.ros_robot import Release
from parley.network import transport_of
from parley.robots.base import Robot
from parley.robots.check import check_robot
from parley.robots.own import RobotBase
from parley.robots.ros_file import RosRobotFile
from parley.site import Site
from parley.transport.base import Transport
from parley.world.geometry import Pose2D

if TYPE_CHECKING:
    from parley.sim.world_file import WorldFile

__all__ = ["app", "found_class", "made_robot"]

EMPTY_FLOOR: Final = """
name: empty floor
walls:
  - {from: [0, 0], to: [6, 0]}
  - {from: [6, 0], to: [6, 4]}
  - {from: [6, 4], to: [0, 4]}
  - {from: [0, 4], to: [0, 0]}
robots:
  - {name: Kim, model: turtlebot3_waffle, pose: [1.0, 1.0, 0.0]}
"""
FLOOR_M = 10.0
"""Where no map is given, so much free floor is taken for granted around the robot."""

app = typer.Typer(no_args_is_help=True)


@app.command("check")
def check(
    robot: Annotated[
        str,
        typer.Argument(
            metavar="MODULE:CLASS",
            help="The class, or a function that makes the robot; also FILE.py:CLASS, or FILE.yaml with ROS.",
        ),
    ],
    name: Annotated[str, typer.Option(help="The robot's name, for a class that takes one.")] = "robot",
    world: Annotated[
        Path | None, typer.Option(help="Folder with its map.yaml; default: free floor around it.")
    ] = None,
    config: Annotated[
        Path | None, typer.Option(help="Settings with the network it is on, if it is behind no rosbridge.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="There is room before it: do not ask.")] = False,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per promise.")] = False,
) -> None:
    """Try out whether a robot stops, lets commands expire, knows where it is, and can be held. It moves!"""
    quiet_logs()
    settings = SystemConfig() if config is None else SystemConfig.load(config)
    made = made_robot(found_class(robot, settings), name)
    confirm(f"{made.name} will drive forward, at most two metres. Is there room?", yes=yes)
    broken = on_loop(_check(made, world, json))
    raise typer.Exit(1 if broken else 0)


@app.command("simulate")
def simulate(
    world: Annotated[
        str,
        typer.Option(
            help=f"A folder with its world.yaml, or one of: {', '.join(DEMOS)}. Default: an empty floor."
        ),
    ] = "",
    config: Annotated[
        Path | None,
        typer.Option(help="Settings with the network to stand on; default: behind a rosbridge of its own."),
    ] = None,
    port: Annotated[int, typer.Option(help="Where that bridge listens, on this machine; 0: any.")] = 9090,
    release: Annotated[str, typer.Option(help="Of Nav2: humble, jazzy or lyrical.")] = "jazzy",
    speed: Annotated[float, typer.Option(help="Simulated seconds per second.", min=0.1, max=20.0)] = 1.0,
) -> None:
    """Stand in for robots with Nav2, by simulated ones, until Ctrl-C."""
    quiet_logs()
    if release not in get_args(Release):
        raise ConfigError(f"there is no release {release!r}; use {', '.join(get_args(Release))}")
    with needs("sim"):
        from parley.sim.world_file import WorldFile
    site = Site.load(demo_folder(world) if world in DEMOS else world) if world else None
    place = WorldFile.parse(EMPTY_FLOOR) if site is None else site.world
    if place is None:
        raise ConfigError(f"{world} is no simulated world: it has no world.yaml")
    settings = SystemConfig() if config is None else SystemConfig.load(config)
    if config is not None and settings.network is None:
        raise ConfigError(f"{config} names no network; leave it out for a rosbridge")
    on_loop(_simulate(place, settings, port, cast(Release, release), speed))


async def _simulate(
    world: WorldFile, settings: SystemConfig, port: int, release: Release, speed: float
) -> None:
    from parley.clock import SimClock
    from parley.robots.nav2_simulated import SimulatedNav2
    from parley.robots.ros_senses import RosTopics
    from parley.sim.simulator import Simulator

    names = [robot.name for robot in world.robots]
    async with AsyncExitStack() as stack:
        make, where = await _stage(stack, settings, port, release)
        simulator = await stack.enter_async_context(Simulator(world, clock=SimClock(), speed=speed))
        for name in names:
            transport = await stack.enter_async_context(make(name))
            topics = RosTopics(
                namespace=name if len(names) > 1 else "", detections="detections", emergency="e_stop"
            )
            await stack.enter_async_context(
                SimulatedNav2(simulator, name, transport, release=release, topics=topics)
            )
            typer.echo(f"{name}: {where}, namespace {topics.namespace or 'none'}, {release}")
        await asyncio.Event().wait()


async def _stage(
    stack: AsyncExitStack, settings: SystemConfig, port: int, release: Release
) -> tuple[Callable[[str], Transport], str]:
    """What makes a robot's end of the network it stands on, and how that is called."""
    if settings.network is not None:
        return lambda name: transport_of(settings, node=f"robot_{name}", release=release), "on the network"
    with needs("rosbridge"):
        from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport
    bridge = await stack.enter_async_context(RosbridgeServer(port))
    return lambda _: RosbridgeTransport(bridge.address), bridge.address


async def _check(robot: Robot, world: Path | None, as_json: bool) -> int:
    """Tell what became of each promise; how many are broken."""
    if isinstance(robot, RobotBase):
        await robot.open()
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


def found_class(text: str, settings: SystemConfig | None = None) -> Any:
    """The class or function that is named.

    Args:
        text: ``MODULE:CLASS``, ``FILE.py:CLASS``, or ``FILE.yaml`` of a robot with ROS.
        settings: With the network on which such a robot may be.

    Raises:
        ConfigError: There is none, or the file is wrong.
    """
    if Path(text).suffix in (".yaml", ".yml"):
        file = RosRobotFile.load(Path(text))
        network = settings.network if settings is not None else None
        if settings is None or network is None:
            return file.robot
        beside = settings.model_copy(update={"network": network.beside})
        return lambda name: file.robot(name, lambda: transport_of(beside, node="robot", release=file.release))
    module, _, attribute = text.rpartition(":")
    if not module or not attribute:
        raise ConfigError(f"{text!r} names no class: write MODULE:CLASS, FILE.py:CLASS or FILE.yaml")
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
