"""The reply inside an answer that is still being written. Pure."""

from __future__ import annotations

from typing import Any

from pydantic_core import from_json

__all__ = ["DraftReader"]

_KEY = "message_response"


class DraftReader:
    """Takes the pieces of an answer, gives the reply as far as it is there."""

    def __init__(self) -> None:
        self._text = ""
        self._reply = ""
        self._complete = False

    def restart(self, text: str = "") -> None:
        """The answer begins anew with `text`."""
        self._text, self._reply, self._complete = text, "", False

    def feed(self, piece: str) -> str | None:
        """Take a piece; the reply so far if it grew, else None."""
        self._text += piece
        if self._complete:
            return None
        start = self._text.find("{")
        if start < 0:
            return None
        try:
            value: Any = from_json(self._text[start:], allow_partial="trailing-strings")
        except ValueError:
            return None
        if not isinstance(value, dict) or not isinstance(value.get(_KEY), str):
            return None
        keys = list(value)
        self._complete = keys[-1] != _KEY
        reply: str = value[_KEY]
        if len(reply) <= len(self._reply):
            return None
        self._reply = reply
        return reply
