"""The learned witness: words to scores of tags, by a small encoder that runs without torch."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from parley.language.builtin.labels import DESCRIBED, HEADS

__all__ = ["Pieces", "Scores", "Tagger", "WordPiece", "shipped_tagger"]

Matrix = NDArray[np.float32]


_LONGEST = 60
_MOST_PIECES = 254


@dataclass(frozen=True, slots=True)
class Pieces:
    """The pieces of a sentence, with [CLS] and [SEP] around."""

    ids: tuple[int, ...]
    first: tuple[int, ...]
    """For each word, where its first piece stands; words behind what fits have none."""


@dataclass(frozen=True, slots=True)
class WordPiece:
    """Greedy longest match, as BERT does it on words in small letters without accents."""

    vocabulary: dict[str, int]
    _known: dict[str, tuple[int, ...]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, text: str) -> WordPiece:
        """From a vocabulary, one piece a line."""
        return cls({piece: number for number, piece in enumerate(text.split("\n"))})

    def split(self, words: Sequence[str]) -> Pieces:
        """The pieces of words."""
        ids, first = [self.vocabulary["[CLS]"]], []
        for word in words:
            pieces = self._word(word)
            if len(ids) + len(pieces) > _MOST_PIECES:
                break
            first.append(len(ids))
            ids += pieces
        return Pieces((*ids, self.vocabulary["[SEP]"]), tuple(first))

    def _word(self, word: str) -> tuple[int, ...]:
        found = self._known.get(word)
        if found is None:
            found = self._pieces(word)
            if len(self._known) < 20_000:
                self._known[word] = found
        return found

    def _pieces(self, word: str) -> tuple[int, ...]:
        plain = unicodedata.normalize("NFD", word.lower().replace("’", "'"))
        plain = "".join(letter for letter in plain if not unicodedata.combining(letter))[:_LONGEST]
        ids: list[int] = []
        for part in _parts(plain):
            ids += self._part(part)
        return tuple(ids) or (self.vocabulary["[UNK]"],)

    def _part(self, part: str) -> list[int]:
        ids: list[int] = []
        at = 0
        while at < len(part):
            lead = "##" if at else ""
            end = next((end for end in range(len(part), at, -1) if lead + part[at:end] in self.vocabulary), 0)
            if not end:
                return [self.vocabulary["[UNK]"]]
            ids.append(self.vocabulary[lead + part[at:end]])
            at = end
        return ids


def _parts(word: str) -> list[str]:
    """Marks inside a word stand alone, as in t-shirt or don't."""
    parts = [""]
    for letter in word:
        if letter.isalnum():
            parts[-1] += letter
        else:
            parts += [letter, ""]
    return [part for part in parts if part]


@dataclass(frozen=True, slots=True)
class Scores:
    """Shares of belief for each word; rows add up to one."""

    act: Matrix
    frame: Matrix
    role: Matrix
    head: Matrix
    mode: Matrix
    move: Matrix
    arcs: Matrix
    """Column 0: belongs to nothing; column n: to what begins at word n - 1."""


@dataclass(frozen=True, slots=True)
class Tagger:
    """The encoder with its heads."""

    session: Any
    pieces: WordPiece

    def tag(self, words: Sequence[str], names: Sequence[tuple[int, int]] = ()) -> Scores:
        """The scores of a sentence's words; of a very long one those of its beginning.

        Args:
            words: As they were said.
            names: From where to where a name of several words stands; its last word is read in its place.
        """
        inside = {at for start, end in names for at in range(start, end - 1)}
        read = [at for at in range(len(words)) if at not in inside]
        scores = self._tagged([words[at] for at in read])
        return _with_names(scores, read, len(words)) if inside else scores

    def _tagged(self, words: Sequence[str]) -> Scores:
        split = self.pieces.split(words)
        ids = np.array([split.ids], dtype=np.int64)
        given = {
            "ids": ids,
            "mask": np.ones(ids.shape, dtype=np.float32),
            "first": np.array([split.first or (0,)], dtype=np.int64),
        }
        found = self.session.run([*HEADS, "arcs"], given)
        return Scores(*(_shares(scores[0]) for scores in found))

    def describe(self, texts: Sequence[str]) -> list[dict[str, float]]:
        """What each text, said of an action, describes: frames and the belief in them."""
        rows = (_shares(self._whole("described", text)) for text in texts)
        return [{frame: float(share) for frame, share in zip(DESCRIBED, row, strict=True)} for row in rows]

    def meanings(self, texts: Sequence[str]) -> Matrix:
        """What each text means as a whole: rows of length one, so that products are likenesses."""
        rows = np.array([self._whole("meaning", text.lower()) for text in texts], dtype=np.float32)
        rows = rows - rows.mean(-1, keepdims=True)
        units: Matrix = rows / np.linalg.norm(rows, axis=-1, keepdims=True)
        return units

    def _whole(self, output: str, text: str) -> Matrix:
        split = self.pieces.split(text.split() or ["?"])
        ids = np.array([split.ids], dtype=np.int64)
        given = {
            "ids": ids,
            "mask": np.ones(ids.shape, dtype=np.float32),
            "first": np.zeros((1, 1), dtype=np.int64),
        }
        row: Matrix = self.session.run([output], given)[0][0]
        return row


def _with_names(scores: Scores, read: Sequence[int], size: int) -> Scores:
    """The scores of all words: what stands for a name counts for each of its words, as one span."""
    rows = np.searchsorted(read, np.arange(size))
    rows = rows[rows < len(scores.act)]
    inner = np.flatnonzero(rows[1:] == rows[:-1])
    later = inner + 1
    every = {name: getattr(scores, name)[rows] for name in ("act", "frame", "role", "head", "mode", "move")}
    for shares in (every["frame"], every["role"]):  # O, then B- and I- of each; of frames a "+" behind
        end = shares.shape[1] - (shares.shape[1] - 1) % 2
        shares[later, 2:end:2] += shares[later, 1:end:2]
        shares[later, 1:end:2] = 0
    every["head"][inner, 1] = 0
    columns = [0, *(int(row) + 1 for row in rows)]
    arcs = scores.arcs[rows][:, columns]
    arcs[:, later + 1] = 0
    return Scores(**every, arcs=arcs)


def _shares(scores: Matrix) -> Matrix:
    grown = np.exp(scores - scores.max(-1, keepdims=True))
    shares: Matrix = grown / grown.sum(-1, keepdims=True)
    return shares


@cache
def shipped_tagger() -> Tagger:
    """The one whose weights lie beside this program; loaded on first use."""
    import onnxruntime

    folder = resources.files("parley.language.builtin") / "weights"
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.inter_op_num_threads = 1
    with resources.as_file(
        folder / "tagger.onnx"
    ) as file:  # read from a copy in memory it takes that as well
        session = onnxruntime.InferenceSession(file, options)
    return Tagger(session, WordPiece.of((folder / "vocabulary.txt").read_text(encoding="utf-8")))
