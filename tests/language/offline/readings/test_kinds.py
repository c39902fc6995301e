"""Orders that are only told, complaints, news and what is usual are told apart."""

from __future__ import annotations

import pytest

from parley.evaluation.steps import read_steps
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.messages.chat import ChatAction
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=name, description=said, x_m=x_m, y_m=0.0, class_name=kind)
    for name, said, kind, x_m in (
        ("north", "north bin", "bin", 2.0),
        ("south", "south bin", "bin", 4.0),
        ("hall", "entrance hall", "room", 6.0),
        ("gate", "garden gate", "gate", 9.0),
    )
)
CATALOGUE = (
    ActionInfo(name="drive_to", inputs={"place": "string"}, description="Drive to a place."),
    ActionInfo(name="look_at", inputs={"thing": "string"}, description="Look at something."),
    ActionInfo(name="empty_bin", inputs={"bin": "string"}, description="Empty a bin."),
    ActionInfo(name="mop_floor", inputs={"area": "string"}, description="Mop the floor of an area."),
    ActionInfo(name="close_gate", inputs={"gate": "string"}, description="Close a gate."),
)


async def understood(message: str) -> ChatAction:
    return await OfflineLanguage().interpret(Situation(message=message, objects=MAP, catalogue=CATALOGUE))


async def steps(message: str) -> list[str]:
    action = await understood(message)
    return [str(step) for step in read_steps(action.queue, CATALOGUE)]


@pytest.mark.parametrize(
    ("message", "plan"),
    [
        ("nobody has emptied the north bin since Monday", ["empty_bin ['north bin']"]),
        ("we forgot to empty the south bin", ["empty_bin ['south bin']"]),
        ("the north bin is overflowing", ["empty_bin ['north bin']"]),
        ("both bins are full to the top", ["empty_bin ['north bin']", "empty_bin ['south bin']"]),
        ("the entrance hall is filthy, see to it", ["mop_floor ['entrance hall']"]),
        ("somebody left the garden gate open", ["close_gate ['garden gate']"]),
    ],
)
async def test_what_is_told_is_done_where_the_robot_has_the_deed(message: str, plan: list[str]) -> None:
    assert await steps(message) == plan


@pytest.mark.parametrize(
    "message",
    [
        "the north bin has been emptied",
        "Tom emptied the north bin this morning",
        "the south bin is emptied every Friday",
        "the garden gate must stay closed at night",
        "Our caretaker retires next year",
        "remember that letters always go to the entrance hall",
        "note that the north bin has to be painted in May",
    ],
)
async def test_news_rules_and_what_is_only_told_are_understood_and_ask_for_nothing(message: str) -> None:
    action = await understood(message)

    assert not action.queue
    assert "not sure what you mean" not in action.message_response


async def test_only_stays_in_what_is_remembered() -> None:
    action = await understood("Only Tom may use the entrance hall")

    assert [command.arguments["data"] for command in action.system_cmd] == [
        "Only Tom may use the entrance hall"
    ]
