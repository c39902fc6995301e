"""What has been said with one robot, capped; pure."""

from __future__ import annotations

from collections import deque

from parley.language.base import Turn

__all__ = ["Conversation"]


class Conversation:
    """The last exchanges with one robot.

    Args:
        exchanges: How many pairs of operator and assistant turns are kept (thesis: a capped record).
    """

    def __init__(self, exchanges: int = 10) -> None:
        self._turns: deque[Turn] = deque(maxlen=2 * exchanges)

    def operator(self, text: str) -> None:
        """The operator said this."""
        self._turns.append(Turn("operator", text))

    def assistant(self, text: str) -> None:
        """The robot said this; failures of ours are not part of a conversation and never come here."""
        self._turns.append(Turn("assistant", text))

    @property
    def turns(self) -> tuple[Turn, ...]:
        """Oldest first."""
        return tuple(self._turns)
