"""Acts, frames, roles: the tags of the tagger's heads, in the order of their numbers."""

from __future__ import annotations

from typing import Literal, get_args

__all__ = [
    "ACTS", "DESCRIBED", "FRAMES", "FRAME_TAGS", "HEADS", "MODES", "MOVES", "OTHER", "ROLES", "ROLE_TAGS",
    "Act", "Mode", "Move", "Role",
]  # fmt: skip

Act = Literal["order", "question", "told", "need", "control", "answer", "social", "edit", "alarm"]
ACTS: tuple[Act, ...] = get_args(Act)
"""What a clause does in the conversation."""

Move = Literal["none", "yes", "no", "stop", "pause", "resume", "cancel", "again"]
MOVES: tuple[Move, ...] = get_args(Move)
"""Which answer, which control, or the same order once more."""

Mode = Literal["plain", "negated", "otherwise", "later", "earlier", "allowed"]
MODES: tuple[Mode, ...] = get_args(Mode)
"""How a deed is meant: as it is, forbidden, if a condition fails, behind or before another, let again."""

Role = Literal[
    "T", "G", "S", "L", "R", "H", "N", "D", "K", "X", "C", "U", "W", "M", "A", "Y", "E", "P", "I", "O"
]
ROLES: tuple[Role, ...] = get_args(Role)
"""What a span is to its frame."""

FRAMES: tuple[str, ...] = (
    "GO", "TURN", "BRING", "TAKE", "PUT", "GIVE", "FIND", "LOOK", "FOLLOW", "GUIDE", "ON", "OFF", "OPEN",
    "CLOSE", "CONNECT", "DISC", "SAY", "ASK", "WAIT", "PHOTO", "COUNT", "CLEAN", "POUR", "CUT", "MIX",
    "COOK", "MAKE", "ANSWER", "CHARGE", "PUSH", "DO", "BELOC", "BECAT", "REMEMBER", "FORGET",
)  # fmt: skip
"""What may be wanted of somebody, and what may be told."""

OTHER = "OTHER"
FRAME_TAGS: tuple[str, ...] = ("O", *(f"{mark}-{frame}" for frame in FRAMES for mark in "BI"), "+")
ROLE_TAGS: tuple[str, ...] = ("O", *(f"{mark}-{role}" for role in ROLES for mark in "BI"))
DESCRIBED: tuple[str, ...] = (OTHER, *FRAMES, "MOVE", "FACE", "LOCATE")
"""What an action may be: a frame, what GO and TURN are with other roles, or finding where a place is."""

HEADS: dict[str, int] = {
    "act": len(ACTS), "frame": len(FRAME_TAGS), "role": len(ROLE_TAGS), "head": 2, "mode": len(MODES),
    "move": len(MOVES),
}  # fmt: skip
"""Heads over words, and how many tags each has; besides there are the arcs and what a sentence describes."""
