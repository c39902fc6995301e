"""The server's end of the topics: what it hears goes into the state, what operators decide goes out."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final, Self, TypeAlias, TypeVar

import structlog
from pydantic import BaseModel

from parley.clock import Clock
from parley.errors import GraphRefusedError, InvalidMessageError, TransportError, UnavailableError
from parley.messages import topics
from parley.messages.attendance import Attendance
from parley.messages.audit import AuditEvent
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, ChatRead, Press, PressTaken, ReplyDraft
from parley.messages.incident import GetIncidents, Incident, IncidentList
from parley.messages.map import MapView
from parley.messages.memory import AddToMemory, MemoryEvent, RemoveMemory
from parley.messages.ros import (
    ChatRequest,
    ChatResponse,
    String,
    UmrfGraphFeedback,
    UmrfGraphPause,
    UmrfGraphResume,
)
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    Rejection,
    StopCommand,
    StopReport,
)
from parley.messages.team import MissionList
from parley.messages.topics import Service, Topic
from parley.messages.wire import decode, decode_plan, encode, load_json, to_string
from parley.transport.base import Publisher, Transport
from parley.transport.desk import Desk
from parley.transport.losses import Losses
from parley.umrf.io import read_graph
from parley.web.state import WebState

__all__ = ["Link", "Pressed", "halts", "robots_of"]

log = structlog.get_logger(__name__)

P = TypeVar("P", bound=BaseModel)
Pressed: TypeAlias = ChatAction | PlanDecision
"""What a button does."""

TICK_S: Final = 0.25
"""Wall time between two looks at what is overdue."""
CALL_TIMEOUT_S: Final = 10.0
ECHO_WITHIN_S: Final = 2.0
"""Wall time after which a message counts as carried though it did not come back."""

_SENT: Final[dict[type[BaseModel], Topic[String]]] = {
    ChatInput: topics.CHAT_INPUT,
    Attendance: topics.ATTENDANCE,
    ChatAction: topics.CHAT_ACTION,
    PlanDecision: topics.PLAN_DECISION,
    StopCommand: topics.STOP,
    AddToMemory: topics.ADD_TO_MEMORY,
    RemoveMemory: topics.REMOVE_MEMORY,
    ChatFeedback: topics.CHAT_FEEDBACK,
    AuditEvent: topics.AUDIT,
}


_MISSED: Final = frozenset(
    topic.name for topic in (topics.CHAT_INPUT, topics.CHAT_FEEDBACK, topics.PLAN, topics.PLAN_DECISION)
)
"""Of what is told here a person would miss what is lost."""
_LOST: Final = (
    "Messages that did not get here, as so much came at once or the connection was away: {count}. "
    "Look whether all is as you want it."
)


def robots_of(message: Pressed) -> tuple[str, ...]:
    """Whom a button is for; empty: all."""
    return message.targets if isinstance(message, ChatAction) else (message.target,)


def halts(message: Pressed) -> bool:
    """Whether less happens by it than without."""
    if isinstance(message, PlanDecision):
        return message.decision == "reject"
    return any(command.command in ("stop", "clear") for command in message.system_cmd)


@dataclass(slots=True)
class _Unread:
    message: ChatInput | Pressed
    robots: tuple[str, ...]
    read: asyncio.Event = field(default_factory=asyncio.Event)
    overtaken: bool = False
    """By something newer: it is not sent again."""

    @property
    def is_past(self) -> bool:
        """Whether it is a halt that something newer has followed."""
        return self.overtaken and not isinstance(self.message, ChatInput) and halts(self.message)


class Link:
    """Connects a `WebState` to a transport. Use as ``async with``.

    Args:
        transport: Opened by the caller; only what is opened here is closed here.
        state: Gets every message.
        clock: Wall time.
        pressed: The page of this server and the number of the last press there, also of earlier runs.
        on_view: Told after a robot's place on the map changed.
        on_joined: Told when a robot is heard of for the first time, or was started anew.
        on_planner: The same of whoever plans.
    """

    def __init__(
        self,
        transport: Transport,
        state: WebState,
        clock: Clock,
        *,
        pressed: tuple[str, int],
        on_view: Callable[[MapView], None] = lambda _: None,
        on_joined: Callable[[str], None] = lambda _: None,
        on_planner: Callable[[], None] = lambda: None,
    ) -> None:
        self.transport, self._state, self._clock = transport, state, clock
        self._on_view_heard, self._on_joined, self._on_planner = on_view, on_joined, on_planner
        self._stack = contextlib.AsyncExitStack()
        self._publishers: dict[type[BaseModel], Publisher[String]] = {}
        self._echoes: dict[str, asyncio.Future[None]] = {}
        """Messages that were published and did not come back yet, by id."""
        self.says_what_it_read = False
        """Whether whoever reads what people say was ever heard to say so; a node of another make does not."""
        self._unread: dict[str, _Unread] = {}
        """Words and presses that were published, by their id."""
        self._again_s = 0.0
        self._outcomes: dict[str, asyncio.Future[PressTaken]] = {}
        """Of presses of which somebody waits to hear what came of them, by id."""
        self._planner, (self._page, self._pressed) = "", pressed
        self._planned = asyncio.Event()
        self.holds: dict[str, tuple[str, ...]] = {}
        """By what each robot's drive is held, as it says itself."""
        self._foreign: set[str] = set()
        """Robots whose engine is that of TeMoto."""
        self._losses = Losses(self._tell_lost)
        self._memory_waits: dict[str, list[asyncio.Future[MemoryEvent]]] = {}

    async def __aenter__(self) -> Self:
        """Open the topics."""
        try:
            await self._open()
        except BaseException:
            await self._stack.aclose()
            raise
        return self

    async def __aexit__(self, *exc: object) -> None:
        """Close them."""
        await self._stack.aclose()

    async def _open(self) -> None:
        for kind, topic in _SENT.items():
            publisher = self.transport.publisher(topic)
            self._stack.callback(publisher.close)
            self._publishers[kind] = publisher
        self._pausing = self.transport.publisher(topics.GRAPH_PAUSE)
        self._pausing_temoto = self.transport.publisher(topics.GRAPH_PAUSE_TEMOTO)
        self._resuming = self.transport.publisher(topics.GRAPH_RESUME)
        for end in (self._pausing, self._pausing_temoto, self._resuming):
            self._stack.callback(end.close)
        state, now_ms = self._state, self._clock.unix_ms
        await self._listen(topics.ACTOR_STATUS, _reader(ActorStatus), self._on_status)
        await self._listen(topics.CHAT_INPUT, _reader(ChatInput), self._on_input)
        await self._listen(
            topics.CHAT_FEEDBACK, _reader(ChatFeedback), lambda m: state.chat.on_feedback(m, unix_ms=now_ms())
        )
        await self._listen(
            topics.REPLY_DRAFT, _reader(ReplyDraft), lambda m: state.chat.on_draft(m, unix_ms=now_ms())
        )
        await self._listen(topics.CHAT_READ, _reader(ChatRead), self._on_read)
        await self._listen(topics.PRESS_TAKEN, _reader(PressTaken), self._on_taken)
        await self._listen(topics.PLAN, decode_plan, state.on_plan)
        await self._listen(topics.PLAN_DECISION, _reader(PlanDecision), state.plans.on_decision)
        await self._listen(topics.GRAPH_EVENTS, _reader(GraphEvent), state.on_event)
        feedback = await self.transport.subscribe(topics.GRAPH_FEEDBACK, self._on_feedback, depth=1000)
        self._stack.push_async_callback(feedback.close)
        await self._listen(topics.STOP, _reader(StopCommand), self._on_stop)
        await self._listen(
            topics.STOP_REPORT,
            _reader(StopReport),
            lambda m: state.robots.on_stop_report(m, unix_ms=now_ms()),
        )
        await self._listen(topics.REJECTION, _reader(Rejection), state.on_rejection)
        await self._listen(topics.MEMORY_EVENT, _reader(MemoryEvent), self._on_memory)
        await self._listen(topics.AUDIT, _reader(AuditEvent), state.on_audit)
        await self._listen(topics.INCIDENT, _reader(Incident), state.on_incident)
        await self._listen(topics.MISSIONS, _reader(MissionList), state.on_missions)
        await self._listen(topics.MAP_VIEW, _reader(MapView), self._on_view)
        await self._stack.enter_async_context(Desk(self.transport, state.robots.untaken))
        for work in (self._tick(), self._fetch_incidents()):
            task = asyncio.create_task(work, name="web link")
            self._stack.push_async_callback(_cancel, task)

    def send(
        self,
        message: ChatInput
        | ChatAction
        | PlanDecision
        | StopCommand
        | AddToMemory
        | RemoveMemory
        | Attendance
        | AuditEvent
        | ChatFeedback,
    ) -> None:
        """Publish what an operator said or decided, or what is to be said to them, on its topic."""
        if isinstance(message, StopCommand) and (message.command == "stop" or message.words):
            self._overtake(message.targets, words=True)
        self._publishers[type(message)].publish(to_string(message))
        if isinstance(message, StopCommand) and message.command == "reset":
            self._on_stop(message)  # it is told again to who is out of reach, also if nobody carries it now

    def pause(self, robot: str, graphs: Iterable[str]) -> None:
        """Let an engine pause graphs, whoever plans; that of TeMoto listens to its own misspelling."""
        ends = (self._pausing, self._pausing_temoto) if robot in self._foreign else (self._pausing,)
        for name in graphs:
            for end in ends:
                end.publish(UmrfGraphPause(name, (robot,)))

    def resume(self, robot: str, graphs: Iterable[str]) -> None:
        """Let an engine go on with graphs that it paused, whoever plans."""
        for name in graphs:
            self._resuming.publish(UmrfGraphResume(name, (robot,)))

    async def say(self, message: ChatInput) -> None:
        """Publish an operator's words and wait until they come back: then the transport has carried them.

        `until_read` has to follow.
        """
        echo: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._echoes[message.id] = echo
        try:
            self.begin(message)
            async with asyncio.timeout(ECHO_WITHIN_S):
                await echo
        except TimeoutError:
            log.warning("no echo of a message", id=message.id)
        finally:
            del self._echoes[message.id]

    def begin(self, message: ChatInput) -> None:
        """Publish an operator's words and wait for nothing; `until_read` has to follow."""
        self._overtake(message.targets)
        self._unread.setdefault(message.id, _Unread(message, message.targets))
        self.send(message)

    def number(self, message: Pressed) -> Pressed:
        """What a button does with the number of its press, without one if no planner says what it takes.

        What was pressed before is not sent again, nor after a pause or a drop what was said before.
        """
        self._overtake(robots_of(message), words=isinstance(message, ChatAction) and halts(message))
        if not self._planner:
            return message
        self._pressed = max(self._pressed + 1, self._clock.unix_ms())  # behind each of an earlier run
        press = Press(page=self._page, number=self._pressed, to=self._planner)
        return message.model_copy(update={"press": press})

    def press(self, message: Pressed) -> None:
        """Publish what a button does; where its press has a number, `until_read` has to follow."""
        if message.press is not None:
            self._unread[message.press.id] = _Unread(message, robots_of(message))
        self.send(message)

    def _overtake(self, robots: Sequence[str], *, words: bool = False) -> None:
        """Something newer goes to robots (none: all): a late deed is worse than a question."""
        for unread in self._unread.values():
            if words or not isinstance(unread.message, ChatInput):
                unread.overtaken |= not robots or not unread.robots or bool({*robots} & {*unread.robots})

    async def until_read(self, ids: Sequence[str], *, again_s: float) -> None:
        """Wait until all of that is read, and send it again meanwhile: who has read it knows its id.

        Where something newer goes to the same robots it is not sent again, nor is a halt waited for then.
        """
        waiting = [self._unread[identity] for identity in ids]
        try:
            while unread := [each for each in waiting if not (each.read.is_set() or each.is_past)]:
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(again_s):
                        await unread[0].read.wait()
                        continue
                self._send_again(again_s)
        finally:
            for identity in ids:
                del self._unread[identity]

    def _send_again(self, again_s: float) -> None:
        """Send all that is wanted, in its order: one that came out of turn would be told as lost before."""
        now_s = self._clock.wall_s()
        if now_s - self._again_s >= again_s / 2:
            self._again_s = now_s
            for each in filter(self._is_wanted, self._unread.values()):
                self.send(each.message)

    def _is_wanted(self, unread: _Unread) -> bool:
        """Whether it is to be sent again."""
        waits = not (unread.read.is_set() or unread.is_past or unread.overtaken)
        return waits and (self.says_what_it_read or not isinstance(unread.message, ChatInput))

    def overtaken(self, press: str) -> bool:
        """Whether something newer has gone to a robot than a press that waits to be taken."""
        return press not in self._unread or self._unread[press].overtaken

    async def until_taken(self, message: Pressed, *, again_s: float) -> None:
        """Publish what a button does until somebody plans and has taken it, whatever comes in between."""
        await self._planned.wait()
        numbered = self.number(message)
        assert numbered.press is not None
        waiting = self._unread[numbered.press.id] = _Unread(numbered, robots_of(numbered))
        try:
            while not waiting.read.is_set():
                self.send(numbered)
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(again_s):
                        await waiting.read.wait()
        finally:
            del self._unread[numbered.press.id]

    async def outcome(self, press: str, within_s: float) -> PressTaken:
        """What came of a press.

        Raises:
            TimeoutError: Nobody said so in time.
        """
        heard: asyncio.Future[PressTaken] = asyncio.get_running_loop().create_future()
        self._outcomes[press] = heard
        try:
            async with asyncio.timeout(within_s):
                return await heard
        finally:
            del self._outcomes[press]

    async def ask(self, service: Service[ChatRequest, ChatResponse], request: BaseModel, kind: type[P]) -> P:
        """Call a service that speaks JSON.

        Raises:
            TransportError: It does not answer.
            InvalidMessageError: Its answer cannot be read.
        """
        reply = await self.transport.call(service, ChatRequest(encode(request)), timeout_s=CALL_TIMEOUT_S)
        return decode(kind, reply.response)

    async def change_memory(self, message: AddToMemory | RemoveMemory) -> MemoryEvent:
        """Have one memory added or removed and wait until that is durable.

        Raises:
            UnavailableError: There is no memory.
            TimeoutError: Nobody confirmed it in time.
        """
        name_of_service = topics.GET_MEMORY.name.lstrip("/")
        ends = self.transport.endpoints()
        if not any(end.role == "server" and end.name.lstrip("/") == name_of_service for end in ends):
            raise UnavailableError("nobody remembers anything; is the memory node running?")
        (name,) = message.root
        wait: asyncio.Future[MemoryEvent] = asyncio.get_running_loop().create_future()
        self._memory_waits.setdefault(name, []).append(wait)
        try:
            self.send(message)
            async with asyncio.timeout(CALL_TIMEOUT_S):
                return await wait
        finally:
            waits = self._memory_waits[name]
            waits.remove(wait)
            if not waits:
                del self._memory_waits[name]

    # -- hearing ---------------------------------------------------------------------------------------

    async def _listen(
        self, topic: Topic[String], read: Callable[[str], P], handle: Callable[[P], None]
    ) -> None:
        def receive(message: String) -> None:
            try:
                payload = read(message.data)
            except InvalidMessageError as error:
                log.warning("unreadable message", topic=topic.name, error=str(error))
                return
            self._losses.look()
            handle(payload)

        depth, late = max(topic.qos.depth, 1000), topic is not topics.STOP  # a release may have overtaken it
        subscription = await self.transport.subscribe(topic, receive, depth=depth, late=late)
        self._stack.push_async_callback(subscription.close)
        if topic.name in _MISSED:
            self._losses.watch(subscription)

    def _tell_lost(self, count: int) -> None:
        """To everybody who looks; what is shown may be out of date."""
        told = ChatFeedback(message=_LOST.format(count=count), type="error")
        self.send(told)  # behind all that waits

    def _on_status(self, status: ActorStatus) -> None:
        before = self._state.robots.views.get(status.actor)
        self.holds[status.actor] = status.holds
        (self._foreign.add if status.engine == "temoto" else self._foreign.discard)(status.actor)
        restarted = self._state.robots.on_status(
            status, now_s=self._clock.wall_s(), unix_ms=self._clock.unix_ms()
        )
        if restarted:
            self._state.chat.on_restart(status.actor)
        if (missed := self._state.robots.not_taken(status.actor)) is not None:
            self.send(missed)
        now_s = self._clock.wall_s()
        if (release := self._state.robots.not_released(status.actor, now_s=now_s)) is not None:
            self.send(release)
        if before is None or before.catalogue != status.catalogue:
            self._state.plans.on_catalogue(status.actor)
        if before is None or restarted:
            self._on_joined(status.actor)

    def _on_feedback(self, feedback: UmrfGraphFeedback) -> None:
        """Whole graphs; plans are left out before they are read, as the planner tells more of them."""
        plans = self._state.plans
        for text in reversed(feedback.history):
            try:
                raw = load_json("UmrfGraphFeedback", text)
                name = raw.get("graph_name") if isinstance(raw, dict) else None
                if isinstance(name, str) and not plans.shows_plan(feedback.actor, name):
                    plans.on_graph(feedback.actor, read_graph(raw))
            except (InvalidMessageError, GraphRefusedError) as error:
                log.warning("unreadable graph", actor=feedback.actor, error=str(error))

    def _on_input(self, said: ChatInput) -> None:
        echo = self._echoes.get(said.id)
        if echo is not None and not echo.done():
            echo.set_result(None)
        self._state.chat.on_input(said, unix_ms=self._clock.unix_ms())

    def _on_read(self, read: ChatRead) -> None:
        self.says_what_it_read = True
        if (waited := self._unread.get(read.id)) is not None:
            waited.read.set()

    def _on_taken(self, taken: PressTaken) -> None:
        if (waited := self._unread.get(taken.id)) is not None:
            waited.read.set()
        heard = self._outcomes.get(taken.id)
        if taken.outcome and heard is not None and not heard.done():
            heard.set_result(taken)
        if taken.run != self._planner:
            self._planner = taken.run
            self._planned.set()
            self._on_planner()

    def _on_stop(self, command: StopCommand) -> None:
        self._state.robots.on_stop(command, now_s=self._clock.wall_s(), unix_ms=self._clock.unix_ms())

    def _on_memory(self, event: MemoryEvent) -> None:
        for wait in self._memory_waits.get(event.name, ()):
            if not wait.done():
                wait.set_result(event)
        self._state.on_memory(event)

    def _on_view(self, view: MapView) -> None:
        self._state.on_view(view)
        self._on_view_heard(view)

    async def _tick(self) -> None:
        while True:
            due_s = self._clock.wall_s() + TICK_S
            await asyncio.sleep(TICK_S)
            now_s = self._clock.wall_s()
            self._state.robots.tick(now_s=now_s, late_s=now_s - due_s)

    async def _fetch_incidents(self) -> None:
        """What happened before this server came; what happens from now on comes by itself."""
        try:
            found = await self.ask(topics.GET_INCIDENTS, GetIncidents(limit=100), IncidentList)
        except (TransportError, InvalidMessageError) as error:
            log.info("no incidents", reason=str(error))
            return
        for incident in reversed(found.incidents):
            if incident.id not in self._state.incidents:
                self._state.on_incident(incident)


async def _cancel(task: asyncio.Task[None]) -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


def _reader(kind: type[P]) -> Callable[[str], P]:
    return lambda text: decode(kind, text)
