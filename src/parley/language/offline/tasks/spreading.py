"""One command for each thing of a group that it names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.marks import marks_of, members_of
from parley.language.offline.tasks.commands import Command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.world.object_map import MapObject

__all__ = ["spread"]

_OF_ONE = {"are": "is", "were": "was", "have": "has", "do": "does", "their": "its", "they": "it"}
_WORDS_THEMSELVES = frozenset({"speak", "answer", "need"})
"""Kinds of commands that repeat words rather than act on what these name."""
_WHERE_SEVERAL = frozenset({"search", "count"})
"""Kinds that are done at one place after the other."""
_TAKING_SEVERAL = frozenset({"motion", "look", "whether", "back"})
"""Kinds that take "A and B" apart themselves."""


def spread(command: Command, objects: Sequence[MapObject]) -> list[Command]:
    """The command once for each thing of the first group in it; empty if it names none."""
    if command.kind in _WHERE_SEVERAL and (each := _at_each(command, objects)):
        return each
    said = (command.theme, command.place, command.source, command.recipient, command.words)
    named = next((phrase for phrase in said if any(marks_of(word) for word in phrase)), ())
    if not named or command.kind in _WORDS_THEMSELVES:
        return []
    if len(coordinated(named)) > 1 and command.kind in _TAKING_SEVERAL:
        return []
    group = next(word for word in named if marks_of(word))
    return [_about(command, group, item, objects) for item in members_of(named, objects)]


def _at_each(command: Command, objects: Sequence[MapObject]) -> list[Command]:
    """For "look for N in A and (in) B" the command once for A and once for B; empty for one place."""
    if "and" not in keys(command.place) or "between" in keys(command.clause):
        return []
    stops = [_without_where(stop) for stop in coordinated(command.place)]
    found = [ground_phrase(stop, objects, strict=True) for stop in stops]
    several = len({one.candidates[0].id for one in found if one.outcome == "match"}) == len(stops) > 1
    if not several:
        return []
    said = (*tokens(command.verb), *command.theme, Word("at", "at"), Word("the", "the"))
    return [replace(command, place=stop, words=(*said[1:], *stop), clause=(*said, *stop)) for stop in stops]


def _without_where(stop: Phrase) -> Phrase:
    found = lexicon().places.match(keys(stop))
    return bare(stop[found[0] :]) if found is not None and found[0] < len(stop) else stop


def _about(command: Command, group: Word, item: MapObject, objects: Sequence[MapObject]) -> Command:
    named = tokens(describe(item, objects))

    def of_one(phrase: Phrase, the: bool) -> Phrase:
        if group not in phrase:
            return phrase
        at = phrase.index(group)
        after = phrase[at + 1 :]
        if after and after[0].key in _OF_ONE:
            verb = _OF_ONE[after[0].key]
            after = (Word(verb, verb), *after[1:])
        article = (Word("the", "the"),) if the and at + 1 <= len(phrase) and not _is_name(named) else ()
        return (*phrase[:at], *article, *named, *after)

    return replace(
        command,
        theme=of_one(command.theme, False),
        place=of_one(command.place, False),
        source=of_one(command.source, False),
        recipient=of_one(command.recipient, False),
        words=of_one(command.words, True),
        clause=of_one(command.clause, True),
    )


def _is_name(words: Phrase) -> bool:
    """Whether it goes without an article ("room 4")."""
    return words[-1].key.isdigit() or len(words[-1].key) == 1
