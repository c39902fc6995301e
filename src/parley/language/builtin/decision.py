"""What comes of a message: one object, from which reply, plan and deed are made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from parley.language.builtin.skills import Skill
from parley.messages.chat import CommandName

__all__ = ["Answer", "Ask", "Control", "Decision", "Deed", "Do", "Note", "Remember", "Told"]


@dataclass(frozen=True, slots=True)
class Deed:
    """One step of a plan."""

    frame: str
    """Whose words say it in the reply."""
    skill: Skill
    arguments: Mapping[str, str | float | bool]
    """Parameter -> value."""
    said: Mapping[str, str]
    """Role -> words for the reply."""
    hidden: bool = False
    """Whether it only prepares the next one, and is not worth a word."""
    check: Deed | None = None
    """The earlier deed that decides whether it is done."""
    open_ended: bool = False
    """Whether it is to wait for what comes next, and means nothing if nothing comes."""
    holds: bool = True
    """With which result of that."""
    text: str = ""
    """How the reply says it, where no frame does."""


@dataclass(frozen=True, slots=True)
class Note:
    """What is added to a reply: a memory that was used, a wish about the manner that cannot be met."""

    text: str
    source: str = ""
    """Name of the memory."""


@dataclass(frozen=True, slots=True)
class Told:
    """A fact to be remembered."""

    name: str
    text: str
    about: str
    is_rule: bool = False
    """Whether it says what to do when something happens."""


@dataclass(frozen=True, slots=True)
class Do:
    """Deeds, all of them certain."""

    deeds: tuple[Deed, ...]
    notes: tuple[Note, ...] = ()
    told: tuple[Told, ...] = ()
    robots: tuple[str, ...] = ()
    """Who is to do it."""


@dataclass(frozen=True, slots=True)
class Ask:
    """A question; nothing is done yet."""

    question: str
    choices: tuple[str, ...] = ()
    told: tuple[Told, ...] = ()
    offer: tuple[Deed, ...] = ()
    """What a yes would do."""


@dataclass(frozen=True, slots=True)
class Remember:
    """Facts to be remembered, and nothing to be done."""

    told: tuple[Told, ...]


@dataclass(frozen=True, slots=True)
class Control:
    """A command of the closed table."""

    command: CommandName


@dataclass(frozen=True, slots=True)
class Answer:
    """Something to be said; nothing is done."""

    text: str
    sources: tuple[str, ...] = field(default=())


Decision = Do | Ask | Remember | Control | Answer
