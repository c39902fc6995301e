"""Courtesy around an order, in whatever words: "I was wondering whether you might V", "... thanks a lot"."""

from __future__ import annotations

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["plainly"]

_WORDS = load_data("courtesy")
_FIRST = frozenset(_WORDS["first"])
_COURTEOUS = frozenset(_WORDS["courteous"])
_MODAL = frozenset(_WORDS["modal"])
_LAST = frozenset(_WORDS["last"])
_ORDERS = frozenset(_WORDS["orders"])
_THANKS = (
    ("thank", "you"),
    ("thanks",),
    ("many", "thanks"),
    ("cheers",),
    ("much", "appreciated"),
    ("thx",),
    ("ty",),
)


def plainly(words: Phrase) -> Phrase:
    """A message without the courtesy at its start and its end."""
    words = _without_thanks(_apart(words))
    start = 0
    result: list[Word] = []
    for index in range(len(words) + 1):
        if index == len(words) or words[index].key in {".", "!", "?", ";", "\n"}:
            result += (*_without_frame(words[start:index]), *words[index : index + 1])
            start = index + 1
    return tuple(result)


def _without_frame(sentence: Phrase) -> Phrase:
    """Without a frame of nothing but courteous words before an order."""
    while keys(sentence[:2]) in _TAKING_BACK and keys(sentence[2:4]) in {("i", "meant"), ("i", "mean")}:
        sentence = sentence[2:]
    flat = keys(word for word in sentence)
    if (
        len(flat) < 4
        or flat[0] not in _FIRST
        or (flat[:2] in {("have", "you"), ("do", "not")} and "time" not in flat[:5])
    ):
        return sentence
    at = 0
    while at < len(flat) and (flat[at] in _COURTEOUS or flat[at] == ","):
        at += 1
    for cut in range(min(at, len(flat) - 1), 2, -1):
        lead = flat[:cut]
        if "not" in lead and not _COURTEOUS_DENIAL & set(lead):
            # "I do not want you to V" is no courtesy.
            continue
        if lead[-1] not in _LAST or not set(lead) & _MODAL or not {"you", "trouble", "bother"} & set(lead):
            continue
        found = lexicon().verbs.match(flat, cut)
        kind = found[1].partition(":")[0] if found is not None else ""
        if kind in _ORDERS and not _asks_for_knowledge(flat[cut:]) and len(flat) > cut + 1:
            return sentence[cut:]
    return sentence


_COURTEOUS_DENIAL = frozenset(
    {"mind", "trouble", "bother", "if", "too", "whether", "inconvenient", "suppose", "why", "disturb"}
)
_TAKING_BACK = frozenset(
    (word, ",") for word in ("sorry", "oops", "no", "wait", "actually", "ah", "oh", "my")
)


def _asks_for_knowledge(flat: tuple[str, ...]) -> bool:
    return flat[:1] in {("know",), ("remember",), ("like",), ("mind",)} or (
        flat[:2] in {("tell", "me"), ("have", "a")} and ("look" not in flat[:5])
    )


def _without_thanks(words: Phrase) -> Phrase:
    """Without "thank you so much, you are a star" at the end."""
    flat = keys(words)
    for at in range(3, len(flat)):
        if flat[at - 1] in {"say", "tell", "him", "her", "them", "to", "you"}:
            continue
        if any(flat[at : at + len(t)] == t for t in _THANKS) and len(flat) - at <= 12:
            rest = flat[at:]
            orders = any(
                lexicon().verbs.match(rest, i) and rest[i - 1] in {",", ".", "and"}
                for i in range(2, len(rest))
            )
            return words if orders else words[:at]
    return words


def _apart(words: Phrase) -> Phrase:
    """A sentence of its own for "could you V" in the middle of dictated words."""
    flat = keys(words)
    if len(flat) < 8:
        return words
    result: list[Word] = []
    dictated = len(flat) > 14 and all(word.is_word for word in words[:-1])
    for index, word in enumerate(words):
        if index > 2 and (
            flat[index : index + 3] == ("by", "the", "way") or (dictated and _tells(flat, index))
        ):
            result.append(Word(".", "."))
        begins = flat[index : index + 2] in _ASKING and lexicon().verbs.match(flat, index + 2) is not None
        joined = (
            index
            and flat[index - 3 : index] != ("by", "the", "way")
            and (not words[index - 1].is_word or flat[index - 1] in _JOINING or flat[index - 1] in _COURTEOUS)
        )
        if begins and index > 2 and not joined:
            result.append(Word(".", "."))
        result.append(word)
    return tuple(result)


def _tells(flat: tuple[str, ...], index: int) -> bool:
    """Whether a sentence about the speaker begins in words dictated without a mark."""
    starts = flat[index] in {"i", "we", "my", "there"} and flat[index + 1 : index + 2] != ()
    having = {"have"} - ({"have"} if flat[index] == "there" else set())
    link = flat[index + 1] in lexicon().be | having if starts else False
    return starts and (link or flat[index] == "my") and flat[index - 1] not in _SUBORDINATE


_SUBORDINATE = _COURTEOUS | frozenset(_WORDS["joining"])
_ASKING = frozenset((modal, "you") for modal in ("could", "can", "would", "will"))
_JOINING = frozenset(
    {"and", "or", "but", "then", "so", "what", "where", "how", "when", "why", "who", "which", "way"}
)
