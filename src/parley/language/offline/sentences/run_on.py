"""Speech without punctuation: where one clause ends and the next begins.

Dictated words have no commas and no full stops. A clause begins at a verb in its base form with something
to do it to, at "please" and "so" before such a verb, and at a subject with its finite verb behind an order
that is complete.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["holds_order", "punctuated"]

IsStop = Callable[[Phrase], bool]

_STOP = Word(".", ".")
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_ORDERING = frozenset({
    "motion", "back", "look", "whether", "search", "transfer", "grasp", "place", "speak", "follow",
    "guide", "meet", "count", "dock",
})  # fmt: skip
_SUBORDINATE = frozenset({
    "if", "unless", "when", "once", "after", "before", "while", "as", "because", "since", "although",
    "whether", "should", "provided", "assuming", "until", "till", "in", "on", "whenever", "though",
    "supposing", "providing",
})  # fmt: skip
_OPEN = (
    frozenset(
        {
            "to",
            "not",
            "never",
            "and",
            "or",
            "but",
            "then",
            "you",
            "i",
            "we",
            "they",
            "he",
            "she",
            "just",
            "please",
            "that",
            "which",
            "who",
            "what",
            "where",
            "how",
            "let",
            "will",
            "may",
            "might",
            "must",
            "do",
            "does",
            "so",
            "did",
            "than",
            "of",
            "with",
            "for",
            "from",
            "at",
            "by",
            "into",
            "onto",
            "kindly",
            "now",
            "go",
            "come",
            "can",
            "could",
            "would",
            "should",
            "shall",
            "also",
            "try",
            "better",
            "quickly",
            "first",
            "next",
            "no",
            "either",
            "maybe",
            "perhaps",
            "only",
            "be",
            "me",
            "always",
            "still",
            "ever",
            "anyone",
            "someone",
            "somebody",
            "anybody",
            "lets",
            "else",
            "otherwise",
        }
    )
    | _SUBORDINATE
    | lexicon().determiners
    | lexicon().quantifiers
)
"""Behind these no clause of its own begins."""
_CLOSING = frozenset({
    "today", "yesterday", "tomorrow", "tonight", "there", "here", "it", "again", "them", "him", "her",
    "that", "too", "thanks", "anyway", "well", "me", "us", "now", "away", "off", "up", "out", "down",
})  # fmt: skip
"""With these a clause may end."""
_SUBJECTS = frozenset({
    "it", "he", "she", "they", "we", "i", "there", "nobody", "everybody", "everyone", "nothing",
    "somebody", "someone",
})  # fmt: skip
_FINITE = (
    frozenset({"has", "had", "have", "did", "does", "do", "will", "would", "can", "could"}) | lexicon().be
)
_AFTER_VERB = frozenset(
    {"it", "them", "there", "around", "whether", "if", "back", "everything", "him", "her"}
)
_LONGEST_STOP = 5


def _in_a_verb(flat: tuple[str, ...], index: int) -> bool:
    """Whether a word is part of a verb of several words that began before ("take up position")."""
    found = ((at, lexicon().verbs.match(flat, at)) for at in range(max(0, index - 3), index))
    return any(verb is not None and at + verb[0] > index for at, verb in found)


def _in_a_name(words: Phrase, index: int, is_stop: IsStop) -> bool:
    """Whether a word is the end of a name, whatever else it means ("the tool store")."""
    return any(is_stop(words[at : index + 1]) for at in range(max(0, index - 2), index))


def punctuated(words: Phrase, is_stop: IsStop) -> Phrase:
    """The same words with a full stop wherever a clause of its own begins without any mark.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something that is known.
    """
    flat = keys(words)
    result: list[Word] = []
    start, ordered = 0, False
    for index, word in enumerate(words):
        if word.key in _MARKS:
            start, ordered = index + 1, False
        elif index > start + 2 and _goes_on(words, flat, index, is_stop):
            result.append(_STOP)
            start, ordered = index + 1, False
            continue
        elif index > start:
            idle = _in_a_verb(flat, index) or _asks_of_another(flat[start:index])
            begins = "" if idle else _order_at(words, flat, index, is_stop)
            begins = "" if begins and _in_a_name(words, index, is_stop) else begins
            if begins and _may_end(words, flat, start, index, is_stop, strong=begins == "strong"):
                result.append(_STOP)
                start, ordered = index, True
                if word.key in {"so", "anyway", "anyways"}:
                    continue
            elif (
                ordered
                and _statement_at(words, flat, index)
                and _ends_here(words, flat, start, index, is_stop)
            ):
                result.append(_STOP)
                start, ordered = index, False
        if index == start:
            ordered = bool(_order_at(words, flat, index, is_stop)) or ordered
        result.append(word)
        ordered = ordered or bool(_order_at(words, flat, index, is_stop))
    return tuple(result)


_ASKING = frozenset({"does", "did", "do", "will", "would", "can", "could", "should"})


def _asks_of_another(flat: tuple[str, ...]) -> bool:
    """For "what day did A (get the key)": the verb of a question about somebody else is no order."""
    asking = flat[:1] and flat[0] in lexicon().question_starts
    at = next((i for i in range(1, min(5, len(flat))) if flat[i] in _ASKING), 0) if asking else 0
    return 0 < at < len(flat) - 1 < at + 6 and not {"you", "we", ",", "and"} & set(flat[at + 1 :])


def holds_order(words: Phrase, is_stop: IsStop) -> bool:
    """Whether an order for something that is known stands anywhere in a message."""
    flat = keys(words)
    return any(_order_at(words, flat, index, is_stop) == "strong" for index in range(len(words)))


def _goes_on(words: Phrase, flat: tuple[str, ...], index: int, is_stop: IsStop) -> bool:
    """Whether "and after the desk ..." begins here."""
    if flat[index] != "and" or flat[index + 1 : index + 2] != ("after",):
        return False
    return any(is_stop(words[index + 2 : index + 2 + size]) for size in range(1, _LONGEST_STOP + 1))


def _order_at(words: Phrase, flat: tuple[str, ...], index: int, is_stop: IsStop) -> str:
    """Whether an order begins here; "strong" if nothing else can be meant."""
    at = index
    if at >= len(flat):
        return ""
    polite = flat[at] in {"please", "kindly"}
    if flat[at] == "so" or flat[at] in {"anyway", "anyways"}:
        following = flat[at + 1 : at + 3]
        led = following[:1] in {("please",), ("kindly",)} or following in _REQUESTS
        return "strong" if led or _order_at(words[at + 1 :], flat[at + 1 :], 0, is_stop) else ""
    if flat[at : at + 2] in _REQUESTS and flat[at + 2 : at + 3] == ("you",):
        return "strong"
    at += polite
    at += next((len(m) for m in _AT_FIRST if flat[at : at + len(m)] == m), 0)
    polite = polite or at > index
    at += flat[at : at + 1] == ("you",)
    found = lexicon().verbs.match(flat, at) if at < len(flat) else None
    if found is None or found[1].partition(":")[0] not in _ORDERING or lemma(flat[at]) != flat[at]:
        return ""
    end = at + found[0]
    if end >= len(flat):
        return ""
    goal = lexicon().goals.match(flat, end)
    named = end + (goal[0] if goal is not None else 0)
    stop = any(
        is_stop(words[named : named + size]) for size in range(1, min(_LONGEST_STOP, len(flat) - named) + 1)
    )
    if not (stop or (flat[named : named + 1] and (flat[named] in lexicon().determiners | _AFTER_VERB))):
        return ""
    return "strong" if polite or (stop and (goal is not None or found[0] > 1)) else "weak"


_AT_FIRST = (
    ("before", "anything", "else"),
    ("first", "of", "all"),
    ("before", "everything", "else"),
    ("first",),
)
_REQUESTS = frozenset(
    {
        ("i", "need"),
        ("i", "want"),
        ("we", "need"),
        ("can", "you"),
        ("could", "you"),
        ("you", "go"),
        ("would", "you"),
        ("will", "you"),
        ("you", "check"),
    }
)


def _may_end(
    words: Phrase, flat: tuple[str, ...], start: int, index: int, is_stop: IsStop, *, strong: bool
) -> bool:
    """Whether what stands before `index` can be a clause of its own."""
    before = flat[index - 1]
    asked = flat[max(start, index - 2) : index - 1] in {("how",), ("where",)}
    if before in _OPEN - _CLOSING or not words[index - 1].is_word or index - start < 2 or asked:
        # "See how things stand at A".
        return False
    if flat[start] in _SUBORDINATE and "then" not in flat[start:index] and "," not in flat[start:index]:
        return False
    if flat[index] not in {"please", "kindly", "so"} and _SUBORDINATE & {"if", "unless"} & set(
        flat[start:index]
    ):
        return False
    return strong or _ends_here(words, flat, start, index, is_stop)


def _ends_here(words: Phrase, flat: tuple[str, ...], start: int, index: int, is_stop: IsStop) -> bool:
    if flat[index - 1] in _CLOSING:
        return True
    low = max(start, index - _LONGEST_STOP)
    return any(is_stop(words[at:index]) for at in range(low, index))


def _statement_at(words: Phrase, flat: tuple[str, ...], index: int) -> bool:
    """Whether a subject with its verb stands here ("it was cold", "nobody came")."""
    if flat[index] not in _SUBJECTS or flat[index - 1] in _OPEN - {"me"} or not words[index - 1].is_word:
        return False
    verb = flat[index + 1 : index + 2]
    return bool(verb) and (verb[0] in _FINITE or lemma(verb[0]) != verb[0])
