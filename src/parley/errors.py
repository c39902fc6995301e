"""The one error tree of Parley, sorted by who must act.

::

    ParleyError
    ├── ConfigError            whoever starts Parley: a setting or a file is wrong
    │   ├── FileFormatError    ... and this file, at this field, says what
    │   └── MissingExtraError  ... or a part is not installed, and its name
    ├── NotAllowedError        whoever asked: who they are does not let them
    ├── InvalidMessageError    whoever sent the message: it does not fit the wire contract
    ├── GraphRefusedError      whoever sent the graph or command: it cannot run, and all the reasons why
    ├── TransportError         whoever runs the network
    │   ├── UnavailableError       nobody serves this name
    │   ├── TransportTimeoutError  somebody does, but did not answer in time
    │   ├── TypeMismatchError      both sides disagree on the type of a name
    │   ├── UnsupportedError       this backend cannot do that
    │   └── GoalRefusedError       an action server does not take this goal
    ├── StoreError             whoever runs the machine: the memory file cannot be read or written
    ├── LanguageError          nobody directly: the language engine failed, the operator is told
    └── ActionFailure          the recovery (then the operator): acting in the world did not work out

The outcome of acting in the world is data with a code from one closed list (`FailureCode`); recovery reads
the code, people read the sentence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

__all__ = [
    "ActionFailure",
    "ConfigError",
    "FailureCode",
    "FileFormatError",
    "GoalRefusedError",
    "GraphRefusedError",
    "InvalidMessageError",
    "LanguageError",
    "MissingExtraError",
    "NotAllowedError",
    "ParleyError",
    "Problem",
    "StoreError",
    "TransportError",
    "TransportTimeoutError",
    "TypeMismatchError",
    "UnavailableError",
    "UnsupportedError",
]


class ParleyError(Exception):
    """Base of everything Parley raises on purpose; its text is fit to be shown to an engineer."""


class ConfigError(ParleyError):
    """A setting is wrong; the text names it and says what would be right."""


class FileFormatError(ConfigError):
    """A file does not have the form it must have.

    Attributes:
        file: The file's name as the caller gave it.
        field: Path of the field inside the file, e.g. ``items.chair[2].coordinates.x``; empty for the whole.
        problem: What is wrong and what is expected, in one sentence.
        others: What else is wrong in it, each told as this is.
    """

    def __init__(self, file: str, field: str, problem: str, others: Sequence[str] = ()) -> None:
        self.file, self.field, self.problem, self.others = file, field, problem, tuple(others)
        super().__init__("\n".join((f"{file}: {field + ': ' if field else ''}{problem}", *others)))


class MissingExtraError(ConfigError):
    """A part that is installed on its own is not there; the text says how to get it.

    Attributes:
        extra: Its name, as pip takes it.
        what: What people call it.
        remedy: How to get it.
    """

    def __init__(self, extra: str, what: str) -> None:
        self.extra, self.what = extra, what
        self.remedy = f"Run: pip install 'parley-hri[{extra}]'"
        super().__init__(f"{what} is not installed; to get it: pip install 'parley-hri[{extra}]'")


class NotAllowedError(ParleyError):
    """Somebody wanted what is not theirs to decide; nothing was done."""


class InvalidMessageError(ParleyError):
    """A message does not fit the wire contract (design section 2).

    Attributes:
        what: The kind of message, e.g. ``ChatInput``.
        path: Path of the offending field; empty when the text as a whole cannot be read.
        problem: What is wrong and what is expected.
    """

    def __init__(self, what: str, path: str, problem: str) -> None:
        self.what, self.path, self.problem = what, path, problem
        super().__init__(f"{what}{'.' + path if path else ''}: {problem}")


@dataclass(frozen=True, slots=True)
class Problem:
    """One reason why a graph or a command is refused."""

    path: str
    """Where, e.g. ``actions[3].input_parameters.pose.position.x``."""
    message: str
    """What is wrong."""
    remedy: str = ""
    """What to do about it; may be empty."""
    code: str = "invalid"
    """Short stable word for programs, e.g. ``unknown_action``."""

    def __str__(self) -> str:
        text = f"{self.path}: {self.message}" if self.path else self.message
        return f"{text} ({self.remedy})" if self.remedy else text


class GraphRefusedError(ParleyError):
    """A graph or a control command was refused before anything changed.

    Attributes:
        graph_name: The graph it was about; may be empty when the text could not be read.
        problems: Every reason found, never empty.
    """

    def __init__(self, graph_name: str, problems: Sequence[Problem]) -> None:
        self.graph_name = graph_name
        self.problems = tuple(problems)
        super().__init__("; ".join(str(problem) for problem in self.problems))


class TransportError(ParleyError):
    """Base of what can go wrong between two nodes."""


class UnavailableError(TransportError):
    """Nobody serves the name that was called."""


class TransportTimeoutError(TransportError):
    """The peer exists but did not answer within the given time."""


class TypeMismatchError(TransportError):
    """Two parties use one name with different types."""


class UnsupportedError(TransportError):
    """The chosen transport backend has no such ability."""


class GoalRefusedError(TransportError):
    """An action server was asked for something that it does not take."""


class StoreError(ParleyError):
    """The memory file cannot be opened, read or written."""


class LanguageError(ParleyError):
    """The language engine could not answer; nothing was decided.

    Attributes:
        plain: One sentence for the operator, saying why; may be empty.
    """

    def __init__(self, message: str, *, plain: str = "") -> None:
        self.plain = plain
        super().__init__(message)


class FailureCode(StrEnum):
    """Every way in which acting in the world can fail; recovery decides on these words alone."""

    NO_MATCH = "no_match"
    """Nothing fits the description (an object, or something looked for in a picture)."""
    AMBIGUOUS = "ambiguous"
    """Several things fit the description equally well; `details["candidates"]` lists them."""
    UNREACHABLE = "unreachable"
    """No way leads there on the known map."""
    BLOCKED = "blocked"
    """A way exists on the map, but something unexpected stands in it (or in the camera's view)."""
    TIMED_OUT = "timed_out"
    """It took longer than allowed, in the robot's time."""
    UNAVAILABLE = "unavailable"
    """A service or model that is needed does not answer."""
    NOT_CAPABLE = "not_capable"
    """This robot cannot do that."""
    ATTENTION = "attention"
    """It worked, but what was found needs a person to decide."""
    DECLINED = "declined"
    """The operator said no."""
    NOT_UNDERSTOOD = "not_understood"
    """The operator's answers could not be understood, as often as asking was allowed."""
    FORBIDDEN = "forbidden"
    """A rule of the people here forbids it; no other way is tried without a person."""
    HARDWARE = "hardware"
    """A device of the robot failed."""
    INTERNAL = "internal"
    """A defect of ours or of an action."""

    @classmethod
    def _missing_(cls, value: object) -> FailureCode | None:
        """Other programs write "Timed out" or "ATTENTION-NEEDED"."""
        word = "_".join(str(value).lower().replace("-", " ").replace("_", " ").split())
        return next((code for code in cls if code.value == word.removesuffix("_needed")), None)


class ActionFailure(ParleyError):  # noqa: N818 - an outcome of acting, not a defect of the program
    """An action ended without reaching its aim.

    Attributes:
        code: Why, from the closed list.
        message: One plain sentence that can be shown to an operator.
        details: Facts for recovery, JSON-able, e.g. ``{"candidates": [{"id": .., "description": ..}]}``.
    """

    def __init__(self, code: FailureCode, message: str, details: Mapping[str, Any] | None = None) -> None:
        self.code, self.message, self.details = code, message, dict(details or {})
        super().__init__(f"[{code.value}] {message}")
