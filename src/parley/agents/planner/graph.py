"""The UMRF graph of a plan (`spec/umrf.md` 5, 10.4, 12.6): fan-outs, joins, or-joins, conditions. Pure.

Errors and ends halt the graph, as in the thesis: the planner repairs it and says where to go on. What an edge
cannot say halts it too, and the planner decides: a condition on a step further back than the one that just
ended, and ways that meet of which one is several steps at once.

Of steps that run at the same time each stops the others when it fails (``on_error -> stop``). Without that,
what comes behind them would run in spite of the failure: an edge that was ignored counts as received (10.4).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from parley.agents.planner.steps import Step, When, stages, verdict
from parley.engine.interrupted import FLOW_KEY, ORDER_KEY
from parley.umrf.model import ChildRelation, Graph, Node, NodeRef, ParentRelation, Response, Result

__all__ = ["Link", "build_graph", "links"]

_ENDS: Final = (Result.ON_TRUE, Result.ON_FALSE)
_IGNORE: Final[Mapping[Result, Response]] = dict.fromkeys(
    (Result.ON_TRUE, Result.ON_FALSE, Result.ON_STOPPED, Result.ON_ERROR), Response.IGNORE
)
_STOP: Final[Mapping[Result, Response]] = {**_IGNORE, Result.ON_ERROR: Response.STOP}

Facts = dict[int, bool]
"""What is known on a way through the plan: identity of a step -> how it ended."""


@dataclass(slots=True)
class Link:
    """The edges from each step of one group to each of a later one."""

    source: list[Step]
    target: list[Step]
    runs: set[Result] = field(default_factory=set)
    """After which results of the source the target runs; none: the planner says when."""
    required: bool = False

    def relation(self, giver: Step, taker: Step) -> ParentRelation:
        """What `taker` says of `giver`."""
        if taker.state == "finished":  # it is not to run again
            return ParentRelation(_ref(giver), False, _IGNORE)
        conditions = {**_IGNORE, **dict.fromkeys(self.runs, Response.RUN)}
        single = len(self.source) == len(self.target) == 1
        # A finished step sends nothing any more; what is told to go on must not count as waiting for it.
        required = self.required and (single or giver.state != "finished")
        return ParentRelation(_ref(giver), required, conditions)


def build_graph(name: str, steps: Sequence[Step]) -> Graph:
    """The graph of `steps`, which are numbered and in the order of the plan."""
    groups = stages(steps)
    parents: dict[int, list[ParentRelation]] = {id(step): [] for step in steps}
    children: dict[int, list[ChildRelation]] = {id(step): [] for step in steps}
    for link in links(groups):
        for giver in link.source:
            for taker in link.target:
                children[id(giver)].append(ChildRelation(_ref(taker)))
                parents[id(taker)].append(link.relation(giver, taker))
    for group in groups:
        beside = [step for step in group if step.state != "finished"]
        for step in beside:
            for other in beside:
                if step is not other:
                    children[id(step)].append(ChildRelation(_ref(other)))
                    parents[id(other)].append(ParentRelation(_ref(step), False, _STOP))
    nodes = tuple(
        Node(
            name=step.call.name,
            instance_id=step.instance_id,
            description=step.call.reason,
            input_parameters=step.call.input_parameters,
            output_parameters=step.call.output_parameters,
            parents=tuple(parents[id(step)]),
            children=tuple(children[id(step)]),
            gui_attributes=_attributes_of(step, group[0]),
        )
        for group in groups
        for step in group
    )
    return Graph(
        name=name,
        nodes=nodes,
        entry=tuple(ChildRelation(_ref(step)) for step in groups[0]) if groups else (),
        exit=tuple(ParentRelation(_ref(step), True, _IGNORE) for step in groups[-1]) if groups else (),
    )


def _attributes_of(step: Step, first: Step) -> dict[str, Any] | None:
    """What the planner reads back from a graph that outlived it; edges alone do not tell it."""
    flow: dict[str, Any] = {}
    if step.when is not None:
        flow["if"] = {"node": step.when.step.node, "result": step.when.result}
    if step is not first:
        flow["together_with"] = first.node
    found = {FLOW_KEY: flow} if flow else {}
    return found | ({ORDER_KEY: step.order} if step.order else {}) or None


def links(groups: Sequence[list[Step]]) -> list[Link]:
    """How the groups of a plan follow each other."""
    return _Router(groups).links()


class _Mixed:
    """Stands for the conditions of a group whose steps have different ones."""


class _Router:
    def __init__(self, groups: Sequence[list[Step]]) -> None:
        self.groups = groups
        self.place = {id(step): index for index, group in enumerate(groups) for step in group}
        self.conditions = [self._condition(group) for group in groups]
        self.asked = {id(item.step) for item in self.conditions if isinstance(item, When)}
        self.found: dict[tuple[int, int], Link] = {}

    def links(self) -> list[Link]:
        """Every link, in the order of the plan."""
        for index, group in enumerate(self.groups):
            facts = self._facts(index)
            if len(group) == 1 and id(group[0]) in self.asked:
                for result, end in zip((True, False), _ENDS, strict=True):
                    self._lead(index, {**facts, id(group[0]): result}, (end,))
            else:
                self._lead(index, facts, _ENDS)
        self._join()
        reached = {target for _, target in self.found}
        for index in range(1, len(self.groups)):
            if index not in reached:
                self._link(index - 1, index)
        return [self.found[key] for key in sorted(self.found)]

    def _lead(self, source: int, facts: Facts, ends: Sequence[Result]) -> None:
        """Find what comes after `source` if `facts` hold."""
        for target in range(source + 1, len(self.groups)):
            holds = self._holds(target, facts)
            if holds is not False:
                self._link(source, target).runs.update(ends if holds else ())
                return

    def _join(self) -> None:
        """One way in: all of it is needed. Several ways in: whichever comes."""
        ways: dict[int, list[Link]] = {}
        for (_, target), link in self.found.items():
            if link.runs:
                ways.setdefault(target, []).append(link)
        for incoming in ways.values():
            for link in incoming:
                link.required = len(incoming) == 1
                if not link.required and len(link.source) > 1:
                    link.runs.clear()

    def _link(self, source: int, target: int) -> Link:
        return self.found.setdefault((source, target), Link(self.groups[source], self.groups[target]))

    def _condition(self, group: Sequence[Step]) -> When | _Mixed | None:
        open_ones = [step.when if verdict(step) is None else None for step in group]
        first = open_ones[0]
        if all(_same(item, first) for item in open_ones[1:]):
            return first
        return _Mixed()

    def _facts(self, index: int) -> Facts:
        """What must have happened where this group runs."""
        facts: Facts = {}
        condition = self.conditions[index]
        while isinstance(condition, When):
            facts[id(condition.step)] = condition.result
            place = self.place.get(id(condition.step))
            condition = self.conditions[place] if place is not None else None
        return facts

    def _holds(self, index: int, facts: Facts) -> bool | None:
        condition = self.conditions[index]
        if condition is None:
            return True
        if not isinstance(condition, When):
            return None
        known = facts.get(id(condition.step))
        if known is not None:
            return known is condition.result
        place = self.place.get(id(condition.step))
        above = self._holds(place, facts) if place is not None and place < index else None
        return False if above is False else None


def _same(first: When | None, second: When | None) -> bool:
    if first is None or second is None:
        return first is second
    return first.step is second.step and first.result is second.result


def _ref(step: Step) -> NodeRef:
    return NodeRef(step.call.name, step.instance_id)
