"""Rules of this house that no other tool holds."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import tomllib
from functools import cache
from pathlib import Path

import pytest

import parley

SOURCE = Path(parley.__file__).parent
ROOT = Path(__file__).parent.parent
DEMOS = SOURCE / "demos"

STORY_WORDS = {
    "john", "david", "refrigerator", "fridge", "bottle", "sofa", "couch", "plant", "tv", "television",
    "bookshelf", "nurse", "dining", "bag", "parking", "elevator",
}  # fmt: skip
"""What the thesis's demonstrations are about, whether or not the data say so."""

EVERYDAY_WORDS = {
    "table", "chair", "door", "room", "wall", "box",
    "a", "an", "and", "at", "by", "in", "near", "next", "of", "on", "the", "to", "with",
    "small", "large", "little", "tall", "big", "long", "low", "round", "left", "right", "middle", "front",
    "back", "first", "corner", "end", "side", "head", "foot", "counter", "desk", "window", "stand", "screen",
    "set", "tree", "top", "shelf", "books", "north", "east", "south", "west",
    "area", "component", "dock", "charging", "loading",
    "b", "c", "black", "blue", "green", "grey", "red", "white",
}  # fmt: skip
"""Words of the demonstrations' data that programs and neutral examples need as well."""

FOREIGN = re.compile(
    "|".join(
        [
            r"(?<![\w.~-])/(?:work|root|mnt|Users)/\w",
            r"(?<![\w.~-])/home/(?!<)\w",
            r"(?<![\w.~-])/tmp/\w",
            "pypi" + r"\.org/(?:simple|packages)",
            "files" + r"\.pythonhosted\.org",
            "registry" + r"\.(?:npmjs\.org|yarnpkg\.com)",
            "(?:--extra-)?index" + "-url",
        ]
    )
)
"""Paths of one machine and addresses of package registries."""


def python_files(folder: Path) -> list[Path]:
    return [path for path in sorted(folder.rglob("*.py")) if "__pycache__" not in path.parts]


def shown(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@cache
def tracked_files() -> tuple[Path, ...]:
    """What belongs to the repository: tracked, or new and not ignored; all files where there is no git."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if listed.returncode == 0:
        return tuple(path for name in listed.stdout.splitlines() if (path := ROOT / name).is_file())
    return tuple(
        path for folder in ("src", "tests", "docs") for path in (ROOT / folder).rglob("*.*") if path.is_file()
    )


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def story_words() -> frozenset[str]:
    """The nouns of the demonstrations: the fixed ones, and every word their object maps name things with."""
    words = set(STORY_WORDS)
    for file in DEMOS.rglob("object_map.json"):
        for class_name, items in json.loads(file.read_text(encoding="utf-8"))["items"].items():
            for item in items:
                names = [class_name, item["description"], *item.get("aliases", [])]
                words.update(re.findall(r"[a-z]+", " ".join(names).lower()))
    return frozenset(words - EVERYDAY_WORDS)


def words_of(text: str) -> set[str]:
    """The words of a program's text, also those inside names like `red_box`, `RedBox` or `boxes`."""
    parts = {part.lower() for part in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", text)}
    return parts | {part.removesuffix("s") for part in parts} | {part.removesuffix("es") for part in parts}


def test_the_product_does_not_know_the_demonstrations() -> None:
    found = {
        shown(path): sorted(known)
        for path in python_files(SOURCE)
        if DEMOS not in path.parents and (known := words_of(path.read_text(encoding="utf-8")) & story_words())
    }
    assert found == {}


def test_a_word_of_the_demonstrations_would_be_found() -> None:
    assert {"fridge", "sofa"} <= words_of("def open_fridge(): return LargeSofas()") & story_words()


def test_no_file_names_a_machine_or_a_package_registry() -> None:
    found = []
    for path in tracked_files():
        if path == Path(__file__):
            continue
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except UnicodeDecodeError:
            continue
        found += [
            f"{shown(path)}:{n}: {line.strip()}" for n, line in enumerate(lines, 1) if FOREIGN.search(line)
        ]
    assert found == []


@pytest.mark.parametrize(
    "text", ["see /" + "work/main", "cd /home/ann", "'/tmp/x'", "https://pypi" + ".org/simple"]
)
def test_a_machines_path_would_be_found(text: str) -> None:
    assert FOREIGN.search(text)


def test_every_module_says_what_it_is_for() -> None:
    silent = [shown(path) for path in python_files(SOURCE) if not ast.get_docstring(tree_of(path))]
    assert silent == []


PAPERS = re.compile(r"\b(?:section \d|contract\b|spec/|docs/|design\.md|umrf\.md)", re.IGNORECASE)
"""Documents that stand in the sources and not with whoever installed the product."""


def test_no_error_cites_a_document_that_a_user_does_not_have() -> None:
    cited = []
    for path in python_files(SOURCE):
        nodes = list(ast.walk(tree_of(path)))
        silent = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}  # what documents the code
        cited += [
            f"{shown(path)}:{node.lineno}"
            for node in nodes
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent
            if PAPERS.search(node.value)
        ]
    assert cited == []


def test_no_exception_is_swallowed_in_silence() -> None:
    swallowed = [
        f"{shown(path)}:{node.lineno}"
        for path in python_files(SOURCE)
        for node in ast.walk(tree_of(path))
        if isinstance(node, ast.ExceptHandler) and is_blind(node) and is_idle(node)
    ]
    assert swallowed == []


OWN_KEYS = {"kind", "name", "language", "table"}
"""Parameters that take words of our own tables, which are few; what people say is never one of them."""


def test_no_cache_grows_without_end() -> None:
    endless = [
        f"{shown(path)}:{node.lineno}: {node.name}"
        for path in python_files(SOURCE)
        for node in ast.walk(tree_of(path))
        if isinstance(node, ast.FunctionDef) and is_endless_cache(node)
    ]
    assert endless == []


def is_endless_cache(function: ast.FunctionDef) -> bool:
    decorators = {ast.unparse(each).removeprefix("functools.") for each in function.decorator_list}
    keys = {each.arg for each in (*function.args.args, *function.args.kwonlyargs)}
    return bool(decorators & {"cache", "lru_cache(None)", "lru_cache(maxsize=None)"}) and not keys <= OWN_KEYS


def is_blind(handler: ast.ExceptHandler) -> bool:
    caught = handler.type
    return caught is None or (isinstance(caught, ast.Name) and caught.id in ("Exception", "BaseException"))


def is_idle(handler: ast.ExceptHandler) -> bool:
    """Whether nothing comes of it: no call (to a log, to a person), no raise, and it is not handed on."""
    nodes = [node for line in handler.body for node in ast.walk(line)]
    is_handed_on = any(isinstance(node, ast.Name) and node.id == handler.name for node in nodes)
    return not is_handed_on and not any(isinstance(node, ast.Call | ast.Raise) for node in nodes)


def test_nothing_is_left_for_later_in_comments() -> None:
    marks = re.compile(r"\b(?:TO" + r"DO|FIX" + r"ME|XX" + r"X)\b")
    found = [
        f"{shown(path)}:{number}"
        for path in tracked_files()
        if path.suffix in (".py", ".md", ".toml", ".yaml", ".yml", "") and path.name != "LICENSE"
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if marks.search(line)
    ]
    assert found == []


def test_the_readme_begins_with_two_commands_that_exist() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in ("demo", "test"):
        assert f"make {target}" in readme
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


def test_every_make_target_that_the_documents_name_exists() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z]+):", makefile, re.MULTILINE))
    documents = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]
    named = {
        target
        for path in documents
        for target in re.findall(r"(?:`|^|  )make ([a-z]+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert named <= targets


def test_every_link_inside_the_documents_leads_somewhere() -> None:
    documents = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
    dead = [
        f"{shown(path)}: {target}"
        for path in documents
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", path.read_text(encoding="utf-8"))
        if not (path.parent / target).exists()
    ]
    assert dead == []


def test_all_that_is_asked_for_is_locked_with_hashes_and_in_one_version() -> None:
    made_of = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    project, groups = made_of["project"], made_of["dependency-groups"]
    extras = project["optional-dependencies"]
    asked = {*project["dependencies"], *groups["build"]}.union(*(extras[x] for x in ("sim", "web", "zenoh")))
    tools = asked.union(*(groups[name] for name in ("dev", "page", "release")))
    # One text each: a name, its version, and the hashes of all its wheels.
    pinned = re.compile(
        r"^([\w.-]+)==(\S+)[^\n]*\\\n(?: +--hash=sha256:[0-9a-f]{64}(?: \\)?\n)+", re.MULTILINE
    )
    texts = {name: (ROOT / name).read_text("utf-8") for name in ("requirements.lock", "constraints.txt")}
    assert {name: pinned.sub("", text) for name, text in texts.items()} == dict.fromkeys(texts, "")
    locked, tested = ({plain(name): version for name, version in pinned.findall(x)} for x in texts.values())
    assert {plain(item) for item in asked} - locked.keys() == set()
    assert {plain(item) for item in tools} - tested.keys() == set()
    assert locked.items() - tested.items() == set()


def plain(requirement: str) -> str:
    """The name of a package as registries compare it."""
    return re.sub(r"[-_.]+", "-", re.split(r"[^\w.-]", requirement, maxsplit=1)[0]).lower()
