"""What is kept of people and of the devices they are signed in on."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from typing import Literal

from parley.messages.principal import Principal, Role, person

__all__ = [
    "SHORTEST_PASSWORD",
    "Device",
    "Gadget",
    "Passkey",
    "Person",
    "Way",
    "gadget_of",
    "key_of",
    "name_problem",
]

SHORTEST_PASSWORD = 8
LONGEST_NAME = 60

Way = Literal["open", "code", "password", "account"]
"""How one comes in: without signing in, by a pairing code, by the one password of all, by an account."""


@dataclass(frozen=True, slots=True)
class Person:
    """Somebody with an account."""

    name: str
    role: Role
    hash: str
    """Of the password, with argon2."""
    created_unix_ms: int
    seen_unix_ms: int = 0
    """When they signed in last."""
    disabled: bool = False

    @property
    def key(self) -> str:
        """The name as it is looked up."""
        return key_of(self.name)


@dataclass(frozen=True, slots=True)
class Passkey:
    """A way to sign in that a device or a stick keeps."""

    id: str
    """Of the credential, base64url."""
    person: str
    """Key of whose it is."""
    name: str
    public_key: bytes
    count: int
    created_unix_ms: int
    seen_unix_ms: int = 0


@dataclass(frozen=True, slots=True)
class Gadget:
    """What somebody looks at the page with."""

    kind: Literal["phone", "tablet", "computer", "program"] = "computer"
    browser: str = ""
    address: str = ""

    @property
    def label(self) -> str:
        """As it stands with what comes from it."""
        return "a program" if self.kind == "program" else f"page on a {self.kind}"


@dataclass(frozen=True, slots=True)
class Device:
    """One browser in which somebody is signed in."""

    digest: str
    """Hash of the cookie's value."""
    id: str
    """Names it to people; opens nothing."""
    person: str
    """Key of the account; empty where there is none."""
    name: str
    """How the person wants to be called; may be empty."""
    role: Role
    """Of an account the person's own counts."""
    way: Way
    stamp: str
    """Of the one password that held then."""
    gadget: Gadget
    created_unix_ms: int
    seen_unix_ms: int
    ends_unix_ms: int

    def principal(self, role: Role) -> Principal:
        """On whose account things happen."""
        return person(self.name, device=self.gadget.label, role=role)


def key_of(name: str) -> str:
    """Names are the same whatever the capitals."""
    return unicodedata.normalize("NFKC", name).casefold().strip()


def name_problem(name: str) -> str:
    """Why nobody can be called so; empty: they can."""
    if not name.strip() or name != name.strip() or len(name) > LONGEST_NAME:
        return f"A name has 1 to {LONGEST_NAME} characters and no space at its ends."
    if any(unicodedata.category(each)[0] == "C" or each in "/\\" for each in name):
        return "A name has no slashes and nothing that cannot be seen."
    return ""


_BROWSERS = (
    ("Edg/", "Edge"),
    ("OPR/", "Opera"),
    ("Firefox/", "Firefox"),
    ("Chrome/", "Chrome"),
    ("Safari/", "Safari"),
)


def gadget_of(user_agent: str, address: str) -> Gadget:
    """What a browser says of itself, in one word or two; nothing hangs on it."""
    browser = next((name for mark, name in _BROWSERS if mark in user_agent), "")
    if not user_agent.startswith("Mozilla/"):
        return Gadget("program", "", address)
    if (
        "iPad" in user_agent
        or "Tablet" in user_agent
        or ("Android" in user_agent and "Mobile" not in user_agent)
    ):
        return Gadget("tablet", browser, address)
    if "iPhone" in user_agent or "Mobile" in user_agent:
        return Gadget("phone", browser, address)
    return Gadget("computer", browser, address)
