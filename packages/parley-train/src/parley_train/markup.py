"""The markup of annotated sentences (README.md): reading it, and saying what is wrong with it."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from parley import files
from parley.errors import FileFormatError
from parley.language.builtin.labels import ACTS, FRAMES, ROLES, Act, Mode, Move, Role
from parley.language.builtin.tokens import tokenize

__all__ = ["Annotated", "RoleSpan", "Trigger", "read_line", "read_text"]

_MOVES: Mapping[str, tuple[Act, Move]] = {
    "yes": ("answer", "yes"),
    "no": ("answer", "no"),
    "stop": ("control", "stop"),
    "pause": ("control", "pause"),
    "resume": ("control", "resume"),
    "cancel": ("control", "cancel"),
    "again": ("order", "again"),
}
"""What may stand in place of an act, with the act that it is."""

_SIGNS: Mapping[str, Mode] = {
    "": "plain", "!": "negated", "~": "otherwise", ">": "later", "<": "earlier", "^": "allowed"
}  # fmt: skip

_PIECE = re.compile(
    r"\{(?P<words>[^{}:]+):(?P<mode>[!~<>^]?)(?P<frame>[A-Z]+|\+)\}"
    r"|\((?P<role>[A-Z])(?:@(?P<owner>\d+))? (?P<span>[^()]+)\)|<(?P<act>[a-z]+)>|(?P<plain>[^{}()<>]+)"
    r"|(?P<wrong>.)"
)


@dataclass(frozen=True, slots=True)
class Trigger:
    """The words that call a frame up."""

    frame: str
    start: int
    """Number of its first word."""
    end: int
    """Number of the word behind its last."""
    mode: Mode = "plain"
    particles: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class RoleSpan:
    """The words that fill a role of a frame."""

    role: Role
    start: int
    end: int
    head: int
    """Number of the word that names the thing itself."""
    owner: int | None
    """Which of the sentence's triggers it belongs to; None: to none."""


@dataclass(frozen=True, slots=True)
class Annotated:
    """A sentence with what its words are."""

    words: tuple[str, ...]
    acts: tuple[Act, ...]
    """Of each word."""
    moves: tuple[Move, ...]
    """Of each word."""
    triggers: tuple[Trigger, ...] = ()
    roles: tuple[RoleSpan, ...] = ()


def read_text(text: str, file: str) -> Iterator[Annotated]:
    """The sentences of a file; empty lines and lines that begin with # say nothing.

    Raises:
        FileFormatError: Names the line and what is wrong with it.
    """
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            try:
                yield read_line(line)
            except ValueError as error:
                raise FileFormatError(file, f"line {number}", str(error)) from error


def read_line(line: str) -> Annotated:
    """One sentence: its act, a tab, the sentence in markup.

    Raises:
        ValueError: Says what is wrong.
    """
    act, tab, text = line.partition("\t")
    if not tab:
        raise ValueError("expected an act, a tab and a sentence")
    reader = _Reader(*_act(act))
    for piece in _PIECE.finditer(text):
        reader.take(piece)
    if not reader.words:
        raise ValueError("there is no sentence")
    return reader.result()


def _act(text: str) -> tuple[Act, Move]:
    if text in _MOVES:
        return _MOVES[text]
    found = next((act for act in ACTS if act == text), None)
    if found is None:
        raise ValueError(f"{text!r} is no act; there are {', '.join([*ACTS, *_MOVES])}")
    return found, "none"


class _Reader:
    def __init__(self, act: Act, move: Move) -> None:
        self._act: Act = act
        self._move: Move = move
        self.words: list[str] = []
        self._acts: list[Act] = []
        self._moves: list[Move] = []
        self._triggers: list[Trigger] = []
        self._roles: list[tuple[RoleSpan, int | None]] = []

    def take(self, piece: re.Match[str]) -> None:
        if piece["wrong"]:
            raise ValueError(f"{piece['wrong']!r} at {piece.start() + 1} opens or closes nothing")
        if piece["plain"]:
            if "*" in piece["plain"]:
                raise ValueError("a * marks the head of a role, so it stands inside one")
            self._say(piece["plain"])
        elif piece["act"]:
            self._act, self._move = _act(piece["act"])
        elif piece["frame"]:
            self._trigger(piece["words"], piece["frame"], piece["mode"])
        else:
            self._role(piece["role"], piece["span"], piece["owner"])

    def _say(self, text: str) -> tuple[int, int]:
        start = len(self.words)
        self.words += [token.text for token in tokenize(text)]
        self._acts += [self._act] * (len(self.words) - start)
        self._moves += [self._move] * (len(self.words) - start)
        return start, len(self.words)

    def _trigger(self, text: str, frame: str, mode: str) -> None:
        start, end = self._say(text)
        if frame == "+":
            if not self._triggers:
                raise ValueError(f"the particle {text!r} has no verb before it")
            last = self._triggers[-1]
            self._triggers[-1] = replace(last, particles=(*last.particles, *range(start, end)))
            return
        if frame not in FRAMES:
            raise ValueError(f"{frame!r} is no frame; there are {', '.join(FRAMES)}")
        self._triggers.append(Trigger(frame, start, end, _SIGNS[mode]))

    def _role(self, name: str, text: str, owner: str | None) -> None:
        role = next((role for role in ROLES if role == name), None)
        if role is None:
            raise ValueError(f"{name!r} is no role; there are {', '.join(ROLES)}")
        before, star, behind = text.partition("*")
        if "*" in behind:
            raise ValueError(f"{text!r} has more than one head")
        start, _ = self._say(before)
        head = len(self.words)
        self._say(behind)
        end = len(self.words)
        if end == start:
            raise ValueError(f"a role {name} has no words")
        span = RoleSpan(role, start, end, head if star else end - 1, len(self._triggers) - 1)
        self._roles.append((span, None if owner is None else int(owner)))

    def result(self) -> Annotated:
        roles = tuple(self._owned(span, said) for span, said in self._roles)
        return Annotated(
            tuple(self.words), tuple(self._acts), tuple(self._moves), tuple(self._triggers), roles
        )

    def _owned(self, span: RoleSpan, said: int | None) -> RoleSpan:
        """With its owner: the one said, else the trigger before, else the first."""
        if said is not None and said > len(self._triggers):
            raise ValueError(f"there is no frame {said} in this sentence")
        owner = (span.owner or 0) if said is None else said - 1
        owner = max(owner, 0) if said is None else owner
        found = owner if 0 <= owner < len(self._triggers) and span.role != "A" else None
        return RoleSpan(span.role, span.start, span.end, span.head, found)


def main() -> None:
    """Check a file of sentences: `python -m parley_train.markup FILE`."""
    if len(sys.argv) != 2:
        sys.exit("usage: python -m parley_train.markup FILE")
    file = Path(sys.argv[1])
    try:
        sentences = list(read_text(files.read_text(file), file.name))
    except FileFormatError as error:
        sys.exit(str(error))
    frames = {trigger.frame for sentence in sentences for trigger in sentence.triggers}
    sys.stdout.write(f"{len(sentences)} sentences, {len(frames)} frames: they can be read\n")


if __name__ == "__main__":
    main()
