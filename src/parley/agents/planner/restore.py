"""What a killed process left of a robot's plan, as steps that can be gone on with. Pure."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import replace

from parley.agents.planner.steps import Step, When, handed_over, previous, with_givers, without_given
from parley.engine.interrupted import Interrupted, flow_of, order_of
from parley.messages.chat import ActionCall
from parley.sentences import sentence
from parley.umrf.model import GraphState, Node, NodeState

__all__ = ["adopted_steps", "interruption_text", "met_text", "restored_steps"]


def restored_steps(was: Interrupted, finding: Container[str] = ()) -> list[Step]:
    """What was not finished, to be done again from the interrupted step on.

    A step that takes its inputs from one that is done gets the values which that gave; if they were not
    written down, the giver is done again too. A graph that is no simple sequence is none of steps: its
    engine goes on with it as it is (`ActionEngine.restore`).

    Args:
        was: What was interrupted.
        finding: Actions that only find something out. They are done again: what they found may have moved
            since, and a way is called by what was looked for.
    """
    if not was.is_sequence:
        return []
    done: list[Step] = []
    given: list[Step] = []
    for node in was.graph.nodes:
        if node.state is NodeState.FINISHED:
            step = Step(_call(node), state="finished", order=order_of(node))
            given.append(replace(step, outputs=dict(was.outputs.get(node.full_name, {}))))
            done.append(step if node.name in finding else given[-1])
    steps: list[Step] = []
    left = [Step(_call(node)) for node in was.remaining]
    # A plan that was changed meanwhile was told to the engine with what its steps had found written in.
    asked = without_given([*given, *left], [step.call for step in (*given, *left)])[len(given) :]
    calls = with_givers(asked, done)
    orders = [order_of(node) for node in was.remaining]
    for call, order in zip(calls, [*orders[: len(calls) - len(orders)], *orders], strict=True):
        steps.append(Step(call, fed=handed_over(call, steps[-1:]), order=order))
    return steps


def adopted_steps(was: Interrupted) -> list[Step]:
    """The plan behind a graph that its engine holds, as far as it can be told.

    None if it has branches and was not made by a planner.
    """
    if not (was.is_linear or was.has_flow):
        return []
    steps: dict[str, Step] = {}
    for node in was.graph.nodes:
        flow = flow_of(node)
        step = Step(_call(node), node.instance_id, outputs=dict(was.outputs.get(node.full_name, {})))
        step.state, step.order = "finished" if node.state is NodeState.FINISHED else "queued", order_of(node)
        if node.state is NodeState.ERROR:
            step.instance_id = -1  # done anew, as a node of its own
        leader, condition = steps.get(flow.get("together_with", "")), flow.get("if", {})
        if leader is not None:
            step.together = leader.together
        on = steps.get(condition.get("node", ""))
        if on is not None:
            step.when = When(on, bool(condition["result"]))
            if node.state is not NodeState.UNINITIALIZED:
                on.result = step.when.result  # it would not have begun otherwise
        steps[node.full_name] = step
    found = list(steps.values())
    for index, step in enumerate(found):
        step.fed = handed_over(step.call, previous(found, index, step.together))
    _leave_out_passed(found, [node.state for node in was.graph.nodes])
    return found


def _leave_out_passed(steps: Sequence[Step], states: Sequence[NodeState]) -> None:
    """What did not begin although something behind it has is not to be done."""
    begun: object = None
    for step, state in reversed(list(zip(steps, states, strict=True))):
        if state is not NodeState.UNINITIALIZED:
            begun = begun or step.together
        elif begun is not None and begun is not step.together:
            step.state = "skipped"


def interruption_text(was: Interrupted, goes_on: Sequence[Step] | bool) -> str:
    """What the operator is told about it.

    Args:
        was: What was interrupted.
        goes_on: The steps that are left, or whether its engine holds it.
    """
    # A graph that was held at its very end is still open, though no step of it is.
    current = next(iter(was.going_on or was.remaining or reversed(was.graph.nodes)))
    words = current.description or current.name
    if was.shared:
        return sentence(
            "I was interrupted while I was at “{step}”. The other robots have gone on without me, "
            "so please give the order again if it still holds.",
            step=words,
        )
    if not goes_on:
        return sentence(
            "I was interrupted while I was at “{step}”. Please give the order again if it still holds.",
            step=words,
        )
    return sentence(
        "I was interrupted while I was at “{step}”. Say “carry on” to go on with the rest, or “cancel "
        "everything”.",
        step=words,
    )


def met_text(was: Interrupted) -> str:
    """What the operator is told of a graph that was met, as whoever planned it had ended."""
    failed = any(node.state is NodeState.ERROR for node in was.graph.nodes)
    current = next(iter(was.going_on or was.remaining or reversed(was.graph.nodes)))
    words = current.description or current.name
    if was.graph.state is GraphState.RUNNING and not failed:
        return sentence(
            "I could not be reached for a while and went on meanwhile. I am at “{step}”.", step=words
        )
    return sentence(
        "I could not be reached for a while. I stand still at “{step}”. Say “carry on” to go on with the "
        "rest, or “cancel everything”.",
        step=words,
    )


def _call(node: Node) -> ActionCall:
    return ActionCall(
        name=node.name,
        input_parameters=dict(node.input_parameters),
        output_parameters=dict(node.output_parameters),
        reason=node.description,
    )
