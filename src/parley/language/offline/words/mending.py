"""Typing errors in small words and verbs put right before anything else; nouns are compared loosely later."""

from __future__ import annotations

import re
from collections.abc import Container
from functools import cache, lru_cache
from itertools import pairwise

from rapidfuzz.distance import OSA

from parley.language.base import Situation
from parley.language.offline.words.inflecting import forms
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.quantities import is_unit, number_words
from parley.language.offline.words.text import (
    Phrase,
    Word,
    closest,
    keys,
    lemma,
    mend,
    singular,
    split_name,
    tokens,
)
from parley.language.word_lists import load_data

__all__ = ["mended"]

_LOOKS = frozenset(
    load_data("people")["worn"] + load_data("people")["posture"] + load_data("people")["superlatives"]
)
"""Words about looks, which are no typing errors."""


_INCIDENTS = load_data("incidents")
_REPORTED = forms(_INCIDENTS["events"]) | frozenset(
    word for kind in ("events", "happened", "states", "things") for word in _INCIDENTS[kind]
)
"""Words for what people report, which are no typing errors."""
_LONG_ENOUGH = 4
_REAL = frozenset(load_data("real_words")["words"])


def mended(words: Phrase, situation: Situation) -> Phrase:
    """Typing errors in small words and verbs put right; nouns are compared loosely later."""
    known = set(lexicon().vocabulary | _LOOKS | _REPORTED | _REAL)
    words = _small(_apart(words, situation), situation)
    for item in situation.objects:
        known.update(
            word.key
            for text in (item.description, *item.aliases, item.class_name, item.id)
            for word in tokens(text)
        )
    for entry in situation.memory:
        known.update(word.key for word in tokens(entry.data[:400]))
    for info in situation.catalogue:
        known.update(split_name(info.name))
    known.update(name.lower() for name in situation.robots)
    named = _named(situation)
    longer = _longer(named)
    offered, about = _offered(tuple((info.name, info.description) for info in situation.catalogue))
    known.update(about)
    own = {split_name(info.name)[0] for info in situation.catalogue if split_name(info.name)} | offered
    inflected = forms(verb for verb in own if len(verb) > _SHORT_NAME - 1)
    known.update(inflected)
    inflected = frozenset(form for form in inflected if len(form) > _SHORT_NAME and form.endswith(_FORMS))
    own = {verb for verb in own if len(verb) > _SHORT_NAME} | offered
    words = tuple(
        part
        for index, word in enumerate(words)
        for part in ((word,) if _stays_whole(word, index, longer) else _cut(word, frozenset(known)))
    )
    told = named | {word.lower() for entry in situation.memory for word in _LONG.findall(entry.data[:400])}
    words = tuple(word if word.key in known else _unswapped(_as_offered(word, about), told) for word in words)
    words = _with_a_look(words)
    words = mend(words, frozenset(known), lexicon().often_mistyped | inflected, _verbs() | own)
    return _without_haste(_counted(words, known))


_MISTYPED: dict[str, str] = load_data("real_words")["mistyped"]
"""What is never a word, and what is meant by it."""
_PARTS_OF = frozenset(load_data("real_words")["parts_of"])
_ONLY_BEFORE_ARTICLES = frozenset({"ta", "ni", "fro"})


def _small(words: Phrase, situation: Situation) -> Phrase:
    """Words of two or three letters with the letters the wrong way round: "ot the door adn back"."""
    if not any(word.key in _MISTYPED for word in words):
        return words
    names = {word for item in situation.objects for word in split_name(f"{item.description} {item.id}")}
    result: list[Word] = []
    for index, word in enumerate(words):
        meant = _MISTYPED.get(word.key, "")
        following = words[index + 1] if index + 1 < len(words) else None
        # Nothing stands before "ot", a name is in capitals, and "ta" alone is thanks.
        if not meant or word.key in names or word.is_capital or not result or following is None:
            result.append(word)
            continue
        if word.key in _ONLY_BEFORE_ARTICLES and following.key not in _OBJECTS:
            meant = word.key
        if word.key == "fo" and keys(words[max(index - 1, 0) : index]) in _PARTS:
            meant = "of"
        result.append(Word(meant, meant))
    return tuple(result)


_OBJECTS = frozenset({
    "the", "teh", "hte", "a", "an", "my", "your", "this", "that", "me", "us", "him", "her", "them", "it",
})  # fmt: skip
_PARTS = frozenset((word,) for word in _PARTS_OF)


def _counted(words: Phrase, known: Container[str]) -> Phrase:
    """For "fiev minutes" "five minutes": a number stands before what it counts."""
    result = list(words)
    for at, (word, following) in enumerate(pairwise(words)):
        if word.key in known or not word.key.isalpha() or len(word.key) < _SHORT_NAME:
            continue
        if not is_unit(following.key) and following.key != "times":
            continue
        meant = closest(word.key, number_words())
        result[at] = Word(meant, meant) if meant else word
    return tuple(result)


@lru_cache(maxsize=16)
def _offered(catalogue: tuple[tuple[str, str], ...]) -> tuple[frozenset[str], frozenset[str]]:
    """The verbs of a catalogue's names, written out, and the longer words of its names and descriptions."""
    names = [name_words(name) for name, _ in catalogue]
    first = {lemma(words[0]) for words in names if words}
    verbs = {verb for verb in first if len(verb) >= _SHORT_NAME}
    told = (re.findall(r"[a-z]+", description.lower()) for _, description in catalogue)
    about = {word for words in (*names, *told) for word in words if len(word) > _SHORT_NAME}
    return frozenset(verbs), frozenset(about)


def _as_offered(word: Word, about: frozenset[str]) -> Word:
    """A typing error in a word that says what an action of the catalogue is for ("borad")."""
    if word.is_capital or len(word.key) <= _SHORT_NAME or not word.key.isalpha() or _is_real(word.key):
        return word
    meant = closest(word.key, about)
    if meant is None or meant.startswith(word.key[:-1]) or word.key.startswith(meant[:-1]):
        # "Cleaner" and "bakery" are no errors for "clean" and "baker".
        return word
    swapped = sorted(meant) == sorted(word.key)
    short = len(word.key) == _SHORT_NAME + 1 and len(meant) <= len(word.key)
    if not swapped and (short or len(word.key) <= _SHORT_NAME or OSA.distance(meant, word.key) > 1):
        return word
    return Word(meant, meant)


def _is_real(word: str) -> bool:
    """Whether a word, or the word that it is a form of, is in any of the lists."""
    return bool({singular(word), lemma(word)} & _listed())


@cache
def _listed() -> frozenset[str]:
    """All words of the lists of deeds, things and words."""
    deeds = load_data("deeds")
    lines = (line for kind in ("verbs", "near", "nouns") for line in deeds[kind])
    told = frozenset(word for line in lines for phrase in line for word in phrase.split())
    return told | lexicon().nouns | lexicon().vocabulary | frozenset(lexicon().synonyms) | _REAL


_THINGS = {
    tuple(sorted(word)): word
    for line in (*load_data("deeds")["nouns"], _INCIDENTS["things"])
    for word in line
    if len(word) > _LONG_ENOUGH and word.isalpha()
}
"""Words for common things by their letters."""


def _unswapped(word: Word, named: frozenset[str]) -> Word:
    """For "ligths" "lights": two letters the wrong way round in a word for a thing, common or on the map."""
    letters = tuple(sorted(word.key))
    meant = _THINGS.get(letters, "")
    if not meant and len(word.key) >= _SHORT_NAME and not _is_real(word.key):
        meant = next((one for one in named if tuple(sorted(one)) == letters), "")
    differ = [i for i, (one, other) in enumerate(zip(word.key, meant, strict=False)) if one != other]
    swapped = len(differ) == len("ab") and differ[1] == differ[0] + 1 and not word.is_capital
    return Word(meant, meant) if swapped else word


_LONG = re.compile(r"\b[a-z]{5,}\b")
_FORMS = ("ed", "ing")
_SHORT_NAME = 4
"""Words of so many letters in an action's name may be short for something."""


def _with_a_look(words: Phrase) -> Phrase:
    """For "hav a lok at" "have a look at": what is had or taken at something is a look."""
    flat = keys(words)
    result = list(words)
    for at in range(len(flat) - 3):
        noun = at + 2 + (flat[at + 2] in _SHORT_LOOKS)
        had = next((v for v in ("have", "take") if OSA.distance(flat[at], v) < 2), "")
        if not had or flat[at + 1] != "a" or flat[noun + 1 : noun + 2] not in _BEHIND_LOOK:
            continue
        if OSA.distance(flat[noun], "look") < 2:
            result[at], result[noun] = Word(had, had), Word("look", "look")
    return tuple(result)


_SHORT_LOOKS = frozenset({"quick", "good", "closer", "close", "short", "proper", "brief"})
_BEHIND_LOOK = frozenset({("at",), ("in",), ("into",), ("round",), ("around",), ("inside",)})


def _named(situation: Situation) -> frozenset[str]:
    """The longer words of what is on the map."""
    texts = (f"{item.description} {item.class_name}" for item in situation.objects)
    return frozenset(word.key for text in texts for word in tokens(text) if len(word.key) >= _SHORT_NAME)


def _longer(words: frozenset[str]) -> frozenset[str]:
    return frozenset(word for word in words if len(word) > _SHORT_NAME)


def _stays_whole(word: Word, index: int, named: frozenset[str]) -> bool:
    """Whether a word is no two: a name, or a mistyped word of the map ("ofice")."""
    name = index > 0 and word.is_capital and not word.raw.isupper()
    return name or closest(word.key, named) is not None


_ARTICLES = frozenset({"the", "a", "an", "my", "your", "this", "that"})
_LABEL = re.compile(r"([a-z]{2,})-?(\d{1,3})")


def _cut(word: Word, known: frozenset[str]) -> tuple[Word, ...]:
    """For "gotothe" "go to the", for "inspectthe" "inspect the": unknown words cut into small ones."""
    key = word.key
    if len(key) < 5 or not key.isalpha() or key in known:
        return (word,)
    for size in range(2, len(key) - 1):
        head, tail = key[:size], key[size:]
        if (head not in _GLUE and head not in _verbs()) or (
            head not in _GLUE and tail[:3] not in {"the", "at", "to"}
        ):
            continue
        rest = (Word(tail, tail),) if tail in known and len(tail) > 1 else _cut(Word(tail, tail), known)
        if len(rest) > 1 or (tail in known and len(tail) > 1):
            return (Word(head, head), *rest)
    return (word,)


_GLUE = frozenset(
    {
        "go",
        "to",
        "the",
        "and",
        "in",
        "into",
        "at",
        "on",
        "then",
        "from",
        "of",
        "for",
        "goto",
        "tothe",
        "look",
        "check",
    }
)


def _apart(words: Phrase, situation: Situation) -> Phrase:
    """Words written together or cut in the wrong place ("box1", "tot he box", "off ice"); "2" for "to"."""
    texts = (f"{item.description} {item.class_name}" for item in situation.objects)
    named = {word.key for text in texts for word in tokens(text)}
    compounds = _compounds(situation)
    result: list[Word] = []
    words = tuple(_unstretched(word) for word in words)
    for at in range(len(words) - 1):
        if words[at].key == "no" and words[at + 1].key == "one":
            words = (*words[:at], Word("nobody", "nobody"), *words[at + 2 :])
            break
    flat = tuple(word.key for word in words)
    index = 0
    while index < len(words):
        word, following = words[index], flat[index + 1] if index + 1 < len(flat) else ""
        label = _LABEL.fullmatch(word.key)
        if word.key[-1:] == "t" and following == "he" and word.key[:-1] in _BEFORE_THE:
            result += [Word(word.key[:-1], word.raw[:-1]), Word("the", "the")]
            index += 2
            continue
        if len(word.key) > 2 and len(following) > 2 and word.key + following in named - {*compounds}:
            result.append(Word(word.key + following, word.raw + following))
            index += 2
            continue
        if word.key in compounds and word.key not in named:
            result += [Word(part, part) for part in compounds[word.key]]
        elif label and word.key not in named and label[1] in named and label[2] in named:
            result += [Word(label[1], label[1]), Word(label[2], label[2])]
        elif word.key in _SHORTHAND and "n" not in named and 0 < index < len(words) - 1:
            short = _SHORTHAND[word.key]
            numbered = {"4", singular(flat[index - 1])} <= set(named)
            fits = word.key != "4" or (
                flat[index - 1] in {"look", "search", "wait", "check"}
                or (following in _FOR_WHOM and not numbered)
            )
            result.append(Word(short, short) if fits else word)
        elif (
            word.key == "2"
            and index
            and (following in _ARTICLES or (flat[index - 1] in _GOING and not _more_than(flat, index, named)))
            and not {"2", flat[index - 1]} <= set(named)
        ):
            result.append(Word("to", "to"))
        else:
            result.append(word)
        index += 1
    return tuple(result)


def _more_than(flat: tuple[str, ...], index: int, named: Container[str]) -> bool:
    """For "the doors over 2": a number."""
    return flat[index - 1] == "over" and index > 1 and singular(flat[index - 2]) in named


def _compounds(situation: Situation) -> dict[str, tuple[str, ...]]:
    """Names of two words as they are written together: "livingroom"."""
    found: dict[str, tuple[str, ...]] = {}
    for item in situation.objects:
        name = tuple(word.key for word in tokens(item.description))
        for first, second in pairwise(name):
            if len(first) > 2 and len(second) > 2:
                found[first + second] = (first, second)
    return found


def _unstretched(word: Word) -> Word:
    """For "gooo" "go"."""
    for kept in (r"\1", r"\1\1"):
        shorter = re.sub(r"([a-z])\1{2,}", kept, word.key)
        if shorter != word.key and shorter in lexicon().vocabulary:
            return Word(shorter, shorter)
    return word


_SHORTHAND = {"n": "and", "4": "for", "da": "the", "m8": "mate", "thru": "through", "abt": "about"}
_FOR_WHOM = _ARTICLES | {"me", "us", "him", "her", "them", "you"}
_GOING = frozenset({"go", "drive", "come", "move", "head", "walk", "navigate", "return", "back", "over"})
_BEFORE_THE = frozenset({"to", "in", "on", "at", "a", "for", "of", "by", "from", "into", "near", "and"})
_HASTE = frozenset(
    [
        "quick",
        "brief",
        "short",
        "close",
        "closer",
        "good",
        "proper",
        "careful",
        "thorough",
        "little",
        "nice",
        "visual",
        "full",
        "complete",
        "routine",
        "detailed",
        "rapid",
    ]
)
_DEEDS = frozenset(
    [
        "look",
        "peek",
        "glance",
        "visit",
        "picture",
        "photo",
        "trip",
        "stop",
        "check",
        "round",
        "inspection",
        "survey",
        "scan",
    ]
)


_BEFORE_HASTE = _HASTE | {"a", "another", ",", ".", "and"}


def _between_haste(words: Phrase, index: int) -> bool:
    """For the comma of "a quick, close look"."""
    return words[index - 1].key in _HASTE and words[index + 1].key in _HASTE


def _without_haste(words: Phrase) -> Phrase:
    """For "have a quick look" reads "have a look": how it is done changes nothing."""
    words = tuple(
        word
        for index, word in enumerate(words)
        if word.key != "," or not 0 < index < len(words) - 1 or not _between_haste(words, index)
    )
    flat = tuple(word.key for word in words)
    return tuple(
        word
        for index, word in enumerate(words)
        if not (
            word.key in _HASTE
            and (index == 0 or flat[index - 1] in _BEFORE_HASTE)
            and next((key for key in flat[index + 1 :] if key not in _HASTE), "") in _DEEDS
        )
    )


@cache
def _verbs() -> frozenset[str]:
    """First words of the verbs that typing errors are mended to."""
    classes = lexicon().verb_classes
    return frozenset(verb.split()[0] for name, verbs in classes.items() if name != "other" for verb in verbs)
