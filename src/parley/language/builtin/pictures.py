"""What a picture shows, in the words of the robot's own detector."""

from __future__ import annotations

import re

from parley.errors import LanguageError
from parley.language.base import InspectionReport
from parley.language.builtin.lexicon import stem
from parley.robots.base import CameraImage

__all__ = ["inspect"]

_LEAST_PIXELS = 40
"""Smaller finds are not trusted."""


_THERE_IS = re.compile(
    r"(?:whether|if)\s+(?:there(?:\s+is|\s+are|'s)|you\s+(?:can\s+)?see)\s+(?:still\s+)?(?:an?\s|any\s|some\s|the\s)?\s*"
    r"(?P<what>.+?)(?:\s+(?:in|on|at|near|by|inside|behind|under|next|there)\b.*)?$",
    re.IGNORECASE,
)
"""Whether something is there: that thing is looked for, and not where it may be."""


def _is(label: str, wanted: set[str], *, whole: bool) -> bool:
    """Whether a thing that was seen is meant; of what may be there any kind of it is."""
    words = {stem(word) for word in label.split()}
    return words <= wanted or (whole and bool(wanted) and wanted <= words)


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
    labels = list(dict.fromkeys(found.label for found in seen))
    shown = ", ".join(labels) or "nothing that I know"
    asked = _THERE_IS.match(request)
    request = asked["what"] if asked is not None else request
    wanted = {stem(word) for word in request.split()}
    match = next((found for found in seen if _is(found.label, wanted, whole=asked is not None)), None)
    if match is None:
        named = any(word not in ("if", "whether", "what", "how") for word in request.split()[:1])
        if not named:
            return InspectionReport(f"I looked. I can see: {shown}. Please judge for yourself.")
        return InspectionReport(
            f"I looked, but I cannot see the {request}. I can see: {shown}.", False, request
        )
    far = "" if match.distance_m is None else f", about {match.distance_m:.1f} m away"
    return InspectionReport(f"I can see the {match.label}{far}.", True, match.label)
