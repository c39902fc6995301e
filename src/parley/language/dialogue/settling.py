"""What an answer to "what shall I do about this failure?" settles, by the shape of its parts."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Literal

from parley.gate.control import control_of
from parley.language.builtin.amounts import amount_of, in_unit
from parley.language.builtin.lexicon import stem
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import plain
from parley.language.dialogue.replies import is_done, words_of

__all__ = ["Settled", "parts_of", "settled"]

Way = Literal["again", "without", "stop", "clear", "done", "promise"]
"""Try once more; leave the step out; stand still; drop the plan; a person did it; a person will do it."""
_AGAIN: Final = re.compile(
    r"\b(?:again|retry|repeat|once more|one more time|keep trying|try (?:it|that|now)|detour|way around|"
    r"(?:an|one|a) ?(?:other|more|second|different) (?:try|go|attempt|shot|look|way|route|path|time)|"
    r"(?:go|drive|move|get|come|try) (?:it )?(?:round|around)|the other way)\b|^try$"
)
_LOOKING: Final = re.compile(r"(?:please )?(?:look|check|inspect)(?: (?:it|there))? again(?: please)?")
_WITHOUT: Final = re.compile(
    r"\b(?:without|skip|leave (?:it|that|this|out)|never ?mind|ignore|next step|"
    r"(?:do|(?:go|carry) on with|continue with|on with) the rest|"
    r"(?:forget|drop|omit)(?: about)? (?:it|that|this|the)|no (?:need|longer needed)|"
    r"(?:not|n't|don't|doesn't) (?:important|matter|needed|necessary|bother|need|want))\b"
)
_GIVING_UP: Final = re.compile(r"(?:no )?(?:(?:forget|drop|leave)(?: about)? (?:it|that|this)|never ?mind)")
_PROMISE: Final = re.compile(
    r"(?:(?:i|we|he|she|they|somebody|someone)(?:'ll| will|'m| am|'re| are|'s| is)"
    r"(?: (?:just|now|already|quickly))* (?!not\b|in\b|at\b|on the \b|sorry\b|here\b|sure\b)\w+.*|"
    r"let (?:me|us) \w+.*|(?:on (?:my|our|the) way|coming)(?: .*)?)"
)
_WAITING: Final = re.compile(r"\b(?:wait|give (?:it|them|him|her|me)|in|after|for)\b")
_JOINT: Final = re.compile(
    r"\s*(?:[.;,!:]+\s*(?:(?:and|then|but|so) )*|\b(?:and then|then|and|but)\b)\s*", re.IGNORECASE
)
_NOT: Final = frozenset({"not", "n't", "don't", "no", "never", "nor"})
_OWN: Final = frozenset({"myself", "ourselves", "himself", "herself", "themselves"})
_CLEARING: Final = re.compile(
    r"\b(?:moved|removed|opened|cleared|pushed|pulled|freed|fixed|closed|plugged)\b"
)
"""What somebody does for a robot that goes on then; else what they did themselves is the step."""
_FREED: Final = re.compile(
    r"(?P<what>(?!i\b|we\b|it\b|that\b|this\b).+) (?:has|have) (?:now |just |all )?been "
    r"(?:moved|removed|cleared|taken away|picked up|put away|fixed|closed|opened)(?: now| again)?"
)
"""What is told to have been done, of something that is named: worth remembering as well."""
_CLEAR: Final = re.compile(
    r"(?:\w+(?: \w+){0,4}?)(?: is| are|'s|'re)(?: all| now| just)* "
    r"(?:gone|away|clear|free|empty|open|out of the way)(?: now| again)*"
)
"""What is told to be in nobody's way any more."""
_MOST_WORDS: Final = 9
_LONGEST_S: Final = 3600.0


@dataclass(frozen=True, slots=True)
class Settled:
    """What is done about a failed step, and what is said behind that."""

    way: Way
    delay_s: float = 0.0
    rest: str = ""
    """What is said besides, which may be an order: for afterwards, or with `clear` in place of the plan."""
    fact: str = ""
    """What is so from now on, in the person's words."""


def settled(reply: str, things: Collection[str], *, in_the_way: bool = False) -> Settled | None:
    """What an answer settles; None if it is no such answer.

    Args:
        reply: What was said.
        things: The stems of words that name other things than the step is about: with one of them in it an
            answer is more than this.
        in_the_way: Whether something was in the way, or where nothing should be.
    """
    wait_s = 0.0
    if re.match(r"\W*(?:go|come|drive) and \w", reply, re.IGNORECASE):
        return None  # "go and charge" is an order
    for piece, rest in parts_of(reply):
        way, seconds = _way(piece, things), _seconds(piece)
        if in_the_way and _is_clear(piece, things):
            way = "done"
        while way == "done" and rest and in_the_way:  # "done, the box is gone, go on to the desk"
            more, behind = next(parts_of(rest))
            if not (_is_clear(more, things) or is_done(plain(tokenize(more)))):
                break
            rest = behind
        if seconds and way in (None, "stop") and _WAITING.search(piece.lower()):
            wait_s += seconds
            continue
        if way == "again":
            later = _seconds(rest)
            return Settled(way, min(wait_s + seconds + later, _LONGEST_S), "" if later else rest)
        if way is None and _FREED.fullmatch(plain(tokenize(piece))) and not {*words_of(piece)} & _NOT:
            return Settled("done", 0.0, rest, piece.strip())
        gives_up = way == "without" and rest and _GIVING_UP.fullmatch(plain(tokenize(piece)))
        return None if way is None else Settled("clear" if gives_up else way, 0.0, rest)
    return Settled("again", min(wait_s, _LONGEST_S)) if wait_s else None


def parts_of(reply: str) -> Iterator[tuple[str, str]]:
    """The parts of an answer, each with all that is said behind it."""
    text = reply.strip().rstrip(".!")
    cuts = [cut for cut in _JOINT.finditer(text) if cut.start() and cut.end() < len(text)]
    starts = [0, *(cut.end() for cut in cuts)]
    for start, end in zip(starts, [*(cut.start() for cut in cuts), len(text)], strict=True):
        behind = next((later for later in starts if later > start), len(text))
        yield text[start:end], text[behind:]


def _is_clear(piece: str, things: Collection[str]) -> bool:
    words = words_of(piece)
    about = {stem(word) for word in words} & {*things}
    return _CLEAR.fullmatch(plain(tokenize(piece))) is not None and not (about or _NOT & {*words})


def _way(piece: str, things: Collection[str]) -> Way | None:
    words, bare = words_of(piece), plain(tokenize(piece))
    command = control_of(piece)
    if command in ("stop", "emergency_stop", "clear"):
        return "clear" if command == "clear" else "stop"
    short = len(words) <= _MOST_WORDS and not {stem(word) for word in words} & {*things}
    if command == "skip" or (short and _WITHOUT.search(bare)):
        return "without"
    if (
        short
        and (_AGAIN.search(bare) or _LOOKING.fullmatch(piece.lower().strip(" .!")))
        and not _NOT & {*words}
    ):
        return "again"
    if is_done(bare):
        return "without" if _OWN & {*words} and not _CLEARING.search(bare) else "done"
    return "promise" if _PROMISE.fullmatch(bare) and not _NOT & {*words} else None


def _seconds(text: str) -> float:
    """The span of time in a text; 0 if there is none."""
    words = words_of(text)
    for start in range(len(words)):
        for end in range(min(len(words), start + 4), start + 1, -1):
            if (span := _span(words[start:end])) is not None:
                return span
    return 0.0


def _span(words: Sequence[str]) -> float | None:
    amount = amount_of(words)
    return in_unit(amount, "s") if amount is not None and amount.kind == "duration" else None
