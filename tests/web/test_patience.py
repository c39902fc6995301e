"""Connections over real sockets that say too little too slowly, and ordinary ones beside them."""

from __future__ import annotations

import asyncio
from urllib.parse import urlsplit

import pytest

from tests.web.rig import Rig, served

WITHIN_S = 20
"""How long a test waits to be hung up on."""
GET = b"GET /api/health HTTP/1.1\r\nHost: 127.0.0.1\r\n"


async def connected(rig: Rig) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    parts = urlsplit(rig.url)
    return await asyncio.open_connection(parts.hostname, parts.port)


async def hung_up(reader: asyncio.StreamReader) -> bytes:
    """What came until the other side hung up."""
    async with asyncio.timeout(WITHIN_S):
        return await reader.read()


@pytest.mark.parametrize("said", [b"", b"GET", GET, GET + b"X-Slow: 1\r\n"])
async def test_a_head_that_does_not_come_to_its_end_is_not_waited_for(said: bytes) -> None:
    async with served("Ada", head_within_s=0.2) as rig:
        reader, writer = await connected(rig)
        writer.write(said)
        assert await hung_up(reader) == b""
        writer.close()
        assert (await rig.http.get("/api/snapshot")).status_code == 200


async def test_a_byte_now_and_then_buys_no_time() -> None:
    async with served("Ada", head_within_s=0.3) as rig:
        reader, writer = await connected(rig)

        async def drip() -> None:
            writer.write(GET)
            while True:
                writer.write(b"X-Slow: 1\r\n")
                await asyncio.sleep(0.02)

        dripping = asyncio.create_task(drip())
        try:
            assert await hung_up(reader) == b""
        except ConnectionResetError:
            pass  # a byte was on its way when the other side hung up
        finally:
            dripping.cancel()
            writer.close()


async def test_the_second_request_of_a_connection_is_not_waited_for_either() -> None:
    async with served("Ada", head_within_s=0.3) as rig:
        reader, writer = await connected(rig)
        writer.write(GET + b"\r\n")
        head = await reader.readuntil(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 200")
        writer.write(b"GET /api/hea")
        await hung_up(reader)
        writer.close()


async def test_a_body_that_stays_out_is_not_waited_for() -> None:
    async with served("Ada", body_idle_s=0.2) as rig:
        reader, writer = await connected(rig)
        head = b"POST /api/chat HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        writer.write(head + b'Content-Length: 100\r\n\r\n{"id"')
        await hung_up(reader)
        writer.close()
        await rig.heard()
        assert rig.robots.inputs == []


async def test_answers_and_live_streams_take_as_long_as_they_take() -> None:
    async with served("Ada", head_within_s=0.3, body_idle_s=0.3) as rig:
        page = await rig.page()
        polling = await connected(rig)
        polling[1].write(GET + b"\r\n")
        await polling[0].readuntil(b"\r\n\r\n")
        reader, writer = await connected(rig)
        await hung_up(reader)  # by then the others have lived longer than any request may take
        writer.close()
        rig.robots.appear("Bob")
        await page.until(lambda: any(change["robot"]["name"] == "Bob" for change in page.of("robot")))
        polling[1].write(GET + b"Connection: close\r\n\r\n")
        assert b"HTTP/1.1 200" in await hung_up(polling[0])
        polling[1].close()
