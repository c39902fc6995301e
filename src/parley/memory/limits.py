"""How many memories are looked at together."""

from __future__ import annotations

from typing import Final

__all__ = ["MOST_MEMORIES"]

MOST_MEMORIES: Final = 50
"""Shown at most for one message, to a language engine as to a person who asks for all."""
