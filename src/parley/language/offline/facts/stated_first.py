"""Where things are, said behind the order that needs it ("bring A the box, it is there"), comes first."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["stated_first"]

IsPerson = Callable[[Phrase], bool]
_NEEDY = frozenset({"transfer", "grasp", "search", "motion", "guide", "meet", "follow", "speak", "look"})


def stated_first(parts: Sequence[Clause], is_person: IsPerson) -> list[Clause]:
    """The clauses with statements of place moved before the order whose thing or person they are about.

    Args:
        parts: All clauses.
        is_person: Whether words name somebody.
    """
    result: list[Clause] = []
    for part in parts:
        about = _about(part, result, is_person)
        if about is None:
            result.append(part)
        else:
            at, clause = about
            result.insert(at, clause)
    return result


def _about(part: Clause, before: Sequence[Clause], is_person: IsPerson) -> tuple[int, Clause] | None:
    """Which order a statement of place is about, and the statement with its pronoun named."""
    if part.is_question or part.conditional or part.condition or not before:
        return None
    fact = read_statement(part.words)
    if fact is None or not fact.is_location or fact.negated:
        return None
    for at in range(len(before) - 1, -1, -1):
        if before[at].condition or before[at].conditional:
            continue
        command = read_command(before[at].words, is_person)
        if command is None or command.negated or command.kind not in _NEEDY:
            continue
        named = _named(keys(bare(fact.subject)), command, is_person)
        if named:
            words = strip_openers(part.words, reporting=True)
            size = len(words) - len(words[len(fact.subject) :])
            told = (*named, *words[size:]) if keys(words[:size]) == keys(fact.subject) else part.words
            passing = keys(fact.subject)[0] in lexicon().person_pronouns and is_person(named)
            return at, replace(part, words=told, passing=passing)
    return None


def _named(subject: tuple[str, ...], command: Command, is_person: IsPerson) -> Phrase:
    """What the subject of a statement is called in the order before it; empty if that is not about it."""
    lex = lexicon()
    theme, people = bare(command.theme), [p for p in (command.recipient, command.theme, command.place) if p]
    if len(subject) == 1 and subject[0] in {"it", "they", "those", "these", "that"}:
        thing = theme or bare(command.place)
        return _with_article(thing) if thing and not is_person(thing) else ()
    if len(subject) == 1 and subject[0] in lex.person_pronouns:
        who = next((p for p in people if is_person(p) and keys(p)[0] not in lex.operator_pronouns), ())
        return () if keys(bare(who))[:1] and keys(bare(who))[0] in lex.person_pronouns else who
    return next(
        (_with_article(p) if not is_person(p) else p for p in (theme, *people) if keys(bare(p)) == subject),
        (),
    )


def _with_article(thing: Phrase) -> Phrase:
    plain_name = thing[0].is_capital or keys(thing)[0] in lexicon().determiners or thing[0].key.endswith("'s")
    return thing if plain_name else (Word("the", "the"), *thing)
