"""What is known, as blocks of data that a model cannot mistake for instructions.

Content is written as JSON with ``<`` and ``>`` escaped: nothing inside a block can end it, begin another, or
look like a model's own marks. Everything is capped, and what was left out is counted.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from parley.language.base import Picture, Turn
from parley.language.prompts.labels import MOST_STEPS, memory_label, step_label
from parley.memory.limits import MOST_MEMORIES
from parley.messages.chat import ActionCall
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = [
    "QUEUE_CHARS",
    "actions",
    "attempts",
    "block",
    "called",
    "completed",
    "memories",
    "objects",
    "pictures",
    "place",
    "queue",
    "rules",
    "tagged",
    "turns",
]

QUEUE_CHARS: Final = 1000
"""Whole actions up to this many characters of the pending queue are shown (thesis 4.3.7.2)."""
TEXT_CHARS: Final = 2000
"""Of one memory, turn or description."""
MAX_OBJECTS: Final = 400
MAX_TURNS: Final = 40
MAX_PHRASES: Final = 6
MAX_ATTEMPTS: Final = 10
MAX_COMPLETED: Final = 10


def tagged(tag: str, value: Any, attributes: str = "") -> str:
    """``<tag>`` around a value as JSON; a list gets a line for each item."""
    if isinstance(value, list | tuple):
        lines = ",\n".join(_json(item) for item in value)
        text = f"[\n{lines}\n]" if lines else "[]"
    else:
        text = _json(value)
    return f"<{tag}{attributes}>\n{text}\n</{tag}>"


def block(name: str, value: Any) -> str:
    """A ``<data>`` block; `name` is ours, `value` is anybody's."""
    return tagged("data", value, f' name="{name}"')


def _json(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text.replace("<", "\\u003c").replace(">", "\\u003e")


def _cut(text: str, longest: int = TEXT_CHARS) -> str:
    return text if len(text) <= longest else f"{text[:longest]}… ({len(text) - longest} characters left out)"


def _capped(items: list[dict[str, Any]], most: int, *, newest: bool = False) -> list[dict[str, Any]]:
    if len(items) <= most:
        return items
    note = {"left_out": len(items) - most}
    return [note, *items[-most:]] if newest else [*items[:most], note]


def called(call: ActionCall) -> dict[str, Any]:
    """One action as a model writes it itself: name, values, reason."""
    values = {name: item.value for name, item in call.input_parameters.items() if item.has_data}
    body: dict[str, Any] = {"action": call.name, "parameters": values}
    return body | ({"reason": _cut(call.reason, 200)} if call.reason else {})


def queue(calls: Sequence[ActionCall], most_chars: int = QUEUE_CHARS) -> list[dict[str, Any]]:
    """Whole actions, as many as fit; the rest is counted."""
    shown: list[dict[str, Any]] = []
    left = most_chars
    for index, call in enumerate(calls):
        item = {"step": step_label(index), **called(call)}
        left -= len(_json(item))
        if left < 0 or index == MOST_STEPS:
            return [*shown, {"left_out": len(calls) - index}]
        shown.append(item)
    return shown


def completed(calls: Sequence[ActionCall], results: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """The last steps that were done, each with what it gave, as far as `results` say."""
    given = [*results[: len(calls)], *({} for _ in calls[len(results) :])]
    done = list(zip(calls, given, strict=True))[-MAX_COMPLETED:]
    shown = [called(call) | ({"gave": dict(gave)} if gave else {}) for call, gave in done]
    return [item if len(_json(item)) <= TEXT_CHARS else item | {"gave": "(too long)"} for item in shown]


def rules(told: Sequence[str]) -> list[dict[str, Any]]:
    """What operators taught, each with a label."""
    return [{"rule": f"r{number}", "text": _cut(text)} for number, text in enumerate(told, 1)]


def memories(entries: Sequence[MemoryEntry], *, whole: bool = True) -> list[dict[str, Any]]:
    """Oldest first; without `whole` only what is needed to pick (thesis 4.3.8.4)."""
    shown: list[dict[str, Any]] = []
    for index, entry in enumerate(entries):
        item: dict[str, Any] = {
            "label": memory_label(index),
            "name": _cut(entry.name, 200),
            "info": _cut(entry.info, 300),
        }
        if entry.type == "image":
            item["type"] = "image"
        elif whole:
            item["data"] = _cut(entry.data)
        elif not entry.info:
            item["info"] = _cut(entry.data, 300)
        if whole and entry.source:
            item["source"] = entry.source
        shown.append(item)
    return _capped(shown, MOST_MEMORIES, newest=True)


def pictures(shown: Sequence[Picture], sees: bool) -> list[dict[str, Any]]:
    """What the pictures are that go along, in their order; or that they cannot be seen."""
    return [
        {
            "picture": number,
            "name": _cut(picture.name, 200),
            "from": "the operator's message" if picture.sent else "memory",
            **({} if sees else {"shown": False}),
        }
        for number, picture in enumerate(shown, 1)
    ]


def attempts(tried: Sequence[Sequence[ActionCall]]) -> list[list[dict[str, Any]]]:
    """What was carried out in place of a failed step, in vain; the newest last."""
    return [queue(calls) for calls in tried[-MAX_ATTEMPTS:]]


def objects(things: Iterable[MapObject]) -> list[dict[str, Any]]:
    """What stands on the map; metres."""
    shown: list[dict[str, Any]] = []
    for thing in things:
        item: dict[str, Any] = {
            "id": thing.id,
            "description": _cut(thing.description, 300),
            "x": round(thing.x_m, 2),
            "y": round(thing.y_m, 2),
        }
        if thing.class_name:
            item["class"] = thing.class_name
        if thing.aliases:
            item["also_called"] = [_cut(name, 100) for name in thing.aliases[:10]]
        shown.append(item)
    return _capped(shown, MAX_OBJECTS)


def place(pose: Pose2D | None) -> dict[str, float] | None:
    """Where the robot stands; metres and radians in the map frame."""
    if pose is None:
        return None
    return {"x": round(pose.x_m, 2), "y": round(pose.y_m, 2), "yaw": round(pose.yaw_rad, 2)}


def turns(said: Sequence[Turn]) -> list[dict[str, Any]]:
    """The conversation so far, oldest first."""
    return _capped([{turn.role: _cut(turn.content)} for turn in said], MAX_TURNS, newest=True)


def actions(catalogue: Sequence[ActionInfo]) -> list[dict[str, Any]]:
    """What the robot can do, and which parameters another action fills in."""
    return [_action(info, _givers(info, catalogue)) for info in catalogue]


def _givers(info: ActionInfo, catalogue: Sequence[ActionInfo]) -> list[str]:
    return [
        other.name
        for other in catalogue
        if other.name != info.name and set(other.outputs.items()) & set(info.inputs.items())
    ]


def _parameter(info: ActionInfo, name: str) -> object:
    """The type, and what else is told: what it means, its unit, what it may be."""
    about = info.parameters.get(name)
    told = about.model_dump(exclude_defaults=True) if about is not None else {}
    return {"type": info.inputs[name], **told} if told else info.inputs[name]


def _is_id(info: ActionInfo, name: str) -> bool:
    return name in info.parameters and info.parameters[name].kind == "id"


def _action(info: ActionInfo, givers: Sequence[str]) -> dict[str, Any]:
    shown: dict[str, Any] = {
        "action": info.name,
        "description": _cut(info.description),
        "parameters": {name: _parameter(info, name) for name in info.inputs if not _is_id(info, name)},
    }
    extras: Mapping[str, Any] = {
        "optional": list(info.optional),
        "gives": info.outputs,
        "parameters_given_by": list(givers),
        "effects": list(info.effects),
        "people_say": [_cut(text, 200) for text in (*info.phrases, *info.examples)[:MAX_PHRASES]],
    }
    shown |= {name: value for name, value in extras.items() if value}
    return shown | ({"risk": info.risk} if info.risk == "high" else {})
