"""Mentions: which thing of the map, which person or which remembered thing words mean."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rapidfuzz.distance import OSA

from parley.language.builtin.amounts import is_compass
from parley.language.builtin.lexicon import Lexicon, is_somebody, stem, stems
from parley.language.lexicon import word_set
from parley.world.object_map import MapObject

__all__ = ["Mention", "head_of", "kind_of", "link", "main_word", "noun_phrase"]

Kind = Literal["one", "part", "several", "unclear", "none", "speaker", "pronoun", "person", "here"]


@dataclass(frozen=True, slots=True)
class Mention:
    """What words refer to."""

    kind: Kind
    text: str
    """The noun phrase as it was said, without article."""
    things: tuple[MapObject, ...] = ()


def noun_phrase(words: Sequence[str], head: int, lexicon: Lexicon) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The words that name the thing, and those that say where it is or which one.

    Args:
        words: Of the span, in small letters.
        head: Which of them names the thing.
        lexicon: Closed classes.
    """
    start = 0
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"] | {"of", "uh", "um"}
    while start < min(head, len(words) - 1) and words[start] in small:
        start += 1
    end = head + 1
    if end + 1 < len(words) and words[end] == "of" and words[end + 1] not in lexicon.classes["prepositions"]:
        end += 2
        led = words[head + 2] in lexicon.classes["determiners"]  # "of the red crate"
        while (
            end < len(words)
            and words[end] not in lexicon.classes["prepositions"]
            and (led or len(words[end]) == 1 or words[end].isdigit())
        ):
            end += 1
    name = words[start:end]
    return tuple(name), tuple(words[end:])


def head_of(words: Sequence[str], lexicon: Lexicon) -> int:
    """Which word of a description names the thing: the last one before a preposition."""
    small = lexicon.classes["prepositions"]
    first = next(
        (at for at, word in enumerate(words) if word not in small | lexicon.classes["determiners"]), 0
    )
    stop = next((at for at in range(first + 1, len(words)) if words[at] in small), len(words))
    return stop - 1


def link(words: Sequence[str], head: int, objects: Sequence[MapObject], lexicon: Lexicon) -> Mention:
    """What words mean among the things of the map."""
    referring = _referring(words, head, lexicon)
    if referring is not None:
        return referring
    exact = _called(words, objects, lexicon)
    if len(exact) == 1:
        return Mention("one", exact[0].description, tuple(exact))
    name, rest = noun_phrase(words, head, lexicon)
    if name and name[-1] in ("one", "ones"):
        told = [item for item in objects if set(stems(name[:-1])) <= set(stems(item.description.split()))]
        return (
            Mention("one", told[0].description, tuple(told))
            if len(told) == 1
            else Mention("none", " ".join(name))
        )
    best = _best(name, objects)
    if best and any(is_compass(word) for word in name) and _rank_of(name, best[0]) > 1:
        return Mention("none", " ".join((*name, *rest)))
    part = name.index("of") if "of" in name[:-1] else 0
    if part and (not best or _rank_of(name, best[0]) > 1):
        of_whole = name[part - 1] in lexicon.classes["parts"]
        whole = [*itertools.dropwhile(lexicon.classes["determiners"].__contains__, name[part + 1 :])]
        best = _best(whole if of_whole else name[:part], objects)
        if of_whole and len(best) == 1:
            return Mention("part", " ".join((*name, *rest)), tuple(best))
        held = name[part + 1] in lexicon.classes["determiners"]  # "the lid of the jar" is no jar
        held = held or name[part - 1] in lexicon.classes["containers"]
        if best and not of_whole and not held and _best(whole, objects) not in ([], best):
            return Mention("unclear", " ".join(name), (*best, *_best(whole, objects)))
    best = best or _otherwise_called(name, objects, lexicon)
    if not best:
        return Mention("none", " ".join((*name, *rest)))
    if len(best) > 1 and rest:
        hints, without = {*_content(rest, lexicon)}, not lexicon.classes["negations"].isdisjoint(rest)
        nearer = [item for item in best if hints.isdisjoint(stems(item.description.split())) is without]
        best = nearer or best
    return Mention("one" if len(best) == 1 else "several", " ".join((*name, *rest)), tuple(best))


def whole_of(
    words: Sequence[str], head: int, objects: Sequence[MapObject], lexicon: Lexicon
) -> MapObject | None:
    """The thing of which words name a part that no map knows: "the hinge of the gate", "the gate's hinge"."""
    name, rest = noun_phrase(words, head, lexicon)
    at = name.index("of") if "of" in name[:-1] else 0
    said = (*name, *rest)
    if "'s" in said[1:-1]:
        name, at = ("of", *said[: said.index("'s")]), 0
    elif not at or name[at + 1] not in lexicon.classes["determiners"] or is_somebody(name[at - 1]):
        return None
    whole = [*itertools.dropwhile(lexicon.classes["determiners"].__contains__, name[at + 1 :])]
    found = _best(whole, objects)
    return found[0] if len(found) == 1 and _rank_of(whole, found[0]) <= 1 else None


def _referring(words: Sequence[str], head: int, lexicon: Lexicon) -> Mention | None:
    """What "me", "here" and pronouns mean."""
    small = lexicon.classes["determiners"] | lexicon.classes["prepositions"]
    bare = [word for word in words if word not in small and word != "back"]  # "come back to me"
    if words[head] in lexicon.classes["me"] or any(word in lexicon.classes["me"] for word in bare[:1]):
        return Mention("speaker", "me")
    if " ".join(words[words[0] == "to" :]) in lexicon.classes["here"]:
        return Mention("here", "here")
    if words[head] in lexicon.classes["persons"]:
        return Mention("pronoun", words[head])
    if words[head] in lexicon.classes["pronouns"] and len(bare) <= 1:
        return Mention("pronoun", words[head])
    return None


def _called(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> list[MapObject]:
    """The things that are called by just these words, whatever article or preposition leads to them."""
    start = 0
    leads = lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    while start < len(words) - 1 and words[start] in leads:
        start += 1
    said = [word for word in words[start:] if word not in ("'s", "’s")]  # "the baby's chair"

    def bare(name: Sequence[str]) -> tuple[str, ...]:  # "the crate with lid" is the one "with a lid"
        inner = (word for word in name[1:-1] if word not in lexicon.classes["determiners"])
        return stems([*name[:1], *inner, *name[1:][-1:]])

    for told in (stems, bare):
        names = [(item, (item.description, *item.aliases)) for item in objects]
        if found := [item for item, called in names if told(said) in [told(n.split()) for n in called]]:
            return found
    return []


def _content(words: Sequence[str], lexicon: Lexicon) -> list[str]:
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    return [stem(word) for word in words if word not in small]


def _best(name: Sequence[str], objects: Sequence[MapObject]) -> list[MapObject]:
    """The things that fit best: called so; by more words; by fewer; mistyped; as the end of a word."""
    wanted = stems(name)
    if not wanted:
        return []
    ranked: dict[int, list[MapObject]] = {}
    for item in objects:
        rank = _rank_of(name, item)
        if rank < 9:
            ranked.setdefault(rank, []).append(item)
    found = ranked[min(ranked)] if ranked else []
    return [item for item in found if _ends_as_said(name, item)] or found


def _ends_as_said(name: Sequence[str], item: MapObject) -> bool:
    """Whether a thing is called by just this last word: "glasses" are not the glass."""
    written = (tuple(text.lower().split()) for text in (item.description, *item.aliases))
    return any(_naming(words)[-1:] == tuple(name[-1:]) for words in written)


def _otherwise_called(name: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> list[MapObject]:
    """The things that have another name of what was said; of the longest name in it."""
    for start in range(len(name)):
        said = tuple(name[start:])
        others = lexicon.synonyms.get(said) or lexicon.synonyms.get(stems(said), frozenset())
        found = [item for item in objects if not others.isdisjoint(_names(item))]
        if found:
            return found
    for at, word in enumerate(name):  # "the big chair" is the large one
        for other in sorted(lexicon.synonyms.get((word,), ())):
            swapped = (*name[:at], *other, *name[at + 1 :])
            if found := [item for item in _best(swapped, objects) if _rank_of(swapped, item) == 0]:
                return found
    return []


def _names(item: MapObject) -> set[tuple[str, ...]]:
    """What a thing is called, word by word, as it is written and without plurals."""
    written = [tuple(text.lower().split()) for text in (item.description, *item.aliases)]
    return {*written, *(stems(words) for words in written)}


def _rank_of(name: Sequence[str], item: MapObject) -> int:
    wanted = stems(name)
    names = [known for text in (item.description, *item.aliases) if (known := stems(text.split()))]
    rank = min((_rank(wanted, known) for known in names), default=9)
    known = stems(item.id.split())
    return min(rank, max(_rank(wanted, known), 1) if known else 9)


def _rank(wanted: tuple[str, ...], known: tuple[str, ...]) -> int:
    if wanted == known or set(wanted) == set(known) or "".join(wanted) == "".join(known):
        return 0
    if wanted in (_naming(known)[-len(wanted) :], kind_of(known)[-len(wanted) :]) or (
        set(wanted) <= set(known) and wanted[-1] == main_word(known)
    ):
        return 1
    if wanted[-len(known) :] == known:
        return 2
    if len(wanted) == len(known) and all(
        _alike(one, other) for one, other in zip(wanted, known, strict=True)
    ):
        return 3
    if len(wanted[-1]) > 3 and len(known) == 1 and known[0].endswith(wanted[-1]):
        return 4
    name = _naming(known)
    found = [next((at for at, word in enumerate(name) if _same_root(one, word)), -1) for one in wanted]
    told = any(len(name[at]) == 1 or name[at].isdigit() for at in found if at >= 0)  # "store B"
    if len(wanted) > 1 and -1 not in found and (told or name[found[-1]] == main_word(kind_of(known))):
        return 5
    return 9


_ROOT = re.compile(r"(?<=\w{4})(?:ing|age|er|ed|ion|or)$")


def _same_root(one: str, other: str) -> bool:
    """Whether two words are one but for their ending: "holder" and "holding"."""
    return one == other or (len(one) > 4 and _ROOT.sub("", one) == _ROOT.sub("", other))


_PLACING = word_set("in of by at near next on with beside behind under above between opposite")


def main_word(known: tuple[str, ...]) -> str:
    """The word that names the thing: the last one before "in", "of", "by" ..."""
    return _naming(known)[-1]


def _naming(known: tuple[str, ...]) -> tuple[str, ...]:
    """What names the thing, without what says where it is."""
    end = next((at for at, word in enumerate(known) if word in _PLACING and at), len(known))
    return known[:end]


def kind_of(known: tuple[str, ...]) -> tuple[str, ...]:
    """What kind of thing is named, without its number or letter: "bay" of "bay 2"."""
    name = _naming(known)
    return name[:-1] if len(name) > 1 and (name[-1].isdigit() or len(name[-1]) == 1) else name


def _alike(one: str, other: str) -> bool:
    return one == other or (min(len(one), len(other)) > 4 and OSA.distance(one, other) == 1)
