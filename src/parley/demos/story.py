"""Stories: what an operator says and what must come of it, as data (YAML).

::

    robot: A
    examples: ["go to the box"]
    steps:
      - {say: "The key is in the box", remembered: "key"}
      - {say: "bring me the key", plan: [GetCoordinates, NavigateTo]}
      - {id: which, asked: ["which box"], choices: ["red box", "blue box"], answer: "the red one"}
      - {restart: true}
      - {told: ["something is in the way"]}
      - {looked: {at: [box_1, box_2]}}
      - {change: {remove: [crate_1]}}
      - {finished: {near: box_1, within_m: 1.0, shown: [inspection]}}
    variants:
      no_key: {world: {remove: [key_1]}, fails: no_match}

A variant changes the world (or the operator) of one run and says how the story must then end.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from parley.demos.faults import Fault
from parley.errors import FileFormatError
from parley.files import TextFile, parse_yaml, validated
from parley.sim.entries import PoseTuple
from parley.sim.world_file import WorldChanges

__all__ = ["Finished", "Looked", "Story", "StoryStep", "Variant"]


def _several(value: object) -> object:
    return (value,) if isinstance(value, str) else value


class _Entry(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Finished(_Entry):
    """Everything is done; and then."""

    near: str = ""
    """Id of an object the robot must be next to."""
    within_m: float = Field(default=1.2, gt=0)
    """How close its middle must be to the object's bounding box."""
    shown: tuple[str, ...] = ()
    """Display feeds that must have had a picture."""
    put: dict[str, str] = Field(default_factory=dict)
    """Things of the world, and on which object of the map each must lie."""


class Looked(_Entry):
    """Pictures that were taken since something was said last, by whichever robot."""

    at: tuple[str, ...] = Field(min_length=1)
    """Ids of objects; for each a robot stood by it and looked."""
    within_m: float = Field(default=2.0, gt=0)
    """How close its middle was to the object's bounding box."""


class StoryStep(_Entry):
    """One thing that happens.

    Exactly one of `say`, `asked`, `told`, `looked`, `state`, `incident`, `change`, `restart`, `finished`.
    """

    id: str = ""
    robot: str = ""
    """The robot it is about; empty: the story's."""
    say: str | None = None
    """The operator says this ..."""
    also: tuple[str, ...] = ()
    """... to these robots as well, in one message ..."""
    reply: tuple[str, ...] = ()
    """... and each of these texts (any case, ``|`` between wordings) is in the reply,"""
    remembered: Annotated[tuple[str, ...], BeforeValidator(_several)] = ()
    """a memory is stored that has each of these texts in it,"""
    plan: tuple[str, ...] = ()
    """and these actions are planned, in this order."""
    proposed: tuple[str, ...] = ()
    """With any step: these actions are shown and wait for a yes then."""
    asked: tuple[str, ...] | None = None
    """The robot asks something that has each of these texts in it ..."""
    choices: tuple[str, ...] = ()
    """... offering these choices, whatever else stands in each ..."""
    answer: str = ""
    """... and the operator answers."""
    told: tuple[str, ...] | None = None
    """The robot says something that has each of these texts in it, after what was heard of it before."""
    looked: Looked | None = None
    """It was looked at these places."""
    state: Literal["idle", "running", "paused", "held", ""] = ""
    """The plan is in this state."""
    incident: Literal["solved", "skipped", "cancelled", "replaced", "held", ""] = ""
    """The newest record of a failure ends so."""
    change: WorldChanges | None = None
    """The world changes ..."""
    note: str = ""
    """... which a transcript tells in these words."""
    restart: bool = False
    """Everything is shut down and started again."""
    finished: Finished | None = None
    """Every action has ended well and the robot waits."""

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        things = (self.say, self.asked, self.told, self.looked, self.change, self.finished)
        kinds = [thing is not None for thing in things] + [
            self.restart, bool(self.state), bool(self.incident),
        ]  # fmt: skip
        if sum(kinds) != 1:
            raise ValueError(
                "expected exactly one of say, asked, told, looked, state, incident, change, restart, finished"
            )
        return self


class Variant(_Entry):
    """One thing that is different in a run, and how the story then ends."""

    world: WorldChanges = Field(default_factory=WorldChanges)
    answers: str | None = None
    """The operator answers every question with this."""
    words: dict[str, str] = Field(default_factory=dict)
    """What the operator says or answers instead, by the ids of steps."""
    leave_out: tuple[str, ...] = ()
    """Ids of steps that do not happen."""
    fails: str = ""
    """The reason the story must report; empty: it holds."""


class Story(_Entry, TextFile):
    """A whole story."""

    robot: str
    title: str = ""
    """What it shows, in a few words."""
    world: WorldChanges = Field(default_factory=WorldChanges)
    """What is different in the world from the start."""
    model: str = ""
    """The model that its robots are, instead of the world's."""
    robots: dict[str, PoseTuple] = Field(default_factory=dict)
    """More robots, of the first one's model, by name, and where they start."""
    ask_first: bool = False
    """Whether plans wait for a yes."""
    agrees: str = ""
    """What the operator says to a plan that waits for a yes where no step speaks of one; empty: nothing."""
    faults: dict[str, tuple[Fault, ...]] = Field(default_factory=dict)
    """Actions that fail at first, by name."""
    examples: tuple[str, ...] = ()
    """Sentences a newcomer may try."""
    steps: tuple[StoryStep, ...] = Field(min_length=1)
    variants: dict[Annotated[str, Field(min_length=1)], Variant] = Field(default_factory=dict)

    @classmethod
    def parse(cls, text: str, file: str = "story") -> Self:
        """Read the YAML text of a story; `file` is only for messages.

        Raises:
            FileFormatError: Names the file and the field.
        """
        return validated(cls, parse_yaml(text, file), file)

    def variant(self, name: str) -> Variant:
        """The variant of that name; an empty name is the story as written.

        Raises:
            FileFormatError: There is no such variant.
        """
        if not name:
            return Variant()
        if name not in self.variants:
            known = ", ".join(self.variants) or "none"
            raise FileFormatError("story", f"variants.{name}", f"there is no such variant; known: {known}")
        return self.variants[name]
