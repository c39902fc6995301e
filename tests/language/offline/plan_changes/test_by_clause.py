"""Changes of the plan said in several clauses."""

from __future__ import annotations

import pytest

from tests.language.offline.plan_changes.test_rearranging import places


@pytest.mark.parametrize(
    ("message", "left"),
    [
        ("area B was done this morning, so there is no point in it", "A C"),
        ("hold your horses with area B, do area C before it", "A C B"),
        ("you can leave area C out now, somebody has checked it", "A B"),
        ("area C first and area B at the very end", "A C B"),
        ("whatever comes after area A, strike it", "A"),
        ("you need not go to area B any more, the rest stands", "A C"),
        ("drop area B, but keep area C", "A C"),
        ("cancel the rest", "A"),
    ],
)
async def test_each_clause_changes_what_the_ones_before_it_left(message: str, left: str) -> None:
    assert await places(message) == left


async def test_an_order_for_something_else_is_no_change_of_the_plan() -> None:
    assert await places("area B was done this morning, so count the cars in area C") != "A C"
