"""The terminal's words: in every language, and without the vocabulary of engineers."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import get_args

import pytest

import parley.terminal
from parley.messages.status import PlanStep, PlanUpdate, StopReport
from parley.sentences import LANGUAGES, in_language
from parley.terminal.client import language_of
from parley.terminal.commands import COMMANDS
from parley.terminal.plan import STATES
from parley.terminal.view import MOODS, STOPS

FOLDER = Path(parley.terminal.__file__).parent
JARGON = re.compile(
    r"\b(umrf|nodes?|graphs?|topics?|actors?|engines?|finished|halted|latched|json|queue)\b", re.IGNORECASE
)


def own_words() -> set[str]:
    """What the terminal says itself: whole sentences, whatever is handed to `say`, and its tables."""
    found = {*MOODS.values(), *STATES.values(), *STOPS.values(), *(does for _, does in COMMANDS.values())}
    for file in FOLDER.glob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in ("say", "_note"):
                found |= {str(text.value) for text in node.args if isinstance(text, ast.Constant)}
            elif isinstance(node, ast.Constant) and id(node) not in docstrings:
                found |= set(re.findall(r"^[A-Z{].* .*\.$", str(node.value)))
    return found


def test_every_word_of_the_terminal_is_there_in_every_language_and_none_is_of_robotics() -> None:
    words = own_words()
    assert {"{robot} is here.", "{robot}'s plan:", "no contact"} <= words
    assert [text for text in words if JARGON.search(text)] == []
    others = [language for language in LANGUAGES if language != "en"]
    assert [text for text in words for other in others if in_language(text, other) == text] == []
    moods = {*get_args(PlanUpdate.model_fields["state"].annotation), "question", "stopped", "lost"}
    assert moods == set(MOODS)
    assert set(get_args(PlanStep.model_fields["state"].annotation)) == set(STATES)
    assert set(get_args(StopReport.model_fields["state"].annotation)) == set(STOPS)


@pytest.mark.parametrize(
    ("environ", "lang"),
    [
        ({"LANG": "et_EE.UTF-8"}, "et"),
        ({"LC_ALL": "en_GB.UTF-8", "LANG": "et_EE.UTF-8"}, "en"),
        ({"LANG": "C.UTF-8"}, "en"),
        ({}, "en"),
    ],
)
def test_the_language_is_that_of_the_environment(environ: dict[str, str], lang: str) -> None:
    assert language_of(environ) == lang
