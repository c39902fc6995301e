"""Text as it may leave the process."""

from __future__ import annotations

__all__ = ["clean_text"]


def clean_text(text: str) -> str:
    """The text without halves of surrogate pairs, which UTF-8 and with it JSON cannot carry."""
    return text if text.isascii() else text.encode("utf-8", "replace").decode("utf-8")
