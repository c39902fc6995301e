"""Who goes with what."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from parley.pairing import best_pairs


@settings(max_examples=200, deadline=None)
@given(st.integers(1, 7), st.integers(1, 7), st.integers(0, 10_000), st.sampled_from([2, 4, 1000]))
def test_the_pairs_are_those_of_scipy_also_among_equals(
    rows: int, columns: int, seed: int, kinds: int
) -> None:
    table = np.random.default_rng(seed).integers(0, kinds, (rows, columns)) / 10
    wanted = linear_sum_assignment(-table)
    assert best_pairs(table.tolist()) == [
        (int(row), int(column)) for row, column in zip(*wanted, strict=True)
    ]


def test_of_nothing_there_are_no_pairs() -> None:
    assert best_pairs([]) == best_pairs([[], []]) == []
