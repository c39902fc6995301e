"""What can be shown to an operator, before it has any colour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Fragments", "Line", "LineKind"]

LineKind = Literal["said", "asked", "problem", "note", "step", "heading"]

Fragments = list[tuple[str, str]]
"""One row of styled text: (style, text) pairs as prompt_toolkit spells them."""


@dataclass(frozen=True, slots=True)
class Line:
    """One thing to show in the conversation."""

    kind: LineKind
    text: str
    speaker: str = ""
    """Who says it; empty for what the terminal itself notes."""
    choices: tuple[str, ...] = ()
    """Answers that are offered, numbered from 1."""
    footnote: str = ""
    """Small print behind it."""
