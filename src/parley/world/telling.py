"""A robot's surroundings as a message, and back: who plans for a robot may be in another process than it."""

from __future__ import annotations

import base64
import binascii
import zlib
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from pydantic import TypeAdapter, ValidationError

from parley.errors import InvalidMessageError
from parley.messages.robot import Floor, RobotSite
from parley.world.object_map import ObjectMap
from parley.world.occupancy import MAX_CELLS, NO_MAP, OccupancyMap

__all__ = ["Surroundings", "floor_of", "surroundings_of", "told_objects"]

_OBJECTS: Final = TypeAdapter(ObjectMap)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What is known of one robot's surroundings, and of itself."""

    occupancy: OccupancyMap = NO_MAP
    """The floor it drives by."""
    objects: ObjectMap = field(default_factory=ObjectMap)
    """What people may name, with what robots found."""
    radius_m: float = 0.2
    max_speed_mps: float = 0.5


def floor_of(occupancy: OccupancyMap) -> Floor | None:
    """An occupancy map as it is told; nothing of no map."""
    if occupancy is NO_MAP:
        return None
    rows, columns = occupancy.cells.shape
    return Floor(
        name=occupancy.name,
        resolution=occupancy.resolution_m,
        origin_x=occupancy.origin_x_m,
        origin_y=occupancy.origin_y_m,
        rows=rows,
        columns=columns,
        cells=base64.b64encode(zlib.compress(occupancy.cells.tobytes(), 1)).decode("ascii"),
    )


def told_objects(objects: ObjectMap) -> dict[str, Any]:
    """The things of a map as they are told."""
    told: dict[str, Any] = _OBJECTS.dump_python(objects, mode="json")
    return told


def surroundings_of(site: RobotSite) -> Surroundings:
    """What a robot told.

    Raises:
        InvalidMessageError: It cannot be; names the field.
    """
    try:
        objects = _OBJECTS.validate_python(site.objects, strict=False)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        path = ".".join(("objects", *map(str, first["loc"])))
        raise InvalidMessageError("RobotSite", path, first["msg"]) from error
    occupancy = _occupancy(site.floor) if site.floor is not None else NO_MAP
    return Surroundings(occupancy, objects, site.radius_m, site.max_speed_mps)


def _occupancy(floor: Floor) -> OccupancyMap:
    count = floor.rows * floor.columns
    try:
        if count > MAX_CELLS:
            raise ValueError(f"more than {MAX_CELLS} cells")
        unpacking = zlib.decompressobj()
        cells = unpacking.decompress(base64.b64decode(floor.cells, validate=True), count + 1)
        if len(cells) != count:
            raise ValueError(f"{floor.rows} rows of {floor.columns} cells do not fit its data")
    except (ValueError, binascii.Error, zlib.error) as error:
        raise InvalidMessageError("RobotSite", "floor.cells", str(error)) from error
    return OccupancyMap(
        np.frombuffer(cells, np.int8).reshape(floor.rows, floor.columns).copy(),
        floor.resolution, floor.origin_x, floor.origin_y, floor.name,
    )  # fmt: skip
