"""The demonstration of thesis 5.3.2: three areas, a bag that somebody leaves, an alarm, and a closer look."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from parley.demos.catalogue import Demo, load_demo
from parley.world.object_map import MapObject
from tests.demos.house import played

Point = tuple[float, float]


@pytest.fixture(scope="module")
def demo() -> Demo:
    return load_demo("parking")


def with_bag_at(demo: Demo, x_m: float, y_m: float) -> Demo:
    """The same, but the bag is left somewhere else."""
    (event,) = demo.world.events
    (bag,) = event.change.add
    moved = event.change.model_copy(update={"add": (bag.model_copy(update={"pose": (x_m, y_m, 0.4)}),)})
    events = (event.model_copy(update={"change": moved}),)
    return replace(demo, world=demo.world.model_copy(update={"events": events}))


@pytest.mark.parametrize(
    ("variant", "seed", "bag"),
    [("", 0, (20.9, 2.0)), ("more_words", 5, (20.1, 2.6))],
    ids=["told", "reworded"],
)
async def test_story_holds_and_the_bag_is_found_where_the_camera_saw_it(
    demo: Demo, tmp_path: Path, variant: str, seed: int, bag: Point
) -> None:
    reason, events, system = await played(with_bag_at(demo, *bag), tmp_path, variant, seed)
    assert reason == ""
    assert [event["text"] for event in events if event["event"] == "world"] == [
        "somebody leaves a bag in area C"
    ]
    (found,) = (item for item in system.known.objects if item.class_name == "bag")
    assert math.dist((found.x_m, found.y_m), bag) < 0.3
    assert [event["code"] for event in events if event["event"] == "failure"] == ["attention"]
    looks = [event["node"] for event in events if event["event"] == "transition" and event.get("result")]
    assert len([node for node in looks if node.startswith("Inspect")]) == 4
    kept = {event["name"] for event in events if event["event"] == "memory"}
    assert {"areas_of_interest", "black_bag_sighting", "picture of the black bag"} <= kept


@pytest.mark.parametrize("name", ["black bag", "bag", "suspicious bag"])
async def test_a_bag_that_is_on_the_map_beforehand_is_that_bag_and_no_area_is_taken_for_another(
    demo: Demo, tmp_path: Path, name: str
) -> None:
    entry = MapObject("black_bag_1", name, 20.85, 2.05, "bag", width_m=0.5, height_m=0.4)
    prepared = replace(demo, objects=replace(demo.objects, objects=(*demo.objects.objects, entry)))
    reason, events, system = await played(prepared, tmp_path)
    assert reason == ""
    (found,) = (item for item in system.known.objects if item.class_name == "bag")
    assert (found.id, found.description) == ("black_bag_1", name)
    assert math.dist((found.x_m, found.y_m), (20.9, 2.0)) < 0.3
    seen = [event["text"] for event in events if event["event"] == "said" and "I see no" in event["text"]]
    assert [text.split(" in ")[1][:6] for text in seen] == ["Area A", "Area B"]
