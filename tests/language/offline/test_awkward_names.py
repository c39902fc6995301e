"""Names that are ordinary words change nothing: what is said of a pond holds for a loading bay too."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from itertools import cycle

from parley.evaluation.cases import Case
from parley.evaluation.judge import wrong
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from tests.language.renamed import kinds_of, plain_cases, renamed

AWKWARD = (
    "loading bay", "waiting room", "pumping station", "packing table", "holding pen", "stamping press",
    "dressing room", "search desk", "repair bay", "start button",
)  # fmt: skip
"""What they begin with is also something to do."""
PLAIN = "alder tarn"
"""Words that mean nothing else to anybody who reads messages."""
CASES = 60


def pairs() -> Iterator[tuple[Case, Case]]:
    """Cases with a plain name, and the same with one that is an ordinary word, from all over the sets."""
    names = cycle(AWKWARD)
    cases = [*plain_cases(("development", "logic", "scenes"))]
    for case in cases[:: max(1, len(cases) // (CASES * 8))]:
        for kind in kinds_of(case)[:1]:
            plain, awkward = renamed(case, kind, PLAIN), renamed(case, kind, next(names))
            if plain is not None and awkward is not None:
                yield plain, awkward


async def _is_right(engine: OfflineLanguage, case: Case) -> bool:
    situation = case.situation
    assert isinstance(situation, Situation)
    return not wrong(case, situation, await engine.interpret(situation))


def test_a_name_that_is_an_ordinary_word_is_understood_like_any_other() -> None:
    engine = OfflineLanguage()

    async def ask() -> tuple[int, list[str]]:
        asked = 0
        failed: list[str] = []
        for plain, awkward in pairs():
            if asked < CASES and await _is_right(engine, plain):
                asked += 1
                failed += [] if await _is_right(engine, awkward) else [awkward.body.say]
        return asked, failed

    asked, failed = asyncio.run(ask())
    assert asked == CASES
    assert not failed
