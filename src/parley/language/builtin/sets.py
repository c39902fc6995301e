"""Several things named together: "both boxes", "gates 2 to 4", "every door except the north one".

A set is certain when each of its words is accounted for and the things of the map are as many as was said.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.builtin.amounts import amount_of
from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.language.builtin.saying import which_one
from parley.language.builtin.things import head_of, link, main_word
from parley.language.lexicon import word_set
from parley.world.object_map import MapObject

__all__ = ["Group", "apart", "group", "kinds", "number_of", "without"]

_QUANTIFIERS = frozenset({"all", "every", "each", "both", "whole", "single"})
_LINKING = frozenset({",", "and", "&", "plus"})
_RANGES = frozenset({"to", "through", "thru", "till", "until", "-", "–"})
_ORDER = {"first": 0, "second": 1, "third": 2, "fourth": 3, "fifth": 4, "last": -1}
_LOOSE = word_set("of the numbered number numbers them my our those these your too")


@dataclass(frozen=True, slots=True)
class Group:
    """Things that are meant together; or why that is not certain."""

    things: tuple[MapObject, ...] = ()
    doubt: str = ""
    choices: tuple[MapObject, ...] = ()
    """One of which is meant."""


def group(
    words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon, left_out: Sequence[str] = ()
) -> Group | None:
    """The set that words, in small letters, name, without what `left_out` names; None if they name no set."""
    if words and (words[0] in ("toward", "towards") or "between" in words):
        return None
    said = list(words)
    while said and said[0] in lexicon.classes["prepositions"]:
        del said[0]
    said, inner = apart(said, lexicon)
    left_out = [*inner, *left_out]
    if not said or len(_exact(said, objects, lexicon)) == 1:
        return None
    parts = [
        list(part) for linking, part in itertools.groupby(said, lambda word: word in _LINKING) if not linking
    ]
    if not parts:
        return None
    found = _listed(parts, objects, lexicon) if len(parts) > 1 else _part(parts[0], objects, lexicon)
    if found is not None and said[0] in ("any", "either") and len(found.things) > 1:
        names = [item.description for item in found.things]
        return Group(doubt=which_one(names), choices=found.things)
    if found is None or not left_out:
        return found
    return found if found.doubt else without(found, left_out, lexicon)


def apart(words: Sequence[str], lexicon: Lexicon) -> tuple[list[str], list[str]]:
    """What is named, and what is left out of it by the same words."""
    inner = next((at for at in range(1, len(words)) if _excepts(words, at, lexicon)), None)
    if inner is None:
        return [*words], []
    size = next(n for n in (4, 3, 2, 1) if " ".join(words[inner : inner + n]) in _excepting(lexicon))
    return [*words[:inner]], [*words[inner + size :]]


def _excepting(lexicon: Lexicon) -> frozenset[str]:
    return lexicon.classes["link_except"] | {"but"}


def _excepts(words: Sequence[str], at: int, lexicon: Lexicon) -> bool:
    return any(" ".join(words[at : at + size]) in _excepting(lexicon) for size in (4, 3, 2, 1))


def _exact(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> list[MapObject]:
    bare = stems([word for word in words if word not in lexicon.classes["determiners"]])
    return [
        item
        for item in objects
        if any(stems(text.split()) == bare for text in (item.description, *item.aliases))
        and not any(word in _QUANTIFIERS for word in words)
    ]


def _listed(parts: Sequence[list[str]], objects: Sequence[MapObject], lexicon: Lexicon) -> Group | None:
    """Things in a row; a noun may stand once for all of them: "rooms 2, 3 and 5"."""
    nouns = [noun for part in parts if (noun := _noun(part, objects, lexicon))]
    found: list[MapObject] = []
    for part in parts:
        own = _part(part, objects, lexicon)
        if own is not None and own.doubt:
            return own
        things = own.things if own is not None else _one(part, objects, lexicon)
        for noun in nouns[:1] + nouns[-1:]:
            if not things and not _noun(part, objects, lexicon):
                bare = _bare(part, lexicon)
                tried = _one([noun, *bare], objects, lexicon) or _one([*bare, noun], objects, lexicon)
                things = tuple(one for one in tried if {*stems(bare)} <= {*stems(one.description.split())})
        if not things:
            akin = link(part, head_of(part, lexicon), objects, lexicon)
            if akin.kind == "several":
                names = tuple(thing.description for thing in akin.things)
                return Group(doubt=which_one(names), choices=akin.things)
            return Group(doubt=f"I do not know any “{' '.join(part)}” here.")
        found += things
    return Group(tuple(dict.fromkeys(found)))


def _one(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> tuple[MapObject, ...]:
    if not words:
        return ()
    mention = link(words, head_of(words, lexicon), objects, lexicon)
    return mention.things if mention.kind == "one" else ()


def _bare(words: Sequence[str], lexicon: Lexicon) -> list[str]:
    """Without articles and prepositions; a letter at the end is a name."""
    small = lexicon.classes["determiners"] | lexicon.classes["prepositions"] | _LOOSE
    return [word for at, word in enumerate(words) if word not in small or (at and at == len(words) - 1)] or [
        *words[-1:]
    ]


def _noun(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> str:
    """The noun among words that is the kind of something on the map."""
    known = {kind for item in objects for kind in kinds(item)}
    return next((word for word in reversed(_bare(words, lexicon)) if stem(word) in known), "")


def kinds(item: MapObject) -> set[str]:
    """What a thing is: the word that names it, and its class."""
    named = stems(item.description.split())
    kind = main_word(named)
    if kind.isdigit() or len(kind) == 1:
        kind = next((word for word in reversed(named) if not word.isdigit() and len(word) > 1), kind)
    return {kind, *stems(item.class_name.split())[-1:]} - {""}


def _part(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> Group | None:
    """A set named by one noun; None if it is one thing, or none."""
    bare = [word for word in words if word not in lexicon.classes["prepositions"] or word in _RANGES]
    quantified = [word for word in bare if word in _QUANTIFIERS]
    span = _range(bare)
    noun = _noun(words, objects, lexicon)
    if not noun or (len(bare) > 1 and len(bare[-1]) == 1 and bare[-1].isalpha()):
        return _letters(bare, objects, lexicon) if noun else None
    counted = [word for word in bare if not word.isdigit() and word not in ("a", "an") and amount_of([word])]
    plural = stem(noun) != noun
    if not (quantified or plural or span):
        return None
    small = lexicon.classes["determiners"] | lexicon.classes["prepositions"] | _QUANTIFIERS | _LOOSE | _RANGES
    more = [
        word
        for word in bare
        if word not in small and word not in counted and word != noun and not (span and word.isdigit())
    ]
    chosen = [word for word in more if word in _ORDER]
    parity = [word for word in more if word.removesuffix("-numbered") in ("odd", "even")]
    kind = stems([word for word in more if word not in chosen and word not in parity])
    family = [
        item
        for item in objects
        if stem(noun) in kinds(item) and set(kind) <= set(stems([*item.description.split(), item.class_name]))
    ]
    return _counted(family, words, span, chosen, parity, counted, bool(quantified))


def _letters(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> Group | None:
    """For "gates A to C"; one letter alone names one thing."""
    if len(words) < 4 or words[-2] not in _RANGES or len(words[-3]) != 1:
        return None
    wanted = [chr(code) for code in range(ord(words[-3]), ord(words[-1]) + 1)]
    found = [thing for letter in wanted for thing in _one([*words[:-3], letter], objects, lexicon)]
    return (
        Group(tuple(found))
        if len(found) == len(wanted) > 1
        else Group(doubt=f"I do not know all of “{' '.join(words)}”.")
    )


def _counted(
    family: list[MapObject],
    words: Sequence[str],
    span: tuple[int, int] | None,
    chosen: Sequence[str],
    parity: Sequence[str],
    counted: Sequence[str],
    quantified: bool,
) -> Group | None:
    """As many of a family as was said."""
    text = " ".join(words)
    numbers = {item.id: number for item in family if (number := number_of(item)) is not None}
    count = (
        int(amount.value) if counted and (amount := amount_of(counted[:1])) else 2 if "both" in words else 0
    )
    if span is not None:
        wanted = range(span[0], span[1] + 1)
        family = [item for item in family if numbers.get(item.id) in wanted]
        complete = len(family) == len(wanted)
        return Group(tuple(family)) if complete else Group(doubt=f"I do not know all of “{text}”.")
    if parity:
        rest = 1 if parity[0].startswith("odd") else 0
        family = [item for item in family if item.id in numbers and numbers[item.id] % 2 == rest]
    if chosen:
        if len(numbers) < len(family) or not count:
            return Group(doubt=f"Which ones are “{text}”?")
        family.sort(key=lambda item: numbers[item.id])
        if len(family) < count:
            return Group(doubt=f"I know only {len(family)} of these.")
        return Group(tuple(family[-count:] if chosen[0] == "last" else family[:count]))
    if count and len(family) != count:
        return Group(doubt=f"I know {len(family)} of these, not {count}. Which ones do you mean by “{text}”?")
    if len(family) == 1 and quantified:
        return Group(doubt=f"I know only {family[0].description}. Is that what you mean by “{text}”?")
    return Group(tuple(family)) if len(family) > 1 else None


def _range(words: Sequence[str]) -> tuple[int, int] | None:
    for at in range(1, len(words) - 1):
        if words[at] in _RANGES and words[at - 1].isdigit() and words[at + 1].isdigit():
            first, last = int(words[at - 1]), int(words[at + 1])
            return (first, last) if first < last <= first + 50 else None
    return None


def number_of(item: MapObject) -> int | None:
    """The number at the end of a thing's name."""
    last = item.description.split()[-1]
    return int(last) if last.isdigit() else None


def without(whole: Group, words: Sequence[str], lexicon: Lexicon) -> Group:
    """A set without its exception, which names some of its own things."""
    family = whole.things
    text = " ".join(words)
    if not [word for word in words if word not in _LINKING]:
        return Group(doubt="Which one do you want left out?")
    gone: list[MapObject] = []
    for linking, part in itertools.groupby(
        words, lambda word: word in _LINKING or word in ("or", "not", "for")
    ):
        if linking:
            continue
        left = _named(list(part), family, lexicon)
        if len(left) != 1:
            return Group(doubt=f"Which one is “{text}”, that you want left out?")
        gone += left
    return Group(tuple(item for item in family if item not in gone))


def _named(words: Sequence[str], family: Sequence[MapObject], lexicon: Lexicon) -> list[MapObject]:
    """Which things of a family some words tell from the others."""
    loose = lexicon.classes["determiners"] | {"one", "ones", "number", "to", "at", "in"}
    wanted = [
        word
        for at, word in enumerate(words)
        if word not in loose or (at == len(words) - 1 > 0 and len(word) == 1)
    ]
    if len(wanted) == 1 and wanted[0] in _ORDER and all(number_of(item) is not None for item in family):
        ranked = sorted(family, key=lambda item: number_of(item) or 0)
        place = _ORDER[wanted[0]]
        return [ranked[place]] if -1 <= place < len(ranked) else []
    said = set(stems(wanted))
    common = set.intersection(*({*stems(item.description.split())} for item in family)) if family else set()
    said = said - common or said
    return [
        item for item in family if said and said <= set(stems([*item.description.split(), item.class_name]))
    ]
