"""Demonstrations, those that come with Parley and a user's own: their data and their systems."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Sequence
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
from parley.site import Site
from parley.system import System
from parley.umrf.action import ActionSpec
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OccupancyMap

__all__ = ["DEMOS", "Demo", "demo_folder", "load_demo"]

DEMOS: Final = {
    "nursing-home": "nursing_home",
    "parking": "parking",
    "warehouse": "warehouse",
    "fleet": "fleet",
}
"""Name on the command line -> folder."""


@dataclass(frozen=True, slots=True)
class Demo:
    """One demonstration's data."""

    name: str
    world: WorldFile
    objects: ObjectMap
    occupancy: OccupancyMap | None
    """Where there is free floor; None: surveyed."""
    told: Story | None = None
    """Its story, if it has one."""

    folder_name: str = ""
    """Names the folder where it keeps what is remembered; two worlds have two."""

    @property
    def tour(self) -> tuple[str, ...]:
        """What the operator of the story says of their own accord; whoever is shown it answers."""
        steps = self.told.steps if self.told is not None else ()
        before = (None, *steps)
        return tuple(
            step.say
            for earlier, step in zip(before, steps, strict=False)
            if step.say and not (earlier and earlier.proposed)  # a yes is theirs
        )

    def settled(self, config: SystemConfig) -> SystemConfig:
        """Settings that ask before plans begin where its story does and nothing else was set."""
        asks = self.told is not None and self.told.ask_first and "approval" not in config.model_fields_set
        return config.changed({"approval": "ask_first"}) if asks else config

    @property
    def examples(self) -> tuple[str, ...]:
        """Sentences that people may want to try."""
        return self.told.examples if self.told is not None else ()

    @property
    def story(self) -> Story:
        """What can be played.

        Raises:
            ConfigError: It has no story.
        """
        if self.told is None:
            raise ConfigError(f"{self.name} has no story.yaml, so there is nothing to play")
        return self.told

    @property
    def everybody(self) -> tuple[str, ...]:
        """Names of its robots, those that stand by among them."""
        return tuple(robot.name for robot in (*self.world.robots, *self.world.standby))

    def with_robots(self, names: Collection[str]) -> Demo:
        """The same with these of its robots.

        Raises:
            FileFormatError: It has no robot of that name, or there would be none.
        """
        return replace(self, world=self.world.with_robots(names, "--robots"))

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
        kept = tuple(item for item in self.objects.objects if item.id not in gone)
        objects = replace(self.objects, objects=kept)
        return System(
            world, config, occupancy=self.occupancy, objects=objects, language=language, actions=actions
        )

    def system_for(self, story: Story, config: SystemConfig, variant: Variant | None = None) -> System:
        """A system for a story with a world, robots and faults of its own."""
        world, occupancy = self.world.with_changes(story.world), self.occupancy
        if story.model:  # what one robot drives under another does not
            world, occupancy = world.with_models(story.model), None
        first = world.robots[0]
        more = tuple(
            RobotEntry(name=name, model=first.model, pose=pose) for name, pose in story.robots.items()
        )
        if story.ask_first:
            config = config.changed({"approval": "ask_first"})
        own = replace(
            self, occupancy=occupancy, world=world.model_copy(update={"robots": (*world.robots, *more)})
        )
        return own.system(config, variant, actions=with_faults(BUILTIN_ACTIONS, story.faults))


def demo_folder(name: str) -> Path:
    """Where the data of one of `DEMOS` lies."""
    return Path(str(resources.files("parley.demos") / DEMOS[name]))


def load_demo(name: str) -> Demo:
    """Read a demonstration.

    Args:
        name: One of `DEMOS`, or a folder: with a ``world.yaml``, and perhaps maps and a ``story.yaml``.

    Raises:
        ConfigError: There is no such demonstration, or one of its files is wrong (named).
    """
    folder = demo_folder(name) if name in DEMOS else Path(name)
    if not folder.is_dir():
        raise ConfigError(
            f"there is no demonstration and no folder {name!r}; demonstrations: {', '.join(DEMOS)}"
        )
    site, story = Site.load(folder), folder / "story.yaml"
    if site.world is None:
        raise ConfigError(f"{name} has no world.yaml, so there is nothing to simulate")
    own = hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:8]
    return Demo(
        name=name if name in DEMOS else folder.resolve().name,
        folder_name=name if name in DEMOS else f"{folder.resolve().name}-{own}",
        world=site.world,
        objects=site.objects,
        occupancy=site.occupancy,
        told=Story.load(story) if story.is_file() else None,
    )
