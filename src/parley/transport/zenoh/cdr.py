"""Our messages to the bytes that ROS 2 sends (CDR), and back; the bytes themselves are the library's work."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, Generic, TypeVar, get_args, get_type_hints

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys.base import normalize_fieldname

from parley.errors import TypeMismatchError
from parley.transport.zenoh.definitions import Definitions

__all__ = ["Codec"]

M = TypeVar("M")

Convert = Callable[[Any], Any]


class Codec(Generic[M]):
    """Writes and reads one type.

    Args:
        definitions: Where its definition is.
        python_type: The frozen dataclass of the message, with the definition's fields.
        ros_type: Its name.

    Raises:
        UnsupportedError: There is no definition of this type.
        TypeMismatchError: The class does not have the definition's fields.
    """

    def __init__(self, definitions: Definitions, python_type: type[M], ros_type: str) -> None:
        self._store, self._ros_type = definitions.store, ros_type
        self._out, self._in = _converters(definitions, python_type, ros_type)

    def encode(self, message: M) -> bytes | bytearray:
        """The bytes of `message`, as they were made: a copy of a picture takes as long as all the rest.

        Raises:
            TypeMismatchError: A value is none that its field can carry.
        """
        try:
            made = self._store.serialize_cdr(self._out(message), self._ros_type).obj
        except (struct.error, OverflowError, ValueError, TypeError, AttributeError, SerdeError) as error:
            raise TypeMismatchError(f"{self._ros_type} cannot carry this message: {error}") from error
        assert isinstance(made, bytearray)
        return made

    def decode(self, data: bytes | bytearray) -> M:
        """The message in `data`.

        Raises:
            TypeMismatchError: These are not the bytes of such a message.
        """
        try:
            message: M = self._in(self._store.deserialize_cdr(memoryview(data), self._ros_type))
        except (SerdeError, struct.error, ValueError, IndexError) as error:
            raise TypeMismatchError(f"what came is no {self._ros_type}: {error}") from error
        return message


def _converters(definitions: Definitions, python_type: type[Any], ros_type: str) -> tuple[Convert, Convert]:
    """From our class to the library's, and back."""
    described = {normalize_fieldname(name): what for name, what in definitions.fields(ros_type)}
    described.pop("structure_needs_at_least_one_member", None)
    own = {field.name for field in fields(python_type)} if is_dataclass(python_type) else set()
    if own != set(described):
        raise TypeMismatchError(
            f"{python_type.__name__} has the fields {', '.join(sorted(own)) or 'none'}, "
            f"and {ros_type} {', '.join(sorted(described)) or 'none'}"
        )
    hints = get_type_hints(python_type)
    both = {name: _field(definitions, what, hints[name]) for name, what in described.items()}
    theirs = definitions.store.types[ros_type]

    def outwards(message: Any) -> Any:
        return theirs(**{name: out(getattr(message, name)) for name, (out, _) in both.items()})

    def inwards(message: Any) -> Any:
        return python_type(**{name: back(getattr(message, name)) for name, (_, back) in both.items()})

    return outwards, inwards


def _field(definitions: Definitions, description: Any, hint: Any) -> tuple[Convert, Convert]:
    kind, inner = description
    if kind == Nodetype.BASE:
        return _same, _same
    if kind == Nodetype.NAME:
        return _converters(definitions, hint, inner)
    (kind_inside, inside), _ = inner
    if kind_inside == Nodetype.NAME:
        out, back = _converters(definitions, get_args(hint)[0], inside)
        return lambda many: [out(one) for one in many], lambda many: tuple(back(one) for one in many)
    if inside[0] == "string":
        return list, tuple
    if hint is bytes:
        return lambda data: np.frombuffer(data, np.uint8), lambda data: data.tobytes()
    number = np.dtype(inside[0])
    return lambda many: np.array(many, number), lambda many: tuple(many.tolist())


def _same(value: Any) -> Any:
    return value
