"""The public door to Parley: everything another program needs, and the only part that keeps its promises.

::

    async with Parley("nursing-home", by=person("Ada")) as parley:
        await parley.say(parley.robots[0], "go to the table")

Versions are semantic: what is named here changes in an incompatible way only with a new major version (before
1.0: a new minor one, told in the changelog). Everything else in `parley` may change at any time. Names are
loaded when they are first used, so importing this costs next to nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from parley.actions.context import ActionContext
    from parley.api.door import Parley, step
    from parley.api.listening import Events
    from parley.api.running import GraphRun, Page
    from parley.api.sync import SyncParley
    from parley.config import ModelSettings, SystemConfig
    from parley.errors import (
        ActionFailure,
        ConfigError,
        FailureCode,
        GraphRefusedError,
        MissingExtraError,
        NotAllowedError,
        ParleyError,
    )
    from parley.messages.chat import ActionCall, ChatFeedback
    from parley.messages.incident import Incident
    from parley.messages.memory import MemoryEntry, MemoryEvent
    from parley.messages.principal import Principal, person, program
    from parley.messages.status import GraphEvent, PlanProposal, PlanRuling, PlanUpdate, Rejection, StopReport
    from parley.robots.base import (
        CameraImage,
        Detection,
        DriveLimits,
        LaserScan,
        NavigationControl,
        Robot,
        Velocity,
    )
    from parley.robots.check import Kept, check_robot
    from parley.robots.nav2 import Nav2Robot, Nav2Setup
    from parley.robots.own import RobotBase
    from parley.robots.ros_senses import RosTopics
    from parley.site import Site
    from parley.umrf.action import Outcome, action
    from parley.world.geometry import Pose2D
    from parley.world.object_map import MapObject, ObjectMap
    from parley.world.occupancy import OccupancyMap

_WHERE: Final = {
    "actions.context": ("ActionContext",),
    "api.door": ("Parley", "step"),
    "api.listening": ("Events",),
    "api.running": ("GraphRun", "Page"),
    "api.sync": ("SyncParley",),
    "config": ("ModelSettings", "SystemConfig"),
    "errors": (
        "ActionFailure", "ConfigError", "FailureCode", "GraphRefusedError", "MissingExtraError",
        "NotAllowedError", "ParleyError",
    ),
    "messages.chat": ("ActionCall", "ChatFeedback"),
    "messages.incident": ("Incident",),
    "messages.memory": ("MemoryEntry", "MemoryEvent"),
    "messages.principal": ("Principal", "person", "program"),
    "messages.status": (
        "GraphEvent", "PlanProposal", "PlanRuling", "PlanUpdate", "Rejection", "StopReport",
    ),
    "robots.base": (
        "CameraImage", "Detection", "DriveLimits", "LaserScan", "NavigationControl", "Robot", "Velocity",
    ),
    "robots.check": ("Kept", "check_robot"),
    "robots.nav2": ("Nav2Robot", "Nav2Setup"),
    "robots.own": ("RobotBase",),
    "robots.ros_senses": ("RosTopics",),
    "site": ("Site",),
    "umrf.action": ("Outcome", "action"),
    "world.geometry": ("Pose2D",),
    "world.object_map": ("MapObject", "ObjectMap"),
    "world.occupancy": ("OccupancyMap",),
}  # fmt: skip
"""Module -> the names it gives to the door."""

__all__ = [
    "ActionCall", "ActionContext", "ActionFailure", "CameraImage", "ChatFeedback", "ConfigError",
    "Detection", "DriveLimits", "Events", "FailureCode", "GraphEvent", "GraphRefusedError", "GraphRun",
    "Incident", "Kept", "LaserScan", "MapObject", "MemoryEntry", "MemoryEvent", "MissingExtraError",
    "ModelSettings", "Nav2Robot", "Nav2Setup", "NavigationControl", "NotAllowedError", "ObjectMap",
    "OccupancyMap", "Outcome", "Page", "Parley", "ParleyError", "PlanProposal", "PlanRuling", "PlanUpdate",
    "Pose2D", "Principal", "Rejection", "Robot", "RobotBase", "RosTopics", "Site", "StopReport",
    "SyncParley", "SystemConfig", "Velocity", "action", "check_robot", "person", "program", "step",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Load a name of the door when it is first used."""
    for module, names in _WHERE.items():
        if name in names:
            value = globals()[name] = getattr(importlib.import_module(f"parley.{module}"), name)
            return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
