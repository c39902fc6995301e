"""What a picture shows, in the words of the robot's own detector: what is there, never how it is."""

from __future__ import annotations

from collections.abc import Sequence

from parley.errors import LanguageError
from parley.language.base import InspectionReport
from parley.language.builtin.lexicon import lexicon, stem
from parley.robots.base import CameraImage, Detection

__all__ = ["inspect"]

_LEAST_PIXELS = 40
"""Smaller finds are not trusted."""
_ASKING = frozenset({"if", "whether", "that", "what", "how"})
_THERE = frozenset(
    {"there", "here", "visible", "present", "still", "in", "on", "at", "near", "by", "under", "behind"}
)
_SOMEBODY = frozenset({"somebody", "someone", "anybody", "anyone", "nobody", "person", "people"})
_PERSONS = frozenset({"person", "human", "man", "woman", "child", "people"})


def inspect(image: CameraImage, request: str) -> InspectionReport:
    """Say whether what is asked for is in a picture.

    Raises:
        LanguageError: The robot has no detector, so nothing can be said about its pictures.
    """
    if image.detections is None:
        raise LanguageError(
            "this robot has no detector, and without a language model I cannot judge pictures"
        )
    seen = [found for found in image.detections if found.pixels >= _LEAST_PIXELS]
    shown = ", ".join(dict.fromkeys(found.label for found in seen)) or "nothing that I know"
    words = request.lower().replace("'s ", " is ").replace("’s ", " is ").split()
    wanted, there = _wanted(words[1:]) if words[:1] and words[0] in _ASKING else (words, True)
    if wanted is None:
        statement = request.partition(" ")[2] if words[:1] != ["what"] else ""
        judge = f" Please look at the picture and judge whether {statement}." if statement else ""
        return InspectionReport(f"I looked. I can see: {shown}.{judge}")
    name = " ".join(word for word in wanted if word not in lexicon().classes["determiners"])
    match = _match(wanted, seen)
    if match is None:
        return InspectionReport(
            f"I looked, but I cannot see the {name}. I can see: {shown}.", not there, name
        )
    far = "" if match.distance_m is None else f", about {match.distance_m:.1f} m away"
    return InspectionReport(f"I can see the {match.label}{far}.", there, match.label)


def _wanted(words: Sequence[str]) -> tuple[Sequence[str] | None, bool]:
    """What a statement says to be there, and whether it is to be; None if it says something else of it."""
    small = lexicon().classes["prepositions"] - {"a", "the"}
    at = next((n for n, word in enumerate(words) if word in ("is", "are")), None)
    if at is None:
        return None, True
    part = words[:at]
    if words[0] == "there":
        end = next((n for n in range(at + 1, len(words)) if words[n] in small), len(words))
        part = words[at + 1 : end]
    elif words[at + 1 : at + 2] and words[at + 1] not in _THERE:
        return None, True
    return part or None, not {*part} & {"no", "nobody"}


def _match(wanted: Sequence[str], seen: Sequence[Detection]) -> Detection | None:
    """What is seen and called so: by all words of its label, or by a part of them."""
    names = {stem(word) for word in wanted} - lexicon().classes["determiners"]
    if names & _SOMEBODY:
        return next((found for found in seen if _PERSONS & {*found.label.lower().split()}), None)
    labels = [(found, {stem(word) for word in found.label.lower().split()}) for found in seen]
    whole = (found for found, label in labels if label <= names)
    return next(whole, next((found for found, label in labels if names and names <= label), None))
