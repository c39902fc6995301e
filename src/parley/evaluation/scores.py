"""Figures of outcomes: shares with their intervals, latency, what models took."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict

from parley.evaluation.running import Outcome

__all__ = ["BackendScore", "Share", "score", "share", "wilson"]

_Z_95 = 1.959964


def wilson(right: int, count: int) -> tuple[float, float]:
    """The 95 % Wilson interval of a proportion; (0, 1) if nothing was counted."""
    if not count:
        return 0.0, 1.0
    part, z2 = right / count, _Z_95 * _Z_95
    middle = part + z2 / (2 * count)
    spread = _Z_95 * math.sqrt(part * (1 - part) / count + z2 / (4 * count * count))
    scale = 1 + z2 / count
    return max(0.0, (middle - spread) / scale), min(1.0, (middle + spread) / scale)


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True)


class Share(_Frozen):
    """So many of so many."""

    right: int
    count: int
    low: float
    """Ends of the 95 % interval."""
    high: float

    @property
    def value(self) -> float | None:
        """The proportion; None if nothing was counted."""
        return self.right / self.count if self.count else None


def share(flags: Iterable[bool]) -> Share:
    """How many are true."""
    listed = list(flags)
    low, high = wilson(sum(listed), len(listed))
    return Share(right=sum(listed), count=len(listed), low=low, high=high)


class EngineScore(_Frozen):
    """What one of several engines answered of a set."""

    answered: Share
    """Of all cases."""
    right: Share
    """Of those it answered; so is what follows."""
    wrong_deeds: Share


class BackendScore(_Frozen):
    """The figures of one engine on one set."""

    language: str
    accuracy: Share
    wrong_deeds: Share
    """Something is done, and it is not what was wanted."""
    engines: dict[str, EngineScore]
    """By who answered, where there are several."""
    executable: Share
    """Of the plans that were made, those that a robot could carry out as they are."""
    parts: dict[str, Share]
    """By file."""
    phenomena: dict[str, Share]
    """By `part: phenomenon`."""
    p50_ms: float | None
    p99_ms: float | None
    usage: dict[str, Any] | None
    """Tokens and money, where a model was asked."""


def score(language: str, outcomes: Sequence[Outcome], usage: dict[str, Any] | None = None) -> BackendScore:
    """The figures of an engine.

    Args:
        language: Its name.
        outcomes: What came of the cases.
        usage: What it took, see `parley.language.llm.usage.Usage.totals`.
    """
    taken_ms = [1000 * outcome.latency_s for outcome in outcomes]
    return BackendScore(
        language=language,
        accuracy=share(outcome.right for outcome in outcomes),
        wrong_deeds=share(outcome.is_wrong_deed for outcome in outcomes),
        engines={
            name: EngineScore(
                answered=share(outcome.engine == name for outcome in outcomes),
                right=share(outcome.right for outcome in outcomes if outcome.engine == name),
                wrong_deeds=share(outcome.is_wrong_deed for outcome in outcomes if outcome.engine == name),
            )
            for name in sorted({outcome.engine for outcome in outcomes if outcome.engine})
        },
        executable=share(o.executable for o in outcomes if o.executable is not None),
        parts=_grouped(outcomes, lambda o: o.case.part),
        phenomena=_grouped(outcomes, lambda o: f"{o.case.part}: {o.case.phenomenon}"),
        p50_ms=float(np.percentile(taken_ms, 50)) if taken_ms else None,
        p99_ms=float(np.percentile(taken_ms, 99)) if taken_ms else None,
        usage=usage,
    )


def _grouped(outcomes: Sequence[Outcome], key: Callable[[Outcome], str]) -> dict[str, Share]:
    groups: dict[str, list[bool]] = {}
    for outcome in outcomes:
        groups.setdefault(key(outcome), []).append(outcome.right)
    return {name: share(flags) for name, flags in groups.items()}
