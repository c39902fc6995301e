"""Inputs that are so or not, or take one of a few values."""

from __future__ import annotations

import pytest

from parley.language.offline.tasks.choices import choices_of, chosen, is_listed, states_verb, switched
from parley.language.offline.words.text import tokens
from parley.messages.status import ActionInfo

COVER = ActionInfo(name="coverTank", inputs={"closed": "boolean"}, description="Close or open the lid.")
FAN = ActionInfo(name="fan", inputs={"enabled": "bool"})
BOX = ActionInfo(name="boxOrder", inputs={"order": "number", "gift_wrap": "bool"}, optional=("gift_wrap",))
PUMP = ActionInfo(
    name="setPump", inputs={"mode": "string"}, description="Pump mode: eco, deep_clean or night."
)
TYPED = ActionInfo(name="setSpeed", inputs={"pace": "slow|fast"})


@pytest.mark.parametrize(
    ("info", "name", "say", "value"),
    [
        (COVER, "closed", "close the lid", True),
        (COVER, "closed", "open the lid", False),
        (FAN, "enabled", "fan off", False),
        (FAN, "enabled", "switch the fan on", True),
        (FAN, "enabled", "stop the fan", False),
        (BOX, "gift_wrap", "box order 7, gift wrapped", True),
        (BOX, "gift_wrap", "box order 7 without gift wrap", False),
    ],
)
def test_it_is_heard_whether_something_is_to_be_so(
    info: ActionInfo, name: str, say: str, value: bool
) -> None:
    found = switched(info, name, tokens(say))
    assert found is not None and found[0] is value


def test_nothing_is_made_up_for_what_is_not_said() -> None:
    assert switched(BOX, "gift_wrap", tokens("box order 7")) is None


def test_values_are_read_from_descriptions_and_types() -> None:
    assert choices_of(PUMP) == {"mode": {"eco": "eco", "deep clean": "deep_clean", "night": "night"}}
    assert choices_of(TYPED) == {"pace": {"slow": "slow", "fast": "fast"}}
    assert is_listed("pace", TYPED)


def test_a_value_of_two_words_is_found() -> None:
    assert chosen(PUMP, tokens("pump on deep clean please"))["mode"][0] == "deep_clean"


def test_what_an_input_can_be_may_stand_for_the_verb() -> None:
    assert states_verb(COVER, tokens("open the lid"))
    assert not states_verb(COVER, tokens("look at the lid"))
