"""Which vectors are nearest: the same with the sieve as without, for vectors as models make them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from parley.memory.vectors import SIEVE_FROM, Vectors, VectorTable, VectorView, make_sieve

LENGTH = 384


def unit(rows: Vectors) -> Vectors:
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True), np.float32)


@cache
def spread(count: int, seed: int, *, decay: float = 0.5, bias: float = 0.0) -> Vectors:
    """Vectors that differ much in some directions and little in others, with something common to all."""
    scale = np.arange(1, LENGTH + 1, dtype=np.float32) ** -decay
    rows = np.random.default_rng(seed).standard_normal((count, LENGTH), np.float32) * scale
    rows[:, 7] += bias * float(np.linalg.norm(scale))
    return unit(rows)


def plain(vectors: Vectors, vector: Vectors, most: int) -> list[int]:
    return [int(number) for number in np.argsort(-(vectors @ vector), kind="stable")[:most]]


def filled(vectors: Vectors) -> VectorTable:
    table = VectorTable(range(len(vectors)), vectors)
    assert table.wants_sieve
    table.adopt(make_sieve(table.view))
    assert not table.wants_sieve
    return table


@pytest.mark.parametrize("bias", [0.0, 1.2, 2.5], ids=["nothing common", "alike", "very alike"])
def test_sieve_finds_what_comparing_all_finds(bias: float) -> None:
    vectors = spread(SIEVE_FROM, 1, bias=bias)
    view = filled(vectors).view
    assert view.sieve is not None
    found = wanted = 0
    for vector in spread(20, 2, bias=bias):
        nearest, right = view.nearest(vector, 20, -1.0), plain(vectors, vector, 20)
        assert nearest[0] == right[0]
        found, wanted = found + len(set(nearest) & set(right)), wanted + len(right)
    assert found >= 0.99 * wanted


def test_vectors_without_directions_of_their_own_are_all_compared() -> None:
    vectors = unit(np.random.default_rng(1).standard_normal((SIEVE_FROM, LENGTH), np.float32))
    view = filled(vectors).view
    assert view.sieve is None
    asked = unit(np.random.default_rng(2).standard_normal((1, LENGTH), np.float32))[0]
    assert view.nearest(asked, 20, -1.0) == plain(vectors, asked, 20)


def test_vectors_that_come_behind_the_sieve_are_found() -> None:
    first, while_made, later = spread(SIEVE_FROM, 1), spread(50, 2), spread(50, 3)
    table = VectorTable(range(len(first)), first)
    before = table.view
    table.extend(range(30_000, 30_050), while_made)
    table.adopt(make_sieve(before))
    table.extend(range(40_000, 40_050), later)
    assert table.view.sieve is not None
    assert table.view.nearest(while_made[7], 1, 0.9) == [30_007]
    assert table.view.nearest(later[9], 1, 0.9) == [40_009]
    assert before.nearest(later[9], 1, 0.9) == [], "a view does not change"


def test_axes_are_sought_anew_when_there_are_twice_as_many() -> None:
    table = filled(spread(SIEVE_FROM, 1))
    table.extend(range(SIEVE_FROM, 2 * SIEVE_FROM - 1), spread(SIEVE_FROM - 1, 2))
    assert not table.wants_sieve
    table.extend([99_999], spread(1, 3))
    assert table.wants_sieve


def test_vectors_of_another_length_replace_all() -> None:
    table = VectorTable([1, 2], np.eye(2, 4, dtype=np.float32))
    table.extend([3], np.eye(1, 3, dtype=np.float32))
    assert len(table) == 1
    assert table.view.nearest(np.eye(1, 3, dtype=np.float32)[0], 5, 0.5) == [3]


def test_only_what_is_alike_enough_is_found_best_first() -> None:
    rows = unit(np.array([[0, 1], [1, 0], [1, 1], [1, 0.1]], np.float32))
    view = VectorView(np.array([10, 11, 12, 13]), rows)
    asked = np.array([1, 0], np.float32)
    assert view.nearest(asked, 10, 0.5) == [11, 13, 12]
    assert view.nearest(asked, 1, 0.5) == [11]
