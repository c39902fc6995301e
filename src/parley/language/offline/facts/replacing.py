"""Facts told by what they take the place of, put plainly.

"It is not A that S, it is B" is "B S", "we changed A to B" is "A is now B", "A is not B any more, it is C" is
"A is C", "I was wrong about A, they are in B" is "A are in B".
"""

from __future__ import annotations

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, singular

__all__ = ["put_plainly"]

_ENDS = frozenset({".", "!", "?", ";", "\n"})
_SOMEBODY = frozenset({"i", "we", "they", "somebody", "someone", "he", "she"})
_CHANGING = frozenset(
    {"changed", "renamed", "switched", "reset", "altered", "updated", "corrected", "extended"}
)
_AROUND = frozenset({"have", "has", "just", "now", "recently", "also", "already"})
_PRONOUNS = frozenset({"it", "they", "he", "she", "that", "this", "those", "these"})
_ENDING = (("any", "more"), ("anymore",), ("any", "longer"))
_WRONG = frozenset({"wrong", "mistaken"})
_PEOPLE = frozenset({"i", "you", "me", "us", "we", "worries", "concerns", "bothers", "needs", "wants"})
_IS, _ARE, _NOW = Word("is", "is"), Word("are", "are"), Word("now", "now")


def put_plainly(words: Phrase) -> Phrase:
    """A message with what it tells by way of correction put as a plain statement; else as it is.

    Args:
        words: All words and punctuation.
    """
    words = _has_put(_without_taking_back(words))
    for reader in (_cleft, _changed, _no_longer, _wrong_about, _has_moved):
        found = reader(words, keys(words))
        if found:
            return found
    return words


def _without_taking_back(words: Phrase) -> Phrase:
    """For "actually, scratch that, S", said of what was told before: S."""
    flat = keys(words)
    at = next((i for i in range(min(4, len(flat))) if flat[i] in {"scratch", "strike"}), -1)
    leads = {"actually", "no", "sorry", "wait", "oh", ",", "."}
    if at < 0 or flat[at + 1 : at + 3] not in {("that", ","), ("that", "."), ("that", "!")}:
        return words
    return words[at + 3 :] if set(flat[:at]) <= leads and len(flat) > at + 4 else words


def _has_put(words: Phrase) -> Phrase:
    """For "Anna put it on the desk" "Anna has put ...": no order."""
    for at in range(len(words) - 2):
        opens = at == 0 or not words[at - 1].is_word
        name = words[at].is_capital and words[at].key not in lexicon().vocabulary
        if opens and name and words[at + 1].key == "put":
            return (*words[: at + 1], Word("has", "has"), *words[at + 1 :])
    return words


def _end(flat: tuple[str, ...], start: int, marks: frozenset[str] = _ENDS) -> int:
    return next((i for i in range(start, len(flat)) if flat[i] in marks), len(flat))


def _cleft(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "it is not A that S, it is B" and "it is B that S, not A": "B S"."""
    if flat[:2] == ("it", "is") and flat[2:3] != ("not",):
        return _only_denied(words, flat)
    if flat[:3] != ("it", "is", "not") or "," not in flat[4:]:
        return ()
    comma = flat.index(",", 4)
    that = next((i for i in range(4, comma) if flat[i] in {"that", "which", "who"}), 0)
    rest = next((n for n in (("it", "is"), ("but",)) if flat[comma + 1 : comma + 1 + len(n)] == n), ())
    end = _end(flat, comma + 1, _ENDS | {","})
    other, said = words[comma + 1 + len(rest) : end], words[that + 1 : comma]
    if not that or not rest or not other or len(said) < 2 or _PEOPLE & set(keys(said)):
        return ()
    return (*other, *said, *words[end:])


def _only_denied(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "it is B that S, not A": "B S"."""
    that = next((i for i in range(3, min(8, len(flat))) if flat[i] in {"that", "which", "who"}), 0)
    comma = next((i for i in range(that, len(flat) - 1) if flat[i : i + 2] == (",", "not")), 0)
    end = _end(flat, comma)
    if not that or comma < that + 2 or _PEOPLE & set(flat[that:comma]) or end - comma > 6:
        return ()
    return (*words[2:that], *words[that + 1 : comma], *words[end:])


def _changed(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "we have changed A to B": "A is now B"."""
    if flat[:1] == () or flat[0] not in _SOMEBODY:
        return ()
    at = next((i for i in range(1, min(4, len(flat))) if flat[i] not in _AROUND), len(flat))
    end = _end(flat, at, _ENDS | {","})
    if at >= len(flat) or flat[at] not in _CHANGING:
        return ()
    to = next((i for i in range(at + 2, end - 1) if flat[i] in {"to", "into"}), 0)
    if not to or lexicon().be & set(flat[at:end]):
        return ()
    return (*words[at + 1 : to], _is(words[at + 1 : to]), _NOW, *words[to + 1 :])


def _no_longer(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "A is not B any more, it is C now": "A is C now"."""
    link = next((i for i in range(1, min(7, len(flat))) if flat[i] in lexicon().be), 0)
    comma = _end(flat, link, frozenset({",", ";", ".", "-"}))
    if not link or comma >= len(flat) - 2 or flat[0] in _PRONOUNS | _SOMEBODY | lexicon().question_starts:
        return ()
    ended = any(flat[comma - len(e) : comma] == e for e in _ENDING) and flat[link + 1] == "not"
    ended = ended or flat[link + 1 : link + 3] == ("no", "longer")
    start = comma + 1 + (flat[comma + 1] in {"but", "now", "and"})
    if not ended or flat[start : start + 1] == () or flat[start] not in _PRONOUNS:
        return ()
    if flat[start + 1 : start + 2] == () or flat[start + 1] not in lexicon().be:
        return ()
    return (*words[:link], *words[start + 1 :])


def _has_moved(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "A has moved, she is in B now": "A is in B now"; that A moved says nothing more."""
    link = next((i for i in range(1, min(7, len(flat))) if flat[i] in {"has", "have", "was", "were"}), 0)
    end = _end(flat, link, _ENDS | {",", "-", "and"}) if link else len(flat)
    said = flat[link + 1 : end]
    while said[:1] and said[0] in _AROUND | {"been", "recently"}:
        said = said[1:]
    moved = said in _MOVED or (len(said) == 2 and said[0] in _SWAPPED)
    start = end + 1 + (flat[end + 1 : end + 2] in {("and",), ("now",)})
    if not moved or flat[0] in _PRONOUNS | _SOMEBODY | lexicon().question_starts or "?" in flat:
        return ()
    if flat[start : start + 1] == () or flat[start] not in _PRONOUNS:
        return ()
    where = flat[start + 1 : start + 2] != () and flat[start + 1] in lexicon().be | _STAYING
    return (*words[:link], *words[start + 1 :]) if where else ()


_STAYING = frozenset({"lives", "live", "works", "work", "sits", "sit", "sleeps", "stays", "stands", "parks"})
_MOVED = frozenset({("moved",), ("moved", "house"), ("relocated",), ("moved", "away"), ("moved", "on")})
_SWAPPED = frozenset({"changed", "swapped", "switched", "moved"})


def _wrong_about(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "I was wrong about A, they are in B": "A are in B"."""
    at = next((i for i in range(min(9, len(flat))) if flat[i] == "about"), 0)
    end = comma = _end(flat, at, frozenset({",", ":", ".", ";", "-"}))
    if at and flat[0] == "what" and flat[end - 2 : end] in {("was", "wrong"), ("is", "wrong")}:
        # "What I said about A was wrong, they are in B".
        words = (words[end - 1], *words[at : end - 2], *words[end:])
        at, end, flat = 1, end - 1 - at, keys(words)
        comma = end
    while flat[comma + 2 : comma + 3] == (",",):
        comma += 2
    pronoun = flat[comma + 1] if comma + 2 < len(flat) else ""
    verb = flat[comma + 2] if pronoun else ""
    if not at or not _WRONG & set(flat[:at]) or pronoun not in _PRONOUNS or verb not in lexicon().be:
        return ()
    return (*words[at + 1 : end], *words[comma + 2 :])


def _is(subject: Phrase) -> Word:
    head = keys(bare(subject))[-1:]
    return _ARE if head and singular(head[0]) != head[0] else _IS
