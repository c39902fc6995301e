"""Failures as data: actions that fail as a story says, to see what becomes of it."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import ActionSpec

__all__ = ["Fault", "with_faults"]


class Fault(BaseModel):
    """One failure of one action, instead of a run of it."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    code: FailureCode
    message: str
    details: dict[str, Any] = Field(default_factory=dict)
    robot: str = ""
    """Only this robot's; empty: whichever runs it first."""


def with_faults(specs: Sequence[ActionSpec], faults: Mapping[str, Sequence[Fault]]) -> tuple[ActionSpec, ...]:
    """The actions, of which those named in `faults` fail in the given order and then work again."""
    return tuple(_failing(spec, faults[spec.name]) if spec.name in faults else spec for spec in specs)


def _failing(spec: ActionSpec, faults: Sequence[Fault]) -> ActionSpec:
    run = spec.run
    if run is None:
        raise ValueError(f"{spec.name} has nothing that could be run or fail")
    waiting = deque(faults)

    async def failing(context: Any, **inputs: Any) -> Any:
        fault = next((f for f in waiting if f.robot in ("", context.actor)), None)
        if fault is not None:
            waiting.remove(fault)
            raise ActionFailure(fault.code, fault.message, fault.details)
        return await run(context, **inputs)

    return replace(spec, run=failing)
