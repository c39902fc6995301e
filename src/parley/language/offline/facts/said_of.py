"""Statements that begin with what they are about: "X is on the Y", "X has moved to the Y", "X is locked"."""

from __future__ import annotations

from typing import Final

from parley.language.offline.facts.fact import Fact
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["NOT_SUBJECTS", "NO_PLACES", "said_of"]

NOT_SUBJECTS: Final = frozenset(
    [
        "what",
        "where",
        "who",
        "when",
        "why",
        "how",
        "which",
        "there",
        "you",
        "let",
        "if",
        "whether",
        "please",
        "can",
        "could",
        "would",
        "will",
        "do",
        "does",
        "did",
    ]
)
_STATE_VERBS = frozenset(
    [
        "has",
        "needs",
        "likes",
        "wants",
        "prefers",
        "hates",
        "loves",
        "means",
        "takes",
        "weighs",
        "costs",
        "belongs",
        "opens",
        "closes",
        "works",
        "lives",
        "feels",
        "looks",
    ]
) | frozenset(
    [
        "owns",
        "drives",
        "rents",
        "uses",
        "eats",
        "drinks",
        "starts",
        "ends",
        "begins",
        "speaks",
        "plays",
        "wears",
        "gets",
        "covers",
        "leads",
        "suffers",
        "smokes",
        "reads",
        "sleeps",
        "goes",
        "leaves",
        "arrives",
        "serves",
        "cleans",
        "repairs",
        "teaches",
        "studies",
        "manages",
        "runs",
    ]
)
_OF_SEVERAL = frozenset(
    {"end", "start", "begin", "need", "have", "like", "close", "open", "belong", "last", "cost"}
)
_NOT_WHERE = frozenset({"of", "from", "with", "against"})
NO_PLACES = frozenset(
    [
        "loan",
        "strike",
        "repair",
        "construction",
        "maintenance",
        "control",
        "sale",
        "duty",
        "vacation",
        "holiday",
        "renovation",
        "time",
        "order",
        "charge",
        "trouble",
        "fire",
        "danger",
        "love",
        "pain",
        "use",
        "place",
        "tears",
        "pieces",
        "stock",
        "service",
        "operation",
        "progress",
        "shape",
        "vain",
        "doubt",
        "bloom",
        "hand",
        "half",
        "bits",
        "agony",
        "shock",
    ]
)


def _is_time(flat: tuple[str, ...], at: int, size: int) -> bool:
    """For "(not here before half) past eight"."""
    behind = flat[at + size : at + size + 1]
    numbered = bool(behind) and (behind[0] in lexicon().numbers or behind[0].isdigit())
    return "past" in flat[at : at + size] and (numbered or flat[at - 1 : at] in {("half",), ("quarter",)})


def _place_behind(
    flat: tuple[str, ...], behind: int, at: int, found: tuple[int, str]
) -> tuple[int, tuple[int, str]]:
    """For "(she is in tears) out in the hall": the place behind how somebody is."""
    start = behind + (flat[behind : behind + 1] in {("out",), ("over",), ("up",), ("down",), ("back",)})
    place = lexicon().places.match(flat, start)
    return (start, place) if place is not None else (at, found)


def said_of(phrase: Phrase) -> Fact | None:
    """What is said of a subject that comes first; None if nothing is.

    Args:
        phrase: One clause, without what only opens it.
    """
    flat = keys(phrase)
    if flat[0] in NOT_SUBJECTS:
        return None
    link = _link(flat)
    subject = bare(phrase[:link])
    if not link or not subject or link > 9 or any(not word.is_word for word in phrase[:link]):
        return None
    subject = _operator(subject)
    at, negated = _after_link(flat, link)
    if keys(subject[-2:]) in {("no", "longer"), ("used", "to")} and len(subject) > 2:
        # What used to be so is so no more.
        subject, negated = subject[:-2], True
    but = flat.index("but", at) if negated and "but" in flat[at:-1] else 0
    if but:
        # "Not on the desk but on the shelf".
        at, negated = but + 1, False
    place = _where(phrase, flat, link, at)
    if place is not None:
        return Fact(subject, place[0], place[1], negated=negated)
    if subject[-1].key in {"location", "place", "position"} and len(subject) > 1 and at < len(flat):
        return Fact(_possessor(subject[:-1]), bare(phrase[at:]), "at", negated=negated)
    if keys(subject) in {("it",), ("that",), ("this",), ("these",), ("those",)}:
        # "That is good" says nothing worth keeping.
        return None
    state = phrase[at:]
    return Fact(subject, relation=flat[link], state=state, negated=negated) if state else None


def _link(flat: tuple[str, ...]) -> int:
    """Where the word stands that links a subject and what is said of it; 0 if there is none."""
    lex = lexicon()
    return next(
        (
            i
            for i in range(1, len(flat))
            if flat[i] in lex.be
            or (
                flat[i] in {"has", "have", "can", "will", "should"}
                and set(flat[i + 1 : i + 3]) & (lex.be | lex.transition_verbs | lex.location_verbs)
            )
            or (
                flat[i] in lex.location_verbs | lex.transition_verbs
                and lex.goals.match(flat, i + 1) is None
                and lex.places.match(flat, i + 1) is not None
            )
            or (flat[i] in lex.transition_verbs and flat[i + 1 : i + 2] in {("to",), ("into",), ("onto",)})
            or (flat[i] in lex.transition_verbs and flat[i + 1 : i + 3] in {("over", "to"), ("back", "to")})
            or (
                flat[i] in lex.location_verbs
                and lex.places.match(flat, i + 1) is not None
                and i + 2 < len(flat)
            )
            or flat[i] in _STATE_VERBS
            or (flat[i] in _OF_SEVERAL and flat[i - 1].endswith("s") and flat[i - 1] not in lex.vocabulary)
        ),
        0,
    )


def _where(phrase: Phrase, flat: tuple[str, ...], link: int, at: int) -> tuple[Phrase, str] | None:
    """The place that is said of a subject, and its preposition; None if none is."""
    lex = lexicon()
    if flat[at : at + 1] == ("from",) and "to" in flat[at + 1 : -1] and link < at + 1:
        # "Went from the desk to the shelf".
        goal = flat.index("to", at)
        if set(flat[link : at + 1]) & lex.transition_verbs:
            return bare(phrase[goal + 1 :]), "at"
    if flat[at : at + 1] == ("with",) and at + 1 < len(flat) and phrase[at + 1].is_capital:
        return bare(phrase[at + 1 :]), "with"
    found = lex.places.match(flat, at)
    moved = bool(set(flat[link:at]) & lex.transition_verbs) or flat[at - 1] in lex.transition_verbs
    if found is None and moved and flat[at : at + 1] in {("to",), ("into",), ("onto",)}:
        found = 1, {"to": "at", "into": "in", "onto": "on"}[flat[at]]
    if found is not None and _is_time(flat, at, found[0]):
        found = None
    if found is not None and flat[at + found[0] : at + found[0] + 1] in {(word,) for word in NO_PLACES}:
        at, found = _place_behind(flat, at + found[0] + 1, at, found)
    if (
        found is not None
        and at + found[0] < len(flat)
        and flat[at + found[0]] not in NO_PLACES
        and found[1] not in _NOT_WHERE
    ):
        return bare(phrase[at + found[0] :]), found[1]
    return None


def _possessor(phrase: Phrase) -> Phrase:
    last = phrase[-1]
    return (*phrase[:-1], Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s")))


def _after_link(flat: tuple[str, ...], link: int) -> tuple[int, bool]:
    """Where what is said begins, and whether it is denied."""
    lex = lexicon()
    at, negated = link, False
    fillers = {
        "now",
        "currently",
        "still",
        "always",
        "usually",
        "already",
        "just",
        "right",
        "again",
        "actually",
        "also",
        "there",
        "over",
        "recently",
        "all",
        "both",
        "temporarily",
        "presently",
        "provisionally",
        "being",
        "meanwhile",
    }
    while at < len(flat):
        if flat[at] in {"not", "never"} or flat[at : at + 2] == ("no", "longer"):
            negated = True
            at += 2 if flat[at] == "no" else 1
        elif (
            flat[at] in lex.be | fillers
            or (flat[at] in lex.auxiliaries and at == link and flat[at] not in {"has", "have"})
            or (
                flat[at] in {"has", "have"}
                and set(flat[at + 1 : at + 3])
                & (lex.be | lex.transition_verbs | lex.location_verbs | {"not"})
            )
            or (
                flat[at] in lex.location_verbs | lex.transition_verbs
                and (
                    lex.places.match(flat, at + 1) or flat[at + 1 : at + 2] in {("to",), ("into",), ("onto",)}
                )
            )
        ):
            at += 1
        else:
            break
    return at, negated


def _operator(subject: Phrase) -> Phrase:
    if keys(subject) in {("i",), ("we",)}:
        return (Word("operator", "operator"),)
    return subject
