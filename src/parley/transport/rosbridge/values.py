"""Our messages as rosbridge writes them in JSON, and back: bytes in base64, no number is null."""

from __future__ import annotations

import base64
import binascii
import math
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, Final, Generic, Literal, TypeVar, get_args, get_origin, get_type_hints

from parley.errors import TypeMismatchError
from parley.messages.ros import Duration, Time

__all__ = ["Codec", "Ros", "spelt"]

M = TypeVar("M")

Ros = Literal[1, 2]
"""The generation of ROS behind the bridge."""

Read = Callable[[Any, str], Any]
"""From JSON; gets also where it stands."""
Write = Callable[[Any], Any]

_SPOILED: Final = 80
"""So much of a value that cannot be read is told."""


def spelt(ros_type: str, ros: Ros) -> str:
    """A type's name as this generation of ROS has it: `std_msgs/msg/String`, `std_msgs/String`."""
    package, _, name = ros_type.partition("/")
    return f"{package}/{name.rpartition('/')[2]}" if ros == 1 else ros_type


class Codec(Generic[M]):
    """Writes and reads one type.

    Args:
        python_type: The frozen dataclass of the message, with the fields of its definition.
        ros_type: Its name, for complaints.
        ros: Whose spelling; ROS 1 calls the parts of a time otherwise.
    """

    def __init__(self, python_type: type[M], ros_type: str, ros: Ros = 2) -> None:
        self._type, self._ros_type = python_type, ros_type
        self._write, self._read = _converters(python_type, ros)

    def encode(self, message: M) -> dict[str, Any]:
        """The JSON object of `message`.

        Raises:
            TypeMismatchError: A value is none that its field can carry.
        """
        try:
            encoded: dict[str, Any] = self._write(message)
        except (TypeError, ValueError, AttributeError) as error:
            raise TypeMismatchError(f"{self._ros_type} cannot carry this message: {error}") from error
        return encoded

    def decode(self, value: Any) -> M:
        """The message in a JSON value. Fields that are not known are passed over: releases differ.

        Raises:
            TypeMismatchError: It is no such message; names the field.
        """
        message: M = self._read(value, self._ros_type)
        return message


def _converters(hint: Any, ros: Ros) -> tuple[Write, Read]:
    if hint in _SIMPLE:
        return _SIMPLE[hint]
    if is_dataclass(hint):
        return _object(hint, ros)
    if get_origin(hint) is tuple:
        inner = get_args(hint)[0]
        write, read = _converters(inner, ros)
        if inner in (int, str, bool):
            return list, _many(read)
        return lambda items: [write(item) for item in items], _many(read)
    raise TypeMismatchError(f"rosbridge has nothing for {hint}")


def _object(kind: Any, ros: Ros) -> tuple[Write, Read]:
    hints = get_type_hints(kind)
    told = _ROS_1.get(kind, {}) if ros == 1 else {}
    both = [
        (field.name, told.get(field.name, field.name), *_converters(hints[field.name], ros))
        for field in fields(kind)
    ]

    def write(message: Any) -> Any:
        return {wire: out(getattr(message, name)) for name, wire, out, _ in both}

    def read(value: Any, where: str) -> Any:
        if not isinstance(value, dict):
            raise _wrong(where, "an object", value)
        for _, wire, _, _ in both:
            if wire not in value:
                raise TypeMismatchError(f"{where}.{wire} is missing")
        return kind(**{name: back(value[wire], f"{where}.{wire}") for name, wire, _, back in both})

    return write, read


_TIMES: Final = {"sec": "secs", "nanosec": "nsecs"}
_ROS_1: Final[dict[Any, dict[str, str]]] = {Time: _TIMES, Duration: _TIMES}


def _many(read: Read) -> Read:
    def read_many(value: Any, where: str) -> Any:
        if not isinstance(value, list):
            raise _wrong(where, "a list", value)
        return tuple(read(item, where) for item in value)

    return read_many


def _read_float(value: Any, where: str) -> float:
    if value is None:  # what JSON cannot say
        return math.nan
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _wrong(where, "a number", value)
    return float(value)


def _write_float(value: Any) -> float | None:
    return float(value) if math.isfinite(value) else None


def _read_bytes(value: Any, where: str) -> bytes:
    try:
        return base64.b64decode(value, validate=True) if isinstance(value, str) else bytes(value)
    except (binascii.Error, ValueError, TypeError) as error:
        raise _wrong(where, "bytes in base64", value) from error


def _exactly(kind: type, words: str) -> Read:
    def read(value: Any, where: str) -> Any:
        if type(value) is not kind:
            raise _wrong(where, words, value)
        return value

    return read


def _wrong(where: str, expected: str, value: Any) -> TypeMismatchError:
    return TypeMismatchError(f"{where} should be {expected}, not {value!r:.{_SPOILED}}")


_SIMPLE: Final[dict[Any, tuple[Write, Read]]] = {
    bool: (bool, _exactly(bool, "true or false")),
    int: (int, _exactly(int, "a whole number")),
    str: (str, _exactly(str, "a text")),
    float: (_write_float, _read_float),
    bytes: (lambda data: base64.b64encode(data).decode(), _read_bytes),
}
