"""Questions about how things are now are looked at; what nobody sees there is answered or offered."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.to_be_seen import sees
from parley.language.offline.engine import OfflineLanguage
from parley.language.offline.tasks.catalogue import Catalogue
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=name, description=said, x_m=x_m, y_m=y_m, class_name=kind)
    for name, said, kind, x_m, y_m in (
        ("kiln", "kiln", "kiln", 2.0, 3.0),
        ("sink", "sink", "sink", 6.0, 3.0),
        ("stall_1", "stall 1", "stall", 1.0, 9.0),
        ("stall_2", "stall 2", "stall", 4.0, 9.0),
    )
)
MEMORY = (
    MemoryEntry(name="glaze", data="The glaze is in the sink"),
    MemoryEntry(name="hours", data="Guests are let in from 10 to 6"),
)


async def asked(message: str, *history: str, catalogue: tuple[ActionInfo, ...] | None = None) -> ChatAction:
    turns = tuple(
        Turn("operator" if i % 2 == 0 else "assistant", content) for i, content in enumerate(history)
    )
    return await OfflineLanguage().interpret(
        Situation(
            message=message,
            objects=MAP,
            memory=MEMORY,
            history=turns,
            catalogue=CATALOGUES["thesis"] if catalogue is None else catalogue,
        )
    )


def looked_for(action: ChatAction) -> str:
    last = action.queue[-1].input_parameters
    return " ".join(str(value.value) for value in last.values())


@pytest.mark.parametrize(
    ("said", "looks"),
    [
        ("is the lid of the kiln shut?", "whether the lid of the kiln is shut"),
        ("Are the bulbs in stall 2 on?", "whether the bulbs in stall 2 are on"),
        ("Is anybody painting in stall 1?", "whether anybody is painting in stall 1"),
        ("Is anything wrong with the sink?", "whether anything is wrong with the sink"),
        ("Is there dust on the floor by the kiln?", "whether there is dust on the floor by the kiln"),
        ("Does stall 1 have a curtain?", "whether stall 1 has a curtain"),
    ],
)
async def test_how_something_is_now_is_looked_at(said: str, looks: str) -> None:
    assert looked_for(await asked(said)) == looks


async def test_each_of_any_is_looked_at() -> None:
    action = await asked("are there brushes in any of the stalls?")
    assert [call.name for call in action.queue].count("Inspect") == 2


async def test_its_and_there_are_what_was_spoken_of() -> None:
    said = ("Go to the kiln.", "I am at the kiln.")
    assert looked_for(await asked("are its bricks cracked?", *said)) == (
        "whether the bricks of the kiln are cracked"
    )
    assert looked_for(await asked("is anybody there?", *said)) == "whether anybody is there"


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("Is the glaze in the sink?", "Yes: The glaze is in the sink."),
        ("until what time can guests come in?", "Guests are let in from 10 to 6."),
        ("Is stall 1 next to stall 2?", "On my map stall 1 is about 3.0 m from stall 2."),
    ],
)
async def test_what_is_known_is_told(said: str, told: str) -> None:
    action = await asked(said)
    assert (action.message_response, action.queue) == (told, ())


@pytest.mark.parametrize(
    "said",
    [
        "Is the kiln hotter than the sink?",
        "Is stall 1 open on Sundays?",
        "Has the kiln been swept?",
        "Is the sink a bargain?",
    ],
)
async def test_what_is_not_to_be_seen_there_is_not_gone_to(said: str) -> None:
    assert not (await asked(said)).queue


async def test_who_cannot_look_says_so() -> None:
    narrow = ActionInfo(name="check_trap", inputs={"trap": "string"}, description="Check a trap.")
    moves = ActionInfo(name="drive_to", inputs={"place": "string"}, description="Drive to a place.")
    assert not sees(Catalogue((moves, narrow)))
    assert sees(Catalogue(CATALOGUES["thesis"]))
    action = await asked("Is the lid of the kiln shut?", catalogue=(moves,))
    assert not action.queue
    assert "cannot look" in action.message_response


@pytest.mark.parametrize("history", [(), ("The glaze is in the kiln", "I will remember that.")])
async def test_of_a_part_it_is_asked_what_the_part_is(history: tuple[str, ...]) -> None:
    answer = await asked("is the kiln door shut?", *history)
    assert [call.input_parameters["inspect"].value for call in answer.queue if call.name == "Inspect"] == [
        "whether the kiln door is shut"
    ]
