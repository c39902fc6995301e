"""Which words of an action's name and of what is said stand for the same deed or thing ("horn", "honk")."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import lemma, singular
from parley.language.word_lists import load_data

__all__ = [
    "LIGHT_VERBS",
    "VERB_LINES",
    "Concept",
    "concepts",
    "contrary",
    "likeness",
    "opposed",
    "other_verbs",
    "reversed_at",
]

_DATA = load_data("deeds")
LIGHT_VERBS = frozenset(_DATA["light"])
"""Verbs that say little about what is done."""


def _lines() -> dict[str, frozenset[int]]:
    table: dict[str, set[int]] = {}
    for number, line in enumerate((*_DATA["verbs"], *_DATA["near"], *_DATA["nouns"])):
        for phrase in line:
            table.setdefault(phrase, set()).add(number)
    return {phrase: frozenset(numbers) for phrase, numbers in table.items()}


_LINES = _lines()


def _phrase_lines(phrase: str, head: str) -> frozenset[int]:
    """The lines of a phrase, with those of its verb where that alone means the same ("heat up")."""
    lines = _LINES[phrase]
    alone = _LINES.get(head, frozenset())
    return lines | alone if lines & alone else lines


_VERBS = (*_DATA["verbs"], *_DATA["near"])
_SURE_LINES = len(_DATA["verbs"])
_VERB_LINES = _SURE_LINES + len(_DATA["near"])
_NEAR = frozenset(range(_SURE_LINES, _VERB_LINES))
VERB_LINES = frozenset(range(_VERB_LINES))
"""The lines that say what is done; the others say what with."""
_PHRASES = PhraseTable.of(_LINES)
_OPPOSITES: dict[str, frozenset[str]] = {}
for _one, _other in _DATA["opposites"]:
    _OPPOSITES[_one] = _OPPOSITES.get(_one, frozenset()) | {_other}
    _OPPOSITES[_other] = _OPPOSITES.get(_other, frozenset()) | {_one}
_PARTICLES = frozenset({"on", "off", "up", "down", "in", "out", "over", "away", "back", "about"})
_BETWEEN = 5
"""How many words may stand between a verb and its particle."""


@dataclass(frozen=True, slots=True)
class Concept:
    """One word or phrase, with what else may be said for it."""

    text: str
    """Base form."""
    lines: frozenset[int]
    at: tuple[int, ...] = ()
    """Its words in what it was read from."""
    within: bool = False
    """Whether it is only a thing within a longer phrase ("call" in "end the call")."""


def _base(word: str) -> tuple[str, ...]:
    """The forms of a word that are compared, the base form first."""
    return tuple(dict.fromkeys((lemma(word), singular(word), word)))


@lru_cache(maxsize=8192)
def concepts(words: tuple[str, ...], *, spoken: bool = True) -> tuple[Concept, ...]:
    """The concepts of words in a row: known phrases and single words.

    Args:
        words: Lower case.
        spoken: Whether it is what somebody says, where verbs may be parted ("turn the light off").
    """
    found: list[Concept] = []
    words = tuple(word.replace("-", "") if "-" in word else word for word in words)
    for index in range(len(words)):
        for form in _base(words[index]):
            rest = (form, *words[index + 1 :])
            matched = _PHRASES.match(rest)
            if matched is not None and matched[0] > 1 and not _leads_on(rest, matched[0]):
                found.append(
                    Concept(
                        matched[1], _phrase_lines(matched[1], form), tuple(range(index, index + matched[0]))
                    )
                )
                break
        found += _split(words, index) if spoken else ()
        forms = _base(words[index])
        lines = frozenset().union(*(_LINES.get(form, frozenset()) for form in forms))
        same = frozenset().union(*(lexicon().synonyms.get(form, frozenset()) for form in forms))
        lines |= frozenset().union(*(_LINES.get(other, frozenset()) for other in same - _LINES.keys()))
        found.append(Concept(forms[0], lines, (index,)))
    return _without_parts(found)


def _leads_on(words: Sequence[str], size: int) -> bool:
    """Whether a particle belongs to where somebody goes: "up" in "go up to the third floor"."""
    if words[size - 1] not in _PARTICLES or words[size : size + 1] not in {("to",), ("towards",)}:
        return False
    return words[0] in _WAYS and not any(word[0].isdigit() for word in words[size + 1 : size + 2])


_WAYS = frozenset({"go", "come", "move", "drive", "walk", "fly", "head", "get", "roll", "climb"})


def _without_parts(found: Sequence[Concept]) -> tuple[Concept, ...]:
    """Without the single words of longer phrases, but for things: in "end the call" nobody calls."""
    whole = [set(concept.at) for concept in found if len(concept.at) > 1]
    first = {concept.at[0] for concept in found if len(concept.at) > 1}
    kept: list[Concept] = []
    for one in found:
        if len(one.at) == 1 and one.at[0] in first:
            continue
        if any(set(one.at) < phrase for phrase in whole):
            if (
                len(one.at) > 1
                or one.text in _PARTICLES
                or not (one.lines - VERB_LINES or singular(one.text) in lexicon().nouns)
            ):
                continue
            one = replace(one, lines=one.lines - VERB_LINES, within=True)
        kept.append(one)
    return tuple(kept)


def _split(words: Sequence[str], index: int) -> Iterable[Concept]:
    """Verbs whose particle stands behind what they act on."""
    if words[index] in _PARTICLES:
        return
    for other in range(index + 2, min(index + 2 + _BETWEEN, len(words))):
        phrase = f"{lemma(words[index])} {words[other]}"
        if words[other] in _PARTICLES and phrase in _LINES:
            ends = (
                words[other] == "about"
                or other + 1 == len(words)
                or words[other + 1]
                in {
                    "in",
                    "at",
                    "again",
                    "please",
                    "to",
                    "by",
                    "for",
                    "now",
                    "on",
                    "onto",
                    "into",
                    "where",
                }
            )
            if ends:
                yield Concept(phrase, _phrase_lines(phrase, lemma(words[index])), (index, other))


def likeness(one: Concept, other: Concept) -> float:
    """How alike two concepts are: 1 the same, 0.8 of the same line, 0.72 near each other, else 0."""
    if one.text == other.text or singular(one.text) == singular(other.text):
        return 1.0
    shared = one.lines & other.lines
    if shared:
        return 0.8 if shared - _NEAR else 0.72
    same = lexicon().synonyms.get(one.text, frozenset())
    return 0.8 if other.text in same else 0.0


def opposed(one: Concept, said: Sequence[Concept]) -> bool:
    """Whether the contrary of a concept is said, and not the concept itself."""
    against = _OPPOSITES.get(one.text, frozenset())
    return any(other.text in against for other in said) and not any(
        likeness(one, other) > 0 for other in said
    )


def reversed_at(one: Concept, said: Sequence[Concept]) -> tuple[int, ...]:
    """Where the contrary of a concept is said, though not the word itself; empty if it is not."""
    against = _OPPOSITES.get(one.text, frozenset())
    if any(other.text == one.text for other in said):
        return ()
    return next((other.at for other in said if other.text in against), ())


def contrary(said: Sequence[str], name: Sequence[str]) -> bool:
    """Whether a direction is said that is the contrary of one in a name ("back" of "ahead")."""
    known = set(name)
    both = {word for word in known if _OPPOSITES.get(word, frozenset()) & known}
    return any(
        _OPPOSITES.get(word, frozenset()) & (known - both) and word not in known
        for word in said
        if word in _DIRECTIONS
    )


_DIRECTIONS = frozenset(
    {
        "up",
        "down",
        "left",
        "right",
        "forward",
        "forwards",
        "ahead",
        "back",
        "backward",
        "backwards",
        "reverse",
    }
)


def _no_openers() -> frozenset[str]:
    """Words that begin no order, though an action may be asked for by them ("is it warm?")."""
    lex = lexicon()
    return lex.determiners | lex.question_starts | lex.be | lex.auxiliaries | _PARTICLES


@lru_cache(maxsize=1024)
def other_verbs(name: tuple[str, ...]) -> frozenset[tuple[str, ...]]:
    """First words of orders for the action of a name that no list of verbs has."""
    found: set[tuple[str, ...]] = set()
    for size in range(min(3, len(name)), 0, -1):
        lines = frozenset(line for line in _LINES.get(" ".join(name[:size]), ()) if line < _VERB_LINES)
        for number in lines:
            for phrase in _VERBS[number]:
                words = tuple(phrase.split())
                known = lexicon().verbs.match(words)
                if known is None and words[0] not in _no_openers():
                    found.add(words)
        if lines:
            break
    return frozenset(found)
