"""From a model's answer to what Parley acts on; nothing is trusted before it is checked. Pure.

What does not hold is said in sentences that go back to the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from parley.errors import LanguageError, Problem
from parley.language.base import ErrorSituation, Grounding, ReplyReading, Situation
from parley.language.llm.answers import (
    MAX_VALUE_CHARS,
    CommandAnswer,
    GroundAnswer,
    PlanAnswer,
    ReplyAnswer,
    ResolveAnswer,
    SelectAnswer,
    StepAnswer,
)
from parley.messages.chat import ActionCall, ChatAction, Flow, FlowIf, SystemCommand
from parley.messages.memory import MemoryEntry
from parley.messages.pvf import Parameter, fits_type
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

__all__ = [
    "AnswerRefusedError",
    "PlanCheck",
    "read_grounding",
    "read_plan",
    "read_reading",
    "read_resolution",
    "read_selection",
]

PlanCheck = Callable[[Sequence[ActionCall], Sequence[ActionInfo], Sequence[ActionCall]], Sequence[Problem]]
"""Why these actions cannot be carried out: the actions, the catalogue, what ran right before them."""


class AnswerRefusedError(LanguageError):
    """An answer that cannot be used.

    Attributes:
        problems: What is wrong with it, in sentences for the model.
    """

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(problems))


def read_plan(answer: PlanAnswer, situation: Situation, check: PlanCheck) -> ChatAction:
    """The Chat Action that an answer to a message means.

    Raises:
        AnswerRefusedError: It cannot be carried out as it is.
    """
    problems: list[str] = []
    calls = _calls(answer.queue, situation.catalogue, problems)
    names = {entry.name for entry in situation.memory}
    commands = _commands(answer.system_cmd, len(situation.queue), names, problems)
    targets = _targets(answer.targets, situation.robots, problems)
    if calls and not problems:
        problems += [str(problem) for problem in check(calls, situation.catalogue, ())]
    if problems:
        raise AnswerRefusedError(problems)
    return ChatAction(
        message_response=answer.message_response,
        queue=tuple(calls),
        system_cmd=tuple(commands),
        targets=tuple(targets),
        choices=_choices(answer),
        sources=tuple(name for name in answer.sources if name in names),
    )


def read_resolution(answer: ResolveAnswer, situation: ErrorSituation, check: PlanCheck) -> ChatAction:
    """The correction that an answer to a failure means.

    Raises:
        AnswerRefusedError: It cannot be carried out as it is.
    """
    problems: list[str] = []
    calls = _calls(answer.queue, situation.catalogue, problems)
    names = {entry.name for entry in situation.memory}
    commands = _commands(answer.system_cmd, len(situation.pending), names, problems)
    later = _calls(answer.afterwards, situation.catalogue, problems, "afterwards")
    if calls and answer.success is None:  # nothing takes the failed step's place: it can only be for later
        calls, later = [], [*calls, *later]
    if calls and not answer.success:
        problems.append("without success true nothing takes the failed step's place: leave the queue empty")
    if calls and not problems:
        problems += [str(problem) for problem in check(calls, situation.catalogue, situation.completed)]
    if later and not problems:
        problems += [f"afterwards: {problem}" for problem in check(later, situation.catalogue, ())]
    if problems:
        raise AnswerRefusedError(problems)
    return ChatAction(
        message_response=answer.message_response,
        queue=tuple(calls),
        system_cmd=tuple(commands),
        success=answer.success,
        delay_s=answer.delay_s if answer.success else 0.0,
        afterwards=tuple(later),
        choices=() if answer.success else _choices(answer),
        sources=tuple(name for name in answer.sources if name in names),
    )


def read_selection(answer: SelectAnswer, index: Sequence[MemoryEntry]) -> list[str]:
    """The picked names that there are, in the order of the list; a name that is not on it is dropped."""
    chosen = set(answer.names)
    return [entry.name for entry in index if entry.name in chosen]


def read_grounding(answer: GroundAnswer, objects: Sequence[MapObject]) -> Grounding:
    """The things that the ids mean.

    Raises:
        AnswerRefusedError: An id is not on the map, or their number does not go with the outcome.
    """
    known = {thing.id: thing for thing in objects}
    unknown = [name for name in answer.ids if name not in known]
    if unknown and answer.outcome != "none":
        raise AnswerRefusedError([f"there is no thing with the id {name!r} on the map" for name in unknown])
    things = tuple(known[name] for name in dict.fromkeys(answer.ids) if name in known)
    if answer.outcome == "match" and len(things) != 1:
        raise AnswerRefusedError([f"a match is exactly one id, not {len(things)}"])
    if answer.outcome == "ambiguous" and len(things) < 2:
        raise AnswerRefusedError(["ambiguous means at least two ids"])
    return Grounding(answer.outcome, things)


def read_reading(answer: ReplyAnswer, choices: Sequence[str]) -> ReplyReading:
    """How a reply is meant.

    Raises:
        AnswerRefusedError: It is said to be a choice that was not offered.
    """
    if answer.kind != "choice":
        return ReplyReading(answer.kind)
    chosen = next((choice for choice in choices if choice.casefold() == answer.choice.casefold()), None)
    if chosen is None:
        raise AnswerRefusedError(
            [f"{answer.choice!r} was not offered; give one of the choices word for word"]
        )
    return ReplyReading("choice", chosen)


def _choices(answer: PlanAnswer) -> tuple[str, ...]:
    return tuple(choice[:200] for choice in answer.choices if choice.strip()) if not answer.queue else ()


def _targets(named: Sequence[str], robots: Sequence[str], problems: list[str]) -> list[str]:
    known = {robot.casefold(): robot for robot in robots}
    problems += [f"there is no robot called {name!r}" for name in named if name.casefold() not in known]
    return [known[name.casefold()] for name in named if name.casefold() in known]


# -- steps -----------------------------------------------------------------------------------------


def _calls(
    steps: Sequence[StepAnswer], catalogue: Sequence[ActionInfo], problems: list[str], place: str = "queue"
) -> list[ActionCall]:
    known = {info.name: info for info in catalogue}
    calls: list[ActionCall] = []
    for index, step in enumerate(steps):
        info = known.get(step.action)
        if info is None:
            names = ", ".join(known) or "none"
            problems.append(f"{place}[{index}]: there is no action {step.action!r}; there are: {names}")
            continue
        calls.append(
            ActionCall(
                name=info.name,
                input_parameters=_values(f"{place}[{index}]", step.parameters, info, problems),
                reason=step.reason,
                flow=_flow(step),
            )
        )
    return calls


def _flow(step: StepAnswer) -> Flow | None:
    """How the step runs, if other than after the one before."""
    condition = step.only_if
    flow = Flow(
        if_=FlowIf(step=condition.step, result=condition.result) if condition is not None else None,
        together_with=step.together_with,
        repeat=step.repeat if step.repeat is not None and step.repeat > 1 else None,
    )
    return flow if flow != Flow() else None


def _values(
    where: str, given: Mapping[str, Any], info: ActionInfo, problems: list[str]
) -> dict[str, Parameter]:
    flat = _flattened(given)
    values: dict[str, Parameter] = {}
    for name, raw in flat.items():
        kind = info.inputs.get(name)
        if kind is None:
            names = ", ".join(info.inputs) or "none"
            problems.append(f"{where}: {info.name} has no parameter {name!r}; its parameters are: {names}")
            continue
        if raw is None:
            continue
        value = _converted(kind, raw)
        if not fits_type(kind, value):
            problems.append(f"{where}.parameters.{name}: expected a value of type {kind}")
        elif len(str(value)) > MAX_VALUE_CHARS:
            problems.append(f"{where}.parameters.{name}: at most {MAX_VALUE_CHARS} characters")
        else:
            values[name] = Parameter(kind, value)
    return values


def _flattened(given: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """``{"pose": {"position": {"x": 1}}}`` as ``{"pose::position::x": 1}``: no parameter holds an object."""
    flat: dict[str, Any] = {}
    for key, value in given.items():
        if isinstance(value, Mapping):
            flat |= _flattened(value, f"{prefix}{key}::")
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def _converted(kind: str, raw: Any) -> Any:
    """What is plainly meant: numbers in quotes, quotes left out."""
    if kind == "number" and isinstance(raw, str):
        try:
            return float(raw.strip())
        except ValueError:
            return raw
    if kind == "number" and isinstance(raw, int) and not isinstance(raw, bool):
        return raw
    if kind == "string" and isinstance(raw, int | float) and not isinstance(raw, bool):
        return str(raw)
    if kind == "bool" and isinstance(raw, str):
        return {"true": True, "false": False}.get(raw.strip().lower(), raw)
    return raw


# -- commands --------------------------------------------------------------------------------------


def _commands(
    answers: Sequence[CommandAnswer], queued: int, memories: set[str], problems: list[str]
) -> list[SystemCommand]:
    commands: list[SystemCommand] = []
    for index, answer in enumerate(answers):
        problem = _command_problem(answer, queued, memories)
        if problem:
            problems.append(f"system_cmd[{index}]: {problem}")
        else:
            commands.append(SystemCommand(command=answer.command, arguments=_arguments(answer)))
    return commands


def _command_problem(answer: CommandAnswer, queued: int, memories: set[str]) -> str:
    match answer.command:
        case "pop" if answer.index is None or answer.index >= queued:
            return f"pop needs the index of a step in the queue, which has {queued}"
        case "add_memory" if not answer.data.strip():
            return "add_memory needs data"
        case "remove_memory" if answer.name not in memories:
            return f"there is no memory called {answer.name!r}"
    return ""


def _arguments(answer: CommandAnswer) -> dict[str, Any]:
    match answer.command:
        case "pop":
            return {"parameters": answer.index}
        case "remove_memory":
            return {"name": answer.name}
        case "add_memory":
            named = {"name": answer.name} if answer.name.strip() else {}
            return {**named, "type": "text", "data": answer.data, "info": answer.info}
    return {}
