"""Missions: one order to several robots, seen as one (`/parley/missions`)."""

from __future__ import annotations

from typing import Final, Literal

from parley.messages.base import Payload
from parley.messages.chat import ActionCall
from parley.messages.plain import LineText, ShownText
from parley.messages.principal import Principal

__all__ = ["OVER", "WAITS_FOR", "MissionInfo", "MissionList", "MissionPart", "PartState"]

WAITS_FOR: Final = "WaitForRobot"
"""The action by which a robot begins when another one has done its part."""

PartState = Literal[
    "asked", "queued", "waiting", "running", "paused", "held", "away", "interrupted",
    "done", "undone", "refused", "given",
]  # fmt: skip
"""`asked`: it waits for a yes; `queued`: its robot does something else first; `waiting`: for other robots;
`held`: a step failed, and a person is asked; `away`: its robot is not there; `interrupted`: what became of it
is not known, as it was followed by a process that has ended; `undone`: it ended, and not all of it was done;
`given`: another robot does it."""

OVER: Final[frozenset[PartState]] = frozenset({"done", "undone", "refused", "given"})
"""Nothing will become of a part in these states by itself."""


class MissionPart(Payload):
    """What one robot does of a mission."""

    robot: str
    order: str
    """`id` of the order that its steps carry out."""
    state: PartState = "queued"
    lines: tuple[LineText, ...] = ()
    """What it does, as people read it."""
    why: LineText = ""
    """Why it is this robot; may be empty."""
    after: tuple[str, ...] = ()
    """Robots whose parts have to be done before."""
    label: LineText = ""
    """The step that is being done, or at which it got stuck."""
    done: int = 0
    """How many steps are done, of `count`."""
    count: int = 0
    left: tuple[LineText, ...] = ()
    """Of a part that is over: what was not done."""
    proposal: str = ""
    """`id` of the proposal that waits for a yes."""
    steps: tuple[ActionCall, ...] = ()
    """What it does, as it was ordered; an edit before the yes changes it."""
    instead_of: str = ""
    """The robot from which it takes over what that had left."""


class MissionInfo(Payload):
    """One order to several robots, and what has become of each part."""

    id: str
    words: str
    """What was said."""
    by: Principal | None = None
    reply_to: str = ""
    """`id` of the message."""
    parts: tuple[MissionPart, ...] = ()
    closing: ShownText = ""
    """How it ended, in a sentence; empty: it has not."""


class MissionList(Payload):
    """`/parley/missions`: the missions that go on, and the last that ended; oldest first."""

    missions: tuple[MissionInfo, ...] = ()
