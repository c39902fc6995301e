"""Zones as shapes: how far points are from them, whether ways lead into them. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from parley.messages.rules import Point

__all__ = ["Shape", "dense"]

Floats = NDArray[np.float64]


class Shape:
    """One closed polygon in the map frame."""

    def __init__(self, corners: Sequence[Point]) -> None:
        """Take the corners in order; the last side leads back to the first."""
        self._from = np.asarray(corners, dtype=np.float64)
        self._to = np.roll(self._from, -1, axis=0)
        self._low, self._high = self._from.min(axis=0), self._from.max(axis=0)

    @property
    def box_m(self) -> tuple[float, float, float, float]:
        """x_min, y_min, x_max, y_max of what surrounds it."""
        (x1, y1), (x2, y2) = self._low.tolist(), self._high.tolist()
        return x1, y1, x2, y2

    def distance_m(self, points: Floats) -> Floats:
        """Signed distance of points (n, 2) from the border: negative inside."""
        points = np.atleast_2d(points)
        side = self._to - self._from
        offset = points[:, None, :] - self._from[None]
        along = np.clip((offset * side).sum(axis=2) / np.maximum((side**2).sum(axis=1), 1e-18), 0.0, 1.0)
        gap = np.linalg.norm(offset - along[..., None] * side, axis=2).min(axis=1)
        return np.asarray(np.where(self._inside(points), -gap, gap))

    def _inside(self, points: Floats) -> NDArray[np.bool_]:
        x, y = points[:, :1], points[:, 1:]
        x1, y1, x2, y2 = self._from[:, 0], self._from[:, 1], self._to[:, 0], self._to[:, 1]
        spans = (y1 > y) != (y2 > y)
        rise = np.where(y2 == y1, 1.0, y2 - y1)
        return np.asarray((spans & (x < (x2 - x1) * (y - y1) / rise + x1)).sum(axis=1) % 2 == 1)

    def distance_to(self, x_m: float, y_m: float) -> float:
        """Signed distance of one point from the border: negative inside."""
        return float(self.distance_m(np.array([[x_m, y_m]]))[0])


def dense(points: Sequence[Point], step_m: float = 0.05) -> Floats:
    """The way along points, with points in between so that none is farther than `step_m` from the next."""
    way = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    if len(way) < 2:
        return way
    parts = [way[:1]]
    for start, end in pairwise(way):
        count = max(1, int(np.ceil(np.linalg.norm(end - start) / step_m)))
        parts.append(start + (end - start) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(parts)
