"""An order to a team as one graph of several actors (`spec/umrf.md` 13), for programs that take such graphs.

Each robot's part is a way of its own through the graph, and leads into the parts that come after it. Parley
itself gives each robot a graph of its own: who stops one robot then stops no other, and what one robot was at
goes on when it or another one has been away.
"""

from __future__ import annotations

import itertools

from parley.agents.planner.flow import steps_of
from parley.agents.planner.graph import Link, build_graph
from parley.agents.planner.steps import Step, stages
from parley.messages.team import MissionInfo
from parley.umrf.model import ChildRelation, Graph, NodeRef, Result

__all__ = ["mission_graph"]

_ENDS = {Result.ON_TRUE, Result.ON_FALSE}


def mission_graph(mission: MissionInfo) -> Graph:
    """All parts as they were ordered, and who waits for whom."""
    parts = [part for part in mission.parts if part.steps and not part.instead_of]
    ids = itertools.count()
    graphs: dict[str, Graph] = {}
    groups: dict[str, list[list[Step]]] = {}
    for part in parts:
        steps = steps_of(part.steps, [])
        for step in steps:
            step.instance_id = next(ids)
        groups[part.robot], graphs[part.robot] = stages(steps), build_graph(part.robot, steps)
    nodes = {node.ref: node._replace(actor=name) for name, own in graphs.items() for node in own.nodes}
    awaited: set[str] = set()
    free: list[str] = []
    for part in parts:
        before = [name for name in part.after if name in groups]
        awaited.update(before)
        free += [] if before else [part.robot]
        for name in before:
            link = Link(groups[name][-1], groups[part.robot][0], _ENDS, required=True)
            for giver, taker in itertools.product(link.source, link.target):
                one, other = (NodeRef(step.call.name, step.instance_id) for step in (giver, taker))
                nodes[one] = nodes[one]._replace(children=(*nodes[one].children, ChildRelation(other)))
                relation = link.relation(giver, taker)
                nodes[other] = nodes[other]._replace(parents=(*nodes[other].parents, relation))
    return Graph(
        name=f"mission_{mission.id}",
        description=mission.words,
        nodes=tuple(nodes.values()),
        entry=tuple(relation for name in free for relation in graphs[name].entry),
        exit=tuple(r for name, own in graphs.items() if name not in awaited for r in own.exit),
    )
