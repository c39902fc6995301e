"""Typing errors in small words and verbs put right before anything else; nouns are compared loosely later."""

from __future__ import annotations

from functools import cache

from parley.language.base import Situation
from parley.language.offline.lexicon import lexicon
from parley.language.offline.text import Phrase, mend, split_name, tokens

__all__ = ["mended"]


def mended(words: Phrase, situation: Situation) -> Phrase:
    """Typing errors in small words and verbs put right; nouns are compared loosely later."""
    known = set(lexicon().vocabulary)
    for item in situation.objects:
        known.update(
            word.key
            for text in (item.description, *item.aliases, item.class_name, item.id)
            for word in tokens(text)
        )
    for entry in situation.memory:
        known.update(word.key for word in tokens(entry.data[:400]))
    for info in situation.catalogue:
        known.update(split_name(info.name))
    known.update(name.lower() for name in situation.robots)
    return _without_haste(mend(words, frozenset(known), lexicon().often_mistyped, _verbs()))


_HASTE = frozenset(
    ["quick", "brief", "short", "close", "closer", "good", "proper", "careful", "thorough", "little", "nice"]
)
_DEEDS = frozenset(["look", "peek", "glance", "visit", "picture", "photo", "trip", "stop", "check", "round"])


def _without_haste(words: Phrase) -> Phrase:
    """For "have a quick look" reads "have a look": how it is done changes nothing."""
    flat = tuple(word.key for word in words)
    return tuple(
        word
        for index, word in enumerate(words)
        if not (
            word.key in _HASTE
            and flat[index - 1 : index] in {("a",), ("another",)}
            and flat[index + 1 : index + 2]
            and flat[index + 1] in _DEEDS
        )
    )


@cache
def _verbs() -> frozenset[str]:
    """First words of the verbs that typing errors are mended to."""
    classes = lexicon().verb_classes
    return frozenset(verb.split()[0] for name, verbs in classes.items() if name != "other" for verb in verbs)
