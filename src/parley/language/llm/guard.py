"""What keeps a model that fails, or costs too much, from being asked: breaker and budget. Plain objects."""

from __future__ import annotations

from collections import deque

from parley.clock import Clock
from parley.errors import LanguageError

__all__ = ["Breaker", "Budget"]

HOUR_S = 3600.0


class Breaker:
    """Opens after so many failures in a row; after a while lets one question through to see (half open).

    Args:
        clock: Its `now_s` counts.
        failures: In a row, until it opens.
        open_s: How long it stays open.
    """

    def __init__(self, clock: Clock, *, failures: int, open_s: float) -> None:
        self._clock, self._failures, self._open_s = clock, failures, open_s
        self._in_a_row = 0
        self._opened_s: float | None = None
        self._probing = False

    @property
    def state(self) -> str:
        """`closed`, `open` or `half_open`."""
        if self._opened_s is None:
            return "closed"
        return "half_open" if self._clock.now_s() - self._opened_s >= self._open_s else "open"

    def admit(self) -> None:
        """Let a question through; each that is let through is followed by `succeeded`, `failed` or `left`.

        Raises:
            LanguageError: It is open, or half open with a probe under way.
        """
        if self.state == "open" or (self.state == "half_open" and self._probing):
            raise LanguageError(
                "the model failed too often and is not asked for a while",
                plain="My language service does not answer at the moment.",
            )
        self._probing = self.state == "half_open"

    def succeeded(self) -> None:
        """The model answered."""
        self._in_a_row, self._opened_s, self._probing = 0, None, False

    def failed(self) -> None:
        """The model could not be reached or did not answer."""
        self._in_a_row += 1
        if self._probing or self._in_a_row >= self._failures:
            self._opened_s = self._clock.now_s()
        self._probing = False

    def left(self) -> None:
        """Whoever asked does not want the answer any more: that says nothing about the model."""
        self._probing = False


class Budget:
    """Tokens and money of the last hour.

    Args:
        clock: Its `now_s` counts.
        max_tokens: In any hour; None: no limit.
        max_usd: In any hour; None: no limit.
    """

    def __init__(self, clock: Clock, *, max_tokens: int | None = None, max_usd: float | None = None) -> None:
        self._clock, self._max_tokens, self._max_usd = clock, max_tokens, max_usd
        self._spent: deque[tuple[float, int, float]] = deque()
        self._tokens, self._usd = 0, 0.0

    def spend(self, tokens: int, usd: float) -> None:
        """Note what an exchange took."""
        self._spent.append((self._clock.now_s(), tokens, usd))
        self._tokens += tokens
        self._usd += usd

    def admit(self) -> None:
        """Check that there is something left.

        Raises:
            LanguageError: The last hour used it up.
        """
        limit_s = self._clock.now_s() - HOUR_S
        while self._spent and self._spent[0][0] <= limit_s:
            _, tokens, usd = self._spent.popleft()
            self._tokens -= tokens
            self._usd -= usd
        over_tokens = self._max_tokens is not None and self._tokens >= self._max_tokens
        over_usd = self._max_usd is not None and self._usd >= self._max_usd
        if over_tokens or over_usd:
            raise LanguageError(
                f"the hour's limit is used up: {self._tokens} tokens, {self._usd:.4f} USD",
                plain="My language service has used up what it may cost in an hour.",
            )
