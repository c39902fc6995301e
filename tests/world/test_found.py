"""What robots found stands on the map, where it was seen last, and is known after a restart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from parley.world.found import FoundThings
from parley.world.object_map import MapObject, ObjectMap
from parley.world.whereabouts import Footprint

KNOWN = ObjectMap(
    (
        MapObject("bay_1", "bay 1", 0.0, 0.0, "area", width_m=2.0, height_m=2.0),
        MapObject("barrow", "barrow", 5.0, 0.0, "barrow", width_m=1.0, height_m=0.6),
    )
)


async def test_a_new_thing_is_on_the_map_where_it_was_seen_and_stays_there_after_a_restart(
    tmp_path: Path,
) -> None:
    file = tmp_path / "found.json"
    thing = await FoundThings(file).note("black bag", Footprint(0.5, 0.2, 0.4, 0.3), KNOWN)
    assert (thing.id, thing.description, thing.class_name) == ("black_bag_1", "black bag", "bag")
    assert FoundThings(file).added_to(KNOWN).objects == (*KNOWN.objects, thing)


async def test_a_known_thing_that_is_seen_elsewhere_was_moved_and_one_in_its_place_was_not() -> None:
    found = FoundThings()
    assert await found.note("barrow", Footprint(4.9, 0.1, 0.2, 0.2), KNOWN) == KNOWN.objects[1]
    assert await found.note("bay 1", Footprint(0.02, 0.0, 2.0, 2.0), KNOWN) == KNOWN.objects[0]  # all of it
    await found.note("Barrow", Footprint(6.0, 0.5, 0.9, 0.5), KNOWN)
    (barrow,) = (item for item in found.added_to(KNOWN).objects if item.description == "barrow")
    assert (barrow.id, barrow.x_m, barrow.y_m) == ("barrow", 6.0, 0.5)
    assert len(found.added_to(KNOWN).objects) == 2


async def test_two_of_a_kind_far_apart_have_two_names() -> None:
    found = FoundThings()
    await found.note("bag", Footprint(0.5, 0.0), KNOWN)
    second = await found.note("bag", Footprint(9.0, 0.0), KNOWN)
    third = await found.note("bag", Footprint(5.0, 1.0), KNOWN)
    assert (second.description, third.description) == ("bag 2", "bag by barrow")


async def test_a_damaged_file_is_no_reason_not_to_start(tmp_path: Path) -> None:
    file = tmp_path / "found.json"
    file.write_text("{")
    assert FoundThings(file).added_to(KNOWN) == KNOWN


async def test_what_is_seen_where_the_map_has_such_a_thing_under_another_name_is_that_thing() -> None:
    case = MapObject("case", "suspicious bag", 2.0, 2.0, "bag", width_m=0.4, height_m=0.3)
    known = ObjectMap((*KNOWN.objects, case))
    found = FoundThings()
    seen = await found.note("black bag", Footprint(2.1, 2.1, 0.4, 0.3), known)
    assert (seen.id, seen.description, seen.aliases) == ("case", "suspicious bag", ("black bag",))
    assert len(found.added_to(known).objects) == 3
    assert (await found.note("black bag", Footprint(2.9, 2.1, 0.4, 0.3), known)).id == "case"  # it was moved
    for label, x_m in (("black box", 2.1), ("black bag", 2.9)):
        assert (await FoundThings().note(label, Footprint(x_m, 2.1, 0.4, 0.3), known)).id != "case"
    red = ObjectMap((replace(case, description="red bag"),))
    assert (await FoundThings().note("black bag", Footprint(2.0, 2.0, 0.4, 0.3), red)).id != "case"
