"""What a robot with ROS is like, as a file says (YAML), which is named wherever a class of robots is.

::

    kind: nav2
    address: ws://192.168.1.5:9090
    radius_m: 0.22
    topics: {camera: camera/image_raw/compressed, emergency: e_stop}
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from parley.errors import ConfigError
from parley.files import TextFile, validated_yaml
from parley.messages.ros_robot import Release
from parley.robots.base import DriveLimits
from parley.robots.nav2 import Nav2Robot, Nav2Setup
from parley.robots.ros1 import Ros1Robot, Ros1Setup
from parley.robots.ros_robot import SLOW_DRIVE, Connect, RosRobot
from parley.robots.ros_senses import RosTopics
from parley.transport.base import Transport

__all__ = ["RosRobotFile"]


class RosRobotFile(BaseModel, TextFile):
    """One robot, or several that are alike; a name stands in `namespace` as ``{name}``."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    kind: Literal["nav2", "ros1"] = "nav2"
    """`ros1`: with move_base."""
    address: str = Field(default="", pattern=r"^(wss?://\S+)?$")
    """Of the rosbridge on it; empty: it is on the network of the settings."""
    release: Release = "jazzy"
    """Whose messages its Nav2 has."""
    action: str = ""
    """By which it drives to a place; empty: the usual one."""
    radius_m: float = Field(default=0.25, gt=0)
    limits: DriveLimits = SLOW_DRIVE
    topics: RosTopics = RosTopics()

    @model_validator(mode="after")
    def _reachable(self) -> Self:
        if self.kind == "ros1" and not self.address:
            raise ValueError("a robot with ROS 1 needs the address of its rosbridge")
        return self

    @classmethod
    def parse(cls, text: str, file: str = "robot") -> Self:
        """Read the text of such a file.

        Raises:
            FileFormatError: Names the file, the line and what is wrong or unknown.
        """
        return validated_yaml(cls, text, file)

    def robot(self, name: str, network: Callable[[], Transport] | None = None) -> RosRobot:
        """The robot of that name.

        Args:
            name: How people call it.
            network: Makes an end of the network of the settings.

        Raises:
            ConfigError: It is on that network, and there is none.
        """
        connect: Connect | None = self.address or network
        if connect is None:
            raise ConfigError(f"{name} has no address, and the settings name no network on which it could be")
        topics = replace(self.topics, namespace=self.topics.namespace.replace("{name}", name))
        given: dict[str, Any] = {"topics": topics, "radius_m": self.radius_m, "limits": self.limits}
        given |= {"action": self.action} if self.action else {}
        if self.kind == "ros1":
            return Ros1Robot(name, connect, Ros1Setup(**given))
        return Nav2Robot(name, connect, Nav2Setup(**given, release=self.release))
