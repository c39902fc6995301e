"""What only a look answers, whom a question is answered for, and what a robot tells of by itself."""

from __future__ import annotations

import pytest

from parley.language.builtin.decision import Answer, Ask, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import CATALOGUE, action, situation

ENGINE = BuiltinLanguage()
ABLE = (
    *CATALOGUE,
    action(
        "tally", "Count the things or people of a kind that are seen and tell how many there are.", "kind"
    ),
    action("reply", "Listen to a person's question and answer it.", "question", optional=("question",)),
    action("lead", "Lead a person to a place.", "person", "place", optional=("place",)),
    action("inform", "Say a sentence, or a piece of information such as the time.", "text"),
)


def done(said: str, catalogue: tuple[ActionInfo, ...] = ABLE, memory: tuple[MemoryEntry, ...] = ()) -> str:
    """The calls that a message leads to, or how it is answered."""
    decision = ENGINE.decide(situation(said, catalogue=catalogue, memory=memory))
    if not isinstance(decision, Do):
        return type(decision).__name__
    return ", ".join(
        " ".join([deed.skill.action.name, *(str(value) for _, value in sorted(deed.arguments.items()))])
        for deed in decision.deeds
    )


@pytest.mark.parametrize(
    ("said", "deeds"),
    [
        ("How many people are in the yard?", "drive_to yard, tally people"),
        ("What is the largest item in the yard?", "look what is the largest item in the yard"),
        ("who is in the yard", "look who is in the yard"),
        ("of the people in the yard, how many are sitting?", "drive_to yard, tally people sitting"),
        ("how many people are lying in the yard?", "drive_to yard, tally people lying"),
        ("how many people in the yard are wearing hats?", "drive_to yard, tally people wearing hats"),
        ("from the yard, tell me how many people are standing", "drive_to yard, tally people standing"),
        ("reveal to me the thinnest book on the desk", "look the thinnest book on the desk"),
        (
            "scan the things on the desk and let me know which is the heaviest",
            "look which is the heaviest on the desk",
        ),
        ("let me know the pose of the person in the yard", "look the pose of the person in the yard"),
        ("the desk please, what is the biggest object", "look what is the biggest object at the desk"),
        (
            "is the person in the yard sitting or standing?",
            "look is the person in the yard sitting or standing",
        ),
        ("tell me if a man or woman is in the yard", "look a man or woman is in the yard"),
        ("go to the yard and answer Kim's question", "drive_to yard, reply"),
        ("go to the yard and tell me how many people are sitting", "drive_to yard, tally people sitting"),
        ("find someone in the yard and answer a question", "drive_to yard, search someone, reply"),
        ("answer a question for the girl in the yard", "drive_to yard, reply"),
        ("tell the man in the yard the time", "drive_to yard, inform the time"),
        ("find Kim in the yard and lead them to the desk", "drive_to yard, search Kim, lead Kim desk"),
        ("find Kim in the yard and bring him to the desk", "drive_to yard, search Kim, lead Kim desk"),
        ("bring me the stapler", "search stapler, carry stapler operator"),
        ("I'd like the stapler please", "search stapler, carry stapler operator"),
        ("fetch the stapler and put it on the desk", "search stapler, grab stapler, lay stapler desk"),
    ],
)
def test_what_is_asked_for_is_seen_met_and_told(said: str, deeds: str) -> None:
    assert done(said) == deeds


@pytest.mark.parametrize(
    "said",
    [
        "who owns the yard",
        "how many people were in the yard yesterday",
        "where is the largest item in the yard",
        "who told you to go to the yard",
        "how far is the yard",
        "how many people live in the yard",
        "never mind",
        "how many people are in the yard? Bring them tea",
        "clear the yard",
        "name the tallest thing in the yard and bring it here",
    ],
)
def test_a_question_about_anything_else_moves_nothing(said: str) -> None:
    assert done(said) in (Answer.__name__, Ask.__name__)


def test_what_was_told_of_a_place_is_answered_and_not_looked_at() -> None:
    told = (MemoryEntry(name="kim_location", data="Kim is in the yard"),)
    assert done("who is in the yard", memory=told) == Answer.__name__


def test_a_name_that_may_be_a_thing_is_asked_about_and_what_cannot_be_told_is_not_read_out() -> None:
    assert done("bring Tobi to the yard") == Ask.__name__
    plain = tuple(one for one in ABLE if one.name != "inform")
    assert done("tell the man in the yard the time", plain) == Ask.__name__


def test_a_room_is_gone_to_and_who_cannot_count_looks() -> None:
    able = tuple(one for one in ABLE if one.name != "tally")
    rooms = (MapObject("hall", "hall", 3.0, 3.0),)
    decision = ENGINE.decide(situation("how many people are in the hall?", catalogue=able, rooms=rooms))
    assert isinstance(decision, Do)
    assert [deed.skill.action.name for deed in decision.deeds] == ["drive_to", "look"]


def test_a_question_to_another_robot_moves_that_one_and_not_who_hears_it() -> None:
    asked = situation("Bo, how many people are in the yard?", catalogue=ABLE, robots=("Ada", "Bo"))
    decision = ENGINE.decide(asked)
    assert isinstance(decision, Do) and decision.robots == ("Bo",)
