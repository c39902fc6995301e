"""The measurement of transports measures messages that came back."""

from __future__ import annotations

from parley.bench.transport import SIZES, measure_transport


async def test_messages_of_each_size_go_there_and_back_over_each_backend() -> None:
    figures = await measure_transport(5)
    assert [(one.backend, one.size) for one in figures] == [
        (backend, size) for backend in ("local", "zenoh") for size in SIZES
    ]
    assert all(len(one.latency_ms) == 5 and min(one.latency_ms) > 0 and one.lost == 0 for one in figures)
