"""What `ros2 run parley_ros NAME` starts: one part of Parley as a node of ROS, told by its parameters."""

from __future__ import annotations

import sys
from collections.abc import Coroutine, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import structlog
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from parley.cli.engine import system_of_robots
from parley.cli.node import run_system
from parley.cli.on_loop import on_loop
from parley.cli.web import page_settings, serve_until_interrupted
from parley.config import NetworkSettings, Ros2Settings, SystemConfig
from parley.errors import ConfigError, ParleyError
from parley.extras import needs
from parley.network import transport_of
from parley.nodes import NODES
from parley.ros_check import need_ros
from parley.system import System

if TYPE_CHECKING:
    from parley.web.server import WebServer

__all__ = ["NAMES", "Parameters", "main"]

NAMES: Final = (*NODES, "nodes", "engine", "web")
"""What can be started; `nodes` is all of `NODES` in one process."""
log = structlog.get_logger(__name__)

_OF_ROS: Final = ("use_sim_time", "qos_overrides.", "start_type_description_service")


class Parameters(BaseModel):
    """What a node can be told, by a launch file, a file of parameters or `--ros-args -p`."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    config: str = ""
    """File with the settings; of its `network` nothing counts here."""
    data: str = ""
    """Folder for what this part keeps; each part needs its own."""
    language: str = ""
    """What understands people: `builtin` or a model, as in the settings."""
    without: tuple[str, ...] = ()
    """`nodes`: those that run elsewhere, or not at all."""
    actor_name: tuple[str, ...] = ()
    """`engine`: the robot's name, or those of several; empty: all of the world."""
    actions_path: str = ""
    """`engine`: a folder with more actions."""
    world: str = ""
    """`engine`: where the robot is; without `robot_class` it is simulated there."""
    robot_class: str = ""
    """`engine`: `FILE.yaml` of robots with Nav2, `MODULE:CLASS` or `FILE.py:CLASS` of your own."""
    speed: float = Field(default=1.0, gt=0)
    """`engine`: simulated seconds per second."""
    port: int = Field(default=8400, ge=0, le=65535)
    """`web`: where the page is served."""
    lan: bool = False
    """`web`: let other devices in, with HTTPS and a code to sign in."""
    password_file: str = ""
    """`web`: a password to sign in with."""

    @classmethod
    def told(cls, values: dict[str, Any]) -> Parameters:
        """What ROS has for a node; its own parameters are passed over.

        Raises:
            ConfigError: One is unknown or wrong; says which.
        """
        ours = {name: value for name, value in values.items() if not name.startswith(_OF_ROS)}
        if values.get("use_sim_time"):
            log.warning("use_sim_time does nothing here: what is promised counts on the wall's time")
        for name in ("without", "actor_name"):
            if isinstance(told := ours.get(name), str):  # launch files have but texts
                ours[name] = tuple(word.strip() for word in told.split(",") if word.strip())
        try:
            return cls(**ours)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            name = ".".join(map(str, first["loc"]))
            raise ConfigError(
                f"parameter {name}: {first['msg']}; there are: {', '.join(cls.model_fields)}"
            ) from error

    def settings(self, arguments: Sequence[str]) -> SystemConfig:
        """The settings of one part."""
        settings = SystemConfig.load(Path(self.config)) if self.config else SystemConfig()
        changes: dict[str, Any] = {"speed": self.speed}
        for name, value in (
            ("data_dir", self.data),
            ("language", self.language),
            ("actions_dir", self.actions_path),
        ):
            if value:
                changes[name] = value
        ros2 = Ros2Settings(arguments=tuple(arguments))
        return settings.changed(changes).model_copy(update={"network": NetworkSettings(ros2=ros2)})


def main(name: str) -> None:
    """Run one part until it is told to end.

    Raises:
        SystemExit: It cannot run; says why.
    """
    arguments = sys.argv[1:]
    try:
        need_ros()
        on_loop(_run(name, arguments))
    except ParleyError as error:
        sys.exit(f"{name}: {error}")
    except SystemExit:  # a signal: so nodes are ended, and nobody is to call it an error
        return


async def _run(name: str, arguments: Sequence[str]) -> None:
    from parley.transport.ros2 import parameters

    told = Parameters.told(await parameters(name, arguments))
    settings = told.settings(arguments)
    await _work(name, told, settings)


def _work(name: str, told: Parameters, settings: SystemConfig) -> Coroutine[Any, Any, None]:
    if name == "web":
        return _serve(told, settings)
    transport = transport_of(settings, node=name)
    if name == "engine":
        robots = system_of_robots(settings, told.world, list(told.actor_name), told.robot_class, transport)
        return run_system(robots)
    if unknown := sorted(set(told.without) - set(NODES)):
        raise ConfigError(f"without: there is no node {unknown[0]!r}; there are: {', '.join(NODES)}")
    which = [each for each in NODES if name == each or (name == "nodes" and each not in told.without)]
    return run_system(System(None, settings, part="agents", nodes=which, transport=transport))


async def _serve(told: Parameters, settings: SystemConfig) -> None:
    with needs("web"):
        from parley.web.config import WebConfig
        from parley.web.server import WebServer

    page = page_settings(
        port=told.port, lan=told.lan, password_file=Path(told.password_file) if told.password_file else None,
        pair_as="operator", certificate=None, key=None, origins=(), without="",
    )  # fmt: skip
    page |= {"data_dir": told.data or None}
    server: WebServer
    async with (
        transport_of(settings, node="web") as transport,
        WebServer(transport, WebConfig.of(settings, **page), port_is_wish=False) as server,
    ):
        await serve_until_interrupted(server, opens=False)
