"""What people tell of so that somebody sees to it: who is waiting, what lies about, who does not answer.

"There is N waiting at A", "a bag stands all alone at A" and "P does not answer the phone" alarm by words
other than those of events (`incidents`); who works somewhere, what is kept where and what always is so stay
facts.
"""

from __future__ import annotations

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.report_words import (
    phrase_of,
    phrases_for,
    place_named,
    words_for,
)
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.finite import verb_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, keys, singular

__all__ = ["complained_of", "told_by", "unanswered", "unattended"]

_LONGEST_TELLER = 9
_ALWAYS = frozenset({
    "always", "usually", "often", "normally", "never", "sometimes", "every", "generally", "regularly",
    "mostly", "supposed", "yesterday",
})  # fmt: skip
_PLANNED = frozenset({"will", "would", "should"})
_INDEFINITE = frozenset({
    "a", "an", "some", "somebody", "someone", "something", "people", "two", "three", "four", "five", "six",
    "several", "many", "lots", "another", "more", "loads", "plenty", "somebody's", "someone's",
})  # fmt: skip
_SEEN_BY = frozenset({"i", "we", "they", "somebody", "someone"})


def unattended(words: Phrase) -> bool:
    """Whether a clause tells of somebody who waits, or of a thing that lies about or stands all alone.

    Args:
        words: One clause, without punctuation.
    """
    flat = keys(words)
    begin = _subject_at(flat)
    if begin < 0 or (_ALWAYS | _PLANNED) & set(flat) or {"no", "not"} & set(flat[begin : begin + 1]):
        return False
    rest = flat[begin:]
    if _any("unattended", rest):
        return True
    if not _INDEFINITE & set(rest[:1]) and flat[:1] != ("there",):
        return False
    heads = {singular(word) for word in rest}
    who = (lexicon().person_words | words_for("callers") | _INDEFINITE - {"something"}) - {"a", "an", "some"}
    waits = next((i for i in range(1, len(rest)) if rest[i] in {"waiting", "queuing", "queueing"}), 0)
    if waits and rest[waits + 1 : waits + 2] != ("for",):
        return rest[waits + 1 : waits + 2] not in _WAITING_PLACES
    if waits:
        return bool(who & (heads | set(rest[:waits])))
    if flat[0] == "there" and heads & words_for("queues") & {singular(word) for word in rest[:4]}:
        return True
    return _any("lying about", rest) and not heads & words_for("on floors")


_WAITING_PLACES = frozenset({("room",), ("area",), ("list",), ("hall",), ("time",), ("lounge",)})


def _any(kind: str, flat: tuple[str, ...]) -> bool:
    table = phrases_for(kind)
    return any(table.match(flat, i) is not None for i in range(1, len(flat)))


def _subject_at(flat: tuple[str, ...]) -> int:
    """Where what is told of begins: behind "there is" or "I see", or at the start; -1 if it is the robot."""
    if flat[:1] == ("there",):
        return next((i + 1 for i in range(1, min(5, len(flat) - 1)) if flat[i] in lexicon().be), -1)
    if flat[:1] and flat[0] in _SEEN_BY:
        seen = words_for("perceiving") | {"got"}
        at = next((i + 1 for i in range(1, min(5, len(flat) - 1)) if flat[i] in seen), -1)
        return 0 if at < 0 and flat[0].startswith("some") else at
    return -1 if flat[:1] in {("you",), ("it",), ("he",), ("she",), ("they",), ("my",)} else 0


def unanswered(words: Phrase, scene: Scene) -> Phrase | None:
    """The order to see after somebody who does not answer; None if a clause tells of nobody.

    Args:
        words: One clause, without punctuation.
        scene: Who is known.
    """
    flat = keys(words)
    if _ALWAYS & set(flat):
        return None
    table, nobody = phrases_for("unanswered"), flat[0] in {"nobody", "no", "no-one"}
    at = next((i for i in range(1, min(_LONGEST_TELLER, len(flat))) if table.match(flat, i) is not None), 0)
    if nobody and phrases_for("answering").match(flat, 2 if flat[:2] == ("no", "one") else 1) is not None:
        where = place_named(words, scene)
        return phrase_of("inspect the", bare(words[where[0] : where[1]])) if where else None
    if not at or nobody or flat[0] in {"i", "we", "you", "it", "they"}:
        return None
    where = place_named(words, scene)
    if where is not None:
        return phrase_of("inspect the", bare(words[where[0] : where[1]]))
    known = find_fact(bare(words[:at]), scene.facts)[0]
    somebody = scene.is_person(words[:at]) or (known is not None and known.fact.is_location)
    return phrase_of("check", words[:at]) if somebody else None


def told_by(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase]:
    """Who tells something, and what they tell; nobody and all words where nobody is said to tell it.

    Args:
        words: One clause, without punctuation.
        scene: Who is known.
    """
    flat = keys(words)
    telling = words_for("reporting")
    at = next((i for i in range(1, min(_LONGEST_TELLER, len(flat) - 3)) if flat[i] in telling), 0)
    end = at + 1
    while end < len(flat) and flat[end] in _BEFORE_REPORT:
        end += 1
    rest = words[end:]
    if not at or len(rest) < 3 or not (verb_at(rest) or _is_somebody(words[:at], scene)):
        return (), words
    return words[:at], rest


def _is_somebody(words: Phrase, scene: Scene) -> bool:
    """Whether words name somebody, wherever they are said to be."""
    while words and words[-1].key in {"just", "has", "have", "now", "also"}:
        words = words[:-1]
    core = noun_phrase(words).core
    known = core[-1:] and core[-1] in lexicon().person_words | words_for("callers")
    return bool(known) or scene.is_person(words)


_BEFORE_REPORT = frozenset({"to", "say", "that", "and", "said", "says", "me", "us", "report", "tell"})


def complained_of(flat: tuple[str, ...]) -> bool:
    """Whether words tell of a state that somebody complains of who is not the operator.

    Args:
        flat: What somebody is said to have told.
    """
    table = phrases_for("complaints")
    return any(table.match(flat, i) is not None for i in range(len(flat))) and not _ALWAYS & set(flat)
