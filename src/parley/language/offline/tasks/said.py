"""What is to be said and to whom, in the words of a command."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.tasks.commands import Command
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["amount", "named_of", "person_of", "place_size", "placed_text", "spoken", "start_of"]


def named_of(words: Phrase) -> Phrase:
    """For "(ask) their name": what their name is."""
    if keys(words[:1]) in {("their",), ("his",), ("her",)}:
        return (*tokens("what their"), *words[1:], *tokens("is"))
    return words


def amount(words: Phrase) -> Phrase:
    """How much is said behind what is acted on: "(every box) with 3 litres", "for ten seconds"."""
    flat = keys(words)
    counted = (i for i in range(1, len(flat)) if flat[i].isdigit() or flat[i] in lexicon().numbers)
    at = next((i for i in counted if flat[i - 1] in {"with", "for", "to", "by", "at"}), 0)
    return words[at - 1 :] if at > 1 else ()


def place_size(flat: tuple[str, ...], index: int) -> int:
    """How many words a preposition of place has that stands at `index`, before more words; 0 if none does."""
    found = lexicon().places.match(flat, index)
    return (
        found[0]
        if found is not None and index and flat[index] != "of" and index + found[0] < len(flat)
        else 0
    )


_GREETING = PhraseTable.of(("hello", "hi", "welcome", "goodbye", "bye", "good night", "thank you", "thanks"))


def placed_text(said: Phrase) -> tuple[Phrase, Phrase]:
    """For "in the hall that the bus is late", "hello in the hall": where, and what is to be said, if so."""
    flat = keys(said)
    greeted = _GREETING.match(flat) or lexicon().greetings.match(flat) or lexicon().farewells.match(flat)
    size = greeted[0] if greeted is not None and '"' not in flat else 0
    behind = lexicon().places.match(flat, size) if size else None
    if behind is not None and size + behind[0] < len(flat):
        # "Hello at the gate": nobody says more than "hello" there.
        return said[size + behind[0] :], said[:size]
    found = lexicon().places.match(flat)
    that = next((i for i in range(2, len(flat) - 1) if flat[i] in {"that", "saying"}), 0)
    if found is None or not that or found[0] >= that or '"' in flat:
        return (), said
    return said[found[0] : that], said[that + 1 :]


def start_of(flat: tuple[str, ...], relation: str) -> int:
    """Where a relation of one or more words begins; the length if it is nowhere."""
    wanted = tuple(relation.split())
    return next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), len(flat))


def person_of(words: Phrase) -> Phrase:
    """Without where the person is."""
    relation = tuple(noun_phrase(words).relation.split())
    flat = keys(words)
    end = next(
        (i for i in range(len(flat)) if relation and flat[i : i + len(relation)] == relation), len(flat)
    )
    return bare(words[:end])


def _placed_listener(words: Phrase, size: int) -> int:
    """For "P at the desk that S": where S begins; 0 if P stands alone."""
    flat = keys(words)
    if lexicon().places.match(flat, size) is None:
        return 0
    return next(
        (
            i
            for i in range(size + 2, len(flat))
            if flat[i] in {"that", "to", "about", "what", "how", "who", "when", "where"}
        ),
        0,
    )


def spoken(command: Command, is_person: Callable[[Phrase], bool]) -> tuple[Phrase, Phrase]:
    """What is to be said and to whom: "tell P that S", "say S to P", "greet P"."""
    marks = [i for i, word in enumerate(command.words) if word.key == '"']
    if len(marks) > 1:
        outside = tuple(w for w in (*command.words[: marks[0]], *command.words[marks[-1] + 1 :]) if w.is_word)
        outside = outside[1:] if keys(outside[:1]) == ("to",) else outside
        return tuple(w for w in command.words[marks[0] + 1 : marks[-1]] if w.key != '"'), outside
    words = tuple(word for word in command.words if word.is_word)
    hello = (Word("hello", "hello"),)
    if command.verb in {
        "greet",
        "salute",
        "welcome",
        "say hello to",
        "say hi to",
        "introduce yourself to",
        "talk to",
        "speak to",
        "speak with",
        "talk with",
        "chat with",
        "have a word with",
    }:
        return hello, words
    flat = keys(words)
    if command.verb in {"ask", "tell", "inform", "notify", "remind", "warn", "alert"}:
        for size in range(min(3, len(words)), 0, -1):
            if is_person(words[:size]):
                placed = _placed_listener(words, size)
                if placed:
                    rest = words[placed:]
                    return (rest[1:] if keys(rest[:1]) in {("that",), ("about",), ("to",)} else rest), words[
                        :placed
                    ]
                rest = words[size:]
                return (rest[1:] if keys(rest[:1]) in {("that",), ("about",), ("to",)} else rest), words[
                    :size
                ]
    for index in range(len(flat) - 2, 0, -1):
        if flat[index] == "to" and is_person(person_of(words[index + 1 :])):
            return words[:index], words[index + 1 :]
    return (words[1:] if flat[:1] == ("that",) and len(words) > 2 else words), ()
