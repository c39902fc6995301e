"""The third set: situations for every phenomenon in worlds of its own, understood but for a few."""

from __future__ import annotations

from parley.evaluation.judge import wrong
from parley.evaluation.sets import own_set
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage

RIGHT = 0.97
"""The share that must be right."""


async def test_the_third_set_is_understood_but_for_a_few_sentences() -> None:
    engine, failed, count = OfflineLanguage(), [], 0
    for case in own_set("third_set").cases:
        situation = case.situation
        assert isinstance(situation, Situation)
        count += 1
        if wrong(case, situation, await engine.interpret(situation)):
            failed.append(case.id)
    assert count > 300
    assert len(failed) <= count * (1 - RIGHT), failed


async def test_a_message_is_answered_alike_each_time_it_is_said() -> None:
    for case in own_set("third_set").cases[::7]:
        situation = case.situation
        assert isinstance(situation, Situation)
        first = await OfflineLanguage().interpret(situation)
        assert await OfflineLanguage().interpret(situation) == first


def test_explaining_changes_no_answer() -> None:
    engine = OfflineLanguage()
    for case in own_set("third_set").cases[::5]:
        situation = case.situation
        assert isinstance(situation, Situation)
        plainly, again = engine.explain(situation), engine.explain(situation)
        assert plainly == again
