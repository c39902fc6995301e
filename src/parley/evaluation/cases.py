"""Sets of situations with what is right in each (design section 5).

A case names a world, what is said (`say`) and, where it matters, `history`, `queue`, `status` and `robot`; a
case with `failed` is about a step that failed. What is right is said by the fields of `Expected`; `either`
lists alternatives where several readings are fair, each as fields that take the place of the case's own.
How steps are written: `parley.evaluation.steps`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field

from parley.errors import FileFormatError
from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.situations import read_situation
from parley.evaluation.steps import write_calls
from parley.files import TextFile, parse_yaml, validated
from parley.language.base import ErrorSituation, Situation
from parley.messages.status import ActionInfo

__all__ = ["Case", "CaseBody", "CaseSet", "Expected", "World"]

Plan = list[str]

_OBJECT_FIELDS = ("id", "description", "x", "y", "class", "width", "height")


class _Strict(BaseModel):
    """A misspelt field would make a case that nothing can fail."""

    model_config = ConfigDict(extra="forbid", populate_by_name=True)


class World(_Strict):
    """Where cases happen."""

    like: str = ""
    """Another world of the file, whose fields are taken where this one has none."""
    robot: str = ""
    robots: list[str] = Field(default_factory=list)
    pose: tuple[float, float, float] | None = None
    """Where the robot is: metres, metres, radians."""
    catalogue: str | list[ActionInfo] = "thesis"
    objects: list[list[Any]] = Field(default_factory=list)
    """Identifier, description, x, y and, where known, class, width and height; metres."""
    memory: list[tuple[str, str]] = Field(default_factory=list)
    """Name and text, oldest first."""

    @property
    def actions(self) -> tuple[ActionInfo, ...]:
        """What the robot can do."""
        named = self.catalogue
        return CATALOGUES[named] if isinstance(named, str) else tuple(named)


class Expected(_Strict):
    """What is right; what is not said must not happen."""

    do: Plan = Field(default_factory=list)
    do_any: list[Plan] | None = None
    """Several right plans."""
    final: Plan | None = None
    """What is pending once commands and plan have been applied; then commands are free."""
    final_any: list[Plan] | None = None
    any_order: bool = False
    """Whether the stops of the plan may be in any order."""
    any_do: bool = False
    """Whether the plan is left open."""
    commands: list[str] = Field(default_factory=list)
    """System commands in order; `add NAME` and `remove NAME` also name a memory."""
    any_commands: bool = False
    """Whether commands are left open, but for those named under `remember` and `forget`."""
    remember: list[list[str]] = Field(default_factory=list)
    """Words of each new memory; `|` between alternatives."""
    may_remember: bool = False
    """Whether more may be remembered, say where something is told besides."""
    forget: list[str] = Field(default_factory=list)
    may_forget: list[str] = Field(default_factory=list)
    """Memories that may be forgotten or kept, say because they are overwritten."""
    says: list[str] = Field(default_factory=list)
    """Parts of the reply; `|` between alternatives."""
    says_not: list[str] = Field(default_factory=list)
    asks: bool = False
    """Whether the reply has to ask; that it has not understood is no such question."""
    understands: bool = False
    """Whether the reply must not say that the message was not understood."""
    declines: bool = False
    """Whether the reply has to say that it cannot be done; a step that asks a person is right too."""
    choices: list[str] | None = None
    targets: list[str] | None = None
    """The robots that are meant."""
    uses: list[str] = Field(default_factory=list)
    """Memories that must be named as sources."""
    success: bool | None = None
    """For failures: whether it is repaired; None leaves it open."""


class CaseBody(Expected):
    """A case as a file has it."""

    in_: Annotated[str, Field(alias="in")]
    say: str = ""
    history: list[str] = Field(default_factory=list)
    """Operator and robot in turn."""
    queue: list[str] = Field(default_factory=list)
    status: Literal["idle", "running", "paused"] = "idle"
    robot: str = ""
    """The robot that is spoken to, if not the world's."""
    failed: list[str] | None = None
    error: str = ""
    code: str = ""
    details: dict[str, Any] = Field(default_factory=dict)
    pending: list[str] = Field(default_factory=list)
    reply: str | None = None
    either: list[Expected] = Field(default_factory=list)


@dataclass(frozen=True)
class Case:
    """One situation and what should come of it."""

    phenomenon: str
    body: CaseBody
    world: World
    part: str = ""
    """The set it belongs to."""
    blind: bool = False
    """Whether only its score is to be looked at."""

    @property
    def id(self) -> str:
        """What tells this case from the others of its set."""
        parts = (self.phenomenon, self.body.say, self.body.robot, self.body.code)
        return ": ".join(part for part in parts if part.strip())

    @property
    def expectations(self) -> list[Expected]:
        """Each reading that is fair."""
        if not self.body.either:
            return [self.body]
        return [
            self.body.model_copy(update={name: getattr(other, name) for name in other.model_fields_set})
            for other in self.body.either
        ]

    @property
    def situation(self) -> Situation | ErrorSituation:
        """The situation as a line of `parley interpret` would give it.

        Raises:
            InvalidMessageError: The case is no situation.
        """
        return read_situation(self.line, self.world.actions)

    @property
    def line(self) -> dict[str, Any]:
        """The JSON object of design section 5."""
        body, world = self.body, self.world
        common: dict[str, Any] = {
            "memory": [{"name": name, "data": data} for name, data in world.memory],
            "objects": [dict(zip(_OBJECT_FIELDS, item, strict=False)) for item in world.objects],
            "robot": body.robot or world.robot,
        }
        if world.pose is not None:
            common["robot_pose"] = dict(zip(("x", "y", "yaw"), world.pose, strict=True))
        if body.failed is not None:
            return common | {
                "kind": "error",
                "error_message": body.error,
                **({"code": body.code} if body.code else {}),
                "details": body.details,
                "failed_action": self._calls(body.failed)[0],
                "pending": self._calls(body.pending),
                "reply": body.reply,
            }
        turns = zip(itertools.cycle(("operator", "assistant")), body.history, strict=False)
        return common | {
            "message": body.say,
            "history": [{"role": role, "content": text} for role, text in turns],
            "queue": self._calls(body.queue),
            "status": body.status,
            "robots": world.robots,
        }

    def _calls(self, short: Sequence[str]) -> list[dict[str, Any]]:
        named = {str(item[0]): str(item[1]) for item in self.world.objects}
        return write_calls(short, named, self.world.actions)


class _File(_Strict):
    blind: bool = False
    worlds: dict[str, World]
    cases: dict[str, list[CaseBody]]


@dataclass(frozen=True)
class CaseSet(TextFile):
    """The cases of one file."""

    cases: tuple[Case, ...]
    worlds: dict[str, World]

    @classmethod
    def parse(cls, text: str, file: str) -> Self:
        """Read the text of a set.

        Raises:
            FileFormatError: Names the file and the field.
        """
        read = validated(_File, parse_yaml(text, file), file)
        worlds = {name: _whole(name, read.worlds, file) for name in read.worlds}
        cases: list[Case] = []
        for phenomenon, listed in read.cases.items():
            for number, body in enumerate(listed):
                if body.in_ not in worlds:
                    where = f"cases.{phenomenon}.{number}.in"
                    raise FileFormatError(file, where, f"there is no world {body.in_!r}")
                cases.append(Case(phenomenon, body, worlds[body.in_], Path(file).stem, read.blind))
        return cls(tuple(cases), worlds)


def _whole(name: str, worlds: dict[str, World], file: str) -> World:
    world = worlds[name]
    if isinstance(world.catalogue, str) and world.catalogue not in CATALOGUES:
        raise FileFormatError(file, f"worlds.{name}.catalogue", f"known are {', '.join(CATALOGUES)}")
    if not world.like:
        return world
    if world.like not in worlds:
        raise FileFormatError(file, f"worlds.{name}.like", f"there is no world {world.like!r}")
    own = {field: getattr(world, field) for field in world.model_fields_set}
    return worlds[world.like].model_copy(update=own)
