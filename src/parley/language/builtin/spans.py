"""From scores of tags to triggers and role spans: the best sequence that can be read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from parley.language.builtin.labels import ACTS, FRAME_TAGS, MODES, MOVES, ROLE_TAGS
from parley.language.builtin.tagger import Matrix, Scores
from parley.language.builtin.tokens import Token

__all__ = ["Filler", "Parse", "Span", "Verb", "parse"]


@dataclass(frozen=True, slots=True)
class Verb:
    """Words that call up a frame, as the tagger sees them."""

    frame: str
    start: int
    end: int
    share: float
    """How much the tagger believes in it."""
    negated: bool = False
    otherwise: bool = False
    particles: tuple[int, ...] = ()
    mode: str = "plain"
    """How it is meant: one of `markup.MODES`."""


@dataclass(frozen=True, slots=True)
class Span:
    """Words that fill a role, as the tagger sees them."""

    role: str
    start: int
    end: int
    head: int
    owner: int | None
    """Which of the verbs it belongs to."""
    share: float


@dataclass(frozen=True, slots=True)
class Parse:
    """A message with what its words are."""

    tokens: tuple[Token, ...]
    acts: tuple[str, ...]
    verbs: tuple[Verb, ...]
    spans: tuple[Span, ...]
    shares: tuple[float, ...]
    """How much the tagger believes in what it says of each word."""
    moves: tuple[str, ...] = ()
    """Of each word: yes, no, stop and the like (`markup.MOVES`)."""

    def text(self, start: int, end: int) -> str:
        """The words from one to another, as they were said."""
        return " ".join(token.text for token in self.tokens[start:end] if token.is_word)

    def said(self, start: int, end: int) -> str:
        """The words and marks from one to another, as they were said."""
        found = ""
        for at in range(start, end):
            apart = at > start and self.tokens[at].start > self.tokens[at - 1].end
            found += f"{' ' if apart else ''}{self.tokens[at].text}"
        return found

    def part(self, start: int, end: int) -> Parse:
        """What is said of the words from one place to another."""
        mine = [n for n, verb in enumerate(self.verbs) if start <= verb.start < end]
        spans = (span for span in self.spans if start <= span.start and span.end <= end)
        return Parse(
            self.tokens[start:end],
            self.acts[start:end],
            tuple(_moved(self.verbs[n], start, end) for n in mine),
            tuple(
                replace(
                    span, start=span.start - start, end=span.end - start, head=span.head - start,
                    owner=mine.index(span.owner) if span.owner in mine else None,
                )
                for span in spans
            ),
            self.shares[start:end],
            self.moves[start:end],
        )  # fmt: skip


def _moved(verb: Verb, start: int, end: int) -> Verb:
    """A verb as a part of the row of words has it."""
    particles = tuple(at - start for at in verb.particles if at < end)
    return replace(verb, start=verb.start - start, end=min(verb.end, end) - start, particles=particles)


def parse(tokens: tuple[Token, ...], scores: Scores) -> Parse:
    """The best reading of the scores."""
    size = min(len(tokens), len(scores.act))
    tokens = tokens[:size]
    frames = _best(scores.frame[:size], FRAME_TAGS)
    roles = _best(scores.role[:size], ROLE_TAGS)
    acts = tuple(ACTS[int(row.argmax())] for row in scores.act[:size])
    shares = tuple(float(min(scores.frame[at, frames[at]], scores.role[at, roles[at]])) for at in range(size))
    verbs = _verbs(frames, scores)
    moves = tuple(MOVES[int(row.argmax())] for row in scores.move[:size])
    return Parse(tokens, acts, verbs, _spans(tokens, roles, scores, verbs), shares, moves)


def _best(shares: Matrix, tags: tuple[str, ...]) -> list[int]:
    """The likeliest tags of which every I- stands behind its B- or another I-."""
    allowed = _follows(tags)
    logs = np.log(shares + 1e-9)
    best = logs[0] + np.array([-50.0 if tag.startswith("I-") else 0.0 for tag in tags])
    back = []
    for row in logs[1:]:
        ways = best[:, None] + allowed
        back.append(ways.argmax(0))
        best = ways.max(0) + row
    path = [int(best.argmax())]
    for row in reversed(back):
        path.append(int(row[path[-1]]))
    return path[::-1]


@lru_cache(maxsize=8)
def _follows(tags: tuple[str, ...]) -> Matrix:
    table = np.zeros((len(tags), len(tags)), dtype=np.float32)
    for behind, tag in enumerate(tags):
        if tag.startswith("I-"):
            for before, other in enumerate(tags):
                if other[1:] != tag[1:] or other in ("O", "+"):
                    table[before, behind] = -50.0
    return table


def _pieces(path: list[int], tags: tuple[str, ...]) -> list[tuple[str, int, int]]:
    """Name, start and end of each B- with the I- behind it."""
    found: list[tuple[str, int, int]] = []
    for at, number in enumerate(path):
        mark, _, name = tags[number].partition("-")
        if mark == "B":
            found.append((name, at, at + 1))
        elif mark == "I" and found:
            found[-1] = (found[-1][0], found[-1][1], at + 1)
    return found


def _verbs(path: list[int], scores: Scores) -> tuple[Verb, ...]:
    pieces = _pieces(path, FRAME_TAGS)
    beside = [at for at, number in enumerate(path) if FRAME_TAGS[number] == "+"]
    verbs = []
    for number, (frame, start, end) in enumerate(pieces):
        share = float(min(scores.frame[at, path[at]] for at in range(start, end)))
        mode = MODES[int(scores.mode[start].argmax())]
        behind = pieces[number + 1][1] if number + 1 < len(pieces) else len(path)
        mine = tuple(at for at in beside if end <= at < behind)
        verbs.append(Verb(frame, start, end, share, mode == "negated", mode == "otherwise", mine, mode))
    return tuple(verbs)


_QUOTES = {"“": "”", '"': '"', "‘": "’", "«": "»"}


def _quoted(tokens: Sequence[Token], start: int, end: int) -> int:
    """Where words that are to be said end: what begins with a quotation mark ends with its other half."""
    closing = _QUOTES.get(tokens[start].text)
    found = (at + 1 for at in range(start + 1, len(tokens)) if tokens[at].text == closing)
    return next(found, end) if closing else end


def _spans(
    tokens: Sequence[Token], path: list[int], scores: Scores, verbs: tuple[Verb, ...]
) -> tuple[Span, ...]:
    spans: list[Span] = []
    for role, start, end in _pieces(path, ROLE_TAGS):
        if spans and start < spans[-1].end:
            continue  # inside what is to be said
        share = float(min(scores.role[at, path[at]] for at in range(start, end)))
        end = _quoted(tokens, start, end) if role == "X" else end
        head = start + int(scores.head[start:end, 1].argmax())
        ways = [float(scores.arcs[head, 0]), *(float(scores.arcs[head, verb.start + 1]) for verb in verbs)]
        best = int(np.argmax(ways))
        spans.append(Span(role, start, end, head, best - 1 if best else None, share))
    return tuple(spans)


@dataclass(frozen=True, slots=True)
class Filler:
    """What fills a role: words of the message, by their places."""

    role: str
    start: int
    end: int
    head: int
    words: tuple[str, ...]
    """From start to end, in small letters."""
    share: float = 1.0
    said: str = ""
    """As it was said."""

    @property
    def text(self) -> str:
        """Its words, as they were said."""
        return self.said or " ".join(self.words)
