"""Situations as JSON lines, for `parley interpret` (design section 5).

A line is one situation; a line with ``"kind": "error"`` is an error situation. What comes back is one line
each, in the same order: ``{"id" if given, "output": Chat Action, "latency_s"}``, or ``{"id", "error"}``.
"""

from __future__ import annotations

import json
import time
from collections.abc import AsyncIterator, Iterable, Sequence
from typing import Annotated, Any, Literal, Protocol, runtime_checkable

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, TypeAdapter, ValidationError

from parley.errors import FailureCode, InvalidMessageError, LanguageError
from parley.language.base import ErrorSituation, Language, Situation, Turn
from parley.messages.chat import SYSTEM_COMMANDS, ActionCall, ChatAction
from parley.messages.completing import completed_answer
from parley.messages.memory import MemoryEntry
from parley.messages.pvf import NATIVE_TYPES
from parley.messages.status import ActionInfo, ParameterInfo
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["Explains", "interpret_lines", "read_situation", "schema", "write_output"]


@runtime_checkable
class Explains(Protocol):
    """A language engine that can say how it came to its answer."""

    def explain(self, situation: Situation) -> tuple[ChatAction, list[dict[str, str]]]:
        """The answer, and what was found and decided on the way, in order: `about` what, and a `text`."""
        ...


class _Line(BaseModel):
    """A misspelt key would be a situation that nobody meant."""

    model_config = ConfigDict(extra="forbid")


class _Parameter(ParameterInfo):
    model_config = ConfigDict(extra="forbid")


class _Action(ActionInfo):
    model_config = ConfigDict(extra="forbid")

    parameters: dict[str, _Parameter] = Field(default_factory=dict)  # type: ignore[assignment]


class _Memory(MemoryEntry):
    model_config = ConfigDict(extra="forbid")


class _Turn(_Line):
    role: Literal["operator", "user", "assistant", "robot", "system"]
    content: str


class _Object(_Line):
    id: str = Field(min_length=1, coerce_numbers_to_str=True)
    description: str = ""
    x: float = 0.0
    y: float = 0.0
    class_: str = Field(default="", alias="class")
    width: float = 0.0
    height: float = 0.0
    aliases: list[str] = Field(default_factory=list)


class _Pose(_Line):
    x: float
    y: float
    yaw: float = 0.0


class _Common(_Line):
    id: Any = None
    """Given back with the answer."""
    memory: list[_Memory] = Field(default_factory=list)
    objects: list[_Object] = Field(default_factory=list)
    robot_pose: _Pose | None = None
    robot: str = ""
    catalogue: list[_Action] | None = None


class _Situation(_Common):
    kind: Literal["message"] = "message"
    message: str
    history: list[_Turn] = Field(default_factory=list)
    queue: list[ActionCall] = Field(default_factory=list)
    status: Literal["idle", "running", "paused"] = "idle"
    robots: list[str] = Field(default_factory=list)


class _Answered(_Line):
    """What comes of a line."""

    id: Any = None
    output: ChatAction
    latency_s: float
    explanation: list[dict[str, str]] | None = None


class _Refused(_Line):
    """A line that could not be answered."""

    id: Any = None
    error: str


def _code(value: object) -> object:
    """A code of which nobody here has heard says no more than none."""
    try:
        return FailureCode(value) if isinstance(value, str) else value
    except ValueError:
        return FailureCode.INTERNAL


class _ErrorSituation(_Common):
    kind: Literal["error"]
    error_message: str
    failed_action: ActionCall
    code: Annotated[FailureCode, BeforeValidator(_code)] = FailureCode.INTERNAL
    details: dict[str, Any] = Field(default_factory=dict)
    completed: list[ActionCall] = Field(default_factory=list)
    pending: list[ActionCall] = Field(default_factory=list)
    dialogue: list[_Turn] = Field(default_factory=list)
    reply: str | None = None


def read_situation(
    value: Any, default_catalogue: Sequence[ActionInfo] = (), line: int = 0
) -> Situation | ErrorSituation:
    """Read one situation.

    Args:
        value: The JSON object of a line.
        default_catalogue: What the robot can do if the situation does not say.
        line: 1-based number of the line, for messages.

    Raises:
        InvalidMessageError: Names the line and the first wrong field.
    """
    what = f"line {line}" if line else "situation"
    if not isinstance(value, dict):
        raise InvalidMessageError(what, "", "expected a JSON object")
    try:
        if value.get("kind") == "error":
            return _error_situation(_ErrorSituation.model_validate(value), default_catalogue)
        return _situation(_Situation.model_validate(value), default_catalogue)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        told = "unknown key" if first["type"] == "extra_forbidden" else first["msg"]
        raise InvalidMessageError(what, ".".join(str(part) for part in first["loc"]), told) from error


def schema() -> dict[str, Any]:
    """The JSON schema of a line that is read, and of one that is answered."""
    return {
        "input": _schema(_Situation | _ErrorSituation, "#/input/$defs/{model}"),
        "output": _schema(_Answered | _Refused, "#/output/$defs/{model}"),
    }


def _schema(kinds: Any, template: str) -> dict[str, Any]:
    """With actions and commands as they are written: an object whose one key is the name."""
    found: dict[str, Any] = TypeAdapter(kinds).json_schema(ref_template=template)
    defined = found["$defs"]
    defined["ActionCall"] = {
        "description": "An action: its name, and behind it what is given to it.",
        "type": "object",
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": {
            "type": "object",
            "properties": {
                "input_parameters": {"$ref": template.format(model="Parameters")},
                "output_parameters": {"$ref": template.format(model="Parameters")},
                "reason": {"type": "string", "description": "Why this step."},
                "flow": {"$ref": template.format(model="Flow")},
            },
        },
    }
    defined["Parameters"] = {
        "description": "A tree: what has a `pvf_type` is a value, what has none a level of names.",
        "type": "object",
        "additionalProperties": {
            "anyOf": [{"$ref": template.format(model=name)} for name in ("Parameter", "Parameters")]
        },
    }
    defined["Parameter"] = {
        "type": "object",
        "properties": {"pvf_type": {"enum": [*NATIVE_TYPES]}, "pvf_value": {}},
        "required": ["pvf_type"],
    }
    if "SystemCommand" in defined:
        defined["SystemCommand"] = {
            "description": "A command: its name, and behind it its arguments.",
            "type": "object",
            "minProperties": 1,
            "maxProperties": 1,
            "properties": {name: {} for name in SYSTEM_COMMANDS},
            "additionalProperties": False,
        }
    return found


def _situation(read: _Situation, default: Sequence[ActionInfo]) -> Situation:
    return Situation(
        message=read.message,
        memory=tuple(read.memory),
        history=_turns(read.history),
        queue=tuple(read.queue),
        status=read.status,
        objects=_objects(read.objects),
        robot_pose=_pose(read.robot_pose),
        robot=read.robot,
        robots=tuple(read.robots),
        catalogue=tuple(default if read.catalogue is None else read.catalogue),
    )


def _error_situation(read: _ErrorSituation, default: Sequence[ActionInfo]) -> ErrorSituation:
    return ErrorSituation(
        error_message=read.error_message,
        failed_action=read.failed_action,
        code=read.code,
        details=read.details,
        completed=tuple(read.completed),
        pending=tuple(read.pending),
        memory=tuple(read.memory),
        objects=_objects(read.objects),
        dialogue=_turns(read.dialogue),
        reply=read.reply,
        robot=read.robot,
        robot_pose=_pose(read.robot_pose),
        catalogue=tuple(default if read.catalogue is None else read.catalogue),
    )


def _turns(turns: Iterable[_Turn]) -> tuple[Turn, ...]:
    return tuple(
        Turn("operator" if turn.role in {"operator", "user"} else "assistant", turn.content) for turn in turns
    )


def _objects(objects: Iterable[_Object]) -> tuple[MapObject, ...]:
    return tuple(
        MapObject(o.id, o.description or o.id, o.x, o.y, o.class_, o.width, o.height, tuple(o.aliases))
        for o in objects
    )


def _pose(pose: _Pose | None) -> Pose2D | None:
    return None if pose is None else Pose2D(pose.x, pose.y, pose.yaw)


def write_output(
    output: ChatAction,
    latency_s: float,
    identifier: Any = None,
    explanation: Sequence[dict[str, str]] | None = None,
) -> str:
    """One line of output, without the line end; what was decided on the way is added if given."""
    line: dict[str, Any] = {} if identifier is None else {"id": identifier}
    line |= {"output": output.to_wire(), "latency_s": round(latency_s, 6)}
    if explanation is not None:
        line["explanation"] = list(explanation)
    return json.dumps(line, ensure_ascii=False)


async def interpret_lines(
    lines: Iterable[str],
    language: Language,
    default_catalogue: Sequence[ActionInfo] = (),
    *,
    explain: bool = False,
) -> AsyncIterator[str]:
    """Answer situations line by line; a bad line gives a line with an ``error`` and stops nothing.

    Args:
        lines: JSON lines; empty ones are passed over.
        language: What understands.
        default_catalogue: For situations that name no catalogue of their own.
        explain: Whether to add what was decided on the way, where the engine `Explains`.
    """
    for number, line in enumerate(lines, 1):
        if line.strip():
            yield await _answer(line, number, language, default_catalogue, explain=explain)


async def _answer(
    line: str, number: int, language: Language, default_catalogue: Sequence[ActionInfo], *, explain: bool
) -> str:
    identifier: Any = None
    try:
        try:
            value = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise InvalidMessageError(f"line {number}", "", f"not valid JSON: {error}") from error
        identifier = value.get("id") if isinstance(value, dict) else None
        situation = read_situation(value, default_catalogue, number)
        start_s = time.perf_counter()
        if isinstance(situation, ErrorSituation):
            output = await language.resolve(situation)
        elif explain and isinstance(language, Explains):
            output, decisions = language.explain(situation)
            output = completed_answer(output, situation.catalogue)
            return write_output(output, time.perf_counter() - start_s, identifier, decisions)
        else:
            output = await language.interpret(situation)
        output = completed_answer(output, situation.catalogue)
        return write_output(output, time.perf_counter() - start_s, identifier)
    except (InvalidMessageError, LanguageError) as error:
        return _error(identifier, str(error))
    except Exception as error:  # noqa: BLE001 - one line that cannot be answered must not end a run of many
        return _error(identifier, f"line {number}: the engine broke down: {error!r}")


def _error(identifier: object, text: str) -> str:
    body = {} if identifier is None else {"id": identifier}
    return json.dumps(body | {"error": text}, ensure_ascii=False)
