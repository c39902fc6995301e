"""Something is sought, and somebody thinks where it is ("where is A? It ought to be at B")."""

from __future__ import annotations

from parley.language.offline.scene.report_words import (
    after_lead,
    follows_preposition,
    phrase_of,
    phrases_for,
    place_named,
)
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["only_looks", "thought_there"]

_LONGEST = 40
_MARKS = frozenset({".", "!", "?", ",", ";", ":", "-", "\n"})
_LEADING = frozenset(
    {"and", "but", "so", "well", "oh", "hm", "hmm", "now", "damn", "help", "hey", "sorry", "or", "because"}
)
_DOUBT = frozenset({
    "should", "must", "ought", "might", "may", "could", "supposed", "meant", "maybe", "perhaps", "probably",
    "possibly", "think", "believe", "guess", "suspect", "likely", "last", "left", "had", "try", "usually",
    "normally", "sure", "hopefully", "presumably", "reckon", "would", "put", "swear", "thought",
})  # fmt: skip
_SUBJECTS = frozenset({
    "it", "they", "he", "she", "i", "we", "maybe", "perhaps", "probably", "possibly", "try", "last", "my",
    "somebody", "someone", "likely", "most", "quite", "very", "hopefully", "presumably", "could", "might",
    "must", "should", "may",
})  # fmt: skip
_LOOKING = frozenset({
    "can", "you", "could", "would", "please", "go", "and", "look", "check", "have", "a", "see", "for", "me",
    "it", "them", "there", "find", "us", "him", "her", "will", "just", "quick", "take", "over", "so",
    "then", "thanks", "ta", "if", "he", "she", "they", "is", "are", "still", "whether", "out", "any",
    "sign", "of", "quickly", "has", "to", "be", "found", "needs", "must", "should", "track", "down", "back",
})  # fmt: skip


def only_looks(words: Phrase) -> bool:
    """Whether words ask for no more than a look there ("could you see if it is still there")."""
    return bool(words) and set(keys(words)) <= _LOOKING


def thought_there(words: Phrase, scene: Scene) -> Phrase:
    """A message with an order to look in place of what is sought and where it may be.

    Args:
        words: All words and punctuation.
        scene: What is known.
    """
    if not (_DOUBT | _LEAVING) & set(keys(words)):
        return words
    words = _with_hints(words, scene)
    if len(words) > _LONGEST:
        return words
    parts = _parts(words)
    left = _left_there(parts, scene)
    if left is not None:
        return left
    at = next((i for i, part in enumerate(parts) if _sought(part)), -1)
    if at < 0:
        return words
    thing = _sought(parts[at])
    for index, part in enumerate(parts):
        where = None if index == at else _where(part, scene)
        if where is None:
            continue
        around = [other for i, other in enumerate(parts) if i not in {at, index}]
        if all(set(keys(other)) <= _LOOKING | set(keys(thing)) for other in around):
            return phrase_of("inspect the", bare(where), "for", thing)
    return words


def _with_hints(words: Phrase, scene: Scene) -> Phrase:
    """For "V. look for A, it may be in B. W" "V. look for A at the B. W"."""
    flat = keys(words)
    for at in range(3, len(flat) - 3):
        if flat[at] not in {",", ".", ";"} and not _joins(words, at):
            continue
        end = next((i for i in range(at + 2, len(flat)) if words[i].key in _MARKS), len(flat))
        end = next((i for i in range(at + 2, end) if flat[i] in {"and", "so"}), end)
        part = words[at + (words[at].key in _MARKS) : end]
        while part and part[0].key in _LEADING:
            part = part[1:]
        where = _where(part, scene) if part else None
        if where is None or not _HINTING & set(keys(part)):
            continue
        start = next((i + 1 for i in range(at - 1, -1, -1) if flat[i] in _MARKS), 0)
        order = words[start:at]
        if _searches_somewhere(order, scene):
            going_on = words[end:] if keys(words[end : end + 1]) != (",",) else words[end + 1 :]
            return (*words[:at], *phrase_of("at the", bare(where)), *_with_hints(going_on, scene))
    return words


_HINTING = _DOUBT - {"last", "had", "try", "usually", "normally", "put", "left"}


def _searches_somewhere(order: Phrase, scene: Scene) -> bool:
    """Whether words end in an order to look for something that does not say where."""
    flat = keys(order)
    verbs = ("look for", "search for", "find", "hunt for", "see if you can find", "try to find", "locate")
    leads = [tuple(verb.split()) for verb in verbs]
    at = next((i + len(v) for i in range(len(flat)) for v in leads if flat[i : i + len(v)] == v), 0)
    thing = order[at:]
    named = place_named(thing, scene) is not None and any(
        lexicon().places.match(keys(thing), i) for i in range(len(thing))
    )
    told = {"nobody", "cannot", "not", "i", "we"} & set(flat[:at]) if at else set()
    return 0 < len(thing) <= 6 and bool(at) and not named and not told and keys(thing[:1]) != ("out",)


_LEAVING = frozenset({"left", "forgot", "forgotten", "lost", "dropped", "mislaid", "misplaced"})
_OWNERS = frozenset({"his", "her", "their", "my", "our", "its", "a", "an", "some"})


def _left_there(parts: list[Phrase], scene: Scene) -> Phrase | None:
    """For "a boy says he left his coat at A, can you find it" the order to look for it there."""
    flat = keys(parts[0]) if parts else ()
    at = next((i for i in range(1, min(8, len(flat) - 3)) if flat[i] in _LEAVING), 0)
    asked = len(parts) > 1 or flat[0] not in {"i", "we"}
    only = all(set(keys(part)) <= _LOOKING for part in parts[1:])
    if not at or not asked or flat[at + 1] not in _OWNERS or not only:
        return None
    rest = parts[0][at + 2 :]
    found = place_named(rest, scene)
    if found is None or not follows_preposition(keys(rest), found[0]):
        return None
    end = next((i for i in range(1, found[0]) if lexicon().places.match(keys(rest), i)), 0)
    if not end or {"on", "open", "running", "unlocked"} & set(flat):
        return None
    return phrase_of("inspect the", bare(rest[found[0] : found[1]]), "for", rest[:end])


def _parts(words: Phrase) -> list[Phrase]:
    parts: list[Phrase] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS and not _joins(words, index):
            continue
        part = words[start:index]
        while part and part[0].key in _LEADING:
            part = part[1:]
        if part:
            parts.append(part)
        start = index + (index < len(words) and words[index].key in _MARKS)
    return parts


def _joins(words: Phrase, index: int) -> bool:
    """Whether "and", "but" or "maybe" begins another part there."""
    following = keys(words[index + 1 : index + 2])
    joined = words[index].key in {"and", "but"} and following and following[0] in _SUBJECTS
    return index > 0 and (bool(joined) or words[index].key in {"maybe", "perhaps", "probably", "possibly"})


def _sought(words: Phrase) -> Phrase:
    """What is sought in one part of a message; empty if nothing is."""
    flat = keys(words)
    thing: Phrase = ()
    if flat[0] == "where":
        thing = _asked_where(words)
    else:
        thing = after_lead(words, "sought", "let_go")
        tail = 0 if thing else phrases_for("gone").match_end(flat)
        thing = words[:-tail] if tail else thing
    while thing and thing[-1].key in _BEHIND | lexicon().be:
        thing = thing[:-1]
    while thing and thing[0].key in {"the", "a", "an", *lexicon().be}:
        thing = thing[1:]
    short = 0 < len(thing) <= 6 and all(word.is_word for word in thing)
    return thing if short and keys(thing)[0] not in _NO_NAMES else ()


_NO_NAMES = frozenset({
    "it", "they", "he", "she", "i", "we", "you", "there", "that", "this", "to", "them", "him", "not", "out",
    "somebody",
})  # fmt: skip
_BEHIND = frozenset(
    {
        "anywhere",
        "now",
        "again",
        "gone",
        "got",
        "to",
        "went",
        "put",
        "left",
        "lately",
        "around",
        "any",
        "more",
    }
)


def _asked_where(words: Phrase) -> Phrase:
    """For "where on earth is A", "where did I put A", "where has A gone"."""
    flat = keys(words)
    link = next(
        (
            i
            for i in range(1, min(6, len(flat)))
            if flat[i] in lexicon().be | {"has", "have", "did", "could", "can"}
        ),
        0,
    )
    if not link:
        return ()
    rest = words[link + 1 :]
    if keys(rest[:2]) in {
        ("i", "put"),
        ("i", "leave"),
        ("we", "put"),
        ("we", "leave"),
        ("i", "left"),
        ("i", "lost"),
    }:
        rest = rest[2:]
    return tuple(word for word in rest if word.key not in {"be", "been"})


def _where(words: Phrase, scene: Scene) -> Phrase | None:
    """The place where something may be, as one part of a message says ("it ought to be at B")."""
    flat = keys(words)
    begins = flat[0] in _SUBJECTS or (
        len(flat) > 1 and flat[1] in {"should", "must", "ought", "might", "may"}
    )
    if not begins or not _DOUBT & set(flat) or "not" in flat or len(flat) > 16:
        return None
    found = place_named(tuple(word for word in words if isinstance(word, Word)), scene)
    if found is None or not follows_preposition(flat, found[0]):
        return None
    return words[found[0] : found[1]]
