"""Robots with an engine each, in this process: what carries plans out, whoever makes them and wherever.

Between these and `Nodes` there is nothing but topics and services.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
from collections.abc import Sequence
from contextlib import AsyncExitStack
from dataclasses import dataclass
from functools import partial
from typing import Final, Literal

import structlog

from parley.actions.context import ActionContext
from parley.agents.display.camera_feed import CameraFeed
from parley.agents.display.map_feed import MapFeed, MapViews
from parley.agents.mates import Mates
from parley.agents.notices import Notifier
from parley.config import SystemConfig
from parley.engine.engine import ActionEngine
from parley.engine.hearing import Hearing
from parley.engine.journal import Journal
from parley.engine.presence import is_at_rest
from parley.engine.services import ContextServices
from parley.engine.unfinished import Unfinished
from parley.engine.watchdog import LoopWatchdog
from parley.errors import ActionFailure, FileFormatError, InvalidMessageError
from parley.gate.book import RuleBook
from parley.gate.rules import RuleKeeper
from parley.gate.stop_line import StopLine
from parley.language.base import Language
from parley.messages import ros, topics
from parley.messages.map import PlacesKept
from parley.messages.passages import PassageList
from parley.messages.robot import RobotSite
from parley.messages.rules import RuleSet
from parley.messages.wire import decode, to_string
from parley.opening import OpenedTogether
from parley.robots.base import Robot
from parley.robots.fleet import Fleet
from parley.robots.run_robot import RunRobot
from parley.robots.turn import Turn
from parley.transport.base import Transport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.discovery import ActionFolder, LiveActions, installed_actions
from parley.world.approach import Spot
from parley.world.found import FoundThings, reaching_floor
from parley.world.geometry import Pose2D
from parley.world.object_map import PLACE, MapObject, ObjectMap
from parley.world.occupancy import NO_MAP, OccupancyMap
from parley.world.placed import Placed, names_of
from parley.world.telling import floor_of, told_objects
from parley.world.whereabouts import Footprint

__all__ = ["Engines", "WorldView"]

GREETS_AFTER_S: Final = 0.2
_NOTHING: Final = Placed()
_ON_IT_M: Final = 0.3
"""What is seen no farther than that from something on the map, where no floor is, stands in or on it."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class WorldView:
    """What one robot knows about its surroundings."""

    engines: Engines
    robot: str
    occupancy: OccupancyMap

    @property
    def objects(self) -> ObjectMap:
        """The objects people may name, with what they put there and what was found."""
        return self.engines.known_on(self.occupancy.name)

    @property
    def taken(self) -> tuple[Spot, ...]:
        """See `parley.actions.context.World.taken`."""
        others = [robot for name, robot in self.engines.robots.items() if name != self.robot]
        return (*(spot for robot in others for spot in _standing(robot)), *self._claimed)

    @property
    def _claimed(self) -> tuple[Spot, ...]:
        return tuple(spot for name, spot in self.engines.claims.items() if name != self.robot)

    def claim(self, spot: Pose2D) -> bool:
        """See `parley.actions.context.World.claim`."""
        own = (spot.x_m, spot.y_m, self.engines.robots[self.robot].radius_m)
        self.engines.claims[self.robot] = own
        return all(math.dist(own[:2], other[:2]) > own[2] + other[2] for other in self._claimed)

    async def note(self, label: str, place: Footprint) -> MapObject | None:
        """See `parley.actions.context.World.note`."""
        before = self.engines.placed_on(self.occupancy.name).applied(self.engines.objects)
        # What no floor is on the map may be furniture that has no name there yet: a new map has none at all.
        if self.occupancy is not NO_MAP and not self.occupancy.is_free(place.x_m, place.y_m):
            near = (item for item in before.objects if item.gap_m(place.x_m, place.y_m) <= _ON_IT_M)
            if any(item.class_name != PLACE and label not in names_of(item) for item in near):
                return None
            with contextlib.suppress(ActionFailure):  # where it was seen from may not be known just now
                place = reaching_floor(place, self.occupancy, self.engines.robots[self.robot].pose())
        thing = await self.engines.found.note(label, place, before)
        self.engines.tell_sites()
        return thing

    async def forget(self, thing: MapObject) -> None:
        """See `parley.actions.context.World.forget`."""
        await self.engines.found.forget(thing)
        self.engines.tell_sites()


class Engines(OpenedTogether):
    """The engines of a fleet. Use as ``async with``, while the transport and the stop line are open.

    Args:
        transport: Where plans come from and reports go.
        config: The settings.
        fleet: The robots.
        objects: The object map.
        language: Finds what words of a plan mean.
        line: Stops the robots.
        actions: What the robots can do, besides what is installed.
        only: The names of those robots of the fleet that are carried out here; empty: all.
    """

    def __init__(
        self,
        transport: Transport,
        config: SystemConfig,
        fleet: Fleet,
        *,
        objects: ObjectMap,
        language: Language,
        line: StopLine,
        actions: Sequence[ActionSpec],
        only: Sequence[str] = (),
    ) -> None:
        super().__init__()
        self._transport, self._config, self._fleet = transport, config, fleet
        self.objects, self._language, self._line = objects, language, line
        installed = installed_actions()
        self._actions = (*actions, *installed.specs)
        self._problems = installed.problems
        self.catalogue = Catalogue(self._actions)
        self.names = tuple(name for name in fleet.names if not only or name in only)
        """The robots."""
        self.robots: dict[str, Robot] = {}
        self.claims: dict[str, Spot] = {}
        """Where each robot was going to stand last."""
        self.found = FoundThings()
        """What robots found besides."""
        self.journal: Journal | None = None
        """What they do is written down in; there once it is open."""
        self._placed: dict[str, Placed] = {}
        self._sites: dict[str, tuple[RobotSite, topics.Topic[ros.String]]] = {}
        self._engines: list[ActionEngine] = []
        self._heard_by = 0
        """How many in other processes listen to heartbeats."""
        self._greeting: asyncio.TimerHandle | None = None
        self._notifier = Notifier(transport)

    @property
    def known(self) -> ObjectMap:
        """What people may name where the first robot is: see `known_on`."""
        return self.known_on(next((site.floor.name for site, _ in self._sites.values() if site.floor), ""))

    def known_on(self, map_name: str) -> ObjectMap:
        """The object map, with what people put on that map and what robots found."""
        placed = self.placed_on(map_name)
        return placed.applied(self.found.added_to(placed.applied(self.objects)))

    def placed_on(self, map_name: str) -> Placed:
        """What people put on a map."""
        return self._placed.get(map_name, _NOTHING)

    def occupancy(self, robot: str) -> OccupancyMap:
        """The floor a robot drives by."""
        return self._fleet.occupancy(robot)

    def at_rest(self, robot: str) -> bool | None:
        """Whether a robot stands, measured now; None: it is not of these. From any thread."""
        known = self.robots.get(robot)
        return None if known is None else is_at_rest(known)

    def tell(self, text: str, kind: Literal["info", "error"] = "info") -> None:
        """Say something to every operator, as soon as one is there."""
        if text:
            self._notifier.tell(text, self.names, kind)

    def tell_sites(self) -> None:
        """Tell where the robots are and what is known to be there."""
        for site, topic in self._sites.values():
            objects = told_objects(self.known_on(site.floor.name if site.floor else ""))
            self._notifier.send(topic, to_string(site.model_copy(update={"objects": objects})))

    def _on_places(self, message: ros.String) -> None:
        """People put something on a map."""
        try:
            kept = decode(PlacesKept, message.data)
            self._placed = {name: Placed.of_json(told) for name, told in kept.maps.items()}
        except (InvalidMessageError, FileFormatError) as error:
            log.warning("unreadable places", error=str(error))
            return
        self.tell_sites()

    async def _open(self, stack: AsyncExitStack) -> None:
        enter, config, clock = stack.enter_async_context, self._config, self._fleet.clock
        self._notifier.speaks = config.speaks
        await enter(self._notifier)
        self.found = await asyncio.to_thread(FoundThings, config.found_file)
        file = config.journal_file or ":memory:"
        journal = self.journal = await enter(await Journal.open(file, clock, tell=self.tell))
        unfinished = {
            name: Unfinished(name, [was for was in journal.interrupted if was.actor == name])
            for name in self.names
        }
        for claim in unfinished.values():  # before a robot is touched: another engine may drive it
            stack.push_async_callback(claim.close)
            await claim.open(self._transport)
        await enter(self._fleet)
        for problem in self._problems:
            self._tell_unusable(problem)
        if config.actions_dir is not None:
            folder = ActionFolder(config.actions_dir)
            live = LiveActions(self.catalogue, folder, self._actions, tell=self._tell_unusable)
            await enter(live)
        mates = await enter(Mates(self._transport, clock))
        watchdog = LoopWatchdog(self._line, self.names, clock, self.tell)
        watchdog.open()
        stack.push_async_callback(watchdog.close)
        hearing = Hearing(self._line, self.names, self._transport, clock, self.tell)
        await hearing.open()
        stack.push_async_callback(hearing.close)
        for name in self.names:
            self._describe(name)
        heard = await self._transport.subscribe(topics.PLACES_KEPT, self._on_places, depth=1)
        stack.push_async_callback(heard.close)
        self.tell_sites()
        stack.push_async_callback((await journal.heed_plans(self._transport)).close)
        for name in self.names:
            await self._open_robot(stack, name, journal, mates, unfinished[name])
        stack.push_async_callback(journal.end)
        stack.callback(self._engines.clear)
        stack.callback(self._transport.on_endpoints_changed(self._greet))

    def _greet(self) -> None:
        """Whoever comes need not wait for a heartbeat to know who is there."""
        name = topics.ACTOR_STATUS.name
        ends = self._transport.endpoints()
        before, self._heard_by = (
            self._heard_by,
            sum(end.elsewhere and end.role == "subscription" and end.name == name for end in ends),
        )
        if self._heard_by > before:  # they come one by one, and the last one is to hear it too
            if self._greeting is not None:
                self._greeting.cancel()
            self._greeting = asyncio.get_running_loop().call_later(GREETS_AFTER_S, self._beat)

    def _beat(self) -> None:
        self._greeting = None
        for engine in self._engines:
            engine.beat()

    def _tell_unusable(self, problem: str) -> None:
        self.tell(f"An action cannot be used: {problem}", "error")

    def _first_rules(self) -> RuleBook:
        """Those that hold until whoever plans tells its own."""
        rules = RuleBook.unread(self._fleet.clock)
        if self._config.foreign_planner:
            RuleKeeper(rules, self._config.rules_path)
            if not rules.in_force:
                rules.replace(RuleSet())
        return rules

    def _describe(self, name: str) -> None:
        facts, occupancy = self._fleet.facts(name), self._fleet.occupancy(name)
        same = (
            site.floor for site, _ in self._sites.values() if site.floor and site.floor.name == occupancy.name
        )
        site = RobotSite(
            actor=name,
            floor=next(same, None) or floor_of(occupancy),
            radius_m=facts.radius_m,
            max_speed_mps=facts.speed_mps,
        )
        self._sites[name] = (site, topics.actor_site(name))

    async def _open_robot(
        self, stack: AsyncExitStack, name: str, journal: Journal, mates: Mates, unfinished: Unfinished
    ) -> None:
        enter, transport, clock = stack.enter_async_context, self._transport, self._fleet.clock
        view = WorldView(self, name, self._fleet.occupancy(name))
        rules = self._first_rules()
        rules.know(name, self._fleet.facts(name))
        robot = self.robots[name] = self._fleet.robot(name, rules)
        services = await enter(ContextServices(name, transport))
        turn = Turn(robot, lambda: view.objects.areas, clock)
        hears = await transport.subscribe(topics.PASSAGES, partial(_hear, turn))
        stack.push_async_callback(hears.close)

        def make_context(run: RunHandle) -> ActionContext:
            return ActionContext(
                run=run,
                robot=RunRobot(robot, run.motion, turn, services),
                world=view,
                memory=services,
                display=services,
                operator=services,
                language=self._language,
                mates=mates,
            )

        engine = await enter(
            ActionEngine(
                name,
                transport=transport,
                catalogue=self.catalogue,
                clock=clock,
                make_context=make_context,
                admit=partial(rules.admit, name),
                robot=robot,
                journal=journal,
                line=self._line,
                rules=rules,
                claim=turn.claim,
                answers_for_all=not self._config.temoto,
                foreign_planner=self._config.foreign_planner,
            )
        )
        turn.changed = engine.changed
        unfinished.take_up(engine)
        self._engines.append(engine)
        if "camera" in robot.capabilities:
            await enter(CameraFeed(transport, robot, self._config.camera_hz))
        await enter(MapViews(transport, robot, view.occupancy.name, clock, lambda: view.objects))
        await enter(MapFeed(transport, robot, view.occupancy, lambda: view.objects.objects, clock))


def _hear(turn: Turn, message: ros.String) -> None:
    with contextlib.suppress(InvalidMessageError):  # what makes no sense gives no place to anybody
        turn.hear(decode(PassageList, message.data))


def _standing(robot: Robot) -> tuple[Spot, ...]:
    """Where a robot stands, if it knows."""
    try:
        pose = robot.pose()
    except ActionFailure:
        return ()
    return ((pose.x_m, pose.y_m, robot.radius_m),)
