"""The doors of the page: who is signed in, as whom, and what lets one in."""

from __future__ import annotations

import asyncio
import hmac
import secrets
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass
from typing import Any, Final, TypeVar

import structlog

from parley.clock import Clock
from parley.errors import StoreError
from parley.messages.audit import AuditEvent
from parley.messages.principal import Principal, Role, person
from parley.web.limits import Attempts
from parley.web.people.codes import Codes, looks_like_code
from parley.web.people.passkeys import Ceremonies, PasskeyRefusedError
from parley.web.people.passwords import Passwords
from parley.web.people.records import Device, Gadget, Person, Way, key_of
from parley.web.people.store import PeopleStore, Roll
from parley.web.problems import WebProblem

__all__ = ["COOKIE", "SESSION_S", "Sessions", "Visitor", "cookie_name"]

T = TypeVar("T")

log = structlog.get_logger(__name__)

COOKIE: Final = "parley_session"
SESSION_S: Final = 30 * 24 * 3600
"""Wall time after which one has to sign in again."""
MAX_SESSIONS: Final = 1000
LOOK_EVERY_S: Final = 1.0
"""Wall time between two looks at what others wrote about people, e.g. `parley people`."""
SEEN_EVERY_MS: Final = 60_000
"""So exactly is it kept when a device was last heard of."""


def cookie_name(*, https: bool) -> str:
    """With HTTPS one that other servers on this machine can neither set nor read without HTTPS."""
    return f"__Host-{COOKIE}" if https else COOKIE


@dataclass(frozen=True, slots=True)
class Visitor:
    """Whoever wants to come in."""

    gadget: Gadget
    before: str = ""
    """The value of the cookie until now; signing in ends that session."""


class Sessions:
    """Who is let in as what.

    With accounts one signs in with name and password, or a passkey. Without them with the one password of
    all, if there is one, else with a pairing code where the page is open to other devices; else nobody has
    to.

    Args:
        clock: Wall time.
        password: The one of all.
        pairs: Whether other devices may come.
        pair_as: What the code that is shown makes of a device.
    """

    def __init__(
        self, clock: Clock, password: str = "", *, pairs: bool = False, pair_as: Role = "operator"
    ) -> None:
        self._clock, self._password, self._pairs = clock, password, pairs
        self.roll = Roll()
        self.codes = Codes(pair_as)
        self.passwords = Passwords()
        self.ceremonies = Ceremonies()
        self.tell: Callable[[AuditEvent], None] = lambda _: None
        """Told of everything that is to be remembered of who came and went."""
        self.listeners: list[Callable[[], None]] = []
        """Told when somebody may do other things than before, or nothing any more."""
        self._salt, self._stamp, self._shared = b"", "", ""
        self._attempts = Attempts()
        self._seen: dict[str, int] = {}
        self._version = 0
        self.store: PeopleStore

    async def restore(self, store: PeopleStore) -> None:
        """Take up what an earlier run left; who signed in another way than is now asked for is not in.

        Raises:
            StoreError: It cannot be read.
        """
        self.store = store
        self._salt = await store.salt()
        if self._password:
            self._shared = await self.passwords.hash(self._password)
            self._stamp = await asyncio.to_thread(self.passwords.stamp, self._password, self._salt)
        self._version = await store.version()
        self.roll = await store.roll()

    # -- who is in -------------------------------------------------------------------------------------

    @property
    def way(self) -> Way:
        """How one comes in now."""
        if self.roll.people:
            return "account"
        return "password" if self._password else "code" if self._pairs else "open"

    @property
    def required(self) -> bool:
        """Whether one has to sign in."""
        return self.way != "open"

    @property
    def code(self) -> str:
        """The pairing code that is shown; empty where there is none."""
        return self.codes.shown(self._clock.wall_s()) if self.way == "code" else ""

    def get(self, token: str) -> Device | None:
        """Who is signed in with a cookie, if it is one of ours and still holds."""
        device = self.holding(self._digest(token)) if token else None
        if device is not None:
            now_ms = self._clock.unix_ms()
            if now_ms - self.seen(device) >= SEEN_EVERY_MS:
                self._seen[device.digest] = now_ms
        return device

    def holding(self, digest: str) -> Device | None:
        """The device of a digest, if it is still let in."""
        device = self.roll.devices.get(digest)
        return device if device is not None and self.role_of(device) is not None else None

    def role_of(self, device: Device) -> Role | None:
        """What a device's person may be; None: it is not let in any more."""
        if device.ends_unix_ms <= self._clock.unix_ms():
            return None
        way = self.way
        if device.way == "account":
            owner = self.roll.people.get(device.person)
            return None if owner is None or owner.disabled else owner.role
        if device.way == "code":
            return device.role if way in ("code", "account") else None
        if device.way == "password":
            return "supervisor" if way == "password" and device.stamp == self._stamp else None
        return "supervisor" if way == "open" else None

    def principal(self, device: Device | None, gadget: Gadget) -> Principal | None:
        """On whose account things happen; None: somebody who is not let in."""
        if device is None:
            return None if self.required else person(device=gadget.label, role="supervisor")
        held = self.holding(device.digest)  # it may have been signed out since it was asked for
        role = None if held is None else self.role_of(held)
        return None if role is None else device.principal(role)

    def seen(self, device: Device) -> int:
        """When a device was last heard of."""
        return max(device.seen_unix_ms, self._seen.get(device.digest, 0))

    def devices_of(self, device: Device) -> list[Device]:
        """All devices of the person of a device that are still let in, this one too."""
        return [
            each
            for each in self.roll.devices.values()
            if (each.digest == device.digest or (device.person and each.person == device.person))
            and self.role_of(each) is not None
        ]

    # -- coming in -------------------------------------------------------------------------------------

    async def sign_in(self, secret: str, name: str, visitor: Visitor) -> str:
        """Let somebody in, or not.

        Args:
            secret: Password or pairing code.
            name: Of the account; where there is none, how the person wants to be called.
            visitor: Who wants to come in.

        Returns:
            The value of the cookie.

        Raises:
            WebProblem: The secret is wrong, or there were too many attempts.
            StoreError: It cannot be kept.
        """
        way = self.way
        if way == "open":
            return await self._let_in("open", name, "supervisor", visitor)
        if way == "password":
            await self._attempt(visitor, "password", name, lambda: self.passwords.fits(secret, self._shared))
            return await self._let_in("password", name, "supervisor", visitor)
        owner = self.roll.people.get(
            key_of(name)
        )  # with a code nobody passes for somebody who has an account
        if way == "code" or (owner is None and looks_like_code(secret)):
            return await self._pair(secret, name, visitor)
        return await self._with_password(secret, name, owner, visitor)

    async def _with_password(self, secret: str, name: str, owner: Person | None, visitor: Visitor) -> str:
        async def check() -> bool:
            # Whoever is not there takes as long as whoever is.
            return await self.passwords.fits(secret, owner.hash if owner and not owner.disabled else "")

        await self._attempt(visitor, f"account {key_of(name)}", name, check)
        assert owner is not None
        return await self.open_for(owner, visitor)

    async def _pair(self, secret: str, name: str, visitor: Visitor) -> str:
        async def take() -> Role | None:
            return self.codes.take(secret, self._clock.wall_s(), is_shown=self.way == "code")

        role: Role = await self._attempt(visitor, "code", name, take)
        return await self._let_in("code", name, role, visitor)

    async def with_passkey(self, key: str, credential: dict[str, Any], origin: str, visitor: Visitor) -> str:
        """Let somebody in with a passkey.

        Raises:
            WebProblem: It does not hold, or there were too many attempts.
            StoreError: It cannot be kept.
        """
        kept = self.roll.passkeys.get(str(credential.get("id", "")))
        owner = self.roll.people.get(kept.person) if kept is not None else None

        async def check() -> tuple[Person, int] | None:
            if kept is None or owner is None or owner.disabled:
                return None
            try:
                count = self.ceremonies.take_known(key, credential, origin, kept, self._clock.wall_s())
            except PasskeyRefusedError as error:
                log.info("passkey refused", reason=str(error))
                return None
            return owner, count

        known, count = await self._attempt(visitor, "passkey", owner.name if owner else "", check)
        assert kept is not None
        await self.store.used_passkey(kept.id, count)
        await self.refresh()
        return await self.open_for(known, visitor)

    async def confirm(self, owner: Person, password: str, visitor: Visitor) -> None:
        """See that it is they who do something weighty.

        Raises:
            WebProblem: The password is not theirs, or there were too many attempts.
        """

        def check() -> Awaitable[bool]:
            return self.passwords.fits(password, owner.hash)

        wrong = WebProblem(422, "This is not your password.", "Type the one you have now.", path="old")
        await self._attempt(visitor, f"account {owner.key}", owner.name, check, wrong)

    async def open_for(self, owner: Person, visitor: Visitor) -> str:
        """Sign somebody in who has shown who they are."""
        return await self._let_in("account", owner.name, owner.role, visitor, owner.key)

    async def _attempt(
        self,
        visitor: Visitor,
        what: str,
        name: str,
        check: Callable[[], Awaitable[T | None]],
        wrong: WebProblem | None = None,
    ) -> T:
        """What a check finds.

        Raises:
            WebProblem: It finds nothing (or False), or there were too many attempts.
        """
        address = visitor.gadget.address
        wait_s = self._attempts.wait_s(address, what, self._clock.wall_s())
        if self.passwords.is_crowded:
            wait_s = max(wait_s, 1.0)
        if wait_s > 0:
            raise WebProblem(
                429,
                "There were too many wrong attempts.",
                f"Wait {int(wait_s) + 1} seconds and try again.",
                headers={"Retry-After": str(int(wait_s) + 1)},
            )
        # Counted before the slow comparison, so that many at once gain nothing.
        self._attempts.failed(address, what, self._clock.wall_s())
        found = await check()
        if not found:
            self._tell("sign_in", None, visitor.gadget, outcome="refused", detail={"name": name})
            raise wrong or WebProblem(
                401, "That is not right.", "Look at the code or password again.", path="secret"
            )
        self._attempts.succeeded(address, what)
        return found

    async def _let_in(self, way: Way, name: str, role: Role, visitor: Visitor, owner: str = "") -> str:
        token, old, now_ms = secrets.token_urlsafe(32), self._digest(visitor.before), self._clock.unix_ms()
        device = Device(
            digest=self._digest(token),
            id=secrets.token_hex(8),
            person=owner,
            name=name,
            role=role,
            way=way,
            stamp=self._stamp if way == "password" else "",
            gadget=visitor.gadget,
            created_unix_ms=now_ms,
            seen_unix_ms=now_ms,
            ends_unix_ms=now_ms + SESSION_S * 1000,
        )
        await self.store.keep_device(device, instead_of=old)
        self.roll.devices.pop(old, None)
        self.roll.devices[device.digest] = device
        if len(self.roll.devices) > MAX_SESSIONS:
            await self.sign_out([next(iter(self.roll.devices.values()))], None)
        if way != "open":
            self._tell("sign_in", device.principal(role), visitor.gadget)
        return token

    # -- going -----------------------------------------------------------------------------------------

    async def sign_out(self, devices: Iterable[Device], by: Principal | None) -> None:
        """Sign devices out, for good; their live streams end.

        Raises:
            StoreError: It cannot be kept that they are out.
        """
        gone = list(devices)
        await self.store.drop_devices([device.digest for device in gone])
        for device in gone:
            self.roll.devices.pop(device.digest, None)
            if by is not None and device.way != "open":
                detail = {"device": device.gadget.label, "name": device.name}
                self.tell(AuditEvent(effect="sign_out", by=by, detail=detail, unix_ms=self._clock.unix_ms()))
        self._changed()

    async def refresh(self) -> None:
        """Take up what was written about people; whoever may do less now is told, or out.

        Raises:
            StoreError: It cannot be read.
        """
        self.roll = await self.store.roll()
        for event in await self.store.take_happened():
            self.tell(event)
        self._changed()

    async def look(self) -> None:
        """See whether others wrote about people, and keep who was heard of.

        Raises:
            StoreError: It cannot be read or written.
        """
        seen, self._seen = self._seen, {}
        if seen:
            await self.store.saw(seen)
        version = await self.store.version()
        if version != self._version or seen:
            self._version = version
            await self.refresh()
        elif any(self.role_of(device) is None for device in self.roll.devices.values()):
            self._changed()

    async def watch(self) -> None:
        """Look again and again."""
        while True:
            await asyncio.sleep(LOOK_EVERY_S)
            try:
                await self.look()
            except StoreError as error:
                log.error("people not read", problem=str(error))

    def _changed(self) -> None:
        for listener in self.listeners:
            listener()

    def _tell(self, effect: str, by: Principal | None, gadget: Gadget, **more: Any) -> None:
        detail = {"address": gadget.address, "device": gadget.label} | more.pop("detail", {})
        self.tell(AuditEvent(effect=effect, by=by, detail=detail, unix_ms=self._clock.unix_ms(), **more))

    def _digest(self, token: str) -> str:
        return hmac.new(self._salt, token.encode(errors="replace"), "sha256").hexdigest()
