"""The measurement answers every message, by every engine."""

from __future__ import annotations

from parley.bench.language import measure_language


async def test_every_message_is_answered_and_timed() -> None:
    figures = await measure_language(7)
    assert [figure.case for figure in figures] == [
        "builtin", "model_overhead", "model_overhead_streamed", "of_it_own_work", "of_it_server_and_http",
        "of_it_server_and_providers_client",
    ]  # fmt: skip
    assert all(len(figure.latency_ms) == 7 and min(figure.latency_ms) > 0 for figure in figures)
