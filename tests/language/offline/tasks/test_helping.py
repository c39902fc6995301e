"""What helps with what is only complained of, wanted or missed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.helping import helping
from parley.language.offline.words.text import tokens
from parley.messages.status import ActionInfo

CATALOGUE = (
    ActionInfo(name="radiatorUp", inputs={"room": "string"}, description="Warm a room."),
    ActionInfo(name="summon_doctor", inputs={"cabin": "string"}, description="Send for a doctor."),
    ActionInfo(name="hush_speakers", description="Silence the speakers."),
    ActionInfo(name="pour", inputs={"drink": "string"}, description="Pour a drink: cider, water or tea."),
    ActionInfo(name="shear_sheep", inputs={"pen": "string"}, description="Shear the sheep of a pen."),
    ActionInfo(name="setDimmer", inputs={"lamp": "string", "percent": "number"}, description="Set a light."),
)


LODGING = (
    ActionInfo(name="change_sheets", inputs={"cabin": "string"}, description="Put new sheets on the beds."),
    ActionInfo(name="restockFridge", inputs={"cabin": "string"}, description="Fill up the fridge."),
    ActionInfo(name="wipe_slate", inputs={"cabin": "string"}, description="Clean the slate in a cabin."),
    ActionInfo(name="fillTank", inputs={"cabin": "string"}, description="Fill the tank with water."),
    ActionInfo(
        name="check_tank",
        inputs={"cabin": "string"},
        outputs={"level": "number"},
        description="Look how much water is in the tank of a cabin, for washing and to drink.",
    ),
)


@pytest.mark.parametrize(
    ("message", "action"),
    [
        ("the couple in cabin 4 have no sheets left", "change_sheets"),
        ("the sheets in cabin 4 are all damp", "change_sheets"),
        ("they have nothing left in the fridge of cabin 4", "restockFridge"),
        ("the slate in cabin 4 is full of scrawl", "wipe_slate"),
        ("the people in cabin 4 are thirsty", "fillTank"),
    ],
)
def test_what_is_used_up_or_spoilt_is_seen_to_by_what_is_called_so(message: str, action: str) -> None:
    found = helping(tokens(message), Scene.of(replace(situation(message), catalogue=LODGING)))
    assert found is not None
    assert (found.info.name, *found.filled.values.values()) == (action, "cabin 4")


def situation(message: str) -> Situation:
    return Situation(message=message, catalogue=CATALOGUE, robot="Bo", robots=("Bo",))


def helps(message: str) -> tuple[object, ...] | None:
    found = helping(tokens(message), Scene.of(situation(message)))
    return None if found is None else (found.info.name, *found.filled.values.values())


@pytest.mark.parametrize(
    ("message", "action"),
    [
        ("we are all shivering in the library", ("radiatorUp", "library")),
        ("The man in cabin 9 has collapsed!", ("summon_doctor", "cabin 9")),
        ("it is so loud, nobody can hear a word", ("hush_speakers",)),
        ("A glass of cider would be lovely.", ("pour", "cider")),
        ("nobody has shorn the sheep in the lower pen yet", ("shear_sheep", "lower pen")),
    ],
)
def test_a_remedy_is_found_by_its_words_and_needs_its_inputs(
    message: str, action: tuple[object, ...]
) -> None:
    assert helps(message) == action


@pytest.mark.parametrize(
    "message",
    [
        "The library is on the second floor",
        "it is cold",
        "my sister is a doctor",
        "The pen is next to the barn",
    ],
)
def test_what_needs_no_help_or_says_too_little_gets_none(message: str) -> None:
    assert helps(message) is None


def test_help_comes_only_where_nothing_is_asked_for() -> None:
    action, _ = OfflineLanguage().explain(situation("It is freezing in the library, but just pour me a tea."))
    assert [step.name for step in action.queue] == ["pour"]


ALARM = ActionInfo(name="fireAlarm", inputs={"floor": "string"}, description="Sound the alarm on a floor.")


async def test_an_alarm_is_asked_about_where_it_is_only_told_and_given_once_agreed() -> None:
    told = Situation(message="there are flames on floor 3", catalogue=(ALARM,), robot="Bo", robots=("Bo",))
    engine = OfflineLanguage()
    asked = await engine.interpret(told)
    assert not asked.queue
    assert "Shall I sound the alarm" in asked.message_response
    history = (
        Turn(role="operator", content=told.message),
        Turn(role="assistant", content=asked.message_response),
    )
    agreed = await engine.interpret(replace(told, message="yes", history=history))
    assert [step.name for step in agreed.queue] == ["fireAlarm"]
    ordered = await engine.interpret(replace(told, message="sound the alarm on floor 3"))
    assert [step.name for step in ordered.queue] == ["fireAlarm"]
