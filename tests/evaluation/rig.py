"""A small set of cases, and answers to them."""

from __future__ import annotations

from typing import Any

from parley.evaluation.cases import Case, CaseSet
from parley.evaluation.judge import wrong
from parley.messages.chat import ActionCall, ChatAction

WORLD = """
worlds:
  depot:
    robot: Ada
    robots: [Ada, Ben]
    pose: [1.0, 2.0, 0.0]
    catalogue: thesis
    objects:
      - [box_1, red box, 3, 4, box, 0.5, 0.5]
      - [box_2, blue box, 8, 4, box, 0.5, 0.5]
      - [door_1, north door, 0, 9, door]
    memory:
      - [keys_location, The keys are in the red box]
  store:
    like: depot
    catalogue:
      - {name: HandOver, inputs: {thing: string, to: string}}
      - {name: Wait, inputs: {duration_s: number}}
"""


def one_case(text: str) -> Case:
    """A case given as one line of YAML."""
    read = CaseSet.parse(f"{WORLD}\ncases:\n  things:\n    - {text}\n", file="set.yaml")
    return read.cases[0]


def problems(text: str, action: ChatAction) -> list[str]:
    """What the judge says about an answer to a case given as one line of YAML."""
    case = one_case(text)
    return wrong(case, case.situation, action)


def call(name: str, flow: dict[str, Any] | None = None, **inputs: Any) -> ActionCall:
    """An action with inputs; ``__`` stands for ``::``."""
    parameters = {
        key.replace("__", "::"): {
            "pvf_type": "string" if isinstance(value, str) else "number",
            "pvf_value": value,
        }
        for key, value in inputs.items()
    }
    body: dict[str, Any] = {"input_parameters": parameters}
    return ActionCall.model_validate({name: body | ({"flow": flow} if flow else {})})


def go(target: str, flow: dict[str, Any] | None = None) -> list[ActionCall]:
    """Finding something and going there."""
    return [call("GetCoordinates", flow, target=target), call("NavigateTo")]


def look(what: str) -> ActionCall:
    """Inspecting."""
    return call("Inspect", inspect=what)


def answer(*queue: ActionCall, says: str = "I will.", **more: Any) -> ChatAction:
    """An answer; `commands` are system commands as in JSON."""
    commands = more.pop("commands", [])
    return ChatAction.model_validate(
        {"message_response": says, "queue": list(queue), "system_cmd": commands, **more}
    )
