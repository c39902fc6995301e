"""What becomes of plans when nobody is connected."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from parley.agents.planner.unattended import LATE_S, PRESENCE, SILENT_S, Absence, UnattendedPlans
from parley.messages import topics
from parley.messages.attendance import Attendance, Unattended
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput
from parley.messages.ros import String
from parley.messages.status import ActorStatus, PlanStep, PlanUpdate, PoseInfo
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport
from tests.web.rig import HandClock, Robots

AFTER_S = 30.0


def test_nobody_is_absent_where_no_server_would_know() -> None:
    assert Absence().since_s(100.0) is None


def test_absence_counts_from_the_last_person_of_all_servers() -> None:
    absence = Absence()
    absence.heard(Attendance(server="1", people=1), 0.0)
    absence.heard(Attendance(server="2", people=0), 0.0)
    assert absence.since_s(1.0) is None
    absence.heard(Attendance(server="1", people=0), 2.0)
    assert absence.since_s(3.0) == 3.0
    assert absence.since_s(9.0) == 3.0
    absence.heard(Attendance(server="2", people=1), 10.0)
    assert absence.since_s(10.0) is None


def test_through_a_server_that_is_silent_nobody_is_connected() -> None:
    absence = Absence()
    absence.heard(Attendance(server="1", people=1), 0.0)
    assert absence.since_s(SILENT_S) is None
    assert absence.since_s(SILENT_S + 1) == SILENT_S + 1


class Ward:
    """A node with its clock, and what it did."""

    def __init__(self, transport: LocalTransport, choice: Unattended) -> None:
        self.clock = HandClock()
        self.node = UnattendedPlans(transport, self.clock, choice, AFTER_S)
        self.robots = Robots(transport)
        self.orders: list[ChatAction] = []
        self.said: list[ChatFeedback] = []

    async def open(self, transport: LocalTransport) -> None:
        def hear(message: String) -> None:
            self.said.append(decode(ChatFeedback, message.data))

        await transport.subscribe(topics.CHAT_FEEDBACK, hear)
        await self.robots.listen()
        self.orders = self.robots.orders

    def people(self, count: int) -> None:
        self.robots.tell(topics.ATTENDANCE, Attendance(server="1", people=count))

    async def alone(self, for_s: float = AFTER_S) -> None:
        """Everybody hangs up, and time passes."""
        self.people(0)
        await settled()
        self.clock.ahead_s += for_s
        self.node.look()
        await settled()


async def settled() -> None:
    for _ in range(20):
        await asyncio.sleep(0)


@asynccontextmanager
async def ward(choice: Unattended = "go_on", order: Unattended | None = None) -> AsyncIterator[Ward]:
    """Robot A carries out a plan, and one person is connected."""
    async with LocalTransport() as transport:
        ward = Ward(transport, choice)
        await ward.open(transport)
        async with ward.node:
            tell = ward.robots.tell
            tell(topics.ACTOR_STATUS, ActorStatus(actor="A", pose=PoseInfo(x=1.0, y=2.0, yaw=0.5)))
            tell(topics.CHAT_INPUT, ChatInput(message="go", targets=("A",), unattended=order))
            transport.publisher(topics.PLAN).publish(to_string(PlanUpdate(target="A", state="running")))
            ward.people(1)
            await settled()
            yield ward
        assert transport.handler_failures == 0


async def test_by_default_a_robot_goes_on_and_says_so_once() -> None:
    async with ward() as here:
        await here.alone()
        await here.alone()
        assert here.orders == []
        assert [said.message.split(".")[0] for said in here.said] == ["Nobody is connected any more"]


async def test_who_would_have_to_ask_before_it_goes_home_waits_where_it_is() -> None:
    async with ward("go_home") as here:
        update = PlanUpdate(target="A", state="running", policy="ask_first")
        here.robots.tell(topics.PLAN, update)
        await settled()
        await here.alone()
        assert [[command.command for command in order.system_cmd] for order in here.orders] == [["stop"]]
        assert "so I wait here" in here.said[-1].message


async def test_nobody_says_that_a_robot_goes_on_which_is_gone() -> None:
    async with ward() as here:
        here.robots.tell(topics.ACTOR_STATUS, ActorStatus(actor="A", state="leaving"))
        await here.alone()
        assert here.said == []


@pytest.mark.parametrize(("choice", "order"), [("hold", None), ("go_on", "hold")])
async def test_a_robot_waits_if_the_system_or_the_order_says_so(
    choice: Unattended, order: Unattended | None
) -> None:
    async with ward(choice, order) as here:
        await here.alone(AFTER_S - 1)
        assert here.orders == []
        here.clock.ahead_s += 1
        here.node.look()
        await settled()
        (stop,) = here.orders
        assert ([command.command for command in stop.system_cmd], stop.targets) == (["stop"], ("A",))
        assert stop.by == PRESENCE


async def test_a_robot_goes_home_where_it_stood_first() -> None:
    async with ward("go_home") as here:
        await here.alone()
        (home,) = here.orders
        assert [command.command for command in home.system_cmd] == ["clear"]
        pose = home.queue[0].input_parameters
        assert (pose["pose::position::x"].value, pose["pose::position::y"].value) == (1.0, 2.0)


async def test_what_is_understood_only_after_everybody_has_gone_is_not_done_far_from_home() -> None:
    async with ward("go_home") as here:
        await here.alone()
        drive = ActionCall(name="NavigateTo")
        for states in (
            ("stopped",),
            ("running",),
            ("finished",),
            ("finished", "running"),
        ):  # home; a late order
            steps = tuple(PlanStep.model_validate({"action": drive, "state": state}) for state in states)
            state = "running" if "running" in states else "idle"
            update = PlanUpdate.model_validate({"target": "A", "state": state, "steps": steps})
            here.robots.tell(topics.PLAN, update)
            await settled()
            here.node.look()
            await settled()
            assert len(here.orders) == (2 if len(states) == 2 else 1), states
        assert [command.command for command in here.orders[1].system_cmd] == ["clear"]


async def test_somebody_who_is_back_in_time_changes_nothing() -> None:
    async with ward("hold") as here:
        await here.alone(AFTER_S - 1)
        here.people(1)
        await settled()
        here.clock.ahead_s += AFTER_S
        here.people(1)
        await settled()
        here.node.look()
        await settled()
        assert here.orders == []


@pytest.mark.parametrize(("after_s", "waits"), [(LATE_S - 1, True), (LATE_S, False)])
async def test_who_orders_where_nobody_is_connected_needs_no_page(after_s: float, *, waits: bool) -> None:
    async with ward("hold") as here:
        here.robots.tell(topics.PLAN, PlanUpdate(target="A", state="idle"))
        await here.alone(after_s)
        here.robots.tell(topics.CHAT_INPUT, ChatInput(message="go", targets=("A",)))
        here.robots.tell(topics.PLAN, PlanUpdate(target="A", state="running"))
        await settled()
        await here.alone()
        assert bool(here.orders) is waits
        assert bool(here.said) is waits


async def test_whoever_looks_in_later_and_hangs_up_leaves_it_alone_again() -> None:
    async with ward("hold") as here:
        await here.alone(LATE_S)
        here.robots.tell(topics.CHAT_INPUT, ChatInput(message="go", targets=("A",)))
        await settled()
        here.people(1)
        await settled()
        await here.alone()
        assert len(here.orders) == 1
