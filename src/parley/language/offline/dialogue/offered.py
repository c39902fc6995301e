"""Answers to what the robot offered: to do something, or to choose among things that it named."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.base import Situation, Turn
from parley.language.offline.repair.replies import agrees
from parley.language.offline.scene.choosing import choose_object
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import listing
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.world.object_map import MapObject

__all__ = ["accepted_offer", "plain_answer"]

_OFFERS = tuple(
    tuple(text.split())
    for text in (
        "would you like me to", "do you want me to", "would you want me to", "shall i", "should i", "may i",
        "want me to", "is it all right if i", "ought i to", "can i", "could i",
    )
)  # fmt: skip
_LONGEST = 5
_RANKING = frozenset({
    "the", "last", "final", "former", "latter", "one", "of", "them", "those", "these", "please", "that",
})  # fmt: skip
_ALL = frozenset({"all", "both", "each", "every", "everything"})
_AROUND_ALL = frozenset({
    "of", "them", "those", "these", "the", "please", "two", "three", "four", "five", "one", "go", "to",
    "check", "yes", "do", "lot",
})  # fmt: skip
_EXCEPTING = frozenset({"not", "except", "but", "without", "besides"})
_HEDGES = frozenset({
    "maybe", "perhaps", "probably", "possibly", "hm", "hmm", "well", "oh", "try", "presumably", "no",
    "nope", "nah",
})  # fmt: skip


def accepted_offer(words: Phrase, situation: Situation) -> Phrase | None:
    """What the robot offered to do and the operator now agrees to; empty if it is refused, None if neither.

    Args:
        words: The operator's words.
        situation: What is known, with what was said before.
    """
    last = situation.history[-1] if situation.history else None
    agreed = agrees(plain(words)) if len(words) <= _LONGEST else None
    if last is None or last.role == "operator" or agreed is None:
        return None
    said = tokens(last.content)
    begins = (i for i in range(len(said)) if not i or not said[i - 1].is_word)
    found = ((i, lead) for i in begins for lead in _OFFERS if keys(said[i : i + len(lead)]) == lead)
    at, lead = next(found, (0, ()))
    order = said[at + len(lead) : -1]
    if not lead or keys(said[-1:]) != ("?",) or {"or", "?", "."} & set(keys(order)) or len(order) < 2:
        return None
    return order if agreed else ()


def plain_answer(words: Phrase, question: Turn, objects: Sequence[MapObject]) -> str:
    """An answer in words that need no question: by name what is meant among the things that it named.

    Args:
        words: The answer ("the last one", "all three", "not A, the other two", "maybe in B", "no, C").
        question: What the robot asked.
        objects: The map.
    """
    asked = question.content.lower()
    named = [item for item in objects if asked.rfind(item.description.lower()) >= 0]
    named.sort(key=lambda item: asked.rfind(item.description.lower()))
    meant = _meant(words, named) if len(named) > 1 else []
    if meant:
        return listing([item.description for item in meant])
    rest = words
    while len(rest) > 1 and (rest[0].key in _HEDGES or not rest[0].is_word):
        rest = rest[1:]
    return plain(rest if len(rest) > 1 else words)


def _meant(words: Phrase, named: Sequence[MapObject]) -> list[MapObject]:
    """Which of the named things an answer means that names none but those it does not mean."""
    flat = keys(word for word in words if word.is_word)
    if _ALL & set(flat) and set(flat) <= _ALL | _AROUND_ALL:
        return list(named)
    if set(flat) <= _RANKING | set(lexicon().ordinals):
        chosen = choose_object(named, plain(words))
        return [chosen] if chosen is not None else []
    at = next((i for i, word in enumerate(flat) if word in _EXCEPTING), -1)
    if at < 0 or not ({"other", "others", "rest"} | _ALL) & set(flat):
        return []
    said = f" {' '.join(flat[at:])} "
    left = [item for item in named if f" {' '.join(keys(tokens(item.description)))} " not in said]
    return left if 1 < len(left) < len(named) else []
