"""Reads the development set and says in short what the engine made of a sentence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from parley.language.base import Situation, Turn
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

DATA = Path(__file__).parent / "data"

POSE = {
    f"pose::{part}::{axis}": "number"
    for part, axes in (("position", "xyz"), ("orientation", "rpy"))
    for axis in axes
}
INSPECT = ActionInfo(
    name="Inspect",
    inputs={"inspect": "string"},
    outputs={"inspection_result": "string"},
    effects=("looks",),
    phrases=("inspect {inspect}", "look at {inspect}", "check {inspect}"),
)
ASK = ActionInfo(
    name="AskOperator",
    inputs={"question": "string"},
    outputs={"answer": "string"},
    effects=("asks_operator",),
)
NAVIGATE = ActionInfo(
    name="NavigateTo", inputs=POSE, effects=("moves",), phrases=("go to {place}", "drive to {place}")
)
CATALOGUES: dict[str, tuple[ActionInfo, ...]] = {
    "thesis": (
        ActionInfo(name="GetCoordinates", inputs={"target": "string"}, outputs=POSE, effects=("locates",)),
        NAVIGATE,
        INSPECT,
        ASK,
    ),
    # The same without any hint but names, types and one other parameter name.
    "location": (
        ActionInfo(name="GetCoordinates", inputs={"location": "string"}, outputs=POSE),
        ActionInfo(name="NavigateTo", inputs=POSE),
        ActionInfo(name="Inspect", inputs={"inspect": "string"}, outputs={"inspection_result": "string"}),
        ActionInfo(name="AskOperator", inputs={"question": "string"}, outputs={"answer": "string"}),
    ),
    "primitives": (
        ActionInfo(name="move_to", inputs={"location": "string"}),
        ActionInfo(name="look_for_obj", inputs={"object": "string"}),
        ActionInfo(name="look_for_person", inputs={"person": "string"}),
        ActionInfo(name="follow", inputs={"person": "string"}),
        ActionInfo(name="grasp", inputs={"object": "string"}),
        ActionInfo(name="pass_to", inputs={"object": "string", "person": "string"}),
        ActionInfo(name="speak", inputs={"text": "string"}),
        ActionInfo(name="answer", inputs={"question": "string"}),
    ),
    "bare": (
        ActionInfo(name="MoveRobot", inputs={"goal": "string"}, description="Drive somewhere."),
        ActionInfo(name="VacuumFloor", inputs={"area": "string"}, description="Clean the floor of an area."),
        ActionInfo(
            name="switch_on", inputs={"device": "string"}, phrases=("turn on {device}", "switch on {device}")
        ),
        ActionInfo(name="WaveAt", inputs={"person": "string"}),
    ),
}


@dataclass(frozen=True)
class Case:
    """One sentence and what should come of it."""

    phenomenon: str
    number: int
    body: dict[str, Any]

    @property
    def id(self) -> str:
        return f"{self.phenomenon}-{self.number}: {self.body['say'][:60]}"


def cases() -> list[Case]:
    """All sentences."""
    read = yaml.safe_load((DATA / "development.yaml").read_text(encoding="utf-8"))
    return [
        Case(phenomenon, number, body)
        for phenomenon, listed in read.items()
        for number, body in enumerate(listed, 1)
    ]


def world(name: str) -> dict[str, Any]:
    """One world's data."""
    worlds = yaml.safe_load((DATA / "worlds.yaml").read_text(encoding="utf-8"))
    body = worlds[name]
    return {**worlds[body["like"]], **body} if "like" in body else body


def situation(world_name: str, message: str, **changes: Any) -> Situation:
    """A message said in a world."""
    body = world(world_name)
    values: dict[str, Any] = {
        "message": message,
        "memory": tuple(MemoryEntry(name=name, data=data) for name, data in body["memory"]),
        "objects": tuple(MapObject(str(i), d, x, y, *rest) for i, d, x, y, *rest in body["objects"]),
        "robot_pose": Pose2D(*body["pose"]) if "pose" in body else None,
        "robot": body["robot"],
        "robots": tuple(body["robots"]),
        "catalogue": CATALOGUES[body["catalogue"]],
    }
    return Situation(**(values | changes))


def turns(*contents: str) -> tuple[Turn, ...]:
    """A conversation that the operator began."""
    return tuple(Turn("operator" if i % 2 == 0 else "assistant", text) for i, text in enumerate(contents))


def plan(action: ChatAction) -> list[str]:
    """The queue in short."""
    short: list[str] = []
    flows: list[str] = []
    steps = list(action.queue)
    while steps:
        step = steps.pop(0)
        text = _step(step)
        if step.name == "GetCoordinates" and steps and steps[0].name == "NavigateTo":
            steps.pop(0)
            text = f"go {_words(step)[0]}"
        flow = step.flow.if_ if step.flow else None
        flows.append("" if flow is None else f"{'if' if flow.result else 'unless'} {flow.step}: ")
        short.append(flows[-1] + text)
    return short


def _step(step: ActionCall) -> str:
    if step.name == "NavigateTo" and any(p.has_data for p in step.input_parameters.values()):
        return "back"
    if step.name == "Inspect":
        return f"look {_words(step)[0]}"
    return "ask" if step.name == "AskOperator" else f"{step.name}({', '.join(_words(step))})"


def _words(step: ActionCall) -> list[str]:
    return [p.value for p in step.input_parameters.values() if isinstance(p.value, str)]


def commands(action: ChatAction) -> list[str]:
    """The system commands in short."""
    short = {"add_memory": "add", "remove_memory": "remove"}
    return [
        " ".join(
            [short.get(c.command, c.command), str(c.arguments.get("name", c.arguments.get("parameters", "")))]
        ).strip()
        for c in action.system_cmd
    ]


def wrong(case: Case, action: ChatAction) -> list[str]:
    """What is not as it should be; empty if all is."""
    body, problems = case.body, []
    expected = {"do": body.get("do", []), "commands": body.get("commands", [])}
    got = {"do": plan(action), "commands": commands(action)}
    for name, value in expected.items():
        if got[name] != value:
            problems.append(f"{name}: expected {value}, got {got[name]}")
    for name in ("choices", "targets"):
        if name in body and list(getattr(action, name)) != body[name]:
            problems.append(f"{name}: expected {body[name]}, got {list(getattr(action, name))}")
    if not set(body.get("uses", [])) <= set(action.sources):
        problems.append(f"uses: expected {body['uses']}, got {list(action.sources)}")
    problems += [
        f"says: {part!r} missing" for part in body.get("says", []) if part not in action.message_response
    ]
    if body.get("asks") and not any(mark in action.message_response for mark in ("?", "Tell me")):
        problems.append("asks: no question")
    if not action.message_response.strip():
        problems.append("says nothing")
    return [*problems, f"reply: {action.message_response}"] if problems else []
