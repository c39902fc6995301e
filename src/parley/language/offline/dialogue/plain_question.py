"""Questions in the order and with the words that their readers expect.

"After the desk, where next?" is "where next after the desk", "till when do they serve tea?" is "when do they
serve tea", "what can you actually do?" has no "actually"; "busy?" and "status" are questions about the robot.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["plain_question"]

_DATA = load_data("questions")
_FILLERS = frozenset(_DATA["fillers"])
_BEFORE_WH = frozenset(_DATA["before_wh"])
_SHORT = {kind: frozenset(listed) for kind, listed in _DATA["short"].items()}
_AROUND_SHORT = frozenset(_DATA["around_short"])
_MARKED_ONLY = frozenset(_DATA["short_if_marked"])
_MEANT = {"status": "what are you doing", "left": "what is left", "self": "where are you"}
_LONGEST_SHORT = 5
_AROUND_NEXT = frozenset(
    word for text in (*_DATA["after_this"], *_DATA["around_next"]) for word in text.split()
)


def plain_question(words: Phrase, *, marked: bool) -> Phrase:
    """The question as its readers expect it; the words as they are if it is none.

    Args:
        words: With or without what only opens them.
        marked: Whether a question mark stands behind them.
    """
    raw = tuple(word for word in words if word.is_word)
    while raw and raw[0].key in _JOINING:
        raw = raw[1:]
    if marked and _after_this(keys(raw)):
        return tuple(Word(part, part) for part in _MEANT["left"].split())
    behind = _behind(keys(raw)) if marked else 0
    if behind:
        # "And once you are through with the desk?"
        return (*(Word(part, part) for part in ("what", "comes", "after")), *raw[behind:])
    if marked and keys(raw[-2:]) in {("then", "what"), ("what", "then"), ("what", "next")}:
        return tuple(Word(part, part) for part in _MEANT["left"].split())
    words = _about_ability(strip_openers(words))
    said = tuple(word for word in words if word.is_word)
    short = _short(said, marked=marked)
    if short:
        return short
    flat = keys(said)
    starts = lexicon().question_starts
    if len(flat) > 2 and flat[0] in _BEFORE_WH and flat[1] in starts:
        # "In which box is the key?", "till when is it open?"
        said, flat = said[1:], flat[1:]
    at = next((i for i in range(2, min(9, len(flat))) if flat[i] in starts), 0)
    fronted = flat[:1] in {("after",), ("before",)} and at
    if fronted and ("," in keys(words) or marked):
        said = (*said[at:], *said[:at])
        flat = keys(said)
    if flat[:1] and (flat[0] in starts or marked):
        said = tuple(
            word for i, word in enumerate(said) if i == 0 or flat[i] not in _FILLERS or len(flat) < 4
        )
    return said


def _after_this(flat: tuple[str, ...]) -> bool:
    """Whether a question asks what comes after that which is being done, and nothing else."""
    text = " ".join(flat)
    at = next((text.find(lead) for lead in _DATA["after_this"] if f" {lead} " in f" {text} "), -1)
    return at >= 0 and set(flat) <= _AROUND_NEXT


def _about_ability(words: Phrase) -> Phrase:
    """For "is V-ing A something that you could do?" "are you able to V A"."""
    said = tuple(word for word in words if word.is_word)
    flat = keys(said)
    at = next((i for i in range(2, len(flat) - 2) if flat[i] in {"something", "anything"}), 0)
    asks = (
        flat[:1] in {("is",), ("would",)}
        and "you" in flat[at:]
        and flat[-1:] in {("do",), ("of",), ("handle",)}
    )
    start = 2 if flat[:1] == ("would",) else 1
    if not at or not asks or not flat[start].endswith("ing"):
        return words
    verb = lemma(flat[start])
    return (*(Word(part, part) for part in ("are", "you", "able", "to", verb)), *said[start + 1 : at])


_JOINING = frozenset({"and", "so", "ok", "okay", "well", "but", "then", "right"})
_DONE = frozenset(
    {"done", "through", "finished", "ready", "been", "visited", "checked", "have", "are", "is", "you"}
)
_DONE_WITH = frozenset({"with", "at", "to", "in", "the"})


def _behind(flat: tuple[str, ...]) -> int:
    """Where the stop begins after which a question asks what comes; 0 if that is not all that it says."""
    if flat[:1] not in {("after",), ("once",), ("when",)} or set(flat) & lexicon().question_starts - {"when"}:
        return 0
    at = 1
    while at < len(flat) and flat[at] in _DONE | _DONE_WITH:
        at += 1
    done = flat[0] == "after" or bool({"done", "through", "finished", "ready"} & set(flat[:at]))
    return at if done and at < len(flat) <= at + 4 else 0


def _short(words: Phrase, *, marked: bool) -> Phrase:
    """A whole question for a word or two that only ask about the robot ("busy?", "status report")."""
    flat = keys(words)
    if not 0 < len(flat) <= _LONGEST_SHORT:
        return ()
    content = frozenset(flat) - _AROUND_SHORT
    if not content or (content & _MARKED_ONLY and not marked):
        return ()
    kind = next((kind for kind, listed in _SHORT.items() if content <= listed), "")
    return tuple(Word(part, part) for part in _MEANT[kind].split()) if kind else ()
