"""Inputs that nobody says but something remembered tells ("give the row as much as it needs")."""

from __future__ import annotations

from collections.abc import Iterator

from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.parts import map_spans
from parley.language.offline.tasks.roles import number_inputs, parameter_role
from parley.language.offline.tasks.slots import COLOURS, Filled, kind_on_map
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.quantities import quantities, taken_by
from parley.language.offline.words.text import Phrase, keys, plain, singular, tokens
from parley.messages.status import ActionInfo

__all__ = ["recall_inputs"]

_AGREES = 2
"""How well a remembered number has to fit an input: by its unit, or by the input's name."""
_POINTING_BACK = frozenset({
    "where", "as", "much", "many", "it", "they", "he", "she", "needs", "need", "belongs", "belong", "usual",
    "usually", "normally", "goes", "go", "back", "always", "place", "its", "their", "his", "her", "gets",
    "takes", "should", "likes", "prefers", "wants", "lives", "is", "kept", "to", "be", "what", "whatever",
    "how", "right", "proper", "normal", "dose", "amount", "quantity",
})  # fmt: skip
"""Words that only point at something known ("where it belongs", "the usual amount")."""


def recall_inputs(info: ActionInfo, filled: Filled, words: Phrase, scene: Scene) -> None:
    """Fill what is missing from facts about what an order names; what only points at them is no longer left.

    Args:
        info: The action.
        filled: What is said for its inputs; what is remembered is added.
        words: The clause.
        scene: What is known.
    """
    if not scene.facts:
        return
    _as_told(filled, scene)
    if not filled.missing:
        return
    topic = frozenset(singular(word) for word in name_words(info.name)[1:])
    named = [*_named(filled, words, scene), *([topic] if topic and topic <= _content(words) else [])]
    found: set[str] = set()
    back = bool(_BACK & set(keys(words)))
    for name in list(filled.missing):
        for item in scene.facts:
            if item.fact.is_location and not (back or scene.is_person(item.fact.subject)):
                # Where a thing is now says nothing of where it is to go.
                continue
            about = next((one for one in named if _is_about(item, one)), None)
            value = _told(info, name, item, about, scene) if about is not None else None
            if value is None:
                continue
            filled.values[name] = value
            if isinstance(value, str):
                filled.phrases[name] = tokens(value)
            filled.missing.remove(name)
            filled.recalled.append(item)
            found |= about or set()
            break
    if found:
        filled.left = [part for part in filled.left if not _content(part.words) <= found]


def _as_told(filled: Filled, scene: Scene) -> None:
    """For "play what A likes": what A is said to like."""
    for name, phrase in filled.phrases.items():
        flat = keys(phrase)
        if flat[:1] not in {("what",), ("whatever",)} or len(flat) <= _AGREES:
            continue
        for item in scene.facts:
            sentence = tokens(item.fact.sentence)
            if keys(sentence[: len(flat) - 1]) == flat[1:] and len(sentence) >= len(flat):
                said = tuple(word for word in sentence[len(flat) - 1 :] if word.is_word)
                filled.values[name], filled.phrases[name] = plain(said), said
                filled.recalled.append(item)
                break


def _named(filled: Filled, words: Phrase, scene: Scene) -> Iterator[frozenset[str]]:
    """The words of each thing and person that an order names, pronouns too."""
    said = [*filled.phrases.values(), *(part.words for part in filled.left)]
    known = {"person": scene.persons[-1:], "thing": scene.things[-1:]}
    said += [one for word in words for one in known.get(_OF_LAST.get(word.key, ""), ())]
    for phrase in said:
        content = _content(phrase)
        if content and not content <= lexicon().small:
            yield content


def _content(phrase: Phrase) -> frozenset[str]:
    """The words that name something."""
    small = lexicon().determiners | _POINTING_BACK
    said = (key.removesuffix("'s") for key in keys(phrase) if key not in small)
    return frozenset(singular(key) for key in said if key)


_BACK = frozenset({"back", "belongs", "belong", "where", "usual", "place", "goes"})
_OF_LAST = {"her": "person", "his": "person", "him": "person", "its": "thing", "it": "thing"}


_CALLED_AT_LARGE = frozenset(
    {"name", "id", "text", "object", "item", "target", "place", "location", "what", "person"}
)


def _is_about(item: Remembered, content: frozenset[str]) -> bool:
    fact = item.fact
    said = {singular(key.removesuffix("'s")) for key in keys(tokens(fact.sentence))}
    return not fact.negated and content <= said


def _told(
    info: ActionInfo, name: str, item: Remembered, about: frozenset[str], scene: Scene
) -> float | str | None:
    """What a fact says for an input; None if nothing that fits it."""
    sentence = tokens(item.fact.sentence)
    if name in number_inputs(info):
        takes = taken_by(name, info.description)
        said = (q for q in quantities(sentence) if takes.fit(q) >= _AGREES)
        return next((takes.value_of(q) for q in said), None)
    called = {singular(word) for word in name_words(name)} - _CALLED_AT_LARGE
    flat = [singular(key) for key in keys(sentence)]
    link = next((i for i, key in enumerate(flat) if key in {"is", "are"} and i), 0)
    if link and called & set(flat[:link]) and about <= set(flat[:link]):
        # "The code of the gate is 4711".
        return plain(tuple(word for word in sentence[link + 1 :] if word.is_word)) or None
    if {"colour", "color"} & set(name_words(name)):
        return next((key for key in keys(sentence) if key in COLOURS), None)
    place = parameter_role(name) == "place"
    if not place and not kind_on_map(name, scene.objects):
        return None
    kinds = {singular(word) for word in name_words(name)}
    for start, end, thing in map_spans(sentence, scene):
        if thing is None or {singular(key) for key in keys(sentence[start:end])} & about:
            continue
        if place or kinds & {singular(word) for word in name_words(thing.class_name)}:
            return plain(sentence[start:end])
    return None
