"""What an action sees of the world: its context, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from parley.clock import Clock
from parley.language.base import Language
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage, Robot
from parley.umrf.action import RunHandle
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OccupancyMap

__all__ = ["ActionContext", "Display", "MemoryAccess", "Operator", "World"]


class Operator(Protocol):
    """The person, as an action reaches them."""

    def tell(self, text: str) -> None:
        """Say something; no answer is expected."""
        ...

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        """Ask and wait for the answer, however long it takes; cancelling withdraws the question."""
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

    @property
    def clock(self) -> Clock:
        """Robot time."""
        return self.run.clock

    @property
    def actor(self) -> str:
        """The robot's name."""
        return self.run.actor
