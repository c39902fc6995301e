"""How a service says that it failed where its network has no word for that."""

from __future__ import annotations

from dataclasses import dataclass

from parley.messages.actions import CancelGoalResponse
from parley.messages.ros import ChatResponse
from parley.transport.failures import failure_in, failure_of


@dataclass(frozen=True)
class Trigger:
    success: bool = True
    message: str = ""


def test_a_failure_is_said_in_the_answer_where_that_has_a_place_for_it() -> None:
    told = failure_of(ChatResponse, 'no "disk"')
    assert told == ChatResponse('{"error": "no \\"disk\\""}')
    assert failure_in(told) == 'no "disk"'
    assert failure_of(Trigger, "no disk") == Trigger(False, "no disk")
    assert failure_of(CancelGoalResponse, "no disk") is None


def test_an_answer_is_not_taken_for_a_failure() -> None:
    for text in (
        "",
        "error",
        '{"error": "x", "box": {}}',
        '{"error": "x"',
        '["error"]',
        '{"error": {"type": "text"}}',
        '{"errors": []}',
    ):
        assert failure_in(ChatResponse(text)) == ""
    assert failure_in(Trigger(False, "no")) == ""
