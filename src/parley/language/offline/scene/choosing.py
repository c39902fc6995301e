"""Which of several offered things an answer means."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.spatial import nearest_to
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, lemma, tokens
from parley.language.word_lists import load_data
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["choose", "choose_object", "strip_lead_ins"]

_ANY = frozenset(["any", "either", "whichever", "whatever", "anyone"])


def choose(texts: Sequence[str], reply: str) -> int | None:
    """Index of the offered text that `reply` means, or None if it means none or several."""
    items = [
        MapObject(id="?" * (index + 1), description=text, x_m=0.0, y_m=0.0)
        for index, text in enumerate(texts)
    ]
    found = choose_object(items, reply)
    return None if found is None else items.index(found)


def choose_object(
    candidates: Sequence[MapObject],
    reply: str,
    objects: Sequence[MapObject] = (),
    pose: Pose2D | None = None,
) -> MapObject | None:
    """The candidate that `reply` means, by words, place, number or exclusion.

    Args:
        candidates: What was offered, in the order in which it was named.
        reply: The answer.
        objects: The whole map, for answers like "the one near the door".
        pose: The robot's, for "the nearest".
    """
    words = tuple(word for word in tokens(reply) if word.is_word)
    if not words or not candidates:
        return None
    by_text = [item for item in candidates if item.description.lower() == reply.strip().lower()]
    if len(by_text) == 1:
        return by_text[0]
    if _is_any(keys(words)):
        return nearest_to(candidates, pose.x_m, pose.y_m)[0] if pose is not None else candidates[0]
    excluded = _excluded(words, candidates, objects, pose)
    if excluded is not None:
        return excluded
    meant = strip_lead_ins(words)
    for said in (meant, _where_in(meant)):
        place = _by_position(keys(bare(said)), candidates)
        # "The second one" is the second that was named, wherever it stands.
        ranked = place if _RANKS & set(keys(said)) else None
        found = ranked or _by_words(said, candidates, objects, pose) or place
        if found is not None:
            return found
    return None


_RANKS = frozenset(lexicon().ordinals) | {"last", "latter", "former"}


def _where_in(words: Phrase) -> Phrase:
    """The place in "Anna is on the large one"; empty for anything else."""
    flat = keys(words)
    link = next((i for i in range(1, min(5, len(flat) - 2)) if flat[i] in _BEING), 0)
    return words[link + 2 :] if link and lexicon().places.match(flat, link + 1) is not None else ()


_BEING = lexicon().be | {"sits", "lies", "stands", "lives", "waits", "sleeps"}


def _is_any(flat: tuple[str, ...]) -> bool:
    if any(lexicon().your_choice.match(flat, index) for index in range(len(flat))):
        return True
    return bool(set(flat[:2]) & _ANY) and len(flat) <= 5


def _excluded(
    words: Phrase, candidates: Sequence[MapObject], objects: Sequence[MapObject], pose: Pose2D | None
) -> MapObject | None:
    """For "not the large one", "not 1 or 2": the one that is left."""
    flat = keys(words)
    if "not" not in flat:
        return None
    left = list(candidates)
    for part in _parted(words[flat.index("not") + 1 :]):
        meant = strip_lead_ins(part)
        refused = _by_words(meant, candidates, objects, pose) or _by_position(keys(bare(meant)), candidates)
        left = [item for item in left if item != refused]
    return left[0] if len(left) == 1 < len(candidates) else None


def _parted(words: Phrase) -> list[Phrase]:
    """What is named between "or", "and" and "nor"."""
    parts: list[Phrase] = [()]
    for word in words:
        if word.key in {"or", "and", "nor"}:
            parts.append(())
        else:
            parts[-1] = (*parts[-1], word)
    return parts


@cache
def _lead_ins() -> tuple[tuple[str, ...], ...]:
    return tuple(
        sorted((tuple(text.split()) for text in load_data("replies")["lead_ins"]), key=len, reverse=True)
    )


def strip_lead_ins(words: Phrase) -> Phrase:
    """Without "I mean", "it is" and the like at the start of an answer."""
    stripped = True
    while stripped and words:
        stripped = False
        for lead in _lead_ins():
            flat = keys(words)
            head = tuple(lemma(word) if index == 0 else word for index, word in enumerate(flat[: len(lead)]))
            if (flat[: len(lead)] == lead or head == lead) and len(words) > len(lead):
                words, stripped = words[len(lead) :], True
                break
    return words


def _by_words(
    words: Phrase, candidates: Sequence[MapObject], objects: Sequence[MapObject], pose: Pose2D | None
) -> MapObject | None:
    if not words:
        return None
    found = ground_phrase(words, candidates, pose)
    if found.outcome == "match":
        return found.candidates[0]
    among_all = ground_phrase(words, _with_all(candidates, objects), pose, among=candidates)
    if among_all.outcome == "match":
        return among_all.candidates[0]
    nouns = [word for word in words if word.key not in lexicon().vocabulary or word.key in lexicon().synonyms]
    if found.outcome == "none" and len(nouns) != len(words) and nouns:
        looser = ground_phrase(tuple(nouns), candidates, pose)
        return looser.candidates[0] if looser.outcome == "match" else None
    return None


def _with_all(candidates: Sequence[MapObject], objects: Sequence[MapObject]) -> list[MapObject]:
    known = {item.id for item in candidates}
    return [*candidates, *(item for item in objects if item.id not in known)]


def _by_position(flat: tuple[str, ...], candidates: Sequence[MapObject]) -> MapObject | None:
    lex = lexicon()
    words = tuple(
        word
        for word in flat
        if word not in {"one", "option", "number", "choice", "the", "of", "them", "two", "other"}
        or len(flat) == 1
    )
    if len(words) != 1:
        return None
    word = words[0]
    if word in {"last", "latter"}:
        return candidates[-1]
    if word in {"former"}:
        return candidates[0]
    if len(word) == 1 and word.isalpha():
        number = ord(word) - ord("a") + 1
    else:
        number = lex.ordinals.get(word) or lex.numbers.get(word) or (int(word) if word.isdigit() else 0)
    return candidates[number - 1] if 0 < number <= len(candidates) else None
