"""From a model's answer to what Parley acts on; nothing is trusted before it is checked. Pure.

What does not hold is said in sentences that go back to the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from parley.errors import LanguageError, Problem
from parley.language.base import ErrorSituation, Grounding, InspectionReport, ReplyReading, Situation
from parley.language.llm.answers import (
    MAX_VALUE_CHARS,
    CommandAnswer,
    GroundAnswer,
    InspectAnswer,
    PlanAnswer,
    ReplyAnswer,
    ResolveAnswer,
    SelectAnswer,
    StepAnswer,
)
from parley.language.prompts.labels import memory_of, step_label, step_of
from parley.messages.chat import ActionCall, ChatAction, Flow, FlowIf, SystemCommand
from parley.messages.completing import completed
from parley.messages.memory import MemoryEntry
from parley.messages.pvf import Parameter, fits_type
from parley.messages.status import ActionInfo
from parley.robots.base import Detection
from parley.world.object_map import MapObject

__all__ = [
    "AnswerRefusedError",
    "PlanCheck",
    "read_grounding",
    "read_plan",
    "read_reading",
    "read_report",
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
    mine, theirs = _shared_out(answer.queue, situation, problems)
    known = _Known(situation.catalogue, situation.objects)
    calls = _calls(mine, known, problems)
    others = {name: _calls(steps, known, problems, name) for name, steps in theirs.items()}
    waiting = _Waiting(situation.queue, situation.steps, runs=True)
    commands = _commands(answer.system_cmd, waiting, situation.memory, problems)
    targets = _targets(answer.targets, situation.robots, problems)
    if not problems:
        for share in filter(None, (calls, *others.values())):
            problems += [str(problem) for problem in check(share, situation.catalogue, ())]
    if problems:
        raise AnswerRefusedError(problems)
    return ChatAction(
        message_response=answer.message_response,
        queue=tuple(calls),
        system_cmd=tuple(commands),
        targets=tuple(targets),
        others=tuple(ChatAction(queue=tuple(steps), targets=(name,)) for name, steps in others.items()),
        choices=_choices(answer),
        sources=_sources(answer.sources, situation.memory),
    )


def read_resolution(answer: ResolveAnswer, situation: ErrorSituation, check: PlanCheck) -> ChatAction:
    """The correction that an answer to a failure means.

    Raises:
        AnswerRefusedError: It cannot be carried out as it is.
    """
    problems: list[str] = []
    known = _Known(situation.catalogue, situation.objects)
    calls = _calls(answer.queue, known, problems)
    waiting = _Waiting(situation.pending, situation.steps)
    commands = _commands(answer.system_cmd, waiting, situation.memory, problems)
    later = _calls(answer.afterwards, known, problems, "afterwards")
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
        sources=_sources(answer.sources, situation.memory),
    )


def read_selection(answer: SelectAnswer, index: Sequence[MemoryEntry]) -> list[str]:
    """The picked names that there are, in the order of the list; what is not on it is dropped."""
    chosen = set(_sources(answer.names, index))
    return [entry.name for entry in index if entry.name in chosen]


def read_report(
    answer: InspectAnswer, rules: Sequence[str], seen: Sequence[Detection] = ()
) -> InspectionReport:
    """What a picture shows; rules that were not given and things that no detector saw are dropped."""
    named = {name.casefold() for name in answer.things}
    applies = {f"r{number}": rule for number, rule in enumerate(rules, 1)}
    return InspectionReport(
        answer.text,
        answer.found,
        answer.wanted,
        answer.attention,
        answer.unwanted,
        tuple(found for found in seen if found.label.casefold() in named),
        tuple(applies[label] for label in dict.fromkeys(answer.rules) if label in applies),
    )


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


def _sources(labels: Sequence[str], shown: Sequence[MemoryEntry]) -> tuple[str, ...]:
    """The names of memories that are spoken of by label or by name, without those that there are not."""
    found = [entry.name for label in labels if (entry := memory_of(label, shown)) is not None]
    return tuple(dict.fromkeys(found))


def _targets(named: Sequence[str], robots: Sequence[str], problems: list[str]) -> list[str]:
    known = {robot.casefold(): robot for robot in robots}
    problems += [f"there is no robot called {name!r}" for name in named if name.casefold() not in known]
    return [known[name.casefold()] for name in named if name.casefold() in known]


# -- steps -----------------------------------------------------------------------------------------


def _shared_out(
    steps: Sequence[StepAnswer], situation: Situation, problems: list[str]
) -> tuple[list[StepAnswer], dict[str, list[StepAnswer]]]:
    """The steps of the robot that is spoken to, and those of others, each counting its own."""
    known = {robot.casefold(): robot for robot in situation.robots}
    shares: dict[str, list[StepAnswer]] = {situation.robot: []}
    places: list[tuple[str, int]] = []
    for index, step in enumerate(steps):
        robot = known.get(step.robot.casefold()) if step.robot else situation.robot
        if robot is None:
            problems.append(f"queue[{index}]: there is no robot called {step.robot!r}")
            robot = situation.robot
        share = shares.setdefault(robot, [])
        named = [step.only_if.step] if step.only_if else []
        named += [step.together_with] if step.together_with is not None else []
        moved: dict[int, int] = {}
        for other in named:
            if other < index and places[other][0] == robot:
                moved[other] = places[other][1]
            elif other < index or robot != situation.robot:
                problems.append(f"queue[{index}]: it can only depend on an earlier step of the same robot")
            else:
                moved[other] = other  # the check of the plan says what is wrong
        places.append((robot, len(share)))
        share.append(_with_places(step, moved))
    return shares.pop(situation.robot), shares


def _with_places(step: StepAnswer, places: Mapping[int, int]) -> StepAnswer:
    condition, beside = step.only_if, step.together_with
    if condition is not None:
        condition = condition.model_copy(update={"step": places.get(condition.step, condition.step)})
    beside = places.get(beside, beside) if beside is not None else None
    return step.model_copy(update={"only_if": condition, "together_with": beside})


class _Known:
    """What steps can be about.

    Args:
        catalogue: What the robot can do.
        objects: What stands on the map.
    """

    def __init__(self, catalogue: Sequence[ActionInfo], objects: Sequence[MapObject]) -> None:
        self.actions = {info.name: info for info in catalogue}
        self._names = {thing.id: thing.description for thing in objects}
        said = [thing.description.casefold() for thing in objects]
        self._unique = {name for name in said if name and said.count(name) == 1}

    def in_words(self, value: Any) -> Any:
        """A thing's description in place of its id, if no other is called so: people read it."""
        name = self._names.get(value, "") if isinstance(value, str) else ""
        return name if name.casefold() in self._unique else value


def _calls(
    steps: Sequence[StepAnswer], known: _Known, problems: list[str], place: str = "queue"
) -> list[ActionCall]:
    calls: list[ActionCall] = []
    for index, step in enumerate(steps):
        info = known.actions.get(step.action)
        if info is None:
            names = ", ".join(known.actions) or "none"
            problems.append(f"{place}[{index}]: there is no action {step.action!r}; there are: {names}")
            continue
        given = {name: known.in_words(value) for name, value in step.parameters.items()}
        call = ActionCall(
            name=info.name,
            input_parameters=_values(f"{place}[{index}]", given, info, problems),
            reason=step.reason,
            flow=_flow(step),
        )
        calls.append(completed(call, info))
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
        if raw is None:
            continue
        kind = info.inputs.get(name)
        if kind is None:
            names = ", ".join(info.inputs) or "none"
            problems.append(f"{where}: {info.name} has no parameter {name!r}; its parameters are: {names}")
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


@dataclass(frozen=True, slots=True)
class _Waiting:
    """The steps as they were shown."""

    calls: Sequence[ActionCall]
    ids: Sequence[str]
    runs: bool = False
    """Whether the first of them is the one that is being carried out."""

    def place(self, answer: CommandAnswer) -> int | None:
        """Which of them is meant."""
        if answer.step:
            return step_of(answer.step, len(self.calls))
        return answer.index if answer.index is not None and answer.index < len(self.calls) else None

    def bound(self, place: int) -> dict[str, Any]:
        """What says, whatever happens meanwhile, that this step is meant."""
        return {"step": self.ids[place]} if place < len(self.ids) else {}


def _commands(
    answers: Sequence[CommandAnswer], waiting: _Waiting, memory: Sequence[MemoryEntry], problems: list[str]
) -> list[SystemCommand]:
    commands: list[SystemCommand] = []
    for index, answer in enumerate(answers):
        problem = _command_problem(answer, waiting, memory)
        if problem:
            problems.append(f"system_cmd[{index}]: {problem}")
        else:
            arguments = _arguments(answer, waiting, memory)
            commands.append(SystemCommand(command=answer.command, arguments=arguments))
    return commands


def _command_problem(answer: CommandAnswer, waiting: _Waiting, memory: Sequence[MemoryEntry]) -> str:
    match answer.command:
        case "pop" if waiting.place(answer) is None:
            labels = ", ".join(map(step_label, range(len(waiting.calls)))) or "none"
            return f"pop needs the label of a waiting step; there are: {labels}"
        case "add_memory" if not answer.data.strip():
            return "add_memory needs data"
        case "remove_memory" if memory_of(answer.name, memory) is None:
            return f"there is no memory called {answer.name!r}"
    return ""


def _arguments(answer: CommandAnswer, waiting: _Waiting, memory: Sequence[MemoryEntry]) -> dict[str, Any]:
    match answer.command:
        case "pop":
            place = waiting.place(answer) or 0
            return {"parameters": place, **waiting.bound(place)}
        case "skip" if waiting.runs:
            return waiting.bound(0)
        case "remove_memory":
            entry = memory_of(answer.name, memory)
            return {"name": entry.name if entry is not None else answer.name}
        case "add_memory":
            named = {"name": answer.name} if answer.name.strip() else {}
            return {**named, "type": "text", "data": answer.data, "info": answer.info}
    return {}
