"""Noun phrases: what is named, by which words, and where it is said to be."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.lexicon import lexicon
from parley.language.offline.text import Phrase, keys, plain, singular

__all__ = ["NounPhrase", "bare", "coordinated", "noun_phrase", "number_of"]


@dataclass(frozen=True, slots=True)
class NounPhrase:
    """A noun phrase cut into its parts; compared words are singular and lower case."""

    phrase: Phrase
    """As written, without determiner and without what only politeness adds."""
    core: tuple[str, ...]
    """The words before any place: modifiers, then the head noun last."""
    relation: str = ""
    """Preposition of place, if any."""
    anchors: tuple[Phrase, ...] = ()
    """What the relation refers to; two for "between"."""
    quantifier: str = ""
    excluded: Phrase = ()
    """After "except"."""

    @property
    def text(self) -> str:
        """As written, without determiner."""
        return plain(self.phrase)


_EXCEPT = (
    "except for",
    "except",
    "but not",
    "apart from",
    "other than",
    "besides",
    "excluding",
    "aside from",
    "but",
)
_SUPERLATIVES = frozenset({"nearest", "closest", "farthest", "furthest"})
_RELATIVE = frozenset({"that", "which", "who", "where"})


def bare(phrase: Phrase) -> Phrase:
    """Without punctuation and fillers around it and without determiners before it."""
    lex = lexicon()
    words = list(phrase)
    while True:
        while words and not words[-1].is_word:
            words.pop()
        size = lex.adverbs.match_end(keys(words))
        if not size or size >= len(words):
            break
        words = words[:-size]
    while words and (not words[0].is_word or words[0].key in lex.determiners):
        # A lone letter after a noun is a name ("area A"), at the start it is the article.
        if len(words) == 1 and words[0].is_word:
            break
        words.pop(0)
    return tuple(words)


def noun_phrase(phrase: Phrase) -> NounPhrase:
    """Read a noun phrase."""
    lex = lexicon()
    excluded: Phrase = ()
    flat = keys(phrase)
    for marker in _EXCEPT:
        at = _find(flat, tuple(marker.split()))
        if at > 0:
            phrase, excluded = phrase[:at], bare(phrase[at + len(marker.split()) :])
            break
    phrase = bare(phrase)
    quantifier = ""
    while phrase and (phrase[0].key in lex.quantifiers | lex.free_choice or keys(phrase[:1]) == ("rest",)):
        quantifier = quantifier or phrase[0].key
        phrase = bare(_without_of(phrase[1:]))
    cut, size = _first_relation(phrase)
    core_words = phrase[:cut]
    core = tuple(number_of(singular(word.key)) for word in core_words if word.is_word)
    if cut == len(phrase):
        return NounPhrase(phrase, core, quantifier=quantifier, excluded=excluded)
    relation = " ".join(keys(phrase[cut : cut + size]))
    rest = bare(phrase[cut + size :])
    anchors = tuple(coordinated(rest)) if "between" in relation else (rest,)
    if relation.startswith("halfway"):
        relation = "between"
    return NounPhrase(phrase, core, relation, anchors, quantifier, excluded)


def number_of(word: str) -> str:
    """Numerals as digits ("two", "second" -> "2"); "one" stays, it also means a thing."""
    lex = lexicon()
    if word in lex.ordinals:
        return str(lex.ordinals[word])
    if word in lex.numbers and word != "one":
        return str(lex.numbers[word])
    return word


def coordinated(phrase: Phrase) -> list[Phrase]:
    """The members of "A, B and C", each without its determiner."""
    members: list[Phrase] = []
    current: list[int] = []
    for index, word in enumerate(phrase):
        if word.key in {"and", ",", "or", "&", "plus"}:
            if current:
                members.append(bare(tuple(phrase[i] for i in current)))
            current = []
        else:
            current.append(index)
    if current:
        members.append(bare(tuple(phrase[i] for i in current)))
    return [member for member in members if member]


def _first_relation(phrase: Phrase) -> tuple[int, int]:
    """Where the first preposition of place stands and how many words it has; the length if there is none."""
    lex = lexicon()
    flat = keys(phrase)
    for index in range(len(phrase)):
        if flat[index] in _RELATIVE and index > 0:
            # "the one that is by the window" reads like "the one by the window".
            skip = index + 1
            while skip < len(flat) and flat[skip] in lex.be | lex.location_verbs:
                skip += 1
            found = lex.places.match(flat, skip)
            if found:
                return index, skip - index + found[0]
        if flat[index] in lex.location_verbs and index > 0:
            found = lex.places.match(flat, index + 1)
            if found:
                return index, 1 + found[0]
        if (
            index
            and flat[index] in {"nearest", "closest"}
            and index + 1 < len(flat)
            and flat[index + 1] in lex.determiners | {"area", "gate"}
        ):
            # "The chair nearest the door".
            return index, 1
        if flat[index] in _SUPERLATIVES and flat[index + 1 : index + 2] not in {
            ("to",),
            ("from",),
            ("away",),
            (),
        }:
            continue
        found = lex.places.match(flat, index)
        if found and flat[index] not in {"of"} and index + found[0] < len(flat):
            return index, found[0]
    return len(phrase), 0


def _without_of(phrase: Phrase) -> Phrase:
    return phrase[1:] if phrase and phrase[0].key == "of" else phrase


def _find(flat: tuple[str, ...], wanted: tuple[str, ...]) -> int:
    for index in range(len(flat) - len(wanted) + 1):
        if flat[index : index + len(wanted)] == wanted:
            return index
    return -1
