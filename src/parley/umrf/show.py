"""Graphs for people: as text, as a Mermaid flowchart, and as an SVG picture.

All three show the same: every action with its state and values, every edge with the conditions that differ
from the defaults, entry and exit. They draw what is there, so they also show graphs that could not run.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final, Literal

from parley.messages.pvf import Parameter
from parley.umrf.drawing import draw_svg
from parley.umrf.model import (
    DEFAULT_CONDITIONS,
    ENTRY,
    EXIT,
    Graph,
    Node,
    NodeRef,
    NodeState,
    ParentRelation,
)

__all__ = ["FORMATS", "STATE_COLOURS", "Format", "as_mermaid", "as_svg", "as_text", "edges", "show"]

Format = Literal["text", "mermaid", "svg"]

MAX_VALUE: Final = 40
"""Longer values are cut; who needs them reads the file."""

STATE_COLOURS: Final[Mapping[NodeState, str]] = {
    NodeState.UNINITIALIZED: "#eceff1",
    NodeState.INITIALIZED: "#eceff1",
    NodeState.RUNNING: "#bbdefb",
    NodeState.PAUSE_REQUESTED: "#fff3c4",
    NodeState.PAUSED: "#fff3c4",
    NodeState.STOPPING: "#ffe0b2",
    NodeState.FINISHED: "#c8e6c9",
    NodeState.BYPASSED: "#f5f5f5",
    NodeState.ERROR: "#ffcdd2",
}
"""Background of an action in pictures; dark text stays readable on each of them."""


@dataclass(frozen=True, slots=True)
class Edge:
    """One arrow: from an action or the entry to an action or the exit."""

    source: NodeRef
    target: NodeRef
    label: str = ""


def show(graph: Graph, how: Format) -> str:
    """The graph in one of the three forms, with a line break at its end."""
    return FORMATS[how](graph)


def edges(graph: Graph) -> Iterator[Edge]:
    """Every arrow of the graph; a relation that leads to no action is left out."""
    nodes = {node.ref: node for node in graph.nodes}
    for relation in graph.entry:
        if relation.node in nodes:
            yield Edge(ENTRY, relation.node)
    for node in graph.nodes:
        for child in node.children:
            if child.node in nodes:
                back = [item for item in nodes[child.node].parents if item.node == node.ref]
                renames = [f"{source} as {target}" for source, target in child.remap]
                label = [_conditions(back[0])] if back else ["stated on one side only"]
                yield Edge(node.ref, child.node, "; ".join(filter(None, label + renames)))
    for leaving in graph.exit:
        if leaving.node in nodes:
            yield Edge(leaving.node, EXIT, _conditions(leaving))


def _conditions(relation: ParentRelation) -> str:
    stated = [
        f"{result.value} -> {relation.response(result).value}"
        for result, default in DEFAULT_CONDITIONS.items()
        if relation.response(result) is not default
    ]
    return ", ".join(stated if relation.required else [*stated, "not required"])


def _title(graph: Graph) -> str:
    return f"{graph.name} ({graph.state.value}){': ' + graph.description if graph.description else ''}"


def _values(node: Node) -> Iterator[str]:
    for name, parameter in node.input_parameters.items():
        yield f"{name} = {_value(parameter)}" if parameter.has_data else f"{name} ({parameter.type})"


def _value(parameter: Parameter) -> str:
    text = json.dumps(parameter.value, ensure_ascii=False, default=str)
    return text if len(text) <= MAX_VALUE else f"{text[: MAX_VALUE - 1]}…"


# -- text -------------------------------------------------------------------------------------------------


def as_text(graph: Graph) -> str:
    """The graph as an indented list from its entry on.

    A single next action stands below its parent, several are indented. ``↺`` leads back to an action from
    which this one was reached, ``⇢`` to one that is described elsewhere.
    """
    return "\n".join([_one_line(f"graph {_title(graph)}"), *_TextTree(graph).lines()]) + "\n"


class _TextTree:
    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._nodes = {node.ref: node for node in graph.nodes}
        self._after: dict[NodeRef, list[Edge]] = {}
        for edge in edges(graph):
            self._after.setdefault(edge.source, []).append(edge)
        self._shown: set[NodeRef] = set()

    def lines(self) -> Iterator[str]:
        yield from self._from(ENTRY)
        for node in self._graph.nodes:
            if node.ref not in self._shown:
                yield f"not reached from the entry: {_one_line(node.full_name)}"
                yield from self._from(node.ref, shown=False)

    def _from(self, start: NodeRef, *, shown: bool = True) -> Iterator[str]:
        """Depth first without recursion: graphs may be long."""
        first = self._after.get(start, []) if shown else [Edge(start, start)]
        waiting = [(edge, 0, frozenset[NodeRef]()) for edge in reversed(first)]
        while waiting:
            edge, level, above = waiting.pop()
            yield from self._line(edge, level, above)
            if edge.target in self._shown or edge.target == EXIT:
                continue
            self._shown.add(edge.target)
            following = self._after.get(edge.target, [])
            deeper = level + (sum(item.target != EXIT for item in following) > 1)
            # Of the way here only what could be led back to is kept: long chains would cost their square.
            here = above | {edge.target} if self._has_several_parents(edge.target) else above
            waiting += [(item, deeper, here) for item in reversed(following)]

    def _has_several_parents(self, ref: NodeRef) -> bool:
        is_entry = any(relation.node == ref for relation in self._graph.entry)
        return len(self._nodes[ref].parents) + is_entry > 1

    def _line(self, edge: Edge, level: int, above: frozenset[NodeRef]) -> Iterator[str]:
        indent = "    " * level
        aside = f"{indent}  "
        label = f"  [{_one_line(edge.label)}]" if edge.label else ""
        if edge.target == EXIT:
            yield f"{aside}→ exit{label}"
        elif edge.target in self._shown:
            back = edge.target in above
            yield f"{aside}{'↺' if back else '⇢'} {_one_line(edge.target.full_name)}{label}"
        else:
            node = self._nodes[edge.target]
            state = "" if node.state is NodeState.UNINITIALIZED else f" {node.state.value}"
            actor = f" @{node.actor}" if node.actor else ""
            several = [relation.node.full_name for relation in node.parents if relation.required]
            joins = f"  (waits for {', '.join(several)})" if len(several) > 1 else ""
            yield f"{indent}• {_one_line(node.full_name + actor)}{state}{_one_line(joins)}{label}"
            yield from (f"{indent}      {_one_line(text)}" for text in _values(node))
            if node.output_parameters:
                yield f"{indent}      gives {_one_line(', '.join(node.output_parameters))}"


def _one_line(text: str) -> str:
    """The text without anything that could move the cursor of a terminal."""
    return re.sub(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]", " ", text)


# -- Mermaid ----------------------------------------------------------------------------------------------


def as_mermaid(graph: Graph) -> str:
    """The graph as a Mermaid flowchart; states are classes, so a style sheet can colour them otherwise."""
    names = {node.ref: f"n{index}" for index, node in enumerate(graph.nodes)} | {
        ENTRY: "entry",
        EXIT: "leave",
    }
    lines = [
        "flowchart TD",
        f"    %% {_mermaid(_title(graph))}",
        '    entry(["entry"])',
        '    leave(["exit"])',
    ]
    for node in graph.nodes:
        text = "<br>".join(_mermaid(item) for item in (_heading(node), *_values(node)))
        lines.append(f'    {names[node.ref]}["{text}"]:::{node.state.value}')
    for edge in edges(graph):
        label = f'|"{_mermaid(edge.label)}"|' if edge.label else ""
        lines.append(f"    {names[edge.source]} -->{label} {names[edge.target]}")
    used = {node.state for node in graph.nodes}
    lines += [
        f"    classDef {state.value} fill:{colour},stroke:#455a64,color:#102027"
        for state, colour in STATE_COLOURS.items()
        if state in used
    ]
    return "\n".join(lines) + "\n"


def _heading(node: Node) -> str:
    return f"{node.full_name} @{node.actor}" if node.actor else node.full_name


def _mermaid(text: str) -> str:
    """Text inside of quotes: everything but plain characters as Mermaid's numeric entities."""
    plain = r"[^\w \-.,:=/@+()\[\]{}…]"
    return re.sub(plain, lambda found: f"#{ord(found.group())};", _one_line(text))


# -- SVG --------------------------------------------------------------------------------------------------


def as_svg(graph: Graph) -> str:
    """The graph as an SVG picture from top to bottom, colours by state."""
    boxes = {
        node.ref: ((_heading(node), *_values(node), node.state.value), STATE_COLOURS[node.state])
        for node in graph.nodes
    }
    boxes[ENTRY] = (("entry",), "#ffffff")
    boxes[EXIT] = (("exit",), "#ffffff")
    arrows = [(edge.source, edge.target, _one_line(edge.label)) for edge in edges(graph)]
    clean = {ref: (tuple(_one_line(line) for line in lines), fill) for ref, (lines, fill) in boxes.items()}
    return draw_svg(_one_line(_title(graph)), clean, arrows, first=ENTRY, last=EXIT)


FORMATS: Final[Mapping[Format, Callable[[Graph], str]]] = {
    "text": as_text,
    "mermaid": as_mermaid,
    "svg": as_svg,
}
"""How a graph can be shown."""
