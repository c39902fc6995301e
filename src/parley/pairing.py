"""Who goes with what, so that it fits best on the whole: a table of values -> pairs of row and column.

The shortest augmenting paths of Crouse (2016), as SciPy has them, which would be a third of what a robot's
computer installs for this alone. Of equally good pairings it is the same one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

__all__ = ["best_pairs"]


def best_pairs(values: Sequence[Sequence[float]]) -> list[tuple[int, int]]:
    """As many pairs as there are rows or columns, whichever are fewer, with the greatest sum; by row.

    Args:
        values: How well each row goes with each column; finite.
    """
    if not values or not values[0]:
        return []
    if len(values[0]) < len(values):
        turned = best_pairs(list(zip(*values, strict=True)))
        return sorted((row, column) for column, row in turned)
    return list(enumerate(_Pairing([[-value for value in row] for row in values]).columns))


class _Pairing:
    """Adds one row after the other to a pairing of least cost; no more rows than columns."""

    def __init__(self, costs: Sequence[Sequence[float]]) -> None:
        self._costs = costs
        self.columns = [-1] * len(costs)
        """Row -> its column."""
        self._rows = [-1] * len(costs[0])
        self._row_price, self._column_price = [0.0] * len(costs), [0.0] * len(costs[0])
        for row in range(len(costs)):
            self._add(row)

    def _add(self, row: int) -> None:
        came_from, lengths, passed, free = self._way(row)
        total = lengths[free]
        self._row_price[row] += total
        for column in passed:
            if column != free:
                self._row_price[self._rows[column]] += total - lengths[column]
            self._column_price[column] -= total - lengths[column]
        column = free
        while column >= 0:  # each row on the way takes the next column
            before = came_from[column]
            self._rows[column] = before
            self.columns[before], column = column, self.columns[before]

    def _way(self, row: int) -> tuple[list[int], list[float], list[int], int]:
        """The shortest way from a new row to a free column: steps, lengths, columns passed, that column."""
        width = len(self._rows)
        came_from, lengths, passed = [-1] * width, [math.inf] * width, []
        left, length = list(range(width - 1, -1, -1)), 0.0
        while True:
            found, least = -1, math.inf
            for index, column in enumerate(left):
                cost = length + self._costs[row][column] - self._row_price[row] - self._column_price[column]
                if cost < lengths[column]:
                    came_from[column], lengths[column] = row, cost
                if lengths[column] < least or (lengths[column] == least and self._rows[column] < 0):
                    found, least = index, lengths[column]
            column, length = left[found], least
            left[found] = left[-1]
            left.pop()
            passed.append(column)
            if self._rows[column] < 0:
                return came_from, lengths, passed, column
            row = self._rows[column]
