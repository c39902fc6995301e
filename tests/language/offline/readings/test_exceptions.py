"""What is to be left out, and nobody knows what that is: asked about, never done."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

OBJECTS = tuple(
    MapObject(id=f"hall_{i}", description=f"hall {i}", class_name="hall", x_m=4.0 * i, y_m=0.0)
    for i in (1, 2, 3)
)
CATALOGUE = (
    ActionInfo(name="GoTo", inputs={"place": "string"}, effects=("moves",), description="Drive to a place"),
)


async def answer(message: str, *history: Turn) -> tuple[str, list[str]]:
    situation = Situation(message=message, objects=OBJECTS, catalogue=CATALOGUE, history=history)
    action = await OfflineLanguage().interpret(situation)
    places = [str(p.value) for step in action.queue for p in step.input_parameters.values()]
    return action.message_response, places


@pytest.mark.parametrize(
    "message",
    [
        "go to all halls but the one with the piano",
        "go to every hall except the one where the band plays",
        "go to all the halls apart from the one that was flooded",
    ],
)
async def test_an_exception_that_nothing_tells_is_asked_about(message: str) -> None:
    reply, places = await answer(message)
    assert places == []
    assert "Which one should I leave out?" in reply


async def test_the_answer_is_left_out() -> None:
    asked = "go to all halls but the one with the piano"
    reply, _ = await answer(asked)
    _, places = await answer("hall 2", Turn("operator", asked), Turn("assistant", reply))
    assert places == ["hall 1", "hall 3"]


async def test_so_many_of_more_are_asked_about_and_the_answer_is_done() -> None:
    reply, places = await answer("go to both halls")
    assert places == []
    assert "Which do you mean" in reply
    asked = (Turn("operator", "go to both halls"), Turn("assistant", reply))
    assert (await answer("hall 1 and hall 3", *asked))[1] == ["hall 1", "hall 3"]
    assert (await answer("2 and 3", *asked))[1] == ["hall 2", "hall 3"]


@pytest.mark.parametrize("message", ["do not go to any hall but hall 2", "go nowhere except hall 2"])
async def test_nothing_but_one_is_that_one(message: str) -> None:
    assert (await answer(message))[1] == ["hall 2"]


async def test_an_exception_by_its_name_is_no_question() -> None:
    assert (await answer("go to all halls but hall 3"))[1] == ["hall 1", "hall 2"]


async def test_nobody_elses_thing_is_taken() -> None:
    memory = (MemoryEntry(name="bag", data="Mr Hill's bag is in hall 1"),)
    carrier = (*CATALOGUE, ActionInfo(name="PickUp", inputs={"item": "string"}, effects=("holds",)))
    situation = Situation(
        message="take Mrs Kay's bag to hall 2", objects=OBJECTS, catalogue=carrier, memory=memory
    )
    action = await OfflineLanguage().interpret(situation)
    assert action.queue == ()


async def test_an_answer_that_leaves_one_out_is_done_for_the_others() -> None:
    history = (Turn("operator", "go to the halls"), Turn("assistant", "Which halls do you mean?"))
    assert (await answer("all but hall 2", *history))[1] == ["hall 1", "hall 3"]


async def test_an_order_with_an_exception_is_no_answer_to_a_question() -> None:
    history = (Turn("operator", "go to the halls"), Turn("assistant", "Which halls do you mean?"))
    reply, places = await answer("go to all halls except the one Bob is in", *history)
    assert places == []
    assert "?" in reply
