"""Actions that fail as a story says."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from parley.demos.faults import Fault, with_faults
from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import RunHandle, action

BLOCKED = Fault(code=FailureCode.BLOCKED, message="A box.", details={"by": "box"})


@action()
async def look(ctx: RunHandle, what: str) -> bool:
    """Look at something."""
    return what == "box"


def handle(actor: str) -> Any:
    return SimpleNamespace(actor=actor)


async def test_action_fails_as_often_as_said_and_then_works() -> None:
    (failing,) = with_faults([look.spec], {"Look": [BLOCKED]})
    assert failing.run is not None
    with pytest.raises(ActionFailure, match="A box") as caught:
        await failing.run(handle("A"), what="box")
    assert (caught.value.code, caught.value.details) == (FailureCode.BLOCKED, {"by": "box"})
    assert await failing.run(handle("A"), what="box") is True


async def test_fault_of_one_robot_leaves_the_others_alone() -> None:
    (failing,) = with_faults([look.spec], {"Look": [BLOCKED.model_copy(update={"robot": "B"})]})
    assert failing.run is not None
    assert await failing.run(handle("A"), what="box") is True
    with pytest.raises(ActionFailure):
        await failing.run(handle("B"), what="box")


def test_other_actions_stay_as_they_are() -> None:
    assert with_faults([look.spec], {"Other": [BLOCKED]}) == (look.spec,)
