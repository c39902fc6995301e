"""What people of ill will send: it is refused, costs little and leaves no trace."""

from __future__ import annotations

import asyncio
import base64
import struct
import zlib
from typing import Any

import pytest

from parley.messages import topics
from parley.messages.ros import String
from tests.web.rig import JPEG, HandClock, picture, served

PASSWORD = "correct horse battery"
SEALS = ("content-security-policy", "x-content-type-options", "x-frame-options", "referrer-policy")


def bomb() -> bytes:
    """A tiny PNG that says it is 60000 x 60000."""
    small = picture("PNG")
    head = b"IHDR" + struct.pack(">II", 60_000, 60_000) + small[24:29]
    return small[:12] + head + struct.pack(">I", zlib.crc32(head)) + small[33:]


@pytest.mark.parametrize("data", [bomb(), JPEG[:12], b"\x89PNG\r\n\x1a\n" + b"\0" * 50])
async def test_pictures_that_are_damaged_or_claim_to_be_huge_are_refused(data: bytes) -> None:
    async with served("Ada") as rig:
        text = base64.b64encode(data).decode()
        post = {"id": "m1", "text": "look", "targets": ["Ada"], "images": [{"name": "a.png", "data": text}]}
        assert (await rig.http.post("/api/chat", json=post)).status_code == 422
        put = {"type": "image", "data": text}
        assert (await rig.http.put("/api/memory?name=box", json=put)).status_code == 422
        await rig.heard()
        assert rig.robots.inputs == []


async def test_a_request_nested_a_hundred_thousand_deep_is_refused() -> None:
    async with served("Ada") as rig:
        deep = b"[" * 100_000 + b"]" * 100_000
        kind = {"Content-Type": "application/json"}
        answer = await rig.http.post("/api/chat", content=deep, headers=kind)
        assert answer.status_code in (400, 422)


@pytest.mark.parametrize(
    "path",
    [
        "/api/chat/images/..%2f..%2f..%2fetc%2fpasswd",
        "/api/feeds/..%2f..%2fetc/passwd.jpg",
        "/api/feeds/Ada/..%2f..%2fsecret.jpg",
        "/api/memory/image?name=..%2f..%2fetc%2fpasswd",
        "/assets/..%5c..%5csecret",
        "/%00",
    ],
)
async def test_no_path_leads_out_of_its_folder(path: str) -> None:
    async with served("Ada") as rig:
        answer = await rig.http.get(path)
        assert "root:" not in answer.text
        assert answer.status_code in (200, 404, 503)
        assert answer.headers["content-security-policy"]


async def test_every_answer_is_sealed_and_nothing_private_is_left_in_caches() -> None:
    async with served("Ada", lan=True, password=PASSWORD) as rig:
        refused = [await rig.http.get("/api/snapshot"), await rig.http.post("/api/stop", json={})]
        refused.append(await rig.http.post("/api/session", json={"secret": "wrong"}))
        assert [answer.status_code for answer in refused] == [401, 401, 401]
        await rig.http.post("/api/session", json={"secret": PASSWORD})
        rig.robots.show("Ada", "inspection")
        await rig.until(lambda: rig.server.backend.state.feeds.pictures)
        answers = [await rig.http.get(path) for path in ("/api/chat", "/api/qr.svg", "/api/none", "/none")]
        answers.append(await rig.http.get("/api/feeds/Ada/inspection.jpg"))
        answers.append(await rig.http.get("/socket.io/?EIO=4&transport=polling"))
        answers.append(await rig.http.post("/api/chat", content=b"{"))
        answers.append(await rig.http.put("/api/chat", json={}))
        answers.append(await rig.http.post("/api/stop", content=b"x" * 100_000))
        answers.append(await rig.http.get("/api/chat", headers={"Host": "evil.example"}))
        answers.append(await rig.http.post("/api/stop", json={}, headers={"Origin": "null"}))
        for answer in [*refused, *answers]:
            assert all(answer.headers.get(name) for name in SEALS), answer.request.url
            assert "max-age" in answer.headers["strict-transport-security"]
            if answer.request.url.path.startswith(("/api", "/socket.io")):
                assert answer.headers["cache-control"] == "no-store", answer.request.url


@pytest.mark.parametrize("method", ["POST", "DELETE"])
async def test_foreign_pages_neither_sign_anybody_in_nor_out(method: str) -> None:
    async with served(lan=True, password=PASSWORD) as rig:
        foreign = {"Origin": "https://evil.example"}
        await rig.http.post("/api/session", json={"secret": PASSWORD})
        answer = await rig.http.request(
            method, "/api/session", headers=foreign, json={"secret": PASSWORD} if method == "POST" else None
        )
        assert answer.status_code == 403
        assert "set-cookie" not in answer.headers
        assert (await rig.http.get("/api/snapshot")).status_code == 200


async def test_what_robots_send_cannot_write_lines_into_the_log(capsys: pytest.CaptureFixture[str]) -> None:
    async with served("Ada") as rig:
        for text in ('{"actor": "x\nFORGED"}', '{"actor": 5, "state": "x\\nFORGED\\u001b[2J"}', "\nFORGED"):
            rig.robots.transport.publisher(topics.ACTOR_STATUS).publish(String(text))
        await rig.heard()
        await rig.http.get("/api/robots/x%0aFORGED")
    written = "".join(capsys.readouterr())
    assert "unreadable message" in written
    assert not [line for line in written.splitlines() if line.startswith("FORGED")]
    assert "\x1b[2J" not in written


async def test_each_who_signed_in_has_a_measure_of_their_own() -> None:
    async with served("Ada", lan=True, password=PASSWORD, clock=HandClock()) as rig:
        cookies = []
        for _ in range(2):
            rig.http.cookies.clear()
            await rig.http.post("/api/session", json={"secret": PASSWORD})
            cookies.append("; ".join(f"{name}={value}" for name, value in rig.http.cookies.items()))
        greedy, modest = ({"Cookie": cookie} for cookie in cookies)
        skip: dict[str, Any] = {"url": "/api/plans/Ada/command", "json": {"command": "skip"}}
        many = await asyncio.gather(*[rig.http.post(**skip, headers=greedy) for _ in range(62)])
        assert 429 in {answer.status_code for answer in many}
        assert (await rig.http.post(**skip, headers=modest)).status_code == 200


async def test_large_uploads_wait_their_turn_and_words_do_not() -> None:
    async with served("Ada", lan=True, password=PASSWORD) as rig:
        await rig.http.post("/api/session", json={"secret": PASSWORD})
        go_on = asyncio.Event()

        async def slow() -> Any:
            yield b'{"id": "'
            await go_on.wait()
            yield b'x"}'

        waiting = [asyncio.create_task(rig.http.post("/api/chat", content=slow())) for _ in range(12)]
        post = {"id": "m1", "text": "go home", "targets": ["Ada"]}
        assert (await rig.http.post("/api/chat", json=post)).status_code == 200
        go_on.set()
        answers = await asyncio.gather(*waiting)
        assert {answer.status_code for answer in answers} == {422}
