"""Plans in short, as the sets write them and as reports show them.

``go X`` is finding X and going there, ``look X`` inspecting, ``ask`` asking the operator, ``locate X``
finding alone, ``driving`` going to where an earlier step says, ``back`` going to where the robot was,
``at 3 4`` going to numbers (metres), ``Name(arg, arg)`` any other action. X is an object's id or words, with
``|`` between alternatives. ``~`` behind the verb makes a step optional; ``if 2:``, ``unless 2:``, ``with 2:``
and ``times 3:`` before it say how it runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from parley.evaluation.catalogues import POSE
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.status import ActionInfo

__all__ = ["Step", "pending", "read_steps", "write_calls"]

_VERBS = {"GetCoordinates": "locate", "Inspect": "look", "AskOperator": "ask"}


@dataclass(frozen=True)
class Step:
    """One step of an answer in short."""

    verb: str
    arguments: tuple[str, ...] = ()
    flow: str = ""
    place: tuple[float, float] | None = None
    """Where it goes to by numbers, metres."""

    def __str__(self) -> str:
        """As a set would write it."""
        place = f" {self.place[0]:g} {self.place[1]:g}" if self.place else ""
        flow = f"{self.flow}: " if self.flow else ""
        return f"{flow}{self.verb}{place}{f' {list(self.arguments)}' if self.arguments else ''}"


def read_steps(queue: Sequence[ActionCall], catalogue: Sequence[ActionInfo] = ()) -> list[Step]:
    """A queue in short; arguments are in the order in which the catalogue has them."""
    inputs = {info.name: list(info.inputs) for info in catalogue}
    found: list[Step] = []
    for call in queue:
        flow, values = _flow(call), _values(call, inputs.get(call.name, ()))
        place = _place(call)
        if call.name == "NavigateTo":
            before = found[-1] if found else None
            if before is not None and before.verb == "locate":
                found[-1] = Step("go", before.arguments, before.flow, place)
            else:
                found.append(Step("at" if values else "driving", (), flow, place))
        else:
            found.append(Step(_VERBS.get(call.name, call.name), values, flow))
    return found


def _flow(call: ActionCall) -> str:
    flow = call.flow
    if flow is None:
        return ""
    parts = []
    if flow.if_ is not None:
        parts.append(f"{'if' if flow.if_.result else 'unless'} {flow.if_.step}")
    if flow.together_with is not None:
        parts.append(f"with {flow.together_with}")
    if flow.repeat is not None and flow.repeat > 1:
        parts.append(f"times {flow.repeat}")
    return ", ".join(parts)


def _values(call: ActionCall, order: Sequence[str]) -> tuple[str, ...]:
    given = {name: str(p.value) for name, p in call.input_parameters.items() if p.has_data}
    names = [*(name for name in order if name in given), *(name for name in given if name not in order)]
    return tuple(given[name] for name in names)


def _place(call: ActionCall) -> tuple[float, float] | None:
    numbers = []
    for axis in "xy":
        parameter = call.input_parameters.get(f"pose::position::{axis}")
        value = None if parameter is None else parameter.value
        if not isinstance(value, int | float):
            return None
        numbers.append(float(value))
    return numbers[0], numbers[1]


def pending(queue: Sequence[ActionCall], action: ChatAction) -> list[ActionCall]:
    """What is pending once the commands and the plan of an answer have been applied."""
    left = list(queue)
    pops = {c.pop_index for c in action.system_cmd if c.command == "pop"}
    for index in sorted((i for i in pops if i is not None), reverse=True):
        del left[index : index + 1]
    if any(c.command == "clear" for c in action.system_cmd):
        left = []
    return [*left, *action.queue]


def write_calls(
    short: Sequence[str], named: Mapping[str, str], catalogue: Sequence[ActionInfo] = ()
) -> list[dict[str, Any]]:
    """The actions of a queue that is given in short, as JSON.

    Args:
        short: The steps.
        named: Object id -> its description, which stands for it in the queue.
        catalogue: What the robot can do, for the names of parameters.
    """
    inputs = {info.name: list(info.inputs) for info in catalogue}
    calls: list[dict[str, Any]] = []
    for text in short:
        verb, _, rest = text.partition(" ")
        if verb in {"go", "locate"}:
            name = inputs.get("GetCoordinates", ["target"])[0]
            calls.append(_call("GetCoordinates", {name: _text(named.get(rest, rest))}))
        if verb in {"go", "driving"}:
            calls.append(_call("NavigateTo", {name: {"pvf_type": kind} for name, kind in POSE.items()}))
        if verb == "look":
            calls.append(_call("Inspect", {"inspect": _text(rest)}))
        if verb == "ask":
            calls.append(_call("AskOperator", {"question": _text(rest)}))
        if "(" in text:
            name, _, rest = text.partition("(")
            values = [value.strip() for value in rest.rstrip(")").split(",")]
            texts = [_text(named.get(value, value)) for value in values if value]
            calls.append(_call(name, dict(zip(inputs[name], texts, strict=True))))
    return calls


def _call(name: str, inputs: dict[str, Any]) -> dict[str, Any]:
    return {name: {"input_parameters": inputs}}


def _text(value: str) -> dict[str, Any]:
    return {"pvf_type": "string", "pvf_value": value}
