"""From a graph to the tree that does the same, or to the reasons why there is none.

Regions, at first one per action, know where they go on after success and after failure. Two that share all
but one way become one region; a graph that has a tree shrinks to a single one.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import Final, Literal

from parley.errors import GraphRefusedError, Problem
from parley.umrf.model import EXIT, Graph, NodeRef, Result
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
    fallback,
    inverter,
    sequence,
)
from parley_bt.ways import Cont, Edge, Way, Ways

__all__ = ["structure"]

MAX_DEPTH: Final = 250
"""BehaviorTree.CPP refuses XML nested deeper than 256; some levels go to the frame."""

_START: Final = NodeRef("", 0)
"""Stands for the graph's entry among the regions."""

Side = Literal["ok", "bad"]


def structure(graph: Graph) -> Shape:
    """The tree of a graph.

    Raises:
        GraphRefusedError: It has none; with codes of `EXPORT_REASONS`.
    """
    ways = Ways(graph)
    problems = ways.problems
    if not problems:
        reducer = _Reducer(ways)
        shape = reducer.reduce() if not problems else None
        problems = problems or reducer.problems
        if shape is not None and not problems:
            return shape
    raise GraphRefusedError(graph.name, problems)


@dataclass(slots=True)
class _Region:
    shape: Shape
    ok: Way | None
    """After success; None if it never succeeds."""
    bad: Way | None
    """After failure; None if it never fails."""

    def ways(self) -> list[Way]:
        return [way for way in (self.ok, self.bad) if way is not None]


class _Reducer:
    def __init__(self, ways: Ways) -> None:
        self._ways = ways
        self.problems: list[Problem] = []
        self._resolved: set[NodeRef] = set()
        self._regions: dict[NodeRef, _Region] = {
            _START: _Region(Sequence(()), ways.entry(), None),
            **{ref: self._leaf(ref) for ref in ways.nodes},
        }
        self._uses = Counter(
            target
            for region in self._regions.values()
            for way in region.ways()
            for target in way.cont.targets
        )

    def reduce(self) -> Shape | None:
        """The whole graph as one tree; None if that did not work, with `problems` said."""
        if self.problems:
            return None
        names = [ref for ref in self._regions if ref != _START]
        names.append(_START)
        going_on = True
        while going_on:
            going_on = False
            for ref in names:
                while ref in self._regions and self._step(ref):
                    going_on = True
            names = [ref for ref in names if ref in self._regions]
        start = self._regions[_START].ok
        rest = [ref for ref in names if ref != _START]
        if start is not None and not self.problems and len(rest) == 1 and start.cont.targets == {rest[0]}:
            region = self._regions[rest[0]]
            if all(way.cont.is_end for way in region.ways()):
                self._check_depth(region.shape)
                return region.shape
        self._explain(rest)
        return None

    def _leaf(self, ref: NodeRef) -> _Region:
        true, false, error = (
            self._ways.follow(ref, result) for result in (Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR)
        )
        if _same(true, false):
            return _Region(Leaf(ref, false_succeeds=True), _either(true, false), error)
        if _same(false, error):
            return _Region(Leaf(ref), true, _either(false, error))
        self.problems.append(refusal("three_ways", self._ways.path(ref), ref.full_name))
        return _Region(Leaf(ref), true, error)

    # -- one step of shrinking ------------------------------------------------------------------------------

    def _step(self, ref: NodeRef) -> bool:
        region = self._regions[ref]
        if self._force(region) or self._loop(ref, region):
            return True
        sides: tuple[Side, ...] = ("ok", "bad")
        return any(
            self._resolve(region, s) or self._follow(ref, region, s) or self._fork(region, s) for s in sides
        )

    def _force(self, region: _Region) -> bool:
        """Success and failure lead to one place: no need to tell them apart."""
        if region.ok is None or region.bad is None or not _same(region.ok, region.bad):
            return False
        self._uses.subtract(region.bad.cont.targets)
        region.shape, region.ok, region.bad = _forced(region.shape), _either(region.ok, region.bad), None
        return True

    def _loop(self, ref: NodeRef, region: _Region) -> bool:
        """A way back to its own beginning is a retry."""
        if region.bad is not None and region.bad.cont.targets == {ref}:
            region.shape, region.bad = Retry(region.shape), None
        elif region.ok is not None and region.ok.cont.targets == {ref}:
            region.shape, region.ok = inverter(Retry(inverter(region.shape))), None
        else:
            return False
        self._uses[ref] -= 1
        return True

    def _resolve(self, region: _Region, side: Side) -> bool:
        """A join is an ordinary next step once all that it requires has certainly been seen."""
        way = getattr(region, side)
        if way is None:
            return False
        arrived = {
            target
            for target in way.cont.targets & self._ways.joins.keys() - self._resolved
            if self._uses[target] == 1 and self._arrived(target, way.seen)
        }
        if arrived == {EXIT} == way.cont.targets:
            self._uses[EXIT] = 0
            setattr(region, side, Way(Cont(verdict=side == "ok", end="finish"), way.seen))
            return True
        self._resolved |= arrived - {EXIT}
        return bool(arrived - {EXIT})

    def _follow(self, ref: NodeRef, region: _Region, side: Side) -> bool:
        """What only this region leads to becomes part of it, if the other ways of both agree."""
        target = _only(getattr(region, side))
        if ref == _START or target is None or target == ref or target not in self._regions:
            return False
        if self._uses[target] != 1 or (target in self._ways.joins and target not in self._resolved):
            return False
        after = self._regions[target]
        other = region.bad if side == "ok" else region.ok
        same_side, cross_side = (after.bad, after.ok) if side == "ok" else (after.ok, after.bad)
        straight = other is None or same_side is None or _same(other, same_side)
        if not straight and (cross_side is None or not _same(other, cross_side)):
            return False
        first = region.shape if straight else inverter(region.shape)
        follows_success = (side == "ok") == straight
        region.shape = (sequence if follows_success else fallback)(first, after.shape)
        self._join_ways(region, side, after, joins_ok=not follows_success)
        del self._regions[target]
        return True

    def _join_ways(self, region: _Region, side: Side, after: _Region, *, joins_ok: bool) -> None:
        through = getattr(region, side)
        other = region.bad if side == "ok" else region.ok
        ok = None if after.ok is None else Way(after.ok.cont, after.ok.seen | through.seen)
        bad = None if after.bad is None else Way(after.bad.cont, after.bad.seen | through.seen)
        self._uses.subtract(through.cont.targets)
        if other is not None:
            mine = ok if joins_ok else bad
            if mine is not None:
                self._uses.subtract(other.cont.targets)
            joined = other if mine is None else _either(other, mine)
            ok, bad = (joined, bad) if joins_ok else (ok, joined)
        region.ok, region.bad = ok, bad

    def _fork(self, region: _Region, side: Side) -> bool:
        """Several next steps that only this region leads to, and that all lead to one join or to no more."""
        way: Way | None = getattr(region, side)
        if way is None or len(way.cont.targets) < 2:
            return False
        waiting = {ref for ref in way.cont.targets if ref in self._ways.joins and ref not in self._resolved}
        groups: dict[Cont, list[NodeRef]] = {}
        for ref in sorted(way.cont.targets - waiting, key=lambda ref: self._ways.index[ref]):
            after = self._regions[ref].ok
            if after is not None and self._uses[ref] == 1:
                groups.setdefault(after.cont, []).append(ref)
        for end, heads in groups.items():
            is_all = len(heads) == len(way.cont.targets - waiting)
            branches = [self._regions[ref] for ref in heads]
            together = self._together(branches, way, end, waiting if is_all else None)
            if together is not None:
                left = frozenset() if is_all else way.cont.targets - {*heads}
                self._replace(region, side, heads, together, left)
                return True
        return False

    def _together(
        self, branches: list[_Region], way: Way, end: Cont, waiting: set[NodeRef] | None
    ) -> _Region | None:
        """One region of branches with a common end.

        Args:
            branches: What runs at once.
            way: How they are reached.
            end: Where they lead after success.
            waiting: Joins that the fork itself leads to; None if it leads to other branches as well.
        """
        if end.is_end:
            return self._apart(branches) if waiting == set() and end.end == "dry" else None
        together = self._joined(branches, way, end, waiting or set())
        if waiting is not None or together is None or together.ok is None:
            return together
        # Branches that are some of several must not need the others, which may meet elsewhere.
        complete = len(branches) > 1 and end.targets.isdisjoint(way.cont.targets)
        seen = together.ok.seen
        return together if complete and all(self._arrived(join, seen) for join in end.targets) else None

    def _replace(
        self, region: _Region, side: Side, heads: list[NodeRef], together: _Region, left: frozenset[NodeRef]
    ) -> None:
        """Put `together` into the place of the branches `heads`; `left` are other ways of the fork."""
        way: Way = getattr(region, side)
        gone = [way, *(item for ref in heads for item in self._regions.pop(ref).ways())]
        for item in gone:
            self._uses.subtract(item.cont.targets)
        self._regions[heads[0]] = together
        setattr(region, side, Way(Cont(left | {heads[0]}), way.seen))
        self._uses.update([heads[0], *left, *(ref for item in together.ways() for ref in item.cont.targets)])

    def _apart(self, branches: list[_Region]) -> _Region | None:
        """Branches that nothing follows: each runs to its own end."""
        bad = [branch.bad for branch in branches if branch.bad is not None]
        if not all(way.cont.end == "dry" for way in bad):
            return None
        shape = Parallel(tuple(branch.shape for branch in branches), all_end=True)
        ends = Way(Cont(verdict=True, end="dry")), Way(Cont(verdict=False, end="dry")) if bad else None
        return _Region(shape, *ends)

    def _joined(self, branches: list[_Region], way: Way, end: Cont, waiting: set[NodeRef]) -> _Region | None:
        """Branches that meet at the same joins; a branch may be empty (the fork names the join itself)."""
        joins = end.targets
        if waiting - joins or joins - self._ways.joins.keys() or joins & self._resolved:
            return None
        seen = [branch.ok.seen for branch in branches if branch.ok is not None]
        if len(seen) < len(branches) or not self._each_needed(joins, [*seen, way.seen]):
            return None
        bad = [branch.bad for branch in branches if branch.bad is not None]
        if len(branches) == 1:
            failed = Way(bad[0].cont, bad[0].seen | way.seen) if bad else None
            return _Region(branches[0].shape, Way(end, seen[0] | way.seen), failed)
        if not all(item.cont.end == "finish" for item in bad):
            return None
        shape = Parallel(tuple(branch.shape for branch in branches))
        failed = Way(Cont(verdict=False, end="finish")) if bad else None
        return _Region(shape, Way(end, way.seen.union(*seen)), failed)

    def _arrived(self, join: NodeRef, seen: frozenset[Edge]) -> bool:
        return all((parent, join) in seen for parent in self._ways.joins[join])

    def _each_needed(self, joins: frozenset[NodeRef], seen: list[frozenset[Edge]]) -> bool:
        """Whether the joins wait for every branch, so that they are run once, by the last."""
        *branches, before = seen
        for position, own in enumerate(branches):
            new = own - before.union(*branches[:position], *branches[position + 1 :])
            for join in joins:
                if not any((parent, join) in new for parent in self._ways.joins[join]):
                    return False
        return True

    # -- why not --------------------------------------------------------------------------------------------

    def _check_depth(self, shape: Shape) -> None:
        if _depth(shape) > MAX_DEPTH:
            self.problems.append(refusal("too_deep", "actions"))

    def _explain(self, rest: list[NodeRef]) -> None:
        reached: set[NodeRef] = set()
        waiting = [_START]
        while waiting:
            region = self._regions.get(waiting.pop())
            new = {t for way in (region.ways() if region else ()) for t in way.cont.targets} - reached
            reached |= new
            waiting += new
        for ref in [ref for ref in rest if ref not in reached]:
            self.problems.append(refusal("unreachable_node", self._ways.path(ref), ref.full_name))
        if self.problems:
            return
        for join in [ref for ref in self._ways.joins if ref in reached and ref not in self._resolved]:
            code = "join_error" if self._fails_apart(join) else "join_never"
            self.problems.append(refusal(code, self._ways.path(join), join.full_name))
        if not self.problems:
            names = ", ".join(ref.full_name for ref in rest) or "no action"
            self.problems.append(refusal("unstructured", "actions", names))

    def _fails_apart(self, join: NodeRef) -> bool:
        """Whether a branch of `join` has a failure that would not end the graph at once."""
        into = [item for item in self._regions.values() if item.ok and join in item.ok.cont.targets]
        return len(into) > 1 and any(item.bad and item.bad.cont.end != "finish" for item in into)


def _same(one: Way | None, other: Way | None) -> bool:
    return one is not None and other is not None and one.cont.same(other.cont)


def _either(one: Way, other: Way) -> Way:
    """What is certain if either of two ways was gone."""
    end = one.cont if one.cont.end == other.cont.end else replace(one.cont, end="either")
    return Way(end, one.seen & other.seen)


def _only(way: Way | None) -> NodeRef | None:
    return next(iter(way.cont.targets)) if way is not None and len(way.cont.targets) == 1 else None


def _forced(shape: Shape) -> Shape:
    return ForceSuccess(shape.child if isinstance(shape, Inverter) else shape)


def _depth(shape: Shape) -> int:
    """Levels of elements; shapes of a converted graph are as deep as they were built, so no recursion."""
    deepest, waiting = 0, [(shape, 1)]
    while waiting:
        at, level = waiting.pop()
        deepest = max(deepest, level)
        if isinstance(at, Sequence | Fallback | Parallel):
            waiting += [(child, level + 1) for child in at.children]
        elif not isinstance(at, Leaf):
            waiting.append((at.child, level + 1))
    return deepest
