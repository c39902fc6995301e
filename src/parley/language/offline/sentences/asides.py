"""What is said around the words of an order and says nothing of its own: how well, when it suits, for whom.

It is left out before a message is cut into its parts, so that nobody takes it for an order or a condition.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.rewriting import rewritten
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["without_asides"]

_DATA = load_data("units")
_MANNER = PhraseTable.of(_DATA["manner"])
_TAGS = PhraseTable.of(_DATA["order_tags"])
_COMES = frozenset(_DATA["coming"])
_ENDING = frozenset({",", ".", "!", "?", ";", "and", "then", "please", "but", "so"})
_MARKS = frozenset({".", "!", "?", ";", ":", "\n"})


def without_asides(words: Phrase) -> Phrase:
    """The same message without what only surrounds its orders.

    Args:
        words: All words and punctuation.
    """
    words = _without_relatives(_without_sake(_without_tags(_plain_do(_without_manner(_in_general(words))))))
    return _without_relief(_without_time_for_it(_without_arrivals(_without_events(words))))


def _in_general(words: Phrase) -> Phrase:
    """For "you can hardly breathe at A" "one can hardly ...": told of anybody, and no order."""
    flat = keys(words)
    if flat[1:2] == ("everywhere",) and flat[2:3] in _AT and not opens_command(words):
        # "Water everywhere in A!"
        return (Word("there", "there"), Word("is", "is"), *words)
    if flat[:2] == ("you", "can") and flat[2:3] in {("hardly",), ("barely",), ("scarcely",)}:
        return (Word("one", "one"), *words[1:])
    return words


_AT = frozenset((place,) for place in ("in", "at", "on", "around", "near", "under", "by"))


def _without_arrivals(words: Phrase) -> Phrase:
    """Without "before A comes" behind what is asked for: when it is due, not where to go."""
    flat = keys(words)
    for at in range(3, len(flat) - 2):
        end = next((i for i in range(at + 1, len(flat)) if not words[i].is_word), len(flat))
        if flat[at] != "before" or flat[at + 1] in {"you", "i", "it", "that"} or end - at > 7:
            continue
        coming = next((i for i in range(at + 2, end) if flat[i] in _COMES), 0)
        if coming and end - coming < 3:
            return (*words[:at], *words[end:])
    return words


def _without_relief(words: Phrase) -> Phrase:
    """Without "It would put my mind at rest." behind what is asked for."""
    flat = keys(words)
    for at in range(3, len(flat) - 4):
        starts = not words[at - 1].is_word and flat[at] in {"it", "that", "this"} and flat[at + 1] == "would"
        end = next((i for i in range(at, len(flat)) if not words[i].is_word), len(flat))
        helps = next((i for i in range(at + 2, min(at + 5, end)) if flat[i] in _RELIEVING), 0)
        if starts and helps and {"my", "me", "us", "our"} & set(flat[helps + 1 : end]) and end - at < 10:
            return (*words[:at], *words[end + 1 :])
    return words


_RELIEVING = frozenset(
    {"put", "set", "ease", "make", "help", "save", "mean", "do", "please", "cheer", "spare"}
)


def _without_time_for_it(words: Phrase) -> Phrase:
    """For "spare a minute to look at A" "look at A"."""
    flat = keys(words)
    for at in range(len(flat) - 4):
        if flat[at] not in {"spare", "find", "take"} or flat[at + 1] not in {"a", "me", "us", "some", "the"}:
            continue
        end = next((i for i in range(at + 2, min(at + 6, len(flat) - 1)) if flat[i] == "to"), 0)
        between = set(flat[at + 2 : end]) if end else set()
        if between <= _MOMENTS and {"minute", "minutes", "moment", "second", "sec", "time"} & between:
            return (*words[:at], *words[end + 1 :])
    return words


_MOMENTS = frozenset(
    {
        "a",
        "minute",
        "moment",
        "second",
        "sec",
        "bit",
        "of",
        "time",
        "your",
        "little",
        "quick",
        "two",
        "minutes",
    }
)


def _without_manner(words: Phrase) -> Phrase:
    """Without "very well" and "one last time", which say nothing that is not done anyway."""
    flat = keys(words)

    def manner(at: int, before: Sequence[Word]) -> tuple[int, Phrase] | None:
        found = _MANNER.match(flat, at) if before and before[-1].is_word else None
        size = found[0] if found is not None else 0
        return (size, ()) if size and (at + size == len(flat) or flat[at + size] in _ENDING) else None

    return rewritten(words, manner)


def _without_tags(words: Phrase) -> Phrase:
    """Without "would you" and "if you can" behind an order, at its end or before the next one."""
    flat = keys(words)

    def tag(at: int, before: Sequence[Word]) -> tuple[int, Phrase] | None:
        start = at + (flat[at] == ",")
        found = _TAGS.match(flat, start) if before and before[-1].is_word else None
        end = start + found[0] if found is not None else 0
        return (end - at, ()) if end and _is_tag(flat, at, end) else None

    return rewritten(words, tag)


def _is_tag(flat: tuple[str, ...], index: int, end: int) -> bool:
    """Whether words end an order there, and nothing hangs on them."""
    start = next((i + 1 for i in range(index - 1, -1, -1) if flat[i] in _MARKS), 0)
    behind = flat[end : end + 1]
    said = next((i for i in range(index - 1, start - 1, -1) if flat[i] == ","), start - 1)
    if index - said < _SHORTEST or flat[start] in _SAYING | lexicon().question_starts:
        return False
    if behind and behind[0] not in _ENDING:
        return False
    hanging = {"if", "unless", "otherwise", "or", "else"} & set(flat[end : end + 3])
    return not hanging and (behind != ("?",) or flat[index] == ",")


_SHORTEST = 3
_SAYING = frozenset({"i", "you", "we", "he", "she", "they", "it", "if", "when"})


def _plain_do(words: Phrase) -> Phrase:
    """For "but do V it" "but V it"."""
    flat = keys(words)
    for at in range(len(flat) - 2):
        begins = not at or not words[at - 1].is_word or flat[at - 1] in {"and", "but", "please", "so", "then"}
        if flat[at] != "do" or not begins or "?" in flat[at:]:
            continue
        verb, behind = flat[at + 1], flat[at + 2]
        known = lexicon().verbs.match(flat, at + 1) is not None
        whole = verb == lemma(verb) and verb not in _DONE and words[at + 1].is_word
        if whole and (known or behind in lexicon().determiners):
            return (*words[:at], *_plain_do(words[at + 1 :]))
    return words


_DONE = frozenset({
    "not", "you", "i", "we", "they", "it", "that", "this", "them", "the", "a", "an", "your", "my", "so",
    "some",
    "all", "both", "any", "each", "what", "as", "me", "us", "people", "these", "those", "another", "one",
    "no", "same", "nothing", "everything", "something", "only", "just", "exactly", "and", "or", "his", "her",
})  # fmt: skip


def _without_sake(words: Phrase) -> Phrase:
    """For "check the desk for him" "check the desk": for whose sake, and nobody to be looked for."""
    flat = keys(words)
    for at in range(3, len(flat) - 1):
        if (
            flat[at] != "for"
            or flat[at + 1] not in _WHOM
            or (flat[at + 2 : at + 3] or (".",))[0] not in _ENDING
        ):
            continue
        start = next((i + 1 for i in range(at - 1, -1, -1) if not words[i].is_word or flat[i] == "and"), 0)
        verb = next(
            (lexicon().verbs.match(flat, i) for i in range(start, at - 1) if flat[i] in _LOOKING), None
        )
        article = lexicon().determiners & set(flat[start:at])
        if verb is not None and article | {key for key in flat[start:at] if key[-1:].isdigit()}:
            return (*words[:at], *_without_sake(words[at + 2 :]))
    return words


_WHOM = frozenset({"him", "her", "them", "me", "us"})
_LOOKING = frozenset({"check", "inspect", "visit", "examine", "count"})


def _without_relatives(words: Phrase) -> Phrase:
    """Without ", where she had lunch" and ", who never listens": told of what was named already."""
    flat = keys(words)
    for at in range(2, len(flat) - 3):
        if flat[at] != "," or flat[at + 1] not in _RELATIVE or not words[at - 1].is_word:
            continue
        end = next((i for i in range(at + 2, len(flat)) if flat[i] in _MARKS | {","}), len(flat))
        said = flat[at + 2 : end]
        asks = flat[end : end + 1] == ("?",) and flat[at + 1] == "where"
        about = flat[at + 1] != "where" or said[0] in _TOLD_OF
        if len(said) < 2 or asks or not about or _SAYS_MORE & set(said):
            continue
        going_on = flat[end : end + 1] == (",",) and _goes_on(words, at, end + 1)
        return (*words[:at], *_without_relatives(words[end + going_on :]))
    return words


def _goes_on(words: Phrase, at: int, behind: int) -> bool:
    """Whether only the subject of a sentence stands before a relative clause, which goes on behind it."""
    flat = keys(words)
    start = next((i + 1 for i in range(at - 1, -1, -1) if flat[i] in _MARKS), 0)
    named = flat[start] in lexicon().determiners or words[start].is_capital
    verb = lexicon().verbs.match(flat, start)
    again = flat[behind : behind + 1] in {("and",), ("so",), ("but",), ()}
    return named and verb is None and at - start < _LONGEST_SUBJECT and not again


_LONGEST_SUBJECT = 6
_RELATIVE = frozenset({"who", "where", "whose"})
_TOLD_OF = frozenset(
    {"i", "we", "he", "she", "they", "it", "people", "somebody", "someone", "nobody", "there"}
)
_SAYS_MORE = frozenset({
    "you", "in", "at", "on", "near", "next", "by", "beside", "behind", "between", "under", "please", "needs",
    "wants", "should", "must", "lives", "waits", "called", "wear", "wears", "wearing", "left", "put",
})  # fmt: skip


def _without_events(words: Phrase) -> Phrase:
    """Without "before it gets dark" in front of what is asked for."""
    flat = keys(words)
    for at in range(len(flat) - 4):
        begins = not at or not words[at - 1].is_word or flat[at - 1] in {"and", "but", "so", "then", "please"}
        if flat[at] != "before" or not begins or flat[at + 1] in {"you", "that", "this", "i", "we"}:
            continue
        coming = next((i for i in range(at + 2, min(at + 6, len(flat) - 1)) if flat[i] in _COMES), 0)
        if not coming or not all(word.is_word for word in words[at:coming]):
            continue
        for end in range(coming + 1, min(coming + 5, len(flat) - 1)):
            if flat[end] == ",":
                return (*words[:at], *words[end + 1 :])
            if not words[end].is_word:
                break
            if _asks_here(words[end:], flat[end - 1]):
                return (*words[:at], *words[end:])
    return words


def _asks_here(words: Phrase, before: str) -> bool:
    """Whether an order begins here, with its verb in the base form and something that it is done to."""
    flat = keys(words[:2])
    plain = len(flat) > 1 and flat[0] == lemma(flat[0]) and before not in lexicon().determiners | {"to"}
    return plain and (opens_command(words) or flat[1] in lexicon().determiners | {"both", "all", "every"})
