"""The terminal's words: complete in every language, and without the vocabulary of engineers."""

from __future__ import annotations

import re
import string
from pathlib import Path
from typing import get_args

import pytest

import parley.terminal
from parley.messages.status import PlanStep, PlanUpdate, StopReport
from parley.terminal.commands import COMMANDS
from parley.terminal.texts import LANGUAGES, Texts, choose_language

FOLDER = Path(parley.terminal.__file__).parent
JARGON = re.compile(
    r"\b(umrf|nodes?|graphs?|topics?|actors?|engines?|finished|halted|latched|json|queue)\b", re.IGNORECASE
)


def placeholders(text: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


@pytest.mark.parametrize("lang", LANGUAGES)
def test_every_language_says_the_same_things(lang: str) -> None:
    english, other = LANGUAGES["en"], LANGUAGES[lang]
    assert other.keys() == english.keys()
    assert {k: placeholders(v) for k, v in other.items()} == {k: placeholders(v) for k, v in english.items()}


@pytest.mark.parametrize("lang", LANGUAGES)
def test_no_text_uses_words_of_robotics(lang: str) -> None:
    assert [text for text in LANGUAGES[lang].values() if JARGON.search(text)] == []


def test_every_text_that_the_code_names_exists_and_no_other() -> None:
    code = "".join(path.read_text(encoding="utf-8") for path in FOLDER.glob("*.py") if path.stem != "texts")
    named = set(re.findall(r"[\"']([a-z_]+)[\"']", code))
    asked_for = set(re.findall(r"(?:texts|words|_note)\(\s*[\"']([a-z_]+)[\"']", code))
    moods = {*get_args(PlanUpdate.model_fields["state"].annotation), "question", "stopped", "lost"}
    composed = {f"state_{mood}" for mood in moods}
    composed |= {f"step_{state}" for state in get_args(PlanStep.model_fields["state"].annotation)}
    composed |= {f"stop_{state}" for state in get_args(StopReport.model_fields["state"].annotation)}
    composed |= {f"help_{command}" for command in COMMANDS}
    known = set(LANGUAGES["en"])
    assert composed | asked_for <= known
    assert known - composed <= named


@pytest.mark.parametrize(
    ("wanted", "environ", "lang"),
    [
        ("et", {"LANG": "en_US.UTF-8"}, "et"),
        ("", {"LANG": "et_EE.UTF-8"}, "et"),
        ("", {"LC_ALL": "en_GB.UTF-8", "LANG": "et_EE.UTF-8"}, "en"),
        ("", {"LANG": "C.UTF-8"}, "en"),
        ("", {}, "en"),
        ("xx", {}, "en"),
    ],
)
def test_the_language_is_the_wanted_one_else_that_of_the_environment(
    wanted: str, environ: dict[str, str], lang: str
) -> None:
    assert choose_language(wanted, environ) == lang


def test_texts_fill_in_names() -> None:
    assert Texts("et")("joined", robot="Ada") == "Ada on kohal."
