"""The actions one actor can carry out: found by name, matched against nodes, told to others (7)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Self

import structlog
from rapidfuzz import fuzz, process

from parley.errors import GraphRefusedError
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo
from parley.umrf.action import ActionSpec
from parley.umrf.io import read_descriptor
from parley.umrf.model import Node

__all__ = ["Catalogue", "descriptor_file_name", "merge"]

log = structlog.get_logger(__name__)

DESCRIPTOR_MARK = "umrf.json"
_SIMILAR = 60.0
"""rapidfuzz score from which a name is worth suggesting."""


class Catalogue:
    """Action descriptions by name; the first of a name wins (7.2)."""

    def __init__(self, specs: Iterable[ActionSpec] = ()) -> None:
        self._specs: dict[str, ActionSpec] = {}
        for spec in specs:
            self._specs.setdefault(spec.name, spec)

    def __iter__(self) -> Iterator[ActionSpec]:
        return iter(self._specs.values())

    def __len__(self) -> int:
        return len(self._specs)

    def __contains__(self, name: str) -> bool:
        return name in self._specs

    def get(self, name: str) -> ActionSpec | None:
        """The action of that name, or None."""
        return self._specs.get(name)

    def match(self, node: Node) -> ActionSpec | None:
        """The action that `node` means: same name, same flat inputs, same flat outputs (7.2); or None."""
        spec = self._specs.get(node.name)
        if spec is None:
            return None
        same = node.input_parameters.keys() == spec.inputs.keys()
        return spec if same and node.output_parameters.keys() == spec.outputs.keys() else None

    def infos(self) -> tuple[ActionInfo, ...]:
        """What others are told about the actions, in the order they were given."""
        return tuple(_info(spec) for spec in self)

    def suggestions(self, name: str) -> list[str]:
        """Names that look like `name`, the most similar first, at most three."""
        found = process.extract(
            name, list(self._specs), scorer=fuzz.WRatio, processor=str.lower, limit=3, score_cutoff=_SIMILAR
        )
        return [choice for choice, _, _ in found]

    @classmethod
    def load_folder(cls, path: Path) -> Self:
        """Read the descriptor files in `path` and two levels below it; bad files are logged and skipped."""
        specs: list[ActionSpec] = []
        for pattern in ("*", "*/*", "*/*/*"):
            for file in sorted(path.glob(pattern)):
                if DESCRIPTOR_MARK in file.name and file.is_file():
                    specs += _read(file)
        return cls(specs)


def _read(file: Path) -> list[ActionSpec]:
    try:
        return [read_descriptor(file.read_text(encoding="utf-8"))]
    except (GraphRefusedError, OSError, UnicodeDecodeError) as error:
        log.warning("descriptor skipped", file=str(file), reason=str(error))
        return []


def _info(spec: ActionSpec) -> ActionInfo:
    return ActionInfo(
        name=spec.name,
        inputs={name: parameter.type for name, parameter in spec.inputs.items()},
        optional=tuple(name for name, item in spec.inputs.items() if not item.required or item.has_data),
        outputs={name: parameter.type for name, parameter in spec.outputs.items()},
        description=spec.description,
        phrases=spec.phrases,
        effects=spec.effects,
        risk=spec.risk,
        capabilities=spec.capabilities,
    )


def merge(node: Node, spec: ActionSpec) -> Node:
    """The node with what the descriptor knows about its inputs; allowed values are the graph's (7.3)."""
    merged: dict[str, Parameter] = {}
    for name, given in node.input_parameters.items():
        known = spec.inputs.get(name)
        if known is None or known.type != given.type:
            merged[name] = given
            continue
        value = given.value if given.has_data else known.value
        merged[name] = replace(known, value=value, allowed=given.allowed)
    return replace(node, input_parameters=merged)


def descriptor_file_name(action: str) -> str:
    """The conventional file of an action: ``GetCoordinates`` -> ``get_coordinates.umrf.json`` (7.1)."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", action).lower() + f".{DESCRIPTOR_MARK}"
