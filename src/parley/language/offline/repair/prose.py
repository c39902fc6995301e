"""Failures that come without a code: what kind of failure their prose tells of, and what it names.

Situations that others write (design section 5) have no code. Where there is one, none of this is looked at.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.offline.repair.failed_step import perceives, words_of
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, singular, split_name, tokens
from parley.language.word_lists import load_data
from parley.world.object_map import MapObject

__all__ = ["says_away", "with_code"]

_MOST_BETWEEN = 2


def with_code(situation: ErrorSituation) -> ErrorSituation:
    """The failure with the code, and for an ambiguous one the candidates, that its prose tells of.

    Args:
        situation: As it came; one that has a code is left as it is.
    """
    if situation.code is not FailureCode.INTERNAL:
        return situation
    code = _looking(situation) or _code(situation.error_message) or _tells_of_sight(situation)
    details = dict(situation.details)
    if code is FailureCode.AMBIGUOUS and not details.get("candidates"):
        details["candidates"] = [item.id for item in _candidates(situation)]
    return situation if code is None else replace(situation, code=code, details=details)


def _looking(situation: ErrorSituation) -> FailureCode | None:
    """What only an action that looks can tell: something was found, or it stands in the wrong place."""
    said = keys(tokens(situation.error_message))
    if not perceives(situation) and "attention" not in said:
        return None
    denied = bool(_DENIALS & set(said))
    for code, phrases in _phrases("looking"):
        if (code is FailureCode.ATTENTION and denied) or not any(_says(said, one) for one in phrases):
            continue
        return code
    return None


def _tells_of_sight(situation: ErrorSituation) -> FailureCode | None:
    """For "There is smoke at A", from an action that looks: that is what it found."""
    said = keys(tokens(situation.error_message))
    there = any(said[i : i + 2] in {("there", "is"), ("there", "are")} for i in range(len(said)))
    return FailureCode.ATTENTION if there and perceives(situation) and not _DENIALS & set(said) else None


def says_away(message: str) -> bool:
    """Whether a failure says that the robot stands in the wrong place to look."""
    said = keys(tokens(message))
    away = next(phrases for code, phrases in _phrases("looking") if code is FailureCode.NO_MATCH)
    return any(_says(said, one) for one in away)


_DENIALS = frozenset({"not", "no", "nothing", "none", "never", "without", "failed"})


def _code(message: str) -> FailureCode | None:
    said = tuple(part for word in tokens(message) for part in _parts(word))
    return next(
        (code for code, phrases in _phrases("phrases") if any(_says(said, one) for one in phrases)), None
    )


def _parts(word: Word) -> tuple[str, ...]:
    """A word as people say it: "OBJECT_NOT_FOUND" is three words."""
    return tuple(split_name(word.raw)) if "_" in word.raw else (word.key,)


@cache
def _phrases(kind: str) -> tuple[tuple[FailureCode, tuple[tuple[str, ...], ...]], ...]:
    listed = load_data("failures")[kind]
    return tuple((FailureCode(one["code"]), tuple(tuple(p.split()) for p in one["said"])) for one in listed)


@cache
def _separating() -> frozenset[str]:
    return frozenset(load_data("failures")["separate"])


def _says(said: tuple[str, ...], phrase: tuple[str, ...]) -> bool:
    return any(_behind(said, start, phrase) for start in range(len(said)))


def _behind(said: tuple[str, ...], start: int, phrase: tuple[str, ...]) -> bool:
    """Whether the words from `start` on are a phrase, with little in between."""
    at, between = start, 0
    for number, wanted in enumerate(phrase):
        while at < len(said) and not _fits(said[at], wanted):
            if number == 0 or between == _MOST_BETWEEN or said[at] in _separating():
                return False
            at, between = at + 1, between + 1
        if at == len(said):
            return False
        at += 1
    return True


def _fits(word: str, wanted: str) -> bool:
    return word.startswith(wanted[:-1]) if wanted.endswith("~") else word == wanted


def _candidates(situation: ErrorSituation) -> list[MapObject]:
    """What an ambiguous failure is about: what its prose names, else what the words of its step fit."""
    said = keys(tokens(situation.error_message))
    named = [item for item in situation.objects if _named(item, said, situation.error_message)]
    if len(named) > 1:
        return named
    phrase = bare(tokens(words_of(situation.failed_action)))
    for wanted in (phrase, *_kinds_in(said, situation)):
        found = ground_phrase(wanted, situation.objects, situation.robot_pose) if wanted else None
        if found is not None and found.outcome == "ambiguous":
            return list(found.candidates)
    return []


def _named(item: MapObject, said: tuple[str, ...], message: str) -> bool:
    name = keys(tokens(item.description))
    whole = any(said[i : i + len(name)] == name for i in range(len(said) - len(name) + 1))
    return whole or item.id in message.replace(",", " ").split()


def _kinds_in(said: tuple[str, ...], situation: ErrorSituation) -> list[Phrase]:
    """The words of the prose that things of the map end in ("2 gates match")."""
    heads = {keys(tokens(item.description))[-1] for item in situation.objects if item.description}
    return [(Word(one, one),) for one in map(singular, said) if one in heads]
