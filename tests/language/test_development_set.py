"""Every sentence of the development set is understood."""

from __future__ import annotations

import pytest

from parley.evaluation.cases import Case
from parley.evaluation.judge import wrong
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from tests.language.dev_set import development_set


@pytest.mark.parametrize("case", development_set().cases, ids=lambda case: case.id[:60])
async def test_a_sentence_of_the_development_set_is_understood(case: Case) -> None:
    situation = case.situation
    assert isinstance(situation, Situation)
    assert wrong(case, situation, await OfflineLanguage().interpret(situation)) == []
