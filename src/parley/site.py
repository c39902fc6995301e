"""A place where robots are: its maps, and its world where that is simulated; a folder, or made in code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final, Self

import numpy as np

from parley.errors import ConfigError
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import FREE, OccupancyMap

if TYPE_CHECKING:
    from parley.sim.world_file import WorldFile

__all__ = ["FILES", "Site"]

FILES: Final = ("world.yaml", "object_map.json", "map.yaml")
"""What a folder may hold: the simulated world, what people may name, where there is free floor."""
_CELL_M: Final = 0.05


@dataclass(frozen=True, slots=True)
class Site:
    """A place: what people may name there, and where there is free floor."""

    objects: ObjectMap = field(default_factory=ObjectMap)
    """What people may name."""
    occupancy: OccupancyMap | None = None
    """Where there is free floor; None: surveyed in a simulated world, not known in a real one."""
    world: WorldFile | None = None
    """The simulated world; None: it is real."""

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read a folder with `FILES`, of which one may be missing, or one `world.yaml`.

        Raises:
            ConfigError: There is no such folder, or nothing of this in it.
            FileFormatError: Names the file and the field that is wrong.
        """
        path = Path(path)
        folder = path if path.is_dir() else path.parent
        world_file = folder / FILES[0] if path.is_dir() else path
        objects, occupancy = folder / FILES[1], folder / FILES[2]
        if not path.exists():
            raise ConfigError(f"there is no folder or file {path}")
        if not any(file.is_file() for file in (world_file, objects, occupancy)):
            raise ConfigError(f"{path} is no world: it holds none of {', '.join(FILES)}")
        world = None
        if world_file.is_file():
            from parley.sim.world_file import WorldFile

            world = WorldFile.load(world_file)
        known = ObjectMap.load(objects) if objects.is_file() else None
        return cls(
            known or (world.object_map() if world is not None else ObjectMap()),
            OccupancyMap.load(occupancy) if occupancy.is_file() else None,
            world,
        )

    @classmethod
    def floor(
        cls, width_m: float, height_m: float, things: Mapping[str, tuple[float, float]] | None = None
    ) -> Self:
        """An empty floor with its lower left corner at (0, 0), for trying things out.

        Args:
            width_m: Along x.
            height_m: Along y.
            things: How people call something -> x and y of where it is.

        Raises:
            ConfigError: It has no extent.
        """
        rows, columns = round(height_m / _CELL_M), round(width_m / _CELL_M)
        if rows < 1 or columns < 1:
            raise ConfigError(f"a floor of {width_m:g} m by {height_m:g} m has no room")
        cells = np.full((rows, columns), FREE, np.int8)
        objects = [
            MapObject(id=name.replace(" ", "_"), description=name, x_m=x, y_m=y)
            for name, (x, y) in (things or {}).items()
        ]
        return cls(ObjectMap(tuple(objects)), OccupancyMap(cells, _CELL_M, 0.0, 0.0, "floor"))
