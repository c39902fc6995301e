"""Who looks after robots, and what they do when nobody does."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from parley.messages.base import Payload

__all__ = ["Attendance", "Unattended"]

Unattended = Literal["go_on", "hold", "go_home"]
"""What a robot does with its plan when nobody is connected for a while."""


class Attendance(Payload):
    """`/parley/attendance`: how many people are connected through one server; told anew every few seconds."""

    server: str
    """Names the server, for as long as it runs."""
    people: int = Field(ge=0)
