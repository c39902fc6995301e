"""What one robot of a team has found, the others need not look for any more. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo, PlanStep
from parley.team.sharing import OVER, tasks_of

__all__ = ["is_that", "needless", "sought"]

_ON_THE_WAY: Final = frozenset({"locates", "moves", "looks"})


def is_that(found: str, wanted: str) -> bool:
    """Whether what was found is what was wanted: a crate is "the red crate", a box is not "all boxes"."""
    one, other = _words(found), _words(wanted)
    return bool(one) and one[-1:] == other[-1:] and {*one} <= {*other}


def sought(call: ActionCall, catalogue: Sequence[ActionInfo]) -> str:
    """What an action looks for or at; empty if it does not look."""
    return next(iter(_texts(call)), "") if "looks" in _effects(call, catalogue) else ""


def needless(steps: Sequence[PlanStep], catalogue: Sequence[ActionInfo], found: str) -> list[PlanStep]:
    """The steps that only lead to a look for what is found, at places that are called otherwise.

    Whoever is sent to look at a thing itself is not left without it.

    Args:
        steps: What a robot does of one order.
        catalogue: Its actions.
        found: What was found, as it was wanted.
    """
    left: list[PlanStep] = []
    at = 0
    for task in tasks_of([step.action for step in steps], catalogue):
        own, at = steps[at : at + len(task)], at + len(task)
        looks = [what for call in task if (what := sought(call, catalogue))]
        places = [text for call in task if not sought(call, catalogue) for text in _texts(call)]
        searches = looks and all(is_that(found, what) for what in looks)
        elsewhere = places and not any(is_that(found, place) for place in places)
        if searches and elsewhere and all(_effects(call, catalogue) <= _ON_THE_WAY for call in task):
            left += [step for step in own if step.state not in OVER]
    return left


def _words(text: str) -> list[str]:
    words = re.findall(r"[^\W_]+", text.lower())
    return [word for word in words if not word.isdigit() and word not in ("the", "a", "an")]


def _texts(call: ActionCall) -> list[str]:
    return [
        item.value for item in call.input_parameters.values() if item.has_data and isinstance(item.value, str)
    ]


def _effects(call: ActionCall, catalogue: Sequence[ActionInfo]) -> frozenset[str]:
    """An action that nobody knows may do anything."""
    return next((frozenset(info.effects) for info in catalogue if info.name == call.name), frozenset({"?"}))
