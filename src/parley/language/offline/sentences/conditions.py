"""Conditions of a sentence: "if S, V, otherwise W", "V unless S", "when S, V", "..., if not, W"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.sentences.echoes import echo
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, lemma

__all__ = ["LAST", "Conditional", "is_rule", "split_condition"]

Opens = Callable[[Phrase], bool]

LAST: Phrase = ()
"""Stands for what the step before looked at."""

_LEADING: tuple[tuple[tuple[str, ...], bool], ...] = (
    (("if",), True),
    (("only", "if"), True),
    (("in", "case"), True),
    (("should",), True),
    (("unless",), False),
)
"""How a condition begins, and whether it must hold."""
_TRAILING: tuple[tuple[tuple[str, ...], bool], ...] = (
    (("only", "if"), True),
    (("but", "only", "if"), True),
    (("in", "case"), True),
    (("unless",), False),
    (("if",), True),
)
_ASKING = frozenset(
    [
        "as",
        "check",
        "see",
        "out",
        "know",
        "me",
        "look",
        "inspect",
        "tell",
        "verify",
        "what",
        "even",
        "ask",
        "or",
        "like",
    ]
)
_WHOEVER = frozenset(
    ["you", "i", "we", "anyone", "anybody", "somebody", "someone", "anything", "something", "nobody"]
)


@dataclass(frozen=True, slots=True)
class Conditional:
    """A sentence in parts."""

    before: Phrase
    """What is done in any case, first."""
    condition: Phrase
    """What has to be looked at; `LAST` if it has been."""
    then: Phrase
    otherwise: Phrase
    late: bool = False
    """Whether the condition was said behind what depends on it."""


def is_rule(condition: Phrase) -> bool:
    """Whether it is about whatever may happen later ("you see smoke"): such a rule is kept, not done."""
    if not condition or condition[0].key not in _WHOEVER:
        return False
    # "Somebody is at the desk" can be looked at now; "you see smoke" is about whatever comes.
    flat = keys(condition)
    flat = (flat[0], *flat[2:]) if flat[1:2] == ("else",) else flat
    there = any(
        lexicon().places.match(flat, at) is not None or flat[at] == "there"
        for at in range(2, min(5, len(flat)))
    )
    placed = len(flat) > 2 and flat[1] in lexicon().be | {"has", "stands", "sits", "lies"} and there
    return flat[0] in {"you", "i", "we"} or not placed


def split_condition(sentence: Phrase, opens: Opens) -> Conditional | None:
    """The parts of a sentence with a condition; None if it has none."""
    words = strip_openers(sentence)
    return _further(words, opens) or _leading(words, opens) or _inside(words, opens)


def _further(words: Phrase, opens: Opens) -> Conditional | None:
    """A sentence that begins with "if not" and the like."""
    again = echo(words, 0, opens)
    if again is None or again.kind not in _REPEATING or again.size >= len(words):
        return None
    rest = words[again.size :]
    return Conditional((), LAST, rest, ()) if again.holds else Conditional((), LAST, (), rest)


_REPEATING = frozenset({"state", "there", "else"})


def _leading(words: Phrase, opens: Opens) -> Conditional | None:
    flat = keys(words)
    found = next(((m, holds) for m, holds in _LEADING if flat[: len(m)] == m), None)
    if found is None and _is_state(flat):
        found = ("when",), True
    if found is None or (
        flat[len(found[0]) : len(found[0]) + 1] == ("you",) and flat[-1] != "?" and _polite(flat)
    ):
        return None
    marker, holds = found
    start = len(marker)
    comma = next((i for i in range(start + 2, len(flat)) if flat[i] in {",", "then"}), len(flat))
    verb = next(
        (
            i
            for i in range(start + 3, comma)
            if opens(words[i:])
            and not _is_noun(flat, i)
            and not (flat[i].endswith("s") and lemma(flat[i]) != flat[i])
            and not (i == comma - 1 and opens(words[comma + 1 :]))
            and flat[i - 1] not in lexicon().be | {"still", "already", "not"}
            and not (comma < len(flat) and flat[i].endswith("ing"))
        ),
        0,
    )
    cut = verb or (comma if comma < len(flat) else 0)
    if not cut or (marker == ("should",) and not opens(words[cut:])):
        return None
    condition = words[start:cut]
    if marker == ("should",):
        condition = tuple(replace(w, key="is", raw="is") if w.key == "be" else w for w in condition)
    return _parts((), condition, words[cut:], opens, holds=holds)


def _polite(flat: tuple[str, ...]) -> bool:
    return flat[1:3] in {("you", "can"), ("you", "could"), ("you", "want"), ("you", "like"), ("you", "have")}


def _is_state(flat: tuple[str, ...]) -> bool:
    """For "When the box is empty, ...": a state, and neither the robot's nor "when that is done"."""
    if (
        flat[:1] != ("when",)
        or flat[1:2] == ()
        or flat[1] in {"you", "i", "that", "this", "done", "it", "we"}
    ):
        return False
    return any(word in lexicon().be for word in flat[2:7])


def _inside(words: Phrase, opens: Opens) -> Conditional | None:
    """A condition behind what it is for, or behind a look: "V if S", "check X and if it is P, V"."""
    flat = keys(words)
    if flat[:1] == ("tell",) or {"remind"} & set(flat[:3]):
        return None
    for index in range(2, len(flat) - 1):
        if flat[index - 1] in {"and", ",", "but", "then"}:
            start = index
            further = _further(words[start:], opens)
            if further is not None:
                return _with_before(words[: start - 1], further)
            leading = _leading(words[start:], opens) if flat[index] in {"if", "unless", "should"} else None
            if leading is not None:
                return _with_before(words[: start - 1], leading)
        for marker, holds in _TRAILING:
            if flat[index : index + len(marker)] != marker or len(flat) < index + len(marker) + 2:
                continue
            if not _may_follow(flat, index, marker):
                continue
            start = next((i for i in range(index - 1, 0, -1) if flat[i] == "then"), 0)
            before = words[:start] if start and opens(words[start + 1 : index]) else ()
            main = words[start + 1 : index] if before else words[:index]
            return replace(_parts(before, words[index + len(marker) :], main, opens, holds=holds), late=True)
    return None


def _with_before(before: Phrase, parts: Conditional) -> Conditional:
    return Conditional(before, parts.condition, parts.then, parts.otherwise)


def _may_follow(flat: tuple[str, ...], index: int, marker: tuple[str, ...]) -> bool:
    if marker != ("if",):
        return True
    before = flat[index - 1]
    return (
        lexicon().verbs.match_end((lemma(before), "if")) == 0
        and flat[index + 1] not in {"you", "possible", "not", "so", "it's"}
        and before not in _ASKING
        and before not in {"and", ","}
        and "ask" not in flat[:index]
    )


def _parts(before: Phrase, condition: Phrase, rest: Phrase, opens: Opens, *, holds: bool) -> Conditional:
    """Cut "otherwise" off, which may stand behind the condition as well."""
    condition, late = _otherwise(condition, opens)
    rest, other = _otherwise(rest, opens)
    other = other or late
    if is_rule(condition):
        return Conditional(before, condition, rest, ())
    condition, denied = _positive(condition)
    if holds == denied:
        rest, other = other, rest
    return Conditional(before, condition, rest, other)


def _positive(condition: Phrase) -> tuple[Phrase, bool]:
    """Turn a denial ("X is not there") into what can be looked at ("X is there"); whether it was one."""
    flat = keys(condition)
    for index in range(1, len(flat)):
        if flat[index] == "not" and flat[index - 1] in lexicon().be:
            return condition[:index] + condition[index + 1 :], True
    return condition, False


def _otherwise(words: Phrase, opens: Opens) -> tuple[Phrase, Phrase]:
    for index in range(1, len(words) - 1):
        again = echo(words, index, opens)
        if again is not None and not again.holds and again.kind in _REPEATING:
            return words[:index], words[index + again.size :]
    return words, ()


def _is_noun(flat: tuple[str, ...], index: int) -> bool:
    """Whether a word that may be a verb stands where only a noun can ("under press 2")."""
    before = flat[index - 1]
    if before in lexicon().determiners | {"to", "of"}:
        return True
    # "If somebody is in go away": such a preposition may end a condition.
    return before not in _ENDING and lexicon().places.match(flat, index - 1) is not None


_ENDING = frozenset({"in", "on", "off", "up", "down", "around", "by", "inside", "outside", "nearby", "back"})
