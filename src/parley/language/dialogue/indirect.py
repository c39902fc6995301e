"""Orders that are not given as such ("we need you at the desk"), and those for later ("when Ada is back")."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

from parley.language.builtin.decision import Ask, Decision, Do
from parley.language.builtin.lexicon import Lexicon, lemmas
from parley.language.builtin.tokens import Token
from parley.language.dialogue.questions import plain
from parley.language.dialogue.speaker import Again
from parley.language.lexicon import load_data, word_set

__all__ = ["PROMISE", "Shape", "due", "meant", "meant_order", "put_off", "shapes"]

_PART = re.compile(r"<(\w+)>")


@dataclass(frozen=True, slots=True)
class Shape:
    """How an order is said round about, and which it is."""

    pattern: re.Pattern[str]
    order: str
    offered: bool
    """Whether it may have been a question as well, so that it is asked about first."""


@cache
def shapes() -> tuple[Shape, ...]:
    """All of them, in the order in which they are tried."""
    read = load_data("indirect")
    found = []
    for kind in ("meant", "offered"):
        for line in str(read[kind]).splitlines():
            shape, order = line.split(" => ")
            pattern = re.compile(_PART.sub(r"(?P<\1>.+)", shape))
            found.append(Shape(pattern, order, kind == "offered"))
    return tuple(found)


def meant_order(bare: str) -> tuple[str, bool] | None:
    """The order that words mean which give none, and whether it is only offered; None for all others.

    Args:
        bare: The message, as `plain` gives it.
    """
    for shape in shapes():
        if (found := shape.pattern.fullmatch(bare)) is not None:
            return _PART.sub(lambda part: found[part[1]], shape.order), shape.offered
    return None


def meant(tokens: Sequence[Token], names: Sequence[str], lexicon: Lexicon, again: Again) -> Decision | None:
    """What comes of a message that means an order without giving it; None for all others.

    `names` are those of the robot that is spoken to; `again` decides about the order.
    """
    found = meant_order(plain(tokens, names))
    if found is None:
        return None
    order, offered = found
    first, _, rest = order.partition(" ")
    verb = next((lemma for lemma in lemmas(first) if (lemma,) in lexicon.verbs), first)  # "going to the desk"
    made = again(f"{verb} {rest}")
    if isinstance(made, Ask) and made.choices and not (offered or made.offer or made.about):
        return replace(made, about=f"{verb} {rest}")
    if not isinstance(made, Do):
        return None
    return Ask(f"Shall I {verb} {rest}?", offer=made.deeds) if offered else made


# -- for when something is told: kept in the conversation itself --


PROMISE: Final = "I will do that as soon as you tell me so"
"""How the promise begins."""
_FRONT: Final = re.compile(
    r"^(?:please )?(?:when(?:ever)?|once|as soon as|the moment|after|if) (?P<when>[^,]+?),\s*(?:then |"
    r"please )?(?P<what>.+)$",
    re.IGNORECASE,
)
_BEHIND: Final = re.compile(
    r"^(?P<what>.+?),? (?:when|once|as soon as|the moment) (?P<when>[^,]+)$", re.IGNORECASE
)
_OWN: Final = re.compile(
    r"^(?:you|that|this|it|everything|all|done|finished|ready|there is|there are|there's)\b", re.IGNORECASE
)
_SMALL: Final = word_set("""the a an is are was has have had be been to at in on of now just my our your his
her and so ok here there will does do did by already""")
_NOT: Final = word_set("not no never isn't hasn't yet won't doesn't aren't didn't")


def put_off(message: str) -> tuple[str, str] | None:
    """The condition that somebody has to tell, and the order that waits for it; None if there is none.

    What the robot can see by itself, and what it does itself, is no such condition.
    """
    text = message.strip().rstrip(".!")
    for form in (_FRONT, _BEHIND):
        found = form.match(text)
        if found is not None and not _OWN.match(found["when"]) and len(found["when"].split()) > 1:
            if form is _FRONT and text.lower().startswith("if ") and _sees(found["when"]):
                return None
            return found["when"].strip(), found["what"].strip()
    return None


def _sees(condition: str) -> bool:
    said = r"(?:there|you|it|the|a|any|no|(?:any|some|no)(?:one|body))\b"
    return re.match(said, condition, re.IGNORECASE) is not None


def due(message: str, waiting: Sequence[str]) -> str:
    """The order among those put off whose condition a message tells, the newest first; empty if none."""
    put = (waits for words in reversed(waiting) if (waits := put_off(words)) is not None)
    return next((what for condition, what in put if _tells(message, condition)), "")


def _tells(message: str, condition: str) -> bool:
    """Whether a message tells that a condition holds now."""
    return not _NOT & set(message.lower().split()) and _content(condition) <= _content(message)


def _content(text: str) -> set[str]:
    words = (word for word in re.findall(r"[\w']+", text.lower()) if word not in _SMALL | _NOT)
    return {lemmas(word)[-1] for word in words}
