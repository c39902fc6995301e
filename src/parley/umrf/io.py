"""UMRF JSON in and out (`spec/umrf.md` sections 2 to 6 and 9).

Reading refuses with every problem found and accepts everything the reference accepts; writing gives what the
reference publishes. That published form loses exit conditions and remaps of the entry, so planners and files
use the `faithful` one, which reads back to the same graph.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from json.encoder import encode_basestring
from typing import Any, Final

from parley.errors import GraphRefusedError
from parley.messages.pvf import SEPARATOR, Parameters, write_parameters
from parley.umrf.action import ActionSpec
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
    "dump",
    "graph_to_json",
    "node_to_json",
    "read_descriptor",
    "read_graph",
    "write_descriptor",
    "write_graph",
]

EXTRAS: Final = "parley"
"""The key of a descriptor for what UMRF does not know; other engines ignore it."""
_TEXTS: Final = ("phrases", "examples", "effects", "capabilities")
_TIMES: Final = ("duration_s", "timeout_s")


def read_graph(source: str | Mapping[str, Any]) -> Graph:
    """Read a graph from JSON text or an object that was parsed already.

    Raises:
        GraphRefusedError: With every problem and where it is.
    """
    raw = load_object(source, "graph")
    reader = Reader()
    graph = reader.graph(raw)
    if graph is None or reader.problems:
        name = raw.get("graph_name")
        raise GraphRefusedError(name if isinstance(name, str) else "", reader.problems)
    return graph


def read_descriptor(source: str | Mapping[str, Any]) -> ActionSpec:
    """Read an action descriptor (7.1); the result has nothing that runs it.

    Raises:
        GraphRefusedError: With every problem and where it is.
    """
    reader, raw = Reader(), load_object(source, "descriptor")
    node = reader.node(raw, "")
    if node is None or reader.problems:
        raise GraphRefusedError("", reader.problems)
    return ActionSpec(
        name=node.name,
        inputs=node.input_parameters,
        outputs=node.output_parameters,
        description=node.description,
        type=node.type,
        **_read_extras(raw.get(EXTRAS)),
    )


def _read_extras(raw: Any) -> dict[str, Any]:
    """What a descriptor of ours says besides UMRF; what does not fit is left out, as for any unknown key."""
    extras: dict[str, Any] = {}
    for key, value in raw.items() if isinstance(raw, dict) else ():
        if key in _TEXTS and isinstance(value, list) and all(isinstance(item, str) for item in value):
            extras[key] = tuple(value)
        elif key in _TIMES and isinstance(value, int | float) and value > 0:
            extras[key] = float(value)
        elif key == "risk" and value in ("none", "low", "high"):
            extras[key] = value
    return extras


def write_graph(graph: Graph, *, faithful: bool = False) -> str:
    """The JSON text of a graph; see `graph_to_json`."""
    return dump(graph_to_json(graph, faithful=faithful))


def graph_to_json(graph: Graph, *, faithful: bool = False) -> dict[str, Any]:
    """The JSON object of a graph.

    Args:
        graph: What to write.
        faithful: Keep what the published form loses (exit conditions, entry remaps, ``pvf_required``), state
            only the conditions that were stated, and keep the order of the actions.
    """
    state = GraphState.INITIALIZED if graph.state is GraphState.UNINITIALIZED else graph.state
    nodes = graph.nodes if faithful else sorted(graph.nodes, key=lambda node: node.full_name)
    return {
        "graph_name": graph.name,
        "graph_description": graph.description,
        "graph_state": (graph.state if faithful else state).value,
        "graph_entry": [_child(relation, with_remap=faithful) for relation in graph.entry],
        "graph_exit": [_parent(relation, _exit_conditions(relation, faithful)) for relation in graph.exit],
        "actions": [node_to_json(node, faithful=faithful) for node in nodes],
    }


class GraphWriter:
    """Writes one graph again and again as `write_graph` does, but only what has changed is written anew.

    Feedback needs the whole graph after each change of one node, so its cost would grow with the graph.
    """

    def __init__(self) -> None:
        self._texts: dict[str, tuple[Node, str]] = {}

    def write(self, graph: Graph) -> str:
        """The published text of the graph as it is now."""
        frame = dump(graph_to_json(replace(graph, nodes=())))
        if not graph.nodes:
            return frame
        texts = {node.full_name: (node, self._text(node)) for node in graph.nodes}
        self._texts = texts
        actions = ",\n".join(texts[name][1] for name in sorted(texts))
        return frame.replace('"actions": []', f'"actions": [\n{actions}\n    ]', 1)

    def _text(self, node: Node) -> str:
        known = self._texts.get(node.full_name)
        if known is not None:
            old, text = known
            if old == node:
                return text
            if replace(old, state=node.state) == node:
                return text.replace(_state_line(old), _state_line(node), 1)
        return "        " + _lay_out(node_to_json(node), "\n        ")


def _state_line(node: Node) -> str:
    """The line of a node's state: in JSON text line breaks are layout only, and this depth is the node's."""
    return f'\n            "state": "{node.state.value}"'


def node_to_json(node: Node, *, faithful: bool = False) -> dict[str, Any]:
    """The JSON object of one action node; see `graph_to_json`."""
    written: dict[str, Any] = {
        "name": node.name,
        "instance_id": node.instance_id,
        "description": node.description,
        "type": node.type,
        "state": node.state.value,
        "actor": node.actor,
        "input_parameters": _parameters(node.input_parameters, with_required=faithful),
        "output_parameters": _parameters(node.output_parameters, with_required=faithful),
        "parents": [
            _parent(relation, relation.conditions if faithful else _all_conditions(relation))
            for relation in node.parents
        ],
        "children": [_child(relation) for relation in node.children],
    }
    if node.gui_attributes is not None:
        written["gui_attributes"] = node.gui_attributes
    if node.messages:
        written["runtime"] = {
            "messages": [{"message": item.message, "timestamp": item.timestamp} for item in node.messages]
        }
    optional = ("actor", "input_parameters", "output_parameters", "parents", "children")
    return {key: value for key, value in written.items() if value or key not in optional}


def write_descriptor(spec: ActionSpec) -> str:
    """The JSON text of an action's ``*.umrf.json``."""
    written: dict[str, Any] = {"name": spec.name, "type": spec.type}
    if spec.description:
        written["description"] = spec.description
    for key, parameters in (("input_parameters", spec.inputs), ("output_parameters", spec.outputs)):
        if parameters:
            written[key] = _parameters(parameters, with_required=True)
    extras = {key: getattr(spec, key) for key in (*_TEXTS, *_TIMES) if getattr(spec, key)}
    if spec.risk != "low":
        extras["risk"] = spec.risk
    if extras:
        written[EXTRAS] = extras
    return dump(written)


_LITERALS: Final = {True: "true", False: "false"}


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


def _parameters(parameters: Parameters, *, with_required: bool) -> dict[str, Any]:
    tree = write_parameters(parameters)
    if with_required:
        for name, parameter in parameters.items():
            if not parameter.required:
                _find(tree, name)["pvf_required"] = False
    return tree


def _find(tree: dict[str, Any], name: str) -> dict[str, Any]:
    for level in name.split(SEPARATOR):
        tree = tree[level]
    return tree


def _child(relation: ChildRelation, *, with_remap: bool = True) -> dict[str, Any]:
    written: dict[str, Any] = {"name": relation.node.name, "instance_id": relation.node.instance_id}
    if relation.remap and with_remap:
        written["remap"] = [{"from": source, "to": target} for source, target in relation.remap]
    return written


def _parent(relation: ParentRelation, conditions: Mapping[Result, Response]) -> dict[str, Any]:
    written: dict[str, Any] = {
        "name": relation.node.name,
        "instance_id": relation.node.instance_id,
        "required": relation.required,
    }
    if conditions:
        written["conditions"] = [
            f"{result.value} -> {conditions[result].value}"
            for result in DEFAULT_CONDITIONS
            if result in conditions
        ]
    return written


def _all_conditions(relation: ParentRelation) -> dict[Result, Response]:
    return {result: relation.response(result) for result in DEFAULT_CONDITIONS}


def _exit_conditions(relation: ParentRelation, faithful: bool) -> Mapping[Result, Response]:
    return relation.conditions if faithful else {}
