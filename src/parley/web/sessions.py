"""Who is signed in: secrets are compared as slow hashes, of sessions only hashes are kept."""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol

from parley.clock import Clock
from parley.web.limits import Attempts
from parley.web.problems import WebProblem

__all__ = ["COOKIE", "Session", "SessionShelf", "Sessions", "cookie_name", "new_code"]

COOKIE: Final = "parley_session"
SESSION_S: Final = 30 * 24 * 3600
"""Wall time after which one has to sign in again."""
MAX_SESSIONS: Final = 1000
CODE_S: Final = 3600.0
"""Wall time after which a pairing code that nobody used gives way to another one."""
_CODE_LETTERS: Final = "23456789ABCDEFGHJKMNPQRSTUVWXYZ"
"""Without what is easily mixed up."""


def cookie_name(*, https: bool) -> str:
    """With HTTPS one that other servers on this machine can neither set nor read without HTTPS."""
    return f"__Host-{COOKIE}" if https else COOKIE


def new_code() -> str:
    """A pairing code: 39 bits, two groups of four."""
    letters = "".join(secrets.choice(_CODE_LETTERS) for _ in range(8))
    return f"{letters[:4]}-{letters[4:]}"


@dataclass(frozen=True, slots=True)
class Session:
    """One person at one browser."""

    digest: str
    """Hash of the cookie's value."""
    name: str
    """How they want to be called; may be empty."""
    ends_unix_ms: int


class SessionShelf(Protocol):
    """Where sessions are kept over restarts; see `parley.web.store.WebStore`."""

    async def settings(self, kind: str) -> dict[str, str]:
        """All settings of a kind."""
        ...

    async def set(self, kind: str, name: str, value: str) -> None:
        """Keep a setting."""
        ...

    async def sessions(self, unix_ms: int) -> list[tuple[str, str, int]]:
        """Digest, name and end of each session."""
        ...

    async def keep_session(self, digest: str, name: str, ends_unix_ms: int, *, instead_of: str) -> None:
        """Keep a session."""
        ...

    async def drop_session(self, digest: str) -> None:
        """Forget a session."""
        ...


class Sessions:
    """The doors of the page.

    Args:
        clock: Wall time.
        password: What one signs in with; empty: nobody has to, or with a code.
        pairs: Whether one signs in with a pairing code, where there is no password: each lets one device in.
    """

    def __init__(self, clock: Clock, password: str = "", *, pairs: bool = False) -> None:
        self._clock, self._password = clock, password
        self._pairs = pairs and not password
        self.required = bool(password) or pairs
        """Whether one has to sign in."""
        self.on_code: Callable[[str], None] = lambda _: None
        """Told of each new pairing code."""
        self._salt, self._key, self._hash = b"", b"", b""
        self._code, self._code_until_s = "", 0.0
        self._attempts = Attempts()
        self._sessions: dict[str, Session] = {}
        self._shelf: SessionShelf

    async def restore(self, shelf: SessionShelf) -> None:
        """Take up the sessions of an earlier run; those of another password or way to sign in do not count.

        Raises:
            StoreError: They cannot be read.
        """
        self._shelf = shelf
        salt = (await shelf.settings("door")).get("salt", "")
        if not salt:
            salt = secrets.token_hex(16)
            await shelf.set("door", "salt", salt)
        self._salt = bytes.fromhex(salt)
        way = "password" if self._password else "code" if self._pairs else "open"
        if self._password:
            self._hash = await asyncio.to_thread(_slow_hash, self._password, self._salt)
        # What is kept of a cookie hangs on how one signed in; once that is changed it means nothing.
        self._key = hmac.digest(self._salt, way.encode() + self._hash, "sha256")
        for digest, name, ends in await shelf.sessions(self._clock.unix_ms()):
            self._sessions[digest] = Session(digest, name, ends)

    @property
    def code(self) -> str:
        """The pairing code that holds now; empty where there is none."""
        if self._pairs and self._clock.wall_s() >= self._code_until_s:
            self._renew_code()
        return self._code

    def get(self, token: str) -> Session | None:
        """The session of a cookie, if it is one of ours and still holds."""
        session = self._sessions.get(self._digest(token)) if token else None
        return session if session is not None and session.ends_unix_ms > self._clock.unix_ms() else None

    async def open(self, secret: str, name: str, address: str, before: str = "") -> str:
        """Sign in.

        Args:
            secret: Password or pairing code.
            name: How the person wants to be called.
            address: Whence; counted when it fails.
            before: The value of the cookie until now; that session ends.

        Returns:
            The value of the cookie.

        Raises:
            WebProblem: The secret is wrong, or there were too many attempts.
            StoreError: The session cannot be kept.
        """
        if self.required:
            await self._check(secret, address)
        token, old = secrets.token_urlsafe(32), self._digest(before)
        session = Session(self._digest(token), name, self._clock.unix_ms() + SESSION_S * 1000)
        await self._shelf.keep_session(session.digest, name, session.ends_unix_ms, instead_of=old)
        self._sessions.pop(old, None)
        self._sessions[session.digest] = session
        if len(self._sessions) > MAX_SESSIONS:
            oldest = next(iter(self._sessions))
            del self._sessions[oldest]
            await self._shelf.drop_session(oldest)
        return token

    async def close(self, token: str) -> None:
        """Sign out, for good.

        Raises:
            StoreError: It cannot be kept that this session is over.
        """
        digest = self._digest(token)
        self._sessions.pop(digest, None)
        await self._shelf.drop_session(digest)

    async def _check(self, secret: str, address: str) -> None:
        wait_s = self._attempts.wait_s(address, self._clock.wall_s())
        if wait_s > 0:
            raise WebProblem(
                429,
                "There were too many wrong attempts.",
                f"Wait {int(wait_s) + 1} seconds and try again.",
                headers={"Retry-After": str(int(wait_s) + 1)},
            )
        # Counted before the slow comparison, so that many at once gain nothing.
        self._attempts.failed(address, self._clock.wall_s())
        if not (self._takes_code(secret) if self._pairs else await self._is_password(secret)):
            raise WebProblem(401, "That is not right.", "Look at the code or password again.", path="secret")
        self._attempts.succeeded(address)

    async def _is_password(self, secret: str) -> bool:
        given = await asyncio.to_thread(_slow_hash, secret, self._salt)
        return hmac.compare_digest(given, self._hash)

    def _takes_code(self, secret: str) -> bool:
        """Whether it is the code, which is used up then. Nothing is awaited here, so it is used once."""
        given, code = _plain_code(secret), _plain_code(self.code)
        if not hmac.compare_digest(given.encode(errors="replace"), code.encode()):
            return False
        self._renew_code()
        return True

    def _renew_code(self) -> None:
        self._code, self._code_until_s = new_code(), self._clock.wall_s() + CODE_S
        self.on_code(self._code)

    def _digest(self, token: str) -> str:
        return hmac.new(self._key, token.encode(errors="replace"), "sha256").hexdigest()


def _plain_code(secret: str) -> str:
    """People leave out or add the gaps of a pairing code, and write it small."""
    return secret.strip().replace("-", "").replace(" ", "").upper()


def _slow_hash(secret: str, salt: bytes) -> bytes:
    return hashlib.scrypt(
        secret.encode(errors="replace"), salt=salt, n=2**14, r=8, p=1, maxmem=64 * 1024 * 1024
    )
