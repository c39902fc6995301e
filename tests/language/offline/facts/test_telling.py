"""What of the things people tell is kept, and as what."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.messages.chat import ChatAction
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="hall_1", description="hall", x_m=1.0, y_m=1.0, class_name="room"),
    MapObject(id="yard_1", description="yard", x_m=5.0, y_m=1.0, class_name="yard"),
    MapObject(id="shelf_1", description="shelf", x_m=3.0, y_m=4.0, class_name="shelf"),
)


async def heard(message: str) -> ChatAction:
    return await OfflineLanguage().interpret(
        Situation(message=message, objects=MAP, catalogue=CATALOGUES["thesis"])
    )


def kept(action: ChatAction) -> list[str]:
    return [str(c.arguments.get("data")) for c in action.system_cmd if c.command == "add_memory"]


@pytest.mark.parametrize(
    "said",
    [
        "my back is killing me today",
        "I have been on my feet since six",
        "I am so tired",
        "tomorrow I will paint the hall",
        "the kids were so loud today",
        "the food here is awful, isn't it",
        "it is eight o'clock",
    ],
)
async def test_moods_plans_and_complaints_are_not_kept(said: str) -> None:
    action = await heard(said)
    assert kept(action) == []
    assert not action.queue


@pytest.mark.parametrize(
    ("said", "fact"),
    [
        (
            "We have two places to watch: the hall and the yard.",
            "We have two places to watch: the hall and the yard",
        ),
        ("From now on old paper goes to the yard.", "From now on old paper goes to the yard"),
        ("Ben gave the ladder to Ada", "Ben gave the ladder to Ada"),
        ("the ladder, that is mine", "The ladder is mine"),
    ],
)
async def test_lists_rules_and_gifts_are_kept_as_they_are_said(said: str, fact: str) -> None:
    action = await heard(said)
    assert kept(action) == [fact]
    assert not action.queue


async def test_facts_are_put_together_over_the_ends_of_lines() -> None:
    action = await heard("the ladder\nis in the yard\nthe saw\nis in the hall")
    assert kept(action) == ["The ladder is in the yard", "The saw is in the hall"]


async def test_what_a_message_lists_can_be_meant_by_its_orders() -> None:
    action = await heard("These are my places: the hall and the yard. Go to each of them.")
    values = [str(p.value) for step in action.queue for p in step.input_parameters.values() if p.has_data]
    assert values == ["hall", "yard"]


async def test_where_things_are_said_behind_an_order_is_known_for_it() -> None:
    action = await heard("bring Ada some tea, it's on the shelf and she is in the yard")
    values = [str(p.value) for step in action.queue for p in step.input_parameters.values() if p.has_data]
    assert values[0] == "shelf"
    assert values[-1] == "yard"
