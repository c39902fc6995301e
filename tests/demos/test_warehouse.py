"""The demonstration of thesis 5.4.2: which storing area, the package, a cylinder at an edge, and home."""

from __future__ import annotations

from pathlib import Path

import pytest

from parley.demos.catalogue import Demo, load_demo
from tests.demos.house import played


@pytest.fixture(scope="module")
def demo() -> Demo:
    return load_demo("warehouse")


@pytest.mark.parametrize(("variant", "seed"), [("", 0), ("other_words", 5)])
async def test_story_holds_and_what_stands_at_the_edge_is_told(
    demo: Demo, tmp_path: Path, variant: str, seed: int
) -> None:
    reason, events, system = await played(demo, tmp_path, variant, seed)
    assert reason == ""
    assert [event["code"] for event in events if event["event"] == "failure"] == ["attention"]
    found = {item.description for item in system.known.objects if item.found}
    assert found == {"package"}  # the cylinder was taken away, and that was seen
    kept = {event["name"] for event in events if event["event"] == "memory"}
    assert variant or "the_loading_area_has_been_cleared" in kept
