"""Where the person is who speaks: remembered when told, asked for when missing, and used for "me"."""

from __future__ import annotations

import pytest

from parley.cli.actions import catalogue_with
from parley.language.base import Situation, Turn
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Asked, Dialogue
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import CATALOGUE

ENGINE = BuiltinLanguage()
SHIPPED = catalogue_with(None)[0].for_robot(("drive", "camera")).infos()
THINGS = (
    MapObject("r", "red desk", 0.0, 0.0),
    MapObject("b", "blue desk", 9.0, 0.0),
    MapObject("g", "gate", 5.0, 5.0),
)
ASKED = Dialogue(asked=Asked("come to me", where="you"), now_unix_ms=1)


async def answer(message: str, history: tuple[Turn, ...] = (), **more: object) -> ChatAction:
    values: dict[str, object] = {"catalogue": CATALOGUE, "history": history} | more
    situation = Situation(message, objects=THINGS, robot="Ada", **values)  # type: ignore[arg-type]
    return await ENGINE.interpret(situation)


def kept(answered: ChatAction) -> list[str]:
    return [str(command.arguments.get("data")) for command in answered.system_cmd]


def places(answered: ChatAction) -> list[object]:
    return [
        value.value for call in answered.queue for value in call.input_parameters.values() if value.has_data
    ]


@pytest.mark.parametrize(
    ("message", "speaker", "memory"),
    [
        ("I'm at the gate", "", "the operator is at the gate"),
        ("ok, I am now sitting over there next to the red desk", "Kim", "Kim is next to the red desk"),
    ],
)
async def test_where_the_speaker_is_is_remembered_under_their_name(
    message: str, speaker: str, memory: str
) -> None:
    made = await answer(message, speaker=speaker)
    assert (kept(made), made.queue) == ([memory], ())


@pytest.mark.parametrize("message", ["I'm at a loss", "I am at the desk", "I am near the moon"])
async def test_what_names_no_one_place_is_not_kept(message: str) -> None:
    assert kept(await answer(message)) == []


@pytest.mark.parametrize("words", ["near the gate", "I'm at the gate", "the gate", "it's by the gate"])
async def test_the_answer_to_where_somebody_is_lets_the_order_be_done(words: str) -> None:
    made = await answer(words, dialogue=ASKED)
    assert kept(made) == [
        f"the operator is {'at' if 'at' in words.split() else 'by' if 'by' in words else 'near'} the gate"
    ]
    assert places(made) == ["gate"]


@pytest.mark.parametrize("words", ["near the desk", "never mind", "is it the gate?"])
async def test_what_does_not_say_which_place_lets_nothing_be_done(words: str) -> None:
    made = await answer(words, dialogue=ASKED)
    assert (made.queue, kept(made)) == ((), [])


async def test_me_is_where_the_one_who_speaks_said_they_are() -> None:
    told = (
        MemoryEntry(name="kim_location", data="Kim is at the gate"),
        MemoryEntry(name="bo_location", data="Bo is at the red desk"),
    )
    made = await answer("go to the blue desk, then come back to me", memory=told, speaker="Kim")
    assert places(made) == ["blue desk", "gate"]
    assert places(await answer("come to me", memory=told, speaker="Ann")) == ["operator"]  # whoever finds Ann


@pytest.mark.parametrize(
    ("before", "things"),
    [
        ("there are the red desk and the gate", ["red desk", "gate"]),
        ("I painted the gate", []),
        ("we have a gate and a desk", []),
    ],
)
async def test_them_are_several_things_or_asked_about(before: str, things: list[str]) -> None:
    history = (Turn("operator", before), Turn("assistant", "All right."))
    made = await answer("look at them", history)
    assert places(made) == things, made.message_response


@pytest.mark.parametrize(
    ("message", "goes"),
    [
        ("I'm at the gate, come to me", ["gate"]),
        ("I am near the red desk. Come here.", ["red desk"]),
        ("the gate is open, I'm at the gate, if it rains come to me", []),
    ],
)
async def test_who_says_where_they_are_and_calls_is_come_to(message: str, goes: list[str]) -> None:
    made = await answer(message)
    if goes:
        assert places(made) == goes
        assert kept(made)[0].endswith(f"the {goes[0]}")
    else:
        assert made.queue == ()


async def test_what_is_missing_is_asked_for_until_an_order_is_whole() -> None:
    asked = await answer("bring Kim the tray", catalogue=SHIPPED)
    assert asked.left_open.where == "the tray"
    told = await answer(
        "in the hall, on the red desk",
        catalogue=SHIPPED,
        dialogue=Dialogue(asked=Asked("bring Kim the tray", where="the tray")),
    )
    assert told.left_open.where == "Kim" and told.left_open.told == ("the tray is on the red desk",)
    last = Dialogue(asked=Asked("bring Kim the tray", where="Kim"), told=told.left_open.told)
    whole = await answer("by the gate", catalogue=SHIPPED, dialogue=last)
    assert [name for name in places(whole) if name in ("red desk", "gate")] == ["red desk", "gate"]
    dropped = await answer("forget it", catalogue=SHIPPED, dialogue=last)
    assert dropped.message_response == "All right, then I leave it."
