"""The action engine of one actor on a transport: it only wires (`spec/umrf.md` 11 and 12)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from contextlib import AsyncExitStack, nullcontext, suppress
from typing import Any, TypeVar

import structlog
from pydantic import BaseModel

from parley.clock import Clock
from parley.engine.events import event_fields
from parley.engine.feedback import Feedback
from parley.engine.heap import settle_heap
from parley.engine.inbox import Inbox
from parley.engine.interrupted import Interrupted
from parley.engine.journal import Journal
from parley.engine.orders import Orders
from parley.engine.presence import Presence
from parley.engine.refused import as_feedback
from parley.engine.runs import GraphRuns
from parley.engine.stop import EmergencyStop
from parley.engine.stop_listener import StopListener
from parley.engine.sync import PEER_TIMEOUT_S
from parley.engine.together import Command, Together
from parley.errors import ConfigError, GraphRefusedError, InvalidMessageError, Problem, UnavailableError
from parley.gate.book import RuleBook
from parley.gate.stop_line import StopLine
from parley.messages import ros, topics
from parley.messages.passages import PassageClaim
from parley.messages.robot import RulesInForce
from parley.messages.status import (
    ActionInfo,
    ActorStatus,
    Rejection,
    RejectionProblem,
    StepCommand,
    StopCommand,
    SyncNotice,
)
from parley.messages.topics import Topic
from parley.messages.wire import decode, to_string, to_string_unchecked
from parley.opening import OpenedTogether
from parley.robots.base import Robot
from parley.transport.base import Publisher, Subscription, Transport
from parley.umrf.action import RunHandle
from parley.umrf.catalogue import Catalogue, info_of
from parley.umrf.check import reasons
from parley.umrf.executor import STOP_TIMEOUT_S, GraphRun
from parley.umrf.io import open_graph, read_loaded, write_descriptor, write_graph
from parley.umrf.model import BUSY, NOTHING, Graph, Result
from parley.umrf.motion import Motions
from parley.umrf.node_run import NodeRun
from parley.umrf.transition import Transition

__all__ = ["ActionEngine"]

log = structlog.get_logger(__name__)

M = TypeVar(
    "M",
    ros.UmrfGraphStart,
    ros.UmrfGraphModify,
    ros.UmrfGraphPause,
    ros.UmrfGraphResume,
    ros.UmrfGraphStop,
)

Admit = Callable[[ActionInfo, Mapping[str, Any]], None]

C = TypeVar("C")
P = TypeVar("P", bound=BaseModel)

SOURCE = "action_engine"
COMMAND_DEPTH = 1000
"""Commands that may come at once; the reference loses all but one (W3)."""

TOLD_AGAIN = 3
"""So many of the newest graphs are told again to whoever comes: how they stand may not have reached them."""


class ActionEngine(OpenedTogether):
    """Carries out graphs for one actor; use with ``async with``.

    Args:
        actor: The robot's name; messages without it (or a wake word) among their targets are ignored.
        transport: Where commands come from and reports go; opened and closed by its owner.
        catalogue: What the actor can do.
        clock: Robot time for actions, wall time for stopping and reporting.
        make_context: Builds what an action gets as its first argument.
        admit: Asked before each action begins, with what it is and its inputs by flat name; if it raises an
            `ActionFailure`, the action does nothing and fails so.
        robot: What the emergency stop stops; an actor may have none.
        wake_words: Other names it listens to.
        journal: Where everything that runs is written down; opened and closed by its owner.
        heartbeat_s: Wall time between two status messages.
        stop_timeout_s: Wall time a node may take to stop.
        peer_timeout_s: Wall time to wait for the engines of other actors in one graph.
        line: The line on which it is stopped, whose owner listens to `/parley/stop`; None: one of its own.
        rules: By what `admit` and the robot's drive go; filled from what is told here, before the commands
            that are told later. None: nothing is heard.
        claim: Tells what the robot wants of places that only so many may be in.
        answers_for_all: Whether it answers `umrf_graph_get` too if no other engine does; that of TeMoto has
            no other name to answer by.
        foreign_planner: Whether it is told what to do by a planner that reads nothing but feedback: what is
            refused is told there too.
    """

    def __init__(
        self,
        actor: str,
        *,
        transport: Transport,
        catalogue: Catalogue,
        clock: Clock,
        make_context: Callable[[RunHandle], Any],
        admit: Admit | None = None,
        robot: Robot | None = None,
        wake_words: Sequence[str] = (),
        journal: Journal | None = None,
        heartbeat_s: float = 1.0,
        stop_timeout_s: float = STOP_TIMEOUT_S,
        peer_timeout_s: float = PEER_TIMEOUT_S,
        line: StopLine | None = None,
        rules: RuleBook | None = None,
        claim: Callable[[], PassageClaim | None] = lambda: None,
        answers_for_all: bool = True,
        foreign_planner: bool = False,
    ) -> None:
        super().__init__()
        self.actor = actor
        catalogue = catalogue if robot is None else catalogue.for_robot(robot.capabilities)
        self._transport, self._catalogue, self._clock = transport, catalogue, clock
        self._journal, self._rules, self._claim = journal, rules, claim
        self._robot, self._heartbeat_s = robot, heartbeat_s
        self._own_line, self._answers_for_all = line is None, answers_for_all
        self._foreign_planner = foreign_planner
        self._line = line or StopLine()
        self._motions = Motions(clock, self._ignored)
        self._make_context = make_context
        self._names = {actor, *wake_words}
        self._inbox = Inbox()
        self._publishers: dict[str, Publisher[Any]] = {}
        self.runs = GraphRuns(
            actor,
            catalogue,
            clock=clock,
            make_context=self._context_of if admit is None else _admitted(admit, self._context_of),
            observer=self._observed,
            stop_timeout_s=stop_timeout_s,
            latched=lambda: self._line.latched(actor),
        )
        self._feedback = Feedback(actor, clock, lambda message: self._publish(topics.GRAPH_FEEDBACK, message))
        self._orders = Orders()
        self._presence: Presence | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._together = Together(
            actor,
            self._names,
            self.runs,
            clock,
            publish=lambda notice: self._publish_payload(topics.SYNC, notice),
            refuse=self._reject,
            watch=self._watch_others,
            timeout_s=peer_timeout_s,
        )
        self._emergency = EmergencyStop(
            actor,
            robot,
            self.runs,
            self._motions,
            self._line,
            report=lambda report: self._publish_payload(topics.STOP_REPORT, report),
            complain=lambda problem: self._reject(topics.STOP.name, "", [problem]),
            changed=self._stop_changed,
        )

    async def _open(self, stack: AsyncExitStack) -> None:
        """Open publishers, then what publishes, then what listens; closed in the opposite order."""
        self._loop = asyncio.get_running_loop()
        stack.callback(self.runs.clear)
        for topic in (
            topics.GRAPH_FEEDBACK,
            topics.GRAPH_EVENTS,
            topics.REJECTION,
            topics.ACTOR_STATUS,
            topics.STOP_REPORT,
            topics.SYNC,
        ):
            publisher: Publisher[Any] = self._transport.publisher(topic)
            self._publishers[topic.name] = publisher
            stack.callback(publisher.close)
        self._presence = Presence(
            self.actor,
            self.runs,
            self._catalogue.infos,
            self._robot,
            lambda status: self._publish_payload(topics.ACTOR_STATUS, status),
            heartbeat_s=self._heartbeat_s,
            unix_ms=self._clock.unix_ms,
            stop=lambda: self._line.in_force(self.actor),
            holds=lambda: self._line.held_by(self.actor),
            orders=lambda: self._orders.states(self.runs.all),
            claim=self._claim,
        )
        self._presence.open()
        stack.push_async_callback(self._presence.close)
        stack.callback(self._feedback.close)
        stack.push_async_callback(self.runs.close)
        self._emergency.open()
        stack.push_async_callback(self._emergency.close)
        stack.push_async_callback(self._together.close)
        stack.callback(self._inbox.close)
        await self._serve(stack)
        settle_heap()
        await self._listen(stack)

    def _context_of(self, run: RunHandle) -> Any:
        run.motion.join(self._motions)
        return self._make_context(run)

    def _ignored(self, node: str) -> None:
        """An action lost its drive; in whichever thread it commands."""
        if self._loop is not None:
            self._loop.call_soon_threadsafe(self._emergency.ignored, node)

    def _stop_changed(self, command: StopCommand) -> None:
        if command.command == "stop":
            self._together.hold()
        self.changed()

    async def _serve(self, stack: AsyncExitStack) -> None:
        own = await self._transport.serve(topics.actor_graph_get(self.actor), self._graph_get)
        stack.push_async_callback(own.close)
        if not self._answers_for_all:
            return
        try:
            shared = await self._transport.serve(topics.GRAPH_GET, self._graph_get)
        except UnavailableError:  # another engine of this transport has it; ours is reached by its own name
            return
        stack.push_async_callback(shared.close)

    async def _listen(self, stack: AsyncExitStack) -> None:
        subscriptions: list[Subscription] = []

        async def on(topic: Topic[C], take: Callable[[C], None]) -> None:
            """Commands of all topics are taken in the order in which they came."""
            known = 0
            subscription: Subscription | None = None

            def handle(message: C) -> None:
                nonlocal known
                if subscription is not None and (lost := subscription.dropped - known) > 0:
                    known += lost
                    self._reject(topic.name, "", [_lost(lost)])
                take(message)

            along = subscriptions[0] if subscriptions else None
            subscription = await self._transport.subscribe(topic, handle, depth=COMMAND_DEPTH, along=along)
            subscriptions.append(subscription)
            stack.push_async_callback(subscription.close)

        async def on_command(topic: Topic[M], command: Command) -> None:
            def take(message: M) -> None:
                self._command(topic.name, command, message.umrf_graph_name, message.targets)

            await on(topic, take)

        if self._own_line:
            names = dict.fromkeys(self._names, self.actor)
            listener = StopListener(
                self._line,
                self._transport,
                lambda problems: self._reject(topics.STOP.name, "", problems),
                names,
            )
            await listener.open()
            stack.push_async_callback(listener.close)
        sync = await self._transport.subscribe(
            topics.SYNC, lambda message: self._payload(topics.SYNC, SyncNotice, message, self._together.take)
        )
        stack.push_async_callback(sync.close)
        if self._rules is not None:
            rules = topics.RULES_IN_FORCE
            await on(rules, lambda message: self._payload(rules, RulesInForce, message, self._hear_rules))
        await on(
            topics.GRAPH_START,
            lambda message: self._heavy_command(
                topics.GRAPH_START.name, message, message.umrf_graph_json, self._start
            ),
        )
        await on(
            topics.GRAPH_MODIFY,
            lambda message: self._heavy_command(
                topics.GRAPH_MODIFY.name, message, message.modified_graph, self._modify
            ),
        )
        for topic in (topics.GRAPH_PAUSE, topics.GRAPH_PAUSE_TEMOTO):
            await on_command(topic, "pause")
        await on_command(topics.GRAPH_RESUME, "resume")
        await on_command(topics.GRAPH_STOP, "stop")
        await on(topics.STEP, lambda message: self._payload(topics.STEP, StepCommand, message, self._on_step))

    async def _watch_others(self) -> None:
        """Listen to heartbeats from now on: who shares a graph must know who is there."""
        others = await self._transport.subscribe(
            topics.ACTOR_STATUS,
            lambda message: self._payload(topics.ACTOR_STATUS, ActorStatus, message, self._together.note),
        )
        self._stack.push_async_callback(others.close)

    # -- commands -------------------------------------------------------------------------------------------

    def _command(
        self, what: str, command: Command, name: str, targets: Sequence[str], node: str = ""
    ) -> None:
        """Carry out one command if it is for us, or say why not."""
        if not self._names.isdisjoint(targets):

            def work() -> None:
                self._told(what, name, lambda: self._together.command(command, name, targets, node))

            self._inbox.put(name, work, light=True)

    def _heavy_command(
        self, what: str, message: M, text: str, command: Callable[[M, Callable[[], Graph] | None], None]
    ) -> None:
        """As `_command`, for one that brings a graph, which may be large: `command` gets what reads it."""
        if self._names.isdisjoint(message.targets):
            return
        try:
            name, read = open_graph(text) if text else ("", None)
        except GraphRefusedError as error:
            self._reject(what, message.umrf_graph_name, error.problems)
            return
        told = message.umrf_graph_name
        self._inbox.put(name or told, lambda: self._told(what, told, lambda: command(message, read), read))

    def _told(
        self, what: str, name: str, command: Callable[[], None], read: Callable[[], Graph] | None = None
    ) -> None:
        """Carry out `command`, and say so if it is refused; `read` reads the graph that it brings."""
        try:
            command()
        except GraphRefusedError as error:
            problems = reasons(error, self._catalogue, actor=self.actor)
            self._reject(what, error.graph_name or name, problems)
            if self._foreign_planner and read is not None:
                with suppress(GraphRefusedError):  # what cannot be read has no steps
                    self._explain(what, read(), problems)

    def _explain(self, what: str, sent: Graph, problems: Sequence[Problem]) -> None:
        run = self.runs.get(sent.name)
        held = run.snapshot() if run is not None else None
        if held is not None and what == topics.GRAPH_START.name and held.state not in BUSY:
            held = None  # it is over: what was sent would have taken its place
        told = as_feedback(sent, held, problems, self._clock.unix_ms())
        if told is not None:
            history = (write_graph(told),)
            self._publish(topics.GRAPH_FEEDBACK, ros.UmrfGraphFeedback(actor=self.actor, history=history))

    def start(
        self,
        graph: Graph | str,
        parameters: Mapping[str, Any] = NOTHING,
        result: Result = Result.ON_TRUE,
    ) -> GraphRun:
        """Run a graph, or the indexed one of that name, from inside this process.

        Args:
            graph: The graph or its name.
            parameters: Inputs of its entry, by flat name.
            result: How its entry is to have ended.

        Raises:
            GraphRefusedError: It cannot run here; with every reason.
        """
        return self._together.start(graph, parameters, result)

    def restore(self, left: Interrupted) -> None:
        """Take up what a killed process left of a graph: it is PAUSED until it is resumed or stopped.

        Raises:
            GraphRefusedError: It cannot be gone on with; with every reason.
        """
        if left.saved is None:
            problem = Problem("", "others took part, and have gone on without it", "start it anew", "shared")
            raise GraphRefusedError(left.graph.name, [problem])
        self.runs.restore(left.saved)

    def beat(self) -> None:
        """Tell whoever has come, or come back, how the graphs stand and that the robot is there."""
        for run in [run for run in self.runs.all if not run.outer][-TOLD_AGAIN:]:
            self._feedback.changed(run)
        self.changed()

    def _start(self, message: ros.UmrfGraphStart, read: Callable[[], Graph] | None) -> None:
        if read is None:
            self.start(message.umrf_graph_name)
            return
        text, journal = message.umrf_graph_json, self._journal
        graph = read()
        with journal.read_from(graph.name, text) if journal else nullcontext():
            self.start(graph)

    def _modify(self, message: ros.UmrfGraphModify, read: Callable[[], Graph] | None) -> None:
        graph = read_loaded({}) if read is None else read()
        self._together.modify(graph, message.modified_graph, message.continue_from, message.targets)

    def _payload(
        self, topic: Topic[ros.String], kind: type[P], message: ros.String, take: Callable[[P], None]
    ) -> None:
        """Read what came on one of our own topics and hand it on, or say why not."""
        try:
            take(decode(kind, message.data))
        except InvalidMessageError as error:
            self._reject(topic.name, "", [Problem(error.path, error.problem, code="malformed")])
        except GraphRefusedError as error:
            self._reject(topic.name, error.graph_name, error.problems)

    def _on_step(self, command: StepCommand) -> None:
        self._command(topics.STEP.name, "end", command.graph_name, (command.target,), command.node)

    def _hear_rules(self, told: RulesInForce) -> None:
        assert self._rules is not None
        try:
            self._rules.hear(told)
        except ConfigError as error:
            problem = Problem("timezone", str(error), "install the time zones there, or name another", "zone")
            self._reject(topics.RULES_IN_FORCE.name, "", [problem])

    async def _graph_get(self, request: ros.UmrfGraphGetRequest) -> ros.UmrfGraphGetResponse:
        return ros.UmrfGraphGetResponse(
            umrf_jsons=tuple(write_descriptor(spec) for spec in self._catalogue),
            graph_jsons_indexed=tuple(write_graph(graph) for graph in self._catalogue.graphs),
            graph_jsons_running=tuple(write_graph(run.snapshot()) for run in self.runs.all),
        )

    # -- reports --------------------------------------------------------------------------------------------

    def _observed(self, run: GraphRun, transition: Transition) -> None:
        if self._journal is not None:
            self._journal.record(run, transition)
        event = event_fields(self.actor, run.name, transition)
        self._publish(topics.GRAPH_EVENTS, to_string_unchecked(event))
        if transition.kind != "progress":
            self._feedback.changed(run)
        if self._orders.note(run, transition) or transition.kind == "graph":
            self.changed()

    def changed(self) -> None:
        """Its status is different now: tell it at once."""
        if self._presence is not None:
            self._presence.changed()

    def _reject(self, what: str, graph_name: str, problems: Sequence[Problem]) -> None:
        log.warning("refused", actor=self.actor, what=what, graph=graph_name, problems=[*map(str, problems)])
        self._publish_payload(
            topics.REJECTION,
            Rejection(
                source=SOURCE,
                target=self.actor,
                what=what,
                graph_name=graph_name,
                problems=tuple(
                    RejectionProblem(path=item.path, message=item.message, remedy=item.remedy, code=item.code)
                    for item in problems
                ),
            ),
        )

    def _publish_payload(self, topic: Topic[ros.String], payload: BaseModel) -> None:
        self._publish(topic, to_string(payload))

    def _publish(self, topic: Topic[Any], message: Any) -> None:
        publisher = self._publishers.get(topic.name)
        if publisher is not None:
            publisher.publish(message)


def _admitted(admit: Admit, make_context: Callable[[RunHandle], Any]) -> Callable[[RunHandle], Any]:
    """Ask before an action gets what it needs to do anything."""

    def make(run: RunHandle) -> Any:
        if isinstance(run, NodeRun):
            admit(info_of(run.spec), run.values)
        return make_context(run)

    return make


def _lost(count: int) -> Problem:
    return Problem(
        "",
        f"{count} commands were lost: more than {COMMAND_DEPTH} came at once",
        "send them again, fewer at a time",
        "commands_lost",
    )
