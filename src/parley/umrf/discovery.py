"""Finding actions: in folders of Python files and descriptors, and in installed packages.

A file of a folder is imported under a private name, so that two folders may hold files of the same name and a
changed file is a new module: what runs keeps the code it began with. A file that cannot be imported is a
problem that is told, and the others count. An installed package offers its actions by an entry point::

    [project.entry-points."parley.actions"]
    arm = "my_robot.arm_actions"          # a module, or one action: "my_robot.arm_actions:grasp"
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any, Final, Self

import structlog

from parley.errors import ConfigError, GraphRefusedError
from parley.umrf.action import Action, ActionSpec
from parley.umrf.catalogue import DESCRIPTOR_MARK, Catalogue, descriptor_file_name
from parley.umrf.graph_index import GRAPH_MARK, LEVELS
from parley.umrf.io import read_descriptor, read_graph, write_descriptor
from parley.umrf.model import Graph
from parley.umrf.modules import import_file, private_name

__all__ = ["ENTRY_POINTS", "ActionFolder", "Found", "LiveActions", "export_descriptors", "installed_actions"]

log = structlog.get_logger(__name__)

ENTRY_POINTS: Final = "parley.actions"
"""The group under which packages offer actions."""

INDEX_EVERY_S: Final = 2.0
"""Wall time between two looks at a folder, as in the reference (7.1)."""


@dataclass(frozen=True, slots=True)
class Found:
    """What was found at one place."""

    specs: tuple[ActionSpec, ...] = ()
    graphs: tuple[Graph, ...] = ()
    problems: tuple[str, ...] = ()
    """What was skipped and why, one sentence each."""

    def __add__(self, other: Found) -> Found:
        return Found(self.specs + other.specs, self.graphs + other.graphs, self.problems + other.problems)


@dataclass(slots=True)
class _Known:
    """One file as it was when it was read."""

    stamp: tuple[int, int]
    found: Found = field(default_factory=Found)


class ActionFolder:
    """The actions and graphs in a folder and two levels below it (7.1).

    Python files (`*.py`, those beginning with ``_`` left out), descriptors (`*.umrf.json`) and graphs
    (`*.graph.json`) count. A descriptor only describes; the Python action of its name is what runs.

    Args:
        path: The folder.

    Raises:
        ConfigError: There is no such folder.
    """

    def __init__(self, path: Path) -> None:
        if not path.is_dir():
            raise ConfigError(f"there is no folder {path}")
        self.path = path
        self._files: dict[Path, _Known] = {}

    def scan(self) -> bool:
        """Read what is new or has changed, forget what is gone; whether anything was different.

        Imports run here, so call it in a thread where a loop must not wait.
        """
        stamps = {file: stamp for file in self._list() if (stamp := _stamp(file)) is not None}
        gone = self._files.keys() - stamps.keys()
        changed = [
            file
            for file, stamp in stamps.items()
            if file not in self._files or self._files[file].stamp != stamp
        ]
        for file in gone:
            del self._files[file]
        for file in changed:
            self._files[file] = _Known(stamps[file], _read(file))
        return bool(gone or changed)

    @property
    def found(self) -> Found:
        """Everything as of the last `scan`, Python actions before descriptors; of equal names the first."""
        files = sorted(self._files, key=lambda file: (file.suffix != ".py", file))
        return _without_doubles((file.name, self._files[file].found) for file in files)

    def _list(self) -> Iterator[Path]:
        for level in LEVELS:
            for file in self.path.glob(level):
                is_code = file.suffix == ".py" and not file.name.startswith("_")
                if is_code or DESCRIPTOR_MARK in file.name or GRAPH_MARK in file.name:
                    yield file


def _stamp(file: Path) -> tuple[int, int] | None:
    try:
        status = file.stat()
    except OSError:  # removed meanwhile
        return None
    return status.st_mtime_ns, status.st_size


def _read(file: Path) -> Found:
    try:
        if file.suffix == ".py":
            return Found(specs=_specs_of(import_file(file, private_name(file))))
        text = file.read_text(encoding="utf-8")
        if GRAPH_MARK in file.name:
            return Found(graphs=(read_graph(text),))
        return Found(specs=(read_descriptor(text),))
    except (GraphRefusedError, OSError, UnicodeDecodeError) as error:
        return Found(problems=(f"{file.name} skipped: {error}",))
    except (Exception, SystemExit) as error:  # noqa: BLE001 - somebody else's code, told as a problem
        return Found(problems=(f"{file.name} skipped: {type(error).__name__}: {error}",))


def _specs_of(module: ModuleType) -> tuple[ActionSpec, ...]:
    """The actions that are defined in `module`; those it only imports are somebody else's."""
    return tuple(
        value.spec
        for value in vars(module).values()
        if isinstance(value, Action) and value.__module__ == module.__name__
    )


def _without_doubles(parts: Iterable[tuple[str, Found]]) -> Found:
    specs: dict[str, ActionSpec] = {}
    graphs: dict[str, Graph] = {}
    problems: list[str] = []
    for source, found in parts:
        problems += found.problems
        for spec in found.specs:
            # A descriptor beside the action that it describes is no second action.
            if specs.setdefault(spec.name, spec) is not spec and spec.runner() is not None:
                problems.append(f"{source}: there is an action {spec.name!r} already; this one is left out")
        for graph in found.graphs:
            if graphs.setdefault(graph.name, graph) is not graph:
                problems.append(f"{source}: there is a graph {graph.name!r} already; this one is left out")
    return Found(tuple(specs.values()), tuple(graphs.values()), tuple(problems))


def installed_actions(points: Iterable[EntryPoint] | None = None) -> Found:
    """The actions of installed packages; a package that cannot be imported is a problem, not an end.

    Args:
        points: The entry points to look at; None: those of the group `parley.actions`.
    """
    points = entry_points(group=ENTRY_POINTS) if points is None else points
    return _without_doubles((f"entry point {point.name}", _load(point)) for point in points)


def _load(point: EntryPoint) -> Found:
    try:
        offered: Any = point.load()
    except (Exception, SystemExit) as error:  # noqa: BLE001 - somebody else's code, told as a problem
        return Found(
            problems=(f"entry point {point.name} ({point.value}) skipped: {type(error).__name__}: {error}",)
        )
    if isinstance(offered, ModuleType):
        return Found(specs=_specs_of(offered))
    if isinstance(offered, Action):
        return Found(specs=(offered.spec,))
    return Found(
        problems=(f"entry point {point.name} ({point.value}) skipped: it is neither a module nor an action",)
    )


def export_descriptors(specs: Iterable[ActionSpec], folder: Path) -> list[Path]:
    """Write the ``*.umrf.json`` of each action into `folder`, which is made if need be; the files.

    Raises:
        ConfigError: A file cannot be written.
    """
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for spec in specs:
            file = folder / descriptor_file_name(spec.name)
            file.write_text(write_descriptor(spec) + "\n", encoding="utf-8")
            written.append(file)
    except OSError as error:
        raise ConfigError(f"{error.filename or folder} cannot be written: {error.strerror}") from error
    return written


class LiveActions:
    """Keeps a catalogue up to date with a folder while it is open; use as ``async with``.

    Args:
        catalogue: Gets what is found, behind `base`.
        folder: Where to look.
        base: What is always there; its names win.
        tell: Gets each new problem, for people.
        every_s: Wall time between two looks.
    """

    def __init__(
        self,
        catalogue: Catalogue,
        folder: ActionFolder,
        base: Sequence[ActionSpec] = (),
        *,
        tell: Callable[[str], None] = lambda _: None,
        every_s: float = INDEX_EVERY_S,
    ) -> None:
        self._catalogue, self._folder, self._base = catalogue, folder, tuple(base)
        self._tell, self._every_s = tell, every_s
        self._told: set[str] = set()
        self._task: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        await asyncio.to_thread(self._folder.scan)
        self._take_over()
        self._task = asyncio.create_task(self._watch(), name="action index")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait([self._task])

    async def _watch(self) -> None:
        while True:
            await asyncio.sleep(self._every_s)
            if await asyncio.to_thread(self._folder.scan):
                self._take_over()

    def _take_over(self) -> None:
        found = _without_doubles(
            [("", Found(specs=self._base)), (self._folder.path.name, self._folder.found)]
        )
        self._catalogue.replace(found.specs, found.graphs)
        for problem in found.problems:
            if problem not in self._told:
                log.warning("action skipped", reason=problem)
                self._tell(problem)
        self._told = set(found.problems)
