"""What the engine says about how it came to an answer."""

from __future__ import annotations

import json
from typing import Any

from typer.testing import CliRunner

from parley.cli import command_line

OBJECTS = [
    {"id": "attic", "description": "attic", "x": 1, "y": 1},
    {"id": "shed", "description": "shed", "x": 5, "y": 1},
]


def answered(message: str, *options: str) -> dict[str, Any]:
    line = json.dumps({"message": message, "objects": OBJECTS}) + "\n"
    done = CliRunner().invoke(command_line(), ["interpret", *options], input=line)
    assert done.exit_code == 0
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer


def explained(message: str) -> list[tuple[str, str]]:
    return [(part["about"], part["text"]) for part in answered(message, "--explain")["explanation"]]


def test_clauses_what_they_want_and_what_is_done_are_told_in_order() -> None:
    told = explained("if the shed is open, go to the attic")
    assert [about for about, _ in told] == ["clause", "clause", "frame", "do"]
    assert told[0][1] == "“the shed is open” (if)"
    assert told[2][1].startswith("“go” is GO with G “to the attic”")
    assert told[-1][1].endswith("GetCoordinates(target: attic), NavigateTo()")


def test_what_is_asked_is_told_with_the_words_that_are_doubtful() -> None:
    assert ("doubtful", "shed") in explained("shed go now the")
    told = explained("to to the shed from please")
    assert ("left over", "from") in told
    assert told[-1][0] == "ask" and "offered: GetCoordinates(target: shed)" in told[-1][1]


def test_answers_are_the_same_with_an_explanation_and_without() -> None:
    quiet, told = answered("go to the shed"), answered("go to the shed", "--explain")
    assert "explanation" not in quiet
    assert quiet["output"] == told["output"]
