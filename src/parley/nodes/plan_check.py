"""Trust nothing that a language engine planned: complete it from the catalogue, then check it.

The rules of a graph are those of `parley.umrf.check`; here a queue of actions is made into a graph for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from parley.errors import Problem
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo
from parley.nodes.plan_steps import Step, build_graph, unrolled
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check

__all__ = ["MAX_ACTIONS", "check_calls", "complete_calls", "spec_of"]

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
        phrases=info.phrases,
        effects=info.effects,
        risk=info.risk,
        capabilities=info.capabilities,
    )


def complete_calls(calls: Iterable[ActionCall], catalogue: Iterable[ActionInfo]) -> list[ActionCall]:
    """Spell out inputs and outputs that were left out; a graph must name them all (`spec/umrf.md` 7.2).

    What is to be repeated is there as often as it is to run.
    """
    known = {info.name: info for info in catalogue}
    calls = unrolled(calls)
    return [_complete(call, known[call.name]) if call.name in known else call for call in calls]


def _complete(call: ActionCall, info: ActionInfo) -> ActionCall:
    inputs = {name: Parameter(kind) for name, kind in info.inputs.items()} | dict(call.input_parameters)
    outputs = {name: Parameter(kind) for name, kind in info.outputs.items()} | dict(call.output_parameters)
    return call.model_copy(update={"input_parameters": inputs, "output_parameters": outputs})


def check_calls(
    calls: Sequence[ActionCall], catalogue: Iterable[ActionInfo], *, before: Sequence[ActionCall] = ()
) -> list[Problem]:
    """Why these actions cannot be carried out; empty if they can.

    Args:
        calls: What is to be done.
        catalogue: What the robot can do.
        before: Actions that run right before and hand their outputs on.
    """
    flows = [index for index, call in enumerate(calls) if call.flow is not None]
    if len(calls) > MAX_ACTIONS:
        return [
            Problem("queue", f"{len(calls)} actions are more than the {MAX_ACTIONS} allowed", code="too_long")
        ]
    if flows:
        return [
            Problem(
                f"queue[{index}].flow",
                "conditions between steps are not carried out yet",
                code="not_supported",
            )
            for index in flows
        ]
    steps = [Step(call, instance_id=index) for index, call in enumerate([*before, *calls])]
    if not steps:
        return []
    return check(build_graph("plan", steps), Catalogue([spec_of(info) for info in catalogue]))
