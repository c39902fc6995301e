"""Situations in the worlds of the development set, and in short what an engine made of them."""

from __future__ import annotations

from functools import cache
from typing import Any

from parley.evaluation.cases import CaseSet
from parley.evaluation.catalogues import CATALOGUES, POSE
from parley.evaluation.sets import own_set
from parley.language.base import Situation, Turn
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["CATALOGUES", "POSE", "commands", "development_set", "plan", "situation", "turns"]


@cache
def development_set() -> CaseSet:
    """All sentences, and the worlds in which they are said."""
    return own_set("development")


def situation(world_name: str, message: str, **changes: Any) -> Situation:
    """A message said in a world."""
    world = development_set().worlds[world_name]
    values: dict[str, Any] = {
        "message": message,
        "memory": tuple(MemoryEntry(name=name, data=data) for name, data in world.memory),
        "objects": tuple(MapObject(str(i), d, x, y, *rest) for i, d, x, y, *rest in world.objects),
        "robot_pose": Pose2D(*world.pose) if world.pose is not None else None,
        "robot": world.robot,
        "robots": tuple(world.robots),
        "catalogue": world.actions,
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
