"""Whether a command can be carried out, before anything is changed (6, 11.4, 11.5)."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import Any

from parley.errors import GraphRefusedError, Problem
from parley.umrf.flow import Flow, FlowNode
from parley.umrf.model import Node

__all__ = ["check_entry", "check_removed", "values_to_continue"]


def check_removed(graph_name: str, active: Iterable[FlowNode], kept: Container[str]) -> None:
    """What runs cannot be taken out of the graph (11.5).

    Raises:
        GraphRefusedError: An active node is not among those `kept`.
    """
    problems = [
        Problem(
            "actions", f"{item.name} is {item.state} and cannot be removed", "stop it first", "node_active"
        )
        for item in active
        if item.name not in kept
    ]
    if problems:
        raise GraphRefusedError(graph_name, problems)


def check_entry(graph_name: str, flow: Flow) -> None:
    """After start parameters were given: the entry actions must have what they need.

    Raises:
        GraphRefusedError: Some have not; a value of another type or one that is not allowed was not taken.
    """
    missing = [
        f"{name} of {relation.node.full_name}"
        for relation in flow.entry
        for name in flow.nodes[relation.node.full_name].missing_inputs()
    ]
    if missing:
        problem = Problem(
            "parameters",
            f"{graph_name} was given no usable value for {', '.join(missing)}",
            "give one of the type and among the values it allows",
            "missing_input",
        )
        raise GraphRefusedError(graph_name, [problem])


def values_to_continue(
    graph_name: str, flow: Flow, form: Mapping[str, Node], name: str, going_on: Container[str]
) -> dict[str, Any]:
    """The inputs that a node takes from the past when it is run out of turn.

    Args:
        graph_name: For the refusal.
        flow: The graph as it is.
        form: Its nodes as they will be, by full name.
        name: Full name of the node; empty for none.
        going_on: Full names of nodes whose action has not ended.

    Raises:
        GraphRefusedError: There is no such node, or it cannot run even so.
    """
    if not name:
        return {}
    if name not in form:
        known = ", ".join(form) or "none"
        raise _refusal(graph_name, "unknown_node", f"has no node {name!r}", f"its nodes are: {known}")
    item = flow.nodes.get(name)
    if item is not None and item.active:
        return {}
    if name in going_on:
        raise _refusal(graph_name, "still_stopping", f"is still stopping {name}", "wait for it")
    past, missing = flow.past_values(name, form)
    if missing:
        raise _refusal(
            graph_name,
            "missing_input",
            f"cannot run {name} without {', '.join(missing)}",
            "give values, or continue from the action that provides them",
        )
    return past


def _refusal(graph_name: str, code: str, message: str, remedy: str) -> GraphRefusedError:
    return GraphRefusedError(graph_name, [Problem("continue_from", f"{graph_name} {message}", remedy, code)])
