"""What is pending is given up for something else: "forget it, go to the sink"."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps, write_calls
from parley.language.base import Situation, Turn
from parley.language.offline.engine import OfflineLanguage
from parley.language.situations import read_situation
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

CATALOGUE = CATALOGUES["thesis"]
MAP = (
    MapObject(id="sink", description="sink", x_m=1.0, y_m=2.0, class_name="sink"),
    MapObject(id="kiln", description="kiln", x_m=5.0, y_m=2.0, class_name="kiln"),
)
MEMORY = (MemoryEntry(name="glaze", data="The glaze is in the sink"),)


async def said(message: str, *pending: str, history: tuple[Turn, ...] = ()) -> ChatAction:
    read = read_situation({"message": message, "queue": write_calls(pending, {}, CATALOGUE)}, CATALOGUE)
    assert isinstance(read, Situation)
    situation = Situation(
        message=message, objects=MAP, memory=MEMORY, catalogue=CATALOGUE, queue=read.queue,
        status="running" if read.queue else "idle", history=history,
    )  # fmt: skip
    return await OfflineLanguage().interpret(situation)


@pytest.mark.parametrize("lead", ["Forget it,", "Forget that.", "Scrap that,", "Cancel everything,"])
async def test_an_order_behind_it_takes_the_place_of_all_that_is_pending(lead: str) -> None:
    answer = await said(f"{lead} go to the sink.", "go kiln", "look kiln")
    assert [command.command for command in answer.system_cmd] == ["clear"]
    assert [str(step) for step in read_steps(answer.queue, CATALOGUE)] == ["go ['sink']"]


@pytest.mark.parametrize("message", ["Forget it, but go to the sink first", "Forget that, it was wrong"])
async def test_nothing_is_cancelled_where_more_is_said_of_it(message: str) -> None:
    answer = await said(message, "go kiln")
    assert "clear" not in [command.command for command in answer.system_cmd]


async def test_what_was_kept_just_now_is_what_is_to_be_forgotten() -> None:
    history = (Turn("operator", "The glaze is in the sink"), Turn("assistant", "I will remember that it is."))
    answer = await said("Forget that. Go to the kiln.", "go sink", history=history)
    assert [command.command for command in answer.system_cmd] == ["remove_memory"]
