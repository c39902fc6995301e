"""Trust nothing that a language engine planned: complete it from the catalogue, then check it.

The rules of a graph are those of `parley.umrf.check`; here a queue of actions is made into a graph for it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from parley.agents.planner.flow import check_flow, placed_steps, unrolled
from parley.agents.planner.graph import build_graph
from parley.agents.planner.steps import Step, previous, stages
from parley.errors import Problem
from parley.messages.chat import ActionCall
from parley.messages.completing import completed
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check
from parley.umrf.model import Graph, Node, Response

__all__ = ["MAX_ACTIONS", "check_calls", "complete_calls", "plan_problems", "spec_of"]

MAX_ACTIONS = 200
"""More than this in one message is not a plan that a person can follow."""


def spec_of(info: ActionInfo) -> ActionSpec:
    """The bare descriptor behind what a robot says of an action."""
    return ActionSpec(
        name=info.name,
        inputs={
            name: Parameter(kind, required=name not in info.optional) for name, kind in info.inputs.items()
        },
        outputs={name: Parameter(kind) for name, kind in info.outputs.items()},
        description=info.description,
        label=info.label,
        phrases=info.phrases,
        effects=info.effects,
        risk=info.risk,
        capabilities=info.capabilities,
    )


def complete_calls(
    calls: Iterable[ActionCall], catalogue: Iterable[ActionInfo], *, known: int = 0
) -> list[ActionCall]:
    """Spell out inputs and outputs that were left out; a graph must name them all (`spec/umrf.md` 7.2).

    What is to be repeated is there as often as it is to run.

    Args:
        calls: As received.
        catalogue: What the robot can do.
        known: How many steps the flows count before `calls`.
    """
    infos = {info.name: info for info in catalogue}
    calls = list(calls)
    # A flow that is impossible stays as it is, so that `check_calls` can say where.
    calls = calls if check_flow(calls, known) else unrolled(calls, known)
    return [completed(call, infos[call.name]) if call.name in infos else call for call in calls]


def plan_problems(
    calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo], before: Sequence[ActionCall] = ()
) -> list[Problem]:
    """Why a plan that was just worked out cannot be carried out, for whoever works plans out.

    Args:
        calls: What is to be done, as it was said.
        catalogue: What the robot can do.
        before: What ran right before and hands its outputs on.
    """
    done = [Step(call) for call in complete_calls(before, catalogue)]
    return check_calls(complete_calls(calls, catalogue), catalogue, before=done)


def check_calls(
    calls: Sequence[ActionCall],
    catalogue: Iterable[ActionInfo],
    *,
    before: Sequence[Step] = (),
    known: Sequence[Step] = (),
    path: str = "queue",
) -> list[Problem]:
    """Why these actions cannot be carried out, each with where and what would help; empty if they can.

    Args:
        calls: What is to be done.
        catalogue: What the robot can do; empty if that is not known: then only the flows are checked.
        before: The plan so far, whose last steps hand their outputs on.
        known: The steps that flows count before `calls`.
        path: What `calls` is called in the message it came by.
    """
    if len(calls) > MAX_ACTIONS:
        text = f"{len(calls)} actions are more than the {MAX_ACTIONS} allowed"
        return [Problem(path, text, "ask for less at a time", "too_long")]
    problems = check_flow(calls, len(known))
    infos = list(catalogue)
    if not problems and calls and infos:
        problems = _check_steps(calls, infos, before, known)
    return [replace(item, path=re.sub(r"^queue\b", path, item.path)) for item in problems]


def _check_steps(
    calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo], before: Sequence[Step],
    known: Sequence[Step],
) -> list[Problem]:  # fmt: skip
    givers = [Step(step.call, index) for index, step in enumerate(previous(before, len(before), object()))]
    for giver in givers:
        giver.together = givers[0].together
    placed = placed_steps(calls, before, known)
    steps = [step for step, _ in placed]
    for index, step in enumerate(steps, len(givers)):
        step.instance_id = index
    graph = build_graph("plan", [*givers, *steps])
    places = {index: place for index, (_, place) in enumerate(placed, len(givers))}
    # What runs already got what it needs from steps that are not part of this.
    given = tuple(f"actions[{index}]" for index in range(len(givers)))
    found = check(graph, Catalogue([spec_of(info) for info in catalogue]))
    problems = [problem for problem in found if not problem.path.startswith(given)]
    if not problems:
        problems = [*_unfed(graph, len(givers), catalogue), *_both_move(steps, len(givers), catalogue)]
    return [replace(item, path=_placed(item.path, places)) for item in problems]


def _placed(path: str, places: Mapping[int, int]) -> str:
    """The path as the sender of the queue knows it."""
    return re.sub(
        r"^actions\[(\d+)\]", lambda found: f"queue[{places.get(int(found[1]), int(found[1]))}]", path
    )


def _unfed(graph: Graph, first: int, catalogue: Sequence[ActionInfo]) -> list[Problem]:
    """Where several ways lead to a step, each must bring what it needs."""
    optional = {info.name: set(info.optional) for info in catalogue}
    nodes = {node.ref: node for node in graph.nodes}
    problems: list[Problem] = []
    for index, node in enumerate(graph.nodes[first:], first):
        ways = [nodes[p.node] for p in node.parents if Response.RUN in p.conditions.values()]
        together = all(parent.required for parent in node.parents)
        needs = [
            name
            for name, parameter in node.input_parameters.items()
            if not parameter.has_data and name not in optional.get(node.name, ())
        ]
        for name in needs:
            lacking = [way for way in ways if name not in way.output_parameters]
            if lacking and (not together or len(lacking) == len(ways)):
                problems.append(_no_value(index, node, name, lacking[0]))
    return problems


def _no_value(index: int, node: Node, name: str, way: Node) -> Problem:
    return Problem(
        f"actions[{index}].input_parameters.{name.replace('::', '.')}",
        f"{node.name} needs {name}, which is not given if it comes right after {way.full_name}",
        "give it a value, or let the step depend on the one that gives it",
        "missing_input",
    )


def _both_move(steps: Sequence[Step], first: int, catalogue: Sequence[ActionInfo]) -> list[Problem]:
    """One robot cannot go to two places at once."""
    moving = {info.name for info in catalogue if "moves" in info.effects}
    places = {id(step): index for index, step in enumerate(steps, first)}
    return [
        Problem(
            f"actions[{places[id(step)]}].flow.together_with",
            "two steps that both move the robot cannot run at the same time",
            "let one run after the other",
            "impossible_flow",
        )
        for group in stages(steps)
        for step in [step for step in group if step.call.name in moving][1:]
    ]
