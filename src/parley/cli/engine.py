"""`parley engine`: robots with their engines in a process of their own, on the network of the settings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.cli.node import NetworkOption, networked, run_system
from parley.cli.on_loop import on_loop
from parley.cli.output import quiet_logs
from parley.cli.robot import found_class, made_robot
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, demo_folder
from parley.errors import ConfigError
from parley.robots.own import RobotBase
from parley.site import Site
from parley.system import System
from parley.transport.base import Transport

__all__ = ["command", "system_of_robots"]


def command(
    config: NetworkOption,
    world: Annotated[
        str, typer.Option(help=f"Where the robots are: a folder, or one of: {', '.join(DEMOS)}.")
    ] = "",
    robot: Annotated[
        list[str] | None, typer.Option(help="Name of a robot; repeatable. Default: all of the world.")
    ] = None,
    kind: Annotated[
        str,
        typer.Option(
            "--class",
            metavar="MODULE:CLASS",
            help="Your own class of robots; also FILE.py:CLASS, or FILE.yaml of robots with ROS.",
        ),
    ] = "",
    data: Annotated[Path | None, typer.Option(help="Folder for what these robots do and find.")] = None,
    speed: Annotated[float | None, typer.Option(help="Simulated seconds per second.")] = None,
    verbose: Annotated[bool, typer.Option("--verbose", help="Show the log.")] = False,
) -> None:
    """Carry out plans for robots, which are made in another process or on another machine."""
    quiet_logs(verbose)
    changes = {"data_dir": data, "speed": speed}
    given = {name: value for name, value in changes.items() if value is not None}
    settings = networked(config).changed(given)
    on_loop(run_system(system_of_robots(settings, world, robot or [], kind)))


def system_of_robots(
    settings: SystemConfig, world: str, robots: list[str], kind: str, transport: Transport | None = None
) -> System:
    """The robots of a place with their engines.

    Args:
        settings: With a network among them.
        world: A demonstration, or a folder; empty: nowhere.
        robots: Their names; empty: all that the world simulates.
        kind: A class for them, instead of simulated ones.
        transport: None: as the settings say.

    Raises:
        ConfigError: There is no such place, robot or class, or too little is said.
    """
    site = Site.load(demo_folder(world) if world in DEMOS else world) if world else Site()
    if not kind:
        if site.world is None:
            raise ConfigError("name a --world that can be simulated, or the --class of your robots")
        return System(
            site.world, settings, occupancy=site.occupancy, objects=site.objects, part="robots",
            only=robots, transport=transport,
        )  # fmt: skip
    made = [made_robot(found_class(kind, settings), name) for name in robots or ["robot"]]
    own = [robot for robot in made if isinstance(robot, RobotBase)]
    if len(own) < len(made):
        raise ConfigError(f"{kind} makes no RobotBase")
    return System(
        None, settings, robots=own, occupancy=site.occupancy, objects=site.objects, actions=BUILTIN_ACTIONS,
        part="robots", transport=transport,
    )  # fmt: skip
