"""The one place where JSON text becomes typed payloads and back.

Nodes parse here, at the border, and hand plain objects on.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final, TypeVar, cast

from pydantic import BaseModel, ValidationError
from pydantic_core import to_json

from parley.errors import InvalidMessageError
from parley.messages.chat import ChatAction
from parley.messages.ros import String
from parley.messages.status import PlanProposal, PlanUpdate

__all__ = [
    "MAX_MESSAGE_CHARS",
    "MAX_NESTING",
    "decode",
    "decode_plan",
    "encode",
    "load_json",
    "to_string",
    "to_string_unchecked",
]

P = TypeVar("P", bound=BaseModel)

MAX_NESTING = 100
"""How deep objects and arrays may stand inside each other."""

MAX_MESSAGE_CHARS = 32 * 1024 * 1024
"""Larger texts are refused unread: the largest honest message is a raw picture."""

KEPT_CHARS = 1024 * 1024
"""Of larger texts nothing is kept for the next reader."""


def decode_plan(text: str) -> PlanUpdate | PlanProposal:
    """A message of the plan topic by its `kind`; any other kind is an update, whose check names the fault.

    Raises:
        InvalidMessageError: It is neither; names the field.
    """
    return cast(PlanUpdate | PlanProposal, _payload(None, text))


def encode(payload: BaseModel) -> str:
    """The JSON text of a payload."""
    if isinstance(payload, ChatAction):
        return json.dumps(payload.to_wire(), ensure_ascii=False)
    return payload.model_dump_json(by_alias=True)


def to_string(payload: BaseModel) -> String:
    """The payload as a std_msgs/String."""
    return String(encode(payload))


def to_string_unchecked(fields: Mapping[str, Any]) -> String:
    """As `to_string`, for a payload of which very many are sent, given as what its JSON is to hold.

    Args:
        fields: Its fields by name, as JSON can hold them; whoever calls this vouches for their types.

    Raises:
        ValueError: Something in it cannot be written.
    """
    return String(to_json(fields).decode())


def decode(kind: type[P], text: str) -> P:
    """Parse `text` into a payload of type `kind`.

    Raises:
        InvalidMessageError: Not JSON, or a field is missing or wrong; names the first such field.
    """
    return cast(P, _payload(kind, text))


def _payload(kind: type[BaseModel] | None, text: str) -> BaseModel:
    """See `decode`, and for no kind `decode_plan`."""
    return _read(kind, text) if len(text) <= KEPT_CHARS else _read.__wrapped__(kind, text)


@lru_cache(maxsize=16)
def _read(kind: type[BaseModel] | None, text: str) -> BaseModel:
    """Payloads are frozen, so each is made once for all who read it in this process."""
    value = load_json(kind.__name__ if kind else "Plan", text)
    if kind is None:
        is_proposal = isinstance(value, dict) and value.get("kind") == "proposal"
        kind = PlanProposal if is_proposal else PlanUpdate
    try:
        return kind.model_validate(value)
    except ValidationError as error:
        errors = error.errors(include_url=False, include_input=False)
        field = errors[0]["loc"][:1]
        # Where a field may be one of several things, the attempt that came furthest says what is wrong.
        told = max((item for item in errors if item["loc"][:1] == field), key=lambda item: len(item["loc"]))
        path = ".".join(str(part) for part in told["loc"])
        raise InvalidMessageError(kind.__name__, path, told["msg"]) from error


def load_json(what: str, text: str) -> Any:
    """Parse JSON text; NaN, infinities and halves of characters are refused, as in JSON itself.

    Raises:
        InvalidMessageError: It is too large, nested too deeply or not JSON; says where.
    """
    if len(text) > MAX_MESSAGE_CHARS:
        raise InvalidMessageError(
            what, "", f"{len(text)} characters is more than the {MAX_MESSAGE_CHARS} allowed"
        )
    try:
        value = _parse(text)
        _check_nesting(text, value)
        _check_characters(text, value)
    except RecursionError as error:
        raise InvalidMessageError(what, "", "nested too deeply") from error
    except ValueError as error:
        raise InvalidMessageError(what, "", f"not valid JSON: {error}") from error
    return value


def _refuse_constant(name: str) -> Any:
    raise ValueError(f"{name} is not allowed")


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is too large a number")
    return number


_parse: Final = json.JSONDecoder(parse_constant=_refuse_constant, parse_float=_finite).decode
"""Made once, as making it takes as long as reading a short message."""


def _check_nesting(text: str, value: Any) -> None:
    """Refuse what could be read, but not written again."""
    if text.count("[") + text.count("{") <= MAX_NESTING:
        return
    level = [value]
    for _ in range(MAX_NESTING):
        inner = [item.values() if isinstance(item, dict) else item for item in level]
        level = [child for items in inner for child in items if isinstance(child, dict | list)]
        if not level:
            return
    raise RecursionError


def _check_characters(text: str, value: Any) -> None:
    """Refuse halves of surrogate pairs: nothing downstream (UTF-8, SQLite) can hold them."""
    # One character is found much sooner than two.
    if text.isascii() and ("\\" not in text or "\\u" not in text):
        return
    try:
        json.dumps(value, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        raise ValueError("it holds half a character (a lone surrogate)") from error
