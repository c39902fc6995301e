"""What the planner makes of orders and decisions before a plan hears of them, and its own words. Pure."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

from parley.agents.planner.effects import Effect
from parley.agents.planner.plan import TargetPlan
from parley.errors import Problem
from parley.gate.cards import for_next, labels_of
from parley.gate.judge import Finding
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.status import ActionInfo
from parley.sentences import Sentence, sentence

__all__ = [
    "BEGUN_ALREADY", "LEFT", "MOST_STEPS", "MOST_WAITING", "MUCH_TO_DO", "NOTHING_DONE", "NOT_AS_SHOWN",
    "PLAN_CHANGED", "STEP_OVER", "TOO_MANY_WAIT", "WAITING", "WAITING_HELPLESS", "WAITS_NO_MORE",
    "bare", "forgetting", "impossible", "in_order",
    "no_robot", "of_memory", "of_plans", "reasons", "take_repair",
]  # fmt: skip

_HELP: Final = sentence("Say “try again”, “skip it” or “cancel everything”, or give me another order.")
WAITING: Final = sentence("Then I am waiting here. {help}", help=_HELP)
WAITING_HELPLESS: Final = sentence(
    "What I worked out would not help, so I am waiting here. {help}", help=_HELP
)
NOTHING_DONE: Final = "I worked out a plan that I cannot carry out, so I did nothing."
LEFT: Final = "I cannot carry out these steps, so I left everything as it is."
_WHY: Final = {
    "missing_input": "something that it needs is not given",
    "unknown_action": "I cannot do such a thing",
}
NOT_AS_SHOWN: Final = sentence("What waits for your yes has changed since you saw it, so I have not begun.")
BEGUN_ALREADY: Final = sentence(
    "Somebody had said yes already, so I have stopped. Say “carry on” when I should go on."
)
STEP_OVER: Final = "That step is over by now, so there was nothing to leave out."
MOST_WAITING: Final = 20
"""Proposals of a robot that wait for a yes at once."""
TOO_MANY_WAIT: Final = sentence(
    "Too much waits for your yes already, so I have not taken that up. Say no to what you no longer want."
)
MOST_STEPS: Final = 200
"""Steps that a robot has yet to do, beyond which it takes up nothing more: all are told at each change."""
MUCH_TO_DO: Final = sentence(
    "I have a great deal to do already, so I have not taken that up. Say it again when some of it is done."
)
WAITS_NO_MORE: Final = "That plan is no longer waiting for an answer."
PLAN_CHANGED: Final = "The plan has changed in the meantime, so I left it as it is. Please look at it again."


def no_robot(name: str, known: str) -> str:
    """That nobody is called `name`, and who is there."""
    return sentence("There is no robot called {name}. {known}", name=name, known=known)


def impossible(
    calls: Sequence[ActionCall],
    catalogue: Sequence[ActionInfo],
    problems: Sequence[Problem],
    before: int = 0,
) -> Sentence:
    """Which step of an edit cannot be carried out, and why; of several the first.

    Args:
        calls: The steps that a person put together.
        catalogue: Of the robot.
        problems: What speaks against them.
        before: How many steps stand before them.
    """
    steps = [int(found[1]) for item in problems if (found := re.match(r"steps\[(\d+)\]", item.path))]
    at = min(steps, default=len(calls))
    if at >= len(calls):
        return sentence(LEFT)
    code = next(item.code for item in problems if item.path.startswith(f"steps[{at}]"))
    hidden = for_next(calls, catalogue)
    shown = at + 1 if hidden[at] else at  # a search stands as the step that it is made for
    step = labels_of(calls, catalogue)[shown]
    label = next((info.label for info in catalogue if info.name == calls[shown].name), "")
    if code == "missing_input" and label:
        step = sentence("{step}", step=re.sub(r"\{[^{}]*\}", "…", label))
    return sentence(
        "I cannot do step {number}, “{step}”: {why}. I left everything as it is.",
        number=before + at + 1 - sum(hidden[:at]),
        step=step,
        why=sentence(_WHY.get(code, "it does not fit there")),
    )


def reasons(findings: Iterable[Finding], before: int = 0) -> list[str]:
    """What rules say, each thing once; `before`: how many steps stand before those that were judged."""
    return list(dict.fromkeys(_counted(finding.sentence, before) for finding in findings))


def _counted(text: str, before: int) -> str:
    if not (before and isinstance(text, Sentence) and isinstance(number := text.values.get("number"), int)):
        return text
    return Sentence.of(text.template, text.values | {"number": number + before})


def take_repair(plan: TargetPlan, calls: Sequence[ActionCall]) -> list[Effect]:
    """Do what a person agreed to, even if the robot was told to stand still meanwhile."""
    return plan.append(calls) if plan.given_up and calls else plan.correct(calls)


def bare(call: ActionCall) -> tuple[str, object]:
    """What makes two actions do the same: name and arguments."""
    return call.name, call.input_parameters


def of_memory(order: ChatAction) -> list[SystemCommand]:
    """The commands of an order that are about memories."""
    return [c for c in order.system_cmd if c.command in ("add_memory", "remove_memory")]


def forgetting(order: ChatAction) -> list[SystemCommand]:
    """What is to be forgotten only after a yes."""
    return [c for c in of_memory(order) if order.needs_yes and c.command == "remove_memory"]


def of_plans(order: ChatAction) -> list[SystemCommand]:
    """The others."""
    return [c for c in order.system_cmd if c.command not in ("add_memory", "remove_memory")]


def in_order(commands: Sequence[SystemCommand]) -> list[SystemCommand]:
    """Steps are counted before any is dropped, so the last is dropped first."""
    last_first = iter(
        sorted((c for c in commands if c.command == "pop"), key=lambda c: c.pop_index or 0, reverse=True)
    )
    return [next(last_first) if command.command == "pop" else command for command in commands]
