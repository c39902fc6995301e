"""Places that are closed, have moved, or are stood in for."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps
from parley.language.base import Situation, Turn
from parley.language.offline.engine import OfflineLanguage
from parley.language.offline.facts.recall import select_memories
from parley.language.offline.facts.redirecting import read_redirect
from parley.language.offline.words.text import plain
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=name, description=said, x_m=x_m, y_m=0.0, class_name=kind)
    for name, said, kind, x_m in (
        ("aa", "area A", "area", 5.0),
        ("ab", "area B", "area", 10.0),
        ("ac", "area C", "area", 15.0),
    )
)
STORED = "Packages stored in area A"


async def answer(message: str, *told: str, said: str = "") -> ChatAction:
    memory = tuple(MemoryEntry(name=f"m{index}", data=text) for index, text in enumerate(told))
    history = (Turn("operator", said), Turn("assistant", "All right.")) if said else ()
    return await OfflineLanguage().interpret(
        Situation(message, memory=memory, objects=MAP, catalogue=CATALOGUES["thesis"], history=history)
    )


async def places(message: str, *told: str, said: str = "") -> list[str]:
    action = await answer(message, *told, said=said)
    steps = read_steps(action.queue, CATALOGUES["thesis"])
    return [step.arguments[0] for step in steps if step.verb == "go"]


@pytest.mark.parametrize(
    ("text", "place", "other"),
    [
        ("Area A closed for maintenance, using area B temporarily", "Area A", "area B"),
        ("Dock 1 is blocked until Friday, meanwhile use dock 3", "Dock 1", "dock 3"),
        ("Instead of dock 1 use dock 2", "dock 1", "dock 2"),
        ("The guest house is used instead of the hotel", "hotel", "guest house"),
        ("Dock 2 replaces dock 1", "dock 1", "Dock 2"),
        ("We have closed the lobby, please use the side door", "lobby", "side door"),
        ("Everything from the old shed has been moved to the barn", "old shed", "barn"),
        ("The archive is temporarily in room 4", "archive", "room 4"),
        ("The shop is closed on Sundays", "shop", ""),
    ],
)
def test_what_takes_the_place_of_another_is_read(text: str, place: str, other: str) -> None:
    said = read_redirect(text)
    assert said is not None
    assert (plain(said.place), plain(said.other), said.reopened) == (place, other, False)


@pytest.mark.parametrize(
    "text",
    ["The packages are stored in area A", "If a gate is closed, go to area B instead", "Is area A closed?"],
)
def test_what_says_nothing_of_closing_is_no_such_fact(text: str) -> None:
    assert read_redirect(text) is None


@pytest.mark.parametrize(
    "closing",
    [
        "Area A closed for maintenance, using area B temporarily",
        "Area A is closed, use area B instead",
        "Area A is out of order. Use area B for now.",
        "Use area B instead of area A today",
        "Everything from area A is now in area B",
    ],
)
async def test_what_is_kept_in_a_closed_place_is_looked_for_in_the_other(closing: str) -> None:
    assert await places("Go to the package", STORED, closing) == ["area B"]
    where = await answer("where is the package?", STORED, closing)
    assert "area B" in where.message_response


async def test_later_facts_win() -> None:
    closed = "Area A is closed, use area B instead"
    assert await places("go to the package", STORED, closed, "Area A is open again") == ["area A"]
    assert await places("go to the package", STORED, closed, "Area B is closed, use area C") == ["area C"]
    assert await places("go to the package", "The packages are in area C", STORED, closed) == ["area B"]
    assert await places("go to the package", STORED, "The package is now in area C") == ["area C"]


async def test_the_closed_place_itself_is_gone_to_and_said_to_be_closed() -> None:
    action = await answer("go to area A", "Area A is closed, use area B instead")
    assert "closed" in action.message_response
    assert await places("go to area A", "Area A is closed, use area B instead") == ["area A"]


async def test_told_that_a_place_is_closed_it_is_remembered_and_used_at_once() -> None:
    action = await answer("Area A is closed. Use area B instead. Go to the package.", STORED)
    assert [command.command for command in action.system_cmd] == ["add_memory"]
    said = "Area A is closed. Use area B instead. Go to the package."
    assert await places(said, STORED) == ["area B"]


async def test_after_an_order_to_go_there_it_is_another_order() -> None:
    assert await places("Area A is closed, use area B instead", said="go to area A") == ["area B"]


async def test_things_in_the_plural_without_article_are_no_persons() -> None:
    action = await answer("take the packages to area C", STORED)
    assert [s.verb for s in read_steps(action.queue, CATALOGUES["thesis"])][:2] == ["go", "look"]


def test_all_facts_on_the_way_are_selected() -> None:
    told = (STORED, "Area A closed, using area B", "Area B is closed, use area C", "It is cold outside")
    index = [MemoryEntry(name=f"m{number}", data=text) for number, text in enumerate(told)]
    assert select_memories("Go to the package", index) == ["m0", "m1", "m2"]


@pytest.mark.parametrize(
    ("closing", "place"),
    [
        ("Area A is being renovated, its packages are in area C for now", ["area C"]),
        ("Everything that was in area A is now in area B", ["area B"]),
        ("Please use area B while area A is being painted", ["area B"]),
        ("Area A is locked", ["area A"]),
    ],
)
async def test_what_is_used_instead_is_told_in_many_ways(closing: str, place: list[str]) -> None:
    assert await places("go to the package", STORED, closing) == place
