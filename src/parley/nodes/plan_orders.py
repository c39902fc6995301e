"""What the planner makes of orders and decisions before a plan hears of them, and its own words. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from parley.messages.chat import ActionCall, SystemCommand
from parley.nodes.plan import TargetPlan
from parley.nodes.plan_effects import Effect
from parley.sentences import sentence

__all__ = [
    "LEFT", "NOTHING_DONE", "PLAN_CHANGED", "WAITING", "WAITING_HELPLESS", "in_order", "is_same", "no_robot",
    "take_repair",
]  # fmt: skip

_HELP: Final = sentence("Say “try again”, “skip it” or “cancel everything”, or give me another order.")
WAITING: Final = sentence("Then I am waiting here. {help}", help=_HELP)
WAITING_HELPLESS: Final = sentence(
    "What I worked out would not help, so I am waiting here. {help}", help=_HELP
)
NOTHING_DONE: Final = "I worked out a plan that I cannot carry out, so I did nothing."
LEFT: Final = "I cannot carry out these steps, so I left everything as it is."
PLAN_CHANGED: Final = "The plan has changed in the meantime, so I left it as it is. Please look at it again."


def no_robot(name: str, known: str) -> str:
    """That nobody is called `name`, and who is there."""
    return sentence("There is no robot called {name}. {known}", name=name, known=known)


def take_repair(plan: TargetPlan, calls: Sequence[ActionCall]) -> list[Effect]:
    """Do what a person agreed to, even if the robot was told to stand still meanwhile."""
    return plan.append(calls) if plan.given_up and calls else plan.correct(calls)


def is_same(first: ActionCall, second: ActionCall) -> bool:
    """Whether two actions do the same."""
    return first.name == second.name and first.input_parameters == second.input_parameters


def in_order(commands: Sequence[SystemCommand]) -> list[SystemCommand]:
    """Steps are counted before any is dropped, so the last is dropped first."""
    last_first = iter(
        sorted((c for c in commands if c.command == "pop"), key=lambda c: c.pop_index or 0, reverse=True)
    )
    return [next(last_first) if command.command == "pop" else command for command in commands]
