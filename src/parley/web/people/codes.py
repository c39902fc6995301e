"""Pairing codes: each lets one device in. Pure: the time is handed in."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from parley.messages.principal import Role

__all__ = ["CODE_S", "TRIES", "Codes", "looks_like_code", "new_code"]

CODE_S: Final = 3600.0
"""Wall time after which a code that nobody used gives way to another one."""
TRIES: Final = 200
"""Wrong codes from whomever after which all codes give way to others: of 39 bits that is nothing."""
MAX_MADE: Final = 20
_LETTERS: Final = "23456789ABCDEFGHJKMNPQRSTUVWXYZ"
"""Without what is easily mixed up."""


def new_code() -> str:
    """39 bits, two groups of four."""
    letters = "".join(secrets.choice(_LETTERS) for _ in range(8))
    return f"{letters[:4]}-{letters[4:]}"


def _plain(secret: str) -> str:
    """People leave out or add the gaps, and write it small."""
    return secret.strip().replace("-", "").replace(" ", "").upper()


def looks_like_code(secret: str) -> bool:
    """Whether somebody may have meant a code."""
    plain = _plain(secret)
    return len(plain) == 8 and set(plain) <= set(_LETTERS)


@dataclass(slots=True, eq=False)
class _Code:
    text: str
    role: Role
    until_s: float
    tries: int = TRIES


class Codes:
    """Those that hold: one that is shown all the time, and those made for somebody.

    Args:
        role: Of whom the code that is shown lets in.
    """

    def __init__(self, role: Role) -> None:
        self.role = role
        self.on_new: Callable[[str], None] = lambda _: None
        """Told of each new code that is to be shown."""
        self._shown: _Code | None = None
        self._made: list[_Code] = []

    def shown(self, now_s: float) -> str:
        """The code that is shown now."""
        if self._shown is None or now_s >= self._shown.until_s:
            self._renew(now_s)
        assert self._shown is not None
        return self._shown.text

    def make(self, role: Role, now_s: float) -> str:
        """Another code, for somebody of a role."""
        code = _Code(new_code(), role, now_s + CODE_S)
        self._made = [*self._made[1 - MAX_MADE :], code]
        return code.text

    def take(self, secret: str, now_s: float, *, is_shown: bool) -> Role | None:
        """The role that a code gives; it is used up, and as nothing is awaited, once. None: it is none.

        Args:
            secret: What was typed.
            now_s: Now.
            is_shown: Whether the code that is shown all the time counts as well.
        """
        if is_shown:
            self.shown(now_s)
        self._made = [code for code in self._made if now_s < code.until_s]
        holding = [*self._made, *([self._shown] if is_shown and self._shown else [])]
        given = _plain(secret).encode(errors="replace")
        found = [code for code in holding if hmac.compare_digest(given, _plain(code.text).encode())]
        for code in [] if found else holding:
            code.tries -= 1
        over = [code for code in holding if code in found or code.tries <= 0]
        self._made = [code for code in self._made if code not in over]
        if self._shown in over:
            self._renew(now_s)
        return found[0].role if found else None

    def _renew(self, now_s: float) -> None:
        self._shown = _Code(new_code(), self.role, now_s + CODE_S)
        self.on_new(self._shown.text)
