"""How an answer to a question is meant: yes, no, one of the choices, an order, or unclear."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from parley.language.base import ReplyReading
from parley.language.control import control_of
from parley.language.offline.repair.asides import asks
from parley.language.offline.repair.reordering import orders_otherwise
from parley.language.offline.scene.choosing import choose
from parley.language.offline.words.text import closest, keys, plain, tokens
from parley.language.word_lists import load_data

__all__ = ["agrees", "read_reply", "without_apology"]


@cache
def _lists() -> dict[str, frozenset[tuple[str, ...]]]:
    data = load_data("replies")
    return {kind: frozenset(tuple(text.split()) for text in data[kind]["phrases"]) for kind in ("yes", "no")}


@cache
def _done_verbs() -> frozenset[str]:
    return frozenset(load_data("replies")["yes"]["verbs"])


_DENIALS = frozenset({"not", "no", "never", "nothing", "unable", "refuse", "cannot", "nobody"})
_LEADS = {
    "yes": "yes",
    "yeah": "yes",
    "yep": "yes",
    "yup": "yes",
    "sure": "yes",
    "done": "yes",
    "ok": "yes",
    "okay": "yes",
    "no": "no",
    "nope": "no",
    "nah": "no",
}
_FILLERS = frozenset(
    [
        "please",
        "now",
        "thanks",
        "thank",
        "you",
        "robot",
        "just",
        "and",
        "the",
        "oh",
        "well",
        "so",
        "then",
        "already",
        "all",
    ]
)


_OPENING = frozenset({"what", "which", "where", "who", "whom", "whose", "when", "how"})


def read_reply(reply: str, choices: Sequence[str] = (), question: str = "") -> ReplyReading:
    """Read an answer; the choices are looked at first."""
    if choices:
        index = choose(choices, reply)
        if index is not None:
            return ReplyReading("choice", choices[index])
    order = control_of(reply)
    if order in {"stop", "skip", "clear", "emergency_stop"}:
        return ReplyReading("control")
    if (asks(reply) and len(reply.split()) > 1) or orders_otherwise(reply, dropping=True):
        return ReplyReading("aside")
    answer = agrees(reply)
    refused = answer is False and len(reply.split()) < 3
    if reply.strip() and not choices and order is None and not refused and _is_open(question):
        return ReplyReading("answer")
    if answer is not None:
        return ReplyReading("yes" if answer else "no")
    if order == "start":
        again = {"again", "retry", "more", "another"} & set(keys(tokens(reply)))
        return ReplyReading("control" if again else "yes")
    return ReplyReading("aside" if orders_otherwise(reply) else "unclear")


def _is_open(question: str) -> bool:
    """Whether a question asks for something other than yes, no or that something is done."""
    sentences = [keys(tokens(part)) for part in re.split(r"(?<=[.!?])\s+", question.strip())]
    return any(words and words[0] in _OPENING for words in sentences)


def without_apology(reply: str) -> str:
    """A reply without "sorry", "my mistake" and the like at its ends.

    Args:
        reply: What the operator said.
    """
    words = tokens(reply)
    while True:
        flat = keys(words)
        lead = next(
            (len(a) for a in _APOLOGIES if flat[: len(a)] == a), int(bool(words) and not words[0].is_word)
        )
        tail = next((len(a) for a in _APOLOGIES if flat[len(flat) - len(a) :] == a), 0)
        if len(words) in {lead, tail} or not (lead or tail):
            break
        words = words[lead:] if lead else words[: len(words) - tail]
    while words and words[-1].key == ",":
        words = words[:-1]
    return plain(words) if len(words) < len(tokens(reply)) else reply


_APOLOGIES = tuple(
    tuple(text.split())
    for text in (
        "i am sorry", "sorry about that", "sorry for that", "so sorry", "sorry", "my mistake", "my bad",
        "my fault", "apologies", "pardon", "oops", "whoops", "oh", "ah", "excuse me", "i beg your pardon",
    )
)  # fmt: skip


def agrees(reply: str) -> bool | None:
    """True for yes and "it is done", False for no, None if it is neither."""
    if reply.strip().endswith("?"):
        return None
    words = tuple(word.key for word in tokens(reply) if word.is_word)
    if not words or len(words) > 40:
        return None
    lists = _lists()
    for text in (words, tuple(word for word in words if word not in _FILLERS)):
        for kind in ("no", "yes"):
            if text in lists[kind]:
                return kind == "yes"
    if words[0] in _LEADS and not (words[0] in {"ok", "okay"} and set(words) & _DENIALS):
        return _LEADS[words[0]] == "yes"
    if set(words) & _DENIALS:
        return False
    if (
        set(words) & _done_verbs()
        and len(words) <= 20
        and words[0] not in {"go", "get", "stop", "put", "set"}
    ):
        return True
    if words[:3] in {("here", "you", "go"), ("there", "you", "go"), ("here", "it", "is")}:
        return True
    if len(words) == 1 and closest(words[0], ("done", "yes", "okay", "finished", "ready")):
        return True
    return None
