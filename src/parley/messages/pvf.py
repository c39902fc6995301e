"""Parameters in UMRF's "parameter value format" (`spec/umrf.md` section 4).

In JSON a tree of objects: an object with ``pvf_type`` is a parameter, one without is a name level. In here a
flat mapping from the joined name (``pose::position::x``) to a `Parameter`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from parley.errors import InvalidMessageError

__all__ = [
    "NATIVE_TYPES",
    "Parameter",
    "Parameters",
    "fits_type",
    "native_type",
    "read_parameters",
    "write_parameters",
]

Parameters = Mapping[str, "Parameter"]
"""Flat parameter name -> parameter."""

SEPARATOR: Final = "::"

NATIVE_TYPES: Final = ("string", "strings", "number", "numbers", "bool", "bools")
"""Types whose values are written in JSON; any other type text is an opaque hand-over inside one process."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One typed input or output of an action."""

    type: str
    """``pvf_type``."""
    value: Any = None
    """``pvf_value``; None means "no data yet" (JSON null is not allowed)."""
    required: bool = True
    """``pvf_required``: must have data before the node may run."""
    updatable: bool = True
    """``pvf_updatable``: whether later data may overwrite the value."""
    allowed: tuple[Any, ...] = field(default=())
    """``pvf_allowed_values``: filter on incoming data; empty allows everything."""

    @property
    def has_data(self) -> bool:
        """Whether a value is there."""
        return self.value is not None

    def with_value(self, value: Any) -> Parameter:
        """The same parameter holding `value`."""
        return replace(self, value=value)


def fits_type(pvf_type: str, value: Any) -> bool:
    """Whether `value` is of the native type `pvf_type`; an opaque type fits no JSON value."""
    match pvf_type:
        case "string":
            return isinstance(value, str)
        case "number":
            return _is_number(value)
        case "bool":
            return isinstance(value, bool)
        case "strings":
            return isinstance(value, list) and all(isinstance(item, str) for item in value)
        case "numbers":
            return isinstance(value, list) and all(_is_number(item) for item in value)
        case "bools":
            return isinstance(value, list) and all(isinstance(item, bool) for item in value)
    return False


def native_type(value: Any) -> str:
    """The native type that `value` fits, or `object` for what is never written in JSON."""
    kinds = ("bool", "number", "string", "numbers", "strings", "bools")
    return next((kind for kind in kinds if fits_type(kind, value)), "object")


def _is_number(value: Any) -> bool:
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer beyond every double
        return False


def read_parameters(tree: Any, path: str = "input_parameters") -> dict[str, Parameter]:
    """Parse a parameter tree into flat names.

    Args:
        tree: The JSON value of ``input_parameters`` or ``output_parameters``.
        path: Where it stands, for messages.

    Raises:
        InvalidMessageError: Something in it is neither a parameter nor a level, or a value does not fit.
    """
    flat: dict[str, Parameter] = {}
    if tree is None:
        return flat
    if not isinstance(tree, Mapping):
        raise InvalidMessageError("parameters", path, f"expected an object, got {_kind(tree)}")
    for key, child in tree.items():
        _read_level(str(key), child, f"{path}.{key}", flat)
    return flat


def _read_level(name: str, node: Any, path: str, flat: dict[str, Parameter]) -> None:
    if not isinstance(node, Mapping):
        raise InvalidMessageError(
            "parameters", path, f"expected an object with pvf_type or a name level, got {_kind(node)}"
        )
    if "pvf_type" in node:
        flat[name] = _read_parameter(node, path)
        return
    for key, child in node.items():
        _read_level(f"{name}{SEPARATOR}{key}", child, f"{path}.{key}", flat)


def _read_parameter(node: Mapping[str, Any], path: str) -> Parameter:
    pvf_type = node["pvf_type"]
    if not isinstance(pvf_type, str) or not pvf_type:
        raise InvalidMessageError("parameters", f"{path}.pvf_type", "expected a non-empty string")
    value = node.get("pvf_value")
    if "pvf_value" in node and not fits_type(pvf_type, value):
        raise InvalidMessageError(
            "parameters", f"{path}.pvf_value", f"expected a value of type {pvf_type}, got {_kind(value)}"
        )
    for flag in ("pvf_required", "pvf_updatable"):
        if not isinstance(node.get(flag, True), bool):
            raise InvalidMessageError("parameters", f"{path}.{flag}", "expected true or false")
    allowed = node.get("pvf_allowed_values", [])
    if not isinstance(allowed, list):
        raise InvalidMessageError("parameters", f"{path}.pvf_allowed_values", "expected an array")
    return Parameter(
        type=pvf_type,
        value=_normal(pvf_type, value),
        required=node.get("pvf_required", True),
        updatable=node.get("pvf_updatable", True),
        allowed=tuple(_normal(pvf_type, item) for item in allowed),
    )


def _normal(pvf_type: str, value: Any) -> Any:
    """Numbers are doubles in UMRF: an integer comes back as 3.0."""
    if pvf_type == "number" and _is_number(value):
        return float(value)
    if pvf_type == "numbers" and isinstance(value, list):
        return [float(item) if _is_number(item) else item for item in value]
    return value


def write_parameters(parameters: Parameters) -> dict[str, Any]:
    """Write flat parameters back as a tree (`spec/umrf.md` section 9: ``pvf_required`` is never written)."""
    tree: dict[str, Any] = {}
    for name, parameter in parameters.items():
        *levels, leaf = name.split(SEPARATOR)
        level = tree
        for part in levels:
            level = level.setdefault(part, {})
        level[leaf] = _write_parameter(parameter)
    return tree


def _write_parameter(parameter: Parameter) -> dict[str, Any]:
    written: dict[str, Any] = {"pvf_type": parameter.type}
    if parameter.has_data and fits_type(parameter.type, parameter.value):
        written["pvf_value"] = parameter.value
    if not parameter.updatable:
        written["pvf_updatable"] = False
    if parameter.allowed:
        written["pvf_allowed_values"] = list(parameter.allowed)
    return written


def _kind(value: Any) -> str:
    """A short name of a JSON value's kind for messages."""
    names = {bool: "a boolean", int: "a number", float: "a number", str: "a string", list: "an array"}
    return "null" if value is None else names.get(type(value), "an object")
