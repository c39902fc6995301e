"""What of the things people tell is worth keeping: no moods, plans, weather and complaints."""

from __future__ import annotations

from functools import cache

from parley.language.offline.facts.facts import Fact
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, singular
from parley.language.word_lists import load_data

__all__ = ["is_idle", "worth_keeping"]


@cache
def _set(kind: str) -> frozenset[str]:
    return frozenset(load_data("telling")[kind])


_REASONS = frozenset({"because", "since", "although", "though", "whereas", "while", "so"})
_WITHOUT_SUBJECT = frozenset(load_data("units")["present"]) | {
    "complained", "told", "said", "swore", "claimed", "thought", "asked", "called", "insisted",
}  # fmt: skip
"""Statements that begin with such a verb lost their subject."""
_SHIFTS = frozenset({"night", "day", "morning", "evening", "weekend"})
"""Before another word these only say which one is meant ("the night porter")."""
_PLANNING = frozenset({"will", "would", "shall", "might", "could"})
_OPINIONS = frozenset(
    {
        "awful",
        "terrible",
        "nice",
        "lovely",
        "great",
        "horrible",
        "boring",
        "annoying",
        "beautiful",
        "delicious",
        "disgusting",
        "ridiculous",
        "stupid",
        "funny",
        "weird",
        "fantastic",
        "wonderful",
        "dreadful",
        "amazing",
        "silly",
        "crazy",
    }
)
_YOU_LOT = frozenset(
    {("you", "lot"), ("you", "robots"), ("you", "machines"), ("you", "guys"), ("you", "two")}
)
_PASSING = frozenset(
    {
        "so",
        "very",
        "really",
        "too",
        "quite",
        "terribly",
        "awfully",
        "today",
        "yesterday",
        "loud",
        "nice",
        "lovely",
        "awful",
        "terrible",
        "great",
        "horrible",
        "fun",
        "boring",
        "busy",
        "quiet",
    }
)


def worth_keeping(fact: Fact, words: Phrase) -> bool:
    """Whether a statement is a fact to keep, as against small talk.

    Args:
        fact: What was read of it.
        words: The statement as it was said.
    """
    flat = keys(word for word in words if word.is_word)
    subject = keys(fact.subject)
    if not flat or not subject:
        return True
    if _is_passing(flat) or _is_opinion(fact):
        return False
    # "Neither gate should be open": what is to be so now, and no rule.
    wished = flat[0] == "neither" and bool({"should", "must", "may", "ought"} & set(flat))
    nobody = wished or flat[0] in _REASONS or _WITHOUT_SUBJECT & {flat[0], subject[0]}
    never = _set("never_subjects") & (set(subject) - (set(subject[:-1]) & _SHIFTS))
    if nobody or (never and not fact.is_location):
        return False
    if not fact.is_location and any(
        flat[i] in {"i", "we"} and flat[i + 1] in _PLANNING for i in range(len(flat) - 1)
    ):
        return False
    if fact.relation in {"was", "were"} and not fact.is_location and set(flat) & _PASSING:
        return False
    if {"you"} == set(subject[:1]) or any(flat[i : i + 2] in _YOU_LOT for i in range(min(4, len(flat)))):
        return fact.is_location
    first = flat[0] in {"i", "we"} or subject == ("operator",)
    if first:
        return _about_operator(fact, flat)
    if flat[0] in {"my", "our"} and {singular(word) for word in subject} & _set("body"):
        return False
    state = set(keys(fact.state)) | set(flat)
    if flat[0] in {"it", "this", "that", "everything", "nothing", "life", "things"} and not fact.is_location:
        return bool(state & _set("opening_times"))
    if fact.is_location and flat[0] not in {"you", "your"}:
        return True
    if (flat[0] in {"you", "your"} and not {"find", "see"} & set(flat[1:4])) or subject[0] in {"you"}:
        return False
    return not (state & _set("weather") and subject[-1] in _set("weather_subjects"))


def _is_passing(flat: tuple[str, ...]) -> bool:
    """For "she looks pale", "A worries me", "nobody is there to help them": how it is at this moment."""
    seems = flat[0] in {"he", "she", "they"} and bool(set(flat[1:2]) & _SEEMING)
    nobody = flat[0] == "nobody" or flat[:2] == ("no", "one")
    if len(flat) > 2 and {"me", "us"} & set(flat[2:]) and _TROUBLING & set(flat[1:-1]):
        return True
    return seems or (nobody and bool({"there", "it", "them", "him", "her", "around"} & set(flat)))


_TROUBLING = frozenset({
    "worries", "worry", "bothers", "bother", "scares", "annoys", "concerns", "puzzles", "upsets", "bugs",
    "troubles", "irritates",
})  # fmt: skip


def _is_opinion(fact: Fact) -> bool:
    """For "the lawn looks awful", "that was really nice": what somebody thinks of it."""
    felt = fact.relation in {"is", "are"} | _SEEMING
    return felt and not fact.is_location and bool(set(keys(fact.state)[-2:]) & _OPINIONS)


_SEEMING = frozenset({"looks", "look", "seems", "seem", "sounds", "sound", "feels", "feel", "appears"})


def is_idle(words: Phrase) -> bool:
    """Whether words only say what time or day it is."""
    flat = keys(word for word in words if word.is_word)
    if flat[:2] != ("it", "is") or len(flat) > 9:
        return False
    return bool(set(flat[2:]) & (_set("idle") | _set("weather"))) or flat[2:3] == ("past",)


def _about_operator(fact: Fact, flat: tuple[str, ...]) -> bool:
    """Of the operator: where they are, what they like and have; not how they feel and what they do."""
    said = set(flat)
    if fact.is_location:
        place = set(keys(fact.place))
        own = place & (
            _set("body") | _set("moods") | {"feet", "phone", "rush", "hurry", "mood", "meeting", "way"}
        )
        return not own and not {"been", "since"} <= said
    if flat[1:2] and flat[1] in _set("lasting"):
        return not said & _set("moods")
    if flat[1:2] and flat[1] in lexicon().be:
        state = keys(fact.state)
        if state[:1] and state[0] in {"closed", "open", "shut"}:
            return True
        if not state or state[0].endswith("ing") or set(state) & _set("moods"):
            return False
        return (
            bool(said & _set("traits")) or state[0] in {"a", "an", "the", "your"} or fact.state[0].is_capital
        )
    return bool(said & _set("lasting"))
