"""Whether a message is in another language than English, by the small words of some that are often spoken."""

from __future__ import annotations

import unicodedata
from functools import cache

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase
from parley.language.word_lists import load_data

__all__ = ["ONLY_ENGLISH", "is_foreign"]

ONLY_ENGLISH = "I understand only English, except for stop words. Please say it in English."

_MOST_ENGLISH = 0.34
"""The share of English words up to which a message of strange letters is another language's."""


@cache
def _lists() -> tuple[frozenset[str], dict[str, frozenset[str]]]:
    data = {name: frozenset(words) for name, words in load_data("foreign").items()}
    weak = data.pop("weak")
    return weak, data


def is_foreign(words: Phrase, names: frozenset[str] = frozenset()) -> bool:
    """Whether words are in another language.

    Args:
        words: The words as they were typed.
        names: Words that name something here, in whatever language.
    """
    letters = [char for word in words for char in word.raw if char.isalpha()]
    if letters and sum("LATIN" not in unicodedata.name(char, "") for char in letters) > len(letters) / 2:
        return True
    english_words = lexicon().vocabulary
    said = [word.key for word in words if word.is_word and not word.key.isdigit()]
    said = [word for word in said if word not in names or word in english_words]
    weak, languages = _lists()
    flat = [_folded(word) for word in said]
    scores = {name: sum(word in known for word in flat) for name, known in languages.items()}
    telling = [word for word in flat if word not in weak]
    strictly = {name: sum(word in known for word in telling) for name, known in languages.items()}
    name = max(scores, key=lambda one: (scores[one], strictly[one]))
    strict = strictly[name]
    english = sum(
        word in english_words and (word not in languages[name] or word in _ENGLISH) for word in said
    )
    if strict and scores[name] > 1 and scores[name] > english:
        return True
    strange = [word for word in said if any(ord(char) > 127 and char.isalpha() for char in word)]
    return bool(strange) and len(said) > 1 and scores[name] > 0 and english <= _MOST_ENGLISH * len(said)


_ENGLISH = frozenset({"is", "do", "to", "on", "in", "we", "me", "no", "was", "of", "at", "see", "for", "the"})


def _folded(word: str) -> str:
    """Without accents."""
    plain = unicodedata.normalize("NFD", word.translate(_PLAIN))
    return "".join(char for char in plain if not unicodedata.combining(char))


_PLAIN = str.maketrans({"ł": "l", "ø": "o", "ı": "i", "ß": "ss", "æ": "ae"})
