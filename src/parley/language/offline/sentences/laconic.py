"""Very short wordings: "Anyone there?", "desk check", "use the left door"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["SEEN", "laconic"]

Grounds = Callable[[Phrase], bool]
_PAUSES = {",", "and", "but", "then"}
_SOMEBODY = frozenset(
    {"anyone", "anybody", "someone", "somebody", "everyone", "everybody", "everything", "anything", "all"}
)
SEEN = frozenset({
    "open", "shut", "closed", "empty", "full", "free", "busy", "occupied", "locked", "unlocked", "on", "off",
    "clean", "dirty", "ok", "okay", "fine", "ready", "available", "broken", "lit", "dark", "tidy", "wet",
    "dry", "alright", "blocked", "clear", "damaged", "working", "running", "done", "present", "missing",
})  # fmt: skip
_CHECKS = frozenset({"check", "inspection", "status", "look", "visit"})


def _verbless(words: Phrase) -> Phrase:
    """For "Anyone there?", "Window shut?": whether it is so."""
    result: list[Word] = []
    start = 0
    for index, mark in enumerate(words):
        if mark.key not in {".", "!", "?", ";", "\n"} and index < len(words) - 1:
            continue
        end = index + (index == len(words) - 1 and mark.is_word)
        sentence, flat = words[start:end], keys(words[start:end])
        start = index + 1
        if mark.key == "?" and 1 < len(flat) < 7 and not set(flat) & (lexicon().be | lexicon().auxiliaries):
            if flat[0] in _SOMEBODY and (
                flat[1] in SEEN
                or flat[1] in {"there", "here", "inside", "around"}
                or (lexicon().places.match(flat, 1) is not None)
            ):
                sentence = (*_words("check whether"), _word(flat[0]), _word("is"), *sentence[1:])
            elif (
                flat[-1] in SEEN and flat[0] not in lexicon().question_starts and not opens_command(sentence)
            ):
                sentence = (
                    *_words("check whether"),
                    *_articled((_word(flat[0]), *sentence[1:-1])),
                    _word("is"),
                    sentence[-1],
                )
        result += sentence if end > index else (*sentence, mark)
    return tuple(result)


def _words(text: str) -> Phrase:
    return tuple(_word(part) for part in text.split())


def _articled(words: Phrase) -> Phrase:
    label = words[-1].key.isdigit() or len(words[-1].key) == 1
    return words if label or words[0].key in lexicon().determiners else (_word("the"), *words)


def _short_check(words: Phrase, grounds: Grounds) -> Phrase:
    """For "desk check", "door status"."""
    body = tuple(word for word in words if word.is_word)
    body = body[:-1] if keys(body[-1:]) == ("please",) else body
    if (
        not 2 <= len(body) <= 5
        or body[-1].key not in _CHECKS
        or opens_command(body)
        or not grounds(body[:-1])
    ):
        return words
    verb = "visit" if body[-1].key == "visit" else "inspect"
    return (_word(verb), *body[:-1])


def _bare_choice(words: Phrase, grounds: Grounds) -> Phrase:
    """For "use the left door", "try the lift": going there."""
    flat = keys(words)
    if flat[:1] in {("use",), ("try",)} and len(flat) > 2 and grounds(words[1:]):
        return (_word("go"), _word("to"), *words[1:])
    at = next((i for i in range(1, len(flat) - 2) if flat[i] in {"try", "use"} and flat[i - 1] in _PAUSES), 0)
    end = next((i for i in range(at, len(flat)) if flat[i] in {".", "!", "?", ";", ","}), len(flat))
    if at and grounds(words[at + 1 : end]):
        return (*words[:at], _word("go"), _word("to"), *words[at + 1 :])
    if flat[:1] == ("try",) and (cut := next((i for i in range(2, len(flat)) if flat[i] in _PAUSES), 0)):
        return (_word("go"), _word("to"), *words[1:]) if grounds(words[1:cut]) else words
    return words


def _word(text: str) -> Word:
    return Word(text, text)


def laconic(words: Phrase, grounds: Grounds) -> Phrase:
    """The same message in whole sentences; `grounds` tells whether words name something on the map."""
    return _short_check(_verbless(_bare_choice(words, grounds)), grounds)
