"""Actions over any transport that can call and subscribe: written once, for backends without their own."""

from __future__ import annotations

import asyncio
import inspect
import uuid
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from typing import Any, Final, Generic, Self, TypeVar

import structlog

from parley.clock import Clock
from parley.errors import GoalRefusedError
from parley.messages.actions import (
    Action,
    ActionWire,
    CancelCode,
    CancelGoalRequest,
    CancelGoalResponse,
    GetResultRequest,
    GoalId,
    GoalInfo,
    GoalState,
    GoalStatus,
    GoalStatusArray,
    SendGoalResponse,
)
from parley.messages.ros import Time
from parley.transport.base import Handler, Outcome, Server, Subscription, Transport

__all__ = ["ActionServer", "CallingActionClient", "RunningGoal"]

Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")

RESULTS_KEPT: Final = 20
"""Of how many goals that are over the server still knows the result."""

log = structlog.get_logger(__name__)


class _SentGoal(Generic[Result]):
    """See `parley.transport.base.SentGoal`."""

    def __init__(
        self,
        transport: Transport,
        wire: ActionWire[Any, Result, Any],
        goal_id: GoalId,
        on_feedback: Handler[Any] | None,
    ) -> None:
        self._transport, self._wire, self._id = transport, wire, goal_id
        self.on_feedback = on_feedback
        self.state = GoalState.UNKNOWN

    async def outcome(self, *, timeout_s: float) -> Outcome[Result]:
        answer = await self._transport.call(
            self._wire.get_result, GetResultRequest(self._id), timeout_s=timeout_s
        )
        self.state = GoalState(answer.status)
        return Outcome(self.state, answer.result)

    async def cancel(self, *, timeout_s: float) -> bool:
        answer = await self._transport.call(
            self._wire.cancel, CancelGoalRequest(GoalInfo(self._id)), timeout_s=timeout_s
        )
        return any(info.goal_id == self._id for info in answer.goals_canceling)


class CallingActionClient(Generic[Goal, Result, Feedback]):
    """See `parley.transport.base.ActionClient`.

    Args:
        transport: What carries it.
        action: What is asked for.
    """

    def __init__(self, transport: Transport, action: Action[Goal, Result, Feedback]) -> None:
        self._transport, self._action, self._wire = transport, action, ActionWire(action)
        self._ends: list[Subscription] = []
        self._goals: dict[GoalId, _SentGoal[Result]] = {}

    async def open(self) -> None:
        """Begin to hear of goals."""
        feedback = await self._transport.subscribe(self._wire.feedback, self._on_feedback)
        self._ends.append(feedback)
        # Along: the last feedback is handled before the word that the goal is over.
        self._ends.append(await self._transport.subscribe(self._wire.status, self._on_status, along=feedback))

    async def send(
        self, goal: Goal, *, timeout_s: float, on_feedback: Handler[Feedback] | None = None
    ) -> _SentGoal[Result]:
        """See `ActionClient.send`."""
        goal_id = GoalId(uuid.uuid4().bytes)
        sent = self._goals[goal_id] = _SentGoal(self._transport, self._wire, goal_id, on_feedback)
        try:
            answer = await self._transport.call(
                self._wire.send_goal, self._wire.send_goal.request(goal_id, goal), timeout_s=timeout_s
            )
            if not answer.accepted:
                raise GoalRefusedError(f"{self._action.name} does not take this goal")
        except BaseException:
            del self._goals[goal_id]
            raise
        sent.state = max(sent.state, GoalState.ACCEPTED)
        return sent

    async def close(self) -> None:
        """See `ActionClient.close`."""
        for end in self._ends:
            await end.close()
        self._goals.clear()

    async def _on_feedback(self, message: Any) -> None:
        sent = self._goals.get(message.goal_id)
        if sent is not None and sent.on_feedback is not None:
            answer = sent.on_feedback(message.feedback)
            if answer is not None and inspect.isawaitable(answer):
                await answer

    def _on_status(self, message: GoalStatusArray) -> None:
        for status in message.status_list:
            sent = self._goals.get(status.goal_info.goal_id)
            if sent is not None:
                sent.state = max(sent.state, GoalState(status.status))
                if sent.state.is_over:
                    del self._goals[status.goal_info.goal_id]


class RunningGoal(Generic[Goal, Feedback]):
    """What whoever carries out a goal is given; its task is cancelled when the goal is called off.

    Attributes:
        goal: What was asked for.
        info: Which goal it is.
        state: Where it stands.
    """

    def __init__(self, goal: Goal, info: GoalInfo, tell: Callable[[GoalId, Feedback], None]) -> None:
        self.goal, self.info, self.state = goal, info, GoalState.EXECUTING
        self._tell = tell

    def feedback(self, feedback: Feedback) -> None:
        """Tell how it goes."""
        self._tell(self.info.goal_id, feedback)


@dataclass(frozen=True, slots=True)
class _Entry(Generic[Goal, Result, Feedback]):
    """A goal the server knows: the work on it, and what waits for its end."""

    running: RunningGoal[Goal, Feedback]
    work: asyncio.Task[Outcome[Result]]
    ended: asyncio.Task[Result]


class ActionServer(Generic[Goal, Result, Feedback]):
    """Serves an action: ``async with ActionServer(...):``.

    Args:
        transport: What carries it.
        action: What is served.
        carry_out: Carries out one goal, in a task of its own that is cancelled when the goal is called off.
        clock: For the stamps of goals.
        takes: Whether a goal is accepted.
    """

    def __init__(
        self,
        transport: Transport,
        action: Action[Goal, Result, Feedback],
        carry_out: Callable[[RunningGoal[Goal, Feedback]], Coroutine[Any, Any, Outcome[Result]]],
        clock: Clock,
        *,
        takes: Callable[[Goal], bool] = lambda _: True,
    ) -> None:
        self._transport, self._action, self._wire = transport, action, ActionWire(action)
        self._carry_out, self._clock, self._takes = carry_out, clock, takes
        self._goals: dict[GoalId, _Entry[Goal, Result, Feedback]] = {}
        self._servers: list[Server] = []

    async def __aenter__(self) -> Self:
        self._feedback = self._transport.publisher(self._wire.feedback)
        self._status = self._transport.publisher(self._wire.status)
        self._servers.append(await self._transport.serve(self._wire.get_result, self._on_get_result))
        self._servers.append(await self._transport.serve(self._wire.cancel, self._on_cancel))
        # Last: who sees this one can use them all.
        self._servers.append(await self._transport.serve(self._wire.send_goal, self._on_goal))
        return self

    async def __aexit__(self, *_: object) -> None:
        for server in self._servers:
            await server.close()
        for entry in self._goals.values():
            entry.work.cancel()
        await asyncio.gather(*(entry.ended for entry in self._goals.values()))
        self._feedback.close()
        self._status.close()

    async def _on_goal(self, request: Any) -> SendGoalResponse:
        now_ms = self._clock.unix_ms()
        stamp = Time(now_ms // 1000, now_ms % 1000 * 1_000_000)
        if request.goal_id in self._goals or not self._takes(request.goal):
            return SendGoalResponse(accepted=False, stamp=stamp)
        running = RunningGoal(request.goal, GoalInfo(request.goal_id, stamp), self._tell)
        work = asyncio.create_task(self._carry_out(running), name=f"goal of {self._action.name}")
        ended = asyncio.create_task(self._end(running, work))
        self._goals[request.goal_id] = _Entry(running, work, ended)
        self._show()
        return SendGoalResponse(accepted=True, stamp=stamp)

    async def _end(self, running: RunningGoal[Goal, Feedback], work: asyncio.Task[Outcome[Result]]) -> Result:
        """The result, when the work is over; the state is right before anybody hears of it."""
        await asyncio.wait([work])
        if work.cancelled():
            called_off = running.state is GoalState.CANCELING
            outcome = Outcome(GoalState.CANCELED if called_off else GoalState.ABORTED, self._action.result())
        elif (error := work.exception()) is not None:
            # The border of what serves an action: a defect ends this goal, is seen, and the client is told.
            log.error("goal failed", action=self._action.name, exc_info=error)
            outcome = Outcome(GoalState.ABORTED, self._action.result())
        else:
            outcome = work.result()
        running.state = outcome.state
        self._show()
        self._forget_old()
        return outcome.result

    async def _on_get_result(self, request: GetResultRequest) -> Any:
        response = self._wire.get_result.response
        entry = self._goals.get(request.goal_id)
        if entry is None:
            return response(GoalState.UNKNOWN, self._action.result())
        result = await asyncio.shield(entry.ended)
        return response(entry.running.state, result)

    async def _on_cancel(self, request: CancelGoalRequest) -> CancelGoalResponse:
        asked, stamp = request.goal_info.goal_id, request.goal_info.stamp
        if asked != GoalId() and asked not in self._goals:
            return CancelGoalResponse(CancelCode.UNKNOWN_GOAL_ID)
        found = [
            entry
            for goal_id, entry in self._goals.items()
            if goal_id == asked
            or (asked == GoalId() and (stamp == Time() or entry.running.info.stamp <= stamp))
        ]
        going = [entry for entry in found if not entry.running.state.is_over]
        for entry in going:
            entry.running.state = GoalState.CANCELING
            entry.work.cancel()
        if going:
            self._show()
        refused = CancelCode.GOAL_TERMINATED if found and not going else CancelCode.NONE
        return CancelGoalResponse(refused, tuple(entry.running.info for entry in going))

    def _tell(self, goal_id: GoalId, feedback: Feedback) -> None:
        self._feedback.publish(self._wire.feedback.type(goal_id, feedback))

    def _show(self) -> None:
        known = (entry.running for entry in self._goals.values())
        self._status.publish(GoalStatusArray(tuple(GoalStatus(goal.info, goal.state) for goal in known)))

    def _forget_old(self) -> None:
        over = [goal_id for goal_id, entry in self._goals.items() if entry.running.state.is_over]
        for goal_id in over[:-RESULTS_KEPT]:
            del self._goals[goal_id]
