"""What an action sees of the world: its context, and nothing else."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from parley.actions.mates import ALONE, Mates
from parley.clock import Clock
from parley.language.base import Language
from parley.memory.pictures import pixels_to_jpeg
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage, Robot
from parley.umrf.action import RunHandle
from parley.world.approach import Spot
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import OccupancyMap
from parley.world.whereabouts import NEAR_M, Footprint, called

__all__ = ["ActionContext", "Display", "MemoryAccess", "Operator", "World"]


class Operator(Protocol):
    """The person, as an action reaches them."""

    def tell(self, text: str, picture: CameraImage | None = None) -> None:
        """Say something, and show the picture that it is about; no answer is expected."""
        ...

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        """Ask and wait for the answer, however long it takes; cancelling withdraws the question."""
        ...

    async def refer(self, reply: str) -> None:
        """Let what was said instead of an answer be understood like any message; wait for the reply to it."""
        ...


class Display(Protocol):
    """The operator's screen."""

    def show(self, feed: str, image: CameraImage, info: Mapping[str, Any] | None = None) -> None:
        """Put a picture on one of this robot's feeds."""
        ...


class MemoryAccess(Protocol):
    """What is remembered."""

    async def find(self, request: str) -> list[MemoryEntry]:
        """Memories that matter for `request`, oldest first."""
        ...

    def add(self, entry: MemoryEntry) -> None:
        """Remember something this robot saw or did."""
        ...


class World(Protocol):
    """What is known about the surroundings."""

    @property
    def objects(self) -> ObjectMap:
        """The objects people may name."""
        ...

    @property
    def occupancy(self) -> OccupancyMap:
        """Where there is free floor."""
        ...

    @property
    def taken(self) -> Sequence[Spot]:
        """Where other robots stand, or are going to."""
        ...

    def claim(self, spot: Pose2D) -> bool:
        """Let other robots know where this one is going to stand; False if one of them is going there."""
        ...

    async def forget(self, thing: MapObject) -> None:
        """Take something that was found from the object map: it is not there any more."""
        ...

    async def note(self, label: str, place: Footprint) -> MapObject | None:
        """Put something that was found on the object map, or to where it was moved.

        Returns:
            It, as it stands on the map from now on; None if it stands in or on something that is there.
        """
        ...


@dataclass(frozen=True, slots=True)
class ActionContext:
    """Given to every action as its first argument."""

    run: RunHandle
    robot: Robot
    world: World
    memory: MemoryAccess
    display: Display
    operator: Operator
    language: Language
    mates: Mates = ALONE

    @property
    def clock(self) -> Clock:
        """Robot time."""
        return self.run.clock

    @property
    def actor(self) -> str:
        """The robot's name."""
        return self.run.actor

    @property
    def source(self) -> str:
        """Who remembers, for memories: robot and action, e.g. ``Ada/Inspect``."""
        return f"{self.actor}/{re.sub(r'_[0-9]+$', '', self.run.node)}"

    def whereabouts(self) -> str:
        """Where the robot stands, in words; by the metres of the map only where no object is known."""
        pose = self.robot.pose()
        distances = [
            (math.hypot(item.x_m - pose.x_m, item.y_m - pose.y_m), item)
            for item in self.world.objects.objects
        ]
        distance_m, nearest = min(distances, key=lambda pair: pair[0], default=(math.inf, None))
        if nearest is None:
            return f"at x {pose.x_m:.1f} m, y {pose.y_m:.1f} m"
        name = called(nearest.description or nearest.class_name)
        return f"near {name}" if distance_m <= NEAR_M else f"about {distance_m:.0f} metres from {name}"

    def remember(self, name: str, text: str, *, info: str = "", own: bool = False) -> None:
        """Remember something this robot saw or did.

        Args:
            name: Of the memory; one of the same name is replaced.
            text: What is to be remembered, as a sentence.
            info: What it is about, if that is not the sentence itself.
            own: For this robot alone instead of for all.
        """
        scope = self.actor if own else ""
        self.memory.add(MemoryEntry(name=name, data=text, info=info or text, scope=scope, source=self.source))

    def remember_picture(self, name: str, image: CameraImage, *, info: str = "", own: bool = False) -> None:
        """Remember a picture of this robot's camera; the arguments are those of `remember`."""
        scope = self.actor if own else ""
        self.memory.add(
            MemoryEntry(
                name=name,
                type="image",
                data=pixels_to_jpeg(image.data),
                info=info or name,
                scope=scope,
                source=self.source,
            )
        )
