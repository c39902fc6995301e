"""People as they are told apart: by name, by what they do, by what they wear, and where they are.

"The man in the red coat who sits by the window" is one description and one place. What is worn and how
somebody holds themselves belongs to the description; what the map knows is where they are.
"""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, singular
from parley.language.word_lists import load_data

__all__ = ["Somebody", "map_name_end", "read_somebody"]

_DATA = load_data("people")
_WORN = frozenset(_DATA["worn"])
_POSTURE = frozenset(_DATA["posture"])
_GENERAL = frozenset(_DATA["general"])
_ENDS = frozenset(_DATA["ends"])
_MOST_BEFORE = 3
"""How many words may stand between an article and "man"."""
_LONGEST_NAME = 5


@dataclass(frozen=True, slots=True)
class Somebody:
    """A person, or several, as a message describes them."""

    who: Phrase
    """By what they are told apart, without article and place."""
    where: Phrase
    """What on the map they are at; empty if that is not said."""
    size: int
    """How many words were read."""
    named: bool = False
    """Whether it is a name."""

    @property
    def described(self) -> bool:
        """Whether more is said than "the man" or a name."""
        return not self.named and len(self.who) > 1


def read_somebody(words: Phrase, scene: Scene) -> Somebody | None:
    """Who the words begin with; None if that is nobody, or at a place that nobody knows.

    Args:
        words: What follows a verb or a preposition.
        scene: What is known.
    """
    head, named = _head(words, scene)
    if head is None:
        return None
    end = head
    flat = keys(words)
    while end < len(words) and not _ends(flat, end):
        at = lexicon().places.match(flat, end)
        if at is not None and at[1] not in {"of", "with", "from"}:
            size = map_name_end(words[end + at[0] :], scene)
            if size:
                who, stop = words[:end], end + at[0] + size
                rest = _said_behind(words, stop)
                return Somebody(
                    _without_link(bare((*who, *words[stop:rest]))),
                    bare(words[end + at[0] : stop]),
                    rest,
                    named,
                )
            size = _of_looks(flat, end + at[0])
            if not size:
                return None
            end += at[0] + size
            continue
        if flat[end] in {"in", "with", "wearing", "to", "on", "has", "carrying"} and _of_looks(flat, end + 1):
            end += 1 + _of_looks(flat, end + 1)
            continue
        end += 1
    return Somebody(bare(words[:end]), (), end, named)


def _without_link(who: Phrase) -> Phrase:
    """Without "is" at the end of "whoever is (in the hall)"."""
    while len(who) > 1 and who[-1].key in lexicon().be | {"who", "that"}:
        who = who[:-1]
    return who


def map_name_end(words: Phrase, scene: Scene) -> int:
    """How many words at the start name something on the map; 0 if none do."""
    for size in range(min(_LONGEST_NAME, len(words)), 0, -1):
        part = words[:size]
        last = part[-1].key
        dangling = last in lexicon().determiners | lexicon().goals_and_places or not part[-1].is_word
        if dangling or not bare(part):
            continue
        if ground_phrase(bare(part), scene.objects, strict=True).outcome != "none":
            return size
    return 0


def _head(words: Phrase, scene: Scene) -> tuple[int | None, bool]:
    """Where "man" in "the old man" ends, or a name; whether it is a name."""
    flat = keys(words)
    lex = lexicon()
    if not flat or flat[0] in lex.person_pronouns | lex.operator_pronouns | {"it", "that", "this"}:
        return None, False
    for size in (2, 1):
        named = words[:size]
        titled = len(named) == size and all(word.is_capital for word in named)
        kind = flat[0] in lex.determiners or singular(named[-1].key) in lex.person_words
        if titled and not kind and scene.is_person(named):
            return size, True
    start = 0
    while start < len(flat) and flat[start] in lex.determiners | lex.quantifiers | {"of"}:
        start += 1
    for index in range(start, min(start + _MOST_BEFORE, len(flat))):
        if _is_human(words[index], scene) or flat[index] in _GENERAL:
            alone = flat[index] == "one" and not _tells_apart(flat, index + 1)
            return (None, False) if alone else (index + 1, False)
        if lex.places.match(flat, index) is not None or flat[index] in _ENDS | {"of"}:
            break
    return None, False


def _is_human(word: Word, scene: Scene) -> bool:
    """Whether a noun is one for people."""
    if singular(word.key) in lexicon().person_words:
        return True
    return (
        not word.is_capital
        and word.is_word
        and word.key not in lexicon().vocabulary
        and scene.is_person((word,))
    )


def _tells_apart(flat: tuple[str, ...], at: int) -> bool:
    return at < len(flat) and (
        flat[at].endswith("ing") or flat[at] in {"who", "in", "with", "at", "on", "by"}
    )


def _ends(flat: tuple[str, ...], at: int) -> bool:
    """Whether what is said of somebody is over before a word."""
    if flat[at] not in _ENDS:
        return False
    be = lexicon().be | {"has", "wears", "have"}
    if flat[at] == "that" and flat[at + 1 : at + 2] and flat[at + 1] in be:
        return False
    if flat[at] in {"a", "an", "the"} and flat[at - 1] in {
        "wearing",
        "wears",
        "carrying",
        "holding",
        "raising",
        "has",
    }:
        return False
    if flat[at] in {"your", "my"}:
        return True
    return not (flat[at] == "to" and _of_looks(flat, at + 1))


def _of_looks(flat: tuple[str, ...], start: int) -> int:
    """How many words from `start` on are about clothes or a posture: "a green coat", "the left"."""
    for index in range(start, min(start + 4, len(flat))):
        word = singular(flat[index])
        if word in _POSTURE or (word in _WORN and not _more_worn(flat, index + 1)):
            return index + 1 - start
    return 0


def _more_worn(flat: tuple[str, ...], index: int) -> bool:
    return index < len(flat) and singular(flat[index]) in _WORN


def _said_behind(words: Phrase, start: int) -> int:
    """Where words end that go on about somebody behind their place: "(the man in the hall) wearing a hat"."""
    flat = keys(words)
    if not _tells_apart(flat, start) or flat[start] in {"at", "on", "by"}:
        return start
    if flat[start] in {"in", "with"} and not _of_looks(flat, start + 1):
        return start
    end = start + 1
    while end < len(flat) and not (_ends(flat, end) and not _of_looks(flat, end)):
        end += 1
    return end
