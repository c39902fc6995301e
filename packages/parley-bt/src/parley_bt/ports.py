"""Parameters as ports of BehaviorTree.CPP: names, types, values, and blackboard entries."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

from parley.errors import Problem
from parley.messages.pvf import SEPARATOR, Parameter
from parley.umrf.model import Graph, Node, NodeRef, Response, Result
from parley_bt.reasons import refusal

__all__ = [
    "BUILTIN_NODES",
    "CPP_TYPES",
    "ON_FALSE",
    "Port",
    "entries",
    "entry_of",
    "is_node_name",
    "node_ports",
    "parameter_name",
    "port_name",
    "read_value",
    "write_value",
]

ON_FALSE: Final = "on_false"
"""Our port of every action: what an action that returns false makes of its node, SUCCESS or FAILURE."""

CPP_TYPES: Final[Mapping[str, str]] = {
    "string": "std::string",
    "number": "double",
    "bool": "bool",
    "strings": "std::vector<std::string>",
    "numbers": "std::vector<double>",
    "bools": "std::vector<bool>",
}
"""PVF type -> what TreeNodesModel calls it; other types keep their own name."""

BUILTIN_NODES: Final = frozenset(
    {
        "Action", "AlwaysFailure", "AlwaysSuccess", "AsyncFallback", "AsyncSequence",
        "BehaviorTree", "Condition", "Control", "Decorator", "Delay", "EntryUpdatedAction",
        "EntryUpdatedDecorator", "Fallback", "ForceFailure", "ForceSuccess", "IfThenElse",
        "Inverter", "KeepRunningUntilFailure", "LoopBool", "LoopDouble", "LoopInt", "LoopString",
        "ManualSelector", "Parallel", "ParallelAll", "Precondition", "ReactiveFallback",
        "ReactiveSequence", "Repeat", "RetryUntilSuccessful", "Root", "RunOnce", "Script",
        "ScriptCondition", "Sequence", "SequenceStar", "SequenceWithMemory", "SetBlackboard",
        "SkipUnlessUpdated", "Sleep", "SubTree", "Switch2", "Switch3", "Switch4", "Switch5",
        "Switch6", "Timeout", "TreeNodesModel", "TryCatch", "UnsetBlackboard", "WaitValueUpdate",
        "WasEntryUpdated", "WhileDoElse", "include", "root",
    }
)  # fmt: skip
"""Names that BehaviorTree.CPP 4 gives to nodes or elements of its own."""

Port = tuple[NodeRef, str]
"""One parameter of one action, by flat name."""

_PORT_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_FORBIDDEN_IN_NAMES: Final = re.compile(r"[\s<>&\"'/\\:*?|.\x00-\x1f\x7f]")
_NO_XML: Final = re.compile("[^\t\n\r\x20-\x7e\x80-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_RUNNABLE: Final = (Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR)


def is_node_name(name: str) -> bool:
    """Whether an action of that name can be a tree node."""
    return bool(name) and name not in BUILTIN_NODES and not _FORBIDDEN_IN_NAMES.search(name + _bad_xml(name))


def port_name(parameter: str) -> str | None:
    """The port of a flat parameter name (``pose::x`` -> ``pose__x``); None if it has none."""
    name = parameter.replace(SEPARATOR, "__")
    if "__" in parameter or name in ("ID", "name", ON_FALSE) or not _PORT_NAME.fullmatch(name):
        return None
    return name


def parameter_name(port: str) -> str:
    """The flat parameter name of a port."""
    return port.replace("__", SEPARATOR)


def entry_of(text: str) -> str | None:
    """The blackboard entry that a port's text points at, or None if it is a value."""
    bare = text.strip(" ")
    return bare[1:-1] if len(bare) >= 3 and bare[0] == "{" and bare[-1] == "}" else None


def write_value(pvf_type: str, value: Any) -> str | None:
    """The text of a value; None if BehaviorTree.CPP could not read it back."""
    match pvf_type:
        case "string":
            ambiguous = entry_of(value) is not None or value in ("", "=") or value.startswith("json:")
            return None if ambiguous or _bad_xml(value) else str(value)
        case "number":
            return repr(float(value))
        case "bool":
            return "true" if value else "false"
        case "strings" | "numbers" | "bools":
            texts = [write_value(pvf_type.removesuffix("s"), item) for item in value]
            whole = [text for text in texts if text is not None and ";" not in text]
            text = ";".join(whole)
            return text if whole and len(whole) == len(texts) and entry_of(text) is None else None
    return None


def read_value(pvf_type: str, text: str) -> Any:
    """The value of a port's text.

    Raises:
        ValueError: It is none of that type.
    """
    match pvf_type:
        case "string":
            return text
        case "number":
            number = float(text)
            if not math.isfinite(number):
                raise ValueError(text)
            return number
        case "bool":
            return {"true": True, "TRUE": True, "True": True, "1": True}.get(text) or _false(text)
        case "strings" | "numbers" | "bools":
            return [read_value(pvf_type.removesuffix("s"), item) for item in text.split(";")]
    raise ValueError(text)


def entries(graph: Graph) -> tuple[dict[Port, str], list[Problem]]:
    """The entry of every output that is handed on and every input that is given; and what has none."""
    gives: dict[Port, set[Port]] = {}
    takes: dict[Port, set[Port]] = {}
    for giver, taker in _transfers(graph):
        gives.setdefault(giver, set()).add(taker)
        takes.setdefault(taker, set()).add(giver)
    nodes = {node.ref: (index, node) for index, node in enumerate(graph.nodes)}
    problems: list[Problem] = []
    names: dict[Port, str] = {}
    for giver, takers in gives.items():
        names.setdefault(giver, f"{giver[0].full_name}__{port_name(giver[1]) or ''}")
        for taker in sorted(takers):
            names.setdefault(taker, names[giver])
            for other in sorted(takes[taker]):
                names.setdefault(other, names[giver])
    for (ref, name), givers in takes.items():
        index, node = nodes[ref]
        path = f"actions[{index}].input_parameters.{name.replace(SEPARATOR, '.')}"
        first, *others = (gives[giver] for giver in givers)
        if any(other != first for other in others):
            problems.append(refusal("several_givers", path, node.full_name))
        if node.input_parameters[name].has_data:
            problems.append(refusal("value_and_giver", path, node.full_name))
        if node.input_parameters[name].allowed:
            problems.append(refusal("allowed_values", path, node.full_name))
    return names, problems


def _transfers(graph: Graph) -> Iterator[tuple[Port, Port]]:
    """Every output and the input that an edge carries it to (10.6)."""
    nodes = {node.ref: node for node in graph.nodes}
    for node in graph.nodes:
        for relation in node.children:
            child = nodes[relation.node]
            edge = next(parent for parent in child.parents if parent.node == node.ref)
            if Response.RUN not in [edge.response(result) for result in _RUNNABLE]:
                continue
            renamed = dict(relation.remap)
            for output, given in node.output_parameters.items():
                wanted = child.input_parameters.get(renamed.get(output, output))
                if wanted is not None and _carries(given, wanted):
                    yield (node.ref, output), (child.ref, renamed.get(output, output))


def _carries(given: Parameter, wanted: Parameter) -> bool:
    return wanted.updatable and wanted.type == given.type


def _bad_xml(text: str) -> str:
    """A forbidden character if `text` has characters that XML has not, for use in a search."""
    return "\x00" if _NO_XML.search(text) else ""


def _false(text: str) -> bool:
    if text not in ("false", "FALSE", "False", "0"):
        raise ValueError(text)
    return False


def node_ports(node: Node) -> Iterator[tuple[str, str, Parameter]]:
    """Direction, flat name and parameter of every port of an action."""
    for name, parameter in node.input_parameters.items():
        yield "input_port", name, parameter
    for name, parameter in node.output_parameters.items():
        yield "output_port", name, parameter
