"""Whose "his room" is: the last one named whose room is known; and who "he" is that is told more of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from parley.language.offline.facts.posts import role_holders
from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.facts.told_here import told_here
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.links import linked_thing
from parley.language.offline.scene.owned import owned_thing
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["with_their_names"]

_THEIR = frozenset({"his", "her", "their"})
_SUBJECTS = frozenset({"he", "she"})
_ANY = _THEIR | _SUBJECTS
_STOPS = frozenset({".", "!", ";"})
_TOLD_OF = lexicon().be | {"has", "sits", "works", "waits", "stands", "lives"}
_SIZES = (3, 2, 1)
_TURNS = 2


def with_their_names(words: Phrase, scene: Scene) -> Phrase:
    """For "A wants it in his room" "A wants it in A's room", if it is known which room that is.

    Args:
        words: All words and punctuation.
        scene: What is known.
    """
    if not _ANY & set(keys(words)):
        return words
    words = _with_subjects(words, scene)
    facts = [*told_here(words), *scene.facts]
    for index, word in enumerate(words):
        if word.key not in _THEIR:
            continue
        for name in _names_before(words[:index], scene):
            whose = (*name[:-1], Word(f"{name[-1].key}'s", f"{name[-1].raw}'s"))
            if any(
                _is_known((*whose, *words[index + 1 : index + 1 + size]), scene, facts) for size in _SIZES
            ):
                return (*words[:index], *whose, *words[index + 1 :])
    return words


def _with_subjects(words: Phrase, scene: Scene) -> Phrase:
    """For "the new doctor is A. She is in B" "... A is in B"."""
    flat = keys(words)
    for index in range(2, len(flat) - 2):
        told = flat[index] in _SUBJECTS and flat[index - 1] in _STOPS and flat[index + 1] in _TOLD_OF
        name = next(_names_in(words[:index], scene), ()) if told else ()
        if name:
            words = (*words[:index], *name, *words[index + 1 :])
            return _with_subjects(words, scene)
    return words


def _is_known(thing: Phrase, scene: Scene, facts: Sequence[Remembered]) -> bool:
    if not thing[-1].is_word or thing[-1].key.endswith("'s"):
        return False
    objects = scene.objects
    known = ground_phrase(thing, objects, strict=True).outcome == "match"
    return known or (owned_thing(thing, objects, facts) or linked_thing(thing, objects, facts)) is not None


def _names_before(words: Phrase, scene: Scene) -> Iterator[Phrase]:
    """Those who were spoken of, the last one first; before this message, those of the last turns."""
    yield from _names_in(words, scene)
    for turn in reversed(scene.situation.history[-_TURNS:]):
        yield from _names_in(tokens(turn.content), scene)


def _names_in(words: Phrase, scene: Scene) -> Iterator[Phrase]:
    flat = keys(words)
    for role, name in role_holders(scene.facts):
        if any(flat[i : i + len(role)] == role for i in range(len(flat))):
            yield name
    end = len(words)
    while end:
        start = end
        while start and words[start - 1].is_capital and words[start - 1].is_word:
            start -= 1
        name = words[start:end]
        if len(name) > 1 and opens_command(name):
            name = name[1:]
        if name and keys(name)[0] not in lexicon().person_pronouns and scene.is_person(name):
            yield name
        end = min(start, end - 1)
