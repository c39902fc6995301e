"""Makes the system that was described at the door. Everything heavy is loaded with this module."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import structlog

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, demo_folder
from parley.errors import ConfigError
from parley.files import validated
from parley.language.base import Language
from parley.logs import quiet_logs
from parley.robots.own import RobotBase
from parley.site import Site
from parley.system import System
from parley.umrf.action import Action, ActionSpec
from parley.umrf.discovery import ActionFolder

__all__ = ["make_system"]


def make_system(
    world: str | Path | Site | None,
    robots: Iterable[RobotBase | type[RobotBase]],
    actions: Iterable[Action[..., Any] | ActionSpec | str | Path],
    language: str | Language | None,
    config: SystemConfig | Mapping[str, Any] | str | Path | None,
) -> System:
    """The system for what is given to `Parley`; see there.

    Raises:
        ConfigError: A setting, a file or a name is wrong, or there are no robots.
    """
    if not structlog.is_configured():
        quiet_logs(traces=True)
    settings = _settings(config)
    if isinstance(language, str):
        settings = settings.changed({"language": language})
    own = [robot if isinstance(robot, RobotBase) else robot(robot.__name__) for robot in robots]
    site = world if isinstance(world, Site) else Site() if world is None else Site.load(_folder(world))
    if not own and site.world is None:
        raise ConfigError("there are no robots: give robots=[..], or a world with a world.yaml")
    return System(
        site.world,
        settings,
        robots=own,
        objects=site.objects,
        occupancy=site.occupancy,
        language=None if isinstance(language, str) else language,
        actions=(*BUILTIN_ACTIONS, *_specs(actions)),
    )


def _settings(config: SystemConfig | Mapping[str, Any] | str | Path | None) -> SystemConfig:
    if isinstance(config, SystemConfig):
        return config
    if isinstance(config, str | Path):
        return SystemConfig.load(Path(config))
    return validated(SystemConfig, dict(config or {}), "config")


def _folder(world: str | Path) -> Path:
    """A demonstration by its name, anything else as a path."""
    return demo_folder(str(world)) if str(world) in DEMOS else Path(world)


def _specs(actions: Iterable[Action[..., Any] | ActionSpec | str | Path]) -> list[ActionSpec]:
    specs: list[ActionSpec] = []
    for each in actions:
        if isinstance(each, Action):
            specs.append(each.spec)
        elif isinstance(each, ActionSpec):
            specs.append(each)
        else:
            folder = ActionFolder(Path(each))
            folder.scan()
            if folder.found.problems:
                raise ConfigError("; ".join(folder.found.problems))
            specs.extend(folder.found.specs)
    return specs
