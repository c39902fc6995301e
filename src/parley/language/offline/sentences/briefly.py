"""Small things that people say around what they mean, put briefly before a message is cut into its parts.

How well something is to be done, "to me" beside a place, "A, he is over there, has left B", "look for it"
where the telling names the thing, and conditions that are dictated without a mark.
"""

from __future__ import annotations

from parley.language.offline.sentences.finite import subject_apart
from parley.language.offline.sentences.lost import with_what_was_lost
from parley.language.offline.sentences.moved import what_was_left
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma, tokens
from parley.language.word_lists import load_data

__all__ = ["briefly"]

_MANNER = PhraseTable.of(load_data("units")["manner"])
_ENDING = frozenset({",", ".", "!", "?", ";", "and", "then", "please", "but", "so"})
_STOP = Word(".", ".")


def briefly(words: Phrase) -> Phrase:
    """The same message, with less around what is meant."""
    words = with_what_was_lost(what_was_left(subject_apart(_without_manner(words))))
    return _without_me(_with_short_conditions(words))


def _without_manner(words: Phrase) -> Phrase:
    """Without "very well" and "one last time", which say nothing that is not done anyway."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        found = _MANNER.match(flat, index) if result and result[-1].is_word else None
        behind = flat[index + found[0] : index + found[0] + 1] if found is not None else ()
        if found is not None and (not behind or behind[0] in _ENDING):
            index += found[0]
            continue
        result.append(words[index])
        index += 1
    return tuple(result)


def _without_me(words: Phrase) -> Phrase:
    """For "come to me at the desk" "come to the desk"."""
    flat = keys(words)
    for index in range(1, len(flat) - 3):
        if flat[index] in {"to", "by"} and flat[index + 1] in {"me", "us"} and flat[index + 2] in _WHERE_AT:
            verb = next((flat[i] for i in range(index - 1, max(-1, index - 4), -1) if flat[i] in _COMING), "")
            if verb and "report" in flat[max(0, index - 2) : index]:
                start = next(i for i in range(index - 1, -1, -1) if flat[i] == "report")
                return (*words[:start], *tokens("come to"), *words[index + 3 :])
            if verb:
                return (*words[: index + 1], *words[index + 3 :])
    return words


_WHERE_AT = frozenset({"at", "in", "by", "on", "near", "outside"})
_COMING = frozenset(
    {"come", "go", "return", "report", "drive", "get", "head", "back", "run", "hurry", "over"}
)


def _with_short_conditions(words: Phrase) -> Phrase:
    """For "if it is go to A if it is not go to B", dictated: with marks where they belong."""
    flat = keys(words)
    result: list[Word] = []
    for index, word in enumerate(words):
        begins = word.key in {"if", "unless"} and flat[index + 1 : index + 2] in _IT
        verb = _order_behind(words, flat, index) if begins else 0
        if verb and index and words[index - 1].is_word and flat[index - 1] not in _JOINED_TO:
            result.append(_STOP)
        result.append(word)
        hanging = next((i for i in range(max(0, index - 5), index) if flat[i] in {"if", "unless"}), -1)
        waits = hanging >= 0 and flat[hanging + 1 : hanging + 2] in _IT and word.is_word
        if waits and _order_behind(words, flat, hanging) == index + 1:
            result.append(Word(",", ","))
    return tuple(result)


_IT = frozenset({("it",), ("that",), ("they",), ("so",), ("not",), ("there",)})
_JOINED_TO = frozenset({
    "and", "but", "or", "see", "check", "know", "whether", "me", "us", "out", "look", "sure", "then", "then,",
    "only", "even", "verify", "ask", "tell", "wonder",
})  # fmt: skip
_GOING = ("motion:", "back:", "look:", "dock:", "wait:", "search:")


def _order_behind(words: Phrase, flat: tuple[str, ...], start: int) -> int:
    """Where an order begins right behind "if it is (not)", with nothing to mark it; 0 if it does not."""
    at = start + 1
    while at < len(flat) and flat[at] in _SHORTLY:
        at += 1
    if at < start + 2 or at + 1 >= len(flat) or not all(word.is_word for word in words[start:at]):
        return 0
    found = lexicon().verbs.match(flat, at)
    return at if found is not None and found[1].startswith(_GOING) and flat[at] == lemma(flat[at]) else 0


_SHORTLY = frozenset(
    {"it", "that", "they", "so", "not", "there", "is", "are", "was", "does", "do", "one", "any"}
)
