"""Words turned from one speaker to another.

What the operator says, as the robot says it; what others tell or wish, as the operator would put it.
"""

from __future__ import annotations

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, singular

__all__ = [
    "as_others_say",
    "asked_directly",
    "counted_plainly",
    "shared_out",
    "still_there",
    "turned",
]

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
_KEPT = frozenset({"hanging", "growing", "stored", "stacked", "parked", "kept", "piled", "left", "remaining"})
"""How things are somewhere; being there is all that is asked."""
_FARTHEST = 7
"""How many words a thing that is counted may have."""


def counted_plainly(words: Phrase) -> Phrase:
    """For "how many A (that) you can see on B", "how many A there are on B": how many A on B."""
    flat = keys(words)
    for at in range(len(flat) - 4):
        if flat[at : at + 2] != ("how", "many"):
            continue
        for start in range(at + 3, min(at + 2 + _FARTHEST, len(flat) - 1)):
            end = start + (flat[start] == "that")
            if flat[start] == "are" and flat[start + 1] in _KEPT and lexicon().places.match(flat, start + 2):
                # "How many bunches are hanging in row 4".
                return (*words[: start + 1], *words[start + 2 :])
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


def as_others_say(words: Phrase) -> Phrase:
    """What others tell or wish, and what was done to none of several, in the words that the rest reads.

    Args:
        words: All words and punctuation.
    """
    return _none_yet(_wished_by_others(_as_telling(words)))


def _as_telling(words: Phrase) -> Phrase:
    """For "the people in A say it leaks" "... says it leaks": what several tell is no order to say it."""
    flat = keys(words)
    if flat[:1] and flat[0] not in _OPENING_SUBJECT:
        return words
    end = next((i for i, word in enumerate(words) if not word.is_word), len(words))
    at = next((i for i in range(2, min(end, _LONGEST_TELLER)) if flat[i] in _SAYING), 0)
    said = flat[at + 1 : end]
    told = len(said) > 2 and (said[0] in _TOLD_OF or said[0] in lexicon().determiners)
    several = any(word.endswith("s") or word in _SEVERAL for word in flat[1:3])
    if not at or not told or not several or _SAYING_ORDER & set(flat[:at]):
        return words
    verb = f"{flat[at]}s"
    return (*words[:at], Word(verb, verb), *words[at + 1 :])


_LONGEST_TELLER = 9
_OPENING_SUBJECT = frozenset({"the", "some", "two", "three", "four", "both", "our", "people", "several"})
_SAYING = frozenset({"say", "report", "complain", "claim"})
_TOLD_OF = frozenset({"it", "they", "there", "that", "their", "something", "somebody", "someone", "nobody"})
_SEVERAL = frozenset(
    {"couple", "family", "people", "children", "staff", "crew", "men", "women", "team", "class"}
)
_SAYING_ORDER = frozenset(
    {"then", "please", "should", "could", "can", "will", "must", "to", "not", "and", "go"}
)


def _wished_by_others(words: Phrase) -> Phrase:
    """For "it would be nice if the guests could hear A" "the guests would like to hear A"."""
    flat = keys(words)
    at = next((i + 1 for i in range(3, min(9, len(flat))) if flat[i] in {"if", "when"}), 0)
    if not at or not {"would", "could"} & set(flat[: at - 1]) or not _GOOD & set(flat[: at - 1]):
        return words
    link = next((i for i in range(at + 1, min(at + 8, len(flat) - 1)) if flat[i] in _COULD | _HAD), 0)
    who = {singular(word) for word in flat[at:link]}
    if not who & lexicon().person_words or who & _ANYBODY:
        return words
    has = flat[link] in _HAD or flat[link + 1] in {"have", "get"}
    rest = link + 1 + (has and flat[link] not in _HAD)
    if not has and flat[rest] not in _ENJOYED:
        return words
    like = ("would", "like") if has else ("would", "like", "to")
    return (*words[at:link], *(Word(word, word) for word in like), *words[rest:])


_GOOD = frozenset(
    {"nice", "lovely", "great", "good", "wonderful", "kind", "helpful", "brilliant", "fantastic"}
)
_COULD = frozenset({"could", "can", "might", "may"})
_HAD = frozenset({"had", "got"})
_ANYBODY = frozenset({"someone", "somebody", "anyone", "anybody", "everyone", "everybody"})
_ENJOYED = frozenset({
    "hear", "see", "learn", "know", "listen", "enjoy", "drink", "eat", "try", "taste", "read", "watch",
    "find",
})  # fmt: skip


def _none_yet(words: Phrase) -> Phrase:
    """For "neither of the A has been V-ed" "both A have not been V-ed", for "none of the A" "all the A"."""
    flat = keys(words)
    at = next((i for i in range(len(flat) - 5) if flat[i : i + 2] in _NONE_OF), -1)
    if at < 0 or (at and words[at - 1].is_word) or flat[at + 2] not in lexicon().determiners:
        return words
    link = next((i for i in range(at + 3, min(at + 9, len(flat) - 2)) if flat[i] in {"has", "have"}), 0)
    been = link + 1 + (flat[link + 1] == "yet")
    if not link or flat[been : been + 1] != ("been",) or not all(word.is_word for word in words[at:link]):
        return words
    every = ("both",) if flat[at] == "neither" else ("all", "the")
    put = (*(Word(word, word) for word in every), *words[at + 3 : link])
    denied = tuple(Word(word, word) for word in ("have", "not"))
    return (*words[:at], *put, *denied, *words[link + 1 :])


_NONE_OF = frozenset({("neither", "of"), ("none", "of")})
