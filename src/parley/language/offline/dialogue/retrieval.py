"""Answers to questions in whatever words from what is remembered: facts that share most with the question.

What a question is about are its words of content, also under other names; what it asks for (whose, where,
which) chooses among facts that share as much.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from parley.language.offline.facts.owning import owner_of
from parley.language.offline.facts.remembering import Remembered, newest
from parley.language.offline.facts.sharing import alike, content_of, is_small, shared, words_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import whole_sentence
from parley.language.offline.words.text import Phrase, keys, lemma, singular, tokens

__all__ = ["condition_of", "known_of", "recalled", "recalled_fully", "when_told"]

_OWNERSHIP = frozenset({"whose", "own", "owns", "owner", "belong", "belongs", "owned", "driver"})
_MOST_TOLD = 3


def recalled(words: Phrase, scene: Scene) -> tuple[str, list[Remembered]] | None:
    """What is remembered that answers a question, and the facts; None if nothing does.

    Args:
        words: The question.
        scene: What is known.
    """
    flat = keys(words)
    own = "you" in flat[:3] and flat[:3] not in _KNOWING and flat[0] not in {"what", "where", "who", "which"}
    if own or "your" in flat[:3] or not scene.facts:
        return None
    if _OWNERSHIP & set(flat):
        owned = _owned(words, scene)
        if owned is not None:
            return whole_sentence(owned.fact.sentence), [owned]
    wanted = content_of(words)
    if not wanted:
        return None
    labels = {
        word.key
        for word in words
        if word.key.isdigit() or (len(word.key) == 1 and word.raw.isupper() and word.raw != "I")
    }
    here = newest(scene.facts)
    current = [item for item in scene.facts if not item.fact.is_location or item.fact.negated or item in here]
    scored = [(shared(wanted, item), item) for item in current if labels <= words_of(item)]
    best = max((score for score, _ in scored), default=0.0)
    known = {word for item in scene.facts for word in words_of(item)}
    about = [word for word in wanted if alike(word) & known]
    if not about or best < 1.0 or len(about) < len(wanted) / 2:
        return None
    hits = _last_words(item for score, item in scored if score == best)
    if best < len(about) and len(about) > 1 and len(hits) > 1:
        return None
    hits = _asked_for(flat, hits)[:_MOST_TOLD]
    text = " ".join(dict.fromkeys(whole_sentence(item.fact.sentence) for item in hits))
    return (text, hits) if hits else None


_KNOWING = frozenset(
    {
        ("do", "you", "know"),
        ("do", "you", "remember"),
        ("can", "you", "remember"),
        ("do", "you", "recall"),
        ("did", "you", "hear"),
        ("have", "you", "heard"),
        ("do", "you", "happen"),
    }
)


def recalled_fully(words: Phrase, scene: Scene) -> tuple[str, list[Remembered]] | None:
    """As `recalled`, but only if one fact has every word that a question is about, and they are several."""
    wanted = content_of(words)
    found = recalled(words, scene) if len(wanted) > 1 else None
    if found is None or len(found[1]) != 1 or shared(wanted, found[1][0]) < len(wanted):
        return None
    return found


def known_of(words: Phrase, scene: Scene) -> tuple[str, list[Remembered]] | None:
    """What is remembered of the one thing that a question names, if it says nothing closer to it.

    Args:
        words: The question.
        scene: What is known.
    """
    said = tuple(key.removesuffix("'s") for key in keys(words))
    flat = f" {' '.join(said)} "
    subjects = {keys(item.fact.subject) for item in scene.facts if item.fact.subject}
    named = {subject for subject in subjects if f" {' '.join(subject)} " in flat}
    longest = max((len(name) for name in named), default=0)
    named = {name for name in named if len(name) == longest}
    # "The lift" for the service lift, if no other lift is spoken of.
    named = named or {subject for subject in subjects if subject[-1] in said and not is_small(subject[-1])}
    if len(named) != 1:
        return None
    subjects = named
    hits = _last_words(item for item in scene.facts if keys(item.fact.subject) in subjects)[:_MOST_TOLD]
    text = " ".join(dict.fromkeys(whole_sentence(item.fact.sentence) for item in hits))
    return f"I only know this: {text}", hits


def when_told(words: Phrase, scene: Scene) -> tuple[str, list[Remembered]] | None:
    """What was told with a time in it, for "until what time can people visit?"; None if none fits best.

    Args:
        words: The question.
        scene: What is known.
    """
    flat = keys(words)
    if "when" not in flat[:2] and not ("time" in flat[:4] and {"what", "which"} & set(flat[:3])):
        return None
    wanted = {_stem(key) for key in flat if key not in _ASKING_WHEN and key not in lexicon().determiners}
    timed = [item for item in scene.facts if _TIMES & set(_said(item)) or any(map(_is_hour, _said(item)))]
    scored = [(len(wanted & {_stem(key) for key in _said(item)}), item) for item in timed]
    best = max((score for score, _ in scored), default=0)
    hits = [item for score, item in scored if score == best] if best else []
    return (whole_sentence(hits[0].fact.sentence), hits) if len(hits) == 1 else None


def _said(item: Remembered) -> tuple[str, ...]:
    return keys(tokens(item.fact.sentence))


def _is_hour(word: str) -> bool:
    return bool(re.fullmatch(r"[0-2]?[0-9]([:.][0-5][0-9])?(am|pm)?", word))


def _stem(word: str) -> str:
    """What a verb and those who do it have in common ("visitors", "visiting")."""
    base = singular(lemma(word))
    ending = next((end for end in ("ing", "or", "er") if base.endswith(end) and len(base) > len(end) + 3), "")
    return base.removesuffix(ending)


_TIMES = frozenset({"noon", "midnight", "morning", "evening", "afternoon", "dusk", "dawn", "o'clock"})
_ASKING_WHEN = frozenset({
    "when", "what", "which", "time", "until", "till", "from", "by", "at", "to", "since", "is", "are", "was",
    "do", "does", "did", "can", "may", "could", "will", "would", "must", "should", "have", "has", "people",
    "it", "they", "there", "in", "on", "of", "for", "and", "or", "i", "we", "you", "one", "be", "get", "go",
    "come", "day", "today", "usually", "normally",
})  # fmt: skip


def condition_of(about: Phrase, asked: Phrase, scene: Scene) -> Remembered | None:
    """What was told last of how something is, if a question asks whether it is in order or may be used.

    Args:
        about: The words that name it.
        asked: What else the question says.
        scene: What is known.
    """
    said = {key for key in keys(asked) if key not in _AROUND_CONDITION}
    named = set(keys(bare(about)))
    if not said or not said <= _CONDITIONS or not named:
        return None
    for item in scene.facts:
        fact, flat = item.fact, keys(item.fact.state)
        subject = set(keys(fact.subject))
        if fact.is_location or not flat or not (named <= subject or subject <= named):
            continue
        if fact.relation in lexicon().be | {"works", "work", "has", "needs", "have", "need"} and (
            flat[0] not in lexicon().determiners | {"called", "named", "from", "for", "owned"}
        ):
            return item
    return None


_CONDITIONS = frozenset({
    "ok", "okay", "fine", "work", "works", "working", "functional", "functioning", "usable", "available",
    "alright", "right", "good", "order", "broken", "fixed", "repaired", "running", "safe", "free", "well",
    "operational", "accessible", "open", "closed", "shut", "use", "used", "function", "defective", "run",
    "damaged", "occupied", "busy", "taken", "ready", "back", "up", "mended", "reachable", "intact",
})  # fmt: skip
_AROUND_CONDITION = frozenset({
    "in", "all", "again", "now", "already", "yet", "still", "be", "to", "today", "at", "the", "moment",
    "really", "out", "of", "properly", "or", "not", "currently", "for", "me", "us", "guests", "people",
    "been", "is", "are", "was", "any",
})  # fmt: skip


def _owned(words: Phrase, scene: Scene) -> Remembered | None:
    """Whose what the question names is."""
    for size in range(min(6, len(words)), 0, -1):
        for start in range(len(words) - size + 1):
            part = bare(words[start : start + size])
            if not part or (size == 1 and is_small(part[0].key)):
                continue
            belonging = owner_of(part, scene.facts)
            if belonging is not None and keys(part)[0] not in _OWNERSHIP | {"who", "which"}:
                return belonging.source
    return None


def _last_words(items: Iterable[Remembered]) -> list[Remembered]:
    """The newest of what is said in the same way of the same thing."""
    newest: dict[tuple[object, ...], Remembered] = {}
    for item in items:
        kind = "where" if item.fact.is_location else item.fact.relation
        newest.setdefault((keys(item.fact.subject), kind if not item.fact.another else item.entry.name), item)
    return list(newest.values())


def _asked_for(flat: tuple[str, ...], hits: list[Remembered]) -> list[Remembered]:
    """Those that say what is asked for: where, if that is the question."""
    if "where" in flat:
        return [item for item in hits if item.fact.is_location] or hits
    return hits
