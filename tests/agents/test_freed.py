"""What kept a robot from its way is told of once it does so no more, and only while that is asked about."""

from __future__ import annotations

from typing import Any

import pytest

from parley.agents.recovery.freed import Freed
from parley.errors import FailureCode
from parley.messages.chat import ActionCall
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.passages import PassageList, PassageState
from parley.messages.status import ActorStatus, PoseInfo


def failed(**details: Any) -> ErrorHandlingMessage:
    return ErrorHandlingMessage(
        target="A", action_called=ActionCall(name="Drive"), error_message="No way.", code=FailureCode.BLOCKED,
        details=details,
    )  # fmt: skip


def at(robot: str, x: float) -> ActorStatus:
    return ActorStatus(actor=robot, state="idle", pose=PoseInfo(x=x, y=0.0, yaw=0.0))


def there(*robots: str) -> PassageList:
    return PassageList(places=(PassageState(name="lift", robots=robots),) if robots else ())


@pytest.fixture
def told() -> list[str]:
    return []


@pytest.fixture
def freed(told: list[str]) -> Freed:
    return Freed(lambda robot, text: told.append(f"{robot}: {text}"))


def test_a_place_is_free_once_nobody_else_is_in_it(freed: Freed, told: list[str]) -> None:
    freed.on_failure(failed(taken="lift"))
    freed.on_passages(there("B"))
    freed.on_asked("A")
    freed.on_passages(there("B", "A"))
    assert told == []
    freed.on_passages(there("A"))
    freed.on_passages(there())
    assert told == ["A: “lift” is free now. Say “try again” and I go on."]


def test_another_robot_in_the_way_is_out_of_it_when_it_is_away(freed: Freed, told: list[str]) -> None:
    for robot, x in (("A", 0.0), ("B", 5.0), ("C", 9.0)):
        freed.on_status(at(robot, x))
    freed.on_failure(failed(at={"x": 4.5, "y": 0.0}))
    freed.on_asked("A")
    freed.on_status(at("C", 20.0))
    freed.on_status(at("B", 5.5))
    assert told == []
    freed.on_status(at("B", 8.0))
    assert told == ["A: B is out of the way now. Say “try again” and I go on."]


def test_before_it_is_asked_and_after_it_is_settled_nothing_is_told(freed: Freed, told: list[str]) -> None:
    freed.on_failure(failed(taken="lift"))
    freed.on_passages(there())
    assert told == []
    freed.on_asked("A")
    assert len(told) == 1
    freed.on_passages(there("B"))
    freed.on_failure(failed(taken="lift"))
    freed.on_asked("A")
    freed.forget("A")
    freed.on_passages(there())
    freed.on_failure(failed(at={"x": 4.5, "y": 0.0}))  # a thing that nobody knows of
    freed.on_asked("A")
    assert len(told) == 1
