"""How a service of ROS says that it failed: ROS has no word for that, so the answer says it if it can.

Of a service that has no place for it the caller hears nothing, and waits its time.
"""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

from parley.messages.ros import ChatResponse

__all__ = ["failure_in", "failure_of"]

Res = TypeVar("Res")

_KEY = "error"


def failure_of(kind: type[Res], why: str) -> Res | None:
    """The answer that says so; None: this kind of answer has no place for it.

    Args:
        kind: Of the answers of the service. JSON as `{"error": ...}`; `success` false with a `message`, as
            std_srvs have it.
        why: The reason.
    """
    made: Any = kind
    if kind is ChatResponse:
        return made(json.dumps({_KEY: why}))  # type: ignore[no-any-return]
    names = {field.name for field in fields(made)} if is_dataclass(kind) else set()
    if {"success", "message"} <= names:
        return made(success=False, message=why)  # type: ignore[no-any-return]
    return None


def failure_in(answer: object) -> str:
    """Why a service failed, by its answer; empty: it did not, or says it in words of its own."""
    if not isinstance(answer, ChatResponse) or not answer.response.startswith(f'{{"{_KEY}"'):
        return ""
    try:
        told = json.loads(answer.response)
    except ValueError:
        return ""
    alone = isinstance(told, dict) and told.keys() == {_KEY} and isinstance(told[_KEY], str)
    return told[_KEY] if alone else ""
