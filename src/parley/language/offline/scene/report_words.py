"""Where a report is about, and the words that reports are made of."""

from __future__ import annotations

from functools import cache, lru_cache

from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, singular, tokens
from parley.language.word_lists import load_data

__all__ = [
    "TELLERS",
    "after_lead",
    "follows_preposition",
    "ordinary_words",
    "phrase_of",
    "phrases_for",
    "place_named",
    "without_hedges",
    "words_for",
]

_LONGEST_NAME = 6


@cache
def words_for(kind: str) -> frozenset[str]:
    """The words of a kind (`data/incidents.yaml`)."""
    return frozenset(load_data("incidents")[kind])


@cache
def ordinary_words() -> frozenset[str]:
    """Things of two words that are usual, whatever their first word may mean alone ("a water glass")."""
    return frozenset(name for members in lexicon().kinds.values() for name in members if name.count(" ") == 1)


TELLERS = frozenset({"i", "we", "they", "somebody", "someone", "people", "he", "she", "everybody"})


def place_named(words: Phrase, scene: Scene) -> tuple[int, int] | None:
    """Where the place that a report is about stands: the longest name, best behind a preposition."""
    found: list[tuple[int, int]] = []
    index = 0
    while index < len(words):
        sizes = range(min(_LONGEST_NAME, len(words) - index), 0, -1)
        size = next((n for n in sizes if _is_place(words[index : index + n], scene)), 0)
        if size:
            found.append((index, index + size))
        index += size or 1
    behind = [one for one in found if follows_preposition(keys(words), one[0])]
    chosen = behind or found
    return chosen[-1] if chosen else None


def _is_place(words: Phrase, scene: Scene) -> bool:
    part = bare(words)
    if not part or part != words or (keys(part)[-1] in lexicon().determiners and not part[-1].raw.isupper()):
        return False
    if len(part) == 1 and part[0].key in lexicon().small - _names_on(scene):
        return False
    if scene.told_apart(part) is not None:
        return True
    found = scene.ground(part)
    if found.outcome != "match":
        return False
    return set(keys(part)) <= _names_on(scene) or scene.situation.objects == () or _by_synonym(part, scene)


def _by_synonym(part: Phrase, scene: Scene) -> bool:
    names = _names_on(scene)
    return all(
        word.key in names
        or singular(word.key) in names
        or lexicon().synonyms.get(word.key, frozenset()) & names
        for word in part
    )


def _names_on(scene: Scene) -> frozenset[str]:
    return _words_of(tuple(item.description for item in scene.objects))


@lru_cache(maxsize=8)
def _words_of(names: tuple[str, ...]) -> frozenset[str]:
    """All words of some names, as they are compared."""
    return frozenset(key for name in names for key in (*name.lower().split(), *keys(tokens(name))))


def follows_preposition(flat: tuple[str, ...], at: int) -> bool:
    """Whether a preposition of place stands before `at`, articles aside."""
    while at and flat[at - 1] in lexicon().determiners:
        at -= 1
    return any(
        (found := lexicon().places.match(flat, start)) is not None and start + found[0] == at
        for start in range(max(0, at - 4), at)
    ) or (at > 0 and flat[at - 1] in {"from", "about"})


def phrase_of(*parts: str | Phrase) -> Phrase:
    """Words out of texts and phrases, in their order."""
    result: list[Word] = []
    for part in parts:
        result += (Word(text, text) for text in part.split()) if isinstance(part, str) else part
    return tuple(result)


@cache
def phrases_for(kind: str) -> PhraseTable:
    """The phrases of a kind (`data/incidents.yaml`)."""
    return PhraseTable.of(words_for(kind))


def after_lead(words: Phrase, *kinds: str) -> Phrase:
    """What follows the first phrase of some kinds, if that begins within the first few words."""
    flat = keys(words)
    for at in range(min(5, len(flat))):
        size = max((found[0] for kind in kinds if (found := phrases_for(kind).match(flat, at))), default=0)
        if size:
            return words[at + size :]
    return ()


def without_hedges(words: Phrase) -> Phrase:
    """Without "it sounds like" at the start and "it seems" at the end."""
    while (found := phrases_for("hedges").match(keys(words))) is not None and found[0] < len(words) - 2:
        words = words[found[0] :]
    size = phrases_for("hedged").match_end(keys(words))
    return words[: len(words) - size] if 0 < size < len(words) - 2 else words
