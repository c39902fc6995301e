"""What holds of each demonstration whose story is a round: how it breaks, what its map files are made of."""

from __future__ import annotations

from pathlib import Path

import pytest

from parley.demos.catalogue import demo_folder, load_demo
from parley.sim.export import export_maps
from tests.demos.house import played

ROUNDS = ("parking", "warehouse")
BREAKS = {
    "parking": ("nobody_comes", "bag_in_a", "dead_camera", "closed_off"),
    "warehouse": ("no_package", "package_in_a", "clear_already", "closed_off"),
}


@pytest.mark.parametrize(("name", "variant"), [(name, one) for name in ROUNDS for one in BREAKS[name]])
async def test_story_breaks_where_the_world_makes_it_impossible(
    name: str, variant: str, tmp_path: Path
) -> None:
    demo = load_demo(name)
    reason, _, _ = await played(demo, tmp_path, variant)
    assert reason.partition(":")[0] == demo.story.variant(variant).fails != ""


@pytest.mark.parametrize("name", ROUNDS)
def test_every_variant_is_tested(name: str) -> None:
    assert {*load_demo(name).story.variants} == {*BREAKS[name], "other_words", "more_words"}


@pytest.mark.parametrize("name", ROUNDS)
def test_its_map_files_are_what_a_survey_of_the_world_gives(name: str, tmp_path: Path) -> None:
    """After a change to world.yaml: `parley world map`."""
    demo = load_demo(name)
    export_maps(demo.world, tmp_path)
    for file in ("map.yaml", "map.pgm", "object_map.json"):
        assert (demo_folder(name) / file).read_bytes() == (tmp_path / file).read_bytes()
    assert not any(item.class_name == "bag" for item in demo.objects.objects), "what comes later is on no map"
