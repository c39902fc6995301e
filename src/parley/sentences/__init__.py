"""Sentences that robots say of their own accord, in the language that is wanted.

The English words stand where they are said and are the key: `sentence` keeps them apart from what is filled
in, so that whoever puts the text on a topic can say it in another language (`in_language`). Words without
anything to fill in are found as they are. What language engines and people say stays as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import Literal, Self

import yaml

__all__ = ["Sentence", "SpokenLanguage", "in_language", "listed", "sentence", "together"]

SpokenLanguage = Literal["en", "et"]


class Sentence(str):
    """English text that remembers what it was made of."""

    template: str
    values: dict[str, object]

    @classmethod
    def of(cls, template: str, values: dict[str, object]) -> Self:
        """Fill in `values`."""
        made = cls(template.format(**values))
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
    table = _table(language)
    if not isinstance(text, Sentence):
        return table.get(text, text)
    values = {
        name: in_language(value, language) if isinstance(value, Sentence) else value
        for name, value in text.values.items()
    }
    return table.get(text.template, text.template).format(**values)


@cache
def _table(language: SpokenLanguage) -> dict[str, str]:
    """English words -> those of another language."""
    text = (resources.files("parley.sentences") / f"{language}.yaml").read_text(encoding="utf-8")
    return {pair["en"]: pair[language] for pair in yaml.safe_load(text)}
