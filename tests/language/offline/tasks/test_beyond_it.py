"""What a robot that drives and looks cannot do is refused, and what is only told is done or kept."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="pen_4", description="pen 4", x_m=2.0, y_m=0.0, class_name="pen"),
    MapObject(id="pen_5", description="pen 5", x_m=5.0, y_m=0.0, class_name="pen"),
    MapObject(id="loft", description="hay loft", x_m=9.0, y_m=0.0, class_name="loft"),
    MapObject(id="shop", description="farm shop", x_m=9.0, y_m=5.0, class_name="shop"),
)
MEMORY = (
    MemoryEntry(name="rosa", data="Rosa is in the farm shop", source="operator"),
    MemoryEntry(name="cup", data="The golden cup is for Rosa", source="operator"),
)
FEEDER = (
    ActionInfo(name="go_to", inputs={"place": "string"}),
    ActionInfo(name="feed", inputs={"pen": "string"}, description="Feed what lives in a pen."),
)


async def told(message: str, catalogue: str = "location", own: tuple[ActionInfo, ...] = ()) -> ChatAction:
    return await OfflineLanguage().interpret(
        Situation(message, objects=MAP, memory=MEMORY, catalogue=own or CATALOGUES[catalogue])
    )


@pytest.mark.parametrize(
    "said",
    [
        "Replace the light switch in the hay loft",
        "Read Rosa a poem",
        "Read the paper to Rosa",
        "Put more straw in pen 5",
        "Give the goat in pen 4 an injection",
    ],
)
async def test_what_needs_hands_is_refused(said: str) -> None:
    action = await told(said)
    assert not action.queue
    assert action.message_response.startswith(f"I cannot {said[:1].lower()}{said[1:]}")


@pytest.mark.parametrize(
    ("said", "seen"),
    [
        ("Read the sign in the hay loft", "sign"),
        ("I want to know if the fork is within reach in the hay loft, have a look", "fork"),
        ("I can't see the hay loft from here, does it have enough straw?", "straw"),
        ("there's a sack nobody owns in the hay loft", "'sack'"),
        ("There is a sack that belongs to nobody in the hay loft", "'sack'"),
        ("I was in the hay loft and I think I left the tap running. Could you check that?", "'tap'"),
        ("There is someone in the hay loft who nobody knows", "'someone'"),
        ("do we still have any straw in the hay loft?", "straw"),
    ],
)
async def test_what_is_told_of_a_place_is_looked_at_there(said: str, seen: str) -> None:
    steps = [str([p.value for p in step.input_parameters.values()]) for step in (await told(said)).queue]
    assert any("hay loft" in step for step in steps)
    assert seen in steps[-1]


async def test_a_robot_without_a_look_of_its_own_looks_for_what_we_still_have() -> None:
    action = await told("have a look if we still have forks in the hay loft", "primitives")
    assert [step.name for step in action.queue] == ["move_to", "look_for_obj"]


async def test_who_gets_something_is_remembered() -> None:
    action = await told("Drive to the person who gets the golden cup")
    assert "farm shop" in str(action.queue)


@pytest.mark.parametrize("lead", ["Rosa should know that", "Rosa has to know that", "Let Rosa know that"])
async def test_what_somebody_should_know_is_said_to_them(lead: str) -> None:
    action = await told(f"{lead} the hay is here", "primitives")
    assert [step.name for step in action.queue] == ["move_to", "speak"]
    assert not action.system_cmd


async def test_somebody_at_a_place_is_sought_and_told() -> None:
    action = await told("The man at pen 4 should know that his van blocks the way", "primitives")
    assert [step.name for step in action.queue] == ["move_to", "look_for_person", "speak"]


async def test_what_is_fed_at_noon_as_a_rule_is_not_fed_now() -> None:
    action = await told("Pen 4 gets fed at noon", own=FEEDER)
    assert not action.queue
    assert action.system_cmd[0].arguments["data"] == "Pen 4 is fed at noon"
    assert (await told("Pen 4 should get fed at noon", own=FEEDER)).queue


async def test_the_news_that_explains_another_is_not_kept_besides() -> None:
    action = await told("Rosa has changed rooms, she's in the hay loft now.")
    assert [command.arguments["data"] for command in action.system_cmd] == ["Rosa is in the hay loft now"]
