"""The figures of `parley bench web` beside what they may be."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from parley.bench.engine import share
from parley.bench.web import WebFigures

__all__ = ["report"]

SOCKET_BUDGET_MS: Final = 50.0
"""From a picture's taking until the network has it, for 95 of 100."""
PAINTED_BUDGET_MS: Final = 150.0
"""The same until a browser has painted it."""
INTERACTIVE_BUDGET_MS: Final = 1500.0
"""From opening the page until one can write."""


def report(figures: WebFigures) -> Iterator[dict[str, Any]]:
    """One object per figure; those with a budget say whether they keep it, and are null without a browser."""
    yield {"case": "load", **figures.facts()}
    written = figures.stage_ms["written"] if figures.feeds else ()
    yield {"case": "camera_to_socket", **_latency(written, SOCKET_BUDGET_MS, "no feeds")}
    seen, why = figures.browser, figures.no_browser or "no feeds"
    yield {
        "case": "camera_to_browser_socket",
        **_latency(seen.socket_ms if seen else (), SOCKET_BUDGET_MS, why),
    }
    yield {
        "case": "camera_to_painted",
        **_latency(seen.painted_ms if seen else (), PAINTED_BUDGET_MS, why),
        **({"feeds_in_sight": seen.in_sight} if seen else {}),
    }
    yield {
        "case": "page_interactive",
        **_latency(seen.interactive_ms if seen else (), INTERACTIVE_BUDGET_MS, why),
    }
    size = {"kb": round(seen.files_kb), "gzip_kb": round(seen.files_gzip_kb)} if seen else {"why": why}
    yield {"case": "page_files", "kb": None, "gzip_kb": None, **size}


def _latency(values_ms: Sequence[float], budget_ms: float, why_none: str) -> dict[str, Any]:
    facts: dict[str, Any] = {"measured": len(values_ms), "p50_ms": None, "p95_ms": None}
    facts |= {"budget_p95_ms": budget_ms, "ok": None}
    if not values_ms:
        return facts | {"why": why_none}
    p95_ms = share(values_ms, 0.95)
    return facts | {
        "p50_ms": round(share(values_ms, 0.5), 1),
        "p95_ms": round(p95_ms, 1),
        "ok": p95_ms <= budget_ms,
    }
