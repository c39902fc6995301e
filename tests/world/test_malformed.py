"""Maps and worlds of others: what is malformed is refused with file and field, and nothing else happens."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import parley.demos
from parley.errors import FileFormatError
from parley.sim.world_file import WorldFile
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OccupancyMap

SHIPPED = next(Path(parley.demos.__file__).parent.glob("*/map.yaml")).parent
HEADER = "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"
PICTURE = b"P5\n2 2\n255\n\0\0\0\0"
DEEP = "[" * 20_000
ITEM = (
    '{"classes": [], "items": {"box": [{"id": "a", "description": "d",'
    ' "coordinates": {"x": 1, "y": 2}, "dimensions": {"height": 1, "width": 1}}]}}'
)
WORLD = "name: w\nwalls: [{from: [0, 0], to: [4, 0]}]\n"
WORLD += "robots: [{name: A, model: turtlebot3_waffle, pose: [2, 2, 0]}]\n"


def read_map(folder: Path, header: str, picture: bytes) -> OccupancyMap:
    (folder / "map.yaml").write_text(header, encoding="utf-8")
    (folder / "map.pgm").write_bytes(picture)
    return OccupancyMap.load(folder / "map.yaml")


@pytest.mark.parametrize(
    "picture",
    [b"", b"P5", b"P5\n", b"P5\n2 2\n0\n\0\0\0\0", b"P5\n20 20\n255\n\0", b"P5\n-2 2\n255\n\0",
     b"P5\n0 2\n255\n", b"P5\n200000 200000\n255\n\0", b"P5\n10000 10000\n255\n\0", b"P2\n2 2\n255\n1 2 x 3"],
)  # fmt: skip
def test_pictures_that_are_no_maps_are_refused(tmp_path: Path, picture: bytes) -> None:
    with pytest.raises(FileFormatError, match=r"map\.yaml: image: "):
        read_map(tmp_path, HEADER, picture)


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("[0, 0, 0]", "[.nan, 0, 0]", "origin[0]"),
        ("[0, 0, 0]", "[0, -.inf, 0]", "origin[1]"),
        ("[0, 0, 0]", "[0, 0, .nan]", "origin[2]"),
        ("[0, 0, 0]", "[1.0e+300, 0, 0]", "origin[0]"),
        ("0.05", "0", "resolution"),
        ("0.05", "-1", "resolution"),
        ("0.05", "1.0e-300", "resolution"),
        ("0.05", ".nan", "resolution"),
        ("map.pgm", ".", "image"),
        ("map.pgm", '"a\\0b"', "image"),
        ("0.05", "0.05\nfree_thresh: .nan", "free_thresh"),
        ("0.05", "0.05\nfree_thresh: 0.9", "free_thresh"),
        ("0.05", "2024-99-99", ""),
        ("0.05", "9" * 5000, ""),
        (HEADER, DEEP, ""),
    ],
)
def test_headers_of_maps_are_refused_with_the_field(tmp_path: Path, old: str, new: str, field: str) -> None:
    with pytest.raises(FileFormatError) as refused:
        read_map(tmp_path, HEADER.replace(old, new), PICTURE)
    assert (refused.value.file, refused.value.field) == ("map.yaml", field)


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('"width": 1', '"width": Infinity', "items.box[0].dimensions.width"),
        ('"height": 1', '"height": -1', "items.box[0].dimensions.height"),
        ('"x": 1', '"x": NaN', "items.box[0].coordinates.x"),
        ('"y": 2', '"y": 1e999', "items.box[0].coordinates.y"),
        ('"y": 2', '"y": 1e300', "items.box[0].coordinates.y"),
        ('"id": "a"', '"id": "\\ud800"', "items.box[0].id"),
        (ITEM, DEEP, ""),
    ],
)
def test_object_maps_are_refused_with_the_field(old: str, new: str, field: str) -> None:
    with pytest.raises(FileFormatError) as refused:
        ObjectMap.parse(ITEM.replace(old, new), "objects.json")
    assert (refused.value.file, refused.value.field) == ("objects.json", field)


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("[4, 0]", "[.nan, 0]", "walls[0].to[0]"),
        ("[4, 0]", "[4.0e+299, 0]", "walls[0].to[0]"),
        ("[4, 0]", "[90000, 90000]", "walls[0]"),
        ("[2, 2, 0]", "[2, .inf, 0]", "robots[0].pose[1]"),
        (WORLD, DEEP, ""),
    ],
)
def test_worlds_are_refused_with_the_field(old: str, new: str, field: str) -> None:
    with pytest.raises(FileFormatError) as refused:
        WorldFile.parse(WORLD.replace(old, new), "world.yaml")
    assert (refused.value.file, refused.value.field) == ("world.yaml", field)


def test_things_inside_things_have_an_end() -> None:
    things = "".join(
        f"- {{name: t{n}, {f'inside: t{n - 1}, ' if n else ''}pose: [9, 9, 0],"
        " parts: [{size_m: [1, 1, 1]}]}\n"
        for n in range(200)
    )
    with pytest.raises(FileFormatError, match=r"things\[\d+\]\.inside: stands inside more than"):
        WorldFile.parse(f"{WORLD}things:\n{things}")


MUTATION = st.tuples(st.integers(0, 2**20), st.integers(0, 40), st.binary(max_size=12))
"""Where, how much is taken out, what comes there."""


def mutated(raw: bytes, mutations: list[tuple[int, int, bytes]]) -> bytes:
    for where, gone, new in mutations:
        at = where % (len(raw) + 1)
        raw = raw[:at] + new + raw[at + gone :]
    return raw


FUZZ = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
TOKENS = re.compile(rb"-?\d[\d.]*|[a-z_]+")
ODD = [
    b"nan",
    b".nan",
    b"-.inf",
    b"Infinity",
    b"1e999",
    b"-1",
    b"0",
    b"null",
    b"[]",
    b"{}",
    b"9" * 5000,
    b"&a",
    b"*a",
]


@FUZZ
@given(st.data(), st.lists(MUTATION, max_size=3), st.sampled_from(["pgm", "yaml", "json", "world"]))
def test_whatever_happens_to_a_shipped_map_it_is_read_or_refused(
    tmp_path: Path, data: st.DataObject, mutations: list[tuple[int, int, bytes]], kind: str
) -> None:
    names = {"pgm": "map.pgm", "yaml": "map.yaml", "json": "object_map.json", "world": "world.yaml"}
    raw = mutated((SHIPPED / names[kind]).read_bytes(), mutations)
    found = list(TOKENS.finditer(raw))
    if kind != "pgm" and found:
        token = data.draw(st.sampled_from(found))
        raw = raw[: token.start()] + data.draw(st.sampled_from(ODD)) + raw[token.end() :]
    for name in names.values():
        (tmp_path / name).write_bytes((SHIPPED / name).read_bytes())
    (tmp_path / names[kind]).write_bytes(raw)
    try:
        if kind in ("pgm", "yaml"):
            OccupancyMap.load(tmp_path / "map.yaml")
        else:
            (ObjectMap if kind == "json" else WorldFile).load(tmp_path / names[kind])
    except FileFormatError as refused:
        assert refused.problem
