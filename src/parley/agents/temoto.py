"""Robots whose engine is TeMoto's: it says little of itself, so this says it, as engines of ours do.

It has no heartbeat, refuses in silence and loses part of its feedback; but it can be asked. So this asks, and
tells who is there, what it can do, how its graphs stand, and which graph it did not take.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Final

from parley.agents.base import Node
from parley.agents.presence import LOST_AFTER_S, STARVED_AFTER_S
from parley.clock import Clock
from parley.errors import GraphRefusedError, TransportError
from parley.messages import ros, topics
from parley.messages.status import (
    NOT_TAKEN,
    ActionInfo,
    ActorStatus,
    Rejection,
    RejectionProblem,
    StopCommand,
    Trouble,
)
from parley.messages.topics import Service, Topic
from parley.transport.base import Transport, absolute
from parley.umrf.catalogue import info_of
from parley.umrf.io import read_descriptor, read_graph
from parley.umrf.model import ENDED, Graph, GraphState

__all__ = ["TemotoActors"]

BEAT_S: Final = 1.0
LOOK_S: Final = 0.25
ASK_S: Final = 1.0
"""How often an engine is asked: of one that was killed, DDS alone would tell only after up to 20 s."""
ANSWER_S: Final = 2.0
SILENT_S: Final = 2.0
"""After such a silence it counts as silent, and people are told."""
ENDS_S: Final = 6.0
"""The same after a command: it answers nothing while it brings an action to its end, which may take 5 s."""
TAKES_S: Final = 1.5
"""It tells what changed every half second; after such a silence it is asked."""
APART_S: Final = 0.2
"""Between two commands: it keeps but one that it has not read."""

_GOING: Final = (GraphState.RUNNING, GraphState.PAUSED, GraphState.STOPPING)
_NOT_BEGUN: Final = (GraphState.UNINITIALIZED, GraphState.INITIALIZED)
"""A graph that it refused late, as an action could not be loaded, it keeps so."""


@dataclass(slots=True)
class _Guest:
    """What is known of one engine."""

    actor: str
    service: Service[ros.UmrfGraphGetRequest, ros.UmrfGraphGetResponse]
    sequence: int = 0
    there: bool = False
    answered_s: float = float("-inf")
    heard_s: float = float("-inf")
    """When it last answered, or said anything."""
    commanded_s: float = float("-inf")
    said_s: float = float("-inf")
    """When others last heard how it fares."""
    trouble: Trouble = ""
    catalogue: tuple[ActionInfo, ...] = ()
    described: tuple[str, ...] = ()
    """What `catalogue` was read from."""
    graphs: dict[str, Graph] = field(default_factory=dict)
    read: dict[str, Graph] = field(default_factory=dict)
    """By their text: those of its last answer."""
    sent: dict[str, float] = field(default_factory=dict)
    """Graphs that it was told to start and that have not ended, and when each was last heard of."""
    told: dict[str, str] = field(default_factory=dict)
    """The text of each of those that was told last."""
    changed: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def state(self) -> str:
        states = {graph.state for graph in self.graphs.values()}
        if states & {GraphState.RUNNING, GraphState.STOPPING}:
            return "running"
        return "paused" if GraphState.PAUSED in states else "idle"


class TemotoActors(Node):
    """Speaks for engines of TeMoto.

    Args:
        transport: Where they are.
        clock: Its wall time counts.
        actors: Their names, and for each the name of the service that it answers (`umrf_graph_get`).
        ask_s: Wall time between two questions to an engine.
        takes_s: Wall time after which an engine that said nothing of a graph is asked for it.
    """

    name = "temoto"

    def __init__(
        self,
        transport: Transport,
        clock: Clock,
        actors: Mapping[str, str],
        *,
        ask_s: float = ASK_S,
        takes_s: float = TAKES_S,
    ) -> None:
        super().__init__(transport)
        self._clock, self._ask_s, self._takes_s = clock, ask_s, takes_s
        self._guests = {
            actor: _Guest(actor, replace(topics.GRAPH_GET, name=service)) for actor, service in actors.items()
        }

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe_raw(topics.GRAPH_FEEDBACK, self._on_feedback, depth=100)
        await self.subscribe_raw(topics.GRAPH_START, self._on_start)
        commands: tuple[Topic[Any], ...] = (
            topics.GRAPH_MODIFY, topics.GRAPH_PAUSE, topics.GRAPH_RESUME, topics.GRAPH_STOP,
        )  # fmt: skip
        for command in commands:
            await self.subscribe_raw(command, self._on_command)
        await self.subscribe(topics.STOP, StopCommand, self._on_stop)
        self.opened.callback(self.transport.on_endpoints_changed(self._on_ends))
        for guest in self._guests.values():
            self.opened.callback(self._leave, guest)
            self.spawn(self._watch(guest), name=f"temoto {guest.actor}")

    # -- what is heard --------------------------------------------------------------------------------------

    def _on_ends(self) -> None:
        for guest in self._guests.values():
            if guest.there != self._is_served(guest):
                guest.changed.set()

    def _on_command(self, message: Any) -> None:
        for guest in self._meant(message.targets):
            guest.commanded_s = self._clock.wall_s()

    def _on_start(self, message: ros.UmrfGraphStart) -> None:
        self._on_command(message)
        for guest in self._meant(message.targets):
            name = message.umrf_graph_name
            if message.umrf_graph_json:
                try:
                    name = read_graph(message.umrf_graph_json).name
                except GraphRefusedError:
                    continue  # whoever sent it is told by the engines of ours
            guest.sent[name] = float("-inf")
            self.spawn(self._look_for(guest, name), name=f"start at {guest.actor}")

    def _on_feedback(self, feedback: ros.UmrfGraphFeedback) -> None:
        guest = self._guests.get(feedback.actor)
        if guest is None:
            return
        for text in reversed(feedback.history):
            with suppress(GraphRefusedError):  # the planner says so
                self._note(guest, read_graph(text), text)
        guest.heard_s = self._clock.wall_s()
        guest.changed.set()

    def _on_stop(self, command: StopCommand) -> None:
        """It knows no emergency stop: what it carries out is ended, and that it stands nobody can say."""
        if command.command == "stop":
            for guest in self._meant(command.targets or tuple(self._guests)):
                # What is known to go comes first, as each waits for the one before.
                going = [name for name, graph in guest.graphs.items() if graph.state in _GOING]
                unknown = [name for name in guest.sent if name not in guest.graphs]
                self.spawn(self._stop(guest, (*going, *unknown)), name=f"stop {guest.actor}")

    async def _stop(self, guest: _Guest, graphs: Iterable[str]) -> None:
        for name in graphs:
            self.log.info("ends a graph of TeMoto", robot=guest.actor, graph=name)
            self.send(topics.GRAPH_STOP, ros.UmrfGraphStop(name, (guest.actor,)))
            await asyncio.sleep(APART_S)

    def _meant(self, targets: Iterable[str]) -> list[_Guest]:
        wanted = {target.casefold() for target in targets}
        return [guest for name, guest in self._guests.items() if name.casefold() in wanted]

    # -- what is asked --------------------------------------------------------------------------------------

    async def _watch(self, guest: _Guest) -> None:
        asked_s = float("-inf")
        asking: asyncio.Task[Any] | None = None
        while True:
            news = guest.changed.is_set()
            guest.changed.clear()
            if not self._is_served(guest):
                self._leave(guest)
                asked_s = float("-inf")
                await guest.changed.wait()
                continue
            now_s = self._clock.wall_s()
            if now_s - asked_s >= self._ask_s and (asking is None or asking.done()):
                asked_s, asking = now_s, self.spawn(self._ask(guest), name=f"ask {guest.actor}")
            news |= now_s - guest.said_s >= BEAT_S or guest.trouble != self._trouble(guest, now_s)
            if news and now_s - guest.answered_s < STARVED_AFTER_S:
                guest.said_s, guest.trouble = now_s, self._trouble(guest, now_s)
                self._say(guest, guest.state)
            with suppress(TimeoutError):
                async with asyncio.timeout(min(LOOK_S, self._ask_s)):
                    await guest.changed.wait()

    def _trouble(self, guest: _Guest, now_s: float) -> Trouble:
        """Whether it says nothing for longer than what it was told to do explains."""
        explained_s = ENDS_S if now_s - guest.commanded_s < ENDS_S else SILENT_S
        return "silent" if now_s - guest.heard_s > explained_s else ""

    async def _look_for(self, guest: _Guest, name: str) -> None:
        """See whether the engine took a graph of which it says nothing."""
        await asyncio.sleep(self._takes_s)
        if guest.sent.get(name) != float("-inf") or not await self._ask(guest):
            return
        if (held := guest.graphs.get(name)) is not None and held.state not in _NOT_BEGUN:
            return
        guest.sent.pop(name, None)
        problem = RejectionProblem(
            message="the engine did not take this graph, and does not say why",
            remedy="look into its log; often it does not know an action, or has a graph of that name",
            code=NOT_TAKEN,
        )
        told = Rejection(
            source=self.name, target=guest.actor, what=topics.GRAPH_START.name, graph_name=name,
            problems=(problem,),
        )  # fmt: skip
        self.publish(topics.REJECTION, told)

    async def _ask(self, guest: _Guest) -> bool:
        """Take over what an engine says when asked; whether it answered."""
        try:
            answer = await self.transport.call(
                guest.service, ros.UmrfGraphGetRequest(), timeout_s=min(ANSWER_S, LOST_AFTER_S / 2)
            )
        except TransportError as error:
            self.log.info("an engine of TeMoto does not answer", robot=guest.actor, why=str(error))
            return False
        guest.answered_s = guest.heard_s = self._clock.wall_s()
        guest.changed.set()
        if answer.umrf_jsons != guest.described:
            guest.described, guest.catalogue = answer.umrf_jsons, tuple(self._read_actions(answer.umrf_jsons))
        guest.read = dict(self._read_graphs(guest, answer.graph_jsons_running))
        guest.graphs = {graph.name: graph for graph in guest.read.values()}
        for text, graph in guest.read.items():
            last_s = guest.sent.get(graph.name)
            if last_s is None or guest.answered_s - last_s < self._takes_s or graph.state in _NOT_BEGUN:
                continue
            if text != guest.told.get(graph.name):
                # It loses part of its feedback, the last of a graph too.
                self.send(topics.GRAPH_FEEDBACK, ros.UmrfGraphFeedback(guest.actor, (text,)))
                self._note(guest, graph, text)
        return True

    def _read_actions(self, texts: Iterable[str]) -> Iterable[ActionInfo]:
        for text in texts:
            try:
                yield info_of(read_descriptor(text))
            except GraphRefusedError as error:
                self.log.warning("an action of TeMoto cannot be read", why=str(error))

    def _read_graphs(self, guest: _Guest, texts: Iterable[str]) -> Iterable[tuple[str, Graph]]:
        for text in texts:
            try:
                yield text, guest.read.get(text) or read_graph(text)
            except GraphRefusedError as error:
                self.log.warning("a graph of TeMoto cannot be read", robot=guest.actor, why=str(error))

    def _note(self, guest: _Guest, graph: Graph, text: str) -> None:
        guest.graphs[graph.name] = graph
        if graph.name in guest.sent:
            guest.sent[graph.name], guest.told[graph.name] = self._clock.wall_s(), text
            if graph.state in ENDED:
                del guest.sent[graph.name], guest.told[graph.name]

    # -- what is said ---------------------------------------------------------------------------------------

    def _is_served(self, guest: _Guest) -> bool:
        name = absolute(guest.service.name)
        return any(end.role == "server" and end.name == name for end in self.transport.endpoints())

    def _leave(self, guest: _Guest) -> None:
        if guest.there:
            self._say(guest, "leaving")
        guest.there, guest.trouble = False, ""
        guest.said_s = guest.answered_s = guest.heard_s = float("-inf")
        guest.graphs, guest.read, guest.sent, guest.told = {}, {}, {}, {}

    def _say(self, guest: _Guest, state: str) -> None:
        guest.there = True
        told = ActorStatus.model_validate(
            {
                "actor": guest.actor, "engine": "temoto", "state": state, "sequence": guest.sequence,
                "trouble": guest.trouble,
                "graphs": {name: graph.state.value for name, graph in guest.graphs.items()},
                "catalogue": guest.catalogue,
            }
        )  # fmt: skip
        guest.sequence += 1
        self.publish(topics.ACTOR_STATUS, told)
