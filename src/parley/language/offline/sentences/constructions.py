"""Ways of asking without an order ("X could use Y", "smoke at Z"), read as the order they mean.

The ways are data (`data/constructions.yaml`): patterns of fixed words and open phrases, with conditions on
what the phrases name. Nothing here knows a single sentence.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.report_words import without_hedges
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular
from parley.language.word_lists import load_data

__all__ = ["recast"]

_LONGEST_SLOT = 9
_ENDS = frozenset({",", ";", "then", "because"})


@dataclass(frozen=True, slots=True)
class _Part:
    """One part of a pattern: fixed alternatives, or an open phrase."""

    words: tuple[tuple[str, ...], ...] = ()
    slot: str = ""
    optional: bool = False


@dataclass(frozen=True, slots=True)
class _Construction:
    parts: tuple[_Part, ...]
    means: tuple[str, ...]
    where: tuple[tuple[str, str], ...]
    said: str


def recast(words: Phrase, scene: Scene) -> tuple[Phrase, str] | None:
    """The order that a clause means, and the pattern it follows; None if it follows none."""
    asked = strip_openers(words, requests=True)
    return _recast(strip_openers(words), scene) or (_recast(asked, scene) if asked != words else None)


def _recast(words: Phrase, scene: Scene) -> tuple[Phrase, str] | None:
    words = without_hedges(tuple(word for word in words if word.is_word or word.key == ","))
    if not 3 <= len(words) <= 24:
        return None
    flat = keys(words)
    for construction in _candidates(flat):
        for slots in _matches(construction.parts, words, flat, 0):
            if all(_fits(kind, slots.get(name, ()), scene) for name, kind in construction.where):
                return _order(construction, slots), construction.said
    return None


@cache
def _constructions() -> tuple[_Construction, ...]:
    return tuple(
        _Construction(
            tuple(_part(text) for text in body["say"].split()),
            tuple(body["means"].split()),
            tuple(body.get("where", {}).items()),
            body["say"],
        )
        for body in load_data("constructions")
    )


def _part(text: str) -> _Part:
    options = text.split("|")
    slot = next((o[1:-1] for o in options if o.startswith("{")), "")
    optional = options[0].startswith("?")
    fixed = tuple(tuple(o.lstrip("?").split("_")) for o in options if not o.startswith("{"))
    return _Part(fixed, slot, optional)


@cache
def _first_words() -> tuple[frozenset[str], ...]:
    """For each construction the words of which one must be in a clause; a quick way to pass most over."""
    return tuple(
        min(
            (
                frozenset(option[0] for option in part.words)
                for part in construction.parts
                if part.words and not part.slot and not part.optional
            ),
            key=len,
            default=frozenset(),
        )
        for construction in _constructions()
    )


def _candidates(flat: tuple[str, ...]) -> Iterator[_Construction]:
    said = set(flat)
    for construction, needed in zip(_constructions(), _first_words(), strict=True):
        if needed & said:
            yield construction


def _matches(
    parts: tuple[_Part, ...], words: Phrase, flat: tuple[str, ...], at: int
) -> Iterator[dict[str, Phrase]]:
    """Every way in which a pattern covers the words from `at` on; longest phrases last."""
    if not parts:
        if at == len(flat):
            yield {}
        return
    part, rest = parts[0], parts[1:]
    for option in sorted(part.words, key=len, reverse=True):
        if flat[at : at + len(option)] == option:
            yield from _matches(rest, words, flat, at + len(option))
    if part.optional:
        yield from _matches(rest, words, flat, at)
    if part.slot:
        for end in range(at + 1, min(len(flat), at + _LONGEST_SLOT) + 1):
            if flat[end - 1] in _ENDS:
                break
            for found in _matches(rest, words, flat, end):
                yield {part.slot: words[at:end], **found}


def _fits(kind: str, phrase: Phrase, scene: Scene) -> bool:
    if not phrase:
        # An open phrase whose place a fixed word took ("someone") needs no condition.
        return True
    bare_words = bare(phrase)
    match kind:
        case "person":
            return _is_somebody(phrase, scene) and keys(bare_words)[0] not in {"i", "we", "you", "it"}
        case "thing":
            first = keys(phrase)[0]
            return first not in {"to", "you", "help", "that"} and not scene.is_person(phrase)
        case "remembered":
            known = find_fact(bare_words, scene.facts)[0]
            return known is not None and known.fact.is_location
        case "place":
            return _is_somewhere(phrase, scene)
        case "incident":
            said = {singular(word) for word in keys(phrase)}
            return bool(said & (lexicon().hazards | lexicon().incidents))
        case "span":
            return duration_s((Word("for", "for"), *phrase)) is not None
        case "free":
            return not noun_phrase(phrase).anchors
        case "base":
            base = (lemma(phrase[0].key), *keys(phrase[1:]))
            return lexicon().verbs.match(base) is not None
    return True


def _is_somebody(phrase: Phrase, scene: Scene) -> bool:
    """Whether words name somebody, wherever they are said to be ("the man at A")."""
    flat = keys(phrase)
    at = next((i for i in range(2, len(flat)) if lexicon().places.match(flat, i) is not None), len(flat))
    return scene.is_person(phrase) or (at < len(flat) and scene.is_person(phrase[:at]))


def _is_somewhere(phrase: Phrase, scene: Scene) -> bool:
    words = bare(phrase)
    if len(words) == 1 and words[0].key in lexicon().place_pronouns | lexicon().thing_pronouns:
        return words[0].key == "there" and bool(scene.places)
    if not scene.objects:
        return True
    return scene.ground(phrase).outcome != "none" or find_fact(phrase, scene.facts)[0] is not None


def _order(construction: _Construction, slots: dict[str, Phrase]) -> Phrase:
    bases = {name for name, kind in construction.where if kind == "base"}
    result: list[Word] = []
    for text in construction.means:
        if not text.startswith("{"):
            result.append(Word(text, text))
            continue
        phrase = slots[text[1:-1]]
        if phrase and phrase[0].key in lexicon().determiners:
            phrase = (Word(phrase[0].key, phrase[0].key), *phrase[1:])
        if text[1:-1] in bases:
            base = lemma(phrase[0].key)
            phrase = (Word(base, base), *phrase[1:])
        result.extend(phrase)
    return tuple(result)
