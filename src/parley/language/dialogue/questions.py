"""What a question is about, where it is about the robot itself: its place, its doings, its plan, what it saw.

Only whole shapes of questions are known here; everything else is left to whoever answers about the world.
Each line carries questions that are run as tests.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

from parley.language.builtin.tokens import Token
from parley.language.lexicon import load_data

__all__ = ["Question", "asks", "plain", "question_of", "shapes"]


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked about the robot itself."""

    topic: str
    about: str = ""
    """The words for what it is about, if the shape leaves room for some."""


@dataclass(frozen=True, slots=True)
class Shape:
    """One topic with the shapes of its questions."""

    topic: str
    patterns: tuple[re.Pattern[str], ...]


_LEADS: Final = re.compile(
    r"^(?:(?:and|so|but|ok|okay|well|then|now|please|(?:hey|hi|hello)(?: there)?|"
    r"(?:good )?(?:morning|afternoon|evening|day)|oh|ah|hm+|sorry|excuse me|by the way|just|"
    r"(?:great|fine|good|perfect|thanks|thank you)(?= (?:remember|note|keep|forget|what|where|who|how|when|"
    r"why|which|is|are|was|were|did|do|does|have|has|any|anything)\b)|"
    r"actually|alright|right|wait|no|yes|robot|can you tell me|could you tell me|tell me|do you know|"
    r"say(?= (?:what|where|when|why|who|which|how|is|are|do|did|can|could|have|(?:that|it) again)\b)|"
    r"i (?:want|would like) to know|what i want to know is) )+"
)
_TAILS: Final = re.compile(
    r"(?: (?:now|right now|please|for (?:today|now)|"
    r"then|today|yet|at the moment|exactly|already|so far|by now|again|just now|"
    r"still|actually|this time|for me|me|sir|buddy|robot|thanks|thank you|anyway|currently|by the way))+$"
)
_ASKING: Final = re.compile(
    r"^(?:what|where|when|why|who|whom|whose|which|how|is|are|was|were|am|do|does|did|have|has|had|can|could|"
    r"will|would|should|shall|may|any|anything|anybody|finished|done|ready)\b"
)


def plain(tokens: Sequence[Token], names: Sequence[str] = ()) -> str:
    """The words of a message without what only opens and closes it; for matching, never to be read again."""
    called = {part.casefold() for name in names for part in name.split()}
    text = " ".join(token.low for token in tokens if token.is_word and token.low not in called)
    text = re.sub(r" (?='[a-z])", "", text)
    text = re.sub(r"\b(what|where|who|how|when)s\b", r"\1's", text)
    while (shorter := _TAILS.sub("", _LEADS.sub("", text))) != text and shorter:
        text = shorter
    return text


def asks(text: str, bare: str) -> bool:
    """Whether a message has the form of a question."""
    return text.rstrip().endswith("?") or _ASKING.match(bare) is not None


def question_of(bare: str) -> Question | None:
    """What a question is about, if it is about the robot itself.

    Args:
        bare: The words, as `plain` gives them.
    """
    bare = re.sub(r"\b(what|where|who|how|when|that|it|all|everything)'s\b", r"\1 is", bare)
    bare = re.sub(r"(?<=\w)'re\b", " are", bare)
    for shape in shapes():
        for pattern in shape.patterns:
            if (found := pattern.fullmatch(bare)) is not None:
                parts = found.groupdict()
                words = [parts.get("side"), parts.get("about")]
                return Question(shape.topic, " ".join(word.strip() for word in words if word))
    return None


@cache
def shapes() -> tuple[Shape, ...]:
    """All of them, in the order in which they are tried."""
    read = {**load_data("questions")}
    parts: dict[str, str] = read.pop("parts")
    return tuple(
        Shape(topic, tuple(re.compile(_filled(pattern, parts)) for pattern in lines.splitlines()))
        for topic, lines in read.items()
        if topic != "tests"
    )


def _filled(pattern: str, parts: dict[str, str]) -> str:
    """A shape with its named parts written out; ``<about>`` takes any words, ``<few>`` one or two."""
    pattern = re.sub(r"<about>", r"(?P<about>.+?)", pattern)
    pattern = re.sub(r"<few>", r"(?P<about>\\w+(?: \\w+)?)", pattern)
    return re.sub(r"(?<!\?P)<(\w+)>", lambda found: f"(?:{parts[found[1]]})", pattern)
