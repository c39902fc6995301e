"""What goes over the websocket: JSON objects with an `op` (rosbridge v2), read once, here."""

from __future__ import annotations

import json
import math
from collections import OrderedDict
from typing import Any, Final

from parley.errors import InvalidMessageError
from parley.messages.wire import load_json

__all__ = ["MAX_BYTES", "Assembly", "Frame", "read_frame", "text_of", "write_frame"]

MAX_BYTES: Final = 64 * 1024 * 1024
"""Longer frames end the connection."""
_FRAGMENTED: Final = 4
"""So many messages may be on their way in pieces; of more the oldest are given up."""
_PIECES: Final = 10_000

Frame = dict[str, Any]


def write_frame(frame: Frame) -> str:
    """The text of a frame."""
    return json.dumps(frame, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def read_frame(text: str | bytes) -> Frame:
    """The frame in a text.

    Raises:
        InvalidMessageError: It is none; says why.
    """
    if isinstance(text, bytes):
        raise InvalidMessageError(
            "rosbridge frame", "", "bytes came; is the bridge in BSON mode? It must speak JSON"
        )
    frame = load_json("rosbridge frame", text)
    if not isinstance(frame, dict):
        raise InvalidMessageError("rosbridge frame", "", "it is no object")
    text_of(frame, "op")
    return frame


def text_of(frame: Frame, key: str) -> str:
    """A text that a frame must have.

    Raises:
        InvalidMessageError: It has none.
    """
    value = frame.get(key)
    if not isinstance(value, str):
        what = f"rosbridge {frame['op']}" if isinstance(frame.get("op"), str) else "rosbridge frame"
        raise InvalidMessageError(what, key, "a text is expected here")
    return value


class Assembly:
    """Puts together what came in pieces: a bridge cuts what is longer than its `max_message_size`."""

    def __init__(self) -> None:
        self._pieces: OrderedDict[str, dict[int, str]] = OrderedDict()

    def add(self, frame: Frame) -> str | None:
        """A piece came; the whole text if it was the last.

        Raises:
            InvalidMessageError: It is no piece.
        """
        id_, data = str(frame.get("id")), text_of(frame, "data")
        number, total = frame.get("num"), frame.get("total")
        if isinstance(total, float) and math.isfinite(total):  # rosbridge 2.0 divides and does not round
            total = int(total)
        if not isinstance(number, int) or not isinstance(total, int) or not 0 <= number < total <= _PIECES:
            raise InvalidMessageError("rosbridge fragment", "num", f"{number!r} of {total!r} cannot be")
        pieces = self._pieces.setdefault(id_, {})
        pieces[number] = data
        if len(pieces) == total:
            del self._pieces[id_]
            return "".join(pieces[index] for index in range(total))
        if len(self._pieces) > _FRAGMENTED or sum(map(len, pieces.values())) > MAX_BYTES:
            self._pieces.popitem(last=False)
        return None
