"""What one robot of a team has found is what others look for; what else they are to do stays."""

from __future__ import annotations

import pytest

from parley.gate.evidence import speaks_of_searching
from parley.messages.chat import ActionCall, Flow
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo, PlanStep
from parley.team.finds import is_that, needless, sought

CATALOGUE = (
    ActionInfo(name="Where", inputs={"target": "string"}, effects=("locates",)),
    ActionInfo(name="Go", inputs={"x": "number"}, effects=("moves",)),
    ActionInfo(name="Look", inputs={"what": "string"}, effects=("looks",)),
    ActionInfo(name="Wash", inputs={}, effects=("touches",)),
)


def at(place: str, *deeds: ActionCall, state: str = "queued") -> list[PlanStep]:
    where = ActionCall(name="Where", input_parameters={"target": Parameter("string", place)})
    calls = (where, ActionCall(name="Go"), *deeds)
    return [PlanStep.model_validate({"action": call, "state": state, "id": place}) for call in calls]


def look(what: str) -> ActionCall:
    return ActionCall(name="Look", input_parameters={"what": Parameter("string", what)})


@pytest.mark.parametrize(
    ("found", "wanted", "same"),
    [
        ("red_crate", "the red crate", True),
        ("crate 2", "red crate", True),
        ("blue_crate", "red crate", False),
        ("box", "all boxes", False),
        ("valve", "valve in room 1", False),
        ("", "box", False),
    ],
)
def test_what_was_found_is_what_was_wanted(found: str, wanted: str, same: bool) -> None:
    assert is_that(found, wanted) is same


def test_only_what_leads_to_looks_for_the_same_is_needless() -> None:
    steps = [
        *at("hall", look("toolbox"), state="finished"),
        *at("yard", look("toolbox"), state="running"),
        *at("shed", look("the red toolbox")),
        *at("gate", look("ladder")),
        *at("shop", look("toolbox"), ActionCall(name="Wash")),
        *at("lab", look("toolbox"), ActionCall(name="Unknown")),
        *at("toolbox", look("toolbox")),
        *at("dock"),
    ]
    assert [step.id for step in needless(steps, CATALOGUE, "toolbox")] == ["yard"] * 3 + ["shed"] * 3
    assert needless([], CATALOGUE, "toolbox") == []


def test_what_depends_on_something_is_left_as_it_is() -> None:
    steps = at("yard", look("toolbox"))
    steps[2] = steps[2].model_copy(
        update={"action": steps[2].action.model_copy(update={"flow": Flow(repeat=2)})}
    )
    assert [step.id for step in needless(steps, CATALOGUE, "toolbox")] == ["yard"] * 3
    more = [*steps, *at("gate", ActionCall(name="Wash"))]
    assert needless(more, CATALOGUE, "toolbox") == [], "nobody can tell here which steps belong together"


def test_only_a_look_looks() -> None:
    assert (sought(look("box"), CATALOGUE), sought(ActionCall(name="Wash"), CATALOGUE)) == ("box", "")


@pytest.mark.parametrize(
    ("words", "searches"),
    [
        ("Leo, look for the crate in Area A. Spot, look for it in Area C.", True),
        ("find the key, split between you", True),
        ("otsige võtit", True),
        ("check the valve in both rooms", False),
        ("look at the pump", False),
    ],
)
def test_a_search_is_over_when_it_is_found_and_a_check_is_not(words: str, searches: bool) -> None:
    assert speaks_of_searching(words) is searches
