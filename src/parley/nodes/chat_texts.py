"""What the chat interface says of its own accord, in plain words."""

from __future__ import annotations

from typing import Final

from parley.language.control import Control

__all__ = [
    "AFTERWARDS",
    "CONTROL_REPLIES",
    "MAX_CHARS",
    "NOTHING_TO_DO",
    "left",
    "settled",
    "still_thinking",
    "unreadable",
]

MAX_CHARS: Final = 10_000
"""A longer message is not a request that a person wrote."""
_QUOTED_CHARS: Final = 200
AFTERWARDS: Final = "I will do that afterwards; first I need your answer to my question."
"""Added to the reply to an order that has to wait until a failed step is settled."""

CONTROL_REPLIES: Final[dict[Control, str]] = {
    "stop": "I have stopped. Say “carry on” when I should go on.",
    "start": "I am going on.",
    "skip": "I will leave that step out.",
    "clear": "I have dropped everything.",
    "emergency_stop": "Emergency stop! I will not move until the stop is released.",
}
NOTHING_TO_DO: Final[dict[Control, str]] = {
    "stop": "I am standing still.",
    "start": "There is nothing left to go on with.",
    "skip": "There is no step to skip.",
    "clear": "There was nothing to drop.",
}


def still_thinking(message: str) -> str:
    """While an answer takes long."""
    return f"I am still thinking about “{_short(message)}”. If I should leave it, say “stop”."


def left(message: str) -> str:
    """About what was asked for before the robot was stopped."""
    return f"You told me to stop, so I leave this: “{_short(message)}”"


def settled(message: str) -> str:
    """About an answer that comes too late."""
    return f"My question is settled already, so I leave this: “{_short(message)}”"


def unreadable(message: str, *, bare: bool = False) -> str:
    """Why a message cannot be a request, in plain words; empty if it can."""
    if not message.strip() and not bare:
        return "I did not get any words. Please write what I should do."
    if len(message) > MAX_CHARS:
        return f"That message is too long for me ({len(message)} characters). Please use fewer words."
    return ""


def _short(message: str) -> str:
    return message if len(message) <= _QUOTED_CHARS else f"{message[:_QUOTED_CHARS]} …"
