"""Actions that fit no frame: meant by what their maker says, filled by kind, asked about when in doubt."""

from __future__ import annotations

import random

import pytest

from parley.language.builtin.decision import Ask, Decision, Do, Remember
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.answers import abilities
from parley.messages.status import ActionInfo, ParameterInfo
from tests.language.builtin.worlds import CATALOGUE, situation

ENGINE = BuiltinLanguage()

TRADE = (
    ActionInfo(name="a", inputs={"part": "string"}, description="Weld a part to the frame."),
    ActionInfo(name="b", inputs={"times": "number"}, optional=("times",), description="Sound the horn."),
    ActionInfo(name="c", inputs={"kg": "number", "pen": "string"}, description="Dispense feed into a pen."),
    ActionInfo(name="d", inputs={"mode": "string"}, description="Set the fan; mode is low, middle or full."),
    ActionInfo(name="e", inputs={"ballot": "string"}, description="Vote for a ballot."),
    ActionInfo(name="f", inputs={"minutes": "number"}, description="Sterilise the chamber for some minutes."),
    ActionInfo(
        name="g",
        inputs={"depth": "number"},
        parameters={"depth": ParameterInfo(kind="distance", unit="millimetres")},
        description="Drill a hole.",
    ),
    ActionInfo(name="h", description="End the shift.", phrases=("call it a day",)),
    ActionInfo(
        name="i",
        inputs={"entry": "string"},
        parameters={"entry": ParameterInfo(kind="text")},
        description="Write into the log.",
        phrases=("log that {entry}",),
    ),
)
MEANT = {
    "weld the bracket": ("a", {"part": "bracket"}),
    "sound the horn": ("b", {}),
    "please sound the horn three times": ("b", {"times": 3.0}),
    "sound the horn twice, please": ("b", {"times": 2.0}),
    "dispense 500 grams of feed into pen 4": ("c", {"kg": 0.5, "pen": "pen 4"}),
    "set the fan to full": ("d", {"mode": "full"}),
    "sterilise the chamber for half an hour": ("f", {"minutes": 30.0}),
    "drill a hole 2 cm deep": ("g", {"depth": 20.0}),
    "please call it a day": ("h", {}),
    "log that the pump leaks": ("i", {"entry": "the pump leaks"}),
}
NOT_MEANT = (
    "weld it", "don't sound the horn", "set the fan to medium", "dispense 500 litres of feed into pen 4",
    "sterilise the chamber", "weld every part", "drill a hole in the desk", "vote for what Kim likes",
    "weld the bracket unless it rains", "honk", "sterilise the chamber for three metres",
    "don't call it a day", "will Kim call it a day?",
)  # fmt: skip


def decide(message: str, catalogue: tuple[ActionInfo, ...] = TRADE) -> Decision:
    return ENGINE.decide(situation(message, catalogue=(*CATALOGUE, *catalogue)))


def done(decision: Decision) -> list[tuple[str, dict[str, object]]]:
    deeds = decision.deeds if isinstance(decision, Do) else ()
    return [(deed.skill.action.name, dict(deed.arguments)) for deed in deeds]


@pytest.mark.parametrize("message", MEANT)
def test_an_order_is_an_action_of_the_robots_own(message: str) -> None:
    assert done(decide(message)) == [MEANT[message]]


@pytest.mark.parametrize("message", NOT_MEANT)
def test_what_fits_no_action_whole_is_not_done(message: str) -> None:
    assert not done(decide(message))


def test_names_decide_nothing() -> None:
    order = random.Random(7)
    other = {info.name: "".join(order.choices("bcdfghjkl", k=8)) for info in TRADE}
    renamed = tuple(info.model_copy(update={"name": other[info.name]}) for info in TRADE)
    for message in (*MEANT, *NOT_MEANT):
        plain = [(other[name], given) for name, given in done(decide(message))]
        assert done(decide(message, renamed)) == plain, message


def test_what_is_not_certain_is_offered_in_the_makers_words() -> None:
    decision = decide("blow the horn")
    assert isinstance(decision, Ask)
    assert "sound the horn" in decision.question
    assert done(Do(decision.offer)) == [("b", {})]
    assert done(decide(decision.choices[0])) == [("b", {})]


def test_what_is_done_is_said_with_one_article() -> None:
    water = ActionInfo(name="j", inputs={"thing": "string"}, phrases=("water the {thing}",))
    decision = decide("water the desk", (water,))
    assert isinstance(decision, Do)
    assert decision.deeds[0].text == "water the desk"


@pytest.mark.parametrize(
    "message", ["remember that the red box is full", "please remember that the gate is open, ok"]
)
def test_what_is_to_be_remembered_is_no_picture(message: str) -> None:
    keep = ActionInfo(
        name="k", description="Remember what is in front.", phrases=("remember this view", "keep the picture")
    )
    assert isinstance(decide(message, (keep,)), Remember)
    assert done(decide("remember this view", (keep,))) == [("k", {})]


NAMED = (
    ActionInfo(name="eject_tip"),
    ActionInfo(name="open_gate", inputs={"gate": "string"}),
    ActionInfo(name="drive_to", inputs={"place": "string"}),
    ActionInfo(name="grasp", inputs={"item": "string"}),
    ActionInfo(name="inspect", inputs={"thing": "string"}),
)


@pytest.mark.parametrize(
    ("message", "wanted"),
    [
        ("eject the tip", [("eject_tip", {})]),
        ("open the front gate", [("open_gate", {"gate": "front gate"})]),
        ("grasp the pump", [("drive_to", {"place": "pump"}), ("grasp", {"item": "pump"})]),
        ("check the pump", [("drive_to", {"place": "pump"}), ("inspect", {"thing": "pump"})]),
        ("eject it", []),
        ("reject the tip", []),
    ],
)
def test_an_action_of_which_only_the_name_is_known_is_done_where_all_of_its_name_is_said(
    message: str, wanted: list[tuple[str, dict[str, object]]]
) -> None:
    assert done(decide(message, NAMED)) == wanted


@pytest.mark.parametrize(
    ("message", "wanted"),
    [
        ("honk the horn twice", ["honk", "honk"]),
        ("go to the pump and honk the horn twice", ["drive_to", "honk", "honk"]),
        ("go to the pump and take a picture three times", ["drive_to", "snap", "snap", "snap"]),
    ],
)
def test_how_often_counts_for_what_is_done_there_and_for_no_way(message: str, wanted: list[str]) -> None:
    honk = ActionInfo(name="honk", description="Honk the horn.")
    decision = ENGINE.decide(situation(message, catalogue=(*CATALOGUE, honk)))
    assert [name for name, _ in done(decision)] == wanted


def test_no_place_is_given_to_an_input_that_takes_a_number() -> None:
    numbered = (
        ActionInfo(name="a", inputs={"x": "number"}, description="Drive to a place.", effects=("moves",)),
        ActionInfo(name="b", inputs={"what": "string"}, description="Look at a thing.", effects=("looks",)),
    )
    assert done(ENGINE.decide(situation("look at the pump", catalogue=numbered))) == [("b", {"what": "pump"})]
    assert not done(ENGINE.decide(situation("go to the pump", catalogue=numbered)))


def test_the_very_words_of_an_action_mean_it_whatever_words_they_are() -> None:
    catalogue = (
        ActionInfo(
            name="shine", description="Make the hall shine.", phrases=("sweep and then polish the hall",)
        ),
        ActionInfo(name="rounds", description="Walk around.", phrases=("patrol without a break",)),
    )
    for info in catalogue:
        decision = ENGINE.decide(situation(info.phrases[0], catalogue=catalogue))
        assert isinstance(decision, Do)
        assert [deed.skill.action.name for deed in decision.deeds] == [info.name]


def test_what_only_programs_ask_for_is_not_told_as_something_to_ask_for() -> None:
    told = {"order": ParameterInfo(kind="id")}
    wait = ActionInfo(name="l", inputs={"order": "string"}, parameters=told, description="Meet a mate.")
    assert "meet a mate" not in abilities((wait, *TRADE))
    assert "sound the horn" in abilities((wait, *TRADE))
    assert not done(decide("meet a mate", (wait,)))
