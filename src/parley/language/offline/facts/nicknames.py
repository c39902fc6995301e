"""Names that people give to things: "the staff call the large van the tank", "our name for A is B"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from parley.language.offline.facts.facts import Fact
from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.facts.theirs import with_their_names
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["Nickname", "by_their_real_names", "nicknames", "remembered_plainly"]

_CALLING = frozenset({"call", "calls", "named", "name", "nicknamed", "nickname", "dub", "dubbed"})
_CALLED = frozenset(
    tuple(text.split())
    for text in (
        "is called", "is also called", "is known as", "is also known as", "is nicknamed", "is named",
        "is dubbed", "goes by", "is often called", "is usually called", "are called", "are known as",
        "is called by everyone", "goes by the name of", "is known here as", "is always called",
    )
)  # fmt: skip
_MEANING = frozenset(
    tuple(text.split()) for text in ("means", "stands for", "is short for", "refers to", "is slang for")
)
_NAMING = frozenset({"name", "nickname", "word", "term", "codename", "shorthand"})
_ABOUT_NAMES = frozenset(
    {
        "call",
        "called",
        "name",
        "nickname",
        "nicknamed",
        "known",
        "named",
        "remember",
        "forget",
        "means",
        "mean",
    }
)
"""Words of messages that are about the names themselves."""
_LONGEST = 6


@dataclass(frozen=True, slots=True)
class Nickname:
    """One name and the thing on the map that it is for."""

    name: Phrase
    item: MapObject
    entry: MemoryEntry


def nicknames(memory: Sequence[MemoryEntry], objects: Sequence[MapObject]) -> list[Nickname]:
    """The names that are remembered for things on the map, newest first, each once."""
    found: dict[tuple[str, ...], Nickname] = {}
    for entry in reversed(memory):
        for thing, name in _namings(tokens(entry.data)) if entry.type == "text" else ():
            called, item = bare(name), _the_one(thing, objects)
            if item is None or not 0 < len(called) <= _LONGEST or _the_one(name, objects):
                continue
            found.setdefault(keys(called), Nickname(called, item, entry))
            break
    return list(found.values())


def remembered_plainly(words: Phrase, scene: Scene) -> Phrase:
    """For "ladle. V it" "the ladle. V it", for "A with the B on it" "A where the B is", B remembered."""
    words = with_their_names(words, scene)
    flat = keys(words)
    for subject in {keys(bare(known.fact.subject)) for known in scene.facts}:
        size = len(subject)
        starts = (i for i in range(len(flat) - size) if subject and flat[i : i + size] == subject)
        for at in starts:
            begins = at == 0 or flat[at - 1] in {".", "!", "?"}
            if (
                begins
                and flat[at + size] in {".", "!", ":"}
                and {"it", "there", "them"} & set(flat[at + size :])
            ):
                return (Word("the", "the"), *words) if at == 0 else words
            behind = flat[at + size : at + size + 2]
            held = (
                behind[:1]
                and behind[0] in {"on", "in", "at", "inside"}
                and behind[1:] in {("it",), ("them",)}
            )
            if held and flat[at - 2 : at] == ("with", "the"):
                return (
                    *words[: at - 2],
                    *tokens("where the"),
                    *words[at : at + size],
                    *tokens("is"),
                    *words[at + size + 2 :],
                )
    return words


def by_their_real_names(words: Phrase, scene: Scene) -> Phrase:
    """A message with things by the names that the map has for them; what was used of memory is noted."""
    flat = keys(words)
    if _ABOUT_NAMES & set(flat) or flat[:1] in {("what",), ("who",)}:
        return words
    for known in nicknames(scene.situation.memory, scene.objects):
        wanted = keys(known.name)
        real = tokens(known.item.description)
        at = next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), -1)
        if at < 0 or _is_told(flat, at, len(wanted)):
            continue
        start = at - (at > 0 and flat[at - 1] in {"the", "our", "old", "a"})
        article = () if real[-1].key.isdigit() or len(real[-1].key) == 1 else (Word("the", "the"),)
        words = (*words[:start], *article, *real, *words[at + len(wanted) :])
        flat = keys(words)
        sentence = f"{plain(known.name)} is {known.item.description}"
        scene.use(Remembered(Fact(known.name, sentence=sentence), known.entry))
    return words


def _is_told(flat: tuple[str, ...], at: int, size: int) -> bool:
    """For "Bertha is in the yard": a fact, kept in the words in which it is told."""
    before = set(flat[:at]) - {"the", "our", "old", "a"}
    return not before and flat[at + size : at + size + 1] != () and flat[at + size] in lexicon().be


def _namings(words: Phrase) -> Iterator[tuple[Phrase, Phrase]]:
    """Each way to read a sentence as (thing, name)."""
    words = tuple(word for word in words if word.is_word)
    flat = keys(words)
    for at in range(len(flat)):
        for size in range(1, 6):
            if flat[at : at + size] in _CALLED and at:
                yield words[:at], words[at + size :]
            if flat[at : at + size] in _MEANING and at:
                yield words[at + size :], words[:at]
        if flat[at] in _NAMING and flat[at + 1 : at + 2] == ("for",):
            yield from _name_for(words, flat, at)
        if flat[at] in _CALLING and 0 < at < len(flat) - 2:
            if flat[:at][-2:][:1] == ("what",):
                yield words[at + 1 :], _before_is(words[: at - 2])
            for cut in range(len(words) - 1, at + 1, -1):
                yield words[at + 1 : cut], words[cut:]


def _name_for(words: Phrase, flat: tuple[str, ...], at: int) -> Iterator[tuple[Phrase, Phrase]]:
    """For "our name for A is B" and "B is our name for A"."""
    links = [i for i, key in enumerate(flat) if key == "is"]
    for link in links:
        if link > at + 2:
            yield words[at + 2 : link], words[link + 1 :]
        elif 0 < link < at:
            yield words[at + 2 :], words[:link]


def _before_is(words: Phrase) -> Phrase:
    """The name in "B is what we call A"."""
    flat = keys(words)
    return words[: flat.index("is")] if "is" in flat else words


def _the_one(phrase: Phrase, objects: Sequence[MapObject]) -> MapObject | None:
    """The one thing on the map that is called so, with nothing said besides."""
    found = ground_phrase(bare(phrase), objects, strict=True)
    if found.outcome != "match" or not phrase:
        return None
    item = found.candidates[0]
    known = set(keys(tokens(f"{item.description} {item.class_name}")))
    return item if set(keys(bare(phrase))) <= known else None
