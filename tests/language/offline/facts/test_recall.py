"""Which memories matter."""

from __future__ import annotations

from parley.language.offline import OfflineLanguage
from parley.messages.memory import MemoryEntry

THESIS = (
    MemoryEntry(name="package_location", data="Packages stored in area A"),
    MemoryEntry(name="maintenance_warning", data="Area A closed for maintenance, using area B temporarily"),
    MemoryEntry(name="temperature", data="Weather outside is -4°C"),
)
HOME = (
    MemoryEntry(name="anna_location", data="Anna is on the couch"),
    MemoryEntry(name="water_bottle_location", data="There is a water bottle in the fridge"),
    MemoryEntry(name="door_state", data="The door is locked"),
)


async def select(query: str, index: tuple[MemoryEntry, ...]) -> list[str]:
    return await OfflineLanguage().select_memories(query, index)


async def test_the_example_of_the_thesis() -> None:
    assert await select("Go to the package.", THESIS) == ["package_location", "maintenance_warning"]


async def test_a_need_finds_the_person_and_what_helps() -> None:
    assert await select("Anna is thirsty", HOME) == ["anna_location", "water_bottle_location"]


async def test_words_of_the_same_meaning_are_enough() -> None:
    assert await select("who is on the sofa?", HOME) == ["anna_location"]


async def test_small_words_select_nothing() -> None:
    assert await select("what is it to the of in on", HOME) == []
