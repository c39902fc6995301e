"""Asking for long tasks through a bridge, with its own words: goal, feedback, result, cancel."""

from __future__ import annotations

import asyncio
import inspect
from contextlib import suppress
from typing import Any, Final, Generic, Protocol, TypeVar

import structlog

from parley.errors import (
    GoalRefusedError,
    TransportError,
    TransportTimeoutError,
    TypeMismatchError,
    UnavailableError,
)
from parley.messages.actions import Action, ActionWire, GoalId, GoalState, GoalStatusArray
from parley.messages.topics import Topic
from parley.transport.base import Handler, Outcome, Subscription, absolute
from parley.transport.inbox import Inbox
from parley.transport.remote import Codec
from parley.transport.rosbridge.frames import Frame

__all__ = ["REFUSED", "Asking", "RosbridgeActionClient"]

M = TypeVar("M")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")

REFUSED: Final = "Action goal was rejected"
_STATES: Final = frozenset(GoalState)
CANCEL_AGAIN_S: Final = 0.3
GIVEN_UP_S: Final = 10.0
"""So long a goal that nobody waits for is called off; a server that takes none by then never did."""

log = structlog.get_logger(__name__)


class Asking(Protocol):
    """What an action client asks of the transport that opened it."""

    def send(self, frame: Frame) -> None:
        """Send soon."""

    async def ask(self, id_: str, frame: Frame, what: str) -> Frame:
        """Send a frame and wait for what comes back under its id."""
        ...

    def new_id(self, kind: str) -> str:
        """A name for one exchange, used by nobody else."""
        ...

    def may_serve(self, name: str) -> bool:
        """Whether somebody might answer this."""
        ...

    def codec(self, python_type: type[M], ros_type: str) -> Codec[M]:
        """What writes and reads a type."""
        ...

    async def subscribe(self, topic: Topic[M], handler: Handler[M]) -> Subscription:
        """See `Transport.subscribe`."""
        ...

    def forget(self, client: RosbridgeActionClient[Any, Any, Any]) -> None:
        """An action client is closed."""

    def count_failure(self) -> None:
        """A handler raised."""


class _SentGoal(Generic[Result]):
    """See `parley.transport.base.SentGoal`."""

    def __init__(self, client: RosbridgeActionClient[Any, Result, Any], id_: str, on_feedback: Any) -> None:
        self._client, self.id, self.on_feedback = client, id_, on_feedback
        self.state = GoalState.UNKNOWN
        self.uuid: GoalId | None = None
        self.changed = asyncio.Event()
        """Something was heard of it."""
        self.ending: asyncio.Task[Outcome[Result]] | None = None

    def now(self, state: GoalState) -> None:
        """The server told where it stands."""
        self.state = max(self.state, state)
        self.changed.set()

    async def outcome(self, *, timeout_s: float) -> Outcome[Result]:
        assert self.ending is not None
        try:
            async with asyncio.timeout(timeout_s):
                return await asyncio.shield(self.ending)
        except TimeoutError as error:
            raise TransportTimeoutError(f"{self._client.name} is not over after {timeout_s} s") from error

    async def cancel(self, *, timeout_s: float) -> bool:
        assert self.ending is not None
        if self.ending.done():
            return False
        try:
            async with asyncio.timeout(timeout_s):
                await self.called_off()
        except TimeoutError as error:
            raise TransportTimeoutError(
                f"{self._client.name} is not called off after {timeout_s} s"
            ) from error
        if self.ending.done():
            self.ending.result()  # raises if the server went away
        return self.state in (GoalState.CANCELING, GoalState.CANCELED)

    async def called_off(self) -> None:
        """Call it off until that is heard: before a bridge has the server's yes, it drops this in silence."""
        assert self.ending is not None
        while self.state < GoalState.CANCELING and not self.ending.done():
            self._client.send_cancel(self.id)
            self.changed.clear()
            with suppress(TimeoutError):
                async with asyncio.timeout(CANCEL_AGAIN_S):
                    while self.state < GoalState.CANCELING and not self.ending.done():
                        await self.changed.wait()
                        self.changed.clear()


class RosbridgeActionClient(Generic[Goal, Result, Feedback]):
    """See `parley.transport.base.ActionClient`.

    A bridge says nothing when a goal is accepted, so the topic of states is heard for that: a goal that
    nobody knew there belongs to whoever of us asked first.

    Args:
        transport: The connection.
        action: What is asked for.
    """

    def __init__(self, transport: Asking, action: Action[Goal, Result, Feedback]) -> None:
        self._transport, self._action, self._wire = transport, action, ActionWire(action)
        self.name = action.name
        self._goals: dict[str, _SentGoal[Result]] = {}
        self._known: set[GoalId] = set()
        self._goal = transport.codec(action.goal, f"{action.ros_type}_Goal")
        self._result = transport.codec(action.result, f"{action.ros_type}_Result")
        self._feedback = transport.codec(action.feedback, f"{action.ros_type}_Feedback")
        self._ends: list[Subscription] = []
        self._given_up: set[asyncio.Task[None]] = set()

    async def open(self) -> None:
        """Begin to hear of goals."""
        self._ends.append(await self._transport.subscribe(self._wire.status, self._on_status))
        topic: Topic[Any] = Topic(f"{self.name} feedback", object, self._action.ros_type)
        self._inbox: Inbox[Any] = Inbox(
            topic, self._tell, depth=100, along=self._ends[0], on_failure=self._transport.count_failure
        )
        self._ends.append(self._inbox)

    async def send(
        self, goal: Goal, *, timeout_s: float, on_feedback: Handler[Feedback] | None = None
    ) -> _SentGoal[Result]:
        """See `ActionClient.send`; many bridges say nothing of a goal that is refused, and it times out."""
        if not isinstance(goal, self._action.goal):
            raise TypeMismatchError(f"{self.name} takes {self._action.ros_type}; got a {type(goal).__name__}")
        if not self._transport.may_serve(self._wire.send_goal.name):
            raise UnavailableError(f"nobody serves the action {self.name}; is its node running?")
        id_ = self._transport.new_id("goal")
        sent = self._goals[id_] = _SentGoal(self, id_, on_feedback)
        frame = {
            "op": "send_action_goal",
            "id": id_,
            "action": absolute(self.name),
            "action_type": self._action.ros_type,
            "args": self._goal.encode(goal),
            "feedback": True,
        }
        sent.ending = asyncio.create_task(self._follow(sent, frame), name=f"goal of {self.name}")
        sent.ending.add_done_callback(_look_at)
        try:
            async with asyncio.timeout(timeout_s):
                while sent.state < GoalState.ACCEPTED and not sent.ending.done():
                    sent.changed.clear()
                    await sent.changed.wait()
        except TimeoutError as error:
            self._give_up(sent)
            raise TransportTimeoutError(
                f"{self.name} did not say within {timeout_s} s that it takes the goal"
            ) from error
        except asyncio.CancelledError:
            self._give_up(sent)
            raise
        if sent.ending.done() and sent.ending.exception() is not None:
            sent.ending.result()
        return sent

    def send_cancel(self, id_: str) -> None:
        """Call a goal off."""
        self._transport.send({"op": "cancel_action_goal", "id": id_, "action": absolute(self.name)})

    async def close(self) -> None:
        """See `ActionClient.close`."""
        self._transport.forget(self)
        for end in reversed(self._ends):
            await end.close()
        for task in list(self._given_up):
            task.cancel()
        await asyncio.gather(*self._given_up, return_exceptions=True)
        for sent in list(self._goals.values()):
            if sent.ending is not None:
                sent.ending.cancel()
                await asyncio.gather(sent.ending, return_exceptions=True)
        self._goals.clear()

    def lost(self) -> None:
        """The connection is lost; what comes of the goals is not known."""
        self._known.clear()

    def on_feedback(self, frame: Frame) -> None:
        """A goal tells how it goes."""
        sent = self._goals.get(str(frame.get("id")))
        if sent is None:
            return
        sent.now(GoalState.EXECUTING)
        if sent.on_feedback is not None:
            try:
                told = self._feedback.decode(frame.get("values"))
            except TypeMismatchError as error:
                log.warning("feedback cannot be read", action=self.name, why=str(error))
                return
            self._inbox.put((sent.on_feedback, told))

    async def _follow(self, sent: _SentGoal[Result], frame: Frame) -> Outcome[Result]:
        """The goal's end, as the bridge tells it."""
        try:
            answer = await self._transport.ask(sent.id, frame, f"action {self.name}")
            if answer.get("result") is not True:
                if answer.get("values") == REFUSED:
                    raise GoalRefusedError(f"{self.name} does not take this goal")
                raise UnavailableError(f"action {self.name} ended without a result: {answer.get('values')}")
            try:
                state = GoalState(answer.get("status", GoalState.UNKNOWN))
            except ValueError:
                raise TransportError(f"action {self.name} ended as {answer.get('status')!r}") from None
            outcome = Outcome(state, self._result.decode(answer.get("values", {})))
            sent.now(state)
            return outcome
        finally:
            sent.changed.set()
            self._goals.pop(sent.id, None)

    def _give_up(self, sent: _SentGoal[Result]) -> None:
        """Nobody waits for this goal any more; it may be on its way all the same, so it is called off."""
        task = asyncio.create_task(self._call_off(sent), name=f"give up {self.name}")
        self._given_up.add(task)
        task.add_done_callback(self._given_up.discard)

    async def _call_off(self, sent: _SentGoal[Result]) -> None:
        try:
            async with asyncio.timeout(GIVEN_UP_S):
                await sent.called_off()
        except TimeoutError:
            log.warning("a goal that was given up was not seen to be called off", action=self.name)
        finally:
            if sent.ending is not None:
                sent.ending.cancel()

    def _on_status(self, message: GoalStatusArray) -> None:
        for status in message.status_list:
            if status.status not in _STATES:
                continue
            uuid, state = status.goal_info.goal_id, GoalState(status.status)
            if uuid not in self._known and not state.is_over:
                waiting = [sent for sent in self._goals.values() if sent.uuid is None]
                if waiting:
                    waiting[0].uuid = uuid
            for sent in self._goals.values():
                if sent.uuid == uuid:
                    sent.now(state)
        self._known = {status.goal_info.goal_id for status in message.status_list}

    async def _tell(self, told: tuple[Handler[Any], Any]) -> None:
        handler, feedback = told
        answer = handler(feedback)
        if answer is not None and inspect.isawaitable(answer):
            await answer


def _look_at(ending: asyncio.Task[Any]) -> None:
    """Whoever asks for the outcome is told how it ended; if nobody asks, that is no defect."""
    if not ending.cancelled():
        ending.exception()
