"""Words turned from one speaker to another: what the operator says, as the robot says it."""

from __future__ import annotations

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, singular

__all__ = ["asked_directly", "counted_plainly", "shared_out", "still_there", "turned"]

_TURNED = {
    "me": "you", "my": "your", "i": "you", "us": "you", "myself": "yourself", "you": "me", "your": "my",
    "yourself": "myself", "mine": "yours", "we": "you", "our": "your",
}  # fmt: skip
_SUBJECT_AFTER = frozenset(
    {"until", "till", "when", "whether", "if", "that", "before", "after", "once", "while"}
)


def turned(words: Phrase) -> Phrase:
    """The operator's words as the robot repeats them: "until I call you" is "until you call me"."""
    result: list[Word] = []
    for index, word in enumerate(words):
        other = _TURNED.get(word.key)
        if word.key == "you" and index and words[index - 1].key in _SUBJECT_AFTER:
            other = "I"
        if word.key == "am" and result and result[-1].key == "you":
            other = "are"
        result.append(word if other is None else Word(other.lower(), other))
    return tuple(result)


_WHO_IS_ASKED = frozenset({"he", "she", "they", "it"})


def asked_directly(words: Phrase) -> str:
    """A reported question as it is put: "whether she needs help" is "Do you need help?"."""
    flat = keys(words)
    lead = flat[:1] if flat[:1] in {("whether",), ("if",)} else ()
    asks = () if lead else flat[:1] if flat[:1] and flat[0] in lexicon().question_starts else None
    if asks is None:
        return plain(words)
    rest = words[1:]
    at = 0 if lead or (rest and rest[0].key in _WHO_IS_ASKED) else -1
    if not lead and keys(rest[:1]) in {("their",), ("his",), ("her",)} and rest[-1].key in lexicon().be:
        return _question(f"{flat[0]} {rest[-1].key} your {plain(rest[1:-1])}")
    if at < 0 or not rest or rest[0].key not in _WHO_IS_ASKED:
        return _sentence(words if not lead else rest, bool(lead))
    verb, tail = rest[1:2], rest[2:]
    if not verb:
        return plain(words)
    if verb[0].key in lexicon().be:
        said = f"{'were' if verb[0].key in {'was', 'were'} else 'are'} you {plain(tail)}"
    elif verb[0].key in lexicon().auxiliaries - {"has", "have"}:
        said = f"{verb[0].key} you {plain(tail)}"
    else:
        said = f"do you {_base(verb[0].key)} {plain(tail)}"
    start = "" if lead else f"{flat[0]} "
    return _question(start + said)


def _base(verb: str) -> str:
    base = "have" if verb == "has" else lemma(verb)
    return singular(base) if base == verb else base


def _sentence(words: Phrase, reported: bool) -> str:
    """For "whether the bus is late", "what time it is": the verb before the subject."""
    flat = keys(words)
    link = next((i for i in range(1, len(flat)) if flat[i] in lexicon().be), 0)
    if not link:
        return plain(words)
    subject, verb, tail = words[:link], words[link], words[link + 1 :]
    return _question(f"{verb.key} {plain(subject)} {plain(tail)}") if reported else _question(plain(words))


def _question(text: str) -> str:
    text = " ".join(text.split())
    return f"{text[:1].upper()}{text[1:]}?"


def shared_out(words: Phrase) -> Phrase:
    """For "all decks, five litres each": five litres, for it is one order for each of them anyway."""
    ends = {quantity.end for quantity in quantities(words) if quantity.units}
    flat = keys(words)
    gone = {i for i in ends if flat[i : i + 1] in {("each",), ("apiece",)} and flat[i + 1 : i + 2] in _ENDING}
    return tuple(word for index, word in enumerate(words) if index not in gone)


_ENDING = {(), (".",), ("!",), (",",), ("?",), ("and",), ("then",)}
_SIGHTS = frozenset({"see", "find", "notice", "spot", "count", "discover"})
_FARTHEST = 7
"""How many words a thing that is counted may have."""


def counted_plainly(words: Phrase) -> Phrase:
    """For "how many A (that) you can see on B" and "how many A there are on B": how many A on B."""
    flat = keys(words)
    for at in range(len(flat) - 4):
        if flat[at : at + 2] != ("how", "many"):
            continue
        for start in range(at + 3, min(at + 2 + _FARTHEST, len(flat) - 1)):
            end = start + (flat[start] == "that")
            if flat[start : start + 2] == ("there", "are") and lexicon().places.match(flat, start + 2):
                return (*words[:start], *words[start + 2 :])
            sees = flat[end] in {"you", "we", "i"}
            end += 1 + (flat[end + 1 : end + 2] in {("can",), ("could",), ("will",)})
            if sees and flat[end : end + 1] and flat[end] in _SIGHTS and flat[end + 1 : end + 2]:
                return (*words[:start], *words[end + 1 :])
    return words


def still_there(words: Phrase) -> Phrase:
    """For "if there is no A left, V" "if there is no A, V"; "a door on the left" stays."""
    flat = keys(words)
    for at in range(3, len(flat)):
        ends = flat[at] in {"left", "remaining"} and (at + 1 == len(flat) or not words[at + 1].is_word)
        there = next((i for i in range(at - 2, max(at - _FARTHEST, 0), -1) if flat[i - 1] == "there"), 0)
        if ends and there and flat[there] in lexicon().be and flat[at - 1] not in lexicon().determiners:
            return (*words[:at], *words[at + 1 :])
    return words
