"""What clauses are besides orders: haste, where the operator is, a deed that no list of verbs knows."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.sentences.clauses import Clause, opens_command
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = [
    "as_visit",
    "hurries",
    "is_deed",
    "is_span",
    "is_strange_order",
    "says_something",
    "says_where_i_am",
    "without_frame",
]

_SMALL = frozenset({
    "and", "or", "but", "not", "please", "just", "also", "too", "really", "ever", "here", "with", "from",
    "into", "for", "know", "imagine", "believe", "think", "like", "mind", "want", "say", "you", "now", "then",
    "maybe", "still",
})  # fmt: skip
"""With these no deed begins."""


def is_deed(words: Phrase) -> bool:
    """Whether a word that nobody knows stands where the verb of a request is, with something to do it to."""
    flat = keys(words)
    lex = lexicon()
    first = flat[0] if flat else ""
    small = lex.determiners | lex.be | lex.auxiliaries | lex.question_starts | lex.quantifiers | _SMALL
    pronouns = lex.person_pronouns | lex.thing_pronouns | lex.place_pronouns | lex.operator_pronouns
    return len(flat) > 1 and first.isalpha() and len(first) > 2 and first not in small | pronouns


def is_strange_order(words: Phrase) -> bool:
    """Whether a sentence begins with a word nobody knows that acts on something: "dissect the frog"."""
    flat = keys(words)
    lex = lexicon()
    if len(flat) < 2 or not is_deed(words) or flat[0] in lex.vocabulary - _verb_words() or "," in flat[:2]:
        return False
    acts = flat[1] in _ACTED_ON or flat[1].isdigit() or flat[1] in lex.numbers
    return acts and len(flat) > 2 - (flat[1] in _THEM) and not set(flat) & (lex.be | lex.auxiliaries)


_THEM = frozenset({"it", "them", "him", "her"})
_ACTED_ON = _THEM | {"the", "a", "an", "this", "these", "those", "some", "all", "every", "each", "both"}


def _verb_words() -> frozenset[str]:
    return frozenset(verb.split()[0] for verbs in lexicon().verb_classes.values() for verb in verbs)


def says_something(words: Phrase) -> bool:
    """Whether a time at the end belongs to what is to be said ("tell A that we close in ten minutes")."""
    flat = keys(strip_openers(words, requests=True))
    found = lexicon().verbs.match(flat)
    spoken = found is not None and found[1].startswith("speak:") and flat[0] != "remind"
    return spoken or flat[:1] == ("let",)


def hurries(clause: Clause) -> bool:
    """Whether a clause is nothing but "now, please"."""
    return bool(clause.words) and {w.key for w in clause.words if w.is_word} <= _HURRYING


_HURRYING = frozenset(
    {"now", "please", "immediately", "asap", "quickly", "quick", "fast", "hurry", "at", "once", "pls"}
)


def says_where_i_am(clause: Clause) -> bool:
    """Whether a clause says where the operator is."""
    if clause.condition or clause.conditional or keys(clause.words[:2]) not in {("i", "am"), ("we", "are")}:
        return False
    fact = read_statement(clause.words)
    return fact is not None and fact.is_location


def without_frame(words: Phrase) -> Phrase:
    """Without "either" before an order, and without "could you" before "remember that"."""
    rest = strip_openers(words)
    if keys(rest[:1]) == ("either",) and opens_command(rest[1:]):
        return rest[1:]
    asked = strip_openers(rest, requests=True)
    told = lexicon().reporting.match(keys(asked))
    noted = told is not None and told[0] > 1 and len(asked) < len(rest) and len(asked) > told[0] + 1
    return asked if noted else words


def is_span(words: Phrase) -> bool:
    """Whether words are nothing but a counted span of time ("ten minutes")."""
    return (
        len(words) in {2, 3}
        and words[0].key not in {"a", "the"}
        and duration_s((Word("in", "in"), *words)) is not None
    )


def as_visit(words: Phrase, own_verbs: Sequence[tuple[str, ...]] = ()) -> Phrase:
    """For "add (a stop at) the desk to the plan": a visit, unless an action of the robot adds things.

    Args:
        words: All words and punctuation.
        own_verbs: First words of orders that only the catalogue knows.
    """
    rest = strip_openers(words, requests=True)
    if any(keys(rest[:1]) == verb[:1] for verb in own_verbs):
        return words
    if keys(rest[:1]) not in {("add",), ("include",), ("insert",)} or len(rest) < 2:
        return words
    rest = rest[1:]
    flat = keys(rest)
    if flat[:2] in {("a", "stop"), ("a", "visit"), ("another", "stop"), ("a", "trip")} and len(flat) > 3:
        rest = rest[3:]
    plans = {"plan", "queue", "list", "route", "mission", "tour", "schedule"}
    for index in range(1, len(rest) - 2):
        if keys(rest[index : index + 3]) == ("to", "the", "end"):
            rest = rest[:index]
            break
        if rest[index].key in {"to", "in", "into"} and rest[index + 2].key in plans:
            rest = (*rest[:index], *rest[index + 3 :])
            break
    return (Word("visit", "visit"), *rest) if rest else words
