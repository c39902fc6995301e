"""What a model may answer: small typed objects, bounded in length; their descriptions go to the model."""

from __future__ import annotations

from typing import Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from parley.language.prompts import Kind
from parley.messages.chat import CommandName

__all__ = [
    "ANSWERS",
    "TOOL",
    "GroundAnswer",
    "InspectAnswer",
    "PlanAnswer",
    "ReplyAnswer",
    "ResolveAnswer",
    "SelectAnswer",
    "StepAnswer",
]

MAX_STEPS: Final = 100
MAX_REPLY_CHARS: Final = 4000
MAX_VALUE_CHARS: Final = 2000


class _Answer(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")

    @model_validator(mode="before")
    @classmethod
    def _said(cls, value: Any) -> Any:
        """Where all fields have to be named, null stands for one that is left out."""
        if not isinstance(value, dict):
            return value
        return {name: item for name, item in value.items() if item is not None or name == "success"}


class ConditionAnswer(_Answer):
    """Whether a step runs at all."""

    step: int = Field(ge=0, description="Place of an earlier step of this queue, from 0.")
    result: bool = Field(default=True, description="How that step must have ended.")


class StepAnswer(_Answer):
    """One step of the plan."""

    action: str = Field(max_length=200, description="Name of the action, exactly as listed.")
    parameters: dict[str, Any] = Field(
        default_factory=dict, description="Values by parameter name; leave out what an earlier step gives."
    )
    reason: str = Field(default="", max_length=300, description="Why, in a few plain words for the operator.")
    only_if: ConditionAnswer | None = Field(default=None, description="Runs only then; else it is left out.")
    together_with: int | None = Field(
        default=None, ge=0, description="Place of an earlier step of this queue that it runs beside."
    )
    repeat: int | None = Field(default=None, ge=1, le=50, description="How often, if more than once.")
    robot: str = Field(default="", max_length=200, description="Who does it, if another robot is meant.")

    @model_validator(mode="before")
    @classmethod
    def _wire_form(cls, value: Any) -> Any:
        """Accept the form of a Chat Action too: ``{"<Action>": {"input_parameters": {..}}}``."""
        if not isinstance(value, dict) or "action" in value or len(value) != 1:
            return value
        name, body = next(iter(value.items()))
        if not isinstance(body, dict) or "input_parameters" not in body:
            return value
        return {
            "action": name,
            "parameters": _flat(body["input_parameters"]),
            "reason": body.get("reason", ""),
        }


def _flat(tree: Any, prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, child in tree.items() if isinstance(tree, dict) else ():
        name = f"{prefix}{key}"
        if isinstance(child, dict) and "pvf_type" in child:
            flat[name] = child.get("pvf_value")
        elif isinstance(child, dict):
            flat |= _flat(child, f"{name}::")
        else:
            flat[name] = child
    return flat


class CommandAnswer(_Answer):
    """One command; which of the other fields it needs depends on it."""

    command: CommandName
    index: int | None = Field(default=None, ge=0, description="pop: place of the step in the queue.")
    step: str = Field(default="", max_length=20, description="pop: label of the step, e.g. s2.")
    name: str = Field(
        default="", max_length=200, description="add_memory: its name; remove_memory: its label, e.g. m2."
    )
    data: str = Field(default="", max_length=MAX_VALUE_CHARS, description="add_memory: the fact, a sentence.")
    info: str = Field(default="", max_length=300, description="add_memory: what it is about.")


class PlanAnswer(_Answer):
    """The reply to the operator, and what is to be done."""

    message_response: str = Field(
        min_length=1, max_length=MAX_REPLY_CHARS, description="The reply, in plain words. Write it first."
    )
    queue: list[StepAnswer] = Field(
        default_factory=list, max_length=MAX_STEPS, description="Steps, in order."
    )
    system_cmd: list[CommandAnswer] = Field(default_factory=list, max_length=20)
    targets: list[str] = Field(
        default_factory=list, max_length=50, description="Only if another robot is meant."
    )
    choices: list[str] = Field(
        default_factory=list, max_length=10, description="Answers to offer, for a question."
    )
    sources: list[str] = Field(
        default_factory=list, max_length=50, description="Labels of memories relied on."
    )

    @model_validator(mode="before")
    @classmethod
    def _spellings(cls, value: Any) -> Any:
        """Accept `message` for `message_response`, and commands in the form of a Chat Action."""
        if not isinstance(value, dict):
            return value
        value = dict(value)
        if "message_response" not in value and isinstance(value.get("message"), str):
            value["message_response"] = value["message"]
        if isinstance(value.get("system_cmd"), list):
            value["system_cmd"] = [_command(item) for item in value["system_cmd"]]
        return value


def _command(item: Any) -> Any:
    if not isinstance(item, dict) or "command" in item or len(item) != 1:
        return item
    name, body = next(iter(item.items()))
    if not isinstance(body, dict):
        return {"command": name} | ({"index": body} if name == "pop" else {})
    body = dict(body)
    if "parameters" in body:
        body["index"] = body.pop("parameters")
    return {**body, "command": name}


class ResolveAnswer(PlanAnswer):
    """How the plan goes on, or the question to the operator."""

    success: bool | None = Field(
        description="true: the plan goes on with this; false: the message asks; null: said aside."
    )
    delay_s: float = Field(default=0.0, ge=0, le=3600, description="Seconds to wait before it goes on.")
    afterwards: list[StepAnswer] = Field(
        default_factory=list, max_length=MAX_STEPS, description="Ordered besides, for behind the rest."
    )


class SelectAnswer(_Answer):
    """The memories that matter."""

    names: list[str] = Field(max_length=200, description="Labels, exactly as listed; may be empty.")


class GroundAnswer(_Answer):
    """What the description means."""

    outcome: Literal["match", "ambiguous", "none"]
    ids: list[str] = Field(default_factory=list, max_length=50, description="Ids, exactly as listed.")


class InspectAnswer(_Answer):
    """What the picture shows."""

    text: str = Field(min_length=1, max_length=MAX_REPLY_CHARS)
    found: bool | None = None
    wanted: str = Field(default="", max_length=200)
    unwanted: bool = False
    attention: bool = False
    things: list[str] = Field(default_factory=list, max_length=50, description="As the detector calls them.")
    rules: list[str] = Field(default_factory=list, max_length=50, description="Labels of rules that apply.")


class ReplyAnswer(_Answer):
    """How the answer is meant."""

    kind: Literal["yes", "no", "choice", "answer", "aside", "control", "unclear"]
    choice: str = Field(default="", max_length=500)


ANSWERS: Final[dict[Kind, type[BaseModel]]] = {
    "interpret": PlanAnswer,
    "resolve": ResolveAnswer,
    "select_memories": SelectAnswer,
    "ground": GroundAnswer,
    "inspect": InspectAnswer,
    "read_reply": ReplyAnswer,
}
"""What is answered to which question."""

TOOL: Final = "answer"
"""Name of the tool whose call is the answer, for models that call tools."""
