"""What the name of an action says: its deed, what that is about, and what its inputs are called."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from parley.language.offline.tasks.roles import parameter_role
from parley.language.offline.words.concepts import LIGHT_VERBS, VERB_LINES, Concept, concepts
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words, told_deed
from parley.language.offline.words.text import singular
from parley.language.word_lists import load_data

__all__ = ["EMPTY", "ENDING", "STATES", "VAGUE", "Signature", "signature_of"]

_DATA = load_data("names")
EMPTY = frozenset(_DATA["empty"] + _DATA["small"])
"""Small words of names, descriptions and orders."""
VAGUE = frozenset(_DATA["vague"])
"""Words of names and descriptions that tell no action from another."""
STATES = frozenset({"on", "off", "up", "down"})
_PARTICLES = STATES | {"in", "out", "over", "away", "back"}
_PEOPLE = lexicon().person_words | {"human", "people", "staff", "crew", "team"}


@dataclass(frozen=True, slots=True)
class Signature:
    """An action's name taken apart."""

    verb: Concept | None
    about: tuple[Concept, ...]
    """What its name names besides."""
    typed: frozenset[str]
    described: tuple[Concept, ...]
    doing: Concept | None
    """The verb of its description."""
    second: Concept | None = None
    """Another deed that its name says ("spray_paint")."""
    starting: bool = False
    """Whether its name says that its deed begins ("start_mowing")."""


@lru_cache(maxsize=2048)
def signature_of(name: str, inputs: tuple[str, ...], description: str) -> Signature:
    """Take an action's name apart.

    Args:
        name: Of the action.
        inputs: What its inputs are called.
        description: What it says of itself.
    """
    words = _compounds(name_words(name))
    typed = frozenset(singular(word) for one in inputs for word in name_words(one.replace("::", "_")))
    parts = _segments(words)
    verb = next((part for part in parts if _is_verb(part) and not _several(words, part.at)), None)
    if (
        verb is not None
        and parts[0] is not verb
        and not parts[0].lines
        and parts[0].text not in lexicon().nouns
        and verb.text in lexicon().nouns
    ):
        verb = parts[0]
    if verb is None and len(parts) > 1 and not parts[0].lines and parts[0].text not in lexicon().nouns:
        verb = parts[0]
    if verb is not None and verb is not parts[0] and singular(verb.text) in typed:
        # "steam_milk (milk)" milks nothing.
        verb = parts[0]
    if verb is not None and verb.text in lexicon().be | lexicon().auxiliaries | {"be", "have"}:
        verb = None
    begun = _begun(parts, words) if verb is not None and verb.text in _BEGINNING else None
    verb, starting = (begun, True) if begun is not None else (verb, False)
    # The "reading" of a "reading light" is no deed.
    parts = [
        p
        if p is verb or len(p.at) != 1 or not words[p.at[0]].endswith("ing") or parts[0].text in ENDING
        else replace(p, lines=frozenset())
        for p in parts
    ]
    people = any(parameter_role(one) == "person" for one in inputs)
    alike = frozenset(line for one in typed for concept in concepts((one,)) for line in concept.lines)
    about = tuple(
        p
        for p in parts
        if p is not verb
        and p.text not in EMPTY | VAGUE
        and not (starting and p.text in _BEGINNING)
        and singular(p.text) not in typed
        and not p.lines & alike
        and not (people and singular(p.text) in _PEOPLE)
    )
    if verb is None and not about:
        # "is_done" is about being done.
        about = tuple(part for part in parts[-1:] if part.text not in lexicon().be)
    told = re.findall(r"[a-z]+", description.lower())
    doing = next(iter(_segments(told_deed(description)[:3])), None)
    described = tuple(
        p for p in _segments(tuple(told)) if p.text not in EMPTY | VAGUE and singular(p.text) not in typed
    )
    second = next(
        (p for p in parts if p is not verb and p.lines & VERB_LINES and p.text not in EMPTY | LIGHT_VERBS),
        None,
    )
    return Signature(verb, about, typed, described, doing, second, starting)


_BEGINNING = frozenset({"start", "begin", "run", "do", "perform", "execute", "initiate"})
ENDING = frozenset({"stop", "end", "finish", "cancel"})
"""How a name begins that says that something ends."""


def _begun(parts: Sequence[Concept], words: tuple[str, ...]) -> Concept | None:
    """The deed itself in a name like "start_mowing"; None if the name has none."""
    return next((p for p in parts[1:2] if words[p.at[-1]].endswith("ing") and p.lines & VERB_LINES), None)


def _compounds(words: tuple[str, ...]) -> tuple[str, ...]:
    """With words in one that are one noun: "floodlight" in "floodLight"."""
    found: list[str] = []
    for word in words:
        whole = found[-1] + word if found else ""
        if (
            whole
            and word not in _PARTICLES
            and (whole in lexicon().nouns or any(c.lines - VERB_LINES for c in concepts((whole,))))
        ):
            found[-1] = whole
        else:
            found.append(word)
    return tuple(found)


def _segments(words: tuple[str, ...]) -> list[Concept]:
    """Words in a row as phrases where they are known phrases, else one by one."""
    found = concepts(words, spoken=False)
    parts: list[Concept] = []
    index = 0
    while index < len(words):
        here = [c for c in found if c.at[:1] == (index,) and c.at[-1] == index + len(c.at) - 1]
        longest = max(
            here, key=lambda concept: len(concept.at), default=Concept(words[index], frozenset(), (index,))
        )
        parts.append(longest)
        index += len(longest.at)
    return parts


def _several(words: tuple[str, ...], at: tuple[int, ...]) -> bool:
    """Whether a name says of things that they are to be on or off ("lights_on" lights nothing)."""
    one, behind = singular(words[at[0]]), words[at[-1] + 1 : at[-1] + 2]
    return (
        behind in {("on",), ("off",)}
        and one != words[at[0]]
        and bool(concepts((one,))[-1].lines - VERB_LINES)
    )


def _is_verb(part: Concept) -> bool:
    first = part.text.split()[0]
    return lexicon().verbs.match((first,)) is not None or bool(part.lines & VERB_LINES)
