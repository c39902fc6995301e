"""One wish in many forms, each put as the plain order it means."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.forms import plainly_put
from parley.language.offline.words.text import plain, tokens
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

_CATALOGUE = tuple(
    ActionInfo(name=name, inputs=inputs, description=told)
    for name, inputs, told in (
        ("drive_to", {"place": "string"}, ""),
        ("waxHull", {"boat": "string"}, "Wax the hull of a boat."),
        ("rinse", {"boat": "string"}, ""),
        ("trim_sail", {"sail": "string"}, ""),
        ("lub_winch", {"winch": "string"}, "Goes to a winch and oils it."),
    )
)
_OBJECTS = tuple(
    MapObject(id=ident, description=name, x_m=float(at), y_m=0.0)
    for at, (ident, name) in enumerate(
        (("y", "yellow dinghy"), ("t", "tall yacht"), ("w", "port winch"), ("q", "quay"))
    )
)


def put(message: str) -> str:
    situation = Situation(
        message, objects=_OBJECTS, catalogue=_CATALOGUE, robot="Ada", robots=("Ada", "Ben"), status="idle"
    )
    return plain(plainly_put(tokens(message), Scene.of(situation)))


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("The tall yacht should be rinsed.", "rinse the tall yacht."),
        ("the port winch ought to be oiled", "oil the port winch"),
        ("the yellow dinghy could do with waxing", "wax the yellow dinghy"),
        (
            "could the tall yacht be rinsed and the yellow dinghy waxed?",
            "rinse the tall yacht and wax the yellow dinghy.",
        ),
        ("I want the tall yacht waxed", "wax the tall yacht"),
        ("make sure the port winch gets oiled", "oil the port winch"),
        ("the tall yacht is to be rinsed by Ben", "Ben, rinse the tall yacht"),
        ("it would be good if you rinsed the tall yacht", "rinse the tall yacht"),
        (
            "the tall yacht is to be rinsed, the yellow dinghy is not",
            "rinse the tall yacht, not the yellow dinghy",
        ),
        ("the yellow dinghy need not be waxed, only rinsed", "rinse the yellow dinghy"),
        ("the owner wants the tall yacht waxed by six", "wax the tall yacht by six"),
        ("the port winch should be oiled by five o'clock", "oil the port winch"),
        ("would be nice if the tall yacht was rinsed", "rinse the tall yacht"),
        ("can we have the port winch oiled?", "oil the port winch."),
        ("she would love to have the port winch oiled", "oil the port winch"),
        ("we would be ever so pleased if the tall yacht could be rinsed", "rinse the tall yacht"),
        ("I would be happier if the port winch was oiled before lunch", "oil the port winch before lunch"),
        ("could the yellow dinghy be rinsed by somebody", "rinse the yellow dinghy"),
        ("the yellow dinghy does not need waxing but the tall yacht does", "wax the tall yacht"),
        ("neither yacht has to be rinsed, but the yellow dinghy does", "rinse the yellow dinghy"),
        ("the tall yacht does need rinsing", "rinse the tall yacht"),
        ("the port winch wants seeing to", "inspect the port winch"),
        ("I want the tall yacht seen to", "inspect the tall yacht"),
        ("the yacht, the tall one, is to be rinsed", "rinse the yacht, the tall one"),
    ],
)  # fmt: skip
def test_what_is_due_or_wanted_in_the_passive_is_an_order(said: str, order: str) -> None:
    assert put(said) == order


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("it is the tall yacht I want rinsed", "rinse the tall yacht"),
        ("it is not the tall yacht I want rinsed, it is the yellow dinghy", "rinse the yellow dinghy"),
        ("it is Ben who should wax the tall yacht", "Ben, wax the tall yacht"),
        ("what I need is the port winch oiled", "oil the port winch"),
        ("where I want you is the quay", "go to the quay"),
        ("the quay is where you go next", "go to the quay next"),
        ("the one to wax is the yellow dinghy", "wax the yellow dinghy"),
        ("the tall yacht is yours to rinse", "rinse the tall yacht"),
        ("all you have to do is rinse the tall yacht", "rinse the tall yacht"),
        (
            "Look at the tall yacht. That is the one I want rinsed",
            "Look at the tall yacht. rinse the tall yacht",
        ),
    ],
)  # fmt: skip
def test_what_is_brought_to_the_fore_goes_back_to_its_place(said: str, order: str) -> None:
    assert put(said) == order


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("before the tall yacht is waxed, rinse it", "rinse the tall yacht, then wax the tall yacht"),
        (
            "rinse the tall yacht after the port winch has been oiled",
            "oil the port winch, then rinse the tall yacht",
        ),
        ("first the tall yacht is rinsed, after that it is waxed", "rinse the tall yacht, then wax it"),
        (
            "waxing the tall yacht comes after rinsing the yellow dinghy",
            "rinse the yellow dinghy, then wax the tall yacht",
        ),
        ("the tall yacht: rinse, then wax", "rinse the tall yacht, then wax the tall yacht"),
        ("a rinsing of the tall yacht, please", "rinse the tall yacht"),
    ],
)  # fmt: skip
def test_deeds_told_in_their_order_or_only_named_are_orders(said: str, order: str) -> None:
    assert put(said) == order


@pytest.mark.parametrize(
    "said",
    [
        "the tall yacht was rinsed yesterday",
        "the port winch is being oiled by Tom",
        "the tall yacht must be rinsed by Tom",
        "the yellow dinghy must not be waxed",
        "has the tall yacht been rinsed?",
        "the tall yacht should be rinsed every day",
        "if the tall yacht should be rinsed, tell me",
        "it is a pity that the quay is wet",
        "is the quay where I can moor?",
        "the owner wants to wax the tall yacht",
        "she does not want the tall yacht rinsed",
        "somebody wants the port winch, take it from wherever it was left",
        "the port winch does not need oiling",
        "I would be glad if you were a bit quicker",
    ],
)
def test_news_rules_questions_and_what_is_to_be_left_alone_stay_as_they_are(said: str) -> None:
    assert put(said) == said
