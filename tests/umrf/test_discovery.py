"""Finding actions in folders and packages, and keeping up with what changes there."""

from __future__ import annotations

import asyncio
import os
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from parley.clock import WallClock
from parley.errors import ConfigError
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue
from parley.umrf.discovery import ActionFolder, Found, LiveActions, export_descriptors, installed_actions
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph

from .spec_actions import SPECS, join_text

GREET = '''
import asyncio
from dataclasses import dataclass
from parley.umrf.action import action

@dataclass(frozen=True)
class Said:
    text: str

@action(phrases=("greet {name}",), examples=("greet the box",), duration_s=2, timeout_s=5)
async def greet(ctx, name: str) -> Said:
    """Say hello."""
    await asyncio.sleep(DELAY)
    return Said(f"WORD {name}")
'''


def greeting(word: str = "hello", delay_s: float = 0.0) -> str:
    return GREET.replace("WORD", word).replace("DELAY", str(delay_s))


def scanned(folder: Path) -> Found:
    index = ActionFolder(folder)
    index.scan()
    return index.found


def names(specs: tuple[ActionSpec, ...]) -> list[str]:
    return [spec.name for spec in specs]


@pytest.mark.spec("7.1")
def test_files_of_a_folder_and_two_levels_below_are_found(tmp_path: Path) -> None:
    deep = tmp_path / "a" / "b"
    (deep / "c").mkdir(parents=True)
    for folder, name in ((tmp_path, "one"), (tmp_path / "a", "two"), (deep, "three"), (deep / "c", "four")):
        (folder / f"{name}.py").write_text(greeting().replace("greet", name), encoding="utf-8")
    (tmp_path / "_helper.py").write_text("raise SystemExit(1)", encoding="utf-8")
    found = scanned(tmp_path)
    assert sorted(names(found.specs)) == ["One", "Three", "Two"]
    assert found.problems == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("import nothing_of_that_name", "nothing_of_that_name"),
        ("def (:", "SyntaxError"),
        ("import sys; sys.exit(3)", "SystemExit: 3"),
        ("from parley.umrf.action import action\n@action\ndef bad(ctx, what): ...", "TypeError"),
        (
            "from parley.umrf.action import action\n@action(timeout_s=-1)\ndef bad(ctx) -> None: ...",
            "timeout_s must be",
        ),
    ],
)
@pytest.mark.spec("7.1")
def test_a_broken_file_is_told_and_the_others_count(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "bad.py").write_text(text, encoding="utf-8")
    (tmp_path / "good.py").write_text(greeting(), encoding="utf-8")
    found = scanned(tmp_path)
    assert names(found.specs) == ["Greet"]
    (problem,) = found.problems
    assert "bad.py" in problem
    assert words in problem


def test_actions_that_a_file_only_imports_are_not_its_own(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "from parley.actions.inspect import inspect\n" + greeting(), encoding="utf-8"
    )
    assert names(scanned(tmp_path).specs) == ["Greet"]


def test_of_two_actions_of_one_name_the_second_is_told(tmp_path: Path) -> None:
    for file in ("first.py", "second.py"):
        (tmp_path / file).write_text(greeting(), encoding="utf-8")
    found = scanned(tmp_path)
    assert len(found.specs) == 1
    assert "second.py" in found.problems[0]


def test_a_missing_folder_is_said(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no folder"):
        ActionFolder(tmp_path / "nowhere")


@pytest.mark.spec("7.1")
def test_exported_descriptors_are_read_back_with_everything_they_say(tmp_path: Path) -> None:
    (tmp_path / "greet.py").write_text(greeting(), encoding="utf-8")
    (spec,) = scanned(tmp_path).specs
    files = export_descriptors([spec, *SPECS], tmp_path / "out")
    assert "greet.umrf.json" in [file.name for file in files]
    back = {item.name: item for item in scanned(tmp_path / "out").specs}
    assert back.keys() == {"Greet", *(item.name for item in SPECS)}
    read = back["Greet"]
    assert (read.inputs, read.outputs, read.description) == (spec.inputs, spec.outputs, spec.description)
    assert (read.phrases, read.examples) == (("greet {name}",), ("greet the box",))
    assert (read.duration_s, read.timeout_s, read.runner()) == (2.0, 5.0, None)


def test_a_descriptor_beside_its_action_is_no_second_action(tmp_path: Path) -> None:
    (tmp_path / "greet.py").write_text(greeting(), encoding="utf-8")
    export_descriptors(scanned(tmp_path).specs, tmp_path)
    found = scanned(tmp_path)
    assert (names(found.specs), found.problems) == (["Greet"], ())
    assert found.specs[0].runner() is not None


def test_packages_offer_actions_by_entry_points_and_a_broken_one_is_told() -> None:
    group = "parley.actions"
    found = installed_actions(
        [
            EntryPoint("module", "tests.umrf.spec_actions", group),
            EntryPoint("one", "tests.umrf.spec_actions:join_text", group),
            EntryPoint("gone", "no_such_package", group),
            EntryPoint("other", "tests.umrf.spec_actions:PLANNER_CONDITIONS", group),
        ]
    )
    assert {"JoinText", "WaitFor", "NoOp"} <= set(names(found.specs))
    assert len(found.specs) == len(set(names(found.specs)))
    assert len(found.problems) == 2
    assert "no_such_package" in found.problems[0]
    assert "neither a module nor an action" in found.problems[1]


def test_no_installed_package_breaks_the_list() -> None:
    assert installed_actions().problems == ()


async def changed(catalogue: Catalogue, wanted: list[str]) -> None:
    async with asyncio.timeout(10):
        while [spec.name for spec in catalogue] != wanted:  # noqa: ASYNC110
            await asyncio.sleep(0.01)


@pytest.mark.spec("7.1", "D34")
async def test_added_changed_and_removed_files_are_noticed(tmp_path: Path) -> None:
    catalogue, told = Catalogue(), list[str]()
    base = (join_text.spec,)
    async with LiveActions(catalogue, ActionFolder(tmp_path), base, tell=told.append, every_s=0.02):
        await changed(catalogue, ["JoinText"])
        file = tmp_path / "greet.py"
        file.write_text(greeting(), encoding="utf-8")
        await changed(catalogue, ["JoinText", "Greet"])
        assert [info.examples for info in catalogue.infos()] == [(), ("greet the box",)]
        file.write_text(greeting().replace("greet(", "welcome("), encoding="utf-8")
        await changed(catalogue, ["JoinText", "Welcome"])
        (tmp_path / "bad.py").write_text("import nothing_at_all", encoding="utf-8")
        async with asyncio.timeout(10):
            while not told:  # noqa: ASYNC110
                await asyncio.sleep(0.01)
        file.unlink()
        await changed(catalogue, ["JoinText"])
    assert len(told) == 1


@pytest.mark.spec("D34")
async def test_a_running_action_keeps_its_code_and_the_next_run_has_the_new_one(tmp_path: Path) -> None:
    file, catalogue = tmp_path / "greet.py", Catalogue()
    file.write_text(greeting("old", 0.3), encoding="utf-8")
    index = ActionFolder(tmp_path)

    def graph(name: str) -> GraphRun:
        action = {
            "name": "Greet", "type": "sync",
            "input_parameters": {"name": {"pvf_type": "string", "pvf_value": "box"}},
            "output_parameters": {"text": {"pvf_type": "string"}},
        }  # fmt: skip
        return GraphRun(
            read_graph({"graph_name": name, "actions": [action]}), catalogue, actor="A", clock=WallClock(),
            make_context=lambda handle: handle,
        )  # fmt: skip

    index.scan()
    catalogue.replace(index.found.specs)
    old = graph("old")
    old.start()
    await asyncio.sleep(0)
    file.write_text(greeting("new"), encoding="utf-8")
    os.utime(file, ns=(1, 1))
    assert index.scan()
    catalogue.replace(index.found.specs)
    new = graph("new")
    new.start()
    await asyncio.gather(old.wait(), new.wait())
    assert old.outputs("Greet_0") == {"text": "old box"}
    assert new.outputs("Greet_0") == {"text": "new box"}


def test_a_robots_view_of_a_catalogue_follows_its_changes() -> None:
    catalogue = Catalogue()
    view = catalogue.for_robot({"drive"})
    catalogue.replace([join_text.spec])
    assert [info.name for info in view.infos()] == ["JoinText"]
    assert catalogue.capabilities is None
