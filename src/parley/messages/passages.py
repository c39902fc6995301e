"""Places that only so many robots may be in at once: who is in, who waits (`/parley/passages`). Ours."""

from __future__ import annotations

from typing import Final

from pydantic import Field

from parley.messages.base import Payload

__all__ = ["TAKEN", "PassageClaim", "PassageList", "PassageState"]

TAKEN: Final = "taken"
"""Among the details of a failure: the place for which a robot has waited in vain."""


class PassageClaim(Payload):
    """What one robot wants of such places, and where it is; told with its heartbeat."""

    id: str = ""
    """Of what it wants now: another one is another wish; empty: it wants nothing."""
    wants: tuple[str, ...] = ()
    """The places that it is to have all at once before it goes on."""
    held: bool = False
    """Whether it was given them, as far as it knows."""
    inside: tuple[str, ...] = ()
    """The places that it stands in, whoever gave them to it."""
    capacity: dict[str, int] = Field(default_factory=dict)
    """Of each place that it names: for how many there is room."""
    without: tuple[str, ...] = ()
    """Robots that do not answer, and of which a person said that they are out of the way."""


class PassageState(Payload):
    """Who is in a place, or may go there now."""

    name: str
    robots: tuple[str, ...] = ()
    lost: tuple[str, ...] = ()
    """Those of them that do not answer any more: they may still be there."""
    waiting: tuple[str, ...] = ()
    """In their turn."""


class PassageList(Payload):
    """`/parley/passages`: all such places that a robot is in or wants."""

    places: tuple[PassageState, ...] = ()
    granted: dict[str, str] = Field(default_factory=dict)
    """Robot -> `id` of its claim that was granted."""
    stuck: tuple[str, ...] = ()
    """Robots that wait in a circle and have to give way."""
