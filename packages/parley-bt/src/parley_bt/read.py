"""BehaviorTree.CPP 4 XML as graphs: the subset of sequence, fallback, parallel and retry."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import count
from typing import Final

from parley.errors import GraphRefusedError, Problem
from parley.messages.pvf import NATIVE_TYPES, Parameter
from parley.umrf.model import Graph, Node, NodeRef
from parley.umrf.reading import MAX_ACTIONS, MAX_INSTANCE_ID
from parley_bt.build import Links, build
from parley_bt.ports import (
    BUILTIN_NODES,
    CPP_TYPES,
    ON_FALSE,
    entry_of,
    is_node_name,
    parameter_name,
    read_value,
)
from parley_bt.reasons import refusal
from parley_bt.shape import (
    FOREVER,
    ForceSuccess,
    Leaf,
    Parallel,
    Retry,
    Shape,
    ends,
    fallback,
    inverter,
    sequence,
    starts,
)
from parley_bt.xml import Element, parse

__all__ = ["import_tree"]

MAX_READ: Final = 4 * MAX_ACTIONS
"""Elements, those in a retry once per attempt."""
MAX_ATTEMPTS: Final = 100
"""Retries are written out, one copy per attempt."""

Model = Mapping[str, tuple[str, str]]
"""Port -> its element (``input_port``, ``output_port``) and PVF type."""

_PVF_TYPES: Final = {cpp: pvf for pvf, cpp in CPP_TYPES.items()} | {
    "int": "number", "unsigned int": "number", "float": "number", "": "string",
}  # fmt: skip
_NUMBERS: Final[Mapping[str, Mapping[str, str]]] = {
    "RetryUntilSuccessful": {"num_attempts": ""},
    "Parallel": {"success_count": "-1", "failure_count": "1"},
    "ParallelAll": {"max_failures": "1"},
}
"""Elements of the subset with ports of their own, and the defaults of these."""
_FRAME: Final = ("Sequence", "Fallback", "Inverter", "ForceSuccess", *_NUMBERS)


def import_tree(text: str) -> Graph:
    """The graph that does what the tree in `text` does.

    Raises:
        GraphRefusedError: There is none; every problem names line and element and has a code of
            `parley_bt.IMPORT_REASONS`.
    """
    root = parse(text)
    trees = list(root.all("BehaviorTree"))
    if root.tag != "root" or root.attributes.get("BTCPP_format") != "4" or len(trees) != 1:
        raise GraphRefusedError("", [refusal("not_a_tree_file", root.path)])
    tree = trees[0]
    name = tree.attributes.get("ID") or "tree"
    reader = _Reader(root)
    shape = reader.tree(tree)
    if shape is None or reader.problems:
        raise GraphRefusedError(name, reader.problems)
    return build(name, shape, reader.nodes, reader.links)


class _TooMany(Exception):  # noqa: N818 - ends the reading, never leaves this module
    """More than a graph of ours should have."""


class _Reader:
    def __init__(self, root: Element) -> None:
        self.problems: list[Problem] = []
        self.nodes: dict[NodeRef, Node] = {}
        self.links = Links()
        self._models: dict[str, Model] = {}
        self._read = 0
        self._next: dict[str, count[int]] = {}
        for element in root.children:
            if element.tag == "TreeNodesModel":
                self._models |= {
                    item.attributes.get("ID", ""): self._model(item) for item in element.children
                }
            elif element.tag != "BehaviorTree":
                self._refuse("unsupported_element", element)

    def tree(self, element: Element) -> Shape | None:
        """What the tree does; None if it cannot be said."""
        try:
            children = self._children(element, exactly=1)
        except _TooMany:
            self._refuse("too_large", element)
            return None
        return children[0] if children else None

    def _model(self, element: Element) -> Model:
        ports: dict[str, tuple[str, str]] = {}
        for port in element.children:
            name, kind = port.attributes.get("name", ""), port.attributes.get("type", "")
            if port.tag in ("input_port", "output_port") and name not in ports:
                ports[name] = (port.tag, _PVF_TYPES.get(kind, kind))
            elif element.tag in ("Action", "Condition"):
                self._refuse("unknown_port", port, name)
        return ports

    def _children(self, element: Element, *, exactly: int = 0) -> list[Shape]:
        number = len(element.children)
        if number == 0 or (exactly and number != exactly):
            self._refuse("wrong_children", element)
            return []
        shapes = [self._shape(child) for child in element.children]
        return [shape for shape in shapes if shape is not None]

    def _shape(self, element: Element) -> Shape | None:
        self._read += 1
        if self._read > MAX_READ:
            raise _TooMany
        is_leaf = element.tag in ("Action", "Condition") or element.tag not in BUILTIN_NODES
        if is_leaf:
            return self._leaf(element)
        if element.tag not in _FRAME:
            self._refuse("unsupported_element", element)
            return None
        known = {"name", "_description", *_NUMBERS.get(element.tag, {})}
        for attribute in element.attributes.keys() - known:
            self._refuse("unsupported_attribute", element, attribute)
        if element.tag == "RetryUntilSuccessful":
            return self._retry(element)
        children = self._children(element, exactly=int(element.tag in ("Inverter", "ForceSuccess")))
        return self._composite(element, children) if children else None

    def _composite(self, element: Element, children: list[Shape]) -> Shape:
        match element.tag:
            case "Sequence":
                return sequence(*children)
            case "Fallback":
                return fallback(*children)
            case "Inverter":
                return inverter(children[0])
            case "ForceSuccess":
                return ForceSuccess(children[0])
        for key, wanted in _NUMBERS[element.tag].items():
            alike = (wanted, str(len(children))) if wanted == "-1" else (wanted,)
            if element.attributes.get(key, wanted) not in alike:
                self._refuse("bad_number", element, key)
        return children[0] if len(children) == 1 else Parallel(tuple(children), element.tag == "ParallelAll")

    def _retry(self, element: Element) -> Shape | None:
        text = element.attributes.get("num_attempts", "")
        attempts = int(text) if re.fullmatch(r"-1|[0-9]{1,4}", text) else 0
        if not (attempts == FOREVER or 1 <= attempts <= MAX_ATTEMPTS):
            self._refuse("bad_number", element, "num_attempts")
            return None
        tries = [self._children(element, exactly=1) for _ in range(max(attempts, 1))]
        if attempts == FOREVER and all(tries) and set(starts(tries[0][0])) & set(ends(tries[0][0], False)):
            tries.append(self._children(element, exactly=1))  # no action can follow itself: two take turns
        if not all(tries):
            return None
        tried = fallback(*(children[0] for children in tries))
        return Retry(tried) if attempts == FOREVER else tried

    def _leaf(self, element: Element) -> Shape | None:
        name = element.attributes.get("ID", "") if element.tag in ("Action", "Condition") else element.tag
        if not is_node_name(name):
            self._refuse("unsupported_element", element, name)
            return None
        if element.children:
            self._refuse("wrong_children", element)
        if len(self.nodes) >= MAX_ACTIONS:
            raise _TooMany
        ref = self._free(name, element.attributes.get("name", ""))
        model = self._models.get(name, {})
        inputs, outputs = (
            {parameter_name(port): Parameter(kind) for port, (side, kind) in model.items() if side == wanted}
            for wanted in ("input_port", "output_port")
        )
        inputs.pop(ON_FALSE, None)
        self.links.lines[ref] = element.path
        for port, text in element.attributes.items():
            if port not in ("ID", "name", "_description", ON_FALSE):
                self._port(element, ref, port, text, inputs, outputs)
        self.nodes[ref] = Node(name, ref.instance_id, input_parameters=inputs, output_parameters=outputs)
        on_false = element.attributes.get(ON_FALSE, "FAILURE")
        if on_false not in ("SUCCESS", "FAILURE"):
            self._refuse("value_form", element, ON_FALSE)
        return Leaf(ref, on_false == "SUCCESS")

    def _free(self, name: str, instance: str) -> NodeRef:
        """The instance that the element names (``Name_3``), or else the next free one."""
        number = instance.removeprefix(f"{name}_")
        if instance != number and re.fullmatch(r"0|[1-9][0-9]{0,4}", number):
            ref = NodeRef(name, int(number))
            if ref not in self.nodes and ref.instance_id <= MAX_INSTANCE_ID:
                return ref
        free = self._next.setdefault(name, count())
        return next(ref for ref in (NodeRef(name, index) for index in free) if ref not in self.nodes)

    def _port(
        self,
        element: Element,
        ref: NodeRef,
        port: str,
        text: str,
        inputs: dict[str, Parameter],
        outputs: dict[str, Parameter],
    ) -> None:
        name, entry = parameter_name(port), port if text in ("=", "{=}") else entry_of(text)
        if port.startswith("_"):
            self._refuse("unsupported_attribute", element, port)
        elif name in outputs and entry is not None:
            self.links.writes[ref, name] = entry
        elif name not in inputs:
            self._refuse("unknown_port", element, port)
        elif entry is not None:
            self.links.reads[ref, name] = entry
        else:
            self._value(element, name, text, inputs)

    def _value(self, element: Element, name: str, text: str, inputs: dict[str, Parameter]) -> None:
        kind = inputs[name].type
        try:
            if kind not in NATIVE_TYPES:
                raise ValueError(text)
            inputs[name] = inputs[name].with_value(read_value(kind, text))
        except ValueError:
            self._refuse("value_form", element, name)

    def _refuse(self, code: str, element: Element, what: str = "") -> None:
        problem = refusal(code, element.path, what)
        if problem not in self.problems:  # what stands in a retry is read once per attempt
            self.problems.append(problem)
