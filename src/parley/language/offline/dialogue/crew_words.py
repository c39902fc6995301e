"""Words around orders to robots: misspelt names, greetings, "whoever is nearest", "it is A's turn to"."""

from __future__ import annotations

from collections.abc import Sequence

from rapidfuzz.distance import OSA

from parley.language.base import Situation
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma, tokens
from parley.language.word_lists import load_data

__all__ = [
    "DUTY",
    "for_another",
    "idles",
    "is_verb",
    "lead_size",
    "only_greets",
    "pronoun_named",
    "sentences",
    "spelled",
    "turn_of",
    "vocative_first",
    "without_only",
    "without_whoever",
]

_DATA = load_data("crews")
DUTY = PhraseTable.of(_DATA["duty"])
"""Words between a name and what is to be done."""
_ANYBODY = PhraseTable.of(_DATA["anybody"])
_WHOEVER = PhraseTable.of(_DATA["whoever"])
_CALLING = PhraseTable.of(_DATA["calling"])
_ONLY = PhraseTable.of(_DATA["only"])
_SENDING = PhraseTable.of(_DATA["sending"])
_RESTING = frozenset(_DATA["resting"])
_AROUND_REST = frozenset(_DATA["around_rest"])
_NEEDLESS = frozenset(_DATA["needless"])
_FREE = frozenset({
    "free", "available", "idle", "nearest", "closest", "nearer", "closer", "not", "busy", "doing", "nothing",
    "around", "there", "already", "the", "now", "right", "standing", "still", "at", "moment", "ready",
})  # fmt: skip
_HANDING = frozenset(_DATA["handing"])
_HANDED = frozenset(_DATA["handed"])
_PRONOUNS = frozenset({"him", "her", "it", "them"})
_TITLES = frozenset(load_data("people")["titles"])
_MARKS = frozenset({".", "!", "?", ";", "\n"})


def is_verb(word: str) -> bool:
    """Whether an order may begin with a word."""
    return lexicon().verbs.match((word,)) is not None or word in {"have", "take", "be"}


def spelled(words: Phrase, situation: Situation) -> Phrase:
    """With names of robots spelt right where they are called."""
    known = lexicon().vocabulary | {
        word.key for item in situation.objects for word in tokens(item.description)
    }
    told = {word.key for entry in situation.memory for word in tokens(entry.data[:400])}
    names = {name.lower(): name for name in situation.robots if name.isalpha()}
    result: list[Word] = []
    for at, word in enumerate(words):
        far = 1 + (len(word.key) > 6)
        strange = word.is_capital and len(word.key) > 3 and word.key not in known | told | set(names)
        # "Mrs Lund" is somebody, whatever robot is called nearly so.
        strange = strange and not (at and words[at - 1].key in _TITLES)
        near = (
            [n for n in names if n[0] == word.key[0] and OSA.distance(n, word.key) <= far] if strange else []
        )
        result.append(Word(near[0], names[near[0]]) if len(near) == 1 else word)
    return tuple(result)


def idles(flat: tuple[str, ...]) -> bool:
    """Whether a robot is to do nothing, or need not ("stay out of this one", "does not need to come").

    Args:
        flat: What is said behind its name, lower case.
    """
    words = tuple(key for key in flat if key.isalnum() or "'" in key)
    while words[:1] and words[0] in {
        "you",
        "can",
        "just",
        "should",
        "please",
        "may",
        "could",
        "will",
        "then",
        "now",
    }:
        words = words[1:]
    if not words:
        return False
    if lemma(words[0]) in _RESTING:
        return set(words[1:]) <= _AROUND_REST
    return (
        "not" in words and set(words) <= _NEEDLESS and bool({"need", "needed", "have", "bother"} & set(words))
    )


def without_only(words: Phrase) -> Phrase:
    """Without "only" and "nobody but" in front: whoever is named then."""
    found = _ONLY.match(keys(words))
    return words[found[0] :] if found is not None else words


def without_whoever(words: Phrase) -> Phrase:
    """Without "whoever is nearest", and without "somebody" before an order."""
    flat = keys(words)
    sent = _SENDING.match(flat)
    found = _WHOEVER.match(flat, sent[0]) if sent is not None else None
    if found is not None and sent is not None and flat[sent[0] + found[0] : sent[0] + found[0] + 1] in _TO:
        # "Send whoever is closest to the door".
        return (Word("go", "go"), *words[sent[0] + found[0] :])
    comma = flat.index(",") if "," in flat[:10] else 0
    if flat[:1] in {("whoever",), ("whichever",)} and comma and is_verb(lemma(flat[comma + 1])):
        return words[comma + 1 :]
    found = _WHOEVER.match(flat)
    if found is not None and found[0] < len(words):
        rest = words[found[0] :]
        if keys(rest[:1]) not in {
            ("?",),
            (",",),
            (":",),
            ("should",),
            ("please",),
            ("can",),
            ("could",),
            ("must",),
            (".",),
        }:
            return words if found[1].startswith(("any", "is", "who is", "who has", "who can")) else rest
        while rest and (not rest[0].is_word or rest[0].key in {"should", "please", "can", "could", "must"}):
            rest = rest[1:]
        return rest
    end = _WHOEVER.match_end(tuple(key for key in flat if key.isalnum()))
    if end and end < len(words) - 1:
        last = max((i for i in range(len(words)) if words[i].is_word), default=0) + 1
        return words[: last - end - (words[last - end - 1].key == ",")]
    start = lead_size(flat)
    asked = 1 if flat[start : start + 1] in {("could",), ("can",), ("would",), ("will",)} else 0
    found = _ANYBODY.match(flat, start + asked)
    rest = words[start + asked + found[0] :] if found is not None else ()
    if not rest or found is None:
        return words
    duty = DUTY.match(keys(rest))
    rest = rest[duty[0] :] if duty is not None and duty[0] < len(rest) else rest
    told = (
        not asked and duty is None and rest[0].key in {"put", "set", "hit", "cut", "shut", "spread", "hurt"}
    )
    if told and keys(rest[1:2]) in {
        ("a",),
        ("an",),
        ("some",),
        ("his",),
        ("her",),
        ("their",),
        ("my",),
        ("our",),
    }:
        # "Somebody put a bag in the hall" tells.
        return words
    verb = is_verb(rest[0].key)
    if verb and rest[-1].key == "?":
        rest = (*rest[:-1], Word(".", "."))
    return rest if verb and (asked or rest[0].key == lemma(rest[0].key)) else words


_TO = frozenset({("to",), ("into",), ("over",)})


def lead_size(flat: tuple[str, ...]) -> int:
    """How many words at the start only call for attention."""
    at = 0
    while at < len(flat):
        found = _CALLING.match(flat, at)
        if found is None and flat[at] not in {","}:
            break
        at += found[0] if found is not None else 1
    return at


def sentences(words: Phrase) -> list[tuple[Phrase, Phrase]]:
    """The sentences of a message, each with its mark."""
    result: list[tuple[Phrase, Phrase]] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS:
            continue
        if words[start:index]:
            result.append((words[start:index], words[index : index + 1]))
        start = index + 1
    return result


def only_greets(words: Phrase, robots: Sequence[str]) -> bool:
    """Whether a sentence only greets several ("hello A, hello B") or says that one is free."""
    names = {part for name in robots for part in keys(tokens(name))}
    flat = tuple(key for key in keys(words) if key.isalnum())
    greeting = lexicon().greetings.match(flat)
    if len(flat) > 2 and flat[0] in names and flat[1] in lexicon().be and set(flat[2:]) <= _FREE:
        return True
    return (
        greeting is not None
        and len(flat) > 3
        and set(flat) <= names | {"hello", "hi", "hey", "and", "good", "morning"}
    )


def vocative_first(words: Phrase, robots: Sequence[str]) -> Phrase:
    """For "go there, A, and look": A, go there and look."""
    flat = keys(words)
    for index in range(2, len(flat) - 1):
        if flat[index] != ",":
            continue
        name = next(
            (n for n in robots if keys(words[index + 1 : index + 1 + len(tokens(n))]) == keys(tokens(n))), ""
        )
        end = index + 1 + len(tokens(name))
        if name and flat[end : end + 1] == (",",) and is_verb(lemma(flat[0])):
            return (*tokens(name), *tokens(","), *words[:index], *words[end + 1 :])
    return words


def turn_of(words: Phrase, robots: Sequence[str]) -> Phrase:
    """For "it is A's turn to V" and "A's job is to V": A, V."""
    flat = keys(words)
    for name in robots:
        owner = f"{name.lower()}'s"
        if owner not in flat:
            continue
        at = flat.index(owner)
        rest = flat[at + 1 :]
        size = next((len(m) for m in _TURNS if rest[: len(m)] == m), 0)
        if size and (
            at == 0 or flat[:at] in {("it", "is"), ("now", "it", "is"), ("this", "is"), ("that", "is")}
        ):
            return (*tokens(name), *tokens(","), *words[at + 1 + size :])
    return words


_TURNS = (
    ("turn", "to"),
    ("job", "to"),
    ("job", "is", "to"),
    ("task", "is", "to"),
    ("task", "to"),
    ("turn", "now", "to"),
)


def pronoun_named(words: Phrase, situation: Situation) -> Phrase:
    """For "send him to the gate": by name, where a robot was spoken of last."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in _PRONOUNS), 0)
    sent = at and len(situation.robots) > 1 and _SENDING.match_end(flat[:at])
    if not sent or (flat[at] == "it" and flat[at - 1] not in {"send", "tell", "ask", "order", "let"}):
        return words
    if flat[at + 1] not in {"to", "into", "over", "back", "there", "home", "go"} and not is_verb(
        flat[at + 1]
    ):
        return words
    said = (words[:at], *(tokens(turn.content) for turn in reversed(situation.history)))
    names = {name.lower(): name for name in situation.robots if name.isalpha()}
    meant = next((names[w.key] for part in said for w in reversed(part) if w.key in names), "")
    others = [name for name in situation.robots if name != situation.robot]
    meant = meant or (others[0] if len(others) == 1 and flat[at - 1] == "send" else "")
    return (*words[:at], *tokens(meant), *words[at + 1 :]) if meant else words


def for_another(words: Phrase, situation: Situation) -> Phrase:
    """The last order for the robots that are named: "let A do it", "no, I meant A", "and A too".

    Args:
        words: All words and punctuation, with the names.
        situation: Its robots, and what was said before.

    Returns:
        The order without names; empty if more is said, or nothing was asked for.
    """
    names = {part for name in situation.robots for part in keys(tokens(name))}
    flat = tuple(word.key for word in words if word.is_word)
    rest = set(flat) - names
    asks = flat[:1] in {("is",), ("does",), ("can",)} and keys(words[-1:]) == ("?",)
    if not names & set(flat) or not rest & _HANDED or not rest <= _HANDING | _HANDED or asks:
        return ()
    said = next((t.content for t in reversed(situation.history) if t.role == "operator"), "")
    order = tuple(word for word in tokens(said) if word.key not in names)
    while order and (not order[0].is_word or order[0].key in {"and", "please"}):
        order = order[1:]
    return order if order and is_verb(lemma(order[0].key)) else ()
