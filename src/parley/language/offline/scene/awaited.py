"""Somebody wants the robot with them ("they ask for you at A", "B could use a hand"): it goes there.

Who wants it, how that is said and where are found apart from one another; where nothing else is said, they
are where they are known to be. The words are data (`data/needs.yaml`).
"""

from __future__ import annotations

from functools import cache

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.report_words import phrase_of, place_named
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.inflecting import forms
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = ["awaited"]

_MOST_WORDS = 20
_LONGEST_SUBJECT = 8
_DENYING = frozenset(
    {"not", "nobody", "no", "never", "none", "was", "were", "yesterday", "if", "when", "whether"}
)
_QUESTIONS = lexicon().question_starts | {"is", "are", "do", "does", "did", "can", "could", "would", "will"}
_NOBODY_NAMED = frozenset({
    ("i",), ("we",), ("they",), ("people",), ("somebody",), ("someone",), ("everybody",), ("everyone",),
    ("it",),
    ("all",), ("you",), ("that",), ("there",),
})  # fmt: skip


def awaited(words: Phrase, scene: Scene) -> Phrase | None:
    """The order to go where the robot is wanted; None if a clause says nothing of the kind.

    Args:
        words: One clause.
        scene: Who and what is known.
    """
    said = tuple(word for word in strip_openers(words) if word.is_word)
    flat = keys(said)
    if not 3 <= len(said) <= _MOST_WORDS or flat[0] in _QUESTIONS or _DENYING & set(flat):
        return None
    found = _wants_you(said) or _you_wanted(said) or _help_wanted(said) or _visited(said)
    if found is None:
        return None
    found = found[0], _without_coming(found[1])
    if found[1][:1] and found[1][0].key in {"to", "not"}:
        return None
    order = _going(*found, scene)
    if order is not None and "eyes" in flat and keys(order[:3]) == ("go", "to", "the"):
        # "We need a pair of eyes at A".
        return phrase_of("inspect", order[2:])
    return order


def _without_coming(rest: Phrase) -> Phrase:
    """For "to come over to her" behind what is wanted of the robot: nothing more."""
    flat = keys(rest)
    if flat[:1] != ("to",) or flat[1:2] not in {
        ("come",),
        ("be",),
        ("join",),
        ("visit",),
        ("drop",),
        ("go",),
    }:
        return rest
    end = 2
    while end < len(flat) and flat[end] in _TO_THEM:
        end += 1
    return rest[end:]


_TO_THEM = frozenset({
    "over", "by", "round", "up", "down", "to", "her", "him", "them", "with", "there", "now", "please", "and",
    "right", "away", "quickly", "along",
})  # fmt: skip


@cache
def _words(kind: str) -> PhraseTable:
    return PhraseTable.of(load_data("needs")[kind])


def _is(kind: str, verb: str) -> bool:
    return verb in _forms(kind)


@cache
def _forms(kind: str) -> frozenset[str]:
    """Verbs of a kind in all their forms."""
    return frozenset(load_data("needs")[kind]) | forms(load_data("needs")[kind])


def _wants_you(words: Phrase) -> tuple[Phrase, Phrase] | None:
    """For "A has been waiting for you (at B)", "A expects you": who, and what is said behind."""
    flat = keys(words)
    for at in range(2, len(flat)):
        if flat[at] != "you":
            continue
        meets = flat[at - 2 : at] == ("to", "see") and bool(_WISHING & set(flat[1 : at - 2]))
        calling = flat[at - 1] in {"for", "on", "after"} and _is("calling_for", flat[at - 2])
        verb = at - 2 if calling or meets else at - 1
        if not (calling or meets) and not _is("wanting_you", flat[verb]):
            continue
        begin = verb
        while begin and flat[begin - 1] in (_HELPING | _WISHING if meets else _HELPING):
            begin -= 1
        if 0 < begin <= _LONGEST_SUBJECT:
            return words[:begin], words[at + 1 :]
    return None


_WISHING = frozenset({"want", "wants", "like", "love", "need", "needs", "asks", "asked", "wishes"})
_HELPING = frozenset({
    "is", "are", "am", "be", "been", "being", "has", "have", "had", "keeps", "keep", "will", "would",
    "still", "already", "now", "just", "really", "urgently", "desperately", "badly", "all", "both",
    "impatiently", "may", "might", "seems", "seem", "to", "out", "also", "currently", "there", "who",
    "that", "does", "do", "like", "love", "want", "wants", "wish", "wishes",
})  # fmt: skip


def _you_wanted(words: Phrase) -> tuple[Phrase, Phrase] | None:
    """For "you are urgently needed (at A)", "your help is wanted (at A)"."""
    flat = keys(words)
    yours = flat[:1] == ("your",) and any(_words("help").match(flat, i) for i in (1, 2))
    noun = next((i for i in range(min(3, len(flat))) if _words("help").match(flat, i)), -1)
    if (
        flat[:1] != ("you",)
        and not yours
        and not (noun >= 0 and flat[0] in {"a", "some", "more", flat[noun]})
    ):
        return None
    for at in range(1, min(7, len(flat))):
        found = _words("wanted").match(flat, at)
        linked = bool(lexicon().be & set(flat[:at])) or flat[0] != "you"
        if found is not None and linked and set(flat[1:at]) & {"like", "as", "very"} == set():
            return (), words[at + found[0] :]
    return None


def _visited(words: Phrase) -> tuple[Phrase, Phrase] | None:
    """For "you have got visitors waiting at A", "you are keeping A waiting"."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in {"waiting", "here", "there"}), 0)
    if flat[:3] == ("you", "are", "keeping") and at > 3 and flat[at] == "waiting":
        return words[3:at], words[at + 1 :]
    if flat[:2] != ("you", "have") or not at or at > 7:
        return None
    return (), words[at + 1 :]


def _help_wanted(words: Phrase) -> tuple[Phrase, Phrase] | None:
    """For "A could use a hand (at B)", "A is calling for help"."""
    flat = keys(words)
    for at in range(1, min(_LONGEST_SUBJECT, len(flat) - 1)):
        need = _words("needing").match(flat, at)
        if need is None:
            continue
        noun = at + need[0]
        while flat[noun : noun + 1] and flat[noun] in _AROUND_HELP:
            noun += 1
        helps = _words("help").match(flat, noun)
        if helps is not None:
            return words[:at], words[noun + helps[0] :]
    return None


_AROUND_HELP = frozenset({
    "a", "an", "some", "your", "any", "another", "more", "extra", "little", "bit", "of", "pair", "urgent",
    "the", "robot's", "immediate", "further", "second", "couple",
})  # fmt: skip


def _going(subject: Phrase, rest: Phrase, scene: Scene) -> Phrase | None:
    where = place_named(rest, scene) if rest else None
    if where is not None:
        return phrase_of("go to the", bare(rest[where[0] : where[1]]))
    named = bare(subject)
    if named and keys(named) not in _NOBODY_NAMED:
        where = place_named(subject, scene)
        if where is not None:
            return phrase_of("go to the", bare(subject[where[0] : where[1]]))
        theirs = named[:-1] if named[-1].key in load_data("needs")["there"] else ()
        if theirs and scene.ground(theirs).outcome == "match":
            return phrase_of("go to the", theirs)
        return phrase_of("go to", subject) if scene.is_person(named) else None
    there = {"there", "over"} & set(keys(rest)) and bool(scene.places)
    return phrase_of("go there") if there else None
