"""The action engine of one actor on a transport: it only wires (`spec/umrf.md` 11 and 12)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AsyncExitStack
from types import TracebackType
from typing import Any, Self, TypeVar

import structlog
from pydantic import BaseModel

from parley.clock import Clock
from parley.engine.feedback import Feedback
from parley.engine.presence import Presence
from parley.engine.runs import GraphRuns
from parley.engine.stop import EmergencyStop
from parley.errors import GraphRefusedError, InvalidMessageError, Problem, UnavailableError
from parley.messages import ros, topics
from parley.messages.status import GraphEvent, Rejection, RejectionProblem, StepCommand, StopCommand
from parley.messages.topics import Topic
from parley.messages.wire import decode, to_string
from parley.robots.base import Robot
from parley.transport.base import Publisher, Transport
from parley.umrf.action import RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import STOP_TIMEOUT_S, GraphRun
from parley.umrf.io import read_graph, write_descriptor, write_graph
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

SOURCE = "action_engine"


class ActionEngine:
    """Carries out graphs for one actor; use with ``async with``.

    Args:
        actor: The robot's name; messages without it (or a wake word) among their targets are ignored.
        transport: Where commands come from and reports go; opened and closed by its owner.
        catalogue: What the actor can do.
        clock: Robot time for actions, wall time for stopping and reporting.
        make_context: Builds what an action gets as its first argument.
        robot: What the emergency stop stops; an actor may have none.
        wake_words: Other names it listens to.
        heartbeat_s: Wall time between two status messages.
        stop_timeout_s: Wall time a node may take to stop.
    """

    def __init__(
        self,
        actor: str,
        *,
        transport: Transport,
        catalogue: Catalogue,
        clock: Clock,
        make_context: Callable[[RunHandle], Any],
        robot: Robot | None = None,
        wake_words: Sequence[str] = (),
        heartbeat_s: float = 1.0,
        stop_timeout_s: float = STOP_TIMEOUT_S,
    ) -> None:
        self.actor = actor
        self._transport, self._catalogue, self._clock = transport, catalogue, clock
        self._robot, self._heartbeat_s = robot, heartbeat_s
        self._names = {actor, *wake_words}
        self._stack = AsyncExitStack()
        self._publishers: dict[str, Publisher[Any]] = {}
        self.runs = GraphRuns(
            actor,
            catalogue,
            clock=clock,
            make_context=make_context,
            observer=self._observed,
            stop_timeout_s=stop_timeout_s,
        )
        self._feedback = Feedback(actor, clock, lambda message: self._publish(topics.GRAPH_FEEDBACK, message))
        self._presence: Presence | None = None
        self._emergency = EmergencyStop(
            actor,
            robot,
            self.runs,
            report=lambda report: self._publish_payload(topics.STOP_REPORT, report),
            complain=lambda problem: self._reject(topics.STOP.name, "", [problem]),
        )

    async def __aenter__(self) -> Self:
        async with AsyncExitStack() as stack:  # closes what was opened if a later step fails
            await self._open(stack)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()

    async def _open(self, stack: AsyncExitStack) -> None:
        """Open publishers, then what publishes, then what listens; closed in the opposite order."""
        for topic in (
            topics.GRAPH_FEEDBACK,
            topics.GRAPH_EVENTS,
            topics.REJECTION,
            topics.ACTOR_STATUS,
            topics.STOP_REPORT,
        ):
            publisher: Publisher[Any] = self._transport.publisher(topic)
            self._publishers[topic.name] = publisher
            stack.callback(publisher.close)
        self._presence = Presence(
            self.actor,
            self.runs,
            self._catalogue.infos(),
            self._robot,
            lambda status: self._publish_payload(topics.ACTOR_STATUS, status),
            heartbeat_s=self._heartbeat_s,
        )
        self._presence.open()
        stack.push_async_callback(self._presence.close)
        stack.callback(self._feedback.close)
        stack.push_async_callback(self.runs.close)
        stack.push_async_callback(self._emergency.close)
        await self._serve(stack)
        await self._listen(stack)

    async def _serve(self, stack: AsyncExitStack) -> None:
        own = await self._transport.serve(topics.actor_graph_get(self.actor), self._graph_get)
        stack.push_async_callback(own.close)
        try:
            shared = await self._transport.serve(topics.GRAPH_GET, self._graph_get)
        except UnavailableError:  # another engine of this transport has it; ours is reached by its own name
            return
        stack.push_async_callback(shared.close)

    async def _listen(self, stack: AsyncExitStack) -> None:
        async def on(topic: Topic[M], command: Callable[[M], None]) -> None:
            subscription = await self._transport.subscribe(
                topic, lambda message: self._command(topic.name, message, command)
            )
            stack.push_async_callback(subscription.close)

        emergency = await self._transport.subscribe(topics.STOP, self._on_emergency)
        stack.push_async_callback(emergency.close)
        step = await self._transport.subscribe(topics.STEP, self._on_step)
        stack.push_async_callback(step.close)
        await on(topics.GRAPH_START, self._start)
        await on(topics.GRAPH_MODIFY, self._modify)
        await on(topics.GRAPH_PAUSE, self._pause)
        await on(topics.GRAPH_PAUSE_TEMOTO, self._pause)
        await on(topics.GRAPH_RESUME, lambda message: self.runs.resume(message.umrf_graph_name))
        await on(topics.GRAPH_STOP, lambda message: self.runs.stop(message.umrf_graph_name))

    # -- commands -------------------------------------------------------------------------------------------

    def _command(self, what: str, message: M, command: Callable[[M], None]) -> None:
        """Carry out one command for us, or say why not."""
        if self._names.isdisjoint(message.targets):
            return
        try:
            command(message)
        except GraphRefusedError as error:
            self._reject(what, error.graph_name or message.umrf_graph_name, error.problems)

    def _start(self, message: ros.UmrfGraphStart) -> None:
        if not message.umrf_graph_json:
            name = message.umrf_graph_name
            raise GraphRefusedError(
                name,
                [
                    Problem(
                        "umrf_graph_name",
                        f"there is no indexed graph {name!r}",
                        "send the graph itself as umrf_graph_json",
                        "unknown_graph",
                    )
                ],
            )
        self.runs.start(read_graph(message.umrf_graph_json))

    def _modify(self, message: ros.UmrfGraphModify) -> None:
        self.runs.modify(read_graph(message.modified_graph), message.continue_from)

    def _pause(self, message: ros.UmrfGraphPause) -> None:
        self.runs.pause(message.umrf_graph_name)

    def _on_step(self, message: ros.String) -> None:
        try:
            command = decode(StepCommand, message.data)
            if command.target in self._names:
                self.runs.end_node(command.graph_name, command.node)
        except InvalidMessageError as error:
            self._reject(topics.STEP.name, "", [Problem(error.path, error.problem, code="malformed")])
        except GraphRefusedError as error:
            self._reject(topics.STEP.name, error.graph_name, error.problems)

    async def _on_emergency(self, message: ros.String) -> None:
        try:
            command = decode(StopCommand, message.data)
        except InvalidMessageError as error:
            self._reject(topics.STOP.name, "", [Problem(error.path, error.problem, code="malformed")])
            return
        if command.targets and self._names.isdisjoint(command.targets):
            return
        if command.command == "stop":
            await self._emergency.stop(command.id)
        else:
            self._emergency.reset(command.id)
        self._status_changed()

    async def _graph_get(self, request: ros.UmrfGraphGetRequest) -> ros.UmrfGraphGetResponse:
        return ros.UmrfGraphGetResponse(
            umrf_jsons=tuple(write_descriptor(spec) for spec in self._catalogue),
            graph_jsons_running=tuple(write_graph(run.snapshot()) for run in self.runs.all),
        )

    # -- reports --------------------------------------------------------------------------------------------

    def _observed(self, run: GraphRun, transition: Transition) -> None:
        event = GraphEvent(
            actor=self.actor,
            graph_name=run.name,
            sequence=transition.sequence,
            kind=transition.kind,
            state=transition.state,
            node=transition.node,
            instance_id=transition.instance_id,
            cause=transition.cause,
            result=transition.result.value if transition.result is not None else "",
            outputs=dict(transition.outputs),
            message=transition.message,
            progress=transition.progress,
            progress_text=transition.progress_text,
            robot_time_s=transition.robot_time_s,
            unix_ms=transition.unix_ms,
        )
        self._publish_payload(topics.GRAPH_EVENTS, event)
        if transition.kind != "progress":
            self._feedback.changed(run)
        if transition.kind == "graph":
            self._status_changed()

    def _status_changed(self) -> None:
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
