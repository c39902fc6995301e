"""`parley world`: check world files, make maps and pictures of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from PIL import Image

from parley.cli.on_loop import on_loop
from parley.clock import SimClock
from parley.errors import ConfigError
from parley.sim.export import MAP_NAME, OBJECT_MAP_FILE, export_maps
from parley.sim.simulator import Simulator
from parley.sim.world_file import WorldFile

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)

WorldArgument = Annotated[Path, typer.Argument(help="A world file (YAML).")]
RobotOption = Annotated[str, typer.Option(help="Whose eyes or height; default: the world's first robot.")]


@app.command("check")
def check(file: WorldArgument) -> None:
    """Read a world file and say what is in it, or what is wrong with it."""
    world = WorldFile.load(file)
    things, robots = len(world.things), ", ".join(robot.name for robot in world.robots)
    more = ", ".join(robot.name for robot in world.standby)
    standby = f"; on standby: {more}" if more else ""
    typer.echo(f"{world.name}: {things} thing{'s' * (things != 1)}, robots: {robots}{standby}")


@app.command("map")
def make_map(
    file: WorldArgument,
    out: Annotated[Path, typer.Argument(help="Folder for object_map.json, map.yaml and map.pgm.")],
) -> None:
    """Survey the world: a ROS map for its first robot, and the object map."""
    world = WorldFile.load(file)
    try:
        out.mkdir(parents=True, exist_ok=True)
        export_maps(world, out)
    except OSError as error:
        raise ConfigError(f"{out} cannot be written to: {error.strerror}") from error
    typer.echo(f"Written into {out}: {OBJECT_MAP_FILE}, {MAP_NAME}.yaml and {MAP_NAME}.pgm")


@app.command("picture")
def picture(
    file: WorldArgument,
    out: Annotated[Path, typer.Argument(help="The picture (PNG).")],
    camera: Annotated[
        bool, typer.Option("--camera", help="What the robot sees, instead of the map view.")
    ] = False,
    robot: RobotOption = "",
    width: Annotated[int, typer.Option(min=64, max=4096, help="Width of the map view in pixels.")] = 900,
) -> None:
    """Take a picture of a world from above, or with a robot's camera."""
    world = WorldFile.load(file)
    on_loop(_picture(world, out, _robot(world, robot) if camera else "", width))


async def _picture(world: WorldFile, out: Path, robot: str, width: int) -> None:
    async with Simulator(world, clock=SimClock()) as simulator:
        pixels = (await simulator.photograph(robot)).frame.rgb if robot else await simulator.top_down(width)
    try:
        Image.fromarray(pixels).save(out)
    except ValueError as error:
        raise ConfigError(f"{out} is no name of a picture: let it end in .png") from error
    except OSError as error:
        raise ConfigError(f"{out} cannot be written: {error.strerror}") from error


def _robot(world: WorldFile, name: str) -> str:
    names = [robot.name for robot in world.robots]
    if name and name not in names:
        raise ConfigError(f"there is no robot {name!r} in {world.name}; there are: {', '.join(names)}")
    return name or names[0]
