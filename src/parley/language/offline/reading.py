"""What is known while one message is being read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from parley.language.offline.facts.noting import Noting
from parley.language.offline.scene.known import UnclearError
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.going import UnableError
from parley.language.offline.tasks.meeting import Meeting
from parley.language.offline.words.text import Phrase

__all__ = ["Reading"]


@dataclass
class Reading(Noting):
    """The state of reading one message."""

    targets: tuple[str, ...] = ()
    tasks: Meeting = field(init=False)
    last: Command | None = None
    _previous: Command | None = None
    """What the message before asked for."""
    _leads_on: bool = False
    """Whether this message begins like a continuation."""
    about: tuple[Phrase, ...] = ()
    """What was told of before the message's first order."""
    trouble: UnclearError | UnableError | None = None
    """What ended the reading early."""
    reported: bool = False
    """Whether something is done only because it was told what has happened."""
    unread: list[Phrase] = field(default_factory=list)
    """Clauses that mean nothing here."""
    _parts: Sequence[Clause] = ()
    _at: int = 0
    _hurried: bool = False
    """Whether the message ends with "now, please" and the like."""
    _before_last: tuple[int, int] = (0, 0)

    _checked: tuple[Phrase, int] = ((), 0)
    _looked_from: str = ""
    """Where it stood when it looked last, for what is to be done otherwise."""

    def __post_init__(self) -> None:
        self.tasks = Meeting(self.scene)
