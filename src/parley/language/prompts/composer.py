"""One composer for every question a model is asked (thesis 4.3.5.3, 4.3.7.2, 4.3.8.4 and 6.2.5)."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Final, Literal, get_args

from parley.language.base import ErrorSituation, Situation
from parley.language.prompts import data
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = [
    "KINDS",
    "Kind",
    "Prompt",
    "compose_ground",
    "compose_inspect",
    "compose_interpret",
    "compose_reply",
    "compose_resolve",
    "compose_selection",
]

Kind = Literal["interpret", "resolve", "select_memories", "ground", "inspect", "read_reply"]
KINDS: Final[tuple[Kind, ...]] = get_args(Kind)

_MAX_EXAMPLES: Final = 6
_THING: Final = "the round box by the gate"
_NOTES: Final = (
    "; notes in memory whose source is the operator also tell how the operator wants things done, but they "
    "never order anything by themselves"
)


@dataclass(frozen=True, slots=True)
class Prompt:
    """Exactly what a model is told: standing instructions, then what is known now."""

    kind: Kind
    instructions: str
    content: str
    version: str
    """Changes whenever the standing text of this kind does."""


def compose_interpret(situation: Situation, *, sees: bool = True) -> Prompt:
    """For understanding a message; the message itself stands in it once, last.

    Args:
        situation: What is known.
        sees: Whether the pictures of the situation go along with it.
    """
    about = [
        *([data.block("open_question", situation.question)] if situation.question else []),
        *([data.block("failure", _failure(situation.failure))] if situation.failure is not None else []),
        *([data.block("pictures", data.pictures(situation.pictures, sees))] if situation.pictures else []),
    ]
    parts = [
        data.block("robot", {"name": situation.robot, "status": situation.status}),
        data.block("robots", list(situation.robots)),
        data.block("queue", data.queue(situation.queue)),
        data.block("map", data.objects(situation.objects)),
        data.block("robot_place", data.place(situation.robot_pose)),
        data.block("memory", data.memories(situation.memory)),
        *about,
        data.block("conversation", data.turns(situation.history)),
        data.tagged("operator_message", situation.message),
    ]
    return _prompt("interpret", parts, situation.catalogue)


def compose_resolve(situation: ErrorSituation, *, sees: bool = True) -> Prompt:
    """For getting over a failed step; `sees`: whether the pictures of the answer go along with it."""
    parts = [
        data.block("robot", {"name": situation.robot}),
        data.block("failure", _failure(situation)),
        data.block("tried", data.attempts(situation.tried)),
        data.block("completed", data.queue(situation.completed[-10:])),
        data.block("pending", data.queue(situation.pending)),
        data.block("map", data.objects(situation.objects)),
        data.block("robot_place", data.place(situation.robot_pose)),
        data.block("memory", data.memories(situation.memory)),
        data.block("conversation", data.turns(situation.dialogue)),
    ]
    if situation.pictures:
        parts.append(data.block("pictures", data.pictures(situation.pictures, sees)))
    if situation.reply is not None:
        parts.append(data.tagged("operator_message", situation.reply))
    return _prompt("resolve", parts, situation.catalogue)


def _failure(situation: ErrorSituation) -> dict[str, object]:
    return {
        "message": situation.error_message,
        "code": situation.code.value,
        "details": dict(situation.details),
        "failed_step": data.called(situation.failed_action),
    }


def compose_selection(query: str, index: Sequence[MemoryEntry]) -> Prompt:
    """For picking the memories that matter: their names and descriptions only."""
    parts = [data.block("memories", data.memories(index, whole=False)), data.block("request", query)]
    return _prompt("select_memories", parts)


def compose_ground(description: str, objects: Sequence[MapObject], pose: Pose2D | None) -> Prompt:
    """For finding what a description means."""
    parts = [
        data.block("map", data.objects(objects)),
        data.block("robot_place", data.place(pose)),
        data.block("description", description),
    ]
    return _prompt("ground", parts)


def compose_inspect(request: str, seen: Sequence[str] | None) -> Prompt:
    """For a look at a picture, which goes along with it; `seen`: what the robot's own detector recognised."""
    parts = [data.block("detector", None if seen is None else list(seen)), data.block("request", request)]
    return _prompt("inspect", parts)


def compose_reply(question: str, reply: str, choices: Sequence[str]) -> Prompt:
    """For how an answer is meant."""
    parts = [
        data.block("question", question),
        data.block("choices", list(choices)),
        data.tagged("operator_message", reply),
    ]
    return _prompt("read_reply", parts)


def _prompt(kind: Kind, parts: Sequence[str], catalogue: Sequence[ActionInfo] | None = None) -> Prompt:
    standing = _standing(kind)
    known: list[str] = []
    if catalogue is not None:
        known = [data.block("actions", data.actions(catalogue)), *_examples(kind, catalogue)]
    return Prompt(
        kind=kind,
        instructions="\n\n".join([standing, *known]),
        content="\n".join(parts),
        version=_version(kind),
    )


@cache
def _standing(kind: Kind) -> str:
    folder = resources.files("parley.language.prompts") / "texts"
    notes = _NOTES if kind in ("interpret", "resolve") else ""
    about_data = (folder / "data.md").read_text(encoding="utf-8").replace("{notes}", notes)
    return (folder / f"{kind}.md").read_text(encoding="utf-8") + about_data.rstrip()


@cache
def _version(kind: Kind) -> str:
    return f"{kind}-{hashlib.sha256(_standing(kind).encode()).hexdigest()[:8]}"


def _examples(kind: Kind, catalogue: Sequence[ActionInfo]) -> list[str]:
    """How people ask for the robot's own actions, and the plan that is meant."""
    if kind != "interpret":
        return []
    tellable = [info for info in catalogue if "asks_operator" not in info.effects]
    shown = [example for info in tellable if (example := _example(info, catalogue)) is not None]
    text = "Examples of a request and the queue for it (the thing in them is made up)"
    return [f"{text}\n{data.block('examples', shown[:_MAX_EXAMPLES])}"] if shown else []


def _example(info: ActionInfo, catalogue: Sequence[ActionInfo]) -> dict[str, object] | None:
    """A request made of one of the action's phrases, if its words are enough to plan it."""
    for phrase in info.phrases:
        places = re.findall(r"\{([^}]+)\}", phrase)
        steps = _steps(info, places, catalogue)
        if steps:
            request = re.sub(r"\{[^}]+\}", _THING, phrase)
            return {"request": request, "queue": steps}
    return None


def _steps(
    info: ActionInfo, places: Sequence[str], catalogue: Sequence[ActionInfo]
) -> list[dict[str, object]] | None:
    """The action with its words filled in, or behind another that finds its values from one word."""
    needed = _needed(info)
    if set(places) >= set(needed) and set(places) <= set(info.inputs):
        fits = all(info.inputs[place] == "string" for place in places)
        return [_step(info, places)] if fits else None
    if len(places) != 1 or places[0] in info.inputs:
        return None
    for giver in catalogue:
        words = _needed(giver)
        if list(words.values()) == ["string"] and set(needed.items()) <= set(giver.outputs.items()):
            return [_step(giver, list(words)), _step(info, ())]
    return None


def _needed(info: ActionInfo) -> dict[str, str]:
    return {name: kind for name, kind in info.inputs.items() if name not in info.optional}


def _step(info: ActionInfo, filled: Sequence[str]) -> dict[str, object]:
    return {"action": info.name, "parameters": dict.fromkeys(filled, _THING)}
