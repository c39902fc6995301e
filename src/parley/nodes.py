"""All that understands, plans, remembers and explains: the nodes, in one process; robots may be in others.

Between these and `Engines` there is nothing but topics and services.
"""

from __future__ import annotations

import asyncio
from collections.abc import Collection, Sequence
from contextlib import AsyncExitStack
from typing import Final, Literal, TypeVar, get_args

from parley.agents.audit_log import AuditLog
from parley.agents.base import Node
from parley.agents.batteries import Batteries
from parley.agents.calls.calls import Calls
from parley.agents.chat.chat_interface import ChatInterface
from parley.agents.display.display_interface import DisplayInterface
from parley.agents.display.map_service import MapService
from parley.agents.memory import MemoryNode
from parley.agents.notices import Notices
from parley.agents.passages import Passages
from parley.agents.places import Places
from parley.agents.planner.umrf_planner import UmrfPlanner
from parley.agents.planner.unattended import UnattendedPlans
from parley.agents.recovery.error_handler import ErrorHandler
from parley.agents.recovery.repair import left_over_text
from parley.agents.rules.lookout import Lookout
from parley.agents.rules.rules import RuleNode
from parley.agents.sites import Sites
from parley.agents.temoto import TemotoActors
from parley.clock import Clock
from parley.config import SystemConfig
from parley.gate.audit_store import AuditStore
from parley.gate.book import RuleBook
from parley.gate.judge import Judgement, RobotFacts
from parley.gate.places import Resolver
from parley.gate.rule_talk import RuleTalk, left_over_rule
from parley.gate.rules import RuleKeeper
from parley.gate.ways import judge_with_ways, with_walls
from parley.language.base import Language
from parley.memory.embedder import configured_embedder
from parley.memory.incidents import IncidentStore
from parley.memory.meanings import Meanings
from parley.memory.missions import MissionStore
from parley.memory.proposals import ProposalStore
from parley.memory.store import MemoryStore
from parley.messages.chat import ActionCall
from parley.messages.incident import Incident
from parley.messages.principal import Principal
from parley.messages.status import ActionInfo
from parley.opening import OpenedTogether
from parley.team.outlook import Outlook, Task, survey
from parley.transport.base import Transport
from parley.world.geometry import Pose2D
from parley.world.telling import Surroundings

__all__ = ["NODES", "NodeName", "Nodes"]

NodeName = Literal["chat_interface", "umrf_planner", "error_handler", "memory", "display_interface"]
"""As the thesis calls them."""

NODES: Final[tuple[NodeName, ...]] = get_args(NodeName)

N = TypeVar("N", bound=Node)

MET_WITHIN_S: Final = 30.0


class Nodes(OpenedTogether):
    """The nodes. Use as ``async with``, while the transport and the language engine are open.

    Args:
        transport: Where robots and people are.
        config: The settings.
        language: Understands people.
        clock: The robots' time, or that on the wall where they are in another process.
        robots: The names of robots that are known to come.
        only: Which of them; the others are in other processes. Rules, the log and calls go with the planner.
    """

    def __init__(
        self,
        transport: Transport,
        config: SystemConfig,
        *,
        language: Language,
        clock: Clock,
        robots: Sequence[str] = (),
        only: Collection[NodeName] = NODES,
    ) -> None:
        super().__init__()
        self._only = frozenset(only)
        self._transport, self._config, self._clock = transport, config, clock
        self._language, self._robots = language, tuple(robots)
        self.rules = RuleBook(clock)
        """What robots may do."""
        self.sites = Sites(transport, self._on_site)
        self.store: MemoryStore | None = None
        self._notices = Notices(transport)
        self._planner: UmrfPlanner | None = None
        self._incidents: list[Incident] = []

    def tell(self, text: str, kind: Literal["info", "error"] = "info") -> None:
        """Say something to every operator, on behalf of no robot in particular, as soon as one is there."""
        if text:
            self._notices.tell(text, self._robots or self._everybody, kind)

    @property
    def _everybody(self) -> tuple[str, ...]:
        return tuple(sorted(self.sites.by_robot))

    async def met(self, robots: Sequence[str]) -> None:
        """Wait until these robots are known, with all that they had not brought to an end.

        Raises:
            TimeoutError: One does not come.
        """
        if self._planner is None:
            return
        async with asyncio.timeout(MET_WITHIN_S):
            for robot in robots:
                await self.sites.of(robot)
                await self._planner.met(robot)

    async def _open(self, stack: AsyncExitStack) -> None:
        enter, config, only = stack.enter_async_context, self._config, self._only
        await enter(self.sites)
        if "memory" in only:
            store = self.store = await enter(
                await MemoryStore.open(config.memory_file or ":memory:", self._clock)
            )
            await enter(MemoryNode(self._transport, store, self._language, meanings=self._meanings(store)))
        if "display_interface" in only:
            display = DisplayInterface(
                self._transport,
                self._clock,
                quality=config.display_quality,
                min_interval_s=config.display_interval_s,
                feeds=config.display_feeds,
            )
            await enter(display)
            await enter(MapService(self._transport, self.sites.by_robot))
        if "umrf_planner" in only:
            await self._open_planner(stack)
        else:
            await self._open_talk(stack, None)

    async def _open_planner(self, stack: AsyncExitStack) -> None:
        """The planner with all that goes with plans, and who talks, if that is in this process too."""
        enter, config, transport, clock = (
            stack.enter_async_context,
            self._config,
            self._transport,
            self._clock,
        )
        keeper = RuleKeeper(self.rules, config.rules_path)
        audit = await enter(await AuditStore.open(config.audit_file or ":memory:", clock))
        await enter(AuditLog(transport, audit, clock, months=config.audit_months, tell=self.tell))
        proposals = await enter(await ProposalStore.open(config.proposals_file or ":memory:", clock))
        planner = self._planner = UmrfPlanner(
            transport,
            clock,
            approval=config.approval,
            policies=config.approval_of,
            proposals=proposals,
            tell=self._tell_for,
            objects=self.sites.objects,
            judge=self._judge,
            begin_for=self.rules.act_for,
            met=self._on_met,
        )
        incidents = await self._open_talk(stack, RuleTalk(self.rules, keeper, self.sites.areas))
        # Only now: whoever is told a plan may answer at once, and has to be heard.
        await enter(self._speaking(planner))
        if config.temoto:
            await enter(TemotoActors(transport, clock, config.temoto))
        await enter(self._speaking(Lookout(transport, clock)))
        await enter(Passages(transport, clock))
        await enter(Batteries(transport, self._tell_for))
        absent = UnattendedPlans(transport, clock, config.unattended, config.unattended_after_s)
        await enter(self._speaking(absent))
        await enter(self._speaking(self._notices))
        await enter(self._speaking(Calls(transport, clock, config.calls, tell=self.tell)))
        for told in (self.store, incidents, proposals):
            self.tell(told.notice if told is not None else "", "error")
        for rule in keeper.left_over:
            self.tell(left_over_rule(rule))
        await keeper.note_asked(())
        ground, maps = self._language.ground, self.sites.by_robot
        await enter(RuleNode(transport, keeper, self.rules, clock, ground=ground, maps=maps))
        await enter(Places(transport, maps, self.rules, clock, config.places_file))
        planner.offer_again()

    async def _open_talk(self, stack: AsyncExitStack, rules: RuleTalk | None) -> IncidentStore | None:
        """Who talks to people.

        Args:
            stack: Where it is opened.
            rules: Hears what is said about rules; None: that is in another process, and set there.
        """
        config, enter = self._config, stack.enter_async_context
        incidents: IncidentStore | None = None
        if "error_handler" in self._only:
            incidents = await enter(
                await IncidentStore.open(config.incidents_file or ":memory:", self._clock)
            )
            recovery = ErrorHandler(
                self._transport,
                self._language,
                self._clock,
                objects=self.sites.objects,
                max_attempts=config.max_attempts,
                language_timeout_s=config.language_timeout_s,
                incidents=incidents,
                rules=rules,
            )
            await enter(self._speaking(recovery))
            self._incidents = list(recovery.left_over)
        if "chat_interface" in self._only:
            missions = await enter(await MissionStore.open(config.missions_file or ":memory:", self._clock))
            chat = ChatInterface(
                self._transport,
                self._language,
                self._clock,
                objects=self.sites.objects,
                history_exchanges=config.history_exchanges,
                language_timeout_s=config.language_timeout_s,
                rules=rules,
                rooms=self.sites.rooms,
                soon=self.sites.soon,
                survey=self._survey,
                missions=missions,
            )
            await enter(self._speaking(chat))
        return incidents

    def _speaking(self, node: N) -> N:
        """Let a node say its own sentences in the language that was chosen."""
        node.speaks = self._config.speaks
        return node

    def _meanings(self, store: MemoryStore) -> Meanings | None:
        settings = self._config.embeddings
        if settings is None:
            return None
        embedder = configured_embedder(settings)
        return Meanings(store, embedder, self._clock, tell=self.tell, min_alike=settings.min_alike)

    def _tell_for(self, robot: str, text: str, asks_yes: bool = False) -> None:
        """Say something on behalf of a robot, as soon as somebody is there to hear it."""
        self._notices.tell(text, [robot], asks_yes=asks_yes)

    def _on_met(self, robot: str, told: bool) -> None:
        """Say which repairs an earlier process left open, unless what it did is told already."""
        mine = [incident for incident in self._incidents if incident.robot == robot]
        self._incidents = [incident for incident in self._incidents if incident.robot != robot]
        for incident in () if told else mine:
            self._tell_for(robot, left_over_text(incident))

    def _on_site(self, robot: str, known: Surroundings) -> None:
        self.rules.know(robot, RobotFacts(known.occupancy.name, known.radius_m, known.max_speed_mps))

    def _resolver(self, known: Surroundings) -> Resolver:
        return Resolver(
            self._language.ground,
            known.objects.places,
            known.occupancy,
            radius_m=known.radius_m,
            clock=self._clock,
        )

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
        if not (risks or self.rules.has_rules):
            return None
        known = await self.sites.known(robot)
        if known is None:
            return None
        steps = await self._resolver(known).resolve(calls, catalogue, pose)
        return await judge_with_ways(
            self.rules, robot, steps, known.occupancy, by=by, pose=pose, people=known.objects.people
        )

    async def _survey(
        self,
        robot: str,
        catalogue: Sequence[ActionInfo],
        pose: Pose2D,
        pending: Sequence[ActionCall],
        tasks: Sequence[Task],
    ) -> Outlook | None:
        """What a robot has before it, by ways around what is closed to it; None: it has not told its map."""
        known = self.sites.by_robot.get(robot)
        if known is None:
            return None
        resolver = self._resolver(known)
        zones = [self.rules.shape(rule) for rule in self.rules.closed_to(robot, None)]
        return await survey(
            lambda calls, start: resolver.resolve(calls, catalogue, start),
            with_walls(known.occupancy, zones, (pose.x_m, pose.y_m), known.radius_m),
            pose,
            pending,
            tasks,
            radius_m=known.radius_m,
            speed_mps=known.max_speed_mps,
        )
