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
        ("fifth_set", 0.95),
        ("scenes", 0.92),
        ("fresh_calls", 0.82),
        ("fresh_days", 0.96),
        ("fresh_nights", 0.86),
        ("fresh_scenes", 0.88),
        ("long_calls", 0.69),
        ("fresh_tasks", 0.90),
        ("list", 0.80),
        ("logic", 0.90),
        ("needs", 0.95),
        ("people", 0.91),
        ("readings", 0.93),
        ("unseen_actions", 0.91),
        ("voices", 0.81),
        ("wordings", 0.78),
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
