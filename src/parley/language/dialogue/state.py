"""The state of a dialogue with one robot, as a message is understood in it. Typed and immutable."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from parley.messages.chat import ActionCall
from parley.messages.status import PlanProposal, PlanStep
from parley.world.geometry import Pose2D

__all__ = ["Asked", "Deed", "Dialogue", "Order", "Stop"]

Ending = Literal["done", "no", "failed", "stopped", "left out", "running"]
"""`no`: it was done, and what it was to find out does not hold."""


@dataclass(frozen=True, slots=True)
class Order:
    """What a person asked for, and the steps that were made of it."""

    words: str
    by: str = ""
    """Their name, if it is known."""
    unix_ms: int = 0
    calls: tuple[ActionCall, ...] = ()
    pose: Pose2D | None = None
    """Where the robot was then."""
    why: str = ""
    """Why it was this robot, if that was left to the robots."""


@dataclass(frozen=True, slots=True)
class Deed:
    """One step that was begun, with what came of it."""

    label: str
    """In words that our code wrote from action, arguments and map."""
    call: ActionCall
    effects: tuple[str, ...] = ()
    order: Order | None = None
    ending: Ending = "running"
    unix_ms: int = 0
    """When it ended, or began."""
    told: tuple[str, ...] = ()
    """What the robot said meanwhile."""
    seen: tuple[str, ...] = ()
    """What it recognised meanwhile."""

    @property
    def looked(self) -> bool:
        """Whether something was looked at."""
        return "looks" in self.effects

    @property
    def moved(self) -> bool:
        """Whether it led somewhere."""
        return "moves" in self.effects


@dataclass(frozen=True, slots=True)
class Asked:
    """What was asked back about an order, and may still be answered."""

    words: str
    """The order."""
    choices: tuple[str, ...] = ()
    where: str = ""
    """Whose or what's place was asked for; `you` for who spoke."""
    alarm: bool = False
    """Whether they told of danger, and what to do about it was asked."""


@dataclass(frozen=True, slots=True)
class Stop:
    """Somebody told the robot to stand still."""

    words: str
    by: str = ""
    unix_ms: int = 0


@dataclass(frozen=True, slots=True)
class Dialogue:
    """All that was said and done so far, as far as it is needed to understand what is said next."""

    plan: str = "idle"
    """The state of the plan, as it is published."""
    steps: tuple[PlanStep, ...] = ()
    """Of the plan in progress, those that are over among them."""
    proposal: PlanProposal | None = None
    """What waits for a yes."""
    deeds: tuple[Deed, ...] = ()
    """Oldest first."""
    orders: tuple[Order, ...] = ()
    """Those that were carried out or waited for a yes, oldest first."""
    asked: Asked | None = None
    """The order that waits for a choice among several things, for a place, or for what to do in danger."""
    waiting: tuple[str, ...] = ()
    """Orders, in their words, that are done when somebody tells what they wait for; oldest first."""
    told: tuple[str, ...] = ()
    """Facts that were told beside orders that were asked about: they count in this conversation."""
    stopped: Stop | None = None
    """The last time."""
    refused: str = ""
    """Why the last order was not carried out, if it was not."""
    left_s: float | None = None
    """How long the running step may still take."""
    left_text: str = ""
    """What is left of it, in the action's own words."""
    battery: float | None = None
    latched: bool = False
    """Whether an emergency stop is in force."""
    now_unix_ms: int = 0
