"""`/parley/rules`: what the page and the terminal ask whoever keeps the rules."""

from __future__ import annotations

from typing import Literal

from parley.messages.base import Payload
from parley.messages.chat import ActionCall
from parley.messages.principal import Principal
from parley.messages.rules import Point, Rule
from parley.sentences import SpokenLanguage

__all__ = ["RuleFinding", "RuleRequest", "RuleVerdict", "RuleView", "RulesAnswer"]


class RuleRequest(Payload):
    """Request of `/parley/rules`."""

    what: Literal["list", "word", "put", "drop", "try"] = "list"
    rule: Rule | None = None
    """For `put`, and for `word`: what it says in words; it does not hold."""
    id: str = ""
    """For `drop`."""
    robot: str = ""
    """For `try`."""
    words: tuple[str, ...] = ()
    """For `try`: places in people's words, one after the other; `steps` and `goal` come before them."""
    steps: tuple[ActionCall, ...] = ()
    """For `try`: a plan."""
    after: tuple[ActionCall, ...] = ()
    """For `try`: what the robot does before that; of it only where it ends counts."""
    goal: Point | None = None
    """For `try`: a point to drive to."""
    language: SpokenLanguage = "en"
    """Of what is told in words."""
    by: Principal | None = None
    """Who changes rules; `try` counts for them."""


class RuleView(Payload):
    """One rule, in words too."""

    rule: Rule
    text: str
    holds_now: bool = True


class RuleFinding(Payload):
    """What one rule says about a plan."""

    step: int
    rule: str = ""
    code: str
    text: str


class RuleVerdict(Payload):
    """What all rules say about a plan that was tried and not driven."""

    forbidden: tuple[RuleFinding, ...] = ()
    ask: tuple[RuleFinding, ...] = ()
    risky: tuple[RuleFinding, ...] = ()
    length_m: float = 0.0
    expected_s: float = 0.0
    way: tuple[Point, ...] = ()
    goals: tuple[Point, ...] = ()
    """Where it would stand on that way, one after the other."""
    unknown: tuple[str, ...] = ()
    """Words with which no single place is meant."""


class RulesAnswer(Payload):
    """Response of `/parley/rules`."""

    rules: tuple[RuleView, ...] = ()
    """All that hold; of `word` the one that was asked about."""
    verdict: RuleVerdict | None = None
    problem: str = ""
    """Why nothing was done, in plain words; empty if it was."""
    file: str = ""
    """Name of the file in which they are kept; empty if they hold only while the system runs."""
