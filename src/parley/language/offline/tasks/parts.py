"""A clause cut into parts by its prepositions; names of things on the map are kept whole."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.text import Phrase, Word, keys, singular
from parley.world.object_map import MapObject

__all__ = ["Part", "map_spans", "parts_of", "trimmed", "unquoted"]

_CUTS = frozenset(
    {
        "to",
        "into",
        "onto",
        "in",
        "on",
        "at",
        "from",
        "with",
        "for",
        "about",
        "as",
        "by",
        "near",
        "inside",
        "using",
    }
    | {
        "through",
        "that",
        "saying",
        "under",
        "over",
        "off",
        "towards",
        "toward",
        "of",
        "against",
        "beside",
        "behind",
    }
    | {"and"}
)
_EMPTY = frozenset(
    {
        "does",
        "do",
        "did",
        "each",
        "have",
        "has",
        "got",
        "we",
        "are",
        "is",
        "be",
        "please",
        "now",
        "again",
        "up",
        "down",
        "off",
        "on",
        "out",
        "over",
        "away",
        "here",
        "bit",
        "little",
    }
)
_LONGEST_NAME = 6


@dataclass(frozen=True, slots=True)
class Part:
    """A piece of a clause."""

    before: str
    """The preposition before it, if any."""
    words: Phrase
    item: MapObject | None = None
    """What it names on the map, if exactly one thing."""
    grounded: bool = False
    """Whether it names anything on the map."""
    start: int = 0
    end: int = 0
    """Where it stands among the words of the clause."""
    kinds: frozenset[str] = frozenset()
    """Of which kinds the things are that it names."""
    role: str = ""
    """What it is to the deed, where that is known: place, person, object or text."""


def map_spans(words: Phrase, scene: Scene) -> list[tuple[int, int, MapObject | None]]:
    """Where the words name something on the map, longest first: start, end, the thing if it is one."""
    spans: list[tuple[int, int, MapObject | None]] = []
    index = 0
    small = lexicon().small
    while index < len(words):
        size = 0
        for length in range(min(_LONGEST_NAME, len(words) - index), 0, -1):
            part = _owner(words[index : index + length])
            if not (part[0].is_word and part[-1].is_word) or part[-1].key in lexicon().goals_and_places:
                continue
            if part[0].key in lexicon().determiners or part[0].key in lexicon().goals_and_places:
                continue
            if part[0].key in lexicon().quantifiers or (
                length == 1 and part[0].key in small and not part[0].is_capital
            ):
                exact = any(keys(part) == tuple(o.description.lower().split()) for o in scene.objects)
                if not exact:
                    continue
            if length > 1 and _counts(words, index + length - 1):
                continue
            text = " ".join(keys(part))
            if set(keys(part)) & _CUTS and not any(
                text == item.description.lower() for item in scene.objects
            ):
                continue
            found = ground_phrase(part, scene.objects, scene.situation.robot_pose, strict=True)
            if (
                found.outcome == "none"
                and index
                and words[index - 1].key == "the"
                and _ends_phrase(words, index + length)
            ):
                found = scene.ground(part)
            if found.outcome != "none":
                item = found.candidates[0] if found.outcome == "match" else None
                size = length
                if item is None and (seen := _seen_from_you(words[index:], length, scene)) is not None:
                    size, item = seen
                spans.append((index, index + size, item))
                break
        index += size or 1
    return spans


def _seen_from_you(words: Phrase, size: int, scene: Scene) -> tuple[int, MapObject] | None:
    """For "trough nearest to you", of several troughs: in how many words it is told, and the one it is."""
    flat = keys(words)
    end = next((i + 1 for i in range(size + 1, min(size + _SIDE, len(flat))) if flat[i] in _YOU), 0)
    found = scene.ground(words[:end]) if end else None
    return (end, found.candidates[0]) if found is not None and found.outcome == "match" else None


_YOU = frozenset({"you", "yourself", "here"})
_SIDE = 4


def _owner(phrase: Phrase) -> Phrase:
    """For "the cargo bike's (chain)": the cargo bike."""
    last = phrase[-1]
    if not last.key.endswith("'s"):
        return phrase
    return (*phrase[:-1], Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s")))


def _counts(words: Phrase, at: int) -> bool:
    """Whether a word is a number with its unit behind it ("the roses two litres")."""
    found = next(iter(quantities(words[at : at + 2])), None)
    return found is not None and bool(found.units) and found.end == 2


def _ends_phrase(words: Phrase, end: int) -> bool:
    """Whether a noun phrase can end here."""
    if end == len(words) or not words[end].is_word:
        return True
    return words[end].key in _CUTS | lexicon().be | {"have", "has", "got", "get", "need", "needs"}


def parts_of(
    words: Phrase,
    gone: set[int],
    spans: Sequence[tuple[int, int, MapObject | None]],
    scene: Scene,
    kinds: Collection[str] = (),
) -> list[Part]:
    """The clause cut by prepositions, without what is explained already; names on the map are kept whole.

    Args:
        words: The clause.
        gone: Which words are explained already.
        spans: Where things of the map are named.
        scene: What is known.
        kinds: What inputs are called: "whale track" is one track, though there is a whale on the map.
    """
    inside = {i for start, end, _ in spans for i in range(start + 1, end)}
    starts = {start: (end, item) for start, end, item in spans}
    ends = {end for _, end, _ in spans}
    parts: list[Part] = []
    before, current = "", list[int]()

    def close(following: str = "") -> None:
        nonlocal before, current
        phrase = trimmed(tuple(words[i] for i in current))
        if phrase:
            touched = [starts[i] for i in current if i in starts]
            phrase = _owner(phrase) if touched else phrase
            one = touched[0][1] if len(touched) == 1 else None
            classes = (item.class_name for _, item in touched if item is not None)
            kinds = frozenset(singular(word) for name in classes for word in name_words(name))
            parts.append(Part(before, phrase, one, bool(touched), current[0], current[-1] + 1, kinds))
        before, current = following, []

    quoted, behind = _quoted(words), 0
    for index, word in enumerate(words):
        if index < behind:
            continue
        if index in quoted and quoted[index] > index + 1:
            # What stands in quotation marks is one thing, whatever it says.
            close()
            behind = quoted[index] + 1
            parts.append(Part("", words[index + 1 : behind - 1], start=index, end=behind, role="text"))
        elif not word.is_word:
            close()
        elif index in gone:
            if current and index not in inside:
                close()
        elif word.key in _CUTS and index not in inside and not _joins(words, index, current):
            close(word.key if word.key != "and" else "")
        else:
            if current and (
                _new_phrase(words, index, inside)
                or (word.key in {"a", "an"} and scene.is_person(trimmed(tuple(words[i] for i in current))))
                or (
                    index in ends
                    and not {word.key, words[index - 1].key} & _JOINING
                    and word.key not in kinds
                )
            ):
                close()
            current.append(index)
    close()
    return _placed(parts, words, scene)


def _quoted(words: Phrase) -> dict[int, int]:
    """Where quotation marks begin and end something; the end of a clause ends it, too."""
    marks = [index for index, word in enumerate(words) if word.key == '"']
    return dict(zip(marks[::2], (*marks[1::2], len(words)), strict=False))


def unquoted(words: Phrase) -> Phrase:
    """With marks in the place of what stands in quotation marks."""
    for start, end in _quoted(words).items():
        words = (*words[:start], *(words[start],) * (end - start), *words[end:])
    return words


_JOINING = frozenset({"and", "or", "of", ","})
_BESIDE = frozenset(
    {"in", "on", "at", "near", "by", "beside", "behind", "under", "over", "to", "from", "with", "inside"}
)


def _joins(words: Phrase, index: int, current: Sequence[int]) -> bool:
    """Whether a word that may part two inputs joins the words around it ("A and B", "the lid of the pot")."""
    if words[index].key == "of":
        return bool(current)
    return words[index].key == "and" and bool(current) and index + 1 < len(words)


def _placed(parts: Sequence[Part], words: Phrase, scene: Scene) -> list[Part]:
    """With "the cup next to the sink" as one part, where the map knows it as one thing."""
    found: list[Part] = []
    for part in parts:
        last = found[-1] if found else None
        if (
            last is not None
            and last.item is None
            and part.before in _BESIDE
            and last.grounded
            and part.grounded
        ):
            whole = words[last.start : part.end]
            grounding = scene.ground(whole)
            if grounding.outcome == "match" and not _in_its_like(grounding.candidates[0], part):
                found[-1] = Part(
                    last.before, bare(whole), grounding.candidates[0], True, last.start, part.end
                )
                continue
        found.append(part)
    return found


def _in_its_like(item: MapObject, part: Part) -> bool:
    """For "the soap in soap dispenser 1": it is in no other dispenser, as nothing is in its like."""
    held = part.before in {"in", "inside", "on"} and part.item is not None
    return held and part.item is not None and part.item.class_name == item.class_name


def _new_phrase(words: Phrase, index: int, inside: set[int]) -> bool:
    """Whether a noun phrase of its own begins without preposition ("table 2 the soup")."""
    joined = index and words[index - 1].key in _JOINING
    return index not in inside and not joined and words[index].key in lexicon().determiners - {"a"}


_DANGLING = frozenset({"of", "with", "for", "to", "in", "at"})


def _tells_where(phrase: Phrase) -> bool:
    """For "the pen where Bella is"."""
    return phrase[-1].key in {"is", "are"} and "where" in keys(phrase[1:-1])


def trimmed(phrase: Phrase) -> Phrase:
    """A phrase without small words at both ends."""
    while (
        phrase
        and not _tells_where(phrase)
        and (phrase[-1].key in _EMPTY | _DANGLING | lexicon().determiners or not phrase[-1].is_word)
    ):
        if len(phrase) > 1 and len(phrase[-1].key) == 1 and phrase[-1].is_capital:
            # "Area A".
            break
        phrase = phrase[:-1]
    while phrase and (phrase[0].key in _EMPTY - {"here"} or not phrase[0].is_word):
        phrase = phrase[1:]
    if len(phrase) == 1 and phrase[0].key in {"me", "us", "you"}:
        return ()
    words = bare(phrase)
    return words if words and not (len(words) == 1 and words[0].key in lexicon().determiners) else ()
