"""`/parley/incident`: the record of one failure, from the first sign to its end (ours)."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from parley.errors import FailureCode
from parley.messages.base import Payload
from parley.messages.chat import ActionCall
from parley.messages.plain import ShownText

__all__ = ["GetIncidents", "Incident", "IncidentAttempt", "IncidentList"]


class IncidentAttempt(Payload):
    """One try to get over a failure."""

    kind: Literal["alone", "asked"]
    """`alone`: with what was known; `asked`: with what the operator answered."""
    asked: str = ""
    """The question, for `asked`."""
    answered: str = ""
    """What the operator said then, word for word, whether or not it was an answer."""
    tried: str = ""
    """What was then tried, in words for the operator; empty if nothing was."""
    unix_ms: int = 0


class Incident(Payload):
    """What happened, what was tried, what the operator said, and how it ended; sent whole at each change."""

    id: str
    robot: str
    graph_name: str = ""
    step: ActionCall
    """The step that failed."""
    label: ShownText = ""
    """What people read of it in the plan: of a search, the step that it is made for; empty: not known."""
    code: FailureCode = FailureCode.INTERNAL
    message: str = ""
    """What went wrong, in plain words."""
    attempts: tuple[IncidentAttempt, ...] = ()
    """Oldest first; of very many the first and the newest."""
    questions: int = 0
    """How often the operator was asked, repetitions after their own questions included."""
    ending: Literal["open", "solved", "skipped", "cancelled", "replaced", "held"] = "open"
    """`held`: the last attempt failed, the robot waits; `replaced`: the operator ordered something else."""
    opened_unix_ms: int = 0
    closed_unix_ms: int = 0
    """0 while it is open."""
    note: str = ""
    """What else is to be said about its end, e.g. that the program was ended before."""


class GetIncidents(Payload):
    """Request of `/parley/get_incidents`."""

    robot: str = ""
    """Only those of this robot; empty: of all."""
    limit: int = Field(default=100, ge=1, le=1000)


class IncidentList(Payload):
    """Response of `/parley/get_incidents`."""

    incidents: tuple[Incident, ...] = ()
    """Newest first."""
