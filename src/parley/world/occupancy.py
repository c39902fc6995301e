"""The occupancy map: which floor is free, in the files of ROS map_server (YAML header and greyscale picture).

A map is a grid of square cells in the map frame. Row 0 is the lowest y and column 0 the lowest x, as in
nav_msgs/OccupancyGrid; pictures have their first row at the highest y, so reading and writing flip rows.
"""

from __future__ import annotations

import math
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError
from pydantic import BaseModel, ConfigDict, Field

from parley.errors import FileFormatError
from parley.files import parse_yaml, read_text, validated
from parley.world.geometry import Metres

__all__ = ["FREE", "MAX_CELLS", "NO_MAP", "OCCUPIED", "UNKNOWN", "OccupancyMap"]

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""The values of a cell, those of nav_msgs/OccupancyGrid."""

MAX_CELLS: Final = 50_000_000
"""Of one map: 350 m square in cells of 5 cm."""
_FAR: Final = 1e9
"""Rows or columns: further away is nothing, whatever somebody orders."""
_FORMATS: Final = ("PPM", "PNG", "BMP", "JPEG", "TIFF", "GIF")

_FREE_PIXEL, _OCCUPIED_PIXEL, _UNKNOWN_PIXEL = 254, 0, 205


class _Header(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    image: str = Field(min_length=1)
    resolution: float = Field(ge=0.001, le=100)
    origin: tuple[Metres, Metres, float]
    negate: Literal[0, 1] = 0
    occupied_thresh: float = Field(default=0.65, ge=0, le=1)
    free_thresh: float = Field(default=0.196, ge=0, le=1)
    mode: Literal["trinary", "scale", "raw"] = "trinary"


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyMap:
    """Free, occupied and unknown floor."""

    cells: NDArray[np.int8]
    """Shape (rows, columns) of `FREE`, `OCCUPIED` or `UNKNOWN`; row 0 is the lowest y."""
    resolution_m: float
    """Length of a cell's side."""
    origin_x_m: float
    """Map-frame x of the lower left corner of cell (0, 0)."""
    origin_y_m: float
    """Map-frame y of that corner."""
    name: str = "map"

    def __post_init__(self) -> None:
        self.cells.setflags(write=False)

    @property
    def free(self) -> NDArray[np.bool_]:
        """True where the floor is known to be free."""
        return np.asarray(self.cells == FREE)

    @property
    def bounds_m(self) -> tuple[float, float, float, float]:
        """x_min, y_min, x_max, y_max in the map frame."""
        rows, columns = self.cells.shape
        return (
            self.origin_x_m,
            self.origin_y_m,
            self.origin_x_m + columns * self.resolution_m,
            self.origin_y_m + rows * self.resolution_m,
        )

    def cell_of(self, x_m: float, y_m: float) -> tuple[int, int]:
        """Row and column of a point in the map frame; may lie outside the grid (see `contains`)."""
        row, column = (y_m - self.origin_y_m) / self.resolution_m, (x_m - self.origin_x_m) / self.resolution_m
        return math.floor(max(-_FAR, min(row, _FAR))), math.floor(max(-_FAR, min(column, _FAR)))

    def cells_of(self, points_m: NDArray[np.float64]) -> NDArray[np.intp]:
        """Rows and columns, shape (k, 2), of those of the map-frame points (n, 2) that lie on the grid."""
        origin = np.array([self.origin_x_m, self.origin_y_m])
        cells = np.floor((points_m - origin) / self.resolution_m).astype(np.intp)[:, ::-1]
        return np.asarray(cells[((cells >= 0) & (cells < self.cells.shape)).all(axis=1)])

    def centers_of(self, cells: NDArray[np.intp]) -> NDArray[np.float64]:
        """Map-frame x and y, shape (n, 2), of the centres of cells given as rows and columns (n, 2)."""
        origin = np.array([self.origin_x_m, self.origin_y_m])
        return np.asarray(origin + (cells[:, ::-1] + 0.5) * self.resolution_m)

    def contains(self, row: int, column: int) -> bool:
        """Whether the cell lies on the grid."""
        rows, columns = self.cells.shape
        return bool(0 <= row < rows and 0 <= column < columns)

    def is_free(self, x_m: float, y_m: float) -> bool:
        """Whether the point lies on floor known to be free."""
        row, column = self.cell_of(x_m, y_m)
        return self.contains(row, column) and bool(self.free[row, column])

    def to_pixels(self) -> NDArray[np.uint8]:
        """The greyscale picture of the map as map_server draws it, first row at the highest y."""
        pixels = np.full(self.cells.shape, _UNKNOWN_PIXEL, dtype=np.uint8)
        pixels[self.cells == FREE] = _FREE_PIXEL
        pixels[self.cells == OCCUPIED] = _OCCUPIED_PIXEL
        return pixels[::-1]

    def save(self, folder: Path, name: str | None = None) -> Path:
        """Write ``<name>.yaml`` and ``<name>.pgm`` (default: the map's own name); return the header's path.

        Raises:
            OSError: The folder cannot be written to.
        """
        name = name or self.name
        Image.fromarray(self.to_pixels()).save(folder / f"{name}.pgm")
        header = {
            "image": f"{name}.pgm",
            "mode": "trinary",
            "resolution": self.resolution_m,
            "origin": [self.origin_x_m, self.origin_y_m, 0.0],
            "negate": 0,
            "occupied_thresh": 0.65,
            # The picture's unknown grey is 50/255 = 0.19608 occupied: the free threshold must stay below.
            "free_thresh": 0.196,
        }
        path = folder / f"{name}.yaml"
        path.write_text(yaml.safe_dump(header, sort_keys=False), encoding="utf-8")
        return path

    @classmethod
    def load(cls, path: Path) -> OccupancyMap:
        """Read a map_server header and the picture that it names.

        The modes `trinary` and `scale` are read alike (cells between the thresholds are unknown).

        Raises:
            FileFormatError: Names the file and the field.
        """
        header = _read_header(path)
        if header.origin[2] != 0.0:
            raise FileFormatError(path.name, "origin[2]", "turned maps are not supported: yaw must be 0")
        if header.free_thresh > header.occupied_thresh:
            raise FileFormatError(path.name, "free_thresh", "must not be above occupied_thresh")
        pixels = _read_pixels(path, header)
        return cls(
            _to_cells(pixels, header), header.resolution, header.origin[0], header.origin[1], path.stem
        )


def _read_header(path: Path) -> _Header:
    return validated(_Header, parse_yaml(read_text(path), path.name), path.name)


def _read_pixels(path: Path, header: _Header) -> NDArray[np.uint8]:
    def refused(problem: str) -> FileFormatError:
        return FileFormatError(path.name, "image", f"{header.image!r} {problem}")

    picture = path.parent / header.image
    try:
        if not picture.is_file():
            raise refused("is no file")
        with Image.open(picture, formats=_FORMATS) as image:
            if image.mode not in {"1", "L", "LA", "P", "RGB", "RGBA"}:
                raise FileFormatError(header.image, "", f"must have 8 bits a pixel, not mode {image.mode}")
            if image.width * image.height > MAX_CELLS:
                raise refused(f"has more than {MAX_CELLS // 1_000_000} million pixels")
            return np.asarray(image.convert("L"))
    except UnidentifiedImageError as error:
        raise refused("is not a picture that can be read") from error
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise refused(f"has more than {MAX_CELLS // 1_000_000} million pixels") from error
    except (OSError, SyntaxError, ValueError, OverflowError, struct.error, zlib.error) as error:
        raise refused(f"cannot be read: {error}") from error


def _to_cells(pixels: NDArray[np.uint8], header: _Header) -> NDArray[np.int8]:
    grey = np.arange(256)
    if header.mode == "raw":
        shade = np.where(grey <= 100, grey / 100.0, np.nan)
    else:
        shade = (grey if header.negate else 255 - grey) / 255.0
    meaning = np.full(256, UNKNOWN, dtype=np.int8)
    meaning[shade < header.free_thresh] = FREE
    meaning[shade > header.occupied_thresh] = OCCUPIED
    return np.asarray(meaning[pixels[::-1]])


NO_MAP: Final = OccupancyMap(np.full((1, 1), UNKNOWN, np.int8), 0.05, 0.0, 0.0, "no map")
"""What a robot without a map has: nothing is known to be free."""
