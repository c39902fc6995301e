"""The bench of the page's server measures what really came over its sockets."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from parley.bench.web import measure_web
from parley.bench.web_browser import find_browser
from parley.bench.web_report import report
from parley.errors import ParleyError

WITH_BUDGET = ["camera_to_socket", "camera_to_browser_socket", "camera_to_painted", "page_interactive"]


async def rows(**load: Any) -> dict[str, dict[str, Any]]:
    """What is reported, by case."""
    figures = await measure_web(robots=2, feeds=1, seconds=1.0, **load)
    return {row["case"]: row for row in report(figures)}


async def test_changes_and_pictures_are_measured_at_the_other_end() -> None:
    facts = (await rows(browser=False))["load"]
    assert facts["changes"] > 0
    assert 0 < facts["frames_shown"] <= facts["frames_taken"]
    assert facts["frame_p50_ms"] > 0


async def test_without_a_browser_its_figures_are_null_and_say_why(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("PARLEY_CHROMIUM", raising=False)
    found = await rows()
    server, *browser = (found[case] for case in WITH_BUDGET)
    assert server["ok"] == (server["p95_ms"] <= server["budget_p95_ms"])
    for row in browser:
        assert (row["p50_ms"], row["p95_ms"], row["ok"]) == (None, None, None)
        assert row["why"]
    assert found["page_files"]["gzip_kb"] is None


@pytest.mark.soak
async def test_a_real_browser_paints_the_pictures_later_than_they_come() -> None:
    try:
        find_browser()
    except ParleyError as missing:
        if os.environ.get("PARLEY_REQUIRE_BROWSER") == "1":
            raise
        pytest.skip(str(missing))
    found = await rows()
    for case in WITH_BUDGET:
        row = found[case]
        assert row["measured"] > 0
        assert row["ok"] == (row["p95_ms"] <= row["budget_p95_ms"])
    assert found["camera_to_painted"]["feeds_in_sight"] == 1
    assert 0 < found["camera_to_browser_socket"]["p50_ms"] < found["camera_to_painted"]["p50_ms"]
    assert 0 < found["page_files"]["gzip_kb"] < found["page_files"]["kb"]
