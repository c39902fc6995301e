"""The bench of the page's server measures what really came over its sockets."""

from __future__ import annotations

from parley.bench.web import measure_web


async def test_changes_and_pictures_are_measured_at_the_other_end() -> None:
    figures = await measure_web(robots=2, feeds=1, seconds=1.0)
    facts = figures.facts()
    assert facts["changes"] > 0
    assert 0 < facts["frames_shown"] <= facts["frames_taken"]
    assert facts["frame_p50_ms"] > 0
