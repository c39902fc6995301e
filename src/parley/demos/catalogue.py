"""The demonstrations that come with Parley: where their data lies and how to build their systems."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Final

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.faults import with_faults
from parley.demos.story import Story, Variant
from parley.errors import ConfigError
from parley.language.base import Language
from parley.sim.world_file import RobotEntry, WorldFile
from parley.system import System
from parley.umrf.action import ActionSpec
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OccupancyMap

__all__ = ["DEMOS", "Demo", "load_demo"]

DEMOS: Final = {"nursing-home": "nursing_home"}
"""Name on the command line -> folder."""


@dataclass(frozen=True, slots=True)
class Demo:
    """One demonstration's data."""

    name: str
    world: WorldFile
    objects: ObjectMap
    occupancy: OccupancyMap
    story: Story

    def system(
        self,
        config: SystemConfig,
        variant: Variant | None = None,
        *,
        language: Language | None = None,
        actions: Sequence[ActionSpec] = BUILTIN_ACTIONS,
    ) -> System:
        """A system for it; the robots' maps stay as surveyed, whatever a variant changes in the world."""
        world = self.world.with_changes(variant.world) if variant is not None else self.world
        gone = set(variant.world.remove) if variant is not None else set()
        objects = ObjectMap(tuple(item for item in self.objects.objects if item.id not in gone))
        return System(
            world, config, occupancy=self.occupancy, objects=objects, language=language, actions=actions
        )

    def system_for(self, story: Story, config: SystemConfig, variant: Variant | None = None) -> System:
        """A system for a story with a world, robots and faults of its own."""
        world = self.world.with_changes(story.world)
        first = world.robots[0]
        more = tuple(
            RobotEntry(name=name, model=first.model, pose=pose) for name, pose in story.robots.items()
        )
        own = replace(self, world=world.model_copy(update={"robots": (*world.robots, *more)}))
        return own.system(config, variant, actions=with_faults(BUILTIN_ACTIONS, story.faults))


def load_demo(name: str, folder: Path | None = None) -> Demo:
    """Read a demonstration.

    Args:
        name: One of `DEMOS`.
        folder: Read from here instead of the package.

    Raises:
        ConfigError: There is no such demonstration, or one of its files is wrong (named).
    """
    if folder is None:
        if name not in DEMOS:
            raise ConfigError(f"there is no demonstration {name!r}; there are: {', '.join(DEMOS)}")
        folder = Path(str(resources.files("parley.demos") / DEMOS[name]))
    return Demo(
        name=name,
        world=WorldFile.load(folder / "world.yaml"),
        objects=ObjectMap.load(folder / "object_map.json"),
        occupancy=OccupancyMap.load(folder / "map.yaml"),
        story=Story.load(folder / "story.yaml"),
    )
