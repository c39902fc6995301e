"""Robots that stand still for words of stopping, by what is sent to the stop line."""

from __future__ import annotations

from typing import Literal

import pytest

from parley.agents.chat.holds import Holds
from parley.messages.chat import ChatInput
from parley.messages.status import ActorStatus, PlanUpdate, StopCommand


def test_between_two_calls_to_stop_nothing_lets_the_robot_go_on() -> None:
    sent: list[StopCommand] = []
    holds, held = Holds(sent.append), set[str]()
    for number in range(3):
        holds.keep("A", ChatInput(message="stop", targets=("A",), id=f"m{number}"))
        while sent:
            command = sent.pop(0)
            (held.add if command.command == "hold" else held.discard)(command.id)
            assert held
    assert len(held) == 1


@pytest.mark.parametrize("state", ["paused", "running"])
def test_what_somebody_who_is_gone_holds_a_robot_by_ends_when_it_may_go_on(
    state: Literal["paused", "running"],
) -> None:
    sent: list[StopCommand] = []
    holds = Holds(sent.append)
    met = ActorStatus(actor="A", state=state, holds=("m1/A", "q7"))
    assert holds.on_status(met) == (state == "running"), "it has to be paused"
    assert not holds.on_status(met)
    holds.on_update(PlanUpdate(target="A", graph_name="g", state="running"))
    holds.on_update(PlanUpdate(target="A", graph_name="g", state="paused"))
    assert sent == []
    holds.on_update(PlanUpdate(target="A", graph_name="g", state="running"))
    assert [(command.command, command.id) for command in sent] == [("go_on", "m1/A"), ("go_on", "q7")]
