"""A literal yes or no, read by code before any language engine is asked, and never turned by one. Pure."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from typing import Final

__all__ = ["assent_of", "begins_with_no"]

_YES: Final = frozenset({
    "yes", "yes please", "yes do", "yes do it", "yes do that", "yes go ahead", "yeah", "yep", "yup", "ok",
    "okay", "sure", "of course", "agreed", "fine", "alright", "all right", "do it", "do that", "do so",
    "please do", "go for it", "you may", "approved", "sounds good", "that is fine", "yes thank you",
    "yes thanks", "go ahead then", "yes sure", "ok do it", "okay do it", "yes i do", "yes that is right",
    "that is right", "correct", "exactly", "right", "affirmative", "by all means", "jah", "jaa", "jah palun",
    "jah tee", "olgu", "sobib", "tee nii", "tee ära", "muidugi", "õige", "nõus", "ole lahke", "palun tee",
})  # fmt: skip
_NO: Final = frozenset({
    "no", "nope", "nah", "no thanks", "no thank you", "no do not", "do not", "do not do it", "do not do that",
    "please do not", "rather not", "better not", "never mind", "leave it", "no leave it", "rejected",
    "no way", "not now", "not yet", "certainly not", "absolutely not", "of course not", "no not now",
    "no not yet", "no never", "never", "not at all", "negative", "no no", "no no no", "no i do not",
    "no that is wrong", "that is wrong", "wrong", "forget it", "no forget it", "no stop", "no wait",
    "ei", "ei aitäh", "ära tee", "ei ära tee", "pole vaja", "ei ole vaja", "mitte praegu", "ei mitte",
    "kindlasti mitte", "vale", "ei taha", "ära",
})  # fmt: skip

_NEGATION: Final = re.compile(
    r"\W*(?:no|nope|nah|not|never|don['’]?t|do not|ei|mitte|ära|pole)\b", re.IGNORECASE
)


def assent_of(text: str, names: Sequence[str] = ()) -> bool | None:
    """Whether a whole utterance is a yes (True) or a no (False); None for everything else.

    Args:
        text: What the person said.
        names: Names of robots, which may be called before or after.
    """
    if "?" in text:
        return None
    low = re.sub(r"\bdon['’]?t\b", "do not", unicodedata.normalize("NFC", text).casefold())
    words = [word for word in re.split(r"\W+", re.sub(r"\bthat['’]s\b", "that is", low)) if word]
    called = {part for name in names for part in name.casefold().split()}
    said = " ".join(word for word in words if word not in called)
    bare = said.removeprefix("please ").removesuffix(" please").removesuffix(" thanks")
    if said in _YES or bare in _YES:
        return True
    return False if said in _NO or bare in _NO else None


def begins_with_no(text: str) -> bool:
    """Whether somebody begins with a negation: whatever follows, no language engine may call it a yes."""
    return _NEGATION.match(unicodedata.normalize("NFC", text)) is not None
