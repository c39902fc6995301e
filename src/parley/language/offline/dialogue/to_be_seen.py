"""Questions about how something on the map is just now: where nobody told it, only looking can tell."""

from __future__ import annotations

from dataclasses import replace

from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.dialogue.turning import turned
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.tasks.roles import parameter_role, text_inputs
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.language.word_lists import load_data

__all__ = ["at_once", "is_of_now", "named_in", "seen_there", "sees", "with_owner_named"]

_DATA = load_data("questions")
_NOT_SEEN = frozenset(_DATA["not_seen"])
_STATES = frozenset(_DATA["seen_verbs"])
_LONGEST_NAME = 6
_PRESENT = frozenset({"is", "are"})


def is_of_now(words: Phrase) -> bool:
    """Whether a question is about how things are at this moment, as somebody who stands there sees them.

    What has been done before, what is usual, allowed or dearer than something else is not to be seen.

    Args:
        words: The words of a question.
    """
    flat = keys(words)
    # "Do we have any A in B" is about A, "do we need to V" is not to be seen.
    owned = flat[:2] == ("do", "we") and "have" in flat[2:4] and "to" not in flat[3:5]
    if not flat or _NOT_SEEN & set(flat[2:] if owned else flat):
        return False
    if flat[0] in {"do", "does"}:
        return bool(_STATES & set(flat[2:]))
    if flat[0] in {"has", "have"}:
        return "been" not in flat
    return flat[0] in _PRESENT or flat[0] in {"how", "what", "who", "which", "any", "anybody", "anyone"}


def sees(catalogue: Catalogue) -> bool:
    """Whether a robot can look at anything, not only at one kind of thing.

    Args:
        catalogue: What it can do.
    """
    eyes = [info for role in ("look", "search", "count") for info in catalogue.all_with_role(role)]
    return any(not text_inputs(i) or any(parameter_role(n) for n in text_inputs(i)) for i in eyes)


def seen_there(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase]:
    """What a yes-or-no question asks about, as a statement, and where that is seen; empty if nowhere known.

    Args:
        words: The words of the question.
        scene: What is known.
    """
    words = tuple(word for word in words if word.is_word)
    flat = keys(words)
    somebody = flat[:1] in {("has",), ("have",)} and flat[1:2] and flat[1].startswith(("any", "some"))
    if not is_of_now(words) or not (flat[0] in _PRESENT | {"do", "does"} or somebody):
        return (), ()
    statement = turned(words, scene)
    if _is_opinion(statement, flat[0]):
        return (), ()
    place = named_in(words[1:], scene) if statement else ()
    if statement and not place and flat[-1] == "there":
        place = next((p for p in reversed((*scene.things, *scene.places)) if named_in(p, scene)), ())
    return (statement, place) if place else ((), ())


def _is_opinion(statement: Phrase, link: str) -> bool:
    """For "is A a nice place?"."""
    flat = keys(statement)
    return flat[:1] != ("there",) and any(
        flat[i] == link and flat[i + 1] in {"a", "an"} for i in range(1, len(flat) - 1)
    )


def at_once(answer: Answer, words: Phrase, scene: Scene) -> Answer:
    """An answer that offers to look; to look at once where the question is about how things are now.

    Args:
        answer: What would be said.
        words: The words of the question.
        scene: What is known.
    """
    flat = keys(words)
    if not is_of_now(words) or _is_opinion(answer.look, flat[0]):
        return answer
    return replace(answer, now=True, at=answer.at or named_in(words[1:], scene))


def named_in(words: Phrase, scene: Scene) -> Phrase:
    """The longest part of some words that names one thing of the map; empty if none does.

    Args:
        words: Any words.
        scene: What is known.
    """
    vocabulary = lexicon().vocabulary - lexicon().nouns
    for size in range(min(_LONGEST_NAME, len(words)), 0, -1):
        for start in range(len(words) - size, -1, -1):
            part = bare(words[start : start + size])
            if len(part) != size or (size == 1 and part[0].key in vocabulary):
                continue
            if ground_phrase(part, scene.objects, scene.situation.robot_pose, strict=True).outcome == "match":
                return part
    return ()


def with_owner_named(words: Phrase, scene: Scene) -> Phrase:
    """With "the doors of A" for "its doors", where A was spoken of before.

    Args:
        words: The words of a question or an order.
        scene: What is known.
    """
    flat = keys(words)
    at = next((i for i in range(len(flat) - 1) if flat[i] == "its" and flat[i + 1] not in _OWN), -1)
    owner = scene.things[-1] if scene.things else ()
    if at < 0 or not owner or ground_phrase(owner, scene.objects).outcome != "match":
        return words
    # "Its back doors" end where something is said of them.
    end = at + 2
    if end < len(words) and end + 1 < len(words) and flat[end] in lexicon().nouns:
        end += 1
    whose = (*tokens("of the"), *bare(owner))
    return (*words[:at], Word("the", "the"), *words[at + 1 : end], *whose, *words[end:])


_OWN = frozenset({"own", "place", "usual", "name", "way", "content", "contents"})
