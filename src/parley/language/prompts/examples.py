"""Examples of requests and their answers, made of the robot's own actions; the things are made up."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, Final

from parley.language.prompts.labels import step_label
from parley.messages.status import ActionInfo

__all__ = ["examples"]

_MOST_PHRASES: Final = 4
_RED, _BLUE = "red box", "blue box"

Example = dict[str, Any]
Shown = dict[str, Any]


def examples(catalogue: Sequence[ActionInfo]) -> list[Example]:
    """Requests with plans, an ambiguity and a fact; where the robot can look, a condition and an edit."""
    tellable = [info for info in catalogue if "asks_operator" not in info.effects]
    asked = [example for info in tellable if (example := _asked(info, catalogue)) is not None]
    return [*asked[:_MOST_PHRASES], _ambiguity(), _fact(), *_condition(catalogue), *_edit(catalogue)]


def _asked(info: ActionInfo, catalogue: Sequence[ActionInfo]) -> Example | None:
    """A request made of one of the action's phrases, if its words are enough to plan it."""
    for phrase in info.phrases:
        places = re.findall(r"\{([^}]+)\}", phrase)
        if steps := _steps(info, places, catalogue):
            request = re.sub(r"\{[^}]+\}", f"the {_RED}", phrase)
            return {"request": request, "answer": {"queue": steps}}
    return None


def _ambiguity() -> Example:
    said = f"I know the {_RED} and the {_BLUE}. Which one do you mean?"
    return {
        "request": "go to the box",
        "answer": {"message_response": said, "queue": [], "choices": [_RED, _BLUE]},
    }


def _fact() -> Example:
    fact = f"The key is in the {_RED}."
    kept = {"command": "add_memory", "name": "key", "data": fact, "info": "where the key is"}
    said = f"I will remember that the key is in the {_RED}."
    return {"request": fact, "answer": {"message_response": said, "queue": [], "system_cmd": [kept]}}


def _condition(catalogue: Sequence[ActionInfo]) -> list[Example]:
    first, second = _looked_at(_RED, catalogue), _looked_at(_BLUE, catalogue)
    if not first:
        return []
    only = {"only_if": {"step": len(first) - 1, "result": False}}
    return [
        {
            "request": f"see whether the key is in the {_RED}, and if not, look into the {_BLUE}",
            "answer": {"queue": [*first, *(step | only for step in second)]},
        }
    ]


def _edit(catalogue: Sequence[ActionInfo]) -> list[Example]:
    waiting, instead = _looked_at(_RED, catalogue), _looked_at(_BLUE, catalogue)
    if not waiting:
        return []
    labels = [step_label(index) for index in range(len(waiting))]
    pops = [{"command": "pop", "step": label} for label in labels]
    return [
        {
            "request": f"not the {_RED}, the {_BLUE}",
            "queue": [{"step": label} | step for label, step in zip(labels, waiting, strict=True)],
            "answer": {"queue": instead, "system_cmd": pops},
        }
    ]


def _looked_at(thing: str, catalogue: Sequence[ActionInfo]) -> list[Shown]:
    """The way to a thing, and a look; empty if the robot cannot."""
    look = next(
        (i for i in catalogue if "looks" in i.effects and list(_needed(i).values()) == ["string"]), None
    )
    move = next((info for info in catalogue if "moves" in info.effects and _giver(info, catalogue)), None)
    give = _giver(move, catalogue) if move is not None else None
    if look is None:
        return []
    way = [_step(give, list(_needed(give)), thing), _step(move, (), thing)] if move and give else []
    return [*way, _step(look, list(_needed(look)), thing)]


def _steps(info: ActionInfo, places: Sequence[str], catalogue: Sequence[ActionInfo]) -> list[Shown] | None:
    """The action with its words filled in, or behind another that finds its values from one word."""
    needed = _needed(info)
    if set(places) >= set(needed) and set(places) <= set(info.inputs):
        fits = all(info.inputs[place] == "string" for place in places)
        return [_step(info, places, _RED)] if fits else None
    if len(places) != 1 or places[0] in info.inputs:
        return None
    giver = _giver(info, catalogue)
    return [_step(giver, list(_needed(giver)), _RED), _step(info, (), _RED)] if giver is not None else None


def _giver(info: ActionInfo, catalogue: Sequence[ActionInfo]) -> ActionInfo | None:
    """The action that finds all that `info` needs from one word."""
    needed = _needed(info)
    for giver in catalogue:
        gives = needed and set(needed.items()) <= set(giver.outputs.items())
        if gives and list(_needed(giver).values()) == ["string"]:
            return giver
    return None


def _needed(info: ActionInfo) -> Mapping[str, str]:
    return {name: kind for name, kind in info.inputs.items() if name not in info.optional}


def _step(info: ActionInfo, filled: Sequence[str], thing: str) -> Shown:
    return {"action": info.name, "parameters": dict.fromkeys(filled, f"the {thing}")}
