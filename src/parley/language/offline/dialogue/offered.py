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

__all__ = ["accepted_offer", "chosen_by_answer", "plain_answer", "without_tail"]

_OFFERS = tuple(
    tuple(text.split())
    for text in (
        "would you like me to", "do you want me to", "would you want me to", "shall i", "should i", "may i",
        "want me to", "is it all right if i", "ought i to", "can i", "could i",
    )
)  # fmt: skip
_LONGEST = 5
_TAILS = tuple(
    tuple(text.split())
    for text in (
        "i think", "i guess", "i suppose", "i believe", "i would say", "of course", "please", "thanks",
        "sorry",
        "obviously", "if you like", "for me", "actually", "naturally", "my mistake", "my fault", "thank you",
    )
)  # fmt: skip
_RANKING = frozenset({
    "the", "last", "final", "former", "latter", "one", "of", "them", "those", "these", "please", "that",
})  # fmt: skip
_ALL = frozenset({"all", "both", "each", "every", "everything"})
_AROUND_ALL = frozenset({
    "of", "them", "those", "these", "the", "please", "two", "three", "four", "five", "one", "go", "to",
    "check", "yes", "do", "lot",
})  # fmt: skip
_EXCEPTING = frozenset({"not", "except", "but", "without", "besides"})
_JOINING = frozenset({"and", "then", "but", "start", "with", "begin"})
_BEFORE_EXCEPTION = _ALL | frozenset(
    {"anything", "any", "either", "one", "the", "no", "just", "please", "well"}
)
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
    meant = chosen_by_answer(words, question, objects)
    if meant:
        return listing([item.description for item in meant])
    rest = _where_only(words)
    while len(rest) > 1 and (rest[0].key in _HEDGES or not rest[0].is_word):
        rest = rest[1:]
    return plain(rest if len(rest) > 1 else words)


def _where_only(words: Phrase) -> Phrase:
    """For "it is the machine beside A" "it is beside A"."""
    flat = keys(words)
    at = next((i for i in range(3, min(6, len(flat))) if lexicon().places.match(flat, i)), 0)
    described = flat[:1] == ("it",) and flat[1:2] and flat[1] in lexicon().be
    noun = described and at and flat[2] in lexicon().determiners
    return (*words[:2], *words[at:]) if noun else words


def without_tail(words: Phrase) -> Phrase:
    """An answer without "I think", "please" and the like behind it.

    Args:
        words: The answer.
    """
    while True:
        body = words
        while body and not body[-1].is_word:
            body = body[:-1]
        size = next((len(t) for t in _TAILS if len(body) > len(t) and keys(body[-len(t) :]) == t), 0)
        if not size:
            return words
        words = body[:-size]


def chosen_by_answer(words: Phrase, question: Turn, objects: Sequence[MapObject]) -> list[MapObject]:
    """The things named in a question that an answer chooses without naming them; empty if it does not.

    Args:
        words: The answer ("the last one", "not A", "all but A", "both, A first").
        question: What the robot asked.
        objects: The map.
    """
    asked = question.content.lower()
    named = [item for item in objects if asked.rfind(item.description.lower()) >= 0]
    named.sort(key=lambda item: asked.rfind(item.description.lower()))
    return _meant(words, named) if len(named) > 1 else []


def _meant(words: Phrase, named: Sequence[MapObject]) -> list[MapObject]:
    """Which of the named things an answer means that names none but those it does not mean."""
    flat = keys(word for word in words if word.is_word)
    ends = {"first", "last"} & set(flat)
    if _ALL & set(flat) and len(ends) == 1 and not _EXCEPTING & set(flat):
        # "Both, the red one first".
        at = flat.index(next(iter(ends)))
        begin = max((i + 1 for i in range(at) if flat[i] in _ALL | _JOINING | {"please", "them"}), default=0)
        rest = " ".join(flat[begin:at])
        chosen = choose_object(named, rest)
        others = [item for item in named if chosen is not None and item.id != chosen.id]
        return [] if chosen is None else [chosen, *others] if "first" in ends else [*others, chosen]
    if _ALL & set(flat) and set(flat) <= _ALL | _AROUND_ALL:
        return list(named)
    if set(flat) <= _RANKING | set(lexicon().ordinals):
        chosen = choose_object(named, plain(words))
        return [chosen] if chosen is not None else []
    at = next((i for i, word in enumerate(flat) if word in _EXCEPTING), -1)
    chosen = choose_object(named, f"not {' '.join(flat[at + 1 :])}") if at >= 0 else None
    if chosen is not None and set(flat[:at]) <= _BEFORE_EXCEPTION:
        return [chosen]
    if at < 0 or not ({"other", "others", "rest"} | _ALL) & set(flat):
        return []
    chosen = choose_object(named, " ".join(flat[at + 1 :]))
    if chosen is not None:
        # "All except the first".
        return [item for item in named if item.id != chosen.id]
    said = f" {' '.join(flat[at:])} "
    left = [item for item in named if f" {' '.join(keys(tokens(item.description)))} " not in said]
    return left if 1 < len(left) < len(named) else []
