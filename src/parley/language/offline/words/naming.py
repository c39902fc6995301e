"""What an action is good for by any word of its name, where the words it begins with do not tell.

"person_search", "BaseMove" and "tts" are names of actions, too. What their inputs are for must agree.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import cache, lru_cache

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import lemma, split_name
from parley.language.word_lists import load_data

__all__ = ["kind_of", "name_words", "role_by_any_word", "told_deed"]

_SHORT: dict[str, list[str]] = {short: text.split() for short, text in load_data("names")["short"].items()}
_KINDS: dict[str, str] = {
    other: kind for kind, others in load_data("names")["types"].items() for other in (kind, *others)
}


@lru_cache(maxsize=4096)
def name_words(name: str) -> tuple[str, ...]:
    """The words of a name in any style, written out: "navGoal" is navigate, goal; "takeoff" take, off."""
    parts = (part for part in split_name(name) if not part.isdigit())
    words = tuple(word for part in parts for word in (_SHORT.get(part) or [_written_out(part)]))
    return (_deed_of(words[0]), *words[1:]) if len(words) > 1 else words


def _deed_of(word: str) -> str:
    """The base form of a name's first word that no list has, by the rules of spelling ("skimming": skim)."""
    if not word.endswith("ing") or len(word) < _SHORTEST_ING or lemma(word) != word:
        return word
    stem = word.removesuffix("ing")
    if not _VOWELS & set(stem) or word in lexicon().nouns or lexicon().verbs.match((word,)) is not None:
        return word
    if stem[-1] == stem[-2]:
        return stem if stem[-1] in "lsfz" else stem[:-1]
    silent = stem[-1] in "cvuz" or (stem[-1] == "l" and stem[-2] not in _VOWELS | {"w", "r"})
    return stem + "e" if silent or re.search(r"[^aeiou]at$|dg$|[^s]s$", stem) else stem


_SHORTEST_ING = 6


def _written_out(part: str) -> str:
    """For "vlv" "valve": the one word that is left without its vowels, deeds before things; else as it is."""
    if len(part) < _SHORTEST or _VOWELS & set(part[1:]):
        return part
    for words in _whole_words():
        found = {word for word in words if word[0] == part[0] and _without_vowels(word) == part}
        if found:
            return min(found) if len(found) == 1 else part
    return part


_SHORTEST = 3
_VOWELS = frozenset("aeiou")


def _without_vowels(word: str) -> str:
    """What is left of a word without its vowels, double letters once."""
    kept = word[0] + "".join(letter for letter in word[1:] if letter not in _VOWELS)
    return re.sub(r"(.)\1", r"\1", kept)


@cache
def _whole_words() -> tuple[frozenset[str], ...]:
    """What names may be short for: verbs, then what deeds are about, then things at large."""
    deeds = load_data("deeds")
    verbs = {words.split()[0] for kind in lexicon().verb_classes.values() for words in kind}
    listed = [
        {word for line in deeds[kind] for word in line if " " not in word} for kind in ("verbs", "nouns")
    ]
    return tuple(frozenset(words) for words in (verbs, *listed, lexicon().nouns))


def kind_of(kind: str) -> str:
    """The native type that a type's name stands for ("float" is "number", "low|high" words), else itself."""
    if "|" in kind or kind.lower().startswith(("enum", "literal")):
        return "string"
    return _KINDS.get(kind.lower(), kind)


_ROLES = {
    role: (frozenset(entry["words"]), frozenset(entry["needs"]), frozenset(entry["without"]))
    for role, entry in load_data("names")["by_any_word"].items()
}


def role_by_any_word(name: str, inputs: Collection[str]) -> frozenset[str]:
    """What an action is good for; empty if its name tells nothing, or two things.

    Args:
        name: Of the action.
        inputs: What each of its inputs in words is for: place, person, text, object, or empty.
    """
    words = {word for part in name_words(name) for word in (part, lemma(part))}
    found = {
        role
        for role, (telling, needs, without) in _ROLES.items()
        if words & telling
        and not words & without
        and (needs & set(inputs) or (role == "answer" and not inputs))
    }
    if len(found) > 1:
        found -= {"motion"}
    return frozenset(found) if len(found) == 1 else frozenset()


def told_deed(description: str) -> tuple[str, ...]:
    """The words of a description from its deed on: in "Goes to A and oils it" it is what is done there."""
    told = tuple(re.findall(r"[a-z]+", description.lower()))
    moves = bool(told) and (lexicon().verbs.match((lemma(told[0]),)) or (0, ""))[1].startswith("motion:")
    at = told.index("and") + 1 if moves and "and" in told[:-1] else 0
    return told[at:]
