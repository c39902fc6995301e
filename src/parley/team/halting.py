"""Words of stopping and going on that tell robots apart: "everyone stop, only Leo goes on". Pure.

Only what consists of nothing but such words is read, so that in doubt all that are called stop. The words
stand in `halting.yaml`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Final

from parley.files import words_in

__all__ = ["Halting", "halting"]


@dataclass(frozen=True, slots=True)
class Halting:
    """Who is to stand still, and who to go on; the others are left as they are."""

    stops: tuple[str, ...] = ()
    goes: tuple[str, ...] = ()


def halting(message: str, robots: Sequence[str], hearers: Sequence[str]) -> Halting | None:
    """What a message says of stopping and going on, if that is not just that all shall stop.

    Args:
        message: What was said.
        robots: Who is there; a team has at least two.
        hearers: Whom it was said to.
    """
    if len(robots) < 2 or message.rstrip().endswith("?"):
        return None
    marks, why = _marks(message, robots), _WHY.search(message)
    if marks is None and why is not None:  # a reason may stand behind who is to stand, but not who is spared
        marks = _marks(message[: why.start()], robots)
        marks = marks if marks is not None and {kind for kind, _ in marks} <= _STANDS else None
    kinds = {kind for kind, _ in marks or ()}
    told = kinds & _APART or {*_DEEDS} <= kinds or {"all", "go"} <= kinds
    if not marks or not (told or (kinds <= _STANDS and "stop" in kinds and _IT_STANDS.search(message))):
        return None
    said = _Said()
    for kind, name in marks:
        said.hear(kind, name)
    said.hear("end", "")
    return said.found(robots, hearers)


_Mark = tuple[str, str]
"""What a few words are, and the robot that they name."""
_DEEDS: Final = ("stop", "go")
_APART: Final = frozenset({"but", "only", "rest", "no_other", "handing"})
"""With one of these some robots are told from others."""
_STANDS: Final = frozenset({"who", "stop", "handing", "small", "end"})
_IT_STANDS: Final = re.compile(
    r"\b(?:stays|stops|waits|halts|holds|rests|pauses|stands)\b|"
    r"\b(?:can|should|must|may|shall) (?:stay|wait|rest)\b",
    re.IGNORECASE,
)
"""Said of somebody, and to nobody: "Ada stays put"."""
_WHY: Final = re.compile(
    r"\s*[,;.:–-]\s*(?:(?:because|since|as)\s+)?(?:it|he|she|there|that)(?:'s|\s+(?:is|has|was|will|may|might))\b"
    r"|\s*,?\s+(?:because|since)\b",
    re.IGNORECASE,
)
_ALL: Final = "*"
_REST: Final = "others"
_WHOM: Final = {"all": _ALL, "nobody": _ALL, "rest": _REST, "no_other": _REST, "hearer": "you"}


@cache
def _phrases() -> dict[tuple[str, ...], str]:
    """By words what they are."""
    data = words_in("parley.team", "halting")
    kinds = ("all", "nobody", "rest", "no_other", "hearer", "but", "only", *_DEEDS, "small", "handing")
    return {tuple(text.split()): kind for kind in kinds for text in data[kind]}


def _marks(message: str, robots: Sequence[str]) -> list[_Mark] | None:
    """A message as marks; None if there are other words in it."""
    text = re.sub(r"\bdon'?t\b", "do not", message.lower().replace("’", "'"))
    words = re.findall(r"[\w'-]+|[.;:!]", re.sub(r"\bdoesn'?t\b", "does not", text))
    names = {tuple(name.lower().split()): name for name in robots}
    known = _phrases()
    longest = max(map(len, [*known, *names]))
    found: list[_Mark] = []
    at = 0
    while at < len(words):
        size = next((n for n in range(longest, 0, -1) if (*words[at : at + n],) in {**known, **names}), 0)
        piece = (*words[at : at + size],)
        if known.get(piece) == "only" and (*words[at + size : at + size + 1],) not in {*names, ("you",)}:
            at += size  # "just go on" tells nobody from anybody
            continue
        if size:
            found.append(("who", names[piece]) if piece in names else (known[piece], ""))
        elif words[at] in ".;:!":
            found.append(("end", ""))
        elif words[at] == "but" and (words[at + 1],) in {**names} if words[at + 1 :] else False:
            found.append(("but", ""))
        elif words[at] != "but":
            return None
        at += size or 1
    return found


@dataclass(slots=True)
class _Clause:
    """Who does what."""

    deed: str
    whom: list[str]
    but: list[str] = field(default_factory=list)


@dataclass(slots=True)
class _Said:
    """A message, mark by mark."""

    clauses: list[_Clause] = field(default_factory=list)
    whom: list[str] = field(default_factory=list)
    """Who is spoken of, and nothing was said of them yet."""
    but: list[str] = field(default_factory=list)
    is_open: bool = False
    """Whether the last clause takes whoever is named next: "stop Leo"."""
    spares: bool = False
    turned: bool = False
    only: bool = False

    def hear(self, kind: str, name: str) -> None:
        """One mark."""
        if kind == "who" and self.spares:
            (self.but if self.whom or not self.clauses else self.clauses[-1].but).append(name)
        elif kind == "but":
            self.spares = True
        elif kind in _DEEDS:
            self._do(kind)
        elif kind == "who" or kind in _WHOM:
            self._name(kind, name)
        elif kind in ("end", "only", "handing"):
            self.is_open = self.spares = False
            self.only = self.only or kind == "only"

    def _name(self, kind: str, name: str) -> None:
        self.spares = False
        if kind == "rest" and self.only and self.whom:  # "only Leo, the rest stop"
            self._do("go")
        self.turned = self.turned or kind in ("nobody", "no_other")
        own = self.clauses[-1].whom if self.is_open else self.whom
        own.append(name or _WHOM[kind])

    def _do(self, deed: str) -> None:
        if self.turned:
            deed = "stop" if deed == "go" else deed
        elif not self.whom and self.spares and self.clauses:  # "everybody stop but Leo goes on"
            self.whom = [*self.clauses[-1].but]
        self.clauses.append(_Clause(deed, self.whom, self.but))
        if self.only and deed == "go":
            self.clauses.append(_Clause("stop", [_REST]))
        self.is_open = not self.whom
        self.whom, self.but, self.spares, self.turned, self.only = [], [], False, False, False

    def found(self, robots: Sequence[str], hearers: Sequence[str]) -> Halting | None:
        """Who stops and who goes on; None if of somebody nothing is said, or both."""
        every = {name for clause in self.clauses for name in (*clause.whom, *clause.but)}
        named = every - {_ALL, _REST}
        own = {*hearers} | named - {"you"} if "you" in named or not named else named

        def those(names: Iterable[str]) -> set[str]:
            found: set[str] = set()
            for name in names:
                found |= {_ALL: {*robots}, _REST: {*robots} - own, "you": {*hearers}}.get(name, {name})
            return found

        does: dict[str, set[str]] = {deed: set() for deed in _DEEDS}
        by_name: dict[str, set[str]] = {deed: set() for deed in _DEEDS}
        for clause in self.clauses:
            does[clause.deed] |= those(clause.whom or ["you"]) - {*clause.but}
            by_name[clause.deed] |= those(name for name in clause.whom if name not in (_ALL, _REST))
        does["stop"] -= by_name["go"]
        does["go"] -= by_name["stop"]
        if self.whom or not self.clauses or does["stop"] & does["go"] or by_name["stop"] & by_name["go"]:
            return None
        if not does["stop"] and not does["go"]:
            return None  # "the others" of all: who is meant has to be asked
        return Halting(*(tuple(name for name in robots if name in does[deed]) for deed in _DEEDS))
