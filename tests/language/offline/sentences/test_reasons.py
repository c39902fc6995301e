"""Why something is asked for is no order, and what is asked for goes on behind it."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.reasons import closed_reasons, without_reason
from parley.language.offline.words.text import keys, tokens


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("go to the shed because it rains", "go to the shed"),
        (
            "go to the shed so that they can help, and if it is, go home",
            "go to the shed, and if it is, go home",
        ),
        ("go to the shed so they know, otherwise go home", "go to the shed, otherwise go home"),
        ("go to the shed so we can start, then to the gate", "go to the shed, then to the gate"),
        ("go to the shed and do so", "go to the shed and do so"),
    ],
)
def test_only_the_reason_goes(said: str, left: str) -> None:
    assert keys(without_reason(tokens(said), opens_command)) == keys(tokens(left))


def test_a_way_that_goes_on_behind_a_reason_is_an_order() -> None:
    read = closed_reasons(tokens("go to the shed so they can see you, and then to the gate"))
    assert keys(read) == keys(tokens("go to the shed so they can see you. then go to the gate"))
