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
    frozenset(
        {
            "errors",
            "extras",
            "logs",
            "clock",
            "messages",
            "config",
            "files",
            "latest",
            "pairing",
            "opening",
            "sentences",
        }
    ),
    frozenset({"transport", "umrf", "memory", "world"}),
    frozenset({"sim"}),
    frozenset({"gate", "language", "robots", "engine", "actions", "team"}),
    frozenset({"agents", "web"}),
    frozenset(
        {
            "terminal",
            "network",
            "site",
            "system",
            "engines",
            "deployment",
            "findings",
            "door_check",
            "network_check",
            "robot_check",
            "ros_check",
            "nodes",
            "api",
            "demos",
            "bench",
            "evaluation",
            "doctor",
            "cli",
        }
    ),
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

INSIDE: dict[str, tuple[str, ...]] = {
    # Planning knows nothing of repairs, nor these of talk.
    "agents": ("base", "display", "planner", "recovery", "chat"),
    # Words and prompts know no engine; what is built in and its dialogue know each other.
    "language": ("lexicon", "prompts", "dialogue builtin", "llm"),
    # One backend each; what all share knows none.
    "transport": ("zenoh", "rosbridge", "ros2"),
    "umrf": ("bt",),
    "web": ("people", "routes"),
    "api": (),
}
"""Rooms inside rooms by height: one knows those before it, and those that stand beside it. One that is not
named is known by none of them."""

CLOSED = {
    "language": {"builtin", "llm", "prompts"},
    "transport": {"zenoh", "rosbridge", "ros2"},
    "umrf": {"bt"},
}
"""What the single files of a room, which all others in it use, do not know."""

ONLY_IN = {
    "rclpy": {"transport/ros2/", "bench/rclpy_alone.py"},
    "mujoco": {"sim/"},
    "prompt_toolkit": {"terminal/"},
    "typer": {"cli.py", "cli/"},
    "pydantic_ai": {"language/llm/"},
    "openai": {"language/llm/"},
    "argon2": {"web/people/"},
    "webauthn": {"web/people/"},
    "zenoh": {"transport/zenoh/"},
    "rosbags": {"transport/zenoh/"},
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


def not_below(other: int, own: int, top: int) -> bool:
    return other > own or other == own == top


def inside(room: str) -> list[tuple[str, str, Import]]:
    """Who imports whom inside a room: folders, and single files by their name."""
    rooms = {path.parent.name for path in SOURCE.glob(f"{room}/*/__init__.py")}
    pairs = [
        (found.where.split("/")[1].removesuffix(".py"), ".".join(found.module.split(".")[2:3]), found)
        for found in IMPORTS
        if found.where.startswith(f"{room}/") and found.module.startswith(f"parley.{room}.")
    ]
    return [(own, other, found) for own, other, found in pairs if other in rooms and own != other]


@pytest.mark.parametrize("room", INSIDE)
def test_inside_a_room_none_imports_a_higher_one(room: str) -> None:
    height = {name: at for at, names in enumerate(INSIDE[room]) for name in names.split()}
    top = len(height)
    files = {path.stem for path in SOURCE.glob(f"{room}/*.py")} - height.keys()
    upwards = [
        found
        for own, other, found in inside(room)
        if (own in files and (other in CLOSED.get(room, ()) or other not in height))
        or (own not in files and not_below(height.get(other, top), height.get(own, top), top))
    ]
    assert told(upwards) == []


def test_every_room_with_rooms_inside_has_their_order() -> None:
    assert {path.parent.parent.name for path in SOURCE.glob("*/*/__init__.py")} <= INSIDE.keys()


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
    """The modules that this one names anywhere, for their types too, and the packages of these."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
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
