"""Finding memories by meaning, with a real server over real HTTP whose model is a word count."""

from __future__ import annotations

import asyncio
import json
import socket
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
import structlog

from parley.clock import SimClock
from parley.config import EmbeddingSettings
from parley.errors import ConfigError, LanguageError
from parley.memory.embedder import Embedder, RefusedTextError, configured_embedder
from parley.memory.embedding_server import EmbeddingServer
from parley.memory.meanings import GONE, Meanings, fused
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry

ALIKE = {"crate": "box", "container": "box", "gate": "door", "entrance": "door"}


class Watch(SimClock):
    """A clock whose wall time a test sets."""

    wall = 100.0

    def wall_s(self) -> float:
        return self.wall


@pytest.fixture
def server() -> Iterator[EmbeddingServer]:
    with EmbeddingServer(ALIKE) as running:
        yield running


@asynccontextmanager
async def meanings(
    store: MemoryStore, server: EmbeddingServer, clock: Watch | None = None, told: list[str] | None = None
) -> AsyncIterator[Meanings]:
    said = told if told is not None else []
    embedder = Embedder(server.address, "words", timeout_s=5.0)
    async with Meanings(store, embedder, clock or Watch(), tell=said.append) as found:
        await settled(found)
        yield found


async def settled(found: Meanings) -> None:
    async with asyncio.timeout(10):
        await found.settled.wait()


async def fill(store: MemoryStore, **texts: str) -> None:
    for name, data in texts.items():
        await store.add(MemoryEntry(name=name, data=data))


def names(entries: list[MemoryEntry]) -> list[str]:
    return [entry.name for entry in entries]


async def test_memory_is_found_by_words_that_mean_the_same(server: EmbeddingServer) -> None:
    async with await MemoryStore.open(":memory:") as store:
        await fill(store, a="the container stands here", b="Kim likes tea", c="tea upstairs")
        async with meanings(store, server) as found:
            assert await store.search("crate") == []
            assert names(await found.alike("crate", 5)) == ["a"]
            assert names(await found.alike("Kim likes tea", 5)) == ["b", "c"]
            assert names(await found.alike("Kim likes tea", 1)) == ["b"]


async def test_memories_that_come_change_and_go_are_followed(server: EmbeddingServer) -> None:
    async with await MemoryStore.open(":memory:") as store, meanings(store, server) as found:
        assert await found.alike("crate", 5) == []
        await fill(store, a="a box")
        found.wake()
        await settled(found)
        assert names(await found.alike("crate", 5)) == ["a"]
        await fill(store, a="a gate")
        found.wake()
        await settled(found)
        assert await found.alike("crate", 5) == []
        assert names(await found.alike("entrance", 5)) == ["a"]
        await store.remove("a")
        assert await found.alike("entrance", 5) == []


async def test_scopes_hold_and_pictures_are_found_by_what_is_said_about_them(server: EmbeddingServer) -> None:
    async with await MemoryStore.open(":memory:") as store:
        for scope in ("", "A", "B"):
            await store.add(MemoryEntry(name=f"of {scope}", data="a box", scope=scope))
        await store.add(MemoryEntry(name="photo", type="image", data="box", info="the gate"))
        async with meanings(store, server) as found:
            assert {entry.scope for entry in await found.alike("crate", 9, "A")} == {"", "A"}
            assert names(await found.alike("entrance", 9)) == ["photo"]


async def test_vectors_are_kept_in_the_file_and_made_once(server: EmbeddingServer, tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as store:
        await fill(store, **{f"m{n}": f"box {n}" for n in range(150)})
        async with meanings(store, server):
            assert sorted(len(texts) for texts in server.asked) == [22, 64, 64]
    server.asked.clear()
    async with await MemoryStore.open(path) as store, meanings(store, server) as found:
        assert server.asked == []
        assert len(await found.alike("crate", 200)) == 150


async def test_nobody_waits_for_the_vectors_that_are_read_at_the_start(
    server: EmbeddingServer, tmp_path: Path
) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as store:
        await fill(store, **{f"m{n}": f"box {n}" for n in range(150)})
        async with meanings(store, server):
            pass
    server.asked.clear()
    embedder = Embedder(server.address, "words", timeout_s=5.0)
    async with await MemoryStore.open(path) as store, Meanings(store, embedder, Watch()) as found:
        assert not found.settled.is_set()
        assert await found.alike("crate", 5) == []
        assert len(await store.search("box")) == 20
        await settled(found)
        assert len(await found.alike("crate", 5)) == 5


async def test_vectors_of_another_length_in_the_file_are_passed_over(
    server: EmbeddingServer, tmp_path: Path
) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as store:
        await fill(store, a="a box", b="another box")
        async with meanings(store, server):
            pass
        await store.database.run(
            lambda db: db.execute("UPDATE memory_vector SET vector = zeroblob(8) WHERE memory = 2")
        )
        async with meanings(store, server) as found:
            assert names(await found.alike("crate", 5)) == ["a"]


async def test_another_model_gets_vectors_of_its_own(server: EmbeddingServer) -> None:
    async with await MemoryStore.open(":memory:") as store:
        await fill(store, a="a box")
        async with meanings(store, server):
            pass
        async with Meanings(store, Embedder(server.address, "another"), Watch()) as found:
            await settled(found)
            assert names(await found.alike("crate", 5)) == ["a"]
        assert len(server.asked) == 3


async def test_server_that_is_gone_is_told_once_left_alone_and_used_again(server: EmbeddingServer) -> None:
    clock, told = Watch(), list[str]()
    async with await MemoryStore.open(":memory:") as store, meanings(store, server, clock, told) as found:
        await fill(store, a="a box")
        found.wake()
        await settled(found)
        server.status = 503
        assert await found.alike("crate", 5) == []
        await fill(store, b="a container")
        found.wake()
        await settled(found)
        asked = len(server.asked)
        assert await found.alike("crate", 5) == []
        assert (told, len(server.asked)) == ([GONE], asked)
        clock.wall += 31
        assert await found.alike("crate", 5) == []
        await settled(found)
        assert told == [GONE], "it is the same trouble still"
        server.status = 200
        clock.wall += 31
        assert "a" in names(await found.alike("crate", 5))
        await settled(found)
        assert set(names(await found.alike("crate", 5))) == {"a", "b"}
        server.status = 500
        await found.alike("crate", 5)
        assert told == [GONE, GONE], "a new trouble is told anew"


async def test_text_that_the_server_refuses_does_not_keep_others_from_a_vector(
    server: EmbeddingServer,
) -> None:
    server.refuses = "forbidden"
    async with await MemoryStore.open(":memory:") as store:
        await fill(store, a="a box", b="something forbidden", c="a crate")
        async with meanings(store, server) as found:
            assert set(names(await found.alike("container", 5))) == {"a", "c"}


def test_rankings_are_merged_by_their_places() -> None:
    a, b, c, d = (MemoryEntry(name=name, data="x") for name in "abcd")
    assert names(fused([a, b, c], [c, d])) == ["c", "a", "b", "d"]
    assert names(fused([a, b], [])) == ["a", "b"]
    assert names(fused([b, a], [b, c, a], first="A")) == ["a", "b", "c"]


# The client


async def test_key_is_sent_and_appears_in_no_error_and_no_log(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with EmbeddingServer(key="sesame-42") as server:
        (tmp_path / "key").write_text("sesame-42\n", encoding="utf-8")
        settings = EmbeddingSettings(url=server.address, model="m", key_file=tmp_path / "key")
        embedder = configured_embedder(settings)
        assert (await embedder.embed(["a", "b"])).shape[0] == 2
        server.key = "another"
        with structlog.testing.capture_logs() as logs, pytest.raises(LanguageError) as caught:
            await embedder.embed(["a"])
        assert "401" in str(caught.value)
        out = capsys.readouterr()
        assert "sesame" not in f"{caught.value!r} {logs} {out.out} {out.err} {embedder!r} {settings}"


async def test_key_comes_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PARLEY_EMBEDDINGS_KEY", "sesame")
    with EmbeddingServer(key="sesame") as server:
        embedder = configured_embedder(EmbeddingSettings(url=server.address, model="m"))
        assert (await embedder.embed(["a"])).shape[0] == 1


def test_wrong_settings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="http"):
        Embedder("file:///etc/passwd", "m")
    with pytest.raises(ConfigError, match="key"):
        Embedder("http://localhost", "m", key="two\nlines")
    with pytest.raises(ConfigError, match="key_file"):
        configured_embedder(EmbeddingSettings(url="http://x", model="m", key_file=tmp_path / "gone"))


async def test_nobody_at_the_address_is_an_error_of_the_language_kind() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(LanguageError, match="cannot be reached"):
        await Embedder(f"http://127.0.0.1:{port}/v1", "m").embed(["a"])


@pytest.mark.parametrize(
    "answer",
    [
        "nonsense", "[]", "{}", '{"data": []}', '{"data": [{"embedding": []}]}',
        '{"data": [{"embedding": "x"}]}',
        '{"data": [{"embedding": [1, null]}]}', '{"data": [{"embedding": [NaN]}]}', '{"data": [5]}',
    ],
)  # fmt: skip
async def test_answers_that_do_not_fit_are_errors(answer: str) -> None:
    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.readuntil(b"\r\n\r\n")
        body = answer.encode()
        writer.write(b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\nConnection: close\r\n\r\n" % len(body) + body)
        await writer.drain()
        writer.close()

    async with await asyncio.start_server(serve, "127.0.0.1", 0) as listening:
        port = listening.sockets[0].getsockname()[1]
        with pytest.raises(LanguageError, match=r"cannot be read|does not fit"):
            await Embedder(f"http://127.0.0.1:{port}", "m").embed(["a"])


async def test_server_that_says_nothing_is_given_up_in_time() -> None:
    left = asyncio.Event()

    async def hang(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.read()
        writer.close()
        left.set()

    async with await asyncio.start_server(hang, "127.0.0.1", 0) as listening:
        port = listening.sockets[0].getsockname()[1]
        with pytest.raises(LanguageError):
            await Embedder(f"http://127.0.0.1:{port}", "m", timeout_s=0.1).embed(["a"])
        await left.wait()


async def test_redirect_is_not_followed_with_the_key() -> None:
    seen: list[bytes] = []

    async def redirect(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        seen.append(await reader.readuntil(b"\r\n\r\n"))
        writer.write(b"HTTP/1.1 307 Moved\r\nLocation: /elsewhere\r\nContent-Length: 0\r\n\r\n")
        await writer.drain()
        writer.close()

    async with await asyncio.start_server(redirect, "127.0.0.1", 0) as listening:
        port = listening.sockets[0].getsockname()[1]
        with pytest.raises(LanguageError, match="307"):
            await Embedder(f"http://127.0.0.1:{port}", "m", key="k").embed(["a"])
    assert len(seen) == 1


async def test_refused_text_is_an_error_of_its_own() -> None:
    with EmbeddingServer() as server:
        server.refuses = "x"
        with pytest.raises(RefusedTextError):
            await Embedder(server.address, "m").embed(["x"])
        assert json.dumps(server.asked) == '[["x"]]'


async def test_an_endless_answer_is_cut_short(server: EmbeddingServer) -> None:
    server.pads = 1_000_000
    with pytest.raises(LanguageError, match="too long"):
        await Embedder(server.address, "words").embed(["box"])
    server.pads = 1000
    assert len(await Embedder(server.address, "words").embed(["box"])) == 1
