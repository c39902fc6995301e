"""Rules about what robots may do, as `rules.yaml` and the topics carry them; and the classes of risk."""

from __future__ import annotations

import math
import re
from enum import StrEnum
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, field_validator, model_validator

from parley.messages.principal import Role

__all__ = [
    "DAYS",
    "SCHEMA",
    "ZONE_KINDS",
    "Day",
    "Hours",
    "Point",
    "RiskClass",
    "Rule",
    "RuleKind",
    "RuleSet",
]  # fmt: skip

SCHEMA: Literal[1] = 1
"""Version of the form of `rules.yaml`."""

Day = Literal["mon", "tue", "wed", "thu", "fri", "sat", "sun"]
DAYS: tuple[Day, ...] = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")

RuleKind = Literal["keep_out", "slow", "ask_zone", "speed", "action", "plan"]
ZONE_KINDS: frozenset[RuleKind] = frozenset({"keep_out", "slow", "ask_zone"})
"""Kinds that are drawn on a map."""

Point = tuple[float, float]
"""x, y in the map frame, metres."""

MAX_POINTS = 200
_LARGEST_M = 1e5


class RiskClass(StrEnum):
    """What an action can do to the world, from what it declares; nothing is harmless by default."""

    LOOKS = "looks_and_speaks"
    MOVES = "moves"
    HANDLES = "handles_things"
    FINAL = "cannot_be_undone"
    UNKNOWN = "unknown"
    """It declares nothing, or something that nobody here knows."""


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True, allow_inf_nan=False)


def _clock_time(value: Any) -> Any:
    """``14:30`` as YAML gives it: the text, or, unquoted, the number of minutes (it counts in sixties)."""
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 1440:
        return f"{value // 60:02d}:{value % 60:02d}"
    found = re.fullmatch(r"(\d{1,2}):(\d{2})", value.strip()) if isinstance(value, str) else None
    if found is None or int(found[2]) > 59 or int(found[1]) * 60 + int(found[2]) > 1440:
        raise ValueError("must be a time of day such as 14:30")
    return f"{int(found[1]):02d}:{found[2]}"


ClockTime = Annotated[str, BeforeValidator(_clock_time)]


class Hours(_Part):
    """When a rule holds, by the clock on the wall; what is left out is always."""

    days: tuple[Day, ...] = ()
    start: ClockTime | None = Field(default=None, alias="from")
    end: ClockTime | None = Field(default=None, alias="to")
    """Before `start`: on the next day; those hours belong to the day on which they began."""

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if (self.start is None) != (self.end is None):
            raise ValueError("says only one of from and to: give both, or leave out both")
        if self.start is None and not self.days:
            raise ValueError("says no hours: give from and to, or days, or leave it out")
        return self


class Rule(_Part):
    """One rule; which fields it needs depends on its kind."""

    id: str = Field(pattern=r"^[a-z0-9][a-z0-9_-]{0,63}$")
    kind: RuleKind
    """`keep_out`: no robot goes in there; `slow`: not faster than `max_speed_mps` in there; `ask_zone`: plans
    that lead through there wait for a yes; `speed`: not faster anywhere; `action`: actions that are forbidden
    or asked about; `plan`: how far, how long and how many steps."""
    name: str = Field(default="", max_length=120)
    """Of the zone, in people's words."""
    map: str = Field(default="", max_length=200)
    """Of a zone: the map it is on; empty: every map."""
    rectangle: tuple[float, float, float, float] | None = None
    """x and y of one corner, x and y of the other."""
    polygon: tuple[Point, ...] | None = None
    max_speed_mps: float | None = Field(default=None, gt=0, le=20)
    actions: tuple[str, ...] = ()
    """Of `action`: these; with neither these nor `classes`: all."""
    classes: tuple[RiskClass, ...] = ()
    """Of `action`: all actions of these classes."""
    verdict: Literal["forbid", "ask"] = "forbid"
    """Of `action` and `plan`: what becomes of it."""
    max_distance_m: float | None = Field(default=None, gt=0)
    max_steps: int | None = Field(default=None, ge=1)
    max_expected_s: float | None = Field(default=None, gt=0)
    robots: tuple[str, ...] = ()
    """For which robots it holds; empty: all."""
    exempt: tuple[Role, ...] = ()
    """Plans on the account of people with these roles are left alone by it."""
    when: Hours | None = None
    words: str = Field(default="", max_length=500)
    """What a person said, if it was told."""
    by: str = Field(default="", max_length=120)
    """Who made it."""

    @field_validator("rectangle")
    @classmethod
    def _has_size(
        cls, value: tuple[float, float, float, float] | None
    ) -> tuple[float, float, float, float] | None:
        if value is None:
            return None
        x1, y1, x2, y2 = value
        if max(map(abs, value)) > _LARGEST_M:
            raise ValueError("lies too far away: coordinates are metres on the map")
        if x1 == x2 or y1 == y2:
            raise ValueError("has no size: its two corners must differ in x and in y")
        return min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2)

    @field_validator("polygon")
    @classmethod
    def _is_an_area(cls, value: tuple[Point, ...] | None) -> tuple[Point, ...] | None:
        if value is None:
            return None
        if not 3 <= len(value) <= MAX_POINTS:
            raise ValueError(f"must have 3 to {MAX_POINTS} corners, not {len(value)}")
        if max(abs(number) for point in value for number in point) > _LARGEST_M:
            raise ValueError("lies too far away: coordinates are metres on the map")
        if _crosses_itself(value):
            raise ValueError("crosses itself: give its corners in order, one round")
        if abs(_area(value)) < 1e-6:
            raise ValueError("has no size: its corners lie in one line")
        return value

    @model_validator(mode="after")
    def _fits_its_kind(self) -> Self:
        zone = self.kind in ZONE_KINDS
        if zone and (self.rectangle is None) == (self.polygon is None):
            raise ValueError(f"{self.kind} needs either rectangle or polygon")
        needs_speed = self.kind in ("slow", "speed")
        if needs_speed and self.max_speed_mps is None:
            raise ValueError(f"{self.kind} needs max_speed_mps")
        given = {
            name for name, field in type(self).model_fields.items() if getattr(self, name) != field.default
        }
        limits = {"max_distance_m", "max_steps", "max_expected_s"}
        if self.kind == "plan" and not given & limits:
            raise ValueError("plan needs one of max_distance_m, max_steps, max_expected_s")
        allowed = {
            "max_speed_mps": needs_speed,
            **dict.fromkeys(("rectangle", "polygon", "map"), zone),
            **dict.fromkeys(("actions", "classes"), self.kind == "action"),
            **dict.fromkeys(limits, self.kind == "plan"),
            "verdict": self.kind in ("action", "plan"),
        }
        if foreign := sorted(name for name in given if not allowed.get(name, True)):
            raise ValueError(f"{', '.join(foreign)}: means nothing for {self.kind}")
        return self

    @property
    def corners(self) -> tuple[Point, ...]:
        """Of a zone, in order; empty for other kinds."""
        if self.rectangle is not None:
            x1, y1, x2, y2 = self.rectangle
            return ((x1, y1), (x2, y1), (x2, y2), (x1, y2))
        return self.polygon or ()


class RuleSet(_Part):
    """All of `rules.yaml`."""

    schema_version: Literal[1] = Field(default=SCHEMA, alias="schema")
    timezone: str = Field(default="", max_length=60)
    """By which clocks hours are meant, e.g. ``Europe/Tallinn``; empty: that of the machine."""
    unusual_distance_m: float = Field(default=30.0, gt=0)
    """Longer plans are unusual: `ask_when_risky` asks about them."""
    rules: tuple[Rule, ...] = ()

    @field_validator("rules")
    @classmethod
    def _ids_differ(cls, value: tuple[Rule, ...]) -> tuple[Rule, ...]:
        seen: set[str] = set()
        for rule in value:
            if rule.id in seen:
                raise ValueError(f"two rules have the id {rule.id!r}")
            seen.add(rule.id)
        return value

    def get(self, rule_id: str) -> Rule | None:
        """The rule of that id."""
        return next((rule for rule in self.rules if rule.id == rule_id), None)


def _area(corners: tuple[Point, ...]) -> float:
    return 0.5 * math.fsum(
        x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(corners, (*corners[1:], corners[0]), strict=True)
    )


def _crosses_itself(corners: tuple[Point, ...]) -> bool:
    """Whether two edges that are no neighbours cross."""
    sides = list(zip(corners, (*corners[1:], corners[0]), strict=True))
    return any(
        _cross(*sides[i], *sides[j])
        for i in range(len(sides))
        for j in range(i + 2, len(sides))
        if not (i == 0 and j == len(sides) - 1)
    )


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    def side(p: Point, q: Point, r: Point) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0
