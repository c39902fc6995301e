"""When a robot says that it has finished: once, for work that is worth it, never for what was not done."""

from __future__ import annotations

from typing import Any, Literal

import pytest

from parley.agents.chat.finishing import Finishing
from parley.messages.chat import ActionCall, Flow
from parley.messages.status import ActionInfo, PlanStep, PlanUpdate

CATALOGUE = (
    ActionInfo(name="Find", effects=("locates",)),
    ActionInfo(name="Drive", effects=("moves",)),
    ActionInfo(name="Look", effects=("looks",)),
    ActionInfo(name="Ask", effects=("asks_operator",)),
)
State = Literal["idle", "awaiting_approval", "running", "paused", "held"]


class Follower:
    """A `Finishing` with a clock of its own."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.told: list[str] = []
        self.finishing = Finishing(lambda: self.now_s)

    def plan(self, state: State, *steps: tuple[str, str], graph: str = "g1", **more: Any) -> None:
        shown = tuple(
            PlanStep.model_validate({
                "action": ActionCall(name=name.partition(" ")[0], reason=name.lower(), **more),
                "id": name, "state": state_of,
            })
            for name, state_of in steps
        )  # fmt: skip
        update = PlanUpdate(target="Ada", graph_name=graph, state=state, steps=shown)
        if text := self.finishing.on_update(update, CATALOGUE):
            self.told.append(text)


@pytest.fixture
def ada() -> Follower:
    return Follower()


def test_the_end_of_several_steps_is_told_once_by_what_was_done(ada: Follower) -> None:
    ada.plan("running", ("Find", "running"), ("Drive", "queued"))
    ada.plan("running", ("Find", "finished"), ("Drive", "running"))
    assert ada.told == []
    for _ in range(2):
        ada.plan("idle", ("Find", "finished"), ("Drive", "finished"))
    assert ada.told == ["I have finished: drive."]


def test_one_short_move_is_not_worth_a_word_but_a_long_one_is(ada: Follower) -> None:
    for seconds in (1.0, 10.0):
        ada.plan("running", ("Drive", "running"), graph=f"g{seconds}")
        ada.now_s += seconds
        ada.plan("idle", ("Drive", "finished"), graph=f"g{seconds}")
    assert ada.told == ["I have finished: drive."]


def test_looking_alone_is_answered_by_what_is_seen(ada: Follower) -> None:
    ada.plan("running", ("Look", "running"), ("Look", "queued"))
    ada.now_s += 60
    ada.plan("idle", ("Look", "finished"), ("Look", "finished"))
    assert ada.told == []


@pytest.mark.parametrize("end", ["stopped", "failed"])
def test_what_was_not_done_is_not_called_finished(ada: Follower, end: str) -> None:
    ada.plan("running", ("Drive", "running"), ("Drive", "queued"))
    ada.plan("idle", ("Drive", "finished"), ("Drive", end))
    assert ada.told == []


def test_a_step_that_its_condition_excluded_is_nothing_left_out(ada: Follower) -> None:
    ada.plan("running", ("Drive", "running"), ("Look", "queued"))
    steps = (
        PlanStep(action=ActionCall(name="Drive", reason="drive"), state="finished"),
        PlanStep(
            action=ActionCall(name="Look", flow=Flow.model_validate({"if": {"step": 0}})), state="skipped"
        ),
    )
    text = ada.finishing.on_update(PlanUpdate(target="Ada", graph_name="g1", steps=steps), CATALOGUE)
    assert text == "I have finished: drive."


def test_of_steps_that_are_alike_the_one_that_was_left_out_is_named(ada: Follower) -> None:
    ada.plan(
        "held", ("Drive", "finished"), ("Look a", "finished"), ("Look b", "failed"), ("Look c", "queued")
    )
    ada.plan("idle", ("Drive", "finished"), ("Look a", "finished"), ("Look c", "finished"))
    assert ada.told == ["I have finished. I left out: look b."]


def test_after_a_repair_that_left_the_failed_step_out_it_is_named(ada: Follower) -> None:
    ada.plan("held", ("Drive", "finished"), ("Look", "failed"))
    ada.plan("idle", ("Drive", "finished"))
    assert ada.told == ["I have finished. I left out: look."]


def test_what_a_person_skipped_is_named(ada: Follower) -> None:
    ada.plan("running", ("Drive", "running"), ("Drive", "queued"), ("Look", "queued"))
    ada.plan("idle", ("Drive", "finished"), ("Drive", "finished"), ("Look", "skipped"))
    assert ada.told == ["I have finished. I left out: look."]


def test_what_was_only_put_off_is_nothing_left_out(ada: Follower) -> None:
    ada.plan("running", ("Drive", "running"), ("Look", "queued"))
    ada.plan("idle", ("Drive", "skipped"), ("Look", "finished"), ("Drive", "finished"))
    assert ada.told == ["I have finished: look; drive."]


def test_after_a_repair_that_helped_it_is_told(ada: Follower) -> None:
    ada.plan("running", ("Drive", "running"), ("Look", "queued"))
    ada.plan("held", ("Drive", "finished"), ("Look", "failed"))
    ada.plan("running", ("Drive", "finished"), ("Drive", "queued"), ("Look", "queued"))
    ada.plan("idle", ("Drive", "finished"), ("Drive", "finished"), ("Look", "finished"))
    assert ada.told == ["I have finished: drive; look."]


def test_an_order_that_replaces_a_cancelled_one_is_named_alone(ada: Follower) -> None:
    ada.plan("running", ("Find", "running"), ("Drive", "queued"))
    ada.plan("idle", ("Find", "stopped"), ("Drive", "stopped"))
    ada.plan("running", ("Find", "running"), ("Drive", "queued"), graph="g2")
    ada.plan("idle", ("Find", "finished"), ("Drive", "finished"), graph="g2")
    assert ada.told == ["I have finished: drive."]


def test_of_many_steps_the_first_are_named(ada: Follower) -> None:
    ada.plan("running", ("Drive", "running"))
    done = tuple(PlanStep(action=ActionCall(name="Drive"), label=f"{n}", state="finished") for n in range(5))
    text = ada.finishing.on_update(PlanUpdate(target="Ada", graph_name="g1", steps=done), CATALOGUE)
    assert text == "I have finished: 0; 1; 2 and 2 more."


def test_who_does_what_a_waiting_robot_asked_for_hears_what_it_waits_for(ada: Follower) -> None:
    ada.plan("running", ("Drive", "running"), ("Ask", "queued"), ("Drive", "queued"))
    ada.plan("paused", ("Drive", "running"), ("Ask", "queued"), ("Drive", "queued"))
    ada.plan("paused", ("Drive", "finished"), ("Ask", "running"), ("Drive", "queued"))
    for state in ("paused", "finished", "finished"):
        ada.plan("paused", ("Drive", "finished"), ("Ask", state), ("Drive", "queued"))
    assert ada.told == ["I go on when you say “carry on”."]
