"""Puts the rooms together for one process: simulation, engines, the five nodes, over one transport."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AsyncExitStack
from dataclasses import dataclass
from types import TracebackType
from typing import Self

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.actions.context import ActionContext
from parley.clock import SimClock
from parley.config import SystemConfig
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.engine.services import ContextServices
from parley.language.base import Language
from parley.language.offline import OfflineLanguage
from parley.memory.store import MemoryStore
from parley.nodes.camera_feed import CameraFeed
from parley.nodes.chat_interface import ChatInterface
from parley.nodes.display_interface import DisplayInterface
from parley.nodes.error_handler import ErrorHandler
from parley.nodes.memory import MemoryNode
from parley.nodes.notices import Notices
from parley.nodes.plan_restore import interruption_text, restored_steps
from parley.nodes.umrf_planner import UmrfPlanner
from parley.robots.base import Robot
from parley.robots.simulated import SimulatedRobot
from parley.sim.simulator import Simulator
from parley.sim.world_file import WorldFile
from parley.transport.base import Transport
from parley.transport.local import LocalTransport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.discovery import ActionFolder, LiveActions, installed_actions
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import OccupancyMap

__all__ = ["System", "WorldView"]


@dataclass(frozen=True, slots=True)
class WorldView:
    """What one robot knows about its surroundings."""

    objects: ObjectMap
    occupancy: OccupancyMap


class System:
    """A simulated world with its robots, and everything that makes them understand people.

    Use as ``async with``; what was opened is closed in reverse order, whatever happens.

    Args:
        world: The simulated world.
        config: The settings.
        occupancy: The map the robots drive by; None: surveyed from the world as it is.
        objects: The object map; None: from the world file.
        language: The language engine; None: as configured.
        transport: None: everything in this process.
        actions: What the robots can do.
    """

    def __init__(
        self,
        world: WorldFile,
        config: SystemConfig,
        *,
        occupancy: OccupancyMap | None = None,
        objects: ObjectMap | None = None,
        language: Language | None = None,
        transport: Transport | None = None,
        actions: Sequence[ActionSpec] = BUILTIN_ACTIONS,
    ) -> None:
        self.config = config
        self.clock = SimClock()
        self.transport: Transport = transport or LocalTransport()
        self.language: Language = language or OfflineLanguage()
        self.simulator = Simulator(world, clock=self.clock, speed=config.speed, seed=config.seed)
        self.objects = objects or world.object_map()
        installed = installed_actions()
        self._actions = (*actions, *installed.specs)
        self._problems = installed.problems
        self.catalogue = Catalogue(self._actions)
        self.robots: dict[str, Robot] = {}
        self.store: MemoryStore | None = None
        self._journal: Journal | None = None
        self._occupancy = occupancy
        self._stack = AsyncExitStack()

    async def __aenter__(self) -> Self:
        try:
            await self._open()
        except BaseException:
            await self._stack.aclose()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()

    @property
    def robot_names(self) -> tuple[str, ...]:
        """The robots of this world."""
        return tuple(robot.name for robot in self.simulator.world.robots)

    async def _open(self) -> None:
        enter = self._stack.enter_async_context
        config, transport, clock = self.config, self.transport, self.clock
        await enter(transport)
        self.store = await enter(await MemoryStore.open(config.memory_file or ":memory:", clock))
        journal = self._journal = await enter(await Journal.open(config.journal_file or ":memory:", clock))
        await enter(self.simulator)
        await enter(MemoryNode(transport, self.store, self.language))
        await enter(
            DisplayInterface(
                transport, clock, quality=config.display_quality, min_interval_s=config.display_interval_s
            )
        )
        ask_first = self.robot_names if config.approval == "ask_first" else ()
        planner = await enter(UmrfPlanner(transport, clock, ask_first=ask_first))
        await enter(
            ErrorHandler(
                transport,
                self.language,
                clock,
                objects=self._objects_of,
                max_attempts=config.max_attempts,
                language_timeout_s=config.language_timeout_s,
            )
        )
        await enter(
            ChatInterface(
                transport,
                self.language,
                clock,
                objects=self._objects_of,
                history_exchanges=config.history_exchanges,
                language_timeout_s=config.language_timeout_s,
            )
        )
        notices = await enter(Notices(transport))
        self._tell_interrupted(journal, planner, notices)
        await self._open_actions(notices)
        views: Mapping[str, WorldView] = {name: self._view(name) for name in self.robot_names}
        for name in self.robot_names:
            await self._open_robot(name, views[name])

    def _tell_interrupted(self, journal: Journal, planner: UmrfPlanner, notices: Notices) -> None:
        """Hold what a killed process left of each robot's plan, and offer it to the operator."""
        newest = {was.actor: was for was in journal.interrupted if was.actor in self.robot_names}
        for robot, was in newest.items():
            steps = restored_steps(was)
            planner.restore(robot, steps)
            notices.tell(interruption_text(was, steps), [robot])

    async def _open_actions(self, notices: Notices) -> None:
        def tell(problem: str) -> None:
            notices.tell(f"An action cannot be used: {problem}", self.robot_names, "error")

        for problem in self._problems:
            tell(problem)
        if self.config.actions_dir is not None:
            folder = ActionFolder(self.config.actions_dir)
            live = LiveActions(self.catalogue, folder, self._actions, tell=tell)
            await self._stack.enter_async_context(live)

    async def _open_robot(self, name: str, view: WorldView) -> None:
        robot = SimulatedRobot(self.simulator, name, view.occupancy)
        self.robots[name] = robot
        services = await self._stack.enter_async_context(ContextServices(name, self.transport))

        def make_context(run: RunHandle) -> ActionContext:
            return ActionContext(
                run=run,
                robot=robot,
                world=view,
                memory=services,
                display=services,
                operator=services,
                language=self.language,
            )

        await self._stack.enter_async_context(
            ActionEngine(
                name,
                transport=self.transport,
                catalogue=self.catalogue,
                clock=self.clock,
                make_context=make_context,
                robot=robot,
                journal=self._journal,
            )
        )
        await self._stack.enter_async_context(CameraFeed(self.transport, robot, self.config.camera_hz))

    def _view(self, robot: str) -> WorldView:
        return WorldView(self.objects, self._occupancy or self.simulator.occupancy(robot))

    def _objects_of(self, _robot: str) -> Sequence[MapObject]:
        return self.objects.objects
