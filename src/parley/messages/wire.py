"""The one place where JSON text becomes typed payloads and back.

Nodes parse here, at the border, and hand plain objects on.
"""

from __future__ import annotations

import json
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from parley.errors import InvalidMessageError
from parley.messages.chat import ChatAction
from parley.messages.ros import String

__all__ = ["MAX_MESSAGE_CHARS", "decode", "encode", "load_json", "to_string"]

P = TypeVar("P", bound=BaseModel)

MAX_MESSAGE_CHARS = 32 * 1024 * 1024
"""Larger texts are refused unread: the largest honest message is a raw picture."""


def encode(payload: BaseModel) -> str:
    """The JSON text of a payload."""
    if isinstance(payload, ChatAction):
        return json.dumps(payload.to_wire(), ensure_ascii=False)
    return payload.model_dump_json(by_alias=True)


def to_string(payload: BaseModel) -> String:
    """The payload as a std_msgs/String."""
    return String(encode(payload))


def decode(kind: type[P], text: str) -> P:
    """Parse `text` into a payload of type `kind`.

    Raises:
        InvalidMessageError: Not JSON, or a field is missing or wrong; names the first such field.
    """
    value = load_json(kind.__name__, text)
    try:
        return kind.model_validate(value)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        path = ".".join(str(part) for part in first["loc"])
        raise InvalidMessageError(kind.__name__, path, first["msg"]) from error


def load_json(what: str, text: str) -> Any:
    """Parse JSON text; NaN and infinities are refused as JSON itself does.

    Raises:
        InvalidMessageError: It is too large or not JSON; says where.
    """
    if len(text) > MAX_MESSAGE_CHARS:
        raise InvalidMessageError(
            what, "", f"{len(text)} characters is more than the {MAX_MESSAGE_CHARS} allowed"
        )
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except RecursionError as error:
        raise InvalidMessageError(what, "", "nested too deeply") from error
    except ValueError as error:
        raise InvalidMessageError(what, "", f"not valid JSON: {error}") from error


def _refuse_constant(name: str) -> Any:
    raise ValueError(f"{name} is not allowed")
