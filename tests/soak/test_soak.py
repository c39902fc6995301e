"""Hours in minutes: random commands on 20 actors leave nothing behind and lose nothing.

`make soak` runs ten minutes, or PARLEY_SOAK_S seconds; a short one is part of `make test`.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import statistics
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog

from parley.engine import runs
from parley.umrf.threads import IDLE

from .storm import ACTORS, Sample, Storm, sample

SOAK_S = float(os.environ.get("PARLEY_SOAK_S", "600"))
MAX_GROWTH_MB = 6.0
"""Of the process's memory, between the first and the last quarter of a run of minutes."""
MAX_GROWTH = 0.08
"""Of the number of things that Python has allocated, as a share."""


@pytest.fixture(autouse=True)
def quiet() -> Iterator[None]:
    """Refusals and crashes are what is wanted here; their log would fill the memory that is measured."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
    yield
    structlog.reset_defaults()


async def blow(seconds: float, folder: Path) -> Storm:
    before = sample()
    names = {thread.name for thread in threading.enumerate()}
    storm = Storm(seconds, folder)
    await storm.run()
    await asyncio.sleep(0.2)
    after = sample()
    assert storm.unaccounted == []
    assert storm.gaps == []
    assert storm.handler_failures == 0
    assert after.tasks == before.tasks
    left = {thread.name for thread in threading.enumerate()} - names
    assert {name for name in left if not name.startswith(("asyncio_", IDLE))} == set()
    assert after.files <= before.files + 1
    return storm


async def test_a_short_storm_leaves_nothing_behind(tmp_path: Path) -> None:
    storm = await blow(5.0, tmp_path)
    assert sum(storm.ends.values()) == storm.commands["start"] > 10 * ACTORS


@pytest.mark.soak
@pytest.mark.timeout(SOAK_S + 120)
async def test_a_long_storm_does_not_grow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for kept in ("KEPT_HALTED", "KEPT_ENDED"):  # what is kept on purpose is to be full before it is measured
        monkeypatch.setattr(runs, kept, 5)
    storm = await blow(SOAK_S, tmp_path)
    quarter = len(storm.samples) // 4
    first, last = storm.samples[quarter // 2 : quarter], storm.samples[-quarter:]
    figures = {
        "seconds": SOAK_S,
        "commands": dict(storm.commands),
        "ends": dict(storm.ends),
        "events": storm.events,
        "rss_mb": [round(median(first, "rss_mb"), 1), round(median(last, "rss_mb"), 1)],
        "blocks": [median(first, "blocks"), median(last, "blocks")],
        "tasks": [median(first, "tasks"), median(last, "tasks")],
        "threads": [median(first, "threads"), median(last, "threads")],
        "files": [median(first, "files"), median(last, "files")],
        "journal_mb": round(size_mb(tmp_path), 1),
    }
    print(json.dumps(figures))  # noqa: T201 - what `make soak` is run for
    assert sum(storm.ends.values()) == storm.commands["start"]
    assert median(last, "rss_mb") - median(first, "rss_mb") < MAX_GROWTH_MB
    assert median(last, "blocks") < (1 + MAX_GROWTH) * median(first, "blocks")
    assert median(last, "tasks") < 1.5 * median(first, "tasks") + 20
    assert median(last, "threads") < 1.5 * median(first, "threads") + 20
    assert median(last, "files") <= median(first, "files") + 3


def size_mb(folder: Path) -> float:
    return sum(file.stat().st_size for file in folder.iterdir()) / 2**20


def median(samples: list[Sample], what: str) -> float:
    return float(statistics.median(getattr(item, what) for item in samples))
