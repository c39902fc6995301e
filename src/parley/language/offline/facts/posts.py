"""Who somebody is that is only called by what they are: "the head chef", "A's boss", "the tall guest"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

from parley.language.offline.facts.fact import Fact
from parley.language.offline.facts.remembering import ONLY_NOW, Remembered
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["by_their_roles", "is_somebodys", "role_holders", "without_called"]

_TITLES = frozenset(load_data("people")["titles"])
_SINCE = frozenset({"new", "current", "acting", "temporary", "old"})
_AFTER_NAMES = frozenset({"and", "who", "now", "today", "tonight", "at", "for", "since", "this", "in"})
_BETWEEN = frozenset({"called", "named", "now", "still", "again", "not"})
_LONGEST_NAME = 3
_LEAST_TOLD = 2


def by_their_roles(words: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """A message with the names of those who are remembered to be what it says ("A's boss", "the shift lead").

    Args:
        words: All words and punctuation.
        facts: What is remembered, newest first.
    """
    said = keys(words)
    here = [*role_holders([item for item in facts if item.entry.name == ONLY_NOW])]
    settled: set[tuple[str, ...]] = set()
    for index, (role, name) in enumerate((*here, *role_holders(facts))):
        at = -1 if role in settled else _where_meant(words, said, role)
        settled.add(role)
        named_so = index >= len(here) and bool(set(keys(name)) & set(said))
        if at >= 0 and not named_so:
            start, end = at, at + len(role)
            while start > 0 and said[start - 1] in {"the", "our"} | _SINCE:
                start -= 1
            return (*words[:start], *name, *words[end:])
    return _by_what_they_are(_by_what_they_do(words, facts), facts)


def _by_what_they_do(words: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """For "A's doctor" the one doctor who is remembered to look after A, for "B's trainer" who trains B."""
    flat = keys(words)
    for index in range(1, len(flat)):
        if flat[index] not in lexicon().person_words:
            continue
        start, end, owner = _whose(words, index)
        if not owner:
            continue
        doing: dict[tuple[str, ...], Phrase] = {}
        for item in facts:
            fact = item.fact
            about = owner in keys((*fact.state, *fact.place)) and is_somebodys(item)
            if about and (_is_titled(fact.subject, flat[index]) or _does(fact.relation, flat[index])):
                doing[keys(fact.subject)] = fact.subject
        if len(doing) == 1:
            (name,) = doing.values()
            return (*words[:start], *name, *words[end:])
    return words


def _whose(words: Phrase, at: int) -> tuple[int, int, str]:
    """For "(the) A's doctor" and "the doctor of A": from where to where that is said, and A."""
    before, behind = words[at - 1], words[at + 1 : at + 4]
    if before.key.endswith("'s") or before.raw.endswith("s'"):
        start = at - 1
        while start > 1 and words[start - 1].is_capital:
            start -= 1
        return start, at + 1, before.key.removesuffix("'s")
    size = next((i for i, word in enumerate(behind[1:]) if not word.is_capital), len(behind) - 1)
    if before.key != "the" or keys(behind[:1]) != ("of",) or size < 1:
        return at, at, ""
    return at - 1, at + 2 + size, behind[size].key


def _is_titled(name: Phrase, role: str) -> bool:
    """Whether a name begins with what somebody is ("Dr A" for a doctor)."""
    return name[0].key in _TITLES and (role.startswith(name[0].key[:1]) and role.endswith(name[0].key[-1:]))


def _does(relation: str, role: str) -> bool:
    """Whether a deed is what somebody does who is called so ("teaches", "teacher")."""
    base = lemma(relation)
    return (
        role.endswith(("er", "or"))
        and len(base) > _LEAST_TOLD
        and role[:-2] in {base, base.removesuffix("e")}
    )


def _where_meant(words: Phrase, said: tuple[str, ...], role: tuple[str, ...]) -> int:
    """Where a role stands for whoever has it; -1 if it does not."""
    for at in range(len(said)):
        named = _same_role(said[at : at + len(role)], role)
        # "A wants to see her brother": A's brother.
        theirs = len(role) == 2 and role[0].removesuffix("'s") in said
        if not (named or (theirs and _is_their_role(said[at : at + 2], role))):
            continue
        end = at + len(role)
        if said[end : end + 1] != () and said[end] in lexicon().be:
            behind = (word for word in words[end + 1 :] if word.key not in _BETWEEN)
            if next((word.is_capital for word in behind), False):
                # "Remember that A's daughter is called B".
                continue
        if not (_is_told(said, at, end) or _is_said_of(words, at)):
            return at
    return -1


def role_holders(facts: Sequence[Remembered]) -> Iterator[tuple[tuple[str, ...], Phrase]]:
    """What people are remembered to be, and their names, the last told first."""
    known = {keys(item.fact.subject) for item in facts if not _is_same(item.fact)}
    for item in facts:
        fact = item.fact
        if not _is_same(fact) or not fact.state:
            continue
        for role, name in ((bare(fact.state), fact.subject), (fact.subject, without_called(fact.state))):
            wanted = _without_since(keys(_without_more(role)))
            name = _without_more(name)
            if set(wanted) <= lexicon().ordinals.keys() or not name or not _is_name(name):
                continue
            theirs = len(wanted) > 1 and any(word.endswith("'s") for word in wanted[:-1])
            named = role is fact.subject and keys(fact.state[:1]) in {("called",), ("named",)}
            somebody = keys(name) in known or keys(name)[0] in _TITLES
            post = named or somebody or bool(lexicon().person_words & set(wanted))
            if theirs or (post and not any(word.is_capital for word in role[:1])):
                yield wanted, name


def _is_same(fact: Fact) -> bool:
    """Whether a fact says what somebody or something is."""
    return not (fact.is_location or fact.negated) and fact.relation in lexicon().be


def _is_name(name: Phrase) -> bool:
    capital = all(word.is_capital for word in name) and not any("'s" in word.key for word in name)
    return capital and len(name) <= _LONGEST_NAME


def _without_more(said: Phrase) -> Phrase:
    """Without what is told besides: "A and sits in B", "A today"."""
    at = next(
        (i for i, word in enumerate(said) if i and (not word.is_word or word.key in _AFTER_NAMES)), len(said)
    )
    return said[:at]


def _without_since(role: tuple[str, ...]) -> tuple[str, ...]:
    return role[1:] if role[:1] and role[0] in _SINCE and len(role) > 1 else role


def _is_told(said: tuple[str, ...], at: int, end: int) -> bool:
    """Whether it is told who that is ("the head chef is A now"), or what became of them."""
    before = set()
    for key in reversed(said[:at]):
        if key in {".", "!", "?", ",", ";"}:
            break
        before.add(key)
    opens = before <= lexicon().determiners | _SINCE
    return opens and said[end : end + 1] != () and said[end] in lexicon().be | {"has", "moved", "left"}


def _is_said_of(words: Phrase, at: int) -> bool:
    """For "A is the head chef", "is A the head chef?": whether it is said of somebody."""
    while at > 0 and words[at - 1].key in lexicon().determiners | _SINCE | {"now", "not"}:
        at -= 1
    flat = keys(words[:at])
    if flat[-1:] != () and flat[-1] in lexicon().be:
        return len(flat) > 1 and words[at - 2].is_capital and flat[-2] not in lexicon().question_starts
    return at > 1 and words[at - 1].is_capital and bool(lexicon().be & set(flat[:1]))


def _is_their_role(said: tuple[str, ...], role: tuple[str, ...]) -> bool:
    return said[:1] in {("her",), ("his",)} and said[1:] == role[1:]


def without_called(state: Phrase) -> Phrase:
    """A name, without "called" before it."""
    return bare(state[1:] if keys(state[:1]) in {("called",), ("named",)} else state)


def _same_role(said: tuple[str, ...], role: tuple[str, ...]) -> bool:
    """Whether words name a role, if need be by another word for it ("A's boss")."""
    alike = lexicon().synonyms.get(role[-1], frozenset()) if role else frozenset()
    return said == role or (
        len(role) > 1 and said[:-1] == role[:-1] and said[-1:] != () and said[-1] in alike
    )


@cache
def _small() -> frozenset[str]:
    """Words that say nothing about somebody."""
    return lexicon().determiners | lexicon().vocabulary - lexicon().states


def _by_what_they_are(words: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """For "the left-handed guest" the name of the one person who is remembered to be left-handed."""
    flat = keys(words)
    for index in range(1, len(flat)):
        start = index
        if flat[index] not in lexicon().person_words:
            continue
        while start and flat[start - 1] not in _small():
            start -= 1
        traits = set(flat[start:index])
        if not traits or not start or flat[start - 1] != "the":
            continue
        fitting = {
            keys(f.fact.subject): f.fact.subject
            for f in facts
            if is_somebodys(f) and traits <= set(keys(f.fact.state))
        }
        if len(fitting) == 1:
            (name,) = fitting.values()
            return (*words[: start - 1], *name, *words[index + 1 :])
    return words


def is_somebodys(item: Remembered) -> bool:
    """Whether a fact is about a person."""
    subject = item.fact.subject
    named = (
        bool(subject) and all(word.is_capital for word in subject) and keys(subject)[0] not in lexicon().nouns
    )
    return bool(subject) and (named or keys(subject)[-1] in lexicon().person_words) and not item.fact.negated
