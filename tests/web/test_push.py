"""Devices whose page is closed are called: by a service that is played by a real HTTP server."""

from __future__ import annotations

import asyncio
import base64
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from queue import Queue
from typing import Any

from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.asymmetric.utils import encode_dss_signature
from cryptography.hazmat.primitives.ciphers.aead import AESGCM
from cryptography.hazmat.primitives.kdf.hkdf import HKDF
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

from tests.web.rig import Rig, served


def text_of(data: bytes) -> str:
    return base64.urlsafe_b64encode(data).rstrip(b"=").decode()


def bytes_of(text: str) -> bytes:
    return base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))


def derived(salt: bytes, key: bytes, info: bytes, length: int) -> bytes:
    return HKDF(hashes.SHA256(), length, salt, info).derive(key)


def vouched(authorization: str, key: str) -> dict[str, Any]:
    """What the server says of itself in `authorization` (RFC 8292), which it has to sign with its `key`."""
    scheme, _, rest = authorization.partition(" ")
    parts = dict(part.strip().split("=", 1) for part in rest.split(","))
    assert (scheme, parts["k"]) == ("vapid", key)
    told, _, signed = parts["t"].rpartition(".")
    r, s = (int.from_bytes(half) for half in (bytes_of(signed)[:32], bytes_of(signed)[32:]))
    public = ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), bytes_of(key))
    public.verify(encode_dss_signature(r, s), told.encode(), ec.ECDSA(hashes.SHA256()))
    claims: dict[str, Any] = json.loads(bytes_of(told.partition(".")[2]))
    return claims


class Browser:
    """A browser that was subscribed, and the service of its maker."""

    def __init__(self, url: str, got: Queue[tuple[str, bytes, str]]) -> None:
        self._key, self._secret = ec.generate_private_key(ec.SECP256R1()), bytes(range(16))
        self._url, self._got = url, got
        self.authorization = ""

    def subscription(self, path: str = "one") -> dict[str, str]:
        point = self._key.public_key().public_bytes(Encoding.X962, PublicFormat.UncompressedPoint)
        return {"endpoint": f"{self._url}/{path}", "p256dh": text_of(point), "auth": text_of(self._secret)}

    async def told(self) -> tuple[str, Any]:
        """What is told next: at which address, and what only this browser can read."""
        path, body, self.authorization = await asyncio.to_thread(self._got.get, timeout=20)
        return path, json.loads(self._read(body))

    def _read(self, body: bytes) -> bytes:
        """As RFC 8291 and RFC 8188 have browsers do it, written from their text."""
        salt, length = body[:16], body[20]
        sender, sealed = body[21 : 21 + length], body[21 + length :]
        assert int.from_bytes(body[16:20]) >= len(sealed), "one record"
        curve = ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), sender)
        own = self._key.public_key().public_bytes(Encoding.X962, PublicFormat.UncompressedPoint)
        shared = self._key.exchange(ec.ECDH(), curve)
        secret = derived(self._secret, shared, b"WebPush: info\0" + own + sender, 32)
        key = derived(salt, secret, b"Content-Encoding: aes128gcm\0", 16)
        nonce = derived(salt, secret, b"Content-Encoding: nonce\0", 12)
        text, _, padding = AESGCM(key).decrypt(nonce, sealed, None).rpartition(b"\2")
        assert not padding.strip(b"\0")
        return text


@contextmanager
def service(gone: str = "") -> Iterator[Browser]:
    """A push service; of the address `gone` it says that it is no more."""
    got: Queue[tuple[str, bytes, str]] = Queue()

    class Answer(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["content-length"]))
            got.put((self.path[1:], body, self.headers["authorization"]))
            self.send_response(410 if self.path[1:] == gone else 201)
            self.end_headers()

        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Answer)
    threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
    try:
        yield Browser(f"http://127.0.0.1:{server.server_port}", got)
    finally:
        server.shutdown()
        server.server_close()


async def put(rig: Rig, body: dict[str, str], **headers: str) -> int:
    return (await rig.http.put("/api/push", json=body, headers=headers)).status_code


async def test_a_device_is_told_in_its_language_what_a_robot_asks_and_called_no_more_when_it_is_gone(
    tmp_path: Path,
) -> None:
    with service(gone="two") as browser:
        services = (browser.subscription()["endpoint"].rsplit("/", 1)[0],)
        async with served("Ada", data_dir=tmp_path, push_services=services) as rig:
            key = (await rig.http.get("/api/push")).json()["key"]
            assert await put(rig, browser.subscription(), **{"accept-language": "et"}) == 200
            assert await put(rig, browser.subscription("two")) == 200
            rig.robots.ask("Where shall I bring it?")
            told = dict([await browser.told(), await browser.told()])
            assert told["one"] == {"title": "Ada", "body": "Kuhu ma selle viin?", "tag": told["two"]["tag"]}
            assert told["two"]["body"] == "Where shall I bring it?"
            claims = vouched(browser.authorization, key)
            assert (claims["aud"], claims["sub"][:6]) == (services[0], "https:")
            store = rig.server.backend.store

            async def kept() -> list[str]:
                return [endpoint.rsplit("/", 1)[1] for endpoint in await store.settings("push")]

            while await kept() != ["one"]:
                await rig.heard()
        assert (tmp_path / "push-key.pem").stat().st_mode & 0o777 == 0o600
        async with served("Ada", data_dir=tmp_path, push_services=services) as rig:
            rig.robots.ask("How far shall I move?", question_id="q2")
            assert (await browser.told())[1]["body"] == "Kui palju liigun?"


async def test_only_services_of_browsers_are_sent_to(tmp_path: Path) -> None:
    async with served("Ada") as rig:
        for endpoint, expected in [
            ("https://fcm.googleapis.com/fcm/send/abc", 200),
            ("https://web.push.apple.com/abc", 200),
            ("https://updates.push.services.mozilla.com/wpush/v2/abc", 200),
            ("http://fcm.googleapis.com/abc", 422),
            ("https://127.0.0.1/abc", 422),
            ("https://fcm.googleapis.com@127.0.0.1/abc", 422),
            ("https://fcm.googleapis.com.example.org/abc", 422),
            ("https://evilpush.apple.com/abc", 422),
        ]:
            body = Browser("", Queue()).subscription() | {"endpoint": endpoint}
            assert await put(rig, body) == expected, endpoint
        for broken in ({"p256dh": "x"}, {"auth": "x"}, {"auth": "ä"}):
            assert (
                await put(rig, Browser("https://fcm.googleapis.com", Queue()).subscription() | broken) == 422
            )


async def test_a_device_that_is_signed_out_is_called_no_more() -> None:
    with service() as browser:
        services = (browser.subscription()["endpoint"].rsplit("/", 1)[0],)
        async with served("Ada", password="correct horse", push_services=services) as rig:
            assert await put(rig, browser.subscription()) == 401
            session = await rig.http.post("/api/session", json={"secret": "correct horse", "name": "Kim"})
            assert session.status_code == 200, session.text
            assert await put(rig, browser.subscription()) == 200
            pusher = rig.server.backend.pusher
            assert len(await rig.server.backend.store.settings("push")) == 1
            assert (await rig.http.delete("/api/session")).status_code in (200, 204)
            rig.robots.ask("Where shall I bring it?")
            await rig.until(lambda: rig.server.backend.state.chat.entries)
            while await rig.server.backend.store.settings("push"):
                await rig.heard()
            assert not pusher.has_any
