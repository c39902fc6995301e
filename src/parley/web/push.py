"""Web Push: devices whose page is closed are called when a robot begins to wait for a person.

What a browser gave is an address at its maker's service and keys; what is sent there only that browser can
read. A call is tried once: where there is no network nobody is called, and the page itself still shows what
waits.
"""

from __future__ import annotations

import asyncio
import base64
import json
import os
from collections.abc import Coroutine, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self
from urllib.parse import urlsplit

import structlog
from pydantic import BaseModel, ConfigDict

from parley.errors import StoreError
from parley.sentences import Sentence, SpokenLanguage, in_language, sentence
from parley.web.people.records import Gadget
from parley.web.sessions import Sessions
from parley.web.state import WebState
from parley.web.store import WebStore

if TYPE_CHECKING:
    from py_vapid import Vapid02

__all__ = ["Pusher", "Subscription"]

log = structlog.get_logger(__name__)

_KIND: Final = "push"
_FILE: Final = "push-key.pem"
_TIMEOUT_S: Final = 10.0
_KEPT_S: Final = 600
"""Wall time for which a service keeps a call for a device that is switched off."""
_MOST: Final = 200
_SECRET_BYTES: Final = 16
_AT_ONCE: Final = 4
_GONE: Final = (404, 410)
"""What a service says when a browser took its subscription back."""


class Subscription(BaseModel):
    """Where one browser is called."""

    model_config = ConfigDict(frozen=True)

    endpoint: str
    p256dh: str
    auth: str
    language: SpokenLanguage = "en"
    device: str = ""
    """Digest of the device that is signed in there; empty where nobody has to."""


class Pusher:
    """Calls the devices that want it. Use as ``async with``.

    Args:
        store: Keeps the subscriptions.
        state: What waits.
        sessions: Which devices are let in.
        folder: Where the key is kept that is made at the first use; None: it lasts as long as the server.
        services: Where calls may be sent: addresses such as ``https://*.example.org``.
        contact: Where this server is, for those who run the services.
    """

    def __init__(
        self,
        store: WebStore,
        state: WebState,
        sessions: Sessions,
        *,
        folder: Path | None,
        services: Sequence[str],
        contact: str,
    ) -> None:
        self._store, self._state, self._sessions = store, state, sessions
        self._folder, self._services, self._contact = folder, services, contact
        self._key: Vapid02 | None = None
        self._known: set[str] = set()
        self._subscriptions: dict[str, Subscription] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._turns = asyncio.Semaphore(_AT_ONCE)

    async def __aenter__(self) -> Self:
        kept = await self._store.settings(_KIND)
        self._subscriptions = {name: Subscription.model_validate_json(text) for name, text in kept.items()}
        self._known = set(self._waiting())
        self._state.log.listen(self._look)
        self._sessions.listeners.append(self._drop_strangers)
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    @property
    def has_any(self) -> bool:
        """Whether anybody wants to be called."""
        return bool(self._subscriptions)

    # -- who is called ---------------------------------------------------------------------------------

    async def public_key(self) -> str:
        """What a browser needs to subscribe."""
        from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

        key = await self._made_key()
        point = key.public_key.public_bytes(Encoding.X962, PublicFormat.UncompressedPoint)
        return base64.urlsafe_b64encode(point).rstrip(b"=").decode()

    def may_send_to(self, endpoint: str) -> bool:
        """Whether an address belongs to a service that browsers use: this server sends to no other."""
        given = urlsplit(endpoint)
        for service in self._services:
            known = urlsplit(service)
            host = given.netloc if "@" not in given.netloc else ""
            ending = known.netloc.removeprefix("*")
            fits = host == known.netloc if ending == known.netloc else host.endswith(ending)
            if given.scheme == known.scheme and fits:
                return True
        return False

    def is_readable(self, wanted: Subscription) -> bool:
        """Whether something can be written that the browser reads with the keys it gave."""
        from cryptography.hazmat.primitives.asymmetric import ec

        try:
            ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), _bytes_of(wanted.p256dh))
        except ValueError:
            return False
        return len(_bytes_of(wanted.auth)) == _SECRET_BYTES

    async def subscribe(self, wanted: Subscription) -> None:
        """Call this browser from now on; a device has one subscription."""
        before = [
            one.endpoint
            for one in self._subscriptions.values()
            if one.endpoint == wanted.endpoint or (wanted.device and one.device == wanted.device)
        ]
        too_many = list(self._subscriptions)[: max(len(self._subscriptions) - _MOST + 1, 0)]
        for endpoint in {*before, *too_many}:
            await self.unsubscribe(endpoint)
        self._subscriptions[wanted.endpoint] = wanted
        await self._store.set(_KIND, wanted.endpoint, wanted.model_dump_json())

    async def unsubscribe(self, endpoint: str) -> None:
        """Call it no more."""
        self._subscriptions.pop(endpoint, None)
        await self._store.unset(_KIND, endpoint)

    def _drop_strangers(self) -> None:
        """Devices that are signed out are called no more."""
        is_open = self._sessions.principal(None, Gadget()) is not None
        for one in list(self._subscriptions.values()):
            if not (self._sessions.holding(one.device) is not None if one.device else is_open):
                self._subscriptions.pop(one.endpoint)
                self._spawn(self._forget(one.endpoint))

    async def _forget(self, endpoint: str) -> None:
        try:
            await self.unsubscribe(endpoint)
        except StoreError as error:
            log.error("a device that is called no more is still kept", problem=str(error))

    # -- calling ---------------------------------------------------------------------------------------

    def _waiting(self) -> dict[str, tuple[str, Sentence]]:
        """What waits for a person: who, and in words."""
        asked = {
            entry.id: (", ".join(entry.targets), sentence("{what}", what=entry.message))
            for entry in self._state.chat.entries.values()
            if entry.question == "open"
        }
        proposed = {
            one.id: (
                one.robot,
                sentence("{robot} waits for a yes: {what}", robot=one.robot, what=one.message),
            )
            for one in self._state.plans.proposals.values()
        }
        return asked | proposed

    def _look(self) -> None:
        if not self.has_any:
            return
        waiting = self._waiting()
        fresh, self._known = waiting.keys() - self._known, set(waiting)
        for key in fresh:
            robot, text = waiting[key]
            for one in self._subscriptions.values():
                self._spawn(self._call(one, key, robot, text))

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work, name="web push")
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _call(self, one: Subscription, key: str, robot: str, text: Sentence) -> None:
        told = json.dumps({"title": robot, "body": in_language(text, one.language), "tag": key})
        async with self._turns:
            status = await asyncio.to_thread(self._send, await self._made_key(), one, told)
        if status in _GONE:
            await self._forget(one.endpoint)

    def _send(self, key: Vapid02, one: Subscription, told: str) -> int:
        """Hand a call to a service; its status, 0 where it was not reached."""
        import requests
        from pywebpush import WebPushException, webpush

        where = urlsplit(one.endpoint)
        with requests.Session() as session:
            session.max_redirects = 0  # what was checked is where it goes
            try:
                webpush(
                    {"endpoint": one.endpoint, "keys": {"p256dh": one.p256dh, "auth": one.auth}},
                    told,
                    vapid_private_key=key,
                    vapid_claims={"sub": self._contact, "aud": f"{where.scheme}://{where.netloc}"},
                    ttl=_KEPT_S,
                    timeout=_TIMEOUT_S,
                    headers={"Urgency": "high"},
                    requests_session=session,
                )
            except WebPushException as error:
                log.warning("a device is not called", service=where.netloc, problem=str(error))
                return error.response.status_code if error.response is not None else 0
            except requests.RequestException as error:
                log.warning("a device is not called", service=where.netloc, problem=repr(error))
                return 0
        return 201

    async def _made_key(self) -> Vapid02:
        if self._key is None:
            self._key = await asyncio.to_thread(_made, self._folder)
        return self._key


def _bytes_of(text: str) -> bytes:
    try:
        return base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
    except ValueError:
        return b""


def _made(folder: Path | None) -> Vapid02:
    """The key that this server is known by, made at the first use; only its owner may read it."""
    from py_vapid import Vapid02

    file = folder / _FILE if folder is not None else None
    if file is not None:
        with suppress(FileNotFoundError):
            return Vapid02.from_pem(file.read_bytes())
    key = Vapid02()
    key.generate_keys()
    if file is not None:
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "wb") as written:
            written.write(key.private_pem())
    return key
