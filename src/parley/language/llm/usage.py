"""What exchanges with models took: tokens, money, time."""

from __future__ import annotations

from collections import deque
from dataclasses import asdict, dataclass
from typing import Any, Literal

import structlog

__all__ = ["Exchange", "Usage"]

log = structlog.get_logger(__name__)

KEPT = 1000


@dataclass(frozen=True, slots=True)
class Exchange:
    """One question to a model, with every request it took."""

    kind: str
    model: str
    prompt_version: str
    outcome: Literal["answered", "failed"]
    requests: int
    input_tokens: int
    output_tokens: int
    cost_usd: float | None
    """None if no price is known for the model."""
    latency_s: float
    """Wall time from the question to the checked answer."""
    error: str = ""


class Usage:
    """Adds up exchanges, and keeps the newest of them."""

    def __init__(self) -> None:
        self.exchanges: deque[Exchange] = deque(maxlen=KEPT)
        """Newest last."""
        self.asked = 0
        self.failed = 0
        self.input_tokens = 0
        self.output_tokens = 0
        self.cost_usd = 0.0
        """Of the exchanges whose price is known."""

    def note(self, exchange: Exchange) -> None:
        """Take an exchange into account, and log it."""
        self.exchanges.append(exchange)
        self.asked += 1
        self.failed += exchange.outcome == "failed"
        self.input_tokens += exchange.input_tokens
        self.output_tokens += exchange.output_tokens
        self.cost_usd += exchange.cost_usd or 0.0
        log.info("model asked", **asdict(exchange))

    def totals(self) -> dict[str, Any]:
        """The sums, for reports."""
        return {
            "asked": self.asked,
            "failed": self.failed,
            "input_tokens": self.input_tokens,
            "output_tokens": self.output_tokens,
            "cost_usd": round(self.cost_usd, 6),
        }
