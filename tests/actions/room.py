"""What an action needs around it: a simulated robot in two rooms, a person, a screen and a memory."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

from parley.actions.context import ActionContext
from parley.clock import Clock, SimClock
from parley.language.base import Language
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage
from parley.robots.simulated import SimulatedRobot
from parley.sim.floor_plan import survey
from parley.sim.simulator import Simulator
from parley.umrf.motion import Motion
from parley.world.approach import Spot
from parley.world.found import FoundThings
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import OccupancyMap
from parley.world.whereabouts import Footprint
from tests.sim.worlds import two_rooms


@dataclass
class Run:
    """The handle of one run; implements `RunHandle`."""

    clock: Clock
    actor: str = "A"
    graph_name: str = "graph"
    node: str = "Action_0"
    logged: list[str] = field(default_factory=list)
    steps: list[tuple[float | None, str]] = field(default_factory=list)
    """Every progress that was told."""
    paused: bool = False
    stop_requested: bool = False
    motion: Motion = field(default_factory=lambda: Motion("Action_0"))
    result_asked: bool = False

    def log(self, text: str) -> None:
        self.logged.append(text)

    def progress(self, fraction: float | None, text: str = "") -> None:
        self.steps.append((fraction, text))

    async def wait_while_paused(self) -> None:
        while self.paused:  # noqa: ASYNC110 - a flag that the test sets
            await asyncio.sleep(0)


@dataclass
class Person:
    """Somebody with prepared answers; implements `Operator`, `Display` and `MemoryAccess`."""

    answers: deque[str] = field(default_factory=deque)
    told: list[str] = field(default_factory=list)
    told_with: list[CameraImage | None] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    offered: list[Sequence[str]] = field(default_factory=list)
    referred: list[str] = field(default_factory=list)
    shown: list[tuple[str, CameraImage, dict[str, Any]]] = field(default_factory=list)
    memories: list[MemoryEntry] = field(default_factory=list)

    def tell(self, text: str, picture: CameraImage | None = None) -> None:
        self.told.append(text)
        self.told_with.append(picture)

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        self.asked.append(question)
        self.offered.append(choices)
        return self.answers.popleft()

    async def refer(self, reply: str) -> None:
        self.referred.append(reply)

    def show(self, feed: str, image: CameraImage, info: Mapping[str, Any] | None = None) -> None:
        self.shown.append((feed, image, dict(info or {})))

    async def find(self, request: str) -> list[MemoryEntry]:
        return self.memories

    def add(self, entry: MemoryEntry) -> None:
        self.memories.append(entry)


@dataclass
class View:
    """Implements `World`; what is noted is kept."""

    base: ObjectMap
    occupancy: OccupancyMap
    found: FoundThings = field(default_factory=FoundThings)
    taken: tuple[Spot, ...] = ()
    claimed: list[Pose2D] = field(default_factory=list)

    def claim(self, spot: Pose2D) -> bool:
        self.claimed.append(spot)
        return True

    @property
    def objects(self) -> ObjectMap:
        return self.found.added_to(self.base)

    async def note(self, label: str, place: Footprint) -> MapObject | None:
        return await self.found.note(label, place, self.base)

    async def forget(self, thing: MapObject) -> None:
        await self.found.forget(thing)


@dataclass
class Room:
    """An action's surroundings, and the context made of them."""

    run: Run
    person: Person
    simulator: Simulator
    robot: SimulatedRobot
    view: View
    language: Language
    script: ScriptedLanguage

    @property
    def context(self) -> ActionContext:
        return ActionContext(
            run=self.run, robot=self.robot, world=self.view, memory=self.person, display=self.person,
            operator=self.person, language=self.language,
        )  # fmt: skip


@asynccontextmanager
async def room(
    changes: Mapping[str, Any] | None = None, language: Language | None = None, *, model: str = ""
) -> AsyncIterator[Room]:
    """Robot "A" in two rooms with `changes` that its map of free floor does not know.

    Args:
        changes: See `two_rooms`.
        language: None: a scripted one.
        model: Of the robot, if it is another one.
    """
    script = ScriptedLanguage(language)
    world = two_rooms(changes).with_models(model) if model else two_rooms(changes)
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        occupancy = survey(two_rooms(), 0.3)
        yield Room(
            Run(simulator.clock), Person(), simulator, SimulatedRobot(simulator, "A", occupancy),
            View(world.object_map(), occupancy), script, script,
        )  # fmt: skip
