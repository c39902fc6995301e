"""Imports point one way (design section 1): whoever stands lower knows nothing of whoever stands higher."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path
from typing import NamedTuple

import pytest

import parley

SOURCE = Path(parley.__file__).parent

LAYERS: tuple[frozenset[str], ...] = (
    frozenset({"errors", "extras", "logs", "clock", "messages", "config", "files", "latest", "sentences"}),
    frozenset({"transport", "umrf", "memory", "world"}),
    frozenset({"sim"}),
    frozenset({"gate", "language", "robots", "engine", "actions"}),
    frozenset({"agents", "web"}),
    frozenset({"terminal", "site", "system", "api", "demos", "bench", "evaluation", "doctor", "cli"}),
)
"""Rooms by height, lowest first; rooms of one height may know each other."""

NEVER = {
    "umrf": {"transport"},
    "language": {"agents"},
    "actions": {"transport", "engine", "agents", "sim"},
    "sim": {"robots"},
    "terminal": {"agents", "engine", "robots", "sim", "system", "demos", "bench", "cli"},
}
"""What a room must not know although its height would allow it, or so that it never will."""

AGENTS = ("base", "display", "planner", "recovery", "chat")
"""Rooms of `agents` by height: planning knows nothing of repairs, nor these of talk. Rooms that are not named
(rules, the single files) are known by none of the others."""

ONLY_IN = {
    "rclpy": {"transport/ros2.py"},
    "mujoco": {"sim/"},
    "prompt_toolkit": {"terminal/"},
    "typer": {"cli.py", "cli/"},
    "pydantic_ai": {"language/llm/"},
    "openai": {"language/llm/"},
    "argon2": {"web/people/"},
    "webauthn": {"web/people/"},
}
"""Third parties that one place hides from the rest."""


class Import(NamedTuple):
    """One import: where it stands, who imports, and what."""

    where: str
    line: int
    module: str

    @property
    def room(self) -> str:
        return self.where.split("/")[0].removesuffix(".py")

    @property
    def imported_room(self) -> str:
        parts = self.module.split(".")
        return parts[1] if parts[0] == "parley" and len(parts) > 1 else ""


def imports_of(path: Path) -> Iterator[Import]:
    where = path.relative_to(SOURCE).as_posix()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (Import(where, node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = full_name(path, node)
            if module == "parley":
                yield from (Import(where, node.lineno, f"parley.{alias.name}") for alias in node.names)
            else:
                yield Import(where, node.lineno, module)


def full_name(path: Path, node: ast.ImportFrom) -> str:
    """The imported module, also where it was named relative to the importing one."""
    if node.level == 0:
        return node.module or ""
    package = ["parley", *path.relative_to(SOURCE).parts[: -node.level]]
    return ".".join([*package, node.module] if node.module else package)


IMPORTS = [found for path in sorted(SOURCE.rglob("*.py")) for found in imports_of(path)]
HEIGHT = {room: height for height, rooms in enumerate(LAYERS) for room in rooms}


def told(imports: list[Import]) -> list[str]:
    return [f"src/parley/{found.where}:{found.line} imports {found.module}" for found in imports]


def test_every_room_has_its_height() -> None:
    rooms = {path.parent.name for path in SOURCE.glob("*/__init__.py")} | {
        p.stem for p in SOURCE.glob("*.py")
    }
    assert rooms - HEIGHT.keys() - {"__init__", "__main__"} == set()


def test_no_room_imports_a_higher_one() -> None:
    upwards = [
        found
        for found in IMPORTS
        if found.imported_room in HEIGHT and HEIGHT[found.imported_room] > HEIGHT.get(found.room, len(LAYERS))
    ]
    assert told(upwards) == []


@pytest.mark.parametrize("room", NEVER)
def test_a_room_does_not_know_what_it_must_not_know(room: str) -> None:
    known = [found for found in IMPORTS if found.room == room and found.imported_room in NEVER[room]]
    assert told(known) == []


def test_inside_agents_no_room_imports_a_higher_one() -> None:
    height = {room: at for at, room in enumerate(AGENTS)}
    rooms = {path.parent.name for path in SOURCE.glob("agents/*/__init__.py")}
    top = len(AGENTS)
    upwards = [
        found
        for found in IMPORTS
        if found.where.startswith("agents/")
        and (inner := ".".join(found.module.split(".")[2:3])) in rooms
        and found.module.startswith("parley.agents.")
        and (own := found.where.split("/")[1]) != inner
        and height.get(inner, top) >= height.get(own, top)
    ]
    assert told(upwards) == []


@pytest.mark.parametrize("package", ONLY_IN)
def test_a_third_party_stays_in_its_place(package: str) -> None:
    places = tuple(ONLY_IN[package])
    elsewhere = [
        found
        for found in IMPORTS
        if found.module.split(".")[0] == package and not found.where.startswith(places)
    ]
    assert told(elsewhere) == []


def module_name(path: Path) -> str:
    parts = ["parley", *path.relative_to(SOURCE).with_suffix("").parts]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def loaded_by(path: Path, modules: set[str]) -> set[str]:
    """The modules that importing this one loads first: those it names at its top, and their packages."""
    found: set[str] = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            source = full_name(path, node)
            found |= {source} | {f"{source}.{alias.name}" for alias in node.names}
    name = module_name(path)
    packages = {".".join(m.split(".")[:n]) for m in found & modules for n in range(1, m.count(".") + 2)}
    return {m for m in packages & modules if m != name and not name.startswith(f"{m}.")}


def test_modules_do_not_import_each_other_in_a_circle() -> None:
    paths = sorted(SOURCE.rglob("*.py"))
    modules = {module_name(path) for path in paths}
    TopologicalSorter({module_name(path): loaded_by(path, modules) for path in paths}).prepare()


def test_an_upward_import_would_be_found() -> None:
    found = Import("messages/chat.py", 1, "parley.agents.base")
    assert HEIGHT[found.imported_room] > HEIGHT[found.room]
