"""What people tell around an order: it is no order, but the things it names may be meant by what follows."""

from __future__ import annotations

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, lemma

__all__ = ["mentioned", "told_around"]

_TELLERS = frozenset([
    "i", "we", "they", "he", "she", "it", "there", "today", "yesterday", "tomorrow", "tonight",
    "somebody", "someone", "everybody", "everyone", "nobody", "something", "because", "since", "as",
    "while", "although", "my", "our", "this", "that", "these", "those", "the", "a", "an", "his", "her",
    "your", "one", "some", "people",
])  # fmt: skip
_LONGEST_NAME = 5


def told_around(words: Phrase) -> bool:
    """Whether a clause tells something, as against a garbled order: who or when comes first."""
    flat = keys(words)
    if not flat or opens_command(words):
        return False
    if flat[0] in _TELLERS or (
        words[0].is_capital and len(words) > 1 and words[1].key not in lexicon().vocabulary
    ):
        return True
    return any(lemma(word) != word for word in flat[1:4])


def mentioned(words: Phrase, scene: Scene) -> list[Phrase]:
    """The objects of the map that a clause names, longest names first, in their order."""
    found: list[Phrase] = []
    index = 0
    while index < len(words):
        for size in range(min(_LONGEST_NAME, len(words) - index), 0, -1):
            part = bare(words[index : index + size])
            if (
                not part
                or any(not word.is_word for word in part)
                or (part[0].key in lexicon().vocabulary and size == 1)
            ):
                continue
            if ground_phrase(part, scene.objects, strict=True).outcome == "match":
                found.append(part)
                index += size - 1
                break
        index += 1
    return found
