"""What a step does, in words that code wrote from action, arguments and map; and what a yes is bound to.

A language engine's own words about a step (`reason`) are never used here: people decide by what is written
here, so it must say what will be done.
"""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, Final

from parley.messages.chat import ActionCall, SystemCommand
from parley.messages.plain import in_words, one_line
from parley.messages.status import ActionInfo
from parley.sentences import Sentence, sentence
from parley.world.object_map import MapObject

__all__ = ["Labels", "command_label", "digest_of", "for_next", "labels_of", "lines_of"]

Labels = tuple[Sentence, ...]

_HOLE: Final = re.compile(r"\{([^{}]*)\}")
_NUMBER: Final = re.compile(r"-?[0-9.]+")
_POSE: Final = "pose::"
_X, _Y = f"{_POSE}position::x", f"{_POSE}position::y"
_NEAR_M: Final = 2.0
_QUOTED_CHARS: Final = 2000
"""More than anybody reads; up to there nothing of what will be done is left out."""


def labels_of(
    calls: Sequence[ActionCall],
    catalogue: Sequence[ActionInfo],
    objects: Sequence[MapObject] = (),
) -> Labels:
    """What each step does.

    Args:
        calls: The steps in order.
        catalogue: What the robot can do.
        objects: What the robot's map knows, to name places.
    """
    infos = {info.name: info for info in catalogue}
    hidden = for_next(calls, catalogue)
    lines = [at + 1 - sum(hidden[:at]) for at in range(len(calls))]
    labels: list[Sentence] = []
    for index, call in enumerate(calls):
        label = _label(call, infos.get(call.name), _place(calls, index, infos, objects))
        labels.append(_conditional(call, label, lines))
    return tuple(labels)


def lines_of(
    calls: Sequence[ActionCall], labels: Sequence[Sentence], catalogue: Sequence[ActionInfo]
) -> Labels:
    """The labels that people read of steps: a search that is made only for the next step belongs to it."""
    hidden = for_next(calls, catalogue)
    return tuple(label for label, is_hidden in zip(labels, hidden, strict=True) if not is_hidden)


def for_next(calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo]) -> tuple[bool, ...]:
    """Of each step whether it only finds out what the next one needs."""
    finding = {info.name for info in catalogue if info.only_finds}
    pairs = zip(calls, [*calls, None][1:], strict=True)
    return tuple(
        call.name in finding
        and after is not None
        and bool({*call.output_parameters} & {*after.input_parameters})
        for call, after in pairs
    )


def command_label(command: SystemCommand, step: str = "") -> Sentence:
    """What a command of a language engine would change, for the question about it.

    Args:
        command: `clear`, `skip`, `pop`, `start`, `add_memory`, `remove_memory`.
        step: The label of the step it is about, if it is about one.
    """
    name = str(command.arguments.get("name") or command.arguments.get("parameters") or "")
    match command.command:
        case "clear":
            return sentence("Give up the plan as it is")
        case "skip" | "pop":
            return sentence("Leave out: {step}", step=step) if step else sentence("Leave out a step")
        case "remove_memory":
            return sentence("Forget “{name}”", name=_quoted(name))
        case "add_memory":
            return sentence("Remember “{data}”", data=_quoted(str(command.arguments.get("data", ""))))
        case "start":
            return sentence("Go on")
    return sentence("Stand still")


def digest_of(
    robot: str,
    calls: Sequence[ActionCall],
    commands: Sequence[SystemCommand] = (),
    objects: Sequence[MapObject] = (),
) -> str:
    """What a yes is bound to: robot, steps with all arguments, changes, and where named things stand now.

    A language engine's words about a step do not count; where a thing is on the map does, so that a yes to
    the box by the door is no yes to the box that was carried to the stairs.
    """
    steps = [_bare(call) for call in calls]
    text = json.dumps(steps, ensure_ascii=False)
    places = sorted(
        (item.id, round(item.x_m, 2), round(item.y_m, 2))
        for item in objects
        if item.id in text or (item.description and item.description.casefold() in text.casefold())
    )
    whole = [robot, steps, [command.model_dump() for command in commands], places]
    canonical = json.dumps(whole, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(canonical.encode()).hexdigest()


def _bare(call: ActionCall) -> Mapping[str, Any]:
    dumped: dict[str, Any] = call.model_copy(update={"reason": ""}).model_dump()
    return dumped


def _label(call: ActionCall, info: ActionInfo | None, place: str | Sentence) -> Sentence:
    arguments = {name: _said(item.value) for name, item in call.input_parameters.items() if item.has_data}
    offered = (info.label, *info.phrases) if info is not None else ()
    phrase = next((text for text in offered if text and _fits(text, arguments, place)), "")
    named = set(_HOLE.findall(phrase))
    if not named <= set(arguments):  # a hole that is no argument stands for the pose
        named |= {name for name in arguments if name.startswith(_POSE)}
    if phrase:
        phrase = phrase[:1].upper() + phrase[1:]
        told = {hole: arguments.get(hole, place) for hole in _HOLE.findall(phrase)}
        fills = {hole: text if isinstance(text, Sentence) else _in_marks(text) for hole, text in told.items()}
        what = Sentence.of(phrase, dict(fills))
    else:
        words = in_words(call.name)
        what = sentence("{what}", what=words[:1].upper() + words[1:])
    known = info.parameters if info is not None else {}
    hidden = {name for name, about in known.items() if about.kind == "id"}
    rest = {name: value for name, value in arguments.items() if name not in named | hidden}
    if not rest:
        return what
    given = ", ".join(
        f"{in_words(name.rpartition('::')[2])} {_in_marks(value)}" for name, value in rest.items()
    )
    return sentence("{what}: {arguments}", what=what, arguments=given)


def _fits(phrase: str, arguments: Mapping[str, str], place: str | Sentence) -> bool:
    """Whether every hole of a phrase is an argument, but for one that a place fills."""
    foreign = [hole for hole in _HOLE.findall(phrase) if hole not in arguments]
    return not foreign or (len(foreign) == 1 and bool(place))


def _conditional(call: ActionCall, label: Sentence, lines: Sequence[int]) -> Sentence:
    """With what it depends on, by the number that people read before it."""
    flow = call.flow
    if flow is None:
        return label
    if flow.repeat is not None and flow.repeat > 1:
        label = sentence("{what}, {count} times", what=label, count=flow.repeat)
    if flow.if_ is not None:
        number = _line_at(flow.if_.step, lines)
        if flow.if_.result:
            return sentence("If step {number} says yes: {what}", number=number, what=label)
        return sentence("If step {number} says no: {what}", number=number, what=label)
    if flow.together_with is not None:
        number = _line_at(flow.together_with, lines)
        return sentence("At the same time as step {number}: {what}", number=number, what=label)
    return label


def _line_at(step: int, lines: Sequence[int]) -> int:
    return lines[step] if step < len(lines) else step + 1


def _place(
    calls: Sequence[ActionCall], index: int, infos: Mapping[str, ActionInfo], objects: Sequence[MapObject]
) -> str | Sentence:
    """The place a pose among the arguments means: by the map, or by what the step before looked up."""
    call = calls[index]
    x, y = call.input_parameters.get(_X), call.input_parameters.get(_Y)
    if x is None and y is None:
        return ""
    if x is not None and y is not None and x.has_data and y.has_data:
        return _by_map(x.value, y.value, objects)
    for giver in reversed(calls[:index]):
        if _X in giver.output_parameters or _X in (infos[giver.name].outputs if giver.name in infos else {}):
            texts = [p.value for p in giver.input_parameters.values() if p.type == "string" and p.has_data]
            return _quoted(str(texts[0])) if texts else ""
    return ""


def _by_map(x: Any, y: Any, objects: Sequence[MapObject]) -> str | Sentence:
    """By what is nearest to it; in numbers only where nothing on the map has a name."""
    try:
        x_m, y_m = float(x), float(y)
    except (TypeError, ValueError):
        return _quoted(f"{x}, {y}")
    distances = [
        (math.hypot(item.x_m - x_m, item.y_m - y_m), item.description or item.id) for item in objects
    ]
    if not distances:
        return f"x {x_m:.1f} m, y {y_m:.1f} m"
    distance_m, name = min(distances)
    if distance_m <= _NEAR_M:
        return sentence("a place near “{name}”", name=_quoted(name))
    return sentence("a place {distance} m from “{name}”", distance=f"{distance_m:.0f}", name=_quoted(name))


def _said(value: object) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    return _quoted(", ".join(map(str, value)) if isinstance(value, list | tuple) else str(value))


def _in_marks(text: str) -> str:
    """As it stands in a line: what could be words of ours, which a number cannot, in quotation marks."""
    return text if _NUMBER.fullmatch(text) else f"“{text}”"


def _quoted(text: str) -> str:
    """Somebody's text between our quotation marks: its own cannot end them."""
    plain = one_line(text).replace("“", "‘").replace("”", "’")
    return plain if len(plain) <= _QUOTED_CHARS else f"{plain[:_QUOTED_CHARS]} …"
