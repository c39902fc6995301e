"""Who is signed in: secrets are compared as slow hashes, sessions are random names kept on the server."""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import secrets
from dataclasses import dataclass
from typing import Final

from parley.clock import Clock
from parley.web.limits import Attempts
from parley.web.problems import WebProblem

__all__ = ["COOKIE", "Session", "Sessions"]

COOKIE: Final = "parley_session"
SESSION_S: Final = 30 * 24 * 3600
"""Wall time after which one has to sign in again."""
MAX_SESSIONS: Final = 1000


@dataclass(frozen=True, slots=True)
class Session:
    """One person at one browser."""

    name: str
    """How they want to be called; may be empty."""
    ends_s: float
    """Wall time."""


class Sessions:
    """The doors of the page.

    Args:
        clock: Wall time.
        secret: What one signs in with; empty: nobody has to.
    """

    def __init__(self, clock: Clock, secret: str = "") -> None:
        self._clock, self._salt = clock, secrets.token_bytes(16)
        self._hash = _slow_hash(_plain(secret), self._salt) if secret else b""
        self._attempts = Attempts()
        self._sessions: dict[str, Session] = {}

    @property
    def required(self) -> bool:
        """Whether one has to sign in."""
        return bool(self._hash)

    def get(self, token: str) -> Session | None:
        """The session of a cookie, if it is one of ours and still holds."""
        session = self._sessions.get(_digest(token)) if token else None
        return session if session is not None and session.ends_s > self._clock.wall_s() else None

    async def open(self, secret: str, name: str, address: str) -> str:
        """Sign in.

        Args:
            secret: Password or pairing code.
            name: How the person wants to be called.
            address: Whence; counted when it fails.

        Returns:
            The value of the cookie.

        Raises:
            WebProblem: The secret is wrong, or there were too many attempts.
        """
        if self._hash:
            await self._check(secret, address)
        token = secrets.token_urlsafe(32)
        self._sessions[_digest(token)] = Session(name, self._clock.wall_s() + SESSION_S)
        if len(self._sessions) > MAX_SESSIONS:
            del self._sessions[next(iter(self._sessions))]
        return token

    def close(self, token: str) -> None:
        """Sign out."""
        self._sessions.pop(_digest(token), None)

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
        given = await asyncio.to_thread(_slow_hash, _plain(secret), self._salt)
        if not hmac.compare_digest(given, self._hash):
            raise WebProblem(401, "That is not right.", "Look at the code or password again.", path="secret")
        self._attempts.succeeded(address)


def _plain(secret: str) -> str:
    """People leave out or add the gaps of a pairing code, and write it small."""
    cleaned = secret.strip().replace("-", "").replace(" ", "")
    return cleaned.upper() if len(cleaned) == 8 and cleaned.isalnum() else secret


def _slow_hash(secret: str, salt: bytes) -> bytes:
    return hashlib.scrypt(
        secret.encode(errors="replace"), salt=salt, n=2**14, r=8, p=1, maxmem=64 * 1024 * 1024
    )


def _digest(token: str) -> str:
    return hashlib.sha256(token.encode(errors="replace")).hexdigest()
