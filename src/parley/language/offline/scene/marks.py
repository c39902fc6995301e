"""A word that stands for things of the map that were found for a phrase ("aisles 2 to 4", "all doors but A").

Whatever else is read afterwards sees one word where the operator said many; who has to do something with each
thing asks for its members.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from parley.language.offline.words.text import Phrase, Word
from parley.world.object_map import MapObject

__all__ = ["by_ids", "marked", "marks_of", "members_of", "without"]

_LEAD = "things"
_OPEN, _CLOSE = "⟨", "⟩"


def marked(items: Sequence[MapObject], said: str) -> Word:
    """The word for several things.

    Args:
        items: The things, in their order.
        said: The operator's words, for sentences.
    """
    return by_ids([item.id for item in items], said)


def marks_of(word: Word) -> tuple[str, ...]:
    """The identifiers of the things a word stands for; empty for any other word."""
    if not word.key.startswith(_LEAD + _OPEN):
        return ()
    return tuple(word.key[len(_LEAD) + 1 : -1].split(_CLOSE + _OPEN))


def members_of(phrase: Phrase, objects: Sequence[MapObject]) -> list[MapObject]:
    """The things that the first such word of a phrase stands for, in its order; empty if it has none."""
    ids = next((found for word in phrase if (found := marks_of(word))), ())
    by_id = {item.id: item for item in objects}
    return [by_id[one] for one in ids if one in by_id]


def without(word: Word, ids: Collection[str]) -> Word:
    """The word for those things of a group with none of these identifiers; itself if none would be left."""
    kept = [one for one in marks_of(word) if one not in ids]
    return by_ids(kept, word.raw) if kept else word


def by_ids(ids: Sequence[str], said: str) -> Word:
    """The word for the things with these identifiers."""
    return Word(_LEAD + "".join(f"{_OPEN}{one}{_CLOSE}" for one in ids), said)
