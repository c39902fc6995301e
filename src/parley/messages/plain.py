"""Text that people are shown: nothing in it is invisible, or turns the direction of reading."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Annotated, Final

from pydantic import AfterValidator

__all__ = ["LineText", "ShownText", "in_words", "named_in", "one_line", "visible"]

_UNSEEN: Final = re.compile(
    "["
    "\x00-\x08\x0b-\x1f\x7f-\x9f"  # control characters but tab and line feed
    "\u00ad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180e"  # soft hyphen, joiners, fillers
    "\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f"  # zero width, separators of lines, bidirectional marks
    "\u3164\ufe00-\ufe0f\ufeff\uffa0\ufff9-\ufffb"
    "\U0001d173-\U0001d17a\U000e0000-\U000e0fff"
    "]"
)
"""Not among them: the zero-width joiner and non-joiner, which Indic scripts, Persian and emoji need."""
_SPEAKER: Final = re.compile(r"\s*\n+\s*(?=[\W_]*\w[\w .'’-]{0,40}?\s*[\W_]*\s*[:>›»|])")
"""Where a line would begin as if somebody else spoke ("Kim: yes"): it goes on in the line before."""
_EMOJI_STYLE: Final = "\ufe0f"
_WORD_STARTS: Final = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|[_\s]+")


def visible(text: str) -> str:
    """`text` with what cannot be seen written out, e.g. ``⟨U+202E⟩``, and no line that imitates a speaker.

    Unicode Technical Report 36 (section 3) says why: such characters let one text look like another.
    """
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    return _SPEAKER.sub(" / ", _UNSEEN.sub(lambda found: _written_out(found[0]), text))


def one_line(text: str) -> str:
    """`visible` for what has one line of its own: labels, names, choices; no line in it can be made up."""
    return " ".join(visible(text).split())


def in_words(name: str) -> str:
    """What an action or a parameter is called, as people read it: ``TakePicture`` is "take picture"."""
    return " ".join(part.lower() for part in _WORD_STARTS.split(one_line(name)) if part)


def named_in(text: str, names: Iterable[str]) -> tuple[str, ...]:
    """Which of some names stand in a text, whatever the capitals; "Kim's" names what is theirs, not Kim."""
    return tuple(
        name
        for name in names
        if re.search(rf"(?<![\w'’-]){re.escape(name)}(?!['’-]?\w)", text, re.IGNORECASE)
    )


def _written_out(character: str) -> str:
    return "" if character == _EMOJI_STYLE else f"⟨U+{ord(character):04X}⟩"


ShownText = Annotated[str, AfterValidator(visible)]
LineText = Annotated[str, AfterValidator(one_line)]
