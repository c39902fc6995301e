"""Which part of a system runs on which machine: one file for all of them, for `parley up`."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Self

import yaml
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic_core import InitErrorDetails

from parley.config import FOLDER, FilePath, NetworkSettings, SystemConfig
from parley.errors import ConfigError
from parley.files import TextFile, again, read_text, validated_yaml, wrong_at

__all__ = ["Deployment", "PartToRun"]

HERE: Final = "here"
"""The machine of whoever names none."""


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)

    machine: str = HERE
    """Where it runs: one of `machines`."""


class _Agents(_Part):
    """All that understands, plans and remembers."""


class _Page(_Part):
    """The page for operators."""

    port: int = Field(default=8400, ge=0, le=65535)
    lan: bool = False
    """Let other devices in: HTTPS, with a code to sign in."""
    password_file: FilePath | None = None
    """A password to sign in with, here too."""


class _Robot(_Part):
    """One robot; those of one simulated world on one machine share a process."""

    name: str = Field(min_length=1)
    world: str = ""
    """Where it is: a demonstration by name, or a folder with maps and perhaps a `world.yaml` to simulate."""
    kind: str = Field(default="", alias="class")
    """``MODULE:CLASS`` or ``FILE.py:CLASS`` of a robot of your own; empty: simulated."""

    @field_validator("world", "kind")
    @classmethod
    def _beside(cls, value: str, info: ValidationInfo) -> str:
        """A folder or Python file counts from the file's own folder."""
        folder = (info.context or {}).get(FOLDER)
        file, colon, name = value.rpartition(":")
        path = file if file.endswith(".py") else value
        if folder is None or not path or not (folder / path).exists():
            return value
        return f"{folder / path}{colon}{name}" if path is file else str(folder / path)


@dataclass(frozen=True, slots=True)
class PartToRun:
    """One process of a machine."""

    name: str
    """How people call it."""
    arguments: tuple[str, ...]
    """Of `parley`, but for its settings and its data."""


class Deployment(BaseModel, TextFile):
    """The parts of a system; a file of it is YAML with these names, and paths in it count from its folder."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    settings: SystemConfig = Field(default_factory=SystemConfig)
    """What all parts share; `network` there is that of all machines that have none of their own."""
    data: FilePath
    """Where the parts keep what they know, each in a folder of its own."""
    machines: dict[str, NetworkSettings] = Field(default_factory=dict)
    """Machine -> how it is reached and whom it connects to; none: all runs on one."""
    agents: _Agents = Field(default_factory=_Agents)
    web: _Page | None = None
    """None: no page."""
    robots: tuple[_Robot, ...] = ()

    @model_validator(mode="wrap")
    @classmethod
    def _fits_together(cls, raw: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """All that is wrong is told at once: with single fields, and with what has to fit together."""
        wrong = list(_unfit(raw)) if isinstance(raw, dict) else []
        try:
            made = handler(raw)
        except ValidationError as error:
            wrong = [*again(error), *wrong]
        if wrong:
            raise ValidationError.from_exception_data(cls.__name__, wrong)
        return made

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a file of this kind.

        Raises:
            FileFormatError: Names the file, the line and what is wrong or unknown.
        """
        return validated_yaml(cls, read_text(path), path.name, {FOLDER: path.parent.resolve()})

    @classmethod
    def parse(cls, text: str, file: str = "deployment") -> Self:
        """Read the text of such a file; paths in it count from where the process runs.

        Raises:
            FileFormatError: Names the file, the line and what is wrong or unknown.
        """
        return validated_yaml(cls, text, file)

    def machine(self, wished: str = "") -> str:
        """Which of the machines this one is.

        Args:
            wished: Its name, if it was told.

        Raises:
            ConfigError: It is none of them, or nobody can say which.
        """
        names = tuple(self.machines) or (HERE,)
        found = wished or (names[0] if len(names) == 1 else socket.gethostname())
        if found not in names:
            which = "is none of the machines" if wished else "is the name of this machine, and none of those"
            raise ConfigError(f"{found!r} {which} in the file: say --machine {' or '.join(names)}")
        return found

    def settings_of(self, machine: str, *, first: bool = True) -> SystemConfig:
        """The settings of the parts of one machine; the `first` one listens where others come in."""
        network = self.machines.get(machine, self.settings.network or NetworkSettings())
        return self.settings.model_copy(update={"network": network if first else network.beside})

    def settings_text(self, machine: str, *, first: bool = True) -> str:
        """The same as a file that each of them reads."""
        settings = self.settings_of(machine, first=first)
        told: dict[str, Any] = settings.model_dump(mode="json", exclude_unset=True)
        network = settings.network or NetworkSettings()
        return yaml.safe_dump(told | {"network": network.model_dump(mode="json", exclude_unset=True)})

    def parts(self, machine: str) -> tuple[PartToRun, ...]:
        """What runs on one machine."""
        found: list[PartToRun] = []
        if self.agents.machine == machine:
            found.append(PartToRun("agents", ("node", "agents")))
        worlds: dict[tuple[str, str], list[str]] = {}
        for robot in self.robots:
            if robot.machine == machine:
                own = f"{robot.kind}#{robot.name}" if robot.kind else ""
                worlds.setdefault((robot.world, own), []).append(robot.name)
        for (world, own), names in worlds.items():
            words = ["engine", *(("--world", world) if world else ())]
            words += [word for name in names for word in ("--robot", name)]
            words += ("--class", own.rpartition("#")[0]) if own else ()
            found.append(PartToRun(f"robot {' and '.join(names)}", tuple(words)))
        if self.web is not None and self.web.machine == machine:
            page = ["node", "web", "--no-open", "--port", str(self.web.port)]
            page += ["--lan"] if self.web.lan else []
            page += ["--password-file", str(self.web.password_file)] if self.web.password_file else []
            found.append(PartToRun("page", tuple(page)))
        return tuple(found)


def _unfit(told: dict[str, Any]) -> Iterator[InitErrorDetails]:
    """What does not fit together, of parts as they are told: each may be wrong in itself besides."""
    machines, robots = told.get("machines"), told.get("robots")
    known = sorted(machines) if isinstance(machines, dict) and machines else [HERE]
    entries = list(robots) if isinstance(robots, list | tuple) else []
    parts: dict[tuple[str | int, ...], Any] = {("agents",): told.get("agents", {}), ("web",): told.get("web")}
    parts |= {("robots", index): robot for index, robot in enumerate(entries)}
    names: set[str] = set()
    for place, part in parts.items():
        if not isinstance(part, dict):
            continue
        machine, name = part.get("machine", HERE), part.get("name")
        if machine not in known:
            problem = f"there is no machine {machine!r}; there are: {', '.join(map(str, known))}"
            yield wrong_at((*place, "machine"), problem)
        if isinstance(name, str) and place[0] == "robots":
            if name in names:
                yield wrong_at((*place, "name"), f"two robots have the name {name!r}")
            names.add(name)
