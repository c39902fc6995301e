"""Orders that say only that somebody should look; what at is said before ("is A open? go and see")."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["as_look", "confirming", "is_look", "looking_in"]

_LOOKING = frozenset(
    {
        "look",
        "glance",
        "peek",
        "see",
        "check",
        "inspect",
        "verify",
        "examine",
        "investigate",
        "inspection",
        "out",
        "closer",
        "peep",
        "watch",
        "confirm",
    }
)
_AROUND = frozenset(
    {
        "round",
        "around",
        "how",
        "bad",
        "badly",
        "serious",
        "big",
        "much",
        "looks",
        "go",
        "and",
        "come",
        "take",
        "have",
        "give",
        "it",
        "that",
        "this",
        "them",
        "a",
        "an",
        "another",
        "quick",
        "short",
        "better",
        "closer",
        "good",
        "proper",
        "find",
        "please",
        "for",
        "me",
        "us",
        "yourself",
        "over",
        "there",
        "up",
        "on",
        "to",
        "at",
        "into",
        "just",
        "could",
        "can",
        "would",
        "will",
        "you",
        "somebody",
        "someone",
        "should",
        "must",
        "needs",
        "has",
        "drive",
        "kindly",
        "now",
        "then",
        "so",
        "do",
        "make",
        "sure",
        "quickly",
        "first",
        "once",
        "again",
        "more",
        "closely",
        "carefully",
        "thoroughly",
        "inside",
        "right",
        "away",
        "immediately",
        "maybe",
        "perhaps",
        "thorough",
        "close",
        "little",
        "brief",
        "what",
        "is",
        "going",
        "happening",
        "wrong",
        "the",
        "matter",
        "with",
        "in",
        "detail",
        "further",
        "near",
        "nearer",
        "might",
        "want",
        "need",
        "i",
        "we",
        "ought",
        "double",
        "nearby",
        "one",
        "time",
    }
)
_NOT_LOOKING = frozenset(
    {
        ("look", "for"),
        ("find", "it"),
        ("find", "them"),
        ("find", "that"),
        ("find", "me"),
        ("see", "you"),
        ("see", "me"),
        ("check", "in"),
        ("watch", "out"),
        ("look", "out"),
        ("see", "to"),
        ("give", "me"),
        ("give", "us"),
    }
)
_MOVING = frozenset({"go", "drive", "move", "get", "come", "step", "roll", "walk"})
_NEARER = frozenset(
    {
        "a",
        "bit",
        "little",
        "nearer",
        "closer",
        "up",
        "to",
        "it",
        "that",
        "there",
        "much",
        "even",
        "in",
        "the",
        "thing",
    }
)
_POINTING = frozenset({"it", "that", "this", "them"})
_PLAIN = frozenset({("check",), ("inspect",), ("look",), ("see",), ("inspect", "it"), ("check", "it")})
_MOST_WORDS = 14


def as_look(words: Phrase) -> Phrase:
    """Words that say only that somebody should look, in the plainest form; others come back unchanged."""
    flat = tuple(word.key for word in words if word.is_word)
    tail = lexicon().adverbs.match_end(flat)
    flat = flat[:-tail] if 2 < tail < len(flat) else flat
    if (
        flat[:3] == ("tell", "me", "what")
        and flat[-1] in _POINTING
        and {"written", "printed", "on", "in", "inside"} & set(flat)
    ):
        return (Word("inspect", "inspect"), Word("it", "it"))
    if flat[:1] and flat[0] in _MOVING and set(flat[1:]) <= _NEARER and {"nearer", "closer"} & set(flat):
        return tuple(Word(text, text) for text in ("go", "to", "it"))
    if flat in {("confirm",), ("please", "confirm"), ("confirm", "please"), ("confirm", "that")}:
        return (Word("check", "check"),)
    if not 2 <= len(flat) <= _MOST_WORDS or flat in _PLAIN or not set(flat) <= _LOOKING | _AROUND:
        return words
    pairs = set(pairwise(flat))
    looks = set(flat) & (_LOOKING - {"out", "closer"}) or ("find", "out") in pairs
    if pairs & _NOT_LOOKING or not looks or flat[0] in {"what", "is"}:
        return words
    if "how" in flat:
        return (Word("check", "check"),)
    if _POINTING & set(flat):
        return (Word("inspect", "inspect"), Word("it", "it"))
    if "there" in flat:
        return (Word("inspect", "inspect"), Word("there", "there"))
    return (Word("check", "check"),)


def is_look(words: Phrase) -> bool:
    """Whether words say only that somebody should look."""
    flat = tuple(word.key for word in words if word.is_word)
    return flat in _PLAIN or flat == ("inspect", "there") or as_look(words) != words


_LOOKING_IN = (
    ("look", "in", "on"),
    ("check", "on"),
    ("check", "in", "on"),
    ("drop", "in", "on"),
    ("pop", "in", "on"),
    ("call", "on"),
    ("look", "in", "at"),
    ("look", "after"),
    ("pop", "over", "to"),
    ("see", "to"),
)
_STATING = (
    ("see", "if"),
    ("see", "whether"),
    ("check", "if"),
    ("check", "whether"),
    ("find", "out", "if"),
    ("see", "how"),
    ("check", "how"),
    ("find", "out", "whether"),
    ("tell", "me", "if"),
    ("tell", "me", "whether"),
    ("tell", "me", "how"),
    ("make", "sure"),
    ("find", "out", "how"),
    ("look", "if"),
    ("look", "whether"),
)


def looking_in(parts: Sequence[Clause], is_person: Callable[[Phrase], bool]) -> list[Clause]:
    """For "look in on A and see if she sleeps" going to A: what to look for is said by what follows.

    Args:
        parts: The clauses of a message.
        is_person: Whether words name somebody.
    """
    result = list(parts)
    for index in range(len(result) - 1):
        words, following = strip_openers(result[index].words, requests=True), keys(result[index + 1].words)
        lead = next((lead for lead in _LOOKING_IN if keys(words)[: len(lead)] == lead), ())
        state = next((lead for lead in _STATING if following[: len(lead)] == lead), ())
        if (
            lead
            and state
            and following[len(state) : len(state) + 1] in _PRONOUNS
            and is_person(words[len(lead) :])
        ):
            moved = (Word("go", "go"), Word("to", "to"), *words[len(lead) :])
            result[index] = replace(result[index], words=moved)
    return result


_PRONOUNS = frozenset({("he",), ("she",), ("they",), ("it",)})


_UNSURE = (
    ("should",),
    ("must",),
    ("ought", "to"),
    ("is", "supposed", "to"),
    ("are", "supposed", "to"),
    ("might",),
    ("may",),
    ("is", "said", "to"),
    ("are", "said", "to"),
)


def confirming(parts: Sequence[Clause]) -> list[Clause]:
    """For "A should be at B, please confirm" checking whether A is at B."""
    result = list(parts)
    for index in range(len(result) - 1):
        words, following = result[index].words, result[index + 1].words
        flat = keys(words)
        at, marker = next(
            ((i, m) for i in range(1, len(flat) - 1) for m in _UNSURE if flat[i : i + len(m)] == m), (0, ())
        )
        if (
            not at
            or keys(following) not in _PLAIN | {("confirm",)}
            or result[index].is_question
            or flat[0] in {"you", "i", "we"}
        ):
            continue
        if flat[at + len(marker)] != "be":
            continue
        verb = "are" if flat[at - 1].endswith("s") and not flat[at - 1].endswith("'s") else "is"
        state = (
            Word("check", "check"),
            Word("whether", "whether"),
            *words[:at],
            Word(verb, verb),
            *words[at + len(marker) + 1 :],
        )
        result[index] = replace(result[index], words=state)
        result[index + 1] = replace(result[index + 1], words=())
    return [part for part in result if part.words]
