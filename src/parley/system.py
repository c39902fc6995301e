"""Puts the rooms together for one process: robots, engines, the five nodes, over one transport."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Mapping, Sequence
from contextlib import AbstractAsyncContextManager, AsyncExitStack
from dataclasses import dataclass
from functools import partial
from types import TracebackType
from typing import TYPE_CHECKING, Final, Literal, Self, TypeVar

import structlog

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.actions.context import ActionContext
from parley.agents.audit_log import AuditLog
from parley.agents.base import Node
from parley.agents.calls.calls import Calls
from parley.agents.chat.chat_interface import ChatInterface
from parley.agents.display.camera_feed import CameraFeed
from parley.agents.display.display_interface import DisplayInterface
from parley.agents.display.map_feed import MapFeed, MapViews
from parley.agents.display.map_service import MapService
from parley.agents.memory import MemoryNode
from parley.agents.notices import Notices
from parley.agents.planner.check import plan_problems
from parley.agents.planner.restore import adopted_steps, interruption_text, restored_steps
from parley.agents.planner.steps import Step
from parley.agents.planner.umrf_planner import UmrfPlanner
from parley.agents.planner.unattended import UnattendedPlans
from parley.agents.recovery.error_handler import ErrorHandler
from parley.agents.recovery.repair import left_over_text
from parley.agents.rules.lookout import Lookout
from parley.agents.rules.rules import MapOf, RuleNode
from parley.config import SystemConfig
from parley.engine.engine import ActionEngine
from parley.engine.interrupted import Interrupted
from parley.engine.journal import Journal
from parley.engine.presence import is_at_rest
from parley.engine.services import ContextServices
from parley.engine.stop_listener import StopListener
from parley.engine.watchdog import LoopWatchdog
from parley.errors import ConfigError, GraphRefusedError, Problem
from parley.extras import needs
from parley.gate.audit_store import AuditStore
from parley.gate.book import RuleBook
from parley.gate.judge import Judgement
from parley.gate.places import Resolver
from parley.gate.rule_talk import RuleTalk, left_over_rule
from parley.gate.rules import RuleKeeper
from parley.gate.stop_line import StopLine
from parley.gate.ways import judge_with_ways, with_walls
from parley.language.base import Language
from parley.language.llm import build_language
from parley.language.llm.usage import Usage
from parley.memory.embedder import configured_embedder
from parley.memory.folder import held_folder
from parley.memory.incidents import IncidentStore
from parley.memory.meanings import Meanings
from parley.memory.proposals import ProposalStore
from parley.memory.store import MemoryStore
from parley.messages import ros, topics
from parley.messages.chat import ActionCall
from parley.messages.principal import Principal
from parley.messages.status import ActionInfo, Rejection, RejectionProblem
from parley.messages.wire import to_string
from parley.network import transport_of
from parley.robots.base import Robot
from parley.robots.fleet import Fleet, OwnFleet
from parley.robots.own import RobotBase
from parley.robots.run_robot import RunRobot
from parley.team.outlook import Outlook, Task, survey
from parley.transport.base import Publisher, Transport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.discovery import ActionFolder, LiveActions, installed_actions
from parley.umrf.model import GraphState
from parley.world.approach import Spot
from parley.world.found import FoundThings
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import NO_MAP, OccupancyMap
from parley.world.whereabouts import Footprint

if TYPE_CHECKING:  # only where a world is simulated
    from parley.sim.simulator import Simulator
    from parley.sim.world_file import WorldFile

__all__ = ["System", "WorldView"]

N = TypeVar("N", bound=Node)

log = structlog.get_logger(__name__)

IN_DOUBT: Final = (
    "I cannot read who was stopped for safety the last time, so all robots count as stopped. Make sure that "
    "it is safe, then release the stop."
)


@dataclass(frozen=True, slots=True)
class WorldView:
    """What one robot knows about its surroundings."""

    system: System
    robot: str
    occupancy: OccupancyMap

    @property
    def objects(self) -> ObjectMap:
        """The objects people may name, with what was found."""
        return self.system.known

    @property
    def taken(self) -> tuple[Spot, ...]:
        """See `parley.actions.context.World.taken`."""
        others = [robot for name, robot in self.system.robots.items() if name != self.robot]
        here = [(robot.pose(), robot.radius_m) for robot in others]
        return (*((pose.x_m, pose.y_m, radius_m) for pose, radius_m in here), *self._claimed)

    @property
    def _claimed(self) -> tuple[Spot, ...]:
        return tuple(spot for name, spot in self.system.claims.items() if name != self.robot)

    def claim(self, spot: Pose2D) -> bool:
        """See `parley.actions.context.World.claim`."""
        own = (spot.x_m, spot.y_m, self.system.robots[self.robot].radius_m)
        self.system.claims[self.robot] = own
        return all(math.dist(own[:2], other[:2]) > own[2] + other[2] for other in self._claimed)

    async def note(self, label: str, place: Footprint) -> MapObject | None:
        """See `parley.actions.context.World.note`."""
        if self.occupancy is not NO_MAP and not self.occupancy.is_free(place.x_m, place.y_m):
            return None
        return await self.system.found.note(label, place, self.system.objects)

    async def forget(self, thing: MapObject) -> None:
        """See `parley.actions.context.World.forget`."""
        await self.system.found.forget(thing)


class System:
    """Robots, simulated or own, and everything that makes them understand people.

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
    ) -> None:
        self.config = config
        self.transport: Transport = transport or transport_of(config)
        self.usage = Usage()
        """What language models took, if any is asked."""
        self.language: Language = language or build_language(
            (config.language, *config.language_fallback),
            config.model,
            check=plan_problems,
            usage=self.usage,
            within_s=0.9 * config.language_timeout_s,
        )
        self.fleet = OwnFleet(robots, occupancy) if robots else _simulated(world, config, occupancy)
        """The robots, the time they live in, and their maps."""
        self.clock = self.fleet.clock
        self.objects = objects or (world.object_map() if world is not None else ObjectMap())
        self.found = FoundThings()
        """What robots found besides."""
        self.rules = RuleBook(self.clock)
        """What robots may do."""
        installed = installed_actions()
        self._actions = (*actions, *installed.specs)
        self._problems = installed.problems
        self.catalogue = Catalogue(self._actions)
        self.robots: dict[str, Robot] = {}
        self.claims: dict[str, Spot] = {}
        """Where each robot was going to stand last."""
        self.stop_line: StopLine
        """Stops the robots, from any thread; there once the system is open."""
        self.store: MemoryStore | None = None
        self._journal: Journal | None = None
        self._notices: Notices | None = None
        self._early: list[str] = []
        self._stack = AsyncExitStack()

    def at_rest(self, robot: str) -> bool | None:
        """Whether a robot stands, measured now; None: it is not of this world. From any thread."""
        known = self.robots.get(robot)
        return None if known is None else is_at_rest(known)

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
    def known(self) -> ObjectMap:
        """What people may name: the object map, with what robots found."""
        return self.found.added_to(self.objects)

    @property
    def robot_names(self) -> tuple[str, ...]:
        """The robots of this world."""
        return self.fleet.names

    @property
    def simulator(self) -> Simulator:
        """The simulated world.

        Raises:
            ConfigError: The robots are real.
        """
        simulator: Simulator | None = getattr(self.fleet, "simulator", None)
        if simulator is None:
            raise ConfigError("there is no simulated world: the robots are your own")
        return simulator

    async def _open(self) -> None:
        enter = self._stack.enter_async_context
        config, transport, clock = self.config, self.transport, self.clock
        if config.data_dir is not None:
            self._stack.enter_context(held_folder(config.data_dir, unix_ms=clock.unix_ms()))
        await enter(transport)
        self.stop_line = await asyncio.to_thread(StopLine, config.stop_file, self.robot_names)
        self._stack.push_async_callback(asyncio.to_thread, self.stop_line.close)
        if isinstance(self.language, AbstractAsyncContextManager):
            await enter(self.language)
        self.found = await asyncio.to_thread(FoundThings, config.found_file)
        keeper = RuleKeeper(self.rules, config.rules_path)
        self.store = await enter(await MemoryStore.open(config.memory_file or ":memory:", clock))
        file = config.journal_file or ":memory:"
        journal = self._journal = await enter(await Journal.open(file, clock, tell=self._tell_all))
        audit = await enter(await AuditStore.open(config.audit_file or ":memory:", clock))
        await enter(AuditLog(transport, audit, clock, months=config.audit_months, tell=self._tell_all))
        await enter(self.fleet)
        await enter(MemoryNode(transport, self.store, self.language, meanings=self._meanings(self.store)))
        await enter(
            DisplayInterface(
                transport,
                clock,
                quality=config.display_quality,
                min_interval_s=config.display_interval_s,
                feeds=config.display_feeds,
            )
        )
        proposals = await enter(await ProposalStore.open(config.proposals_file or ":memory:", clock))
        planner = UmrfPlanner(
            transport,
            clock,
            approval=config.approval,
            policies=config.approval_of,
            proposals=proposals,
            tell=self._tell_for,
            objects=self._objects_of,
            judge=self._judge,
            begin_for=self.rules.act_for,
        )
        await enter(self._speaking(planner))
        rules = RuleTalk(self.rules, keeper, self.objects.areas)
        incidents = await enter(await IncidentStore.open(config.incidents_file or ":memory:", clock))
        recovery = ErrorHandler(
            transport,
            self.language,
            clock,
            objects=self._objects_of,
            max_attempts=config.max_attempts,
            language_timeout_s=config.language_timeout_s,
            incidents=incidents,
            rules=rules,
        )
        await enter(self._speaking(recovery))
        chat = ChatInterface(
            transport,
            self.language,
            clock,
            objects=self._objects_of,
            history_exchanges=config.history_exchanges,
            language_timeout_s=config.language_timeout_s,
            rules=rules,
            rooms=self.objects.rooms,
            survey=self._survey,
        )
        await enter(self._speaking(chat))
        await enter(self._speaking(Lookout(transport, clock)))
        absent = UnattendedPlans(transport, clock, config.unattended, config.unattended_after_s)
        await enter(self._speaking(absent))
        notices = self._notices = await enter(self._speaking(Notices(transport)))
        await enter(self._speaking(Calls(transport, clock, config.calls, tell=self._tell_all)))
        doubt = IN_DOUBT if self.stop_line.in_doubt else ""
        for text in (doubt, self.store.notice, incidents.notice, proposals.notice, *self._early):
            self._tell_all(text, "error")
        for rule in keeper.left_over:
            self._tell_all(left_over_rule(rule))
        await keeper.note_asked(())
        await self._open_actions(notices)
        views: Mapping[str, WorldView] = {name: self._view(name) for name in self.robot_names}
        await enter(MapService(transport, views))
        await self._listen_to_stops()
        watchdog = LoopWatchdog(self.stop_line, self.robot_names, clock, self._tell_all)
        watchdog.open()
        self._stack.push_async_callback(watchdog.close)
        floors = {name: MapOf(view.occupancy, view.objects.places) for name, view in views.items()}
        await enter(RuleNode(transport, keeper, self.rules, clock, ground=self.language.ground, maps=floors))
        engines = {name: await self._open_robot(name, views[name]) for name in self.robot_names}
        self._tell_interrupted(journal, planner, notices, engines)
        self._stack.push_async_callback((await journal.heed_plans(transport)).close)
        self._stack.push_async_callback(journal.end)
        planner.offer_again()
        told = {was.actor for was in journal.interrupted}
        for incident in recovery.left_over:
            if incident.robot in engines and incident.robot not in told:
                notices.tell(left_over_text(incident), [incident.robot])

    async def _listen_to_stops(self) -> None:
        refusals: Publisher[ros.String] = self.transport.publisher(topics.REJECTION)
        self._stack.callback(refusals.close)

        def complain(problems: Sequence[Problem]) -> None:
            told = tuple(
                RejectionProblem(path=item.path, message=item.message, remedy=item.remedy, code=item.code)
                for item in problems
            )
            refusals.publish(to_string(Rejection(source="stop_line", what=topics.STOP.name, problems=told)))

        listener = StopListener(self.stop_line, self.transport, complain)
        await listener.open()
        self._stack.push_async_callback(listener.close)

    def _speaking(self, node: N) -> N:
        """Let a node say its own sentences in the language that was chosen."""
        node.speaks = self.config.speaks
        return node

    def _meanings(self, store: MemoryStore) -> Meanings | None:
        settings = self.config.embeddings
        if settings is None:
            return None
        embedder = configured_embedder(settings)
        return Meanings(store, embedder, self.clock, tell=self._tell_all, min_alike=settings.min_alike)

    def _tell_all(self, text: str, kind: Literal["info", "error"] = "info") -> None:
        """Say something to every operator, on behalf of no robot in particular."""
        if text and self._notices is not None:
            self._notices.tell(text, self.robot_names, kind)
        elif text:
            self._early.append(text)

    def _tell_for(self, robot: str, text: str) -> None:
        """Say something on behalf of a robot, as soon as somebody is there to hear it."""
        if self._notices is not None:
            self._notices.tell(text, [robot])

    def _tell_interrupted(
        self, journal: Journal, planner: UmrfPlanner, notices: Notices, engines: Mapping[str, ActionEngine]
    ) -> None:
        """Hold what an earlier process left of each robot's plan, and offer it to the operator."""
        left = [was for was in journal.interrupted if was.actor in engines]
        newest = {was.actor: was for was in left}
        for was in left:
            robot, steps = was.actor, restored_steps(was) if newest[was.actor] is was else []
            goes_on: Sequence[Step] | bool = steps
            if steps:
                planner.restore(robot, steps)
            else:
                goes_on = _held(engines[robot], was)
            adopted = adopted_steps(was) if goes_on is True and newest[robot] is was else []
            if adopted:
                dry = was.graph.state is GraphState.HALTED
                planner.adopt(robot, was.graph.name, adopted, dry=dry)
            elif goes_on is True:
                planner.hold_graph(robot, was.graph.name)
            notices.tell(interruption_text(was, goes_on), [robot])

    async def _open_actions(self, notices: Notices) -> None:
        def tell(problem: str) -> None:
            notices.tell(f"An action cannot be used: {problem}", self.robot_names, "error")

        for problem in self._problems:
            tell(problem)
        if self.config.actions_dir is not None:
            folder = ActionFolder(self.config.actions_dir)
            live = LiveActions(self.catalogue, folder, self._actions, tell=tell)
            await self._stack.enter_async_context(live)

    async def _open_robot(self, name: str, view: WorldView) -> ActionEngine:
        self.rules.know(name, self.fleet.facts(name))
        robot = self.robots[name] = self.fleet.robot(name, self.rules)
        services = await self._stack.enter_async_context(ContextServices(name, self.transport))

        def make_context(run: RunHandle) -> ActionContext:
            return ActionContext(
                run=run,
                robot=RunRobot(robot, run.motion),
                world=view,
                memory=services,
                display=services,
                operator=services,
                language=self.language,
            )

        engine = await self._stack.enter_async_context(
            ActionEngine(
                name,
                transport=self.transport,
                catalogue=self.catalogue,
                clock=self.clock,
                make_context=make_context,
                admit=partial(self.rules.admit, name),
                robot=robot,
                journal=self._journal,
                line=self.stop_line,
            )
        )
        enter = self._stack.enter_async_context
        if "camera" in robot.capabilities:
            await enter(CameraFeed(self.transport, robot, self.config.camera_hz))
        areas = view.objects.areas
        await enter(MapViews(self.transport, robot, view.occupancy.name, self.clock, areas))
        await enter(MapFeed(self.transport, robot, view.occupancy, view.objects.objects, self.clock))
        return engine

    def _view(self, robot: str) -> WorldView:
        return WorldView(self, robot, self.fleet.occupancy(robot))

    async def _judge(
        self,
        robot: str,
        calls: Sequence[ActionCall],
        catalogue: Sequence[ActionInfo],
        pose: Pose2D | None,
        by: Principal | None,
        risks: bool,
    ) -> Judgement | None:
        """What the rules say about steps; nothing is worked out where nothing could be said."""
        if robot not in self.robots or not (risks or self.rules.has_rules):
            return None
        view, radius_m = self._view(robot), self.robots[robot].radius_m
        resolver = Resolver(
            self.language.ground, view.objects.places, view.occupancy, radius_m=radius_m, clock=self.clock
        )
        steps = await resolver.resolve(calls, catalogue, pose)
        return await judge_with_ways(
            self.rules, robot, steps, view.occupancy, by=by, pose=pose, people=view.objects.people
        )

    async def _survey(
        self,
        robot: str,
        catalogue: Sequence[ActionInfo],
        pose: Pose2D,
        pending: Sequence[ActionCall],
        tasks: Sequence[Task],
    ) -> Outlook | None:
        """What a robot of ours has before it, by ways around what is closed to it."""
        if robot not in self.robots:
            return None
        view, facts, here = self._view(robot), self.rules.facts(robot), (pose.x_m, pose.y_m)
        resolver = Resolver(
            self.language.ground,
            view.objects.places,
            view.occupancy,
            radius_m=facts.radius_m,
            clock=self.clock,
        )
        zones = [self.rules.shape(rule) for rule in self.rules.closed_to(robot, None)]
        return await survey(
            lambda calls, start: resolver.resolve(calls, catalogue, start),
            with_walls(view.occupancy, zones, here, facts.radius_m),
            pose,
            pending,
            tasks,
            radius_m=facts.radius_m,
            speed_mps=facts.speed_mps,
        )

    def _objects_of(self, _robot: str) -> Sequence[MapObject]:
        return self.known.objects


def _simulated(world: WorldFile | None, config: SystemConfig, occupancy: OccupancyMap | None) -> Fleet:
    if world is None:
        raise ConfigError("a system needs a simulated world or robots of your own")
    with needs("sim"):
        from parley.robots.simulated import SimulatedFleet
    return SimulatedFleet(world, speed=config.speed, seed=config.seed, occupancy=occupancy)


def _held(engine: ActionEngine, was: Interrupted) -> bool:
    """Whether the engine could take up what was interrupted; it stands still there."""
    try:
        engine.restore(was)
    except GraphRefusedError as error:
        log.warning("cannot be gone on with", graph=was.graph.name, reason=str(error))
        return False
    return True
