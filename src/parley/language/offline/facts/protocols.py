"""What operators teach about failures: "when the way is blocked, wait a minute and try again".

A protocol is kept as a memory in the operator's words and read again when something failed. Whether it
applies is decided by the failure's code and, where its condition names a thing, by the failure's facts.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.chat import SystemCommand
from parley.messages.memory import MemoryEntry

__all__ = [
    "Act", "Protocol", "applying", "first_act", "may_matter", "protocol_memory", "read_protocol",
    "read_sighting_rule", "sighted",
]  # fmt: skip


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
class Protocol:
    """A rule about failures."""

    condition: Phrase
    acts: tuple[Act, ...]
    sentence: str
    """The whole rule in the operator's words."""
    standing: bool = True
    """Whether it can only be meant for later; "if you see a box, ..." may also be an order to look."""

    def has(self, kind: str) -> bool:
        """Whether one of its parts is of this kind."""
        return any(act.kind == kind for act in self.acts)

    @property
    def delay_s(self) -> float:
        """How long to wait first."""
        return sum(act.delay_s for act in self.acts)


@lru_cache(maxsize=1024)
def read_protocol(text: str, *, kept: bool = False) -> Protocol | None:
    """The rule that a message teaches, or None if it teaches none (a condition for once is none).

    Args:
        text: The message.
        kept: Whether it is remembered: then it is a rule whatever its condition speaks of.
    """
    if text.strip().endswith("?") or len(text) > 400:
        return None
    words = tuple(word for word in tokens(text) if word.key not in {'"', "."})
    starts = {marker[0] for kind in ("always", "conditional") for marker in _phrases(kind)}
    if keys(words[:1]) and words[0].key not in starts:
        words = strip_openers(words, reporting=True)
    for condition, rest, always in _cuts(words):
        acts = _acts(rest)
        if acts and condition and (always or kept or _speaks_of_failure(condition)):
            standing = always or _codes(condition) != {FailureCode.ATTENTION}
            return Protocol(condition, acts, plain(words).rstrip(" .!"), standing)
    return None


def protocol_memory(protocol: Protocol) -> SystemCommand:
    """The command that keeps a protocol; a later one for the same condition takes its place."""
    name = "_".join(re.sub(r"\W+", "_", key) for key in keys(protocol.condition))[:80]
    sentence = protocol.sentence[:1].upper() + protocol.sentence[1:]
    arguments = {
        "data": sentence,
        "info": f"What to do when {plain(protocol.condition)}",
        "name": f"protocol_{name}",
    }
    return SystemCommand(command="add_memory", arguments=arguments)


def applying(situation: ErrorSituation) -> Iterator[tuple[Protocol, MemoryEntry]]:
    """The protocols that this failure calls for, those that name a thing first, then newest first."""
    found: list[tuple[bool, Protocol, MemoryEntry]] = []
    for entry in reversed(situation.memory):
        protocol = read_protocol(entry.data, kept=True) if entry.type == "text" else None
        if protocol is not None and _applies(protocol, situation):
            found.append((not _names(protocol.condition), protocol, entry))
    for _, protocol, entry in sorted(found, key=lambda item: item[0]):
        yield protocol, entry


def may_matter(text: str, said: Set[str]) -> bool:
    """Whether a text teaches a rule that the words of what happened may call for."""
    protocol = read_protocol(text)
    if protocol is None:
        return False
    telling = {form for key in keys(protocol.condition) for form in (key, singular(key))}
    return _has(protocol.condition, _phrases("any")) or bool((telling - set(_data()["generic"])) & said)


def read_sighting_rule(text: str) -> Protocol | None:
    """The rule that a message teaches about what may be seen ("if you see a crack, tell me"), or None."""
    protocol = read_protocol(text)
    if protocol is None or "not" in keys(protocol.condition) or not _names(protocol.condition):
        return None
    speaks_of_others = _codes(protocol.condition) - {FailureCode.ATTENTION}
    return None if speaks_of_others or _has(protocol.condition, _phrases("any")) else protocol


def sighted(protocol: Protocol, reports: Iterable[str]) -> str:
    """The sentence of a report by which what the rule names is there, or an empty text."""
    names = _names(protocol.condition)
    for report in reports:
        for sentence in re.split(r"(?<=[.!?;])\s+", report):
            said = _words_in([sentence])
            if names <= said and not said & set(_data()["denials"]):
                return sentence.strip()
    return ""


# -- conditions --


@cache
def _data() -> Any:
    return load_data("protocols")


@cache
def _phrases(*path: str) -> tuple[tuple[str, ...], ...]:
    """The word sequences of a list in the data, longest first."""
    listed: Any = _data()
    for name in path:
        listed = listed[name]
    return tuple(sorted((tuple(text.split()) for text in listed), key=len, reverse=True))


def _cuts(words: Phrase) -> Iterator[tuple[Phrase, Phrase, bool]]:
    """Condition and rest of a sentence in every way it can be cut, and whether it is meant for always."""
    flat = keys(words)
    for always, kind in ((True, "always"), (False, "conditional")):
        for marker in _phrases(kind):
            size = len(marker)
            if flat[:size] == marker:
                ends = range(size + 2, len(flat))
                marked = [end for end in ends if flat[end] == ","]
                # Words may be verbs and nouns ("water"): where it is written, the comma decides.
                for end in marked or [e for e in ends if flat[e] == "then" or _act_of(words[e:])]:
                    yield words[size:end], words[end:], always
                return
            for at in range(1, len(flat) - size - 1):
                acts = _acts(words[:at]) if flat[at : at + size] == marker else ()
                if acts and all(act.kind != "order" for act in acts):
                    yield words[at + size :], words[:at], always
                    return


def _speaks_of_failure(condition: Phrase) -> bool:
    return bool(_codes(condition)) or _has(condition, _phrases("any"))


@lru_cache(maxsize=1024)
def _codes(condition: Phrase) -> frozenset[FailureCode]:
    lists = _data()["codes"]
    found = frozenset(FailureCode(code) for code in lists if _has(condition, _phrases("codes", code)))
    # "Cannot see the box" is no "see a box".
    return found - {FailureCode.ATTENTION} if "not" in keys(condition) else found


def _has(words: Phrase, phrases: tuple[tuple[str, ...], ...]) -> bool:
    text = f" {' '.join(keys(words))} "
    return any(f" {' '.join(phrase)} " in text for phrase in phrases)


@cache
def _generic() -> frozenset[str]:
    data = _data()
    said = {word for phrases in data["codes"].values() for text in phrases for word in text.split()}
    return frozenset(data["generic"]) | said | {word for text in data["any"] for word in text.split()}


def _names(condition: Phrase) -> frozenset[str]:
    """The words of a condition that name something in particular."""
    return frozenset(singular(word.key) for word in condition if word.is_word and word.key not in _generic())


def _applies(protocol: Protocol, situation: ErrorSituation) -> bool:
    codes, names = _codes(protocol.condition), _names(protocol.condition)
    if FailureCode.ATTENTION in codes:
        return bool(names) and names <= _words_in(_seen(situation))
    if not names:
        return situation.code in codes or _has(protocol.condition, _phrases("any"))
    if codes and situation.code not in codes:
        return False
    step = situation.failed_action
    values = [str(p.value) for p in step.input_parameters.values() if p.type == "string"]
    facts = [situation.error_message, step.reason, *values, *_texts(situation.details)]
    return names <= _words_in(facts)


def _seen(situation: ErrorSituation) -> list[str]:
    """What was noticed, in words; that something could not be seen is not among it."""
    details = situation.details
    seen = _texts({key: details.get(key) for key in ("seen", "in_the_way")})
    return [*seen, situation.error_message] if situation.code is FailureCode.ATTENTION else seen


def _texts(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    if isinstance(value, dict):
        return [text for item in value.values() for text in _texts(item)]
    return [text for item in value for text in _texts(item)] if isinstance(value, list | tuple) else []


def _words_in(texts: Sequence[str]) -> frozenset[str]:
    return frozenset(singular(word.key) for text in texts for word in tokens(text) if word.is_word)


# -- acts --


def _acts(words: Phrase) -> tuple[Act, ...]:
    """The parts of what is to be done; empty if one of them cannot be understood."""
    parts: list[Phrase] = [()]
    for word in words:
        if word.key in {",", "and", "then", "but", ";"}:
            parts.append(())
        elif word.is_word:
            parts[-1] = (*parts[-1], word)
    acts = [_act_of(part) for part in parts if part]
    return () if None in acts else tuple(act for act in acts if act is not None)


def first_act(words: Phrase) -> Act | None:
    """What a reply says first that is to be done about a failed step."""
    end = next((i for i, word in enumerate(words) if word.key in {",", "and", "then", "but", ";", "."}), None)
    return _act_of(words[:end])


def _act_of(words: Phrase) -> Act | None:
    words = strip_openers(words, requests=True)
    flat = keys(words)
    if not flat:
        return None
    flat = (lemma(flat[0]), *flat[1:])
    seconds = duration_s(words)
    if seconds is not None and any(flat[: len(start)] == start for start in _phrases("acts", "wait")):
        return Act("wait", plain(words), seconds)
    for kind in ("again", "around", "tell", "stop", "cancel", "skip"):
        if any(flat[: len(start)] == start for start in _phrases("acts", kind)):
            return Act(kind, plain(words))
    instead = flat[0] in {"use", "take"} and len(flat) > 1
    return Act("order", plain(words)) if instead or opens_command(words) else None
