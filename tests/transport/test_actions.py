"""What every backend promises of actions, with the action server that stands in for a robot."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field

import pytest

from parley.clock import WallClock
from parley.errors import GoalRefusedError, TransportError, TransportTimeoutError, UnavailableError
from parley.messages.actions import (
    Action,
    ActionWire,
    CancelCode,
    CancelGoalRequest,
    GoalId,
    GoalInfo,
    GoalState,
)
from parley.messages.ros import Time
from parley.transport.actions import RESULTS_KEPT, ActionServer, CallingActionClient, RunningGoal
from parley.transport.base import Outcome, SentGoal
from tests.transport.backends import Network, until


@dataclass(frozen=True, slots=True)
class Duration:
    sec: int = 0
    nanosec: int = 0


@dataclass(frozen=True, slots=True)
class WaitGoal:
    time: Duration = field(default_factory=Duration)


@dataclass(frozen=True, slots=True)
class WaitResult:
    total_elapsed_time: Duration = field(default_factory=Duration)
    error_code: int = 0
    error_msg: str = ""


@dataclass(frozen=True, slots=True)
class WaitFeedback:
    time_left: Duration = field(default_factory=Duration)


WAIT = Action("contract/wait", WaitGoal, WaitResult, WaitFeedback, "nav2_msgs/action/Wait")
TEN = WaitGoal(Duration(10))


class Waiter:
    """Carries out goals of waiting; of 0 s fails, of 9 s breaks, others go on when told."""

    def __init__(self) -> None:
        self.begun: list[int] = []
        self.go_on = asyncio.Event()

    async def __call__(self, running: RunningGoal[WaitGoal, WaitFeedback]) -> Outcome[WaitResult]:
        asked = running.goal.time.sec
        self.begun.append(asked)
        if asked == 0:
            return Outcome(GoalState.ABORTED, WaitResult(Duration(0, 5)))
        if asked == 9:
            raise ValueError("a defect of the server")
        for left in (2, 1):
            running.feedback(WaitFeedback(Duration(left)))
        await self.go_on.wait()
        return Outcome(GoalState.SUCCEEDED, WaitResult(Duration(asked)))


@asynccontextmanager
async def waiting(network: Network) -> AsyncIterator[Waiter]:
    waiter = Waiter()
    async with ActionServer(network.there, WAIT, waiter, WallClock(), takes=lambda goal: goal.time.sec >= 0):
        await until(lambda: any(end.name.endswith("send_goal") for end in network.here.endpoints()))
        yield waiter


async def ended(sent: SentGoal[WaitResult]) -> Outcome[WaitResult]:
    return await sent.outcome(timeout_s=5.0)


async def test_a_goal_tells_how_it_goes_and_then_its_result(network: Network) -> None:
    heard: list[int] = []
    async with waiting(network) as waiter:
        client = await network.here.action_client(WAIT)
        sent = await client.send(
            TEN, timeout_s=5.0, on_feedback=lambda told: heard.append(told.time_left.sec)
        )
        await until(lambda: len(heard) == 2)
        assert not sent.state.is_over
        waiter.go_on.set()
        assert await ended(sent) == Outcome(GoalState.SUCCEEDED, WaitResult(Duration(10)))
        assert sent.state.is_over
        await client.close()
        await client.close()
    assert heard == [2, 1]


async def test_two_goals_hear_each_of_itself(network: Network) -> None:
    heard: tuple[list[WaitFeedback], list[WaitFeedback]] = ([], [])
    async with waiting(network) as waiter:
        client = await network.here.action_client(WAIT)
        sent = [
            await client.send(goal, timeout_s=5.0, on_feedback=own.append)
            for goal, own in zip((TEN, WaitGoal(Duration(20))), heard, strict=True)
        ]
        await until(lambda: all(len(own) == 2 for own in heard))
        assert await sent[0].cancel(timeout_s=5.0)
        assert (await ended(sent[0])).state is GoalState.CANCELED
        waiter.go_on.set()
        assert await ended(sent[1]) == Outcome(GoalState.SUCCEEDED, WaitResult(Duration(20)))
    assert [len(own) for own in heard] == [2, 2]


async def test_a_goal_that_is_called_off_ends_canceled_and_cannot_be_called_off_again(
    network: Network,
) -> None:
    async with waiting(network):
        client = await network.here.action_client(WAIT)
        sent = await client.send(TEN, timeout_s=5.0)
        assert await sent.cancel(timeout_s=5.0)
        assert await ended(sent) == Outcome(GoalState.CANCELED, WaitResult())
        assert not await sent.cancel(timeout_s=5.0)


async def test_a_goal_that_cannot_be_reached_ends_aborted_with_what_the_server_says(network: Network) -> None:
    async with waiting(network):
        client = await network.here.action_client(WAIT)
        sent = await client.send(WaitGoal(), timeout_s=5.0)
        assert await ended(sent) == Outcome(GoalState.ABORTED, WaitResult(Duration(0, 5)))
        broken = await client.send(WaitGoal(Duration(9)), timeout_s=5.0)
        assert await ended(broken) == Outcome(GoalState.ABORTED, WaitResult())


async def test_a_goal_that_is_not_taken_is_refused(network: Network) -> None:
    async with waiting(network) as waiter:
        client = await network.here.action_client(WAIT)
        refused, within_s = (GoalRefusedError, 5.0) if network.says_no else (TransportTimeoutError, 1.0)
        with pytest.raises(refused, match="contract/wait"):
            await client.send(WaitGoal(Duration(-1)), timeout_s=within_s)
        assert waiter.begun == []


async def test_a_goal_nobody_serves_says_so_at_once(network: Network) -> None:
    client = await network.here.action_client(WAIT)
    said, within_s = (UnavailableError, 60.0) if network.says_no else (TransportError, 1.0)
    with pytest.raises(said, match="contract/wait"):
        await client.send(TEN, timeout_s=within_s)


async def test_waiting_for_the_outcome_may_be_given_up_and_taken_up_again(network: Network) -> None:
    async with waiting(network) as waiter:
        client = await network.here.action_client(WAIT)
        sent = await client.send(TEN, timeout_s=5.0)
        with pytest.raises(TransportTimeoutError):
            await sent.outcome(timeout_s=0.02)
        waiter.go_on.set()
        assert (await ended(sent)).state is GoalState.SUCCEEDED


async def test_a_server_that_closes_ends_the_waiting_for_its_goals(network: Network) -> None:
    async with waiting(network):
        client = await network.here.action_client(WAIT)
        sent = await client.send(TEN, timeout_s=5.0)
        outcome = asyncio.create_task(sent.outcome(timeout_s=60.0 if network.says_no else 1.0))
        await asyncio.sleep(0.01)
    # What it is told depends on which is quicker, the answer or the parting; it is never left waiting.
    with suppress(TransportError):
        assert (await outcome).state is GoalState.ABORTED


async def test_who_comes_later_sees_where_goals_stand(network: Network) -> None:
    seen: list[int] = []
    async with waiting(network):
        client = await network.here.action_client(WAIT)
        await client.send(TEN, timeout_s=5.0)
        await network.here.subscribe(
            ActionWire(WAIT).status, lambda told: seen.extend(goal.status for goal in told.status_list)
        )
        await until(lambda: seen)
    assert seen[0] == GoalState.EXECUTING


async def test_goals_are_called_off_all_at_once_or_up_to_a_time(network: Network) -> None:
    cancel = ActionWire(WAIT).cancel
    async with waiting(network):
        client = await network.here.action_client(WAIT)
        goals = [await client.send(TEN, timeout_s=5.0) for _ in range(2)]

        async def call_off(info: GoalInfo) -> tuple[int, int]:
            answer = await network.here.call(cancel, CancelGoalRequest(info), timeout_s=5.0)
            return answer.return_code, len(answer.goals_canceling)

        assert await call_off(GoalInfo(GoalId(b"x" * 16))) == (CancelCode.UNKNOWN_GOAL_ID, 0)
        assert await call_off(GoalInfo(stamp=Time(1))) == (CancelCode.NONE, 0)
        assert await call_off(GoalInfo()) == (CancelCode.NONE, 2)
        assert [(await ended(goal)).state for goal in goals] == [GoalState.CANCELED] * 2
        assert await call_off(GoalInfo()) == (CancelCode.GOAL_TERMINATED, 0)


async def test_of_goals_long_over_the_server_knows_nothing(network: Network) -> None:
    if not network.says_no:
        pytest.skip("its results cannot be asked for apart from its goals")
    async with waiting(network):
        client = CallingActionClient(network.here, WAIT)  # which asks for results when it is asked itself
        await client.open()
        sent = [await client.send(WaitGoal(), timeout_s=5.0) for _ in range(RESULTS_KEPT + 1)]
        assert (await ended(sent[-1])).state is GoalState.ABORTED
        assert (await ended(sent[0])).state is GoalState.UNKNOWN
