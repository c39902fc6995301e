"""Statements that say what there is, one by one: "we have three areas here: A, B and C"."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from parley.language.offline.facts.facts import Fact, strip_openers
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.text import Phrase, keys, plain, singular
from parley.language.word_lists import load_data

__all__ = ["read_group", "with_members"]

_LEADS = (
    ("there", "are"),
    ("there", "is"),
    ("we", "have"),
    ("i", "have"),
    ("we", "have", "got"),
    ("these", "are"),
    ("you", "have"),
    ("they", "are"),
    ("we", "watch"),
    ("we", "look", "after"),
    ("you", "will", "find"),
    ("the", "following"),
    ("we", "call", "them"),
    ("here", "are"),
    ("here", "we", "have"),
    ("this", "place", "has"),
    ("this", "building", "has"),
    ("the", "building", "has"),
    ("there", "exist"),
    ("we", "are", "responsible", "for"),
    ("we", "monitor"),
    ("we", "use"),
    ("we", "divide", "this", "into"),
    ("it", "has"),
    ("it", "is", "divided", "into"),
    ("the", "site", "has"),
    ("the", "place", "has"),
    ("you", "are", "responsible", "for"),
    ("you", "look", "after"),
    ("you", "watch"),
    ("you", "guard"),
    ("you", "are", "in", "charge", "of"),
    ("your", "areas", "are"),
)
_MOST_WORDS = 40


@cache
def _kinds() -> frozenset[str]:
    return frozenset(load_data("telling")["groups"])


def read_group(words: Phrase) -> Fact | None:
    """The list that a statement gives, as a fact about the kind of what is listed; None if it gives none."""
    words = strip_openers(words, reporting=True)
    while words and not words[-1].is_word:
        words = words[:-1]
    flat = keys(words)
    if not 4 <= len(flat) <= _MOST_WORDS:
        return None
    lead = next((lead for lead in _LEADS if flat[: len(lead)] == lead), ())
    before = flat.index(":") if ":" in flat else len(flat)
    kind_at = next((i for i in range(before) if flat[i] in _kinds()), -1)
    if kind_at < 0:
        kind_at = next((i for i in range(1, before) if _counted(flat, i)), -1)
    if kind_at < 0:
        return None
    linked = kind_at + 1 < len(flat) and "are" in flat[kind_at + 1 : kind_at + 9]
    starts = flat[0] in lexicon().determiners | {"all", "my", "our", "areas"} or kind_at == 0
    listed = kind_at < 9 and ":" in flat[kind_at : kind_at + 4] and not opens_order(words)
    if not lead and not (linked and starts) and not listed:
        return None
    start = _list_at(flat, kind_at)
    members = coordinated(words[start:]) if start else []
    if len(members) < 2 or not all(0 < len(member) <= 5 for member in members):
        return None
    if any(set(keys(member)) & (lexicon().be | {"you", "i"}) or opens_order(member) for member in members):
        return None
    numbers = set(lexicon().numbers) | {"of"}
    named = bare(
        tuple(
            w for w in words[max(len(lead), 0) : kind_at + 1] if w.key not in numbers and not w.key.isdigit()
        )
    )
    subject = bare(named)[-3:] or (words[kind_at],)
    text = plain(words)
    return Fact(subject, relation="are", state=words[start:], sentence=text[:1].upper() + text[1:])


def _counted(flat: tuple[str, ...], index: int) -> bool:
    """Whether the plural of something stands there with a number before it."""
    before = set(flat[max(0, index - 3) : index])
    return singular(flat[index]) != flat[index] and bool(
        before & set(lexicon().numbers) or any(w.isdigit() for w in before)
    )


def opens_order(words: Phrase) -> bool:
    """Whether words begin with a verb of going, looking or bringing and say more."""
    found = lexicon().verbs.match(keys(words))
    return found is not None and len(words) > found[0] and not words[0].is_capital


def _list_at(flat: tuple[str, ...], kind_at: int) -> int:
    """Where the list begins: behind a colon or a link, or behind a comma."""
    for index in range(kind_at, len(flat) - 2):
        if flat[index] in {":", "-", "namely"}:
            return index + 1
    for index in range(kind_at + 1, min(kind_at + 9, len(flat) - 2)):
        if flat[index] in {"are", "called", "named"}:
            return index + (2 if flat[index + 1] in {"called", "named"} else 1)
    return next((i + 1 for i in range(kind_at + 1, len(flat) - 2) if flat[i] == ","), 0)


_THEM = (
    ("each", "and", "every", "one", "of", "them"),
    ("every", "one", "of", "them"),
    ("every", "single", "one"),
    ("each", "one", "of", "them"),
    ("each", "of", "them"),
    ("all", "of", "them"),
    ("each", "of", "those"),
    ("all", "of", "those"),
    ("them", "all"),
    ("each", "one"),
    ("every", "one"),
    ("all", "three"),
    ("each", "of", "these"),
    ("all", "of", "these"),
    ("them",),
    ("those",),
    ("each",),
)


def with_members(words: Phrase, told: Sequence[Fact]) -> Phrase:
    """A message with "each of them" as what another of its sentences listed.

    Args:
        words: The rest of the message.
        told: What its sentences listed.
    """
    listed = next((fact.state for fact in told if fact.relation == "are"), ())
    flat = keys(words)
    for pronoun in _THEM if listed else ():
        at = next((i for i in range(len(flat)) if flat[i : i + len(pronoun)] == pronoun), -1)
        behind = flat[at + len(pronoun) : at + len(pronoun) + 1]
        if at >= 0 and not (behind and pronoun in {("each",), ("those",)} and behind[0].isalpha()):
            members = tuple(word for word in listed if word.is_word or word.key == ",")
            return (*words[:at], *members, *words[at + len(pronoun) :])
    return words
