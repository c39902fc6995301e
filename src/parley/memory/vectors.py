"""Vectors in working memory, and which of them are nearest to another. Pure; nothing here waits.

Among few, all are compared. Among many, all are compared in those directions first in which they differ most
(principal axes), and only those that come near are compared in full: a sixth of the reading. Where vectors
have no such directions, all are compared after all.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

__all__ = ["SIEVE_FROM", "Sieve", "VectorTable", "VectorView", "Vectors", "make_sieve"]

Vectors = npt.NDArray[np.float32]
"""One row per text, each of length one, so that a dot product is the cosine."""
Ids = npt.NDArray[np.int64]

SIEVE_FROM: Final = 20_000
"""So many vectors are compared in full without a thought."""
_AXES: Final = 128
_SAMPLE: Final = 4096
"""So many vectors tell which axes matter."""
_LEAST_SHARE: Final = 0.6
"""Of their squared length that the axes must hold, or the sieve would lose near ones."""
_CLOSE_LOOKS: Final = 2000
_GROWTH: Final = 1.25
"""So that many small additions do not copy everything each time."""
_BLOCK: Final = 8192


@dataclass(frozen=True, slots=True)
class Sieve:
    """The axes along which vectors differ most, and all vectors along them."""

    axes: Vectors
    short: Vectors


class _Rows:
    """Rows with room for more behind them; what stands is never written again, so a view of it stays good."""

    def __init__(self, width: int) -> None:
        self._room: Vectors = np.zeros((0, width), np.float32)
        self.rows: Vectors = self._room

    def extend(self, rows: Vectors) -> None:
        begun, ended = len(self.rows), len(self.rows) + len(rows)
        if ended > len(self._room):
            self._room = np.empty((max(ended, int(_GROWTH * begun)), rows.shape[1]), np.float32)
            self._room[:begun] = self.rows
        self._room[begun:ended] = rows
        self.rows = self._room[:ended]


class VectorTable:
    """Vectors of one length, each with the number of what it belongs to.

    Args:
        ids: Of the first vectors.
        vectors: Them.
    """

    def __init__(self, ids: Sequence[int] = (), vectors: Vectors | None = None) -> None:
        self._ids: Ids = np.zeros(0, np.int64)
        self._full, self._short = _Rows(1), _Rows(_AXES)
        self._axes: Vectors | None = None
        self._looked_at = 0
        """How many there were when the axes were sought."""
        if vectors is not None:
            self.extend(ids, vectors)

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def length(self) -> int:
        """Of each vector; 0 while there is none."""
        return self._full.rows.shape[1] if len(self) else 0

    @property
    def view(self) -> VectorView:
        """What stands now, for another thread."""
        sieve = None if self._axes is None else Sieve(self._axes, self._short.rows)
        return VectorView(self._ids, self._full.rows, sieve)

    @property
    def wants_sieve(self) -> bool:
        """Whether there are so many by now that axes should be sought (anew, as there are twice as many)."""
        return len(self) >= max(SIEVE_FROM, 2 * self._looked_at)

    def extend(self, ids: Sequence[int], vectors: Vectors) -> None:
        """Add vectors; those of another length take the place of all."""
        if self._full.rows.shape[1] != vectors.shape[1]:
            self._ids, self._full, self._axes = np.zeros(0, np.int64), _Rows(vectors.shape[1]), None
            self._looked_at = 0
        self._full.extend(vectors)
        self._ids = np.concatenate([self._ids, np.asarray(ids, np.int64)])
        if self._axes is not None:
            self._short.extend(vectors @ self._axes)

    def extended(self, ids: Sequence[int], vectors: Vectors) -> VectorTable:
        """A table with more vectors; this one stays as it is, so that a thread may make it."""
        more = copy.copy(self)
        more._full, more._short = copy.copy(self._full), copy.copy(self._short)
        more.extend(ids, vectors)
        return more

    def adopt(self, sieve: Sieve | None) -> None:
        """Take over what `make_sieve` made of a view of this; vectors may have come since."""
        self._looked_at, self._axes = len(self), None
        if sieve is not None and sieve.axes.shape[0] == self._full.rows.shape[1]:
            self._axes, self._short = sieve.axes, _Rows(_AXES)
            self._short.extend(sieve.short)
            self._short.extend(self._full.rows[len(sieve.short) :] @ sieve.axes)


@dataclass(frozen=True, slots=True)
class VectorView:
    """Vectors that change no more."""

    ids: Ids
    vectors: Vectors
    sieve: Sieve | None = None

    def nearest(self, vector: Vectors, most: int, least: float) -> list[int]:
        """Whose vectors are nearest, nearest first.

        Args:
            vector: Of length one.
            most: How many at most.
            least: The least cosine.
        """
        numbers = self._near(vector, max(_CLOSE_LOOKS, 10 * most))
        cosine = _cosines(self.vectors if numbers is None else self.vectors[numbers], vector)
        top = _largest(cosine, most)
        top = top[cosine[top] >= least]
        ranked = top[np.argsort(-cosine[top], kind="stable")]
        return [int(self.ids[number]) for number in (ranked if numbers is None else numbers[ranked])]

    def _near(self, vector: Vectors, looks: int) -> npt.NDArray[np.intp] | None:
        """The rows to look at closely; None for all."""
        if self.sieve is None or len(self.vectors) <= looks:
            return None
        return _largest(_cosines(self.sieve.short, vector @ self.sieve.axes), looks)


def make_sieve(view: VectorView) -> Sieve | None:
    """Axes for many vectors, None if there are none that tell enough. Takes a second for 100,000."""
    vectors = view.vectors
    if len(vectors) < SIEVE_FROM or vectors.shape[1] < 2 * _AXES:
        return None
    sample = vectors[:: max(1, len(vectors) // _SAMPLE)][:_SAMPLE]
    lengths, directions = np.linalg.eigh(sample.T @ sample)
    if lengths[-_AXES:].sum() < _LEAST_SHARE * lengths.sum():
        return None
    axes = np.ascontiguousarray(directions[:, -_AXES:], np.float32)
    short = np.empty((len(vectors), _AXES), np.float32)
    for begun in range(0, len(vectors), _BLOCK):
        short[begun : begun + _BLOCK] = vectors[begun : begun + _BLOCK] @ axes
    return Sieve(axes, short)


def _cosines(rows: Vectors, vector: Vectors) -> Vectors:
    # Row by row in this thread: a matrix product spreads over all cores, and on a busy machine waits for the
    # slowest of them.
    return np.asarray(np.vecdot(rows, vector), np.float32)


def _largest(values: Vectors, most: int) -> npt.NDArray[np.intp]:
    if len(values) <= most:
        return np.arange(len(values))
    return np.argpartition(values, -most)[-most:]
