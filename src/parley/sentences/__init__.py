"""Sentences that robots say, in the language that is wanted.

The English words stand where they are said and are the key: `sentence` keeps them apart from what is filled
in, so that whoever shows the text can say it in another language (`in_language`). A text of which nobody
knows any more what it was made of is looked for among all forms (`forms`). What people said stays as it is.

A language is a file named after it, ``et.yaml``, here or in the folder that ``PARLEY_LANGUAGES`` names.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Annotated, Final, Self

import yaml
from pydantic import AfterValidator

from parley.sentences.forms import Catalogue, ended_once, is_own

__all__ = [
    "LANGUAGES",
    "OWN_LANGUAGES",
    "Sentence",
    "SpokenLanguage",
    "in_language",
    "listed",
    "sentence",
    "together",
]

_LOADER: Final = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
OWN_LANGUAGES: Final = Path(os.environ["PARLEY_LANGUAGES"]) if os.environ.get("PARLEY_LANGUAGES") else None
"""Where whoever runs Parley keeps languages that it does not bring."""
_FOLDERS: Final = (
    resources.files("parley.sentences"),
    *([OWN_LANGUAGES] if OWN_LANGUAGES and OWN_LANGUAGES.is_dir() else []),
)
_FILES: Final = {
    file.name[:-5]: file for folder in _FOLDERS for file in folder.iterdir() if file.name.endswith(".yaml")
}
LANGUAGES: Final = ("en", *sorted(_FILES))
"""English, and those that have a file."""


def _known(language: str) -> str:
    if language not in LANGUAGES:
        raise ValueError(f"there is no language {language}; there are: {', '.join(LANGUAGES)}")
    return language


SpokenLanguage = Annotated[str, AfterValidator(_known)]
"""The name of a language that has a file."""


class Sentence(str):
    """English text that remembers what it was made of."""

    template: str
    values: dict[str, object]

    @classmethod
    def of(cls, template: str, values: dict[str, object]) -> Self:
        """Fill in `values`."""
        made = cls(ended_once(template.format(**values)))
        made.template, made.values = template, values
        return made


def sentence(template: str, **values: object) -> Sentence:
    """A sentence with ``{names}`` filled in; a value may be a sentence itself."""
    return Sentence.of(template, values)


def together(*parts: str) -> Sentence:
    """Several sentences, one after the other; empty ones are left out."""
    told = {f"part{number}": part for number, part in enumerate(part for part in parts if part)}
    return Sentence.of(" ".join(f"{{{name}}}" for name in told), dict(told))


def listed(parts: Sequence[str]) -> Sentence:
    """`parts` with commas between them."""
    told = {f"part{number}": part for number, part in enumerate(parts)}
    return Sentence.of(", ".join(f"{{{name}}}" for name in told), dict(told))


def in_language(text: str, language: SpokenLanguage) -> str:
    """`text` in another language, as far as it is one of these sentences or made of them."""
    if language == "en":
        return str(text)
    catalogue = _catalogue(language)
    if not isinstance(text, Sentence):
        return catalogue.said(text)
    template = text.template
    values = {
        name: in_language(value, language) if isinstance(value, str) and not is_own(template, name) else value
        for name, value in text.values.items()
    }
    return catalogue.filled(template, values)


@cache
def _catalogue(language: SpokenLanguage) -> Catalogue:
    text = _FILES[language].read_text(encoding="utf-8")
    return Catalogue({pair["en"]: pair[language] for pair in yaml.load(text, _LOADER) or ()})
