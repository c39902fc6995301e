"""Standing rules: what people teach for a case that may come ("if you see a crack, stop and tell me").

A rule is kept as a memory in the person's words, and read again when something is seen or goes wrong. Its
words stand in `lexicon/standing.yaml`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any, Literal

from parley.language.builtin.amounts import amount_of, in_unit
from parley.language.builtin.lexicon import is_somebody, lexicon, stem
from parley.language.builtin.tokens import tokenize
from parley.language.lexicon import load_data

__all__ = ["Act", "StandingRule", "read_rule", "read_sighting_rule", "sighted", "tells_in_case"]

_LONGEST = 400


@dataclass(frozen=True, slots=True)
class Act:
    """One part of what is to be done."""

    kind: str
    """`again`, `around`, `skip`, `stop`, `tell`, `cancel`, `wait`, or `order`."""
    words: str
    """As it was said."""
    delay_s: float = 0.0
    """For `wait`."""


@dataclass(frozen=True, slots=True)
class StandingRule:
    """What to do in a case."""

    case: tuple[str, ...]
    """The words of the case, in small letters."""
    about: Literal["sight", "trouble", ""]
    """Whether it speaks of what is seen or of what goes wrong."""
    names: frozenset[str]
    """The words of the case that name something in particular."""
    acts: tuple[Act, ...]
    sentence: str
    """The whole rule in the person's words."""

    def has(self, kind: str) -> bool:
        """Whether one of its parts is of this kind."""
        return any(act.kind == kind for act in self.acts)

    @property
    def delay_s(self) -> float:
        """How long to wait first."""
        return sum(act.delay_s for act in self.acts)


@dataclass(frozen=True, slots=True)
class _Word:
    low: str
    start: int
    end: int


@lru_cache(maxsize=1024)
def read_rule(text: str) -> StandingRule | None:
    """The rule that a text teaches, or None if it teaches none."""
    if text.strip().endswith("?") or len(text) > _LONGEST:
        return None
    words = _words(text)
    for case, rest, always in _cuts(words):
        acts = _acts(rest, text, marked=bool(rest) and rest[0].low in _COMMAS)
        told = [word.low for word in case if word.low not in _COMMAS]
        about = _about(told)
        if acts and told and (always or about):
            return StandingRule(tuple(told), about, _names(told), acts, " ".join(text.split()).rstrip(" .!"))
    return None


def read_sighting_rule(text: str) -> StandingRule | None:
    """The rule that a text teaches about what may be seen ("if you see a crack, tell me"), or None."""
    rule = read_rule(text)
    return rule if rule is not None and rule.names and rule.about != "trouble" else None


def tells_in_case(text: str) -> bool:
    """Whether a text says not that something is so, but to be told if it is: "if it burns, call me"."""
    words = _words(text)
    if re.search(r"[.!?;–—]\s*\w", text) is not None:
        return False
    for case, rest, _ in _cuts(words):
        acts = _acts(rest, text, marked=False)
        if case and acts and all(act.kind == "tell" for act in acts):
            return not any(word.low in _COMMAS for word in case)
    return False


def sighted(rule: StandingRule, reports: Iterable[str]) -> str:
    """The sentence of a report by which what the rule names is there, or an empty text."""
    for report in reports:
        for sentence in re.split(r"(?<=[.!?;])\s+", report):
            words = [word.low for word in _words(sentence)]
            said = {stem(word) for word in words}
            denied = said & {*load_data("standing")["denials"]} - rule.names
            if any(is_somebody(word) for word in words if word not in _VAGUE):
                said.add(_SOMEBODY)
            if rule.names <= said and not denied:
                return sentence.strip()
    return ""


_COMMAS = frozenset({",", ";", ":"})
_JOINS = _COMMAS | {"and", "then", "but"}


def _words(text: str) -> tuple[_Word, ...]:
    """Words and commas in small letters; what is denied by "n't" gets a "not" of its own."""
    found: list[_Word] = []
    for token in tokenize(text):
        low = token.low
        if low.endswith("n't") or low == "cannot":
            verb = {"can't": "can", "cannot": "can", "won't": "will"}.get(low, low[:-3])
            found += [_Word(verb, token.start, token.end), _Word("not", token.start, token.end)]
        elif token.is_word or low in _COMMAS:
            found.append(_Word(low, token.start, token.end))
    return tuple(found)


@cache
def _phrases(*path: str) -> tuple[tuple[str, ...], ...]:
    """The phrases of a list in the data, longest first."""
    listed: Any = load_data("standing")
    for name in path:
        listed = listed[name]
    return tuple(sorted((tuple(text.split()) for text in listed), key=len, reverse=True))


def _leading(words: Sequence[_Word], phrases: Iterable[tuple[str, ...]]) -> int:
    """With how many words one of the phrases begins; 0 if none does."""
    low = tuple(word.low for word in words)
    return next((len(phrase) for phrase in phrases if low[: len(phrase)] == phrase), 0)


def _cuts(words: tuple[_Word, ...]) -> Iterator[tuple[Sequence[_Word], Sequence[_Word], bool]]:
    """The case and what is to be done in every way a text can be cut, and whether it is meant for always."""
    while (lead := _leading(words, _phrases("leads"))) or (words[:1] and words[0].low in _COMMAS):
        words = words[lead or 1 :]
    for kind in ("always", "conditional"):
        always, markers = kind == "always", _phrases(kind)
        if size := _leading(words, markers):
            commas = [at for at in range(size + 1, len(words)) if words[at].low in _COMMAS]
            # Words may be verbs and nouns ("water"): where it is written, the comma decides.
            for end in commas or range(size + 2, len(words)):
                yield words[size:end], words[end:], always
            return
        for at in range(1, len(words)):
            if size := _leading(words[at:], markers):
                yield words[at + size :], words[:at], always
                break


def _has(told: Sequence[str], phrases: Iterable[tuple[str, ...]]) -> bool:
    text = f" {' '.join(told)} "
    return any(f" {' '.join(phrase)} " in text for phrase in phrases)


def _about(told: Sequence[str]) -> Literal["sight", "trouble", ""]:
    if _has(told, _phrases("trouble")):
        return "trouble"
    # "Cannot see the box" is no "see a box".
    return "sight" if "not" not in told and _has(told, _phrases("seeing")) else ""


def _names(told: Sequence[str]) -> frozenset[str]:
    names = frozenset(stem(word) for word in told if word not in _generic())
    return names or frozenset({_SOMEBODY} if _ANYBODY & {*told} else ())


_ANYBODY = frozenset({"anybody", "anyone", "somebody", "someone"})
_SOMEBODY = "somebody"
"""The name of a case in which any person is seen."""
_VAGUE = frozenset({"all", "others"})
"""Words for people that may be for things as well."""


@cache
def _generic() -> frozenset[str]:
    data = load_data("standing")
    said = {word for text in (*data["seeing"], *data["trouble"]) for word in text.split()}
    return frozenset(data["generic"]) | said


# -- what is to be done --


def _acts(words: Sequence[_Word], text: str, *, marked: bool) -> tuple[Act, ...]:
    """The parts of what is to be done; empty if one of them cannot be understood.

    Args:
        words: Of the text, without the case.
        text: As it was said.
        marked: Whether a comma parts them from the case; then a robot's own verbs are orders, too.
    """
    parts: list[list[_Word]] = [[]]
    for word in words:
        if word.low in _JOINS:
            parts.append([])
        elif parts[-1] or word.low not in lexicon().classes["determiners"] or len(parts) < 2:
            parts[-1].append(word)
        else:  # "go to the desk and the door" is one order
            parts[-2:] = [[*parts[-2], word]]
    acts = [_act(part, text, marked) for part in parts if part]
    return () if None in acts else tuple(act for act in acts if act is not None)


def _act(words: Sequence[_Word], text: str, marked: bool) -> Act | None:
    while lead := _leading(words, _phrases("leads")):
        words = words[lead:]
    if not words:
        return None
    said = text[words[0].start : words[-1].end]
    if waits := _leading(words, _phrases("acts", "wait")):
        amount = amount_of([word.low for word in words[waits:] if word.low != "for"])
        if amount is not None and amount.kind == "duration":
            return Act("wait", said, in_unit(amount, "s"))
    for kind in ("again", "around", "tell", "stop", "cancel", "skip"):
        if _leading(words, _phrases("acts", kind)):
            return Act(kind, said)
    return Act("order", said) if _is_order([word.low for word in words], marked) else None


def _is_order(low: Sequence[str], marked: bool) -> bool:
    known = lexicon()
    if len(low) < 2 or (low[0],) in known.verbs or low[0] in known.classes["imperatives"]:
        return len(low) > 1
    nouns = ("determiners", "pronouns", "persons", "small", "prepositions", "quantifiers")
    told = known.classes["being"] | known.classes["predicates"]
    return marked and not any(low[0] in known.classes[name] for name in nouns) and not told & {*low[1:3]}
