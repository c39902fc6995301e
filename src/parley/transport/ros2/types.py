"""Our messages as the classes that ROS generates, and back, by what those say of their fields."""

from __future__ import annotations

import importlib
from array import array
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, Final, Generic, TypeVar, get_args, get_type_hints

import numpy as np

from parley.errors import TypeMismatchError, UnsupportedError

__all__ = ["Codec", "ros_class"]

M = TypeVar("M")

Convert = Callable[[Any], Any]

_OF_ACTIONS: Final = {
    "SendGoal": "SendGoalService", "GetResult": "GetResultService", "FeedbackMessage": "FeedbackMessage",
}  # fmt: skip
"""What of an action has a class of its own: by our names, and by those that ROS has for it."""


def ros_class(ros_type: str) -> Any:
    """The class of a message, a service, an action, or a part of these, by a name as `std_msgs/msg/String`.

    Raises:
        UnsupportedError: It is not built or not sourced.
    """
    service, _, part = ros_type.rpartition("_")
    if part in ("Request", "Response"):
        return getattr(ros_class(service), part)
    package, kind, name = ros_type.split("/")
    action, _, part = name.partition("_") if kind == "action" else (name, "", "")
    try:
        found = getattr(importlib.import_module(f"{package}.{kind}"), action)
    except (ImportError, AttributeError) as error:
        raise UnsupportedError(
            f"ROS does not know {ros_type}: install or build the package {package}, and source it ({error})"
        ) from error
    return getattr(found.Impl, _OF_ACTIONS[part]) if part else found


class Codec(Generic[M]):
    """Turns one type of ours into the class of ROS, and back.

    Args:
        python_type: The frozen dataclass of the message, with the definition's fields.
        made: The class of ROS.

    Raises:
        TypeMismatchError: They do not have the same fields.
    """

    def __init__(self, python_type: type[M], made: Any) -> None:
        self._name = made.__name__
        self._out, self._in = _converters(python_type, made)

    def encode(self, message: M) -> Any:
        """What ROS sends for `message`.

        Raises:
            TypeMismatchError: A value is none that its field can carry.
        """
        try:
            return self._out(message)
        except (AssertionError, AttributeError, OverflowError, TypeError, ValueError) as error:
            raise TypeMismatchError(f"{self._name} cannot carry this message: {error}") from error

    def decode(self, message: Any) -> M:
        """Our message for what came.

        Raises:
            TypeMismatchError: A value is none that our field can carry.
        """
        try:
            decoded: M = self._in(message)
        except (TypeError, ValueError) as error:
            raise TypeMismatchError(f"a {self._name} cannot be read: {error}") from error
        return decoded


def _converters(python_type: type[Any], made: Any) -> tuple[Convert, Convert]:
    described: dict[str, str] = made.get_fields_and_field_types()
    own = {field.name for field in fields(python_type)} if is_dataclass(python_type) else set()
    if own != set(described):
        raise TypeMismatchError(
            f"{python_type.__name__} has the fields {', '.join(sorted(own)) or 'none'}, "
            f"and {made.__name__} of this ROS {', '.join(sorted(described)) or 'none'}"
        )
    hints, empty = get_type_hints(python_type), made()
    both = {name: _field(what, hints[name], type(getattr(empty, name))) for name, what in described.items()}

    def outwards(message: Any) -> Any:
        filled = made()
        for name, (out, _) in both.items():
            setattr(filled, name, out(getattr(message, name)))
        return filled

    def inwards(message: Any) -> Any:
        return python_type(**{name: back(getattr(message, name)) for name, (_, back) in both.items()})

    return outwards, inwards


def _field(described: str, hint: Any, made: Any) -> tuple[Convert, Convert]:
    """How a field is turned.

    Args:
        described: Its type in words of ROS: `string`, `sequence<double>`, `uint8[16]`, `std_msgs/Header`.
        hint: Its type here.
        made: Its class in ROS.
    """
    inner, many, fixed = _parts(described)
    if not many:
        if "/" in inner:
            return _converters(hint, made)
        return (_text, str) if inner == "string" else (_SCALARS.get(inner, _same), _same)
    if "/" in inner:
        package, name = inner.split("/")
        out, back = _converters(get_args(hint)[0], ros_class(f"{package}/msg/{name}"))
        return lambda items: [out(one) for one in items], lambda items: tuple(back(one) for one in items)
    if inner == "string":
        return lambda items: [_text(one) for one in items], tuple
    number = np.dtype({"float": "f4", "double": "f8", "boolean": "?"}.get(inner, inner))
    if hint is bytes:
        if fixed:
            return lambda data: np.frombuffer(data, number), lambda data: data.tobytes()
        return lambda data: array("B", data), lambda data: data.tobytes()
    if fixed:
        return lambda items: np.array(items, number), lambda items: tuple(items.tolist())
    if inner == "boolean":
        return list, tuple
    return lambda items: array(number.char.replace("l", "q").replace("L", "Q"), items), tuple


def _parts(described: str) -> tuple[str, bool, bool]:
    """Type of one, whether there are many, and whether their count is fixed; bounds are left to ROS."""
    if described.startswith("sequence<"):
        return described[len("sequence<") : -1].partition(",")[0], True, False
    inner, bracket, _ = described.partition("[")
    return inner.partition("<")[0], bool(bracket), bool(bracket)


def _text(value: str) -> str:
    """Texts of ROS are UTF-8; half a character would be found out only when it is sent."""
    if not value.isascii():
        value.encode()
    return value


def _same(value: Any) -> Any:
    return value


_SCALARS: Final[dict[str, Convert]] = {"float": float, "double": float, "boolean": bool}
