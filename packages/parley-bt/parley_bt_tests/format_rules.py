"""The documented rules of BehaviorTree.CPP 4 files, written down once more for tests.

From its pages on the XML format, on name validation and on the connection of ports. Nothing of the product is
used here, so that a mistake of the product is not made twice.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

CONTROLS = {"Sequence", "Fallback", "Parallel", "ParallelAll"}
DECORATORS = {"Inverter", "ForceSuccess", "RetryUntilSuccessful"}
OWN_PORTS = {
    "Parallel": {"success_count", "failure_count"},
    "ParallelAll": {"max_failures"},
    "RetryUntilSuccessful": {"num_attempts"},
}
FORBIDDEN = re.compile(r"[ \t\n\r<>&\"'/\\:*?|.\x00-\x1f\x7f]")
MAX_DEPTH = 256
LITERALS = {
    "double": r"-?[0-9.]+(e[-+]?[0-9]+)?",
    "bool": r"true|false",
    "std::vector<double>": r"-?[0-9.e+-]+(;-?[0-9.e+-]+)*",
    "std::vector<bool>": r"(true|false)(;(true|false))*",
    "BT::NodeStatus": r"SUCCESS|FAILURE",
}


def violations(text: str) -> list[str]:
    """Every rule that a file breaks, in words."""
    root = ElementTree.fromstring(text)
    return list(_file(root))


def _file(root: Element) -> Iterator[str]:
    if root.tag != "root" or root.get("BTCPP_format") != "4":
        yield "the first element is <root BTCPP_format='4'>"
    trees, models = root.findall("BehaviorTree"), root.findall("TreeNodesModel")
    if len(models) > 1:
        yield "there is one TreeNodesModel at most"
    if root.get("main_tree_to_execute") not in [tree.get("ID") for tree in trees]:
        yield "main_tree_to_execute names a tree"
    ports = {model.get("ID", ""): _model(model) for item in models for model in item}
    yield from (problem for item in models for model in item for problem in _model_rules(model))
    types: dict[str, str] = {}
    for tree in trees:
        if not _is_name(tree.get("ID", "")) or tree.get("ID") in ports:
            yield "a tree has a name of its own"
        if len(tree) != 1:
            yield "a tree has one root"
        for child in tree:
            yield from _node(child, ports, types, 1)


def _model(model: Element) -> dict[str, tuple[str, str]]:
    return {port.get("name", ""): (port.tag, port.get("type", "")) for port in model}


def _model_rules(model: Element) -> Iterator[str]:
    if not _is_name(model.get("ID", "")):
        yield f"{model.get('ID')!r} is no node name"
    for port in model:
        name = port.get("name", "")
        if port.tag not in ("input_port", "output_port", "inout_port"):
            yield f"<{port.tag}> is no port"
        if not _is_name(name) or not name[0].isalpha() or name in ("ID", "name"):
            yield f"{name!r} is no port name"
    if len(model) != len(_model(model)):
        yield "port names are unique"


def _node(
    node: Element, ports: dict[str, dict[str, tuple[str, str]]], types: dict[str, str], depth: int
) -> Iterator[str]:
    if depth > MAX_DEPTH:
        yield "nested too deep"
    if node.tag == "Action":
        yield from _action(node, ports.get(node.get("ID", "")), types)
    elif node.tag in CONTROLS | DECORATORS:
        if node.attrib.keys() - OWN_PORTS.get(node.tag, set()):
            yield f"<{node.tag}> has other ports"
        if len(node) < 1 or (node.tag in DECORATORS and len(node) != 1):
            yield f"<{node.tag}> has {len(node)} children"
        if any(not -1 <= int(value) <= len(node) for value in node.attrib.values()):
            yield f"<{node.tag}> asks for more than its children"
    else:
        yield f"<{node.tag}> is not known"
    for child in node:
        yield from _node(child, ports, types, depth + 1)


def _action(node: Element, ports: dict[str, tuple[str, str]] | None, types: dict[str, str]) -> Iterator[str]:
    if ports is None:
        yield f"{node.get('ID')!r} is not in the model"
        return
    if len(node):
        yield "an action has no children"
    for name, text in node.attrib.items():
        if name in ("ID", "name"):
            continue
        if name not in ports:
            yield f"{name!r} is not in the model of {node.get('ID')}"
            continue
        direction, kind = ports[name]
        if re.fullmatch(r" *\{.+\} *", text, re.DOTALL):
            if types.setdefault(text, kind) != kind:
                yield f"two types meet at {text}"
        elif direction == "output_port":
            yield f"the output {name!r} needs an entry"
        elif not re.fullmatch(LITERALS.get(kind, r"[\s\S]*"), text):
            yield f"{text!r} is no {kind}"


def _is_name(name: str) -> bool:
    return bool(name) and name.lower() != "root" and not FORBIDDEN.search(name)
