"""What only a machine or a driver could do: driving a vehicle, lifting a load, moving what is too heavy."""

from __future__ import annotations

from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.tasks.commands import Command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import noun_phrase
from parley.language.offline.words.text import Phrase, keys, singular
from parley.language.word_lists import load_data

__all__ = ["needs_machine"]

_DATA = load_data("heavy")
_HEAVY = frozenset(_DATA["heavy"])
_SMALL = frozenset(_DATA["small"])
_STEERED = frozenset(_DATA["steered"])
_LIFTED = frozenset(_DATA["lifted"])
_ONTO = frozenset(_DATA["onto"])
_BOARD = frozenset({"you", "yourself", "me", "board", "us"})
_BEHIND = _ONTO | {"of", "at", "over", "through", "next", "behind", "past", "across", "back", "around"}
_MOVED = frozenset({"transfer", "grasp", "place"})


def needs_machine(command: Command, catalogue: Catalogue) -> bool:
    """Whether an order is nothing that somebody could help the robot with by putting a thing on it.

    Args:
        command: What is asked for, which no action of its own kind does.
        catalogue: What the robot can do.
    """
    flat = keys(command.clause)
    if (
        flat[1:2]
        and flat[0] in _STEERED
        and flat[1] in lexicon().determiners
        and _is_heavy(command.clause[1:])
    ):
        return True
    if command.kind not in _MOVED or catalogue.with_role("fetch", "grasp", "place") is not None:
        return False
    if command.theme and _is_heavy(command.theme) and not _handled(command.theme, catalogue):
        return True
    lifts = bool(flat) and flat[0] in _LIFTED
    return lifts and bool(_ONTO & set(flat[2:])) and not _BOARD & set(flat[1:])


def _handled(words: Phrase, catalogue: Catalogue) -> bool:
    """Whether an action says that it is about such a thing ("lift_pallet")."""
    said = {singular(word) for word in noun_phrase(words).core} & _HEAVY
    texts = (f"{' '.join(name_words(info.name))} {info.description.lower()}" for info in catalogue.infos)
    return any(said & {singular(word) for word in text.split()} for text in texts)


def _is_heavy(words: Phrase) -> bool:
    """Whether what is named cannot be carried; "the car keys" and "a toy train" can."""
    end = next((i for i in range(1, len(words)) if words[i].key in _BEHIND), len(words))
    core = [singular(word) for word in noun_phrase(words[:end]).core if word.isalpha() and len(word) > 1]
    return bool(core) and core[-1] in _HEAVY and not _SMALL & set(core)
