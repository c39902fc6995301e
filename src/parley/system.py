"""Puts the halves of a system together for one process: robots with their engines, and the nodes."""

from __future__ import annotations

import asyncio
from collections.abc import Collection, Mapping, Sequence
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Final, Literal

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.agents.planner.check import plan_problems
from parley.clock import Clock, WallClock
from parley.config import SystemConfig
from parley.engine.stop_listener import StopListener
from parley.engines import Engines
from parley.errors import ConfigError, Problem
from parley.extras import needs
from parley.gate.book import RuleBook
from parley.gate.stop_line import StopLine
from parley.language.base import Language
from parley.language.llm import build_language
from parley.language.llm.in_use import EngineInUse
from parley.language.llm.usage import Usage
from parley.memory.folder import held_folder
from parley.memory.store import MemoryStore
from parley.messages import ros, topics
from parley.messages.status import Rejection, RejectionProblem
from parley.messages.wire import to_string
from parley.network import transport_of
from parley.nodes import NODES, NodeName, Nodes
from parley.opening import OpenedTogether
from parley.robots.base import Robot
from parley.robots.fleet import Fleet, OwnFleet
from parley.robots.own import RobotBase
from parley.transport.base import Publisher, Transport
from parley.umrf.action import ActionSpec
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OccupancyMap

if TYPE_CHECKING:  # only where a world is simulated
    from parley.sim.simulator import Simulator
    from parley.sim.world_file import WorldFile

__all__ = ["Part", "System"]

IN_DOUBT: Final = (
    "I cannot read who was stopped for safety the last time, so all robots count as stopped. Make sure that "
    "it is safe, then release the stop."
)


Part = Literal["all", "robots", "agents"]
"""Of a system: all in one process; the robots with their engines; the nodes that understand and plan."""


class System(OpenedTogether):
    """Robots, simulated or own, and everything that makes them understand people; or one half of that.

    Use as ``async with``; what was opened is closed in reverse order, whatever happens.

    Args:
        world: The simulated world; None: there is none.
        config: The settings.
        robots: Robots of your own, which take the place of those of the world.
        occupancy: The map the robots drive by; None: surveyed from the world as it is.
        objects: The object map; None: from the world file.
        language: The language engine; None: as configured.
        transport: None: as configured.
        actions: What the robots can do.
        part: What of it is in this process; `agents` takes neither a world nor robots.
        only: Names of those robots that are in this process; empty: all.
        nodes: Which of the nodes are in this process, if any is.
    """

    def __init__(
        self,
        world: WorldFile | None,
        config: SystemConfig,
        *,
        robots: Sequence[RobotBase] = (),
        occupancy: OccupancyMap | None = None,
        objects: ObjectMap | None = None,
        language: Language | None = None,
        transport: Transport | None = None,
        actions: Sequence[ActionSpec] = BUILTIN_ACTIONS,
        part: Part = "all",
        only: Sequence[str] = (),
        nodes: Collection[NodeName] = NODES,
    ) -> None:
        super().__init__()
        self.config, self._part, self._which = config, part, nodes
        self.transport: Transport = transport or transport_of(config, node=f"parley_{part}")
        self.usage = Usage()
        """What language models took, if any is asked."""
        self.language = EngineInUse(language or self._built(config.language), self._built)
        """What understands people."""
        self._fleet = None if part == "agents" else _fleet(world, config, robots, occupancy)
        self.clock: Clock = self._fleet.clock if self._fleet is not None else WallClock()
        self.objects = objects or (world.object_map() if world is not None else ObjectMap())
        self._actions, self._only = tuple(actions), tuple(only)
        self.robot_names = _chosen(self._fleet, only)
        """The robots of this process."""
        self.stop_line: StopLine
        """Stops the robots, from any thread; there once the system is open."""
        self._engines: Engines | None = None
        self._nodes: Nodes | None = None

    # -- what is in it, once it is open ----------------------------------------------------------------------

    @property
    def engines(self) -> Engines:
        """The robots with their engines.

        Raises:
            ConfigError: They are in another process.
        """
        if self._engines is None:
            raise ConfigError("the robots are in another process")
        return self._engines

    @property
    def nodes(self) -> Nodes:
        """All that understands and plans.

        Raises:
            ConfigError: It is in another process.
        """
        if self._nodes is None:
            raise ConfigError("the nodes are in another process")
        return self._nodes

    @property
    def robots(self) -> Mapping[str, Robot]:
        """The robots of this process."""
        return self.engines.robots

    @property
    def rules(self) -> RuleBook:
        """What robots may do."""
        return self.nodes.rules

    @property
    def store(self) -> MemoryStore | None:
        """The memory."""
        return self.nodes.store

    @property
    def known(self) -> ObjectMap:
        """What people may name: the object map, with what robots found."""
        return self.engines.known

    @property
    def simulator(self) -> Simulator:
        """The simulated world.

        Raises:
            ConfigError: The robots are real.
        """
        simulator: Simulator | None = getattr(self._fleet, "simulator", None)
        if simulator is None:
            raise ConfigError("there is no simulated world: the robots are your own")
        return simulator

    def at_rest(self, robot: str) -> bool | None:
        """Whether a robot stands, measured now; None: it is not of this process. From any thread."""
        return self._engines.at_rest(robot) if self._engines is not None else None

    # -- opening ---------------------------------------------------------------------------------------------

    async def _open(self, stack: AsyncExitStack) -> None:
        enter, config = stack.enter_async_context, self.config
        if config.data_dir is not None:
            stack.enter_context(held_folder(config.data_dir, unix_ms=self.clock.unix_ms()))
        await enter(self.transport)
        self.stop_line = await asyncio.to_thread(StopLine, config.stop_file, self.robot_names)
        stack.push_async_callback(asyncio.to_thread, self.stop_line.close)
        await enter(self.language)
        if self._part != "robots":
            self._nodes = Nodes(
                self.transport,
                config,
                language=self.language,
                clock=self.clock,
                robots=self.robot_names,
                only=self._which,
            )
            await enter(self._nodes)
        if self._part != "agents" or "umrf_planner" in self._which:
            await self._listen_to_stops(stack)
        if self._fleet is not None:
            self._engines = Engines(
                self.transport,
                config,
                self._fleet,
                objects=self.objects,
                language=self.language,
                line=self.stop_line,
                actions=self._actions,
                only=self._only,
            )
            await enter(self._engines)
        if self.stop_line.in_doubt:
            tell = self._nodes.tell if self._nodes is not None else self.engines.tell
            tell(IN_DOUBT, "error")
        if self._nodes is not None:
            await self._nodes.met(self.robot_names)

    def _built(self, language: str) -> Language:
        config = self.config.changed({"language": language})
        return build_language(
            (config.language, *config.language_fallback),
            config.model,
            check=plan_problems,
            usage=self.usage,
            within_s=0.9 * config.language_timeout_s,
        )

    async def _listen_to_stops(self, stack: AsyncExitStack) -> None:
        refusals: Publisher[ros.String] = self.transport.publisher(topics.REJECTION)
        stack.callback(refusals.close)

        def complain(problems: Sequence[Problem]) -> None:
            told = tuple(
                RejectionProblem(path=item.path, message=item.message, remedy=item.remedy, code=item.code)
                for item in problems
            )
            refusals.publish(to_string(Rejection(source="stop_line", what=topics.STOP.name, problems=told)))

        # Who plans keeps the stops of robots that are away; who has robots keeps those of its own.
        ours = {name: name for name in self.robot_names} if self._part == "robots" else None
        listener = StopListener(self.stop_line, self.transport, complain, ours)
        await listener.open()
        stack.push_async_callback(listener.close)


def _fleet(
    world: WorldFile | None, config: SystemConfig, robots: Sequence[RobotBase], occupancy: OccupancyMap | None
) -> Fleet:
    if robots:
        return OwnFleet(robots, occupancy)
    if world is None:
        raise ConfigError("a system needs a simulated world or robots of your own")
    with needs("sim"):
        from parley.robots.simulated import SimulatedFleet
    return SimulatedFleet(world, speed=config.speed, seed=config.seed, occupancy=occupancy)


def _chosen(fleet: Fleet | None, only: Sequence[str]) -> tuple[str, ...]:
    """The robots of this process.

    Raises:
        ConfigError: One that is named is not there.
    """
    names = fleet.names if fleet is not None else ()
    if missing := [name for name in only if name not in names]:
        raise ConfigError(f"there is no robot {missing[0]!r} in this world; there are: {', '.join(names)}")
    return tuple(name for name in names if not only or name in only)
