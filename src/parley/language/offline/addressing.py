"""Which robot a message is for."""

from __future__ import annotations

from parley.language.base import Situation
from parley.language.offline.lexicon import lexicon
from parley.language.offline.text import Phrase, closest, keys, tokens

__all__ = ["addressed", "calls_several"]

_CALLS = frozenset(
    {"hey", "hi", "hello", "ok", "okay", "dear", "tell", "have", "let", "ask", "make", "and", "please", "get"}
)


def addressed(words: Phrase, situation: Situation) -> tuple[Phrase, tuple[str, ...]]:
    """The message without the names it calls, and the robots it is for (empty: nobody was named)."""
    group = lexicon().everybody.match(keys(words))
    if group is not None and group[0] < len(words) and situation.robots:
        return _without_lead(words[group[0] :]), situation.robots
    named: list[str] = []
    rest = words
    while True:
        shorter, name = _called_first(rest, situation.robots)
        if not name:
            break
        rest = shorter
        named.append(name)
    rest, last = _called_last(rest, situation.robots)
    if last:
        named.append(last)
    return rest, tuple(dict.fromkeys(named))


def calls_several(words: Phrase, robots: tuple[str, ...]) -> bool:
    """Whether different robots are given different orders ("A go to x and B go to y")."""
    flat = keys(words)
    called = {
        name
        for name in robots
        for index in range(len(flat) - 2)
        if flat[index] == name.lower() and (index == 0 or flat[index - 1] in {"and", ",", ".", "while", ";"})
    }
    return len(called) > 1 and " and ".join(sorted(n.lower() for n in called)) not in " ".join(flat)


def _called_first(words: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, str]:
    flat = keys(words)
    start = 0
    while start < len(flat) and (flat[start] in _CALLS or not words[start].is_word):
        start += 1
    for name in robots:
        called = keys(tokens(name))
        if flat[start : start + len(called)] == called:
            after = start + len(called)
            verb_of_statement = after < len(flat) and flat[after] in {
                "is",
                "was",
                "has",
                "needs",
                "wants",
                "feels",
            }
            if after >= len(flat) or not verb_of_statement:
                return _without_lead(words[after:]), name
    if len(flat) > start + 1 and flat[start + 1] == "," and words[start].is_capital:
        meant = closest(flat[start], [name.lower() for name in robots])
        if meant:
            return _without_lead(words[start + 2 :]), next(n for n in robots if n.lower() == meant)
    return words, ""


def _without_lead(words: Phrase) -> Phrase:
    while words and (not words[0].is_word or words[0].key in {"to", "should", "must", "and"}):
        words = words[1:]
    return words


def _called_last(words: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, str]:
    end = len(words)
    while end and not words[end - 1].is_word:
        end -= 1
    for name in robots:
        called = keys(tokens(name))
        start = end - len(called)
        if start > 0 and keys(words[start:end]) == called:
            if words[start - 1].key == ",":
                return (*words[: start - 1], *words[end:]), name
            if keys(words[:start]) in lexicon().thanks or keys(words[:start]) in lexicon().greetings:
                return words[:start], name
    return words, ""
