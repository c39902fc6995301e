"""The measurement of pictures measures what it says."""

from __future__ import annotations

from parley.bench.display import measure_display


async def test_every_kind_of_picture_is_sent_and_timed() -> None:
    figures = await measure_display(3)
    assert [figure.kind for figure in figures] == ["jpeg_untouched", "png", "rgb8"]
    assert all(figure.frames == len(figure.latency_ms) == 3 for figure in figures)
    assert all(ms > 0 for figure in figures for ms in figure.latency_ms)
