"""How much a remembered fact shares with words: a question about it, or a description of something by it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, lemma, singular, tokens

__all__ = ["alike", "content_of", "is_small", "shared", "words_of"]

_EMPTY = frozenset(
    {
        "on",
        "off",
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


def content_of(words: Phrase) -> list[str]:
    """The words that carry meaning, in their base forms.

    Args:
        words: A question or a description.
    """
    result: list[str] = []
    for word in words:
        key = word.key
        base = singular(lemma(key.removesuffix("'s")))
        small = is_small(key)
        if word.is_word and not small and base not in _EMPTY and key not in _EMPTY:
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
        "duty",
        "shift",
        "charge",
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


@cache
def _done() -> frozenset[str]:
    """Past forms ("sown") of verbs that are no common kind of order: they say something of a thing."""
    lex = lexicon()
    common = {verb for kind, listed in lex.verb_classes.items() if kind != "other" for verb in listed}
    common |= lex.auxiliaries | lex.be | {"have", "do", "be", "get", "make", "let", "say", "know"}
    return frozenset(word for word, base in lex.irregular.items() if base != word and base not in common)


def is_small(word: str) -> bool:
    """Whether a word carries no meaning of its own."""
    if word in _done():
        return False
    return word in lexicon().vocabulary and word not in _names() and singular(word) not in _names()


def alike(word: str) -> set[str]:
    """A word and others that may stand for it; all in their base forms."""
    lex = lexicon()
    same = {word} | {singular(part) for other in lex.synonyms.get(word, ()) for part in other.split()}
    same |= {singular(part) for other in lex.kinds.get(word, ()) for part in other.split()}
    return same


def words_of(item: Remembered) -> set[str]:
    """All words of a fact, in their base forms."""
    fact = item.fact
    said = (word for word in tokens(fact.sentence) if word.key not in lexicon().determiners)
    phrases = (*fact.subject, *fact.place, *fact.state, *said)
    found = {singular(lemma(word.key.removesuffix("'s"))) for word in phrases if word.is_word}
    found |= {singular(word.key.removesuffix("'s")) for word in phrases if word.is_word}
    return found | {lemma(fact.relation)}


def shared(wanted: Sequence[str], item: Remembered) -> float:
    """How many of the words a fact has, under whatever names."""
    words = words_of(item)
    return float(sum(bool(alike(word) & words) for word in wanted))
