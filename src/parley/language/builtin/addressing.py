"""Which robots a message is for: those that it calls by name, else the one that hears it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rapidfuzz.distance import OSA

from parley.language.base import Situation
from parley.language.builtin.decision import Ask, Decision, Do, Edit
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.tokens import Token
from parley.language.dialogue.speaker import Again
from parley.language.lexicon import word_set

__all__ = ["addressed", "for_nobody", "uncalled"]

_BETWEEN = frozenset({"and", ",", "&", ":", "!", "-"})
_BEFORE = word_set("hey hello hi ok okay please so now well yes no and right oh both ,")
_MARKS = ([","], ["!"], [":"])
_ENDS = frozenset({".", "?", "!", ";"})
_ASKING = [[word, "you"] for word in ("can", "could", "would", "will")]
_SHALL = frozenset({"should", "shall", "must", "to", "will"})
_AFTER = frozenset({".", "?", "!", ",", "please"})
_INITIALS = 2
"""Shorter ones are no names: "bays A, B, C"."""
_SLIPS = 2
_ALL = (
    "all of you", "both of you", "you all", "you both", "the two of you", "everyone", "everybody",
    "all robots",
    "both robots", "you two", "all three of you",
)  # fmt: skip


def addressed(situation: Situation, tokens: Sequence[Token]) -> tuple[str, ...] | Ask:
    """The robots that are called; a question where another one is named but not called."""
    here = (situation.robot,) if situation.robot else ()
    if len(situation.robots) < 2:
        return here
    low = [token.low for token in tokens]
    names = {name.lower(): name for name in situation.robots}
    named = [at for at, word in enumerate(low) if word in names]
    start = next((at for at, word in enumerate(low) if word not in _BEFORE), 0)
    first = _run(low, start, names)
    last = _last_run(low, names)
    together = " ".join(word for word in low if word.isalpha())
    if any(together.startswith(text + " ") or together.endswith(" " + text) for text in _ALL):
        both = "both" in low or "two" in low
        exact = not named and (not both or len(situation.robots) == 2) and "except" not in low
        return situation.robots if exact else Ask("Which of us do you mean? Please call them by their names.")
    if not named:
        return here
    if set(named) <= set(first) | set(last):
        return tuple(dict.fromkeys(names[low[at]] for at in named))
    others = [names[low[at]] for at in named if names[low[at]] != situation.robot]
    if len({low[at] for at in named}) > 1:
        return Ask("Please say it to one of us after the other, each by name first.")
    return Ask(f"Is that for {others[0]}? Please call {others[0]} by name first.") if others else here


def uncalled(situation: Situation, lexicon: Lexicon, *, told: bool = False) -> str:
    """The message without the name of who hears it at either end, where that is also a deed, or `told`."""
    name, said = situation.robot, situation.message
    if not name or ((name.lower(),) not in lexicon.verbs and not told):
        return said
    call = rf"\W*(?:(?:hey|ok|okay|please|hi|hello),? )?{re.escape(name)}\b([,:!–-]*)\s+(?=(\w+))"
    before = re.match(call, said, re.IGNORECASE)
    if before and (before[1] or (before[2].lower(),) in lexicon.verbs):
        return said[before.end() :]
    return re.sub(rf",\s*{re.escape(name)}(?=[.!?]*$)", "", said, flags=re.IGNORECASE)


def _run(low: Sequence[str], start: int, names: dict[str, str]) -> list[int]:
    """The places of names that stand together from a place on."""
    found: list[int] = []
    for at in range(start, len(low)):
        if low[at] in names:
            found.append(at)
        elif low[at] not in _BETWEEN or not found:
            break
    return found


def _last_run(low: Sequence[str], names: dict[str, str]) -> list[int]:
    """The places of names at the end, behind a comma."""
    found: list[int] = []
    for at in range(len(low) - 1, -1, -1):
        if low[at] in names:
            found.append(at)
        elif low[at] == "," and found:
            return found
        elif low[at] not in (*_BETWEEN, ".", "?", "please"):
            break
    return []


def for_nobody(
    made: Decision, situation: Situation, tokens: Sequence[Token], lexicon: Lexicon, again: Again
) -> Ask | None:
    """The question whether to do what somebody who is no robot here was told; None where nobody was.

    The message would lead to what is `made`; `again` decides about it without the call.
    """
    names = {word for name in situation.robots for word in name.lower().split()}
    acts = isinstance(made, Do) or (isinstance(made, Ask) and made.offer)
    acts = acts or (isinstance(made, Edit) and made.do is not None)
    if not acts or not names or names & {token.low for token in tokens}:
        return None
    if (found := _unknown_call(situation, tokens, lexicon)) is None:
        return None
    called, rest = found
    near = next((name for name in situation.robots if _is_near(called.lower(), name.lower())), None)
    if near is not None and near != situation.robot:
        return Ask(f"Do you mean {near}? Please call {near} by name first.")
    plain = again(rest)
    offer = plain.deeds if isinstance(plain, Do) else plain.offer if isinstance(plain, Ask) else ()
    if not offer:
        return Ask(f"No robot here is called “{called}”. Please say it again without that name.")
    question = f"Do you mean {near}?" if near else f"No robot here is called “{called}”. Shall I do it?"
    return Ask(question, offer=offer, unclear=called, called=called)


def _unknown_call(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon) -> tuple[str, str] | None:
    """A name with which a message begins or ends, known to nobody, and the message without it."""
    low, text, verbs = [token.low for token in tokens], situation.message, lexicon.verbs
    places = {
        word
        for thing in (*situation.objects, *situation.rooms)
        for name in (thing.description, thing.class_name, *thing.aliases)
        for word in name.lower().replace("_", " ").split()
    }

    def unknown(at: int, *, apart: bool) -> bool:
        known = low[at] in places or any(low[at] in words for words in lexicon.classes.values())
        is_name = len(low[at]) > _INITIALS and low[at].isalpha() and (apart or tokens[at].text[0].isupper())
        return is_name and not known and not lexicon.frames_of((low[at],))

    for begin in (0, *(at + 1 for at, word in enumerate(low) if word in _ENDS)):
        start = next((at for at in range(begin, len(low) - 1) if low[at] not in _BEFORE), len(low) - 1)
        apart = low[start + 1 : start + 2] in _MARKS
        follows = low[start + 1 + apart : start + 2 + apart]
        told = follows and follows[0] in lexicon.classes["predicates"]  # "Kim is in the yard"
        should = bool(follows) and follows[0] in _SHALL and (*low[start + 2 : start + 3],) in verbs
        orders = follows and not told and (low[start + 1 : start + 3] in _ASKING or (follows[0],) in verbs)
        if follows and (apart or orders or should) and unknown(start, apart=apart):
            rest = text[: tokens[start].start] + text[tokens[start + 1 + (apart or should)].start :]
            return tokens[start].text, rest
    end = next((at for at in range(len(low) - 1, 0, -1) if low[at] not in _AFTER), 0)
    if end > 1 and low[end - 1] == "," and unknown(end, apart=False):
        return tokens[end].text, text[: tokens[end - 1].start] + text[tokens[end].end :]
    return None


def _is_near(word: str, name: str) -> bool:
    return abs(len(name) - len(word)) < _SLIPS and OSA.distance(word, name) <= _SLIPS
