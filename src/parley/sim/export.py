"""What a robot is given to know of a world beforehand: the object map and the occupancy map, as files."""

from __future__ import annotations

import json
from pathlib import Path

from parley.sim.floor_plan import survey
from parley.sim.world_file import WorldFile

__all__ = ["MAP_NAME", "OBJECT_MAP_FILE", "export_maps"]

MAP_NAME = "map"
"""Of ``map.yaml`` and ``map.pgm``."""
OBJECT_MAP_FILE = "object_map.json"


def export_maps(world: WorldFile, folder: Path, resolution_m: float = 0.05) -> None:
    """Write a world's object map and the occupancy map that serves all its robots.

    Raises:
        OSError: The folder cannot be written to.
    """
    text = json.dumps(world.object_map().to_json(), indent=2, ensure_ascii=False)
    (folder / OBJECT_MAP_FILE).write_text(text + "\n", encoding="utf-8")
    tallest_m = max(robot.model.height_m for robot in world.robots)
    survey(world, tallest_m, resolution_m).save(folder, MAP_NAME)
