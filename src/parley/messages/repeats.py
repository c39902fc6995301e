"""Messages that come again and again by themselves, as `ros2 topic pub` sends what it was given. Pure."""

from __future__ import annotations

from typing import Final

from parley.latest import Latest
from parley.messages.chat import ChatInput

__all__ = ["Repeats"]

WITHIN_S: Final = 2.5
"""What comes so soon after the same is no new message: programs repeat once a second, people take longer."""


class Repeats:
    """Recognises a message without an id by what it says; with one it is recognised by that."""

    def __init__(self) -> None:
        self._heard: Latest[ChatInput, tuple[float, int]] = Latest()

    def count(self, said: ChatInput, now_s: float) -> int:
        """How often the same was said before this, each time soon after the last; 0: it is new."""
        if said.id:
            return 0
        last_s, count = self._heard.get(said, (now_s - 2 * WITHIN_S, -1))
        count = count + 1 if now_s - last_s < WITHIN_S else 0
        self._heard[said] = (now_s, count)
        return count
