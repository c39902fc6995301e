"""From Python types to parameters and back: how a function's signature becomes a descriptor.

Pure: knows types, docstrings and values, not actions. Reading goes one way (`flatten_type`), running the
other (`build_argument` before the call, `flatten_value` after it).
"""

from __future__ import annotations

import dataclasses
import enum
import inspect
import re
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Literal

from parley.errors import ActionFailure, FailureCode
from parley.messages.pvf import SEPARATOR, Parameter
from parley.umrf.text import clean_text

__all__ = [
    "MISSING",
    "build_argument",
    "docstring_parts",
    "flatten_type",
    "flatten_value",
    "is_record",
    "resolve_hints",
    "strip_optional",
]

MISSING: Final = object()
"""Stands for "no value"; None is a value in Python."""

_NATIVE: Final[Mapping[Any, str]] = {str: "string", bool: "bool", int: "number", float: "number"}
_SECTION: Final = re.compile(
    r"^(Args|Arguments|Returns|Raises|Yields|Attributes|Example|Examples|Note|Notes):\s*$", re.M
)
_ARGUMENT: Final = re.compile(r"^\s+(\w+)(?: \([^)]*\))?:\s*(.*)$")


def resolve_hints(function: Callable[..., Any], skip: int = 1) -> tuple[dict[str, Any], Any]:
    """The types of a function's arguments after the first `skip`, and of what it returns.

    What is skipped (context, `self`) is not looked at, so its type may be imported for type checkers only.

    Raises:
        TypeError: An argument has no annotation, or it is ``*args``/``**kwargs``.
    """
    parameters = list(inspect.signature(function).parameters.values())[skip:]
    for parameter in parameters:
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            raise TypeError(f"{function.__qualname__}: *{parameter.name} cannot be described as a parameter")
        if parameter.annotation is parameter.empty:
            raise TypeError(f"{function.__qualname__}: argument {parameter.name!r} needs a type annotation")
    wanted = {parameter.name for parameter in parameters} | {"return"}
    annotations = {name: hint for name, hint in function.__annotations__.items() if name in wanted}
    holder = types.SimpleNamespace(__annotations__=annotations)
    hints = typing.get_type_hints(holder, globalns=getattr(function, "__globals__", {}))
    returned = hints.pop("return", None)
    return {parameter.name: hints[parameter.name] for parameter in parameters}, returned


def strip_optional(hint: Any, *besides: type) -> Any:
    """``X`` for ``X | None`` (and without `besides`), everything else as it is."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        kept = [item for item in typing.get_args(hint) if item not in (type(None), *besides)]
        if len(kept) == 1:
            return kept[0]
    return hint


def is_record(hint: Any) -> bool:
    """Whether `hint` is a dataclass, which becomes a name level."""
    return isinstance(hint, type) and dataclasses.is_dataclass(hint)


def flatten_type(name: str, hint: Any, default: Any = MISSING) -> dict[str, Parameter]:
    """The flat parameters that stand for one value of type `hint`.

    Args:
        name: Flat name of the value; empty for the fields of a returned dataclass.
        hint: A resolved type: str, float, int, bool, lists of them, a Literal or enum of texts, a dataclass
            of such, or any other class (an opaque hand-over).
        default: Its default; with one, no parameter of it is required.
    """
    hint = strip_optional(hint)
    if is_record(hint):
        flat: dict[str, Parameter] = {}
        hints = typing.get_type_hints(hint)
        for item in dataclasses.fields(hint):
            inner = _field_default(item) if default is MISSING else getattr(default, item.name, None)
            flat |= flatten_type(_join(name, item.name), hints[item.name], inner)
        return flat
    pvf_type, allowed = _pvf_type(hint)
    value = None if default is MISSING else _plain(default)
    return {name: Parameter(pvf_type, value=value, required=default is MISSING, allowed=allowed)}


def _field_default(item: dataclasses.Field[Any]) -> Any:
    if item.default is not dataclasses.MISSING:
        return item.default
    if item.default_factory is not dataclasses.MISSING:
        return item.default_factory()
    return MISSING


def _pvf_type(hint: Any) -> tuple[str, tuple[Any, ...]]:
    """The PVF type of a leaf and its allowed values."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin is Literal and all(isinstance(item, str) for item in arguments):
        return "string", arguments
    if isinstance(hint, type) and issubclass(hint, enum.Enum) and issubclass(hint, str):
        return "string", tuple(str(item.value) for item in hint)
    if origin in (list, tuple, Sequence) and arguments and arguments[0] in _NATIVE:
        return f"{_NATIVE[arguments[0]]}s", ()
    if hint in _NATIVE:
        return _NATIVE[hint], ()
    return getattr(hint, "__name__", str(hint)), ()


def build_argument(name: str, hint: Any, values: Mapping[str, Any]) -> Any:
    """The Python value of one argument, from flat `values`; `MISSING` if no part of it has data.

    Raises:
        ActionFailure: `internal`: part of a dataclass is missing, or a whole number was expected.
    """
    hint = strip_optional(hint)
    if not is_record(hint):
        return _to_python(name, hint, values[name]) if name in values else MISSING
    hints = typing.get_type_hints(hint)
    built: dict[str, Any] = {}
    lacking: list[str] = []
    for item in dataclasses.fields(hint):
        value = build_argument(_join(name, item.name), hints[item.name], values)
        if value is not MISSING:
            built[item.name] = value
        elif _field_default(item) is MISSING:
            lacking.append(_join(name, item.name))
    if not built:
        return MISSING
    if lacking:
        raise ActionFailure(FailureCode.INTERNAL, f"The input {lacking[0]} is missing.")
    return hint(**built)


def _to_python(name: str, hint: Any, value: Any) -> Any:
    if hint is int and isinstance(value, float):
        if not value.is_integer():
            raise ActionFailure(
                FailureCode.INTERNAL, f"The input {name} must be a whole number, not {value}."
            )
        return int(value)
    allowed = _pvf_type(hint)[1]
    if allowed and value not in allowed:
        words = ", ".join(map(str, allowed))
        raise ActionFailure(FailureCode.INTERNAL, f"The input {name} must be one of {words}, not {value}.")
    if isinstance(hint, type) and issubclass(hint, enum.Enum):
        return hint(value)
    return tuple(value) if typing.get_origin(hint) is tuple else value


def flatten_value(value: Any, name: str = "") -> dict[str, Any]:
    """Flat name -> plain value of a returned dataclass; fields that are None are left out."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        flat: dict[str, Any] = {}
        for item in dataclasses.fields(value):
            flat |= flatten_value(getattr(value, item.name), _join(name, item.name))
        return flat
    return {} if value is None else {name: _plain(value)}


def _plain(value: Any) -> Any:
    """Numbers as doubles, enums and broken text as plain text, tuples as lists: what JSON would give back."""
    if isinstance(value, enum.Enum):
        value = value.value
    if isinstance(value, str):
        return clean_text(value)
    if isinstance(value, bool) or not isinstance(value, int | tuple | list):
        return value
    return float(value) if isinstance(value, int) else [_plain(item) for item in value]


def _join(level: str, name: str) -> str:
    return f"{level}{SEPARATOR}{name}" if level else name


def docstring_parts(function: Any) -> tuple[str, dict[str, str]]:
    """The description (text before the first section) and each argument's text of a google docstring."""
    text = inspect.getdoc(function) or ""
    first = _SECTION.search(text)
    description = " ".join((text[: first.start()] if first else text).split())
    arguments: dict[str, str] = {}
    current = ""
    for line in _section(text, ("Args", "Arguments")):
        found = _ARGUMENT.match(line)
        if found and _indent(line) <= 4:
            current = found[1]
            arguments[current] = found[2].strip()
        elif current and line.strip():
            arguments[current] += " " + line.strip()
    return description, arguments


def _section(text: str, titles: tuple[str, ...]) -> list[str]:
    for found in _SECTION.finditer(text):
        if found[1] in titles:
            following = _SECTION.search(text, found.end())
            return text[found.end() : following.start() if following else len(text)].splitlines()
    return []


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())
