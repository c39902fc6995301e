"""Words of a message with their places in it; the message itself is never changed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.lexicon import word_set
from parley.umrf.kinds import is_word_for

__all__ = ["TITLES", "Token", "point_of", "spoken", "tokenize"]

_POINT = re.compile(r"\(\s*(-?\d+(?:\.\d+)?)\s*[,;]\s*(-?\d+(?:\.\d+)?)\s*\)")
_WORD = re.compile(
    rf"{_POINT.pattern}"  # (1.5, -2), as the map tells a point
    r"|\d+(?:[.,:]\d+)+[^\W_]*"  # 2.5m, 14:30
    r"|[^\W_]\w*(?:-\w+)*(?:n['’]t\b)?"  # words, ids, t-shirt, don't
    r"|['’](?:s|m|re|ll|ve|d)\b"  # what stands for is, am, are, will, have, would
    r"|[^\w\s]",
    re.IGNORECASE,
)
_NOT = re.compile(r"\w+n['’]t\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Token:
    """One word or mark."""

    text: str
    start: int
    end: int

    @property
    def low(self) -> str:
        """In small letters, with a straight apostrophe."""
        return self.text.lower().replace("’", "'")

    @property
    def is_word(self) -> bool:
        """Whether it is more than a mark."""
        return len(self.text) > 1 or self.text.isalnum() or self.text in "'’"


def tokenize(text: str) -> tuple[Token, ...]:
    """The words and marks of a text, in order."""
    found: list[Token] = []
    at = 0
    while at < len(text):
        match = _NOT.match(text, at) or _WORD.match(text, at)
        if match is None:
            at += 1
            continue
        found.append(Token(match[0], match.start(), match.end()))
        titled = match[0].lower() in TITLES and text[match.end() : match.end() + 1] == "."
        at = match.end() + titled  # no sentence ends there
    return tuple(found)


def point_of(words: Sequence[str]) -> tuple[float, float] | None:
    """The place on the map, in metres, that words tell by its numbers; None if they tell none."""
    found = [match for word in words if (match := _POINT.fullmatch(word))]
    return (float(found[0][1]), float(found[0][2])) if len(found) == 1 else None


TITLES = frozenset({"mr", "mrs", "ms", "dr", "prof"})
"""What stands before a name, with a point or without."""
_HUM = re.compile(r"u+h+m*|u+m+|h+m+|m+h*m+|e+r+m*|a+h+|o+h+|e+h+|([a-z])\1{1,}|xxx", re.IGNORECASE)


def spoken(tokens: Sequence[Token]) -> tuple[Token, ...]:
    """Those that carry something: without hums, words said twice, beginnings of the word that follows.

    Nor does the full stop at the end: it is not spoken, and the tagger has seen few.
    """
    kept: list[Token] = []
    loud = [token for token in tokens if not _HUM.fullmatch(token.text)]
    low = [token.low for token in loud]
    loud = [
        token
        for at, token in enumerate(loud)
        if not (token.low in _PASSING and low[at - 1 : at] == ["a"] and low[at + 1 : at + 2] == ["look"])
        and not (token.low == "both" and _joins_two(low[at + 1 :]))
    ]
    while loud and loud[-1].text in ".…":
        loud.pop()
    for token, behind in zip(loud, [*loud[1:], None], strict=False):
        begun = behind is not None and token.low.isalpha() and token.low not in ("a", "i")
        if begun and behind is not None and behind.low == token.low:
            continue
        letter = len(token.low) == 1 and (
            token.text.isupper() or (kept and is_word_for(kept[-1].low, "place"))
        )
        short = len(token.low) < 4 and token.low not in _SHORT and not letter  # "is bay b by the wall?"
        if not (begun and short and behind is not None and behind.low.startswith(token.low)):
            kept.append(token)
    return tuple(kept)


def _joins_two(words: Sequence[str]) -> bool:
    """Whether "both" stands before two names, each with its article: "both the desk and the lamp"."""
    joint = words.index("and") if "and" in words[:_NAME_WORDS] else 0
    return joint > 0 and words[0] in _OWNED and {*words[joint + 1 : joint + 2]} <= _OWNED


_NAME_WORDS = 7
_OWNED = word_set("the my our your his her their its")
_PASSING = word_set("quick brief little short proper good fast careful thorough")
"""What looks are called: "have a quick look"."""
_SHORT = word_set("on in to the at it so no be go up do an and for off all us we if or by my me of is as")
