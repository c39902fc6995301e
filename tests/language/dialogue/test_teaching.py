"""Words and sentences of people's own: what teaches, what may be taught, and what it comes to."""

from __future__ import annotations

from typing import Any

import pytest

from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.teaching import Learned, Taught, entry_of, key, lesson_of, reserved, weighed
from parley.language.lexicon import load_data
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from tests.language.builtin.worlds import THINGS, situation, thing

ENGINE = BuiltinLanguage()
TRAYS = (*THINGS, thing("blue tray", 20), thing("red tray", 21))
DATA: dict[str, Any] = load_data("teaching")


def kept(words: str, means: str = "", action: str = "", **arguments: str | float) -> MemoryEntry:
    return entry_of(Taught(words, means, action, arguments), source="Kim", words="so they said")


def steps(answer: ChatAction) -> list[str]:
    return [f"{c.name}({', '.join(str(v.value) for v in c.input_parameters.values())})" for c in answer.queue]


async def done(message: str, *memory: MemoryEntry) -> list[str]:
    return steps(await ENGINE.interpret(situation(message, objects=TRAYS, memory=memory)))


@pytest.mark.parametrize(("message", "lesson"), DATA["tests"].items())
def test_each_shape_teaches_the_words_and_what_they_mean(message: str, lesson: list[str]) -> None:
    assert lesson_of(message) == Taught(key(lesson[0]), lesson[1])


@pytest.mark.parametrize("message", [*DATA["others"], "by tray do you mean the blue one?"])
def test_what_only_sounds_like_it_teaches_nothing(message: str) -> None:
    assert lesson_of(message) is None


@pytest.mark.parametrize(
    ("message", "memory", "deeds"),
    [
        ("go to the den", kept("den", "office"), ["drive_to(office)"]),
        ("pick up the tray", kept("tray", "blue tray"), ["grab(blue tray)"]),
        ("pick up the red tray", kept("tray", "blue tray"), ["grab(red tray)"]),
        ("inspect the pump", kept("pump", "lamp"), ["look(pump)"]),  # its own name stays its own
        ("Tidy up, please!", kept("tidy up", "go to the desk and inspect the pump"),
         ["drive_to(desk)", "look(pump)"]),
        ("lights out", kept("lights out", "", "off", device="lamp"), ["off(lamp)"]),
        ("Tidy up, and then go to the yard.", kept("tidy up", "inspect the pump"),
         ["look(pump)", "drive_to(yard)"]),
        ("go to the yard, then lights out", kept("lights out", "", "off", device="lamp"),
         ["drive_to(yard)", "off(lamp)"]),
        ("tidy up the desk", kept("tidy up", "inspect the pump"), []),
        ("tidy up, then fly to the moon", kept("tidy up", "inspect the pump"), []),
        ("if the office is open, tidy up", kept("tidy up", "inspect the pump"), []),
        ("don't tidy up", kept("tidy up", "go to the desk and inspect the pump"), []),
        ("tidy up", kept("tidy up", "", "fly"), []),
        ("tidy up", kept("tidy up", '{"action": 3}'), []),
        ("round", kept("round", "round"), []),
        ("go to the yard", kept("go to the yard", "go to the desk"), ["drive_to(yard)"]),
    ],
)  # fmt: skip
async def test_what_was_taught_is_done(message: str, memory: MemoryEntry, deeds: list[str]) -> None:
    assert await done(message, memory) == deeds


@pytest.mark.parametrize("way", ["", "seen", "concluded"])
async def test_what_no_person_told_is_not_taught(way: str) -> None:
    entry = kept("den", "office").model_copy(update={"way": way})
    assert await done("go to the den", entry) == []
    assert not entry.is_told


async def test_plan_says_that_it_rests_on_what_was_taught() -> None:
    memory = (kept("den", "office"), kept("tray", "blue tray"))
    answer = await ENGINE.interpret(situation("go to the den", objects=TRAYS, memory=memory))
    assert answer.sources == (memory[0].name,)


@pytest.mark.parametrize(
    "words",
    [
        "stop", "STOP!", "halt", "yes", "no", "okay", "go ahead", "carry on", "drop everything", "never",
        "not that",
        "never go", "approve", "seis", "jah", "it", "there", "the", "42", "to the left", "where are you", "",
        "one two three four five six seven eight nine",
    ],
)  # fmt: skip
async def test_what_stops_decides_or_rules_cannot_be_redefined(words: str) -> None:
    assert reserved(words) is not None
    taught = kept(words or "x", "go to the desk")
    assert await done(words or "", *([taught] if words else [])) == []


@pytest.mark.parametrize(
    ("words", "means", "why"),
    [
        ("pump", "the lamp", "is what something on my map is called already"),
        ("go to the yard", "go to the desk", "means something to me already"),
        ("den", "the moon", "neither something on my map nor an order"),
        ("den", "stop", "neither something on my map nor an order"),
        ("den", "never go to the desk", "neither something on my map nor an order"),
        ("den", "the tray", "may be several things: blue tray, red tray"),
        ("stop", "go to the desk", "keeps its meaning"),
        ("Ada", "the desk", "calls a robot"),
    ],
)
async def test_what_cannot_be_taught_is_refused_with_the_reason(words: str, means: str, why: str) -> None:
    found = await weighed(Taught(key(words), means), situation("", objects=TRAYS), ENGINE)
    assert isinstance(found, str)
    assert why in found


async def test_one_of_a_kind_is_taught_by_what_tells_it_apart() -> None:
    found = await weighed(Taught("tray", "the blue one"), situation("", objects=TRAYS), ENGINE)
    assert found == Learned(Taught("tray", "blue tray"))


async def test_what_others_mean_stays_as_it_is() -> None:
    known = situation("", objects=TRAYS)
    found = await weighed(
        Taught("front gate round", "go to the desk"), known, ENGINE, alike=["front gate round"]
    )
    assert isinstance(found, str)
    assert "would not mean any more" in found
