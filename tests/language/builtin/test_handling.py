"""What a robot with hands does by actions of which only names are known; and nothing named is lost."""

from __future__ import annotations

import pytest

from parley.language.builtin.decision import Ask, Do, Remember
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from tests.language.builtin.worlds import CATALOGUE, situation

ENGINE = BuiltinLanguage()


def _named(name: str, *inputs: str) -> ActionInfo:
    return ActionInfo(name=name, inputs=dict.fromkeys(inputs, "string"))


HANDS = (
    _named("drive_to", "place"),
    _named("find_obj", "object"),
    _named("find_person", "person"),
    _named("grasp", "object"),
    _named("pass_to", "object", "person"),
    _named("put_down", "object", "place"),
    _named("follow", "person"),
    _named("say", "text"),
)
LOOKING = (CATALOGUE[0], ActionInfo(name="view", inputs={"what": "string"}, effects=("looks",)))
IN_MIND = (MemoryEntry(name="kim_location", data="Kim is in the office"),)
PLANS = {
    "find the hammer in the office": "drive_to office, find_obj hammer",
    "find the man in the yard": "drive_to yard, find_person man",
    "bring Kim the hammer from the yard": "drive_to yard, find_obj hammer, grasp hammer, drive_to office, "
    "pass_to hammer Kim",
    "take the hammer from the yard and give it to Kim": "drive_to yard, grasp hammer, drive_to office, "
    "pass_to hammer Kim",
    "go to the yard, find the hammer and bring it to me": "drive_to yard, find_obj hammer, grasp hammer, "
    "pass_to hammer operator",
    "fetch the hammer from the yard and hand it to Kim": "drive_to yard, find_obj hammer, grasp hammer, "
    "drive_to office, pass_to hammer Kim",
    "give the hammer to Kim": "find_obj hammer, grasp hammer, drive_to office, pass_to hammer Kim",
    "take the hammer, go to the yard and put it on the desk": "find_obj hammer, grasp hammer, drive_to yard, "
    "drive_to desk, put_down hammer desk",
    "go to the woman in the yard and follow her": "drive_to yard, find_person woman, follow woman",
    "find and follow the woman": "find_person woman, follow woman",
    "meet Kim in the yard and follow him": "drive_to yard, find_person Kim, follow Kim",
    "take the hammer from the yard and give it to Kim by the desk": "drive_to yard, grasp hammer, "
    "drive_to desk, pass_to hammer Kim",
    "follow the woman in the yard": "drive_to yard, find_person woman, follow woman",
    "say hello to Bo in the yard": "drive_to yard, say hello",
}


@pytest.mark.parametrize("said", PLANS)
def test_with_hands_of_its_own_a_robot_fetches_finds_and_hands_over(said: str) -> None:
    decision = ENGINE.decide(situation(said, catalogue=HANDS, memory=IN_MIND))
    assert isinstance(decision, Do), decision
    done = [" ".join([deed.skill.action.name, *map(str, deed.arguments.values())]) for deed in decision.deeds]
    assert ", ".join(done) == PLANS[said]


@pytest.mark.parametrize("said", ["give it to Kim", "bring the yard to the yard", "put it on the desk"])
def test_what_it_does_not_hold_and_cannot_find_it_does_not_hand_over(said: str) -> None:
    before = situation(said, catalogue=HANDS, memory=IN_MIND, history=())
    assert isinstance(ENGINE.decide(before), Ask)


def test_to_ask_the_operator_is_an_action_by_its_name() -> None:
    asking = (_named("drive_to", "place"), _named("look_at", "thing"), _named("AskOperator", "question"))
    decision = ENGINE.decide(situation("bring the red box to the office", catalogue=asking))
    assert isinstance(decision, Do)
    assert "AskOperator" in [deed.skill.action.name for deed in decision.deeds]


@pytest.mark.parametrize("said", ["go to the office the yard and the ramp", "inspect office yard ramp"])
def test_of_what_an_order_names_nothing_is_lost(said: str) -> None:
    decision = ENGINE.decide(situation(said))
    lost = isinstance(decision, Do) and not all(
        any(name in deed.arguments.values() for deed in decision.deeds) for name in ("office", "yard", "ramp")
    )
    assert not lost, decision


@pytest.mark.parametrize("said", ["make sure nobody is in the office", "see how the pump is doing"])
def test_how_something_is_is_seen_where_it_is(said: str) -> None:
    decision = ENGINE.decide(situation(said, catalogue=LOOKING))
    assert isinstance(decision, Do)
    assert decision.deeds[0].frame == "GO"


def test_one_look_tells_two_things_of_the_same_place() -> None:
    decision = ENGINE.decide(situation("check the pump and see whether the valve is shut", catalogue=LOOKING))
    assert isinstance(decision, Do)
    looks = [deed for deed in decision.deeds if deed.frame == "LOOK"]
    assert len(looks) == 1
    assert {"pump", "valve"} <= {*" ".join(map(str, looks[0].arguments.values())).split()}


def test_where_somebody_is_now_is_what_is_remembered() -> None:
    decision = ENGINE.decide(situation("Kim isn't in the office any more, she is in the yard"))
    assert isinstance(decision, Remember)
    assert [fact.text for fact in decision.told] == ["Kim is in the yard"]


def test_what_belongs_to_somebody_is_not_where_they_are() -> None:
    assert isinstance(ENGINE.decide(situation("go to Kim's car", memory=IN_MIND)), Ask)
