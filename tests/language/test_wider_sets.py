"""The sets that are not understood whole: none of them may fall below what was reached."""

from __future__ import annotations

import asyncio
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest

from parley.evaluation.judge import wrong
from parley.evaluation.sets import own_set
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage

REACHED = {
    "fifth_set": 0.95,
    "scenes": 0.92,
    "fresh_calls": 0.82,
    "fresh_days": 0.96,
    "fresh_nights": 0.86,
    "fresh_scenes": 0.88,
    "fresh_tasks": 0.90,
    "list": 0.80,
    "logic": 0.90,
    "long_calls": 0.69,
    "needs": 0.95,
    "people": 0.91,
    "readings": 0.93,
    "unseen_actions": 0.91,
    "voices": 0.81,
    "wordings": 0.78,
}


def failed_and_all(name: str) -> tuple[list[str], int]:
    """The cases of a set that are not understood, and how many cases it has."""
    engine = OfflineLanguage()

    async def ask() -> tuple[list[str], int]:
        asked = [(c, c.situation) for c in own_set(name).cases if isinstance(c.situation, Situation)]
        return [c.id for c, s in asked if wrong(c, s, await engine.interpret(s))], len(asked)

    return asyncio.run(ask())


@pytest.fixture(scope="module")
def answered() -> dict[str, tuple[list[str], int]]:
    """All sets, asked side by side: one after the other they take over a minute."""
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        return dict(zip(REACHED, pool.map(failed_and_all, REACHED), strict=True))


@pytest.mark.timeout(300)
@pytest.mark.parametrize("name", REACHED)
def test_a_set_is_understood_as_well_as_it_was(name: str, answered: dict[str, tuple[list[str], int]]) -> None:
    failed, count = answered[name]
    assert count > 20
    assert len(failed) <= count * (1 - REACHED[name]), failed
