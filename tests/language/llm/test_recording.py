"""Exchanges that were recorded, played again without any server."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from parley.agents.planner.check import plan_problems
from parley.config import ModelSettings
from parley.errors import ConfigError, FileFormatError, LanguageError
from parley.language.base import Language
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.llm import build_language
from parley.language.llm.scripted_server import Say
from parley.messages.memory import MemoryEntry
from tests.language.llm.rig import LOOK_PLAN, LOOKS, model, situation

HERE = Path(__file__).parent

THESIS_QUERY = "Go to the package."
THESIS_MEMORIES = [
    MemoryEntry(name="package_location", info="Packages stored in area A", data="Packages stored in area A"),
    MemoryEntry(
        name="maintenance_warning",
        info="Area A closed for maintenance, using area B temporarily",
        data="Area A closed for maintenance, using area B temporarily",
    ),
    MemoryEntry(name="temperature", info="Weather outside is -4°C", data="Weather outside is -4°C"),
]
"""The example of thesis 4.3.8.3."""


def replay(file: Path) -> Language:
    return build_language([f"replay:{file}"], ModelSettings(), check=plan_problems)


async def test_recorded_exchange_is_played_again_with_its_corrections(tmp_path: Path) -> None:
    file = tmp_path / "exchanges.jsonl"
    async with model(record_file=file) as asked:
        asked.will(Say(answer=LOOK_PLAN | {"queue": [{"action": "Fly"}]}), LOOKS)
        first = await asked.language.interpret(situation())
    assert await replay(file).interpret(situation()) == first


async def test_question_that_was_not_recorded_has_no_answer(tmp_path: Path) -> None:
    file = tmp_path / "exchanges.jsonl"
    async with model(record_file=file) as asked:
        asked.will(LOOKS)
        await asked.language.interpret(situation())
    with pytest.raises(LanguageError, match="no answer to this"):
        await replay(file).interpret(situation("something else"))


async def test_recording_holds_what_a_bug_report_needs(tmp_path: Path) -> None:
    file = tmp_path / "exchanges.jsonl"
    async with model(record_file=file, corrections=0) as asked:
        asked.will(LOOKS, Say(text="hm"))
        await asked.language.interpret(situation())
        with pytest.raises(LanguageError):
            await asked.language.interpret(situation())
    good, bad = (json.loads(line) for line in file.read_text(encoding="utf-8").splitlines())
    assert good["prompt_version"].startswith("interpret-")
    assert "look at the box" in good["content"]
    assert good["instructions"]
    assert (good["outcome"], bad["outcome"]) == ("answered", "failed")
    assert bad["responses"][0]["parts"][0]["content"] == "hm"


def test_file_that_is_no_recording_is_named(tmp_path: Path) -> None:
    file = tmp_path / "other.jsonl"
    file.write_text('{"x": 1}\n', encoding="utf-8")
    with pytest.raises(FileFormatError, match=r"other.jsonl, line 1"):
        replay(file)
    file.write_text("", encoding="utf-8")
    with pytest.raises(ConfigError, match="no answers"):
        replay(file)


async def test_memories_of_the_thesis_example_are_picked_by_a_model(tmp_path: Path) -> None:
    file, wanted = tmp_path / "exchanges.jsonl", ["package_location", "maintenance_warning"]
    many = [*THESIS_MEMORIES, *(MemoryEntry(name=f"shelf_{n}", data="It is full.") for n in range(20))]
    async with model(record_file=file) as asked:
        labels = [f"m{index}" for index, entry in enumerate(many, 1) if entry.name in wanted]
        asked.will(Say(answer={"names": labels}))
        await asked.language.select_memories(THESIS_QUERY, many)
        told = asked.server.requests[0].texts[-1]
    for entry in THESIS_MEMORIES:
        assert told.count(entry.info) == 1
    assert await replay(file).select_memories(THESIS_QUERY, many) == wanted


async def test_memories_of_the_thesis_example_are_picked_without_a_model() -> None:
    picked = await BuiltinLanguage().select_memories(THESIS_QUERY, THESIS_MEMORIES)
    assert picked == ["package_location", "maintenance_warning"]
