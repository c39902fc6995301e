"""The behaviour trees that both forms can express, as values: what stands between a graph and its XML."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from parley.umrf.model import NodeRef

__all__ = [
    "FOREVER",
    "Fallback",
    "ForceSuccess",
    "Inverter",
    "Leaf",
    "Parallel",
    "Retry",
    "Sequence",
    "Shape",
    "ends",
    "fallback",
    "inverter",
    "leaves",
    "sequence",
    "starts",
]

FOREVER = -1
"""Attempts of a `Retry` that only a success ends."""


@dataclass(frozen=True, slots=True)
class Leaf:
    """One action. It fails when its action raises, and when it returns false unless `false_succeeds`."""

    node: NodeRef
    false_succeeds: bool = False


@dataclass(frozen=True, slots=True)
class Sequence:
    """One after the other, until one fails."""

    children: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Fallback:
    """One after the other, until one succeeds."""

    children: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Parallel:
    """All at once. The first failure ends it, or with `all_end` it waits for all and then fails."""

    children: tuple[Shape, ...]
    all_end: bool = False


@dataclass(frozen=True, slots=True)
class Retry:
    """Again until it succeeds, at most `attempts` times."""

    child: Shape
    attempts: int = FOREVER


@dataclass(frozen=True, slots=True)
class Inverter:
    """Success and failure exchanged."""

    child: Shape


@dataclass(frozen=True, slots=True)
class ForceSuccess:
    """Success, however the child ends."""

    child: Shape


Shape = Leaf | Sequence | Fallback | Parallel | Retry | Inverter | ForceSuccess


def sequence(*children: Shape) -> Shape:
    """A sequence without sequences directly inside; of one child, that child."""
    flat = [part for item in children for part in (item.children if isinstance(item, Sequence) else (item,))]
    return flat[0] if len(flat) == 1 else Sequence(tuple(flat))


def fallback(*children: Shape) -> Shape:
    """A fallback without fallbacks directly inside; of one child, that child."""
    flat = [part for item in children for part in (item.children if isinstance(item, Fallback) else (item,))]
    return flat[0] if len(flat) == 1 else Fallback(tuple(flat))


def inverter(child: Shape) -> Shape:
    """The opposite of `child`."""
    return child.child if isinstance(child, Inverter) else Inverter(child)


def leaves(shape: Shape) -> Iterator[Leaf]:
    """All actions, in the order in which they are written."""
    match shape:
        case Leaf():
            yield shape
        case Sequence() | Fallback() | Parallel():
            for child in shape.children:
                yield from leaves(child)
        case Retry() | Inverter() | ForceSuccess():
            yield from leaves(shape.child)


def starts(shape: Shape) -> tuple[NodeRef, ...]:
    """The actions that run first."""
    match shape:
        case Leaf():
            return (shape.node,)
        case Sequence() | Fallback():
            return starts(shape.children[0])
        case Parallel():
            return tuple(ref for child in shape.children for ref in starts(child))
        case _:
            return starts(shape.child)


def ends(shape: Shape, success: bool) -> tuple[NodeRef, ...]:
    """The actions that may run last before success (or failure)."""
    match shape:
        case Leaf():
            return (shape.node,)
        case Sequence() | Fallback() if isinstance(shape, Sequence) == success:
            return ends(shape.children[-1], success)
        case Sequence() | Fallback() | Parallel():
            return tuple(ref for child in shape.children for ref in ends(child, success))
        case Retry():
            return ends(shape.child, True) if success else ()
        case Inverter():
            return ends(shape.child, not success)
        case ForceSuccess():
            both = (*ends(shape.child, True), *ends(shape.child, False)) if success else ()
            return tuple(dict.fromkeys(both))
