"""Answers to questions in whatever words from what is remembered: facts that share most with the question.

What a question is about are its words of content, also under other names; what it asks for (whose, where,
which) chooses among facts that share as much.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

from parley.language.offline.facts.owning import owner_of
from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import whole_sentence
from parley.language.offline.words.text import Phrase, keys, lemma, singular

__all__ = ["recalled", "recalled_fully"]

_OWNERSHIP = frozenset({"whose", "own", "owns", "owner", "belong", "belongs", "owned", "driver"})
_EMPTY = frozenset(
    {
        "say",
        "said",
        "tell",
        "told",
        "know",
        "remember",
        "mention",
        "mentioned",
        "think",
        "mean",
        "sit",
        "stand",
        "lie",
        "be",
        "put",
        "keep",
        "find",
        "get",
        "thing",
        "one",
        "exactly",
        "again",
        "actually",
        "here",
        "there",
        "see",
        "sitting",
        "supposed",
        "currently",
        "right",
        "now",
        "still",
        "anybody",
        "anyone",
        "somebody",
        "someone",
        "place",
        "spot",
        "happen",
        "idea",
        "remind",
        "please",
        "moment",
        "name",
        "person",
        "called",
        "go",
        "need",
        "like",
        "you",
        "robot",
        "house",
        "building",
        "left",
        "last",
        "heard",
        "hear",
        "kept",
        "stored",
        "located",
        "information",
        "anything",
        "something",
        "everything",
        "about",
        "so",
        "far",
        "today",
        "usually",
        "normally",
        "meant",
        "kind",
        "sort",
        "type",
        "number",
        "many",
        "much",
        "reason",
        "way",
        "have",
        "do",
        "can",
        "will",
        "was",
        "were",
    }
)
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
    wanted = _content(words)
    if not wanted:
        return None
    labels = {
        word.key
        for word in words
        if word.key.isdigit() or (len(word.key) == 1 and word.raw.isupper() and word.raw != "I")
    }
    scored = [(_score(wanted, item), item) for item in scene.facts if labels <= _words_of(item)]
    best = max((score for score, _ in scored), default=0.0)
    known = {word for item in scene.facts for word in _words_of(item)}
    about = [word for word in wanted if _alike(word) & known]
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
    wanted = _content(words)
    found = recalled(words, scene) if len(wanted) > 1 else None
    if found is None or len(found[1]) != 1 or _score(wanted, found[1][0]) < len(wanted):
        return None
    return found


def _owned(words: Phrase, scene: Scene) -> Remembered | None:
    """Whose what the question names is."""
    for size in range(min(6, len(words)), 0, -1):
        for start in range(len(words) - size + 1):
            part = bare(words[start : start + size])
            if not part or (size == 1 and _is_small(part[0].key)):
                continue
            belonging = owner_of(part, scene.facts)
            if belonging is not None and keys(part)[0] not in _OWNERSHIP | {"who", "which"}:
                return belonging.source
    return None


def _content(words: Iterable[object]) -> list[str]:
    result: list[str] = []
    for word in words:
        key = getattr(word, "key", "")
        base = singular(lemma(key.removesuffix("'s")))
        small = _is_small(key)
        if getattr(word, "is_word", False) and not small and base not in _EMPTY and key not in _EMPTY:
            result.append(base)
    return list(dict.fromkeys(result))


@cache
def _names() -> frozenset[str]:
    """Words of the lists that name something."""
    lex = lexicon()
    kinds = frozenset(word for members in lex.kinds.values() for word in members)
    said = frozenset(lex.synonyms) | frozenset(lex.needs) | lex.person_words | lex.nouns
    return said | lex.meaningful | lex.states | kinds | _ALSO


_ALSO = frozenset(
    {
        "like",
        "likes",
        "allergic",
        "drive",
        "drives",
        "driving",
        "key",
        "closed",
        "close",
        "open",
        "work",
        "works",
    }
)


def _is_small(word: str) -> bool:
    """Whether a word carries no meaning of its own."""
    return word in lexicon().vocabulary and word not in _names() and singular(word) not in _names()


def _alike(word: str) -> set[str]:
    """A word and others that may stand for it."""
    lex = lexicon()
    same = {word} | {singular(part) for other in lex.synonyms.get(word, ()) for part in other.split()}
    same |= {singular(part) for other in lex.kinds.get(word, ()) for part in other.split()}
    return same


def _words_of(item: Remembered) -> set[str]:
    fact = item.fact
    phrases = (*fact.subject, *fact.place, *fact.state)
    found = {singular(lemma(word.key.removesuffix("'s"))) for word in phrases if word.is_word}
    found |= {singular(word.key.removesuffix("'s")) for word in phrases if word.is_word}
    return found | {lemma(fact.relation)}


def _score(wanted: Sequence[str], item: Remembered) -> float:
    words = _words_of(item)
    return float(sum(bool(_alike(word) & words) for word in wanted))


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
