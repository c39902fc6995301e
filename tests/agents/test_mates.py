"""What is known of the part of another robot that is waited for: nobody's silence keeps anybody waiting."""

from __future__ import annotations

import pytest

from parley.agents.mates import UNKNOWN_FOR_S, MateBook
from parley.agents.presence import LOST_AFTER_S, Presence
from parley.messages.chat import ActionCall
from parley.messages.status import ActorStatus, PlanProposal, PlanStep, PlanUpdate
from tests.agents.test_presence import ManualClock


class Told:
    """What Kim's engine and the planner say, and what comes of it for whoever waits for its order "o"."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.presence = Presence(self.clock)
        self.book = MateBook(self.presence, self.clock)

    def engine(self, *states: str, state: str = "running") -> None:
        orders = {"o": states[0]} if states else {}
        self.book.on_status(
            ActorStatus.model_validate({"actor": "Kim", "state": state, "orders": orders}),
        )

    def planner(self, *states: str, waits: tuple[str, ...] = ()) -> None:
        call = ActionCall(name="Look")
        steps = [{"action": call, "state": state, "order": "o"} for state in states]
        read = tuple(PlanStep.model_validate(step) for step in steps)
        self.book.on_plan(PlanUpdate(target="Kim", steps=read, waits=waits))

    def after(self, seconds: float = 0.0) -> str:
        self.book.outlook("Kim", "o")
        self.clock.time_s += seconds
        return self.book.outlook("Kim", "o")


@pytest.mark.parametrize(("told", "outlook"), [("open", "open"), ("failed", "failed"), ("done", "done")])
def test_the_engine_says_how_far_it_is_whether_a_planner_is_there_or_not(told: str, outlook: str) -> None:
    kim = Told()
    kim.engine(told)
    assert kim.after(UNKNOWN_FOR_S) == outlook


def test_what_is_planned_or_waits_for_a_yes_is_to_come() -> None:
    kim = Told()
    kim.engine()
    kim.book.on_plan(PlanProposal(id="p", target="Kim", order="o"))
    kim.planner(waits=("p",))
    assert kim.after(100.0) == "open"
    kim.planner("queued", "queued")
    assert kim.after(100.0) == "open"


@pytest.mark.parametrize("what", ["left", "no", "skipped", "nobody", "silent", "stopped"])
def test_what_will_not_be_done_is_told(what: str) -> None:
    kim = Told()
    kim.engine("left" if what == "left" else "open")
    if what == "no":
        kim.book.on_plan(PlanProposal(id="p", target="Kim", order="o"))
        kim.planner(waits=())
        kim.engine()
    elif what == "skipped":
        kim.planner("finished", "skipped")
        kim.engine("open")
    elif what == "nobody":
        kim.engine()
    elif what == "silent":
        kim.clock.time_s += LOST_AFTER_S + 0.1
        kim.presence.expire()
    elif what == "stopped":
        kim.engine("open", state="leaving")
    assert kim.after(UNKNOWN_FOR_S) == "lost"


def test_a_robot_without_orders_is_waited_for_until_it_has_nothing_to_do() -> None:
    kim = Told()
    kim.engine(state="running")
    assert kim.book.outlook("Kim", "") == "open"
    kim.engine(state="idle")
    assert kim.book.outlook("Kim", "") == "done"
