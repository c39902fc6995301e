"""What kind of thing an action is, from what it declares."""

from __future__ import annotations

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.gate.risk import always_asks, risk_class, risk_of
from parley.messages.status import ActionInfo
from parley.umrf.action import action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_descriptor, write_descriptor


@pytest.mark.parametrize(
    ("effects", "risk", "expected"),
    [
        (("looks",), "", "looks_and_speaks"),
        (("looks", "moves"), "", "moves"),
        (("moves", "opens"), "", "handles_things"),
        (("moves", "pours"), "", "cannot_be_undone"),
        (("looks", "sings_to_the_moon"), "", "unknown"),
        ((), "", "unknown"),
        ((), "low", "unknown"),
        ((), "none", "looks_and_speaks"),
        (("moves",), "none", "moves"),
        (("looks",), "high", "cannot_be_undone"),
    ],
)
def test_the_worst_effect_counts_and_nothing_declared_is_unknown(
    effects: tuple[str, ...], risk: str, expected: str
) -> None:
    assert risk_class(effects, risk) == expected
    asks = expected in ("handles_things", "cannot_be_undone", "unknown")
    assert always_asks(ActionInfo(name="Do", effects=effects, risk=risk)) is asks


def test_an_action_that_nobody_knows_is_unknown() -> None:
    assert risk_of(None) == "unknown"
    assert always_asks(None)


def test_the_built_in_actions_say_what_they_do() -> None:
    found = {info.name: str(risk_of(info)) for info in Catalogue(BUILTIN_ACTIONS).infos()}
    assert found == {
        "GetCoordinates": "looks_and_speaks", "NavigateTo": "moves", "Inspect": "looks_and_speaks",
        "AskOperator": "looks_and_speaks", "KeepPicture": "looks_and_speaks", "MoveBy": "moves",
        "TurnBy": "moves", "TakePicture": "looks_and_speaks", "Wait": "looks_and_speaks",
        "Say": "looks_and_speaks", "Follow": "moves", "Dock": "moves", "PickUp": "handles_things",
        "Place": "handles_things", "WaitForRobot": "looks_and_speaks",
    }  # fmt: skip


def test_a_descriptor_without_a_word_about_risk_is_not_harmless() -> None:
    @action
    async def press(ctx: object) -> None:
        """Press."""

    assert read_descriptor(write_descriptor(press.spec)).risk == ""
    assert read_descriptor('{"name": "Press", "type": "sync", "parley": {"risk": "low"}}').risk == "low"
