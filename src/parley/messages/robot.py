"""What a robot's engine and those who plan for it tell each other, in whichever processes they are. Ours."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from parley.messages.base import Payload
from parley.messages.principal import Principal
from parley.messages.rules import RuleSet

__all__ = ["Floor", "GoesOn", "Notice", "RobotSite", "RulesInForce", "UnfinishedRun", "UnfinishedRuns"]

GoesOn = Literal["engine", "anew", "no"]


class Floor(Payload):
    """An occupancy map, cell by cell."""

    name: str
    resolution: float = Field(gt=0)
    """Metres, the side of a cell."""
    origin_x: float
    origin_y: float
    """Of the lower left corner of the first cell, in the map frame."""
    rows: int = Field(ge=1)
    columns: int = Field(ge=1)
    cells: str
    """Base64 of the packed cells (zlib), one signed byte each, the lowest row first."""


class RobotSite(Payload):
    """`/<actor>/parley_site`, latched: where a robot is and what it is like."""

    actor: str
    floor: Floor | None = None
    """What it drives by; None: it has no map."""
    objects: dict[str, Any] = Field(default_factory=dict)
    """What people may name, with what robots found; see `parley.world.telling`."""
    radius_m: float = 0.2
    max_speed_mps: float = 0.5


class RulesInForce(Payload):
    """`/parley/rules_in_force`, latched: by what engines and drives go."""

    rules: RuleSet
    accounts: dict[str, Principal | None] = Field(default_factory=dict)
    """Robot -> on whose account it acts."""


class UnfinishedRun(Payload):
    """A graph of a robot that is not over."""

    graph: str
    """As JSON, with the states its nodes have."""
    outputs: dict[str, dict[str, Any]] = Field(default_factory=dict)
    """What finished nodes gave: full name -> flat name -> value."""
    unix_ms: int = 0
    shared: bool = False
    """Whether other robots take part."""
    left: bool = False
    """Whether it is from before the engine was started; nothing of it goes on by itself."""
    goes_on: GoesOn = "engine"
    """`engine`: the engine has it; `anew`: what is left of it is to be planned anew; `no`: it cannot."""


class UnfinishedRuns(Payload):
    """Response of `/<actor>/parley_unfinished`."""

    runs: tuple[UnfinishedRun, ...] = ()
    """The oldest first."""


class Notice(Payload):
    """`/parley/notice`: something operators are to be told as soon as one is there."""

    message: str
    targets: tuple[str, ...] = ()
    type: Literal["info", "error"] = "info"
