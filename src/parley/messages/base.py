"""What every JSON payload shares: frozen, typed, unknown keys ignored (other programs add their own)."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, PlainSerializer

from parley.messages.pvf import Parameter, read_parameters, write_parameters

__all__ = ["ParameterTree", "Payload"]


class Payload(BaseModel):
    """Base of JSON payloads. Equality is by content; fields left out by the sender take their defaults."""

    model_config = ConfigDict(frozen=True, extra="ignore", populate_by_name=True)


def _read_tree(value: Any) -> Any:
    """Accept a JSON tree as well as parameters that are parsed already."""
    if isinstance(value, dict) and all(isinstance(item, Parameter) for item in value.values()):
        return value
    try:
        return read_parameters(value, path="")
    except Exception as error:  # pydantic reports ValueError with the field's path
        raise ValueError(str(error)) from error


ParameterTree = Annotated[
    dict[str, Parameter], BeforeValidator(_read_tree), PlainSerializer(write_parameters, return_type=dict)
]
"""Flat parameters in Python, the PVF tree in JSON."""
