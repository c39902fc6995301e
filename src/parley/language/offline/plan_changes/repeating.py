"""Doing something once more: the whole plan, one of its steps, or what the message before asked for."""

from __future__ import annotations

import re
from dataclasses import dataclass

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys
from parley.messages.chat import ActionCall

__all__ = ["Repetition", "counted_times", "repetition", "without_recurrence"]

_ONCE_MORE = r"(?:again|once more|one more time|another time|once again|a second time|over again|over)"
_ALL = re.compile(
    rf"(?:(?:do|repeat|redo|run)(?: all)?"
    rf"(?: (?:of )?(?:it|that|this|them|everything|the (?:whole |entire )?"
    rf"(?:plan|thing|same|same thing|queue|list|tour|mission|round)))?(?: all)?(?: {_ONCE_MORE})?"
    rf"|(?:{_ONCE_MORE}|same again|the same again|once more from the (?:top|start|beginning)))"
    r"(?: (?:afterwards|at the end|when you are done|please|then))*"
)
_STEP = re.compile(
    rf"(?:do|repeat|redo|run) (?:the |your |that )?(\w+)(?: (?:step|action|one|task|order|command|stop))"
    rf"(?: {_ONCE_MORE})?(?: please)?"
)
_NEEDS_AGAIN = frozenset({"do", "run"})


@dataclass(frozen=True, slots=True)
class Repetition:
    """What is to be done once more: these steps, or what was asked for last if there are none."""

    steps: tuple[ActionCall, ...] = ()


def repetition(words: Phrase, scene: Scene) -> Repetition | None:
    """What a clause asks to be repeated, or None if it asks for nothing of the kind."""
    flat = keys(word for word in strip_openers(words, requests=True) if word.is_word)
    text = " ".join(flat)
    queue = scene.situation.queue
    step = _STEP.fullmatch(text)
    if step is not None and flat[0] == "do" and re.search(_ONCE_MORE, text) is None:
        return None
    if step is not None:
        index = _index(step.group(1), len(queue))
        if index is None:
            return None
        return Repetition((queue[index],) if -len(queue) <= index < len(queue) else ())
    if not flat or _ALL.fullmatch(text) is None:
        return None
    if flat[0] in _NEEDS_AGAIN and re.search(_ONCE_MORE, text) is None:
        return None
    return Repetition(queue)


def _index(word: str, count: int) -> int | None:
    if word in {"last", "final"}:
        return count - 1
    if word in {"current", "previous", "this", "same"}:
        return 0
    ordinal = lexicon().ordinals.get(word)
    return None if ordinal is None else ordinal - 1


_OFTEN = re.compile(
    r"(?:,? ?\b)(?:(?:every|each) (?:(?:\d+|"
    + "|".join(lexicon().numbers)
    + r"|few|other|half|couple of|fifteen|twenty|"
    r"thirty|quarter) )?(?:second|minute|min|hour|day|night|morning|evening|week|half hour)s?|hourly|daily|"
    r"every now and then|every once in a while|from time to time|at regular intervals|regularly|periodically|"
    r"once an hour|once a day|twice a day|all the time|continuously|repeatedly|"
    r"again and again|over and over(?: again)?)$"
)


def without_recurrence(words: Phrase) -> tuple[Phrase, str]:
    """A message without "every ten minutes" at its end (or start), and those words."""
    flat = keys(words)
    for size in range(5, 0, -1):
        for at in range(len(flat) - size + 1):
            said = " ".join(flat[at : at + size])
            if not _OFTEN.fullmatch(said) or any(not word.is_word for word in words[at : at + size]):
                continue
            before, after = words[:at], words[at + size :]
            after = after[1:] if not before and after and not after[0].is_word else after
            return (*before, *after), said
    return words, ""


def counted_times(words: Phrase) -> tuple[Phrase, int]:
    """A message without "three times" or "twice", and how often that is; 1 if nothing is said."""
    flat = keys(words)
    for at, word in enumerate(flat):
        if word == "twice":
            return (*words[:at], *words[at + 1 :]), 2
        if word == "times" and at:
            said = flat[at - 1]
            return (*words[: at - 1], *words[at + 1 :]), lexicon().numbers.get(
                said, int(said) if said.isdigit() else 1
            )
    return words, 1
