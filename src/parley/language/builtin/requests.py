"""Orders in the form of a question: "can you open the gate" wants it open, and no yes."""

from __future__ import annotations

import itertools
from dataclasses import replace

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Parse, Verb

__all__ = ["requested"]

_MODALS = frozenset({"can", "could", "would"})
_KNOWING = frozenset(
    {"tell", "say", "see", "hear", "explain", "show", "feel", "smell", "swim", "read", "speak"}
)
"""Who asks whether the robot can do so wants to know something."""


def requested(parse: Parse, lexicon: Lexicon) -> Parse:
    """What was read, with orders where somebody asks "can you ..." for something that can be done."""
    acts = list(parse.acts)
    for verb in parse.verbs:
        start = _opening(parse, verb, lexicon)
        if start is None or not _is_deed(parse, verb, lexicon):
            continue
        end = verb.start
        while end < len(acts) and acts[end] in ("question", "order") and _runs_on(parse, end):
            end += 1
        acts[start:end] = ["order"] * (end - start)
    return replace(parse, acts=tuple(acts))


def _opening(parse: Parse, verb: Verb, lexicon: Lexicon) -> int | None:
    """Where "can you", "do you think you could" before a verb begins; None if nothing of that kind does."""
    low = [token.low for token in parse.tokens]
    start = verb.start
    while (
        start and parse.tokens[start - 1].is_word and low[start - 1] in lexicon.classes["small"] | {"think"}
    ):
        start -= 1
    opener = low[start : verb.start]
    pairs = set(itertools.pairwise(opener))
    asked = any((modal, "you") in pairs for modal in _MODALS) or ("you", "can") in pairs
    return start if asked and parse.acts[verb.start] in ("question", "order") else None


def _runs_on(parse: Parse, at: int) -> bool:
    token = parse.tokens[at]
    return token.is_word and token.low not in ("and", "then", "but", "or")


def _is_deed(parse: Parse, verb: Verb, lexicon: Lexicon) -> bool:
    words = [token.low for token in parse.tokens[verb.start : verb.end]]
    particles = [parse.tokens[at].low for at in verb.particles]
    known = verb.frame in lexicon.frames_of(words, particles)
    return known and not verb.negated and words[0] not in _KNOWING | lexicon.classes["mental"]
