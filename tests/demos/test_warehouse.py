"""The demonstration of thesis 5.4.2: which storing area, the package, a cylinder at an edge, and home."""

from __future__ import annotations

from pathlib import Path

import pytest

from parley.demos.catalogue import Demo, demo_folder, load_demo
from parley.sim.export import export_maps
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


@pytest.mark.parametrize("variant", ["no_package", "package_in_a", "clear_already"])
async def test_story_breaks_where_the_world_makes_it_impossible(
    demo: Demo, tmp_path: Path, variant: str
) -> None:
    reason, _, _ = await played(demo, tmp_path, variant)
    assert reason.partition(":")[0] == demo.story.variant(variant).fails != ""


async def test_every_variant_is_tested(demo: Demo) -> None:
    marks = test_story_breaks_where_the_world_makes_it_impossible.pytestmark  # type: ignore[attr-defined]
    assert {*demo.story.variants} == {*marks[0].args[1], "other_words"}


def test_its_map_files_are_what_a_survey_of_the_world_gives(demo: Demo, tmp_path: Path) -> None:
    """After a change to world.yaml: `parley world map`."""
    export_maps(demo.world, tmp_path)
    for name in ("map.yaml", "map.pgm", "object_map.json"):
        assert (demo_folder("warehouse") / name).read_bytes() == (tmp_path / name).read_bytes()
