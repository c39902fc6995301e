"""The demonstration with a model's answers, in several wordings, over HTTP; see `answers`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.demos.runner import play
from parley.files import parse_yaml, read_text
from parley.language.llm.scripted_server import Say, ScriptedServer

FOLDER = Path(__file__).parent / "answers"


def answers(telling: str) -> list[dict[str, Any]]:
    read: list[dict[str, Any]] = parse_yaml(read_text(FOLDER / f"{telling}.yaml"), telling)
    return read


@pytest.mark.parametrize("telling", ["plain", "chatty", "terse"])
async def test_story_holds_with_what_a_model_answers(telling: str, tmp_path: Path) -> None:
    demo, script = load_demo("nursing-home"), answers(telling)
    async with ScriptedServer() as server:
        server.will(*(Say(answer=one.get("answer"), text=one.get("text")) for one in script))
        record = tmp_path / "record.jsonl"
        config = SystemConfig.model_validate(
            {
                "speed": None,
                "data_dir": tmp_path,
                "language": f"local:m@{server.url}",
                "language_fallback": (),
                "model": {"record_file": record},
            }
        )
        result = await play(demo.story, lambda variant: demo.system(config, variant))
        assert result.held, result.text
        kept = [json.loads(line) for line in record.read_text(encoding="utf-8").splitlines()]
        assert [(one["kind"], one["outcome"]) for one in kept] == [
            (one["kind"], "answered") for one in script
        ]
        assert len(server.requests) == len(script) <= 8
        assert "John is thirsty" in kept[-1]["content"]  # what was wanted, and what the looking gave
        assert '"gave": {"inspection_result"' in kept[-1]["content"]
