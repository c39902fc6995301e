"""Graphs as BehaviorTree.CPP 4 XML."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from xml.etree import ElementTree

from parley.errors import GraphRefusedError, Problem
from parley.messages.pvf import SEPARATOR
from parley.umrf.model import Graph, Node
from parley_bt.ports import (
    CPP_TYPES,
    ON_FALSE,
    Port,
    entries,
    is_node_name,
    node_ports,
    port_name,
    write_value,
)
from parley_bt.reasons import refusal
from parley_bt.shape import (
    Fallback,
    ForceSuccess,
    Inverter,
    Leaf,
    Parallel,
    Retry,
    Sequence,
    Shape,
)
from parley_bt.structure import structure

__all__ = ["export_tree"]


def export_tree(graph: Graph) -> str:
    """The XML of the behaviour tree that does what `graph` does.

    Raises:
        GraphRefusedError: There is none; every problem has a code of `parley_bt.EXPORT_REASONS`.
    """
    shape = structure(graph)
    given, problems = entries(graph)
    problems += _unwritable(graph, given)
    if problems:
        raise GraphRefusedError(graph.name, problems)
    root = ElementTree.Element("root", BTCPP_format="4", main_tree_to_execute=_tree_id(graph))
    tree = ElementTree.SubElement(root, "BehaviorTree", ID=_tree_id(graph))
    nodes = {node.ref: node for node in graph.nodes}
    _write(tree, shape, {ref: _leaf(node, given) for ref, node in nodes.items()})
    _write_models(ElementTree.SubElement(root, "TreeNodesModel"), graph)
    ElementTree.indent(root, "    ")
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=False) + "\n"


def _tree_id(graph: Graph) -> str:
    """The graph's name as far as a tree can have it; actions keep their names for themselves."""
    name = re.sub(r"[^A-Za-z0-9_-]", "_", graph.name)
    return name if is_node_name(name) and name not in {node.name for node in graph.nodes} else f"{name}_tree"


def _write(parent: ElementTree.Element, shape: Shape, leaf: Mapping[object, dict[str, str]]) -> None:
    match shape:
        case Leaf():
            attributes = dict(leaf[shape.node])
            if shape.false_succeeds:
                attributes[ON_FALSE] = "SUCCESS"
            ElementTree.SubElement(parent, "Action", attributes)
        case Sequence() | Fallback():
            _write_all(ElementTree.SubElement(parent, type(shape).__name__), shape.children, leaf)
        case Parallel(all_end=True):
            _write_all(ElementTree.SubElement(parent, "ParallelAll", max_failures="1"), shape.children, leaf)
        case Parallel():
            counts = {"success_count": "-1", "failure_count": "1"}
            _write_all(ElementTree.SubElement(parent, "Parallel", counts), shape.children, leaf)
        case Retry():
            attempts = {"num_attempts": str(shape.attempts)}
            _write(ElementTree.SubElement(parent, "RetryUntilSuccessful", attempts), shape.child, leaf)
        case Inverter() | ForceSuccess():
            _write(ElementTree.SubElement(parent, type(shape).__name__), shape.child, leaf)


def _write_all(
    element: ElementTree.Element, children: tuple[Shape, ...], leaf: Mapping[object, dict[str, str]]
) -> None:
    for child in children:
        _write(element, child, leaf)


def _leaf(node: Node, given: Mapping[Port, str]) -> dict[str, str]:
    attributes = {"ID": node.name, "name": node.full_name}
    for direction, name, parameter in node_ports(node):
        entry = given.get((node.ref, name))
        value = write_value(parameter.type, parameter.value) if parameter.has_data else None
        if entry is not None:
            attributes[port_name(name) or ""] = f"{{{entry}}}"
        elif value is not None and direction == "input_port":
            attributes[port_name(name) or ""] = value
    return attributes


def _write_models(models: ElementTree.Element, graph: Graph) -> None:
    written: set[str] = set()
    for node in graph.nodes:
        if node.name in written:
            continue
        written.add(node.name)
        model = ElementTree.SubElement(models, "Action", ID=node.name)
        for direction, name, parameter in node_ports(node):
            kind = CPP_TYPES.get(parameter.type, parameter.type)
            ElementTree.SubElement(model, direction, name=port_name(name) or "", type=kind)
        ElementTree.SubElement(
            model, "input_port", name=ON_FALSE, type="BT::NodeStatus", default="FAILURE"
        ).text = "What the node returns when its action returns false"


def _unwritable(graph: Graph, given: Mapping[Port, str]) -> Iterator[Problem]:
    """Names and values that XML or BehaviorTree.CPP cannot hold."""
    kinds: dict[str, Node] = {}
    for index, node in enumerate(graph.nodes):
        path = f"actions[{index}]"
        first = kinds.setdefault(node.name, node)
        if not is_node_name(node.name) or _ports(first) != _ports(node):
            yield refusal("node_name", f"{path}.name", node.full_name)
        if node.input_parameters.keys() & node.output_parameters.keys():
            yield refusal("port_name", path, f"{node.full_name} has an input and an output of one name")
        for direction, name, parameter in node_ports(node):
            where = f"{path}.{direction.removesuffix('_port')}_parameters.{name.replace(SEPARATOR, '.')}"
            if port_name(name) is None:
                yield refusal("port_name", where, name)
            no_text = parameter.has_data and write_value(parameter.type, parameter.value) is None
            if no_text and direction == "input_port" and (node.ref, name) not in given:
                yield refusal("value_form", where, node.full_name)


def _ports(node: Node) -> list[tuple[str, str, str]]:
    return sorted((direction, name, parameter.type) for direction, name, parameter in node_ports(node))
