"""Robots that stand still for words of stopping, by what is sent to the stop line."""

from __future__ import annotations

from parley.agents.chat.holds import Holds
from parley.messages.chat import ChatInput
from parley.messages.status import StopCommand


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
