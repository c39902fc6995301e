"""Who may do what, from where, how much, and what answers carry."""

from __future__ import annotations

import asyncio
import json
import ssl
from pathlib import Path
from typing import Any

import aiohttp
import httpx
import pytest
import socketio

from parley.clock import WallClock
from parley.errors import ConfigError
from parley.transport.local import LocalTransport
from parley.web.config import WebConfig
from parley.web.server import WebServer
from parley.web.tls import made_certificate
from tests.web.rig import HandClock, Page, served

PASSWORD = "correct horse battery"
STOP = {"command": "stop"}


async def test_on_this_machine_nobody_has_to_sign_in() -> None:
    async with served() as rig:
        session = (await rig.http.get("/api/session")).json()
        assert (session["required"], session["authenticated"]) == (False, True)
        assert rig.url.startswith("http://127.0.0.1:")


async def test_a_name_once_told_stands_with_what_is_said() -> None:
    async with served("Ada") as rig:
        await rig.http.post("/api/session", json={"name": "Kim"})
        post = {"id": "m1", "text": "go home", "targets": ["Ada"]}
        said = (await rig.http.post("/api/chat", json=post)).json()
        assert (said["author"], said["device"]) == ("Kim", "a program")
        await rig.http.delete("/api/session")
        assert (await rig.http.get("/api/session")).json()["name"] == ""


@pytest.mark.parametrize("path", ["/api/snapshot", "/api/chat", "/api/robots", "/api/feeds/Ada/camera.jpg"])
async def test_in_the_network_nothing_is_told_before_signing_in(path: str) -> None:
    async with served("Ada", lan=True, password=PASSWORD) as rig:
        assert rig.url.startswith("https://")
        answer = await rig.http.get(path)
        assert answer.status_code == 401
        assert answer.headers["content-type"] == "application/problem+json"
        assert (await rig.http.post("/api/stop", json=STOP)).status_code == 401
        await rig.heard()
        assert rig.robots.stops == []


async def test_signing_in_opens_everything_until_one_signs_out() -> None:
    async with served("Ada", lan=True, password=PASSWORD) as rig:
        answer = await rig.http.post("/api/session", json={"secret": PASSWORD, "name": "Kim"})
        cookie = answer.headers["set-cookie"].lower()
        assert all(word in cookie for word in ("httponly", "secure", "samesite=strict"))
        assert (await rig.http.get("/api/snapshot")).status_code == 200
        stolen = "; ".join(f"{name}={value}" for name, value in rig.http.cookies.items())
        await rig.http.delete("/api/session")
        again = await rig.http.get("/api/snapshot", headers={"Cookie": stolen})
        assert again.status_code == 401


async def test_the_live_stream_is_closed_to_strangers() -> None:
    async with served("Ada", lan=True, password=PASSWORD) as rig:
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(ssl=False)) as plain:
            stranger = socketio.AsyncClient(reconnection=False, http_session=plain)
            with pytest.raises(socketio.exceptions.ConnectionError):
                await stranger.connect(rig.url, transports=["websocket"])
        await rig.http.post("/api/session", json={"secret": PASSWORD})
        cookie = "; ".join(f"{name}={value}" for name, value in rig.http.cookies.items())
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(ssl=False)) as plain:
            page = Page()
            page.io.eio.http = plain
            page.io.eio.external_http = True
            await page.open(rig.url, headers={"Cookie": cookie})
            await page.until(lambda: page.snapshots)
            await page.io.disconnect()


async def test_wrong_attempts_are_slowed_down_and_the_right_one_waits_too() -> None:
    async with served(lan=True, password=PASSWORD) as rig:
        codes = []
        for _ in range(7):
            codes.append((await rig.http.post("/api/session", json={"secret": "guess"})).status_code)
        assert codes[:5] == [401] * 5
        assert codes[-1] == 429
        right = await rig.http.post("/api/session", json={"secret": PASSWORD})
        assert right.status_code == 429
        assert int(right.headers["retry-after"]) >= 1


async def test_many_attempts_at_once_are_counted_like_those_one_by_one() -> None:
    async with served(lan=True, password=PASSWORD) as rig:
        guesses = [rig.http.post("/api/session", json={"secret": f"g{n}"}) for n in range(20)]
        codes = [answer.status_code for answer in await asyncio.gather(*guesses)]
        assert codes.count(401) <= 5


async def test_without_a_password_a_pairing_code_is_made_and_may_be_typed_carelessly() -> None:
    async with served(lan=True) as rig:
        code = rig.server.pairing_code
        assert len(code) == 9
        careless = code.replace("-", " ").lower()
        answer = await rig.http.post("/api/session", json={"secret": careless})
        assert answer.status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8400", "127.0.0.1.evil.example", ""])
async def test_requests_under_a_foreign_name_are_refused(host: str) -> None:
    async with served() as rig:
        answer = await rig.http.get("/api/snapshot", headers={"Host": host})
        assert answer.status_code in (400, 403)


@pytest.mark.parametrize("origin", ["https://evil.example", "null", "http://127.0.0.1:1"])
async def test_pages_of_another_origin_change_nothing_and_hear_nothing(origin: str) -> None:
    async with served("Ada") as rig:
        answer = await rig.http.post("/api/stop", json=STOP, headers={"Origin": origin})
        assert answer.status_code == 403
        page = Page()
        with pytest.raises(socketio.exceptions.ConnectionError):
            await page.open(rig.url, headers={"Origin": origin})
        await page.close()
        polled = await rig.http.get(
            "/socket.io/", params={"EIO": "4", "transport": "polling"}, headers={"Origin": origin}
        )
        assert polled.status_code == 403
        await rig.heard()
        assert rig.robots.stops == []


async def test_own_and_allowed_origins_may() -> None:
    async with served(origins=("http://localhost:5173",)) as rig:
        for origin in (rig.url.rstrip("/"), "http://localhost:5173"):
            answer = await rig.http.post("/api/stop", json=STOP, headers={"Origin": origin})
            assert answer.status_code == 200


async def test_answers_are_sealed() -> None:
    async with served() as rig:
        for path in ("/", "/api/health", "/api/none", "/no/such/page"):
            headers = (await rig.http.get(path)).headers
            policy = headers["content-security-policy"]
            assert "default-src 'none'" in policy
            assert "unsafe" not in policy
            assert "frame-ancestors 'none'" in policy
            assert headers["x-content-type-options"] == "nosniff"
            assert "server" not in headers
        assert (await rig.http.get("/api/health")).headers["cache-control"] == "no-store"


async def test_large_bodies_are_refused_whether_or_not_their_length_is_told() -> None:
    async with served("Ada") as rig:
        big = json.dumps({"command": "stop", "id": "x" * 100_000}).encode()

        async def untold() -> Any:
            for start in range(0, len(big), 10_000):
                yield big[start : start + 10_000]

        assert (await rig.http.post("/api/stop", content=big)).status_code == 413
        assert (await rig.http.post("/api/stop", content=untold())).status_code == 413


async def test_too_many_changes_at_once_are_refused_but_never_a_stop() -> None:
    clock = HandClock()
    async with served("Ada", clock=clock) as rig:
        post = {"command": "skip"}
        many = [rig.http.post("/api/plans/Ada/command", json=post) for _ in range(65)]
        codes = [answer.status_code for answer in await asyncio.gather(*many)]
        assert (codes.count(200), codes.count(429)) == (60, 5)
        stops = [await rig.http.post("/api/stop", json=STOP) for _ in range(10)]
        assert {answer.status_code for answer in stops} == {200}
        clock.ahead_s = 1.0
        assert (await rig.http.post("/api/plans/Ada/command", json=post)).status_code == 200


async def test_a_large_message_on_the_live_stream_ends_that_client_alone() -> None:
    async with served("Ada") as rig:
        page, other = await rig.page(), await rig.page()
        gone = asyncio.Event()
        page.io.on("disconnect", lambda *_: gone.set())
        await page.io.emit("watch", "x" * 200_000)
        async with asyncio.timeout(10):
            await gone.wait()
        rig.robots.appear("Bob")
        await other.until(lambda: other.of("robot"))


async def test_a_certificate_is_made_once_for_the_same_names(tmp_path: Path) -> None:
    now = WallClock().unix_ms()
    certificate, key = made_certificate(tmp_path, ["localhost", "192.0.2.7"], now)
    first = certificate.read_bytes()
    assert key.stat().st_mode & 0o077 == 0
    made_certificate(tmp_path, ["localhost"], now)
    assert certificate.read_bytes() == first
    made_certificate(tmp_path, ["localhost", "192.0.2.8"], now)
    assert certificate.read_bytes() != first


async def test_the_made_certificate_holds_for_this_machine(tmp_path: Path) -> None:
    async with served(lan=True, password=PASSWORD, data_dir=tmp_path) as rig:
        trust = ssl.create_default_context(cafile=str(tmp_path / "certificate.pem"))
        async with httpx.AsyncClient(verify=trust) as strict:
            assert (await strict.get(f"{rig.url}api/health")).status_code == 200


async def test_a_given_certificate_without_its_key_is_refused(tmp_path: Path) -> None:
    async with LocalTransport() as transport:
        with pytest.raises(ConfigError, match="--key"):
            async with WebServer(transport, WebConfig(port=0, certificate=tmp_path / "c.pem")):
                pass


async def test_a_port_that_is_taken_is_named_or_replaced() -> None:
    async with served() as rig:
        port = int(rig.url.rstrip("/").rpartition(":")[2])
        with pytest.raises(ConfigError, match="--port"):
            async with WebServer(rig.robots.transport, WebConfig(port=port)):
                pass
        async with WebServer(rig.robots.transport, WebConfig(port=port), port_is_wish=True) as second:
            assert second.url != rig.url
            assert second.instead_of == port
