"""What a message asks for, by what the robot offers; and the order in which that is due."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.messages.status import ActionInfo

CATALOGUE = (
    ActionInfo(name="fillKettle", inputs={"litres": "number"}, description="Fill the kettle."),
    ActionInfo(name="grindBeans", inputs={"kind": "string", "seconds": "number"}),
    ActionInfo(name="steam", inputs={"on": "bool"}, description="Turn the steam on or off."),
    ActionInfo(name="wipeCounter", inputs={"counter": "string"}, description="Wipe a counter."),
    ActionInfo(name="waxCounter", inputs={"counter": "string"}, description="Wax a counter."),
    ActionInfo(name="ring_chime"),
)


def done(message: str) -> list[tuple[object, ...]]:
    situation = Situation(message=message, catalogue=CATALOGUE, robot="Bo", robots=("Bo",))
    action, _ = OfflineLanguage().explain(situation)
    return [
        (step.name, *(parameter.value for parameter in step.input_parameters.values()))
        for step in action.queue
    ]


@pytest.mark.parametrize(
    ("message", "plan"),
    [
        ("ring the chime, then wipe counter 2, and before all that fill the kettle with two litres",
         [("fillKettle", 2.0), ("ring_chime",), ("wipeCounter", "counter 2")]),
        ("Wipe counter 1 once you have turned the steam off. Last of all, ring the chime.",
         [("steam", False), ("wipeCounter", "counter 1"), ("ring_chime",)]),
        ("Before you ring the chime, fill the kettle with 3 litres.", [("fillKettle", 3.0), ("ring_chime",)]),
        ("steam on, and counter 4 should be wiped", [("steam", True), ("wipeCounter", "counter 4")]),
        ("Grind Arabica beans for 20 seconds, but turn the steam on first.",
         [("steam", True), ("grindBeans", "Arabica", 20.0)]),
        ("Grind Arabica beans for 20 seconds and Robusta beans for 30 seconds.",
         [("grindBeans", "Arabica", 20.0), ("grindBeans", "Robusta", 30.0)]),
        ("steam off please, it is far too loud", [("steam", False)]),
        ("Wipe counter 1, steam off, ring the chime",
         [("wipeCounter", "counter 1"), ("steam", False), ("ring_chime",)]),
    ],
)  # fmt: skip
def test_several_actions_come_in_the_order_that_is_said(message: str, plan: list[tuple[object, ...]]) -> None:
    assert done(message) == plan


def test_it_stands_for_what_was_named_though_that_comes_later() -> None:
    plan = [("wipeCounter", "counter 3"), ("waxCounter", "counter 3")]
    assert done("Wax counter 3 once you have wiped it.") == plan


def test_what_is_forbidden_is_not_done() -> None:
    assert ("ring_chime",) not in done("Turn the steam on and never ring the chime.")
