"""Parts of a group: "any two doors", "at least three of the boxes", "every other chair"."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.group_words import exception_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, singular
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["part_of", "with_exception_behind"]

_FREELY = (
    "at least", "at most", "up to", "no more than", "no fewer than", "not more than", "a minimum of",
    "a maximum of", "any", "some", "just", "only", "whichever", "exactly", "least", "most",
)  # fmt: skip
_LEADS = tuple(sorted((tuple(text.split()) for text in _FREELY), key=len, reverse=True))
_ALL = frozenset({"all", "every", "each", "everything", "both"})


def part_of(
    phrase: Phrase, objects: Sequence[MapObject], pose: Pose2D | None
) -> tuple[MapObject, ...] | None:
    """The things that are meant by a number of equals that anybody may choose, nearest first.

    None if the words ask for no such part, or there are not as many.
    """
    words = tuple(word for word in phrase if word.is_word)
    flat = keys(words)
    if flat[:2] == ("every", "other") and len(flat) > 2:
        group = _group(words[2:], objects)
        return group[::2] if len(group) > 2 else None
    at, freely = 0, False
    while lead := next((lead for lead in _LEADS if flat[at : at + len(lead)] == lead), ()):
        at, freely = at + len(lead), True
    count = _number(flat[at : at + 1])
    if count < 2 or at + 1 >= len(flat):
        return None
    rest = words[at + 1 :]
    of = keys(rest[:1]) == ("of",)
    rest = bare(rest[1:] if of else rest)
    if not rest or singular(_noun(rest)) == _noun(rest):
        return None
    group = _group(rest, objects)
    if (
        len(group) < count
        or (len(group) == count and not freely)
        or (at == 0 and flat[0].isdigit() and not of)
    ):
        return None
    if pose is not None:
        near = sorted(group, key=lambda item: (item.x_m - pose.x_m) ** 2 + (item.y_m - pose.y_m) ** 2)
        return tuple(near[:count])
    return group[:count]


def _noun(words: Phrase) -> str:
    """The word that says what they are: the one before the first that says where."""
    flat = keys(words)
    end = next((i for i in range(1, len(flat)) if lexicon().places.match(flat, i)), len(flat))
    return flat[end - 1]


def _group(words: Phrase, objects: Sequence[MapObject]) -> tuple[MapObject, ...]:
    return ground_phrase(bare(words), objects).candidates


def _number(words: tuple[str, ...]) -> int:
    if not words:
        return 0
    return int(words[0]) if words[0].isdigit() else int(lexicon().numbers.get(words[0], 0))


def with_exception_behind(words: Phrase) -> Phrase:
    """For "apart from A, check all doors": "check all doors except A"."""
    flat = keys(words)
    lead = 0 if flat[:1] in {("but",), ("bar",)} else exception_at(flat, 0)
    comma = next((i for i in range(lead + 1, len(flat)) if flat[i] == ","), 0) if lead else 0
    end = next((i for i in range(comma + 1, len(flat)) if flat[i] in {",", ".", "!", "?", "then"}), len(flat))
    if not comma or comma > lead + 8 or not _ALL & set(flat[comma + 1 : end]):
        return words
    return (*words[comma + 1 : end], Word("except", "except"), *words[lead:comma], *words[end:])
