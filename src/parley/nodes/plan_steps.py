"""The pieces of a plan: its steps, what is sent because of it, and the graph it makes. Pure."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from parley.messages.chat import ActionCall, Flow
from parley.messages.failure import ErrorHandlingMessage, FailureReport
from parley.umrf.model import ChildRelation, Graph, Node, NodeRef, NodeState, ParentRelation, Response, Result

__all__ = [
    "ACTIVE_STATES", "GONE_CODES", "LATCHED", "OPEN_STATES", "Effect", "EndStep", "ModifyGraph", "PauseGraph",
    "ReportFailure", "ResumeGraph", "RunState", "Say", "StartGraph", "Step", "StepState", "StopGraph",
    "build_graph", "failure_message", "fill_inputs", "handed_over", "known_outputs", "unrolled",
    "with_givers", "with_values", "without_orphans",
]  # fmt: skip

StepState = Literal["queued", "running", "finished", "failed", "stopped", "skipped", "paused", "waiting"]
RunState = Literal["none", "starting", "continuing", "running", "paused", "halted", "stopping"]
"""`starting` and `continuing`: told to run, but not reported as running yet."""

OPEN_STATES: Final = frozenset({"queued", "running", "paused", "waiting"})
"""States of steps that are still to be done."""

ACTIVE_STATES: Final = frozenset({NodeState.RUNNING, NodeState.PAUSED, NodeState.PAUSE_REQUESTED})
"""States of nodes that are being carried out."""

GONE_CODES: Final = frozenset({"unknown_graph", "graph_ended"})
"""Codes by which an engine says that it has no such graph to command any more."""

LATCHED: Final = "I was stopped for safety. Release the stop first, then say “carry on”."
"""What the operator is told when an emergency stop is in force."""

_EDGE = {
    Result.ON_TRUE: Response.RUN,
    Result.ON_FALSE: Response.RUN,
    Result.ON_STOPPED: Response.IGNORE,
    Result.ON_ERROR: Response.IGNORE,
}
_EXIT = dict.fromkeys((Result.ON_TRUE, Result.ON_FALSE, Result.ON_STOPPED, Result.ON_ERROR), Response.IGNORE)


@dataclass(frozen=True, slots=True)
class StartGraph:
    """Publish on `umrf_graph_start`."""

    graph: Graph


@dataclass(frozen=True, slots=True)
class ModifyGraph:
    """Publish on `umrf_graph_modify`."""

    graph: Graph
    continue_from: str = ""


@dataclass(frozen=True, slots=True)
class PauseGraph:
    """Publish on `umrf_graph_pause`."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class ResumeGraph:
    """Publish on `umrf_graph_resume`."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class StopGraph:
    """Publish on `umrf_graph_stop`."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class EndStep:
    """Publish on `/parley/step`."""

    graph_name: str
    node: str


@dataclass(frozen=True, slots=True)
class ReportFailure:
    """Publish on `error_handling_message`."""

    message: ErrorHandlingMessage


@dataclass(frozen=True, slots=True)
class Say:
    """Tell the operator."""

    text: str
    type: Literal["info", "error"] = "info"


Effect = StartGraph | ModifyGraph | PauseGraph | ResumeGraph | StopGraph | EndStep | ReportFailure | Say


@dataclass(slots=True)
class Step:
    """One action of the plan."""

    call: ActionCall
    instance_id: int = -1
    """-1 until it is part of a graph."""
    state: StepState = "queued"
    outputs: dict[str, Any] = field(default_factory=dict)
    """Values the engine reported when it finished, by flat name."""
    fed: frozenset[str] = frozenset()
    """Inputs without a value of their own that the step before hands over."""
    ending: bool = False
    """The operator skipped it while it ran; its end is awaited."""

    @property
    def node(self) -> str:
        """Full name of its node, empty before it has one."""
        return f"{self.call.name}_{self.instance_id}" if self.instance_id >= 0 else ""


def build_graph(name: str, steps: Sequence[Step]) -> Graph:
    """The linear graph of `steps` in the planner's style (`spec/umrf.md` 12.6): errors and ends halt it."""
    nodes = []
    for index, step in enumerate(steps):
        before = steps[index - 1] if index else None
        after = steps[index + 1] if index + 1 < len(steps) else None
        nodes.append(
            Node(
                name=step.call.name,
                instance_id=step.instance_id,
                description=step.call.reason,
                input_parameters=step.call.input_parameters,
                output_parameters=step.call.output_parameters,
                parents=(ParentRelation(_ref(before), True, _EDGE),) if before else (),
                children=(ChildRelation(_ref(after)),) if after else (),
            )
        )
    return Graph(
        name=name,
        nodes=tuple(nodes),
        entry=(ChildRelation(nodes[0].ref),) if nodes else (),
        exit=(ParentRelation(nodes[-1].ref, True, _EXIT),) if nodes else (),
    )


def _ref(step: Step) -> NodeRef:
    return NodeRef(step.call.name, step.instance_id)


def failure_message(
    target: str, graph_name: str, failed: Step, steps: Sequence[Step], report: FailureReport
) -> ErrorHandlingMessage:
    """What the error handler is told about a step that failed."""
    behind = steps[steps.index(failed) + 1 :]
    return ErrorHandlingMessage(
        error_message=report.message,
        action_called=failed.call,
        umrf_queue=tuple(step.call for step in behind if step.state in OPEN_STATES),
        target=target,
        process_instructions=report.process_instructions,
        process_data_text=report.process_data_text,
        process_data_images=report.process_data_images,
        code=report.code,
        details=report.details,
        completed=tuple(step.call for step in steps if step.state == "finished"),
        failure_id=f"{graph_name}/{failed.node}",
    )


def handed_over(call: ActionCall, before: Step | None) -> frozenset[str]:
    """The inputs without a value of their own that the step before gives."""
    if before is None:
        return frozenset()
    blank = {name for name, parameter in call.input_parameters.items() if not parameter.has_data}
    return frozenset(blank & set(before.call.output_parameters))


def unrolled(calls: Iterable[ActionCall]) -> list[ActionCall]:
    """`calls` with those that are to be repeated as often as they are to run.

    Copies instead of a cycle: people see how far it got, and can drop or skip one of them.
    """
    found: list[ActionCall] = []
    for call in calls:
        flow = call.flow
        if flow is None or flow.repeat is None:
            found.append(call)
            continue
        rest = flow.model_copy(update={"repeat": None})
        once = call.model_copy(update={"flow": rest if rest != Flow() else None})
        found += [once] * flow.repeat
    return found


def with_values(call: ActionCall, values: dict[str, Any]) -> ActionCall:
    """The call with values written into its blank inputs."""
    inputs = {
        name: parameter.with_value(values[name]) if name in values and not parameter.has_data else parameter
        for name, parameter in call.input_parameters.items()
    }
    return call.model_copy(update={"input_parameters": inputs})


def known_outputs(steps: Sequence[Step]) -> dict[str, Any]:
    """What `steps` gave: of each name what its last giver did, if that is known."""
    known: dict[str, Any] = {}
    for step in steps:
        for name in step.call.output_parameters:
            known.pop(name, None)
        known.update(step.outputs)
    return known


def fill_inputs(steps: Sequence[Step]) -> None:
    """Write into waiting steps what they can no longer get from the step right before them."""
    for index, step in enumerate(steps):
        if step.state != "queued" or not step.fed:
            continue
        before = steps[index - 1] if index else None
        if before is not None and before.state in OPEN_STATES:
            continue
        known = known_outputs(steps[:index])
        values = {name: known[name] for name in step.fed if name in known}
        if values:
            step.call = with_values(step.call, values)


def with_givers(calls: Sequence[ActionCall], before: Sequence[Step]) -> list[ActionCall]:
    """`calls` with the values that `before` gave, or behind a repetition of the step that gives them."""
    if not calls:
        return []
    known = known_outputs(before)
    blank = {name for name, value in calls[0].input_parameters.items() if not value.has_data}
    if blank <= set(known):
        return [with_values(calls[0], known), *calls[1:]]
    for step in reversed(before):
        if step.state == "finished" and blank & set(step.call.output_parameters):
            return [step.call, *calls]
    return list(calls)


def without_orphans(steps: Sequence[Step]) -> list[Step]:
    """`steps` less those waiting ones that lost the step which was to give them their inputs."""
    kept: list[Step] = []
    for step in steps:
        if step.state == "queued" and step.fed:
            before = next((s for s in reversed(kept) if s.state not in ("skipped", "stopped")), None)
            offered = set(before.call.output_parameters) if before else set()
            if not step.fed <= (offered | set(known_outputs(kept))):
                continue
        kept.append(step)
    return kept
