"""What a killed process left of a robot's plan, as steps that can be gone on with. Pure."""

from __future__ import annotations

from parley.engine.journal import Interrupted
from parley.messages.chat import ActionCall
from parley.nodes.plan_steps import Step, handed_over, with_givers
from parley.umrf.model import Node, NodeState

__all__ = ["interruption_text", "restored_steps"]


def restored_steps(was: Interrupted) -> list[Step]:
    """What was not finished, to be done again from the interrupted step on.

    A step that takes its inputs from one that is done gets the values which that gave; if they were not
    written down, the giver is done again too. A graph that is no simple sequence cannot be gone on with:
    then there are no steps.
    """
    if not was.is_linear:
        return []
    done = [
        Step(_call(node), state="finished", outputs=dict(was.outputs.get(node.full_name, {})))
        for node in was.graph.nodes
        if node.state is NodeState.FINISHED
    ]
    steps: list[Step] = []
    for call in with_givers([_call(node) for node in was.remaining], done):
        steps.append(Step(call, fed=handed_over(call, steps[-1] if steps else None)))
    return steps


def interruption_text(was: Interrupted, steps: list[Step]) -> str:
    """What the operator is told about it."""
    current = next(iter(was.going_on or was.remaining))
    words = current.description or current.name
    if not steps:
        return f"I was interrupted while I was at “{words}”. Please give the order again if it still holds."
    return (
        f"I was interrupted while I was at “{words}”. "
        "Say “carry on” to go on with the rest, or “cancel everything”."
    )


def _call(node: Node) -> ActionCall:
    return ActionCall(
        name=node.name,
        input_parameters=dict(node.input_parameters),
        output_parameters=dict(node.output_parameters),
        reason=node.description,
    )
