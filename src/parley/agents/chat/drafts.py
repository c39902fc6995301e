"""A reply while it is being written, for clients that show it at once (`/parley/reply_draft`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from parley.clock import Clock
from parley.messages.chat import ReplyDraft

__all__ = ["MIN_INTERVAL_S", "Drafts"]

MIN_INTERVAL_S: Final = 0.1
"""Wall time between two drafts of one reply: each is sent whole, and nobody reads faster."""


class Drafts:
    """Hands on what is written of one reply, not too often; whoever asked without an id gets none.

    Args:
        reply_to: `id` of the operator's message.
        target: The robot that answers.
        publish: Where drafts go.
        clock: Its wall time spaces them.
    """

    def __init__(
        self, reply_to: str, target: str, publish: Callable[[ReplyDraft], None], clock: Clock
    ) -> None:
        self._reply_to, self._target = reply_to, target
        self._publish, self._clock = publish, clock
        self._next_s = 0.0

    def __call__(self, text: str) -> None:
        """Take the reply so far."""
        now_s = self._clock.wall_s()
        if not self._reply_to or not text or now_s < self._next_s:
            return
        self._next_s = now_s + MIN_INTERVAL_S
        self._publish(ReplyDraft(reply_to=self._reply_to, targets=(self._target,), message=text))
