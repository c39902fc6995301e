"""What the page is told, in the language in which its person reads it.

Robots are understood and remembered in English; their words are put into another language where they are
shown, for each page its own. What people said stays, and so does what is sent back: choices and steps.
"""

from __future__ import annotations

from typing import Annotated, Any, Final

from fastapi import Depends, Request
from pydantic import BaseModel

from parley.sentences import LANGUAGES, SpokenLanguage, in_language

__all__ = ["Reader", "language_of", "shown_in"]

_WORDED: Final = frozenset(
    {
        "message",
        "label",
        "progress_text",
        "reason",
        "why",
        "description",
        "help",
        "changes",
        "note",
        "asked",
        "tried",
    }
    | {"lines", "left", "closing"}
    | {"language", "detail", "remedy", "title"}
)
"""Fields that hold what is said to people."""
_KEPT: Final = frozenset({"call", "inputs", "outputs", "author", "answered"})
"""What is sent back as it is, or was said by people."""


def language_of(accepted: str) -> SpokenLanguage:
    """The language that a browser asks for first, as far as it is known here."""
    wanted = accepted.partition(",")[0].partition(";")[0].partition("-")[0].strip().lower()
    return wanted if wanted in LANGUAGES else "en"


def shown_in(language: SpokenLanguage, what: Any) -> Any:
    """What is told of a model, as JSON, in a language."""
    data = what.model_dump(mode="json") if isinstance(what, BaseModel) else what
    return data if language == "en" else _shown(data, language)


def _shown(data: Any, language: SpokenLanguage) -> Any:
    if isinstance(data, list):
        return [_shown(item, language) for item in data]
    if not isinstance(data, dict) or data.get("who") == "operator":
        return data
    shown = {name: value if name in _KEPT else _field(name, value, language) for name, value in data.items()}
    for said in ("choices", "examples"):
        if f"shown_{said}" in data:
            shown[f"shown_{said}"] = [in_language(text, language) for text in data[said]]
    return shown


def _field(name: str, value: Any, language: SpokenLanguage) -> Any:
    if name in _WORDED and isinstance(value, str):
        return in_language(value, language)
    if name in _WORDED and isinstance(value, list) and all(isinstance(item, str) for item in value):
        return [in_language(item, language) for item in value]
    return _shown(value, language)


def _reader(request: Request) -> SpokenLanguage:
    return language_of(request.headers.get("accept-language", ""))


Reader = Annotated[SpokenLanguage, Depends(_reader)]
"""The language of whoever asks."""
