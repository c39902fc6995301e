"""Orders for when something is told: "when Ada is back, go to the desk". Kept in the conversation itself."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.language.base import Turn
from parley.language.builtin.lexicon import lemmas

__all__ = ["PROMISE", "due", "put_off"]

PROMISE: Final = "I will do that as soon as you tell me so"
"""How the promise begins that is looked for when something is told."""
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
_SMALL: Final = frozenset({
    "the", "a", "an", "is", "are", "was", "has", "have", "had", "be", "been", "to", "at", "in", "on", "of",
    "now", "just", "my", "our", "your", "his", "her", "and", "so", "ok", "here", "there", "will", "does",
    "do", "did", "by", "already",
})  # fmt: skip
_NOT: Final = frozenset(
    {"not", "no", "never", "isn't", "hasn't", "yet", "won't", "doesn't", "aren't", "didn't"}
)
_TURNS: Final = 20


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
    return re.match(r"(?:there|you|it|the|a|any|no)\b", condition, re.IGNORECASE) is not None


def due(message: str, history: Sequence[Turn]) -> str:
    """The order that was put off until what a message tells; empty if none was."""
    turns = history[-_TURNS:]
    for turn, reply in zip(reversed(turns[:-1]), reversed(turns[1:]), strict=True):
        waits = (
            put_off(turn.content) if turn.role == "operator" and reply.content.startswith(PROMISE) else None
        )
        if waits is not None and _tells(message, waits[0]):
            later = [each for each in turns[turns.index(turn) + 1 :] if each.role == "operator"]
            return "" if any(_tells(each.content, waits[0]) for each in later) else waits[1]
    return ""


def _tells(message: str, condition: str) -> bool:
    """Whether a message tells that a condition holds now."""
    return not _NOT & set(message.lower().split()) and _content(condition) <= _content(message)


def _content(text: str) -> set[str]:
    words = (word for word in re.findall(r"[\w']+", text.lower()) if word not in _SMALL | _NOT)
    return {lemmas(word)[-1] for word in words}
