"""Small graphs for tests, and random ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from hypothesis import strategies as st

from parley.umrf.model import ChildRelation, Graph, Node, NodeRef, ParentRelation, Response, Result
from parley_bt.shape import (
    Fallback,
    ForceSuccess,
    Inverter,
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
from parley_bt.shape import Sequence as Row

RESULTS = (Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR)
DEFAULT, STRICT, RECOVER, ALWAYS = "run run bypass", "run bypass bypass", "bypass run run", "run run run"
STYLES = (
    DEFAULT, DEFAULT, STRICT, RECOVER, ALWAYS,
    "run run ignore", "run ignore ignore", "ignore run run", "ignore ignore run", "bypass bypass run",
)  # fmt: skip


def conditions(words: str) -> dict[Result, Response]:
    """Answers to true, false and error."""
    return dict(zip(RESULTS, map(Response, words.split()), strict=True))


def graph(
    edges: Mapping[tuple[str, str], str],
    *,
    entry: Sequence[str] = ("A",),
    leave: Mapping[str, str] | None = None,
    nodes: Mapping[str, Mapping[str, Any]] | None = None,
) -> Graph:
    """A graph of actions with one letter each.

    Args:
        edges: Answers to true, false and error by edge; with ``?`` at the end the parent is not required.
        entry: Where it begins.
        leave: Exit actions with their answers.
        nodes: More about nodes, by name.
    """
    leave, more = leave or {}, nodes or {}
    names = sorted({name for edge in edges for name in edge} | {*entry, *leave, *more})

    def parent(name: str, words: str) -> ParentRelation:
        return ParentRelation(NodeRef(name), not words.endswith("?"), conditions(words.rstrip("?")))

    return Graph(
        "g",
        tuple(
            Node(
                name,
                parents=tuple(parent(one, words) for (one, other), words in edges.items() if other == name),
                children=tuple(ChildRelation(NodeRef(other)) for one, other in edges if one == name),
                **more.get(name, {}),
            )
            for name in names
        ),
        tuple(ChildRelation(NodeRef(name)) for name in entry),
        tuple(parent(name, words) for name, words in leave.items()),
    )


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    """Layers of actions, mostly with the usual conditions, and something odd here and there."""
    layers: list[list[str]] = []
    letters = iter("ABCDEFGH")
    for _ in range(draw(st.integers(1, 4))):
        layers.append([next(letters) for _ in range(draw(st.sampled_from([1, 1, 1, 2])))])
    names = [name for layer in layers for name in layer]
    needed = st.sampled_from(["", "", "", "", "?"])
    edges = {
        (one, other): draw(st.sampled_from(STYLES)) + draw(needed)
        for above, below in pairwise(layers)
        for one in above
        for other in below
    }
    for _ in range(draw(st.integers(0, 2))):
        one, other = draw(st.sampled_from(names)), draw(st.sampled_from(names))
        backward = names.index(one) >= names.index(other)
        edges[one, other] = draw(st.sampled_from(STYLES)) + ("?" if backward else draw(needed))
    leaving = [*layers[-1], *draw(st.lists(st.sampled_from(names), max_size=1))]
    leave = {name: draw(st.sampled_from([DEFAULT, *STYLES])) for name in leaving if draw(st.integers(0, 4))}
    return graph(edges, entry=layers[0], leave=leave)


@st.composite
def shapes(draw: st.DrawFn) -> Shape:
    """Trees that a graph can hold: actions `Step` numbered in the order in which they are written."""
    count = 0

    def shape(depth: int, kinds: str) -> Shape:
        nonlocal count
        kind = draw(st.sampled_from(kinds)) if depth else "L"
        if kind == "L":
            count += 1
            return Leaf(NodeRef("Step", count - 1), draw(st.booleans()))
        if kind in "IWR":
            child = shape(depth - 1, kinds)
            follows_itself = bool(set(starts(child)) & set(ends(child, False)))
            return {"I": inverter(child), "W": ForceSuccess(child)}.get(
                kind, child if follows_itself else Retry(child)
            )
        children = [shape(depth - 1, kinds) for _ in range(draw(st.integers(2, 3)))]
        return {"S": sequence(*children), "F": fallback(*children)}.get(kind, Parallel(tuple(children)))

    # What ends the tree has to fail as its action does, so the last part is plain.
    first = shape(2, draw(st.sampled_from(["LSF", "LSFIWR", "LSP"])))
    return sequence(first, strict(shape(draw(st.integers(0, 2)), "LSF")))


def strict(shape: Shape) -> Shape:
    """The same tree with actions whose false is a failure."""
    match shape:
        case Leaf():
            return Leaf(shape.node)
        case Row():
            return sequence(*map(strict, shape.children))
        case Fallback():
            return fallback(*map(strict, shape.children))
        case Parallel():
            return Parallel(tuple(map(strict, shape.children)), shape.all_end)
        case Inverter():
            return Inverter(strict(shape.child))
        case Retry():
            return Retry(strict(shape.child))
        case ForceSuccess():
            return ForceSuccess(strict(shape.child))


scripts = st.lists(st.text("TFE", min_size=1, max_size=3), min_size=9, max_size=9)
"""Endings for up to nine actions, more often good than not."""
