"""What comes of a message: one object, from which reply, plan and deed are made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from parley.language.builtin.skills import Skill
from parley.messages.chat import CommandName

if TYPE_CHECKING:
    from parley.language.dialogue.changes import Change

__all__ = ["Answer", "Ask", "Control", "Decision", "Deed", "Do", "Edit", "Forget", "Note", "Remember", "Told"]


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
    about: str = ""
    """The order that was asked about before, where the message only answers that."""


@dataclass(frozen=True, slots=True)
class Ask:
    """A question; nothing is done yet."""

    question: str
    choices: tuple[str, ...] = ()
    offer: tuple[Deed, ...] = ()
    """What a yes would do."""
    unclear: str = ""
    """Of an offer the words that were not understood; "…" where the whole is doubtful, "?" where only a look
    tells what was asked."""
    called: str = ""
    """Who is called in it, where no robot is called so."""
    stops: bool = False
    """Whether the robot stands still until it is answered."""
    alarms: bool = False
    """Whether everybody is told of it: somebody is in danger."""
    told: tuple[Told, ...] = ()
    """What was told clearly beside it."""
    where: str = ""
    """Whose or what's place is asked for; `you` for who speaks."""
    about: str = ""
    """The order that it is about, where that is not the message."""
    robots: tuple[str, ...] = ()
    """Who asks, where that is not the one that hears it."""


@dataclass(frozen=True, slots=True)
class Remember:
    """Facts to be remembered, and nothing to be done."""

    told: tuple[Told, ...]


@dataclass(frozen=True, slots=True)
class Edit:
    """A change of what runs or waits, perhaps with deeds that were ordered in place of it."""

    change: Change
    do: Do | None = None
    proposal: str = ""
    """What waits for a yes and is changed."""
    steps: tuple[str, ...] = ()
    """The ids in the plan of what is still to be done, as far as they are known."""


@dataclass(frozen=True, slots=True)
class Forget:
    """Memories to be forgotten."""

    names: tuple[str, ...]
    texts: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Control:
    """A command of the closed table."""

    command: CommandName
    robots: tuple[str, ...] = ()
    """Whom it is said to."""


@dataclass(frozen=True, slots=True)
class Answer:
    """Something to be said; nothing is done."""

    text: str
    sources: tuple[str, ...] = field(default=())
    waits: bool = False
    """Whether it promises to do the order when somebody tells what that waits for."""
    unknown: str = ""
    """Of what nothing is known."""


Decision = Do | Ask | Remember | Forget | Edit | Control | Answer
