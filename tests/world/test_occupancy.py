"""Occupancy maps and their map_server files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from PIL import Image

from parley.errors import FileFormatError
from parley.world.occupancy import FREE, OCCUPIED, UNKNOWN, OccupancyMap

HEADER = "image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n"


def write_map(folder: Path, header: str, pixels: list[list[int]]) -> Path:
    Image.fromarray(np.array(pixels, dtype=np.uint8)).save(folder / "m.pgm")
    path = folder / "m.yaml"
    path.write_text(header)
    return path


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=50)
@given(
    cells=arrays(
        np.int8, array_shapes(min_dims=2, max_dims=2, max_side=12), elements=st.sampled_from([0, 100, -1])
    ),
    resolution_m=st.floats(0.01, 2.0),
    origin=st.tuples(st.floats(-100, 100), st.floats(-100, 100)),
)
def test_what_is_saved_loads_the_same(
    tmp_path: Path, cells: np.ndarray, resolution_m: float, origin: tuple[float, float]
) -> None:
    saved = OccupancyMap(cells, resolution_m, *origin, name="ground")
    loaded = OccupancyMap.load(saved.save(tmp_path))
    assert np.array_equal(loaded.cells, cells)
    assert (loaded.resolution_m, loaded.origin_x_m, loaded.origin_y_m) == (resolution_m, *origin)
    assert loaded.name == "ground"


@given(st.integers(-50, 50), st.integers(-50, 50), st.floats(0.01, 1.0), st.floats(-20, 20))
def test_a_cells_centre_lies_in_that_cell(
    row: int, column: int, resolution_m: float, origin_m: float
) -> None:
    ground = OccupancyMap(np.zeros((3, 3), np.int8), resolution_m, origin_m, -origin_m)
    ((x, y),) = ground.centers_of(np.array([[row, column]]))
    assert ground.cell_of(x, y) == (row, column)


def test_points_beside_the_grid_have_no_cell() -> None:
    ground = OccupancyMap(np.zeros((2, 3), np.int8), 0.5, 1.0, 2.0)
    assert not ground.contains(*ground.cell_of(1e308, -1e308))
    cells = ground.cells_of(np.array([[1.1, 2.6], [0.9, 2.1], [2.4, 2.1], [2.6, 2.1], [1.1, 3.1]]))
    assert cells.tolist() == [[1, 0], [0, 2]]
    assert ground.centers_of(cells).tolist() == [[1.25, 2.75], [2.25, 2.25]]


def test_the_first_row_of_the_picture_is_the_highest_y(tmp_path: Path) -> None:
    ground = OccupancyMap.load(write_map(tmp_path, HEADER, [[0, 254], [254, 254], [254, 254]]))
    assert not ground.is_free(0.05, 0.25)
    assert ground.is_free(0.05, 0.05)
    assert ground.bounds_m == pytest.approx((0.0, 0.0, 0.2, 0.3))


def test_outside_the_grid_nothing_is_free(tmp_path: Path) -> None:
    ground = OccupancyMap.load(write_map(tmp_path, HEADER, [[254]]))
    assert ground.is_free(0.05, 0.05)
    assert not ground.is_free(-0.05, 0.05)
    assert not ground.is_free(0.05, 0.15)


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ("", [FREE, UNKNOWN, UNKNOWN, OCCUPIED]),
        ("negate: 1\n", [OCCUPIED, OCCUPIED, UNKNOWN, FREE]),
        ("occupied_thresh: 0.4\nfree_thresh: 0.3\n", [FREE, FREE, OCCUPIED, OCCUPIED]),
        ("mode: scale\n", [FREE, UNKNOWN, UNKNOWN, OCCUPIED]),
    ],
)
def test_shades_become_cells_by_the_headers_thresholds(
    tmp_path: Path, more: str, expected: list[int]
) -> None:
    ground = OccupancyMap.load(write_map(tmp_path, HEADER + more, [[254, 205, 128, 0]]))
    assert ground.cells[0].tolist() == expected


def test_raw_pictures_hold_the_values_themselves(tmp_path: Path) -> None:
    ground = OccupancyMap.load(write_map(tmp_path, HEADER + "mode: raw\n", [[0, 100, 255, 50]]))
    assert ground.cells[0].tolist() == [FREE, OCCUPIED, UNKNOWN, UNKNOWN]


def test_a_map_cannot_be_changed_after_it_was_made() -> None:
    ground = OccupancyMap(np.zeros((2, 2), np.int8), 0.1, 0.0, 0.0)
    with pytest.raises(ValueError, match="read-only"):
        ground.cells[0, 0] = OCCUPIED


@pytest.mark.parametrize(
    ("header", "field"),
    [
        ("resolution: 0.1\norigin: [0, 0, 0]\n", "image"),
        (HEADER.replace("0.1", "-0.1"), "resolution"),
        (HEADER.replace("0.1", "fine"), "resolution"),
        (HEADER.replace("[0, 0, 0]", "[0, 0]"), "origin[2]"),
        (HEADER.replace("[0, 0, 0]", "[0, 0, 0.5]"), "origin[2]"),
        (HEADER + "negate: 2\n", "negate"),
        (HEADER + "mode: colour\n", "mode"),
        (HEADER + "free_thresh: 7\n", "free_thresh"),
        (HEADER.replace("m.pgm", "other.pgm"), "image"),
        (HEADER.replace("m.pgm", "m.yaml"), "image"),
        ("image: [", ""),
        ("- just a list", ""),
    ],
)
def test_a_malformed_header_is_refused_with_file_and_field(tmp_path: Path, header: str, field: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        OccupancyMap.load(write_map(tmp_path, header, [[254]]))
    assert (caught.value.file, caught.value.field) == ("m.yaml", field)


def test_a_missing_header_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"gone\.yaml: cannot be read"):
        OccupancyMap.load(tmp_path / "gone.yaml")
