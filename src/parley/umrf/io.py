"""UMRF JSON in and out (`spec/umrf.md` sections 2 to 6 and 9).

Reading refuses with every problem found and accepts everything the reference accepts; writing gives what the
reference publishes. That published form loses exit conditions and remaps of the entry, so planners and files
use the `faithful` one, which reads back to the same graph.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from json.encoder import encode_basestring
from operator import attrgetter
from typing import Any, Final

from parley.errors import GraphRefusedError, Problem
from parley.messages.pvf import SEPARATOR, Parameters, write_parameters
from parley.umrf.action import ActionSpec
from parley.umrf.extras import EXTRAS, read_extras, write_extras
from parley.umrf.model import (
    DEFAULT_CONDITIONS,
    ChildRelation,
    Graph,
    GraphState,
    Node,
    ParentRelation,
    Response,
    Result,
)
from parley.umrf.reading import Reader, load_object

__all__ = [
    "GraphWriter",
    "UnreadableGraphError",
    "dump",
    "graph_to_json",
    "open_graph",
    "read_descriptor",
    "read_graph",
    "read_loaded",
    "write_descriptor",
    "write_graph",
]


KEPT_GRAPHS: Final = 64
"""So many are kept as they were read and checked: rounds are done again, and by several robots."""
KEPT_CHARS: Final = 50_000
_read: Final[dict[str, Graph]] = {}
"""Their texts without the names -> one of them."""
_NAMED: Final = re.compile(r'"graph_name"\s*:\s*"([^"\\\x00-\x1f\ud800-\udfff]+)"')


class UnreadableGraphError(GraphRefusedError):
    """A graph that cannot be read as it stands.

    Attributes:
        readable: What could be read of it, for whoever looks for further problems; None if hardly anything.
    """

    def __init__(self, graph_name: str, problems: Sequence[Problem], readable: Graph | None) -> None:
        self.readable = readable
        super().__init__(graph_name, problems)


def read_graph(source: str | Mapping[str, Any]) -> Graph:
    """Read a graph from JSON text or an object that was parsed already.

    Raises:
        GraphRefusedError: With every problem and where it is.
    """
    return read_loaded(load_object(source, "graph"))


def read_loaded(raw: Mapping[str, Any]) -> Graph:
    """Read a graph from an object that `load_object` gave.

    Raises:
        UnreadableGraphError: With every problem and where it is.
    """
    reader = Reader()
    graph = reader.graph(raw)
    if graph is None or reader.problems:
        name = raw.get("graph_name")
        raise UnreadableGraphError(name if isinstance(name, str) else "", reader.problems, graph)
    return graph


def open_graph(text: str) -> tuple[str, Callable[[], Graph]]:
    """The name of a graph, and what reads the rest.

    Nothing is read once more of a text that differs from an earlier one only in the name.

    Args:
        text: A long one is not kept, nor one with escapes, in which the name is not found by its letters.

    Raises:
        GraphRefusedError: It is no JSON object. Reading the rest raises `UnreadableGraphError`.
    """
    alone = len(text) <= KEPT_CHARS and "\\" not in text and text.count('"graph_name"') == 1
    named = _NAMED.search(text) if alone else None
    content = text[: named.start(1)] + text[named.end(1) :] if named is not None else ""
    known = _read.get(content)
    if known is not None and named is not None:
        name = named[1]
        return name, lambda: replace(known, name=name)
    raw = load_object(text, "graph")

    def read() -> Graph:
        graph = read_loaded(raw)
        if named is not None and graph.name == named[1]:
            if len(_read) == KEPT_GRAPHS:
                _read.clear()
            _read[content] = graph
        return graph

    return str(raw.get("graph_name") or ""), read


def read_descriptor(source: str | Mapping[str, Any]) -> ActionSpec:
    """Read an action descriptor (7.1); the result has nothing that runs it.

    Raises:
        GraphRefusedError: With every problem and where it is.
    """
    reader, raw = Reader(), load_object(source, "descriptor")
    node = reader.node(raw, "")
    extras, problems = read_extras(raw.get(EXTRAS), node.input_parameters if node is not None else ())
    if node is None or reader.problems or problems:
        raise GraphRefusedError("", [*reader.problems, *problems])
    return ActionSpec(
        name=node.name,
        inputs=node.input_parameters,
        outputs=node.output_parameters,
        description=node.description,
        type=node.type,
        **extras,
    )


def write_graph(graph: Graph, *, faithful: bool = False) -> str:
    """The JSON text of a graph: as it is published (9), or that of `graph_to_json`."""
    if faithful:
        return dump(graph_to_json(graph))
    nodes = sorted(graph.nodes, key=lambda node: node.full_name)
    return _published(_published_frame(graph), [_lay_out_node(node) for node in nodes])


def graph_to_json(graph: Graph) -> dict[str, Any]:
    """The JSON object of a graph from which the same graph is read.

    It has what the published form loses (exit conditions, entry remaps, ``pvf_required``), the order of the
    actions, and only the conditions that were stated.
    """
    return {
        "graph_name": graph.name,
        "graph_description": graph.description,
        "graph_state": graph.state.value,
        "graph_entry": [_child(relation) for relation in graph.entry],
        "graph_exit": [_parent(relation) for relation in graph.exit],
        "actions": [_node(node) for node in graph.nodes],
    }


class GraphWriter:
    """Writes one graph again and again as `write_graph` does, but only what has changed is written anew.

    Feedback needs the whole graph after each change of one node, so its cost would grow with the graph.
    A node counts as unchanged if it is the same object as before, which is what running graphs hand out.
    """

    def __init__(self) -> None:
        self._texts: dict[str, tuple[Node, str]] = {}
        self._nodes: tuple[Node, ...] = ()
        """Those of the last graph that was wholly written."""
        self._order: list[str] = []
        self._head: tuple[object, ...] = ()
        self._frame = ""

    def prepare(self, graph: Graph, most: int) -> bool:
        """Write at most so many nodes that have changed; whether that was all, so that `write` is quick."""
        if graph.nodes is self._nodes:
            return True
        texts, left, nodes = self._texts, most, graph.nodes
        if len(self._nodes) == len(nodes):
            nodes = tuple(node for node, old in zip(nodes, self._nodes, strict=True) if node is not old)
        for node in nodes:
            name = node.full_name
            known = texts.get(name)
            if known is None:
                self._order = []
            elif known[0] is node:
                continue
            if left == 0:
                return False
            left -= 1
            texts[name] = (node, _node_text(node, known))
        self._nodes = graph.nodes
        return True

    def write(self, graph: Graph) -> str:
        """The published text of the graph as it is now."""
        self.prepare(graph, -1)
        head = (graph.name, graph.description, graph.state, graph.entry, graph.exit)
        if head != self._head:
            self._head, self._frame = head, _published_frame(graph)
        if len(self._texts) != len(graph.nodes):  # some were taken out
            names = {node.full_name for node in graph.nodes}
            self._texts = {name: item for name, item in self._texts.items() if name in names}
            self._order = []
        if not self._order:
            self._order = sorted(self._texts)
        return _published(self._frame, [self._texts[name][1] for name in self._order])


def _published(frame: str, nodes: Sequence[str]) -> str:
    """The text of a graph from those of its parts."""
    actions = "\n" + ",\n".join(nodes) + "\n    " if nodes else ""
    return f'{{\n    "actions": [{actions}],{frame}'


def _published_frame(graph: Graph) -> str:
    """The published text of a graph after its actions."""
    state = GraphState.INITIALIZED if graph.state is GraphState.UNINITIALIZED else graph.state
    written = {
        "graph_name": graph.name,
        "graph_description": graph.description,
        "graph_state": state.value,
        "graph_entry": [relation.node._asdict() for relation in graph.entry],
        "graph_exit": [{**relation.node._asdict(), "required": relation.required} for relation in graph.exit],
    }
    return dump(written)[1:]


def _node_text(node: Node, known: tuple[Node, str] | None) -> str:
    """The text of a node inside a graph, made from the last one if only its state is another."""
    if known is not None:
        old, text = known
        if _BUT_STATE(old) == _BUT_STATE(node):
            return text.replace(_state_line(old), _state_line(node), 1)
    return _lay_out_node(node)


_BUT_STATE: Final = attrgetter(*(name for name in Node._fields if name != "state"))

_LINE: Final = "\n            "
"""What begins a line of a node's own keys in a published graph."""


def _lay_out_node(node: Node) -> str:
    """A node as it stands in a published graph; most of it has always the same form."""
    parts: list[str] = []
    if node.actor:
        parts.append(f'"actor": {encode_basestring(node.actor)}')
    if node.children:
        parts.append(f'"children": [{",".join(map(_lay_out_child, node.children))}{_LINE}]')
    parts.append(f'"description": {encode_basestring(node.description)}')
    if node.gui_attributes is not None:
        parts.append(f'"gui_attributes": {_lay_out(node.gui_attributes, _LINE)}')
    if node.input_parameters:
        parts.append(f'"input_parameters": {_lay_out(write_parameters(node.input_parameters), _LINE)}')
    parts.append(f'"instance_id": {node.instance_id}')
    parts.append(f'"name": {encode_basestring(node.name)}')
    if node.output_parameters:
        parts.append(f'"output_parameters": {_lay_out(write_parameters(node.output_parameters), _LINE)}')
    if node.parents:
        parts.append(f'"parents": [{",".join(map(_lay_out_parent, node.parents))}{_LINE}]')
    if extras := _extras(node):
        parts.append(f'"{EXTRAS}": {_lay_out(extras, _LINE)}')
    if node.messages:
        parts.append(f'"runtime": {_lay_out(_runtime(node), _LINE)}')
    parts.append(f'"state": "{node.state.value}"')
    parts.append(f'"type": {encode_basestring(node.type)}')
    return f"        {{{_LINE}{f',{_LINE}'.join(parts)}\n        }}"


def _lay_out_child(relation: ChildRelation) -> str:
    if relation.remap:
        return f"{_LINE}    {_lay_out(_child(relation), f'{_LINE}    ')}"
    name = encode_basestring(relation.node.name)
    return f"""{_LINE}    {{
                    "instance_id": {relation.node.instance_id},
                    "name": {name}
                }}"""


def _lay_out_parent(relation: ParentRelation) -> str:
    name = encode_basestring(relation.node.name)
    said = f",{_LINE}            ".join(
        _CONDITION_TEXTS[result, relation.response(result)] for result in DEFAULT_CONDITIONS
    )
    return f"""{_LINE}    {{
                    "conditions": [
                        {said}
                    ],
                    "instance_id": {relation.node.instance_id},
                    "name": {name},
                    "required": {_LITERALS[relation.required]}
                }}"""


def _state_line(node: Node) -> str:
    """The line of a node's state: in JSON text line breaks are layout only, and this depth is the node's."""
    return f'\n            "state": "{node.state.value}"'


def _node(node: Node) -> dict[str, Any]:
    written: dict[str, Any] = {
        "name": node.name,
        "instance_id": node.instance_id,
        "description": node.description,
        "type": node.type,
        "state": node.state.value,
    }
    optional: dict[str, Any] = {
        "actor": node.actor,
        "input_parameters": _parameters(node.input_parameters),
        "output_parameters": _parameters(node.output_parameters),
        "parents": [_parent(relation) for relation in node.parents],
        "children": [_child(relation) for relation in node.children],
        EXTRAS: _extras(node),
        "runtime": _runtime(node) if node.messages else None,
    }
    if node.gui_attributes is not None:
        written["gui_attributes"] = node.gui_attributes
    return written | {key: value for key, value in optional.items() if value}


def _extras(node: Node) -> dict[str, Any]:
    """What other engines ignore."""
    extras: dict[str, Any] = {"retries": node.retries} if node.retries else {}
    if node.timeout_s is not None:
        extras["timeout_s"] = node.timeout_s
    if node.skipped is not None:
        extras["skipped"] = node.skipped.value
    return extras


def _runtime(node: Node) -> dict[str, Any]:
    return {"messages": [{"message": item.message, "timestamp": item.timestamp} for item in node.messages]}


def write_descriptor(spec: ActionSpec) -> str:
    """The JSON text of an action's ``*.umrf.json``."""
    written: dict[str, Any] = {"name": spec.name, "type": spec.type}
    if spec.description:
        written["description"] = spec.description
    for key, parameters in (("input_parameters", spec.inputs), ("output_parameters", spec.outputs)):
        if parameters:
            written[key] = _parameters(parameters)
    extras = write_extras(spec)
    if extras:
        written[EXTRAS] = extras
    return dump(written)


_LITERALS: Final = {True: "true", False: "false"}
_CONDITION_TEXTS: Final = {
    (result, response): f'"{result.value} -> {response.value}"' for result in Result for response in Response
}


def dump(value: Any) -> str:
    """The layout of section 9: keys sorted, four blanks."""
    return _lay_out(value, "\n")


def _lay_out(value: Any, line: str) -> str:
    """What `json.dumps` with `indent` gives, several times as fast: its own indenting is not in C.

    Args:
        value: Anything that JSON can hold.
        line: The line break and blanks before what stands on the level of `value`.
    """
    if isinstance(value, str):
        return encode_basestring(value)
    inner = line + "    "
    if isinstance(value, dict) and value:
        pairs = (f"{encode_basestring(key)}: {_lay_out(value[key], inner)}" for key in sorted(value))
        return f"{{{inner}{f',{inner}'.join(pairs)}{line}}}"
    if isinstance(value, list | tuple) and value:
        return f"[{inner}{f',{inner}'.join(_lay_out(item, inner) for item in value)}{line}]"
    return _LITERALS[value] if isinstance(value, bool) else json.dumps(value, allow_nan=False)


def _parameters(parameters: Parameters) -> dict[str, Any]:
    """The tree of parameters, with what the published form loses."""
    tree = write_parameters(parameters)
    for name, parameter in parameters.items():
        if not parameter.required:
            level = tree
            for part in name.split(SEPARATOR):
                level = level[part]
            level["pvf_required"] = False
    return tree


def _child(relation: ChildRelation) -> dict[str, Any]:
    written: dict[str, Any] = relation.node._asdict()
    if relation.remap:
        written["remap"] = [{"from": source, "to": target} for source, target in relation.remap]
    return written


def _parent(relation: ParentRelation) -> dict[str, Any]:
    written: dict[str, Any] = {**relation.node._asdict(), "required": relation.required}
    if stated := relation.conditions:
        order = (result for result in DEFAULT_CONDITIONS if result in stated)
        written["conditions"] = [f"{result.value} -> {stated[result].value}" for result in order]
    return written
