"""Servers that answer without end: memory stays bounded, and a plain sentence says why."""

from __future__ import annotations

import gzip
import io
import tracemalloc
import zlib

import pytest

from parley.errors import LanguageError
from parley.language.llm.failures import UnusableError
from parley.language.llm.scripted_server import Say
from tests.language.llm.rig import LOOKS, Model, model, situation


def packed(megabytes: int) -> bytes:
    """Gzip of so many megabytes of spaces."""
    held = io.BytesIO()
    with gzip.GzipFile(fileobj=held, mode="wb", mtime=0) as file:
        for _ in range(megabytes):
            file.write(b" " * 1_000_000)
    return held.getvalue()


BOMB = packed(300)
SENDS: dict[str, Say] = {
    "an answer": Say(body=BOMB, headers={"Content-Encoding": "gzip"}),
    "an error": Say(body=BOMB, status=400, headers={"Content-Encoding": "gzip"}),
    "a redirect": Say(body=BOMB, status=302, headers={"Content-Encoding": "gzip", "Location": "/v1/x"}),
    "a stream": Say(body=BOMB, content_type="text/event-stream", headers={"Content-Encoding": "gzip"}),
    "deflated": Say(body=zlib.compress(b" " * 100_000_000), headers={"Content-Encoding": "deflate"}),
    "packed twice": Say(body=gzip.compress(BOMB), headers={"Content-Encoding": "gzip, gzip"}),
    "not packed": Say(body=b" " * 5_000_000),
    "one endless frame": Say(body=b"data: " + b"x" * 2_000_000, content_type="text/event-stream"),
}


async def peak_mb(here: Model) -> float:
    """Ask once, which fails; what that took."""
    tracemalloc.start()
    try:
        with pytest.raises(UnusableError, match=r"too long|more than once") as told:
            await here.language.interpret(situation(), on_draft=lambda _draft: None)
        assert told.value.plain == "My language service gave an answer that is too long."
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("what", SENDS)
async def test_an_endless_answer_is_cut_short_and_asked_for_once(what: str) -> None:
    async with model() as here:
        here.server.always(SENDS[what])
        assert await peak_mb(here) < 60
        assert len(here.server.requests) == 1


async def test_a_packed_answer_of_usual_length_is_read() -> None:
    async with model() as plain:
        plain.will(LOOKS)
        meant = await plain.language.interpret(situation())
    async with model() as here:
        here.server.packs = True
        here.will(LOOKS)
        assert await here.language.interpret(situation()) == meant


async def test_nobody_is_followed_to_another_address() -> None:
    async with model() as elsewhere, model() as here:
        here.server.always(Say(body="{}", status=307, headers={"Location": f"{elsewhere.server.url}/x"}))
        with pytest.raises(LanguageError):
            await here.language.interpret(situation())
        assert not elsewhere.server.requests
