"""The object map in the thesis's JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from parley.errors import FileFormatError
from parley.world.object_map import MapArea, MapObject, ObjectMap


def entry(**changes: Any) -> dict[str, Any]:
    return {
        "id": "chair_1",
        "description": "red chair",
        "coordinates": {"x": 1.0, "y": 2.0},
        "dimensions": {"height": 0.5, "width": 0.4},
    } | changes


def document(*entries: dict[str, Any]) -> str:
    return json.dumps({"classes": ["chair"], "items": {"chair": list(entries)}})


def test_width_lies_along_x_and_height_along_y() -> None:
    found = ObjectMap.parse(document(entry())).get("chair_1")
    assert found == MapObject("chair_1", "red chair", 1.0, 2.0, "chair", width_m=0.4, height_m=0.5)


def test_what_is_written_reads_back_the_same() -> None:
    objects = ObjectMap(
        (
            MapObject("a", "box A", 1.0, 2.0, "box", 0.3, 0.4, ("crate", "case"), front_rad=1.5),
            MapObject("b", "chair B", -1.0, 0.0, "chair", 0.0, 0.0),
        ),
        (MapArea("yard", ((0.0, 0.0), (4.0, 0.0), (4.0, 3.5))),),
    )
    assert ObjectMap.parse(json.dumps(objects.to_json())) == objects


def test_an_unknown_id_finds_nothing() -> None:
    assert ObjectMap.parse(document(entry())).get("chair_2") is None


@pytest.mark.parametrize(
    ("text", "field"),
    [
        ("[1, 2", ""),
        (json.dumps({"items": {}}), "classes"),
        (document(entry(coordinates={"x": 1.0})), "items.chair[0].coordinates.y"),
        (document(entry(coordinates={"x": "left", "y": 0})), "items.chair[0].coordinates.x"),
        (document(entry(dimensions={"height": -1, "width": 0})), "items.chair[0].dimensions.height"),
        (document(entry(), entry(description="")), "items.chair[1].description"),
        (document(entry(), entry()), "items.chair[1].id"),
        (document(entry(front="north")), "items.chair[0].front"),
        (
            json.dumps({"classes": [], "items": {}, "areas": [{"name": "yard", "corners": [[0, 0]]}]}),
            "areas[0].corners",
        ),
    ],
)
def test_a_malformed_map_is_refused_with_file_and_field(text: str, field: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        ObjectMap.parse(text, file="objects.json")
    assert (caught.value.file, caught.value.field) == ("objects.json", field)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"nowhere\.json: cannot be read"):
        ObjectMap.load(tmp_path / "nowhere.json")


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "objects.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FileFormatError, match="UTF-8"):
        ObjectMap.load(tmp_path / "objects.json")
