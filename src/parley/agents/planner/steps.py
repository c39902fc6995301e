"""The steps of a plan: what each is, what it depends on, and what it hands on. Pure."""

from __future__ import annotations

import uuid
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from parley.messages.chat import ActionCall
from parley.messages.failure import ErrorHandlingMessage, FailureReport
from parley.umrf.model import NodeState

__all__ = [
    "ACTIVE_NODES", "ACTIVE_STATES", "GONE_CODES", "KEPT_LATCHED", "LATCHED", "OPEN_STATES", "RunState",
    "Step", "StepState", "When", "failure_message", "fill_inputs", "handed_over", "known_outputs", "new_id",
    "previous", "stages", "verdict", "with_givers", "with_values", "without_orphans",
]  # fmt: skip

StepState = Literal["queued", "running", "finished", "failed", "stopped", "skipped", "paused", "waiting"]
RunState = Literal["none", "starting", "continuing", "running", "paused", "halted", "stopping"]
"""`starting` and `continuing`: told to run, but not reported as running yet."""

ACTIVE_STATES: Final = frozenset({"running", "paused", "waiting"})
"""States of steps that are being carried out."""

OPEN_STATES: Final = ACTIVE_STATES | {"queued"}
"""States of steps that are still to be done."""

ACTIVE_NODES: Final = frozenset({NodeState.RUNNING, NodeState.PAUSED, NodeState.PAUSE_REQUESTED})
"""States of nodes that are being carried out."""

GONE_CODES: Final = frozenset({"unknown_graph", "graph_ended"})
"""Codes by which an engine says that it has no such graph to command any more."""

LATCHED: Final = "I was stopped for safety. Release the stop first, then say “carry on”."
"""What the operator is told when an emergency stop is in force."""

KEPT_LATCHED: Final = (
    "I was stopped for safety, so I keep that for later. Release the stop first, then say “carry on”."
)
"""The same, when there is something new to do."""


def new_id() -> str:
    """What a step is called that nothing else was called before."""
    return uuid.uuid4().hex[:12]


@dataclass(frozen=True, slots=True, eq=False)
class When:
    """A condition: `step` ended with `result`."""

    step: Step
    result: bool


@dataclass(slots=True, eq=False)
class Step:
    """One action of the plan."""

    call: ActionCall
    """Without its `flow`, which `when` and `together` stand for."""
    instance_id: int = -1
    """-1 until it is part of a graph."""
    state: StepState = "queued"
    outputs: dict[str, Any] = field(default_factory=dict)
    """Values the engine reported when it finished, by flat name."""
    fed: frozenset[str] = frozenset()
    """Inputs without a value of their own that the steps right before hand over."""
    ending: bool = False
    """The operator skipped it while it ran; its end is awaited."""
    taken_back: bool = False
    """Another step stands for it from now on; it is forgotten once nothing of the kind is being done."""
    when: When | None = None
    """It runs only if this holds."""
    together: object = field(default_factory=object)
    """Neighbours that share it run at the same time."""
    result: bool | None = None
    """How it ended, if the engine said so."""
    stopped: bool = False
    """The engine said that it was stopped before its end."""
    alerted: bool = False
    """It failed as it saw what people have to know: who goes on from there leaves nothing out."""
    upset: bool = False
    """A step beside it failed, which stops this one: what it did does not count unless it was done."""
    id: str = field(default_factory=new_id)
    """What it is called as long as the plan has it, whatever stands before it."""
    words: str = ""
    """By which words of a person it came into the plan."""
    order: str = ""
    """`id` of the order that it carries out; empty: of none that has one."""

    @property
    def node(self) -> str:
        """Full name of its node, empty before it has one."""
        return f"{self.call.name}_{self.instance_id}" if self.instance_id >= 0 else ""

    @property
    def ended_by_others(self) -> bool:
        """Whether it was stopped before its end, not by the operator nor for a failure beside it."""
        return self.state == "finished" and self.stopped and not self.upset

    def again(self) -> None:
        """Put it back among those that have not begun."""
        self.instance_id, self.state, self.result = -1, "queued", None
        self.stopped = self.upset = self.ending = self.alerted = False
        self.outputs.clear()


def verdict(step: Step) -> bool | None:
    """Whether the condition of `step` holds; None if that is not known yet."""
    if step.when is None:
        return True
    on = step.when.step
    if on.state in ("skipped", "stopped") or (on.state == "finished" and on.stopped):
        return False
    return None if on.result is None else on.result is step.when.result


def stages(steps: Iterable[Step]) -> list[list[Step]]:
    """`steps` in groups: those of one group run at the same time, one group after the other."""
    groups: list[list[Step]] = []
    for step in steps:
        if groups and groups[-1][0].together is step.together:
            groups[-1].append(step)
        else:
            groups.append([step])
    return groups


def previous(steps: Sequence[Step], index: int, together: object) -> list[Step]:
    """Who comes right before place `index`: the last group other than `together` that is not left out."""
    found: list[Step] = []
    for place in range(index - 1, -1, -1):
        step = steps[place]
        if step.together is together or step.state in ("skipped", "stopped"):
            continue
        if found and step.together is not found[0].together:
            break
        found.append(step)
    return found


def failure_message(
    target: str, graph_name: str, failed: Step, pending: Sequence[ActionCall], steps: Sequence[Step],
    report: FailureReport,
) -> ErrorHandlingMessage:  # fmt: skip
    """What the error handler is told about a step that failed; `pending` is what comes behind it."""
    done = [step for step in steps if step.state == "finished"]
    return ErrorHandlingMessage(
        error_message=report.message,
        action_called=failed.call,
        umrf_queue=tuple(pending),
        target=target,
        process_instructions=report.process_instructions,
        process_data_text=report.process_data_text,
        process_data_images=report.process_data_images,
        code=report.code,
        details=report.details,
        completed=tuple(step.call for step in done),
        results=tuple(step.outputs for step in done),
        steps=tuple(step.id for step in steps if step.state in OPEN_STATES),
        order=failed.words,
        failure_id=f"{graph_name}/{failed.node}",
    )


def handed_over(call: ActionCall, before: Sequence[Step]) -> frozenset[str]:
    """The inputs without a value of their own that the steps right before give."""
    blank = {name for name, parameter in call.input_parameters.items() if not parameter.has_data}
    return frozenset(blank & {name for step in before for name in step.call.output_parameters})


def with_values(call: ActionCall, values: dict[str, Any]) -> ActionCall:
    """The call with values written into its blank inputs."""
    inputs = {
        name: parameter.with_value(values[name]) if name in values and not parameter.has_data else parameter
        for name, parameter in call.input_parameters.items()
    }
    return call.model_copy(update={"input_parameters": inputs})


def without_given(steps: Sequence[Step], calls: Sequence[ActionCall]) -> list[ActionCall]:
    """`calls` of `steps` without values that earlier steps gave: people call a way by what was looked up."""
    known: dict[str, Any] = {}
    found: list[ActionCall] = []
    for step, call in zip(steps, calls, strict=True):
        inputs = {
            name: parameter.with_value(None) if known.get(name, ...) == parameter.value else parameter
            for name, parameter in call.input_parameters.items()
        }
        found.append(call.model_copy(update={"input_parameters": inputs}))
        _take(known, step)
    return found


def known_outputs(steps: Iterable[Step]) -> dict[str, Any]:
    """What `steps` gave: of each name what its last giver did, if that is known."""
    known: dict[str, Any] = {}
    for step in steps:
        _take(known, step)
    return known


def _take(known: dict[str, Any], step: Step) -> None:
    if step.state in ("skipped", "stopped"):
        return
    for name in step.call.output_parameters:
        known.pop(name, None)
    known.update(step.outputs)


def fill_inputs(steps: Sequence[Step]) -> None:
    """Write into waiting steps what they can no longer get from the steps right before them."""
    known: dict[str, Any] = {}
    for index, step in enumerate(steps):
        if step.state == "queued" and step.fed:
            before = previous(steps, index, step.together)
            values = {name: known[name] for name in step.fed if name in known}
            if values and not any(giver.state in OPEN_STATES for giver in before):
                step.call = with_values(step.call, values)
        _take(known, step)


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
    """`steps` less those waiting ones that lost what they depend on.

    That is the step which was to give them their inputs, or the one whose end decides whether they run.
    """
    kept: list[Step] = []
    there: set[int] = set()
    known: dict[str, Any] = {}
    for step in steps:
        if step.state == "queued" and step.fed:
            before = previous(kept, len(kept), step.together)
            offered = {name for giver in before for name in giver.call.output_parameters}
            if not step.fed <= (offered | set(known)):
                continue
        lost = step.when is not None and id(step.when.step) not in there
        if step.state == "queued" and lost and verdict(step) is not True:
            continue
        kept.append(step)
        there.add(id(step))
        _take(known, step)
    return kept
