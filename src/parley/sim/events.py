"""What happens in a simulated world by itself: at a time, when a robot comes near, after something else.

::

    events:
      - {name: somebody leaves a parcel, near: {thing: gate_1, within_m: 3}, delay_s: [2, 6],
         change: {add: [{name: parcel_1, pose: [2, 3, 0], parts: [{size_m: [0.4, 0.3, 0.3]}]}]}}
      - {name: it is taken away, after: somebody leaves a parcel, delay_s: 60, change: {remove: [parcel_1]}}
      - {name: the lights fail, at_s: 120, change: {robots: {Ada: {camera: broken}}}}

Seconds are robot time; of a range the seed chooses. Each happens once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from parley.sim.entries import Entry, Name, WorldChanges
from parley.world.geometry import Pose2D

__all__ = ["Events", "WorldEvent"]

Seconds = Annotated[float, Field(ge=0, le=1e6)]
Span = Seconds | tuple[Seconds, Seconds]
_STILL_M = 0.05


class Near(Entry):
    """A robot is near something."""

    thing: Name
    within_m: float = Field(gt=0)
    """From the robot's middle to the thing's frame."""
    robot: str = ""
    """Which one; empty: any."""
    stands_s: float = Field(default=0, ge=0)
    """How long it has to stand there; 0: whoever passes is near, too."""


class WorldEvent(Entry):
    """One thing that happens; exactly one of `at_s`, `near` and `after` says when."""

    name: Name
    at_s: Span | None = None
    """Robot time since the world began."""
    near: Near | None = None
    after: Name | None = None
    """The event that comes before it."""
    delay_s: Span = 0.0
    """How long after that."""
    change: WorldChanges
    """What is different from then on."""

    @model_validator(mode="after")
    def _one_trigger(self) -> Self:
        if sum(trigger is not None for trigger in (self.at_s, self.near, self.after)) != 1:
            raise ValueError("expected exactly one of at_s, near, after")
        return self


@dataclass(slots=True)
class Events:
    """Which events are due; each is given out once."""

    events: Sequence[WorldEvent]
    seed: int = 0
    _due_s: dict[str, float] = field(default_factory=dict)
    """When those happen whose time is known."""
    _done: set[str] = field(default_factory=set)
    _stood: dict[str, tuple[Pose2D, float]] = field(default_factory=dict)
    """By robot where it stands, and since when."""
    _soon: bool = False
    """Whether a robot only has to stand a while longer."""

    def __post_init__(self) -> None:
        """Draw the times that are known from the start."""
        for event in self.events:
            if event.at_s is not None:
                self._due_s[event.name] = self._drawn(event, event.at_s) + self._drawn(event, event.delay_s)

    @property
    def timed(self) -> bool:
        """Whether something happens as soon as enough time has passed."""
        return self._soon or any(name not in self._done for name in self._due_s)

    def due(
        self, now_s: float, robots: Mapping[str, Pose2D], place_of: Callable[[str], Pose2D | None]
    ) -> list[WorldEvent]:
        """What happens now, in the order in which it is written.

        Args:
            now_s: Robot time.
            robots: Where they are.
            place_of: Where a thing is; None: it is not there.
        """
        found: list[WorldEvent] = []
        self._soon = False
        for robot, pose in robots.items():
            if robot not in self._stood or pose.distance_to(self._stood[robot][0]) > _STILL_M:
                self._stood[robot] = (pose, now_s)
        for event in self.events:
            if event.name in self._done:
                continue
            if event.name not in self._due_s and self._is_met(event, now_s, robots, place_of):
                self._due_s[event.name] = now_s + self._drawn(event, event.delay_s)
            if self._due_s.get(event.name, math.inf) <= now_s + 1e-9:
                self._done.add(event.name)
                found.append(event)
        return found

    def _is_met(
        self,
        event: WorldEvent,
        now_s: float,
        robots: Mapping[str, Pose2D],
        place_of: Callable[[str], Pose2D | None],
    ) -> bool:
        if event.after is not None:
            return event.after in self._done
        place = place_of(event.near.thing) if event.near is not None else None
        if event.near is None or place is None:
            return False
        near = event.near
        there = [
            now_s - self._stood[name][1]
            for name, pose in robots.items()
            if near.robot in ("", name) and pose.distance_to(place) <= near.within_m
        ]
        met = any(stood_s >= near.stands_s for stood_s in there)
        self._soon = self._soon or (bool(there) and not met)
        return met

    def _drawn(self, event: WorldEvent, span: Span) -> float:
        """A time of a range, the same for the same seed."""
        if not isinstance(span, tuple):
            return span
        place = next(at for at, other in enumerate(self.events) if other is event)
        return float(np.random.default_rng([self.seed, place]).uniform(min(span), max(span)))
