"""How fast memories are found among many, before any language model is asked."""

from __future__ import annotations

import random
import tempfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from parley.agents.memory import MemoryNode
from parley.clock import WallClock
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.client import ask_memory
from parley.memory.embedder import Embedder
from parley.memory.meanings import Meanings
from parley.memory.store import MemoryStore
from parley.memory.vectors import Vectors
from parley.messages.memory import GetMemory, MemoryEntry
from parley.transport.local import LocalTransport

__all__ = ["MemoryFigures", "measure_memory"]

COMMON: Final = ("box", "door", "hall", "red", "blue", "shelf", "key", "room")
"""Words that a tenth to nearly all of the memories hold."""

VECTOR_LENGTH: Final = 768
SPREAD: Final = np.arange(1, VECTOR_LENGTH + 1, dtype=np.float32) ** -0.5
"""Vectors of models differ much in a few directions and little in most; here a sixth of the directions hold
three quarters of a vector."""


@dataclass(frozen=True, slots=True)
class MemoryFigures:
    """What was measured; all times in milliseconds of wall time."""

    memories: int
    fill_ms: float
    open_ms: float
    file_mb: float
    add_ms: Sequence[float] = field(default_factory=list)
    """Durable additions, one after the other."""
    search_ms: dict[str, list[float]] = field(default_factory=dict)
    """Searches in the store, by how common the words asked for are."""
    service_ms: Sequence[float] = field(default_factory=list)
    """The same through the memory node and its service."""
    meaning_fill_ms: float = 0.0
    """Vectors for all, kept in the file; without the time that a model takes to make them."""
    meaning_open_ms: float = 0.0
    """Reading the vectors when the program starts."""
    meaning_ms: Sequence[float] = field(default_factory=list)
    """Searches by meaning; without the time that a model takes for the vector of the request."""
    both_ms: Sequence[float] = field(default_factory=list)
    """Searches by words and by meaning, through the memory node and its service."""


async def measure_memory(count: int = 100_000, searches: int = 100, seed: int = 1) -> MemoryFigures:
    """Fill a file with `count` memories and search it.

    Args:
        count: How many memories.
        searches: How many searches of each kind.
        seed: For the made-up memories.
    """
    chance, clock = random.Random(seed), WallClock()
    entries = [_memory(number, chance) for number in range(count)]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "memory.db"
        begun = clock.wall_s()
        async with await MemoryStore.open(path, clock) as store:
            await store.merge(entries)
        filled = clock.wall_s()
        async with await MemoryStore.open(path, clock) as store:
            figures = MemoryFigures(
                memories=count,
                fill_ms=1000 * (filled - begun),
                open_ms=1000 * (clock.wall_s() - filled),
                file_mb=path.stat().st_size / 1e6,
                add_ms=[await _add(store, clock, number) for number in range(searches)],
                search_ms={
                    kind: [await _search(store, clock, text) for text in texts]
                    for kind, texts in _questions(count, searches, chance).items()
                },
                service_ms=await _service(store, clock, count, searches, chance),
            )
            by_meaning = await _meaning(store, clock, count, searches, chance)
    return replace(figures, **by_meaning)


class _MadeUp(Embedder):
    """Vectors by chance, of the length and spread that those of common models have, without a model."""

    def __init__(self) -> None:
        super().__init__("http://127.0.0.1", "made up")

    async def embed(self, texts: Sequence[str]) -> Vectors:
        rows = np.stack([self._vector(text) for text in texts])
        return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True), np.float32)

    @staticmethod
    def _vector(text: str) -> Vectors:
        seed = zlib.crc32(text.encode())
        return np.random.default_rng(seed).standard_normal(VECTOR_LENGTH, np.float32) * SPREAD


async def _meaning(
    store: MemoryStore, clock: WallClock, count: int, searches: int, chance: random.Random
) -> dict[str, Any]:
    texts = _questions(count, searches, chance)["mixed"]
    begun = clock.wall_s()
    async with Meanings(store, _MadeUp(), clock, min_alike=-1.0) as meanings:
        await meanings.settled.wait()
    filled = clock.wall_s()
    async with Meanings(store, _MadeUp(), clock, min_alike=-1.0) as meanings:
        await meanings.settled.wait()
        opened = clock.wall_s()
        taken: list[float] = []
        for text in texts:
            asked = clock.wall_s()
            await meanings.alike(text, 20)
            taken.append(1000 * (clock.wall_s() - asked))
    both = await _service(
        store, clock, count, searches, chance, Meanings(store, _MadeUp(), clock, min_alike=-1.0)
    )
    return {
        "meaning_fill_ms": 1000 * (filled - begun),
        "meaning_open_ms": 1000 * (opened - filled),
        "meaning_ms": taken,
        "both_ms": both,
    }


async def _add(store: MemoryStore, clock: WallClock, number: int) -> float:
    begun = clock.wall_s()
    await store.add(MemoryEntry(name=f"new {number}", data="The red box is in the hall."))
    return 1000 * (clock.wall_s() - begun)


async def _search(store: MemoryStore, clock: WallClock, text: str) -> float:
    begun = clock.wall_s()
    await store.search(text)
    return 1000 * (clock.wall_s() - begun)


async def _service(
    store: MemoryStore,
    clock: WallClock,
    count: int,
    searches: int,
    chance: random.Random,
    meanings: Meanings | None = None,
) -> list[float]:
    taken: list[float] = []
    language = ScriptedLanguage()
    async with LocalTransport() as transport, MemoryNode(transport, store, language, meanings=meanings):
        for text in [text for texts in _questions(count, searches, chance).values() for text in texts]:
            begun = clock.wall_s()
            await ask_memory(transport, GetMemory(request=text, scope="A", kind="search"))
            taken.append(1000 * (clock.wall_s() - begun))
    return taken


def _memory(number: int, chance: random.Random) -> MemoryEntry:
    some = " ".join(word for word in COMMON if chance.random() < 0.1 + 0.1 * COMMON.index(word))
    seldom = " ".join(f"w{int(chance.paretovariate(0.7)) % 50_000}" for _ in range(4))
    text = f"The thing {number} with {some} and {seldom} stands in room {chance.randrange(400)}."
    return MemoryEntry(name=f"thing {number}", data=text, info=f"about thing {number}")


def _questions(count: int, searches: int, chance: random.Random) -> dict[str, list[str]]:
    def some(size: int) -> str:
        return " ".join(chance.sample(COMMON, size))

    return {
        "rare": [f"where is thing {chance.randrange(count)}?" for _ in range(searches)],
        "common": [f"where is the {some(3)}?" for _ in range(searches)],
        "all_common": [f"is the thing {' '.join(COMMON)} in the room?" for _ in range(searches)],
        "mixed": [f"the {some(2)} near w{chance.randrange(3000)} please" for _ in range(searches)],
        "none": [f"zyx{chance.randrange(1000)} qwv" for _ in range(searches)],
    }
