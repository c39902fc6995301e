"""The measurement of searches measures what it says; how fast it is, is no test."""

from __future__ import annotations

from parley.bench.memory import measure_memory


async def test_every_search_and_addition_is_timed() -> None:
    figures = await measure_memory(500, searches=3)
    assert figures.memories == 500
    assert {kind: len(taken) for kind, taken in figures.search_ms.items()} == dict.fromkeys(
        ("rare", "common", "all_common", "mixed", "none"), 3
    )
    assert (len(figures.service_ms), len(figures.add_ms)) == (15, 3)
    assert (len(figures.meaning_ms), len(figures.both_ms)) == (3, 15)
    assert figures.file_mb > 0
    assert all(ms > 0 for ms in (figures.fill_ms, figures.open_ms, *figures.service_ms, *figures.add_ms))
