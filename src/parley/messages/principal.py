"""Who is behind a message: a person, a language engine, a standing rule, a schedule, a program, a robot."""

from __future__ import annotations

from typing import Literal

from parley.messages.base import Payload

__all__ = ["ROLES", "Principal", "PrincipalKind", "Role", "person", "program"]

PrincipalKind = Literal["person", "engine", "rule", "schedule", "program", "robot"]
Role = Literal["viewer", "operator", "supervisor"]

ROLES: tuple[Role, ...] = ("viewer", "operator", "supervisor")
"""What people may be, from the least to the most."""


class Principal(Payload):
    """Somebody on whose account something happens.

    It is stamped where somebody comes in: by the page's server, the terminal, the chat interface. A message
    that carries none comes from a program that nobody vouches for. Who may write to a topic at all is the
    transport's matter (SROS2, access control of the broker), not this one's.
    """

    kind: PrincipalKind = "program"
    name: str = ""
    """Of a person how they are called; of a language engine or program which; of a rule whose it is."""
    device: str = ""
    """Of a person: through what, e.g. ``page on a phone``, ``terminal``."""
    role: Role | Literal[""] = ""
    """Of a person; empty: an operator."""
    key: str = ""
    """Of a program: the name of the key by which it is known; empty: nobody vouches for it."""

    @property
    def is_person(self) -> bool:
        """Whether it is somebody who can say yes."""
        return self.kind == "person"

    def __str__(self) -> str:
        """In one short piece of text for logs, e.g. ``person:Kim (terminal)``."""
        return f"{self.kind}:{self.name}" + (f" ({self.device})" if self.device else "")


def person(name: str = "", *, device: str = "", role: Role = "operator") -> Principal:
    """A person."""
    return Principal(kind="person", name=name, device=device, role=role)


def program(name: str, *, key: str = "") -> Principal:
    """A program; with the name of the key by which people know it, it counts as known."""
    return Principal(kind="program", name=name, key=key)
