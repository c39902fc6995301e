"""What an object of the map is called, prepared for comparing with what is said."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import noun_phrase, number_of
from parley.language.offline.words.text import Phrase, singular, split_name, tokens
from parley.world.object_map import MapObject

__all__ = ["Profile", "comparable", "head_of", "is_label", "profile_of", "variants"]

_MAX_VARIANTS = 48


def head_of(words: Sequence[str]) -> str:
    """The head noun of a bare noun phrase's core: its last word (before "of") that is no letter or number."""
    if "of" in words[1:]:
        words = words[: list(words).index("of", 1)]
    for word in reversed(words):
        if not is_label(word):
            return word
    return words[-1] if words else ""


@lru_cache(maxsize=2048)
def variants(core: tuple[str, ...]) -> tuple[tuple[str, ...], ...]:
    """The same noun phrase in other words of the same meaning, the words themselves first."""
    synonyms = lexicon().synonyms
    result: dict[tuple[str, ...], None] = {core: None}
    queue = [core]
    while queue and len(result) < _MAX_VARIANTS:
        words = queue.pop(0)
        for start in range(len(words)):
            for end in range(start + 1, min(start + 3, len(words)) + 1):
                for other in synonyms.get(" ".join(words[start:end]), ()):
                    changed = (*words[:start], *map(singular, other.split()), *words[end:])
                    if changed not in result and len(changed) <= len(core) + 2:
                        result[changed] = None
                        queue.append(changed)
    return tuple(result)


@dataclass(frozen=True, slots=True)
class Profile:
    """An object's words, prepared for comparing."""

    item: MapObject
    names: frozenset[tuple[str, ...]]
    heads: frozenset[str]
    words: frozenset[str]


@lru_cache(maxsize=4096)
def profile_of(item: MapObject) -> Profile:
    """The words of an object: of its description, other names, class and identifier."""
    names: set[tuple[str, ...]] = set()
    heads: set[str] = set()
    words: set[str] = set()
    id_words = tuple(number_of(singular(word)) for word in split_name(item.id))
    for text in (item.description, *item.aliases):
        noun = noun_phrase(tokens(text))
        named = tokens(text)
        while len(named) > 1 and named[0].key in lexicon().determiners:
            named = named[1:]
        names.add(comparable(named))
        heads.update(
            {head_of(noun.core), head_of(noun.core[noun.core.index("of") + 1 :]) if "of" in noun.core else ""}
        )
        words.update(comparable(noun.phrase))
    class_words = tuple(singular(word) for word in split_name(item.class_name))
    if class_words:
        heads.update({class_words[-1], "".join(class_words)})
        words.update(class_words)
    names.add(id_words)
    words.update(id_words)
    return Profile(item, frozenset(names), frozenset(heads - {""}), frozenset(words))


def comparable(phrase: Phrase) -> tuple[str, ...]:
    """The words of a phrase in the form in which they are compared, without articles."""
    articles = {"the", "an"}
    return tuple(
        number_of(singular(word.key))
        for index, word in enumerate(phrase)
        if word.is_word
        and word.key not in articles
        and not (word.key == "a" and index < len(phrase) - 1 and (word.raw != "A" or not index))
    )


def is_label(word: str) -> bool:
    """Whether a word is a letter or a number."""
    return len(word) == 1 or word.isdigit()
