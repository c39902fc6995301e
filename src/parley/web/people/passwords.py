"""Passwords are kept as argon2 hashes, which take long on purpose: few at once, and never on the loop."""

from __future__ import annotations

import asyncio
import hashlib
from typing import Final

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError
from argon2.low_level import Type, hash_secret_raw

from parley.web.people.records import SHORTEST_PASSWORD

__all__ = ["Passwords", "password_problem"]

AT_ONCE: Final = 2
"""Each takes 64 MiB."""
MAX_WAITING: Final = 32


def password_problem(password: str) -> str:
    """Why it cannot be a password; empty: it can."""
    return (
        ""
        if len(password) >= SHORTEST_PASSWORD
        else f"A password has at least {SHORTEST_PASSWORD} characters."
    )


class Passwords:
    """Makes and compares hashes."""

    def __init__(self) -> None:
        self._hasher = PasswordHasher()
        self._room = asyncio.Semaphore(AT_ONCE)
        self._waiting = 0
        self._nobodys = ""

    @property
    def is_crowded(self) -> bool:
        """Whether so many wait that nobody else should."""
        return self._waiting >= MAX_WAITING

    def hashed(self, password: str) -> str:
        """The hash to keep. Blocks."""
        return self._hasher.hash(password.encode(errors="replace"))

    async def hash(self, password: str) -> str:
        """The hash to keep."""
        return await asyncio.to_thread(self.hashed, password)

    async def fits(self, password: str, kept: str) -> bool:
        """Whether it is the password of a hash; for nobody's ("") it takes as long, and is not."""
        self._waiting += 1
        try:
            async with self._room:
                return await asyncio.to_thread(self._fits, password, kept)
        finally:
            self._waiting -= 1

    def _fits(self, password: str, kept: str) -> bool:
        if not kept and not self._nobodys:
            self._nobodys = self.hashed("nobody")
        try:
            return self._hasher.verify(kept or self._nobodys, password.encode(errors="replace")) and bool(
                kept
            )
        except (VerificationError, InvalidHashError):
            return False

    @staticmethod
    def stamp(password: str, salt: bytes) -> str:
        """Tells one password of all from another one, and is of no use to find it out. Blocks."""
        raw = hash_secret_raw(
            password.encode(errors="replace"),
            salt,
            time_cost=3,
            memory_cost=65536,
            parallelism=4,
            hash_len=32,
            type=Type.ID,
        )
        return hashlib.sha256(raw).hexdigest()
