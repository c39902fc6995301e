"""The sets that are not understood whole: none of them may fall below what was reached."""

from __future__ import annotations

import pytest

from parley.evaluation.judge import wrong
from parley.evaluation.sets import own_set
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage


@pytest.mark.parametrize(
    ("name", "right"),
    [
        ("fifth_set", 0.93),
        ("scenes", 0.88),
        ("fresh_calls", 0.67),
        ("fresh_days", 0.92),
        ("fresh_nights", 0.78),
        ("fresh_scenes", 0.66),
        ("long_calls", 0.70),
        ("logic", 0.88),
        ("needs", 0.94),
        ("people", 0.79),
        ("readings", 0.90),
        ("unseen_actions", 0.92),
        ("voices", 0.61),
        ("wordings", 0.70),
    ],
)
async def test_a_set_is_understood_as_well_as_it_was(name: str, right: float) -> None:
    engine, failed, count = OfflineLanguage(), [], 0
    for case in own_set(name).cases:
        if isinstance(case.situation, Situation):
            count += 1
            if wrong(case, case.situation, await engine.interpret(case.situation)):
                failed.append(case.id)
    assert count > 20
    assert len(failed) <= count * (1 - right), failed
