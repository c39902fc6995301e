"""The fifth set: how a message is cut into what is asked, understood but for a few."""

from __future__ import annotations

from parley.evaluation.judge import wrong
from parley.evaluation.sets import own_set
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage

RIGHT = 0.88
"""The share that must be right."""


async def test_the_fifth_set_is_understood_but_for_a_few_sentences() -> None:
    engine, failed, count = OfflineLanguage(), [], 0
    for case in own_set("fifth_set").cases:
        situation = case.situation
        assert isinstance(situation, Situation)
        count += 1
        if wrong(case, situation, await engine.interpret(situation)):
            failed.append(case.id)
    assert count > 200
    assert len(failed) <= count * (1 - RIGHT), failed
