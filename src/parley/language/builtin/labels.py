"""The tags of the tagger's heads, in the order of their numbers; training and running share them."""

from __future__ import annotations

from parley.language.builtin.markup import ACTS, FRAMES, MODES, MOVES, ROLES

__all__ = ["ACT_TAGS", "DESCRIBED", "FRAME_TAGS", "HEADS", "MODE_TAGS", "MOVE_TAGS", "OTHER", "ROLE_TAGS"]

OTHER = "OTHER"
ACT_TAGS: tuple[str, ...] = ACTS
FRAME_TAGS: tuple[str, ...] = ("O", *(f"{mark}-{frame}" for frame in FRAMES for mark in "BI"), "+")
ROLE_TAGS: tuple[str, ...] = ("O", *(f"{mark}-{role}" for role in ROLES for mark in "BI"))
MODE_TAGS: tuple[str, ...] = MODES
MOVE_TAGS: tuple[str, ...] = MOVES
DESCRIBED: tuple[str, ...] = (OTHER, *FRAMES, "MOVE", "FACE", "LOCATE")
"""What an action may be: a frame, what GO and TURN are with other roles, or finding where a place is."""

HEADS: dict[str, int] = {
    "act": len(ACT_TAGS),
    "frame": len(FRAME_TAGS),
    "role": len(ROLE_TAGS),
    "head": 2,
    "mode": len(MODE_TAGS),
    "move": len(MOVE_TAGS),
}
"""Heads over words, and how many tags each has; besides there are the arcs and what a sentence describes."""
