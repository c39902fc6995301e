"""What understands people: one interface, several implementations (design section 5).

A `Situation` holds everything that may be used to understand a message; what comes back is a `ChatAction`,
checked against the catalogue by whoever asked. Everything in a situation except `message` is data, never an
instruction.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from parley.errors import FailureCode
from parley.language.dialogue.state import Dialogue
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.robots.base import CameraImage, Detection
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = [
    "DraftHandler", "ErrorSituation", "Grounding", "InspectionReport", "Language", "Picture",
    "ReplyReading", "Situation", "Turn",
]  # fmt: skip

Status = Literal["idle", "running", "paused"]

DraftHandler = Callable[[str], None]
"""Gets the reply so far, whole each time, while the plan behind it is still being written; must not block."""


@dataclass(frozen=True, slots=True)
class Turn:
    """One turn of the conversation so far."""

    role: Literal["operator", "assistant"]
    content: str


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture that belongs to what is to be understood."""

    name: str
    """What it is called; for one that was just sent, its file name, which may say nothing."""
    jpeg: bytes
    sent: bool = False
    """Whether it came with the message; else it is the memory of that name."""


@dataclass(frozen=True, slots=True)
class Situation:
    """What is known when a message of the operator is to be understood."""

    message: str
    memory: tuple[MemoryEntry, ...] = ()
    """Oldest first: later facts win."""
    history: tuple[Turn, ...] = ()
    """Oldest first, without `message`."""
    queue: tuple[ActionCall, ...] = ()
    """Pending actions; 0 is the one being executed."""
    steps: tuple[str, ...] = ()
    """Their ids in the plan, as far as they are known: whatever changes later, these steps are meant."""
    status: Status = "idle"
    objects: tuple[MapObject, ...] = ()
    rooms: tuple[MapObject, ...] = ()
    """Parts of the map with a name, as goals."""
    robot_pose: Pose2D | None = None
    robot: str = ""
    """The robot that is spoken to."""
    robots: tuple[str, ...] = ()
    """All robots there are."""
    speaker: str = ""
    """The name of who says it, as far as it is known."""
    catalogue: tuple[ActionInfo, ...] = ()
    """What `robot` can do."""
    failure: ErrorSituation | None = None
    """The step that failed, while the robot waits for an answer to its question about it."""
    question: str = ""
    """What the robot asked, if its question is open or `message` was said instead of an answer to it."""
    pictures: tuple[Picture, ...] = ()
    """Pictures sent with the message, and those among `memory`."""
    dialogue: Dialogue = field(default_factory=Dialogue)
    """What runs, what waits, what was done and seen, on whose words."""

    @property
    def places(self) -> tuple[MapObject, ...]:
        """All that words may lead to; a thing goes before a room that is called like it."""
        things = {item.description.lower() for item in self.objects}
        return (*self.objects, *(room for room in self.rooms if room.description.lower() not in things))


@dataclass(frozen=True, slots=True)
class ErrorSituation:
    """What is known when a step failed."""

    error_message: str
    failed_action: ActionCall
    code: FailureCode = FailureCode.INTERNAL
    details: Mapping[str, Any] = field(default_factory=dict)
    completed: tuple[ActionCall, ...] = ()
    results: tuple[Mapping[str, Any], ...] = ()
    """What the completed steps gave, by name; with them, as far as it is known."""
    pending: tuple[ActionCall, ...] = ()
    steps: tuple[str, ...] = ()
    """The ids in the plan of those pending; see `Situation.steps`."""
    order: str = ""
    """What a person said that they want with the plan; empty if that is not known."""
    memory: tuple[MemoryEntry, ...] = ()
    objects: tuple[MapObject, ...] = ()
    dialogue: tuple[Turn, ...] = ()
    """Questions and answers about this failure so far."""
    reply: str | None = None
    """What the operator just answered; None for the attempt without asking."""
    tried: tuple[tuple[ActionCall, ...], ...] = ()
    """Corrections of this step that were carried out already, in vain."""
    pictures: tuple[Picture, ...] = ()
    """Pictures sent with `reply`."""
    robot: str = ""
    robot_pose: Pose2D | None = None
    catalogue: tuple[ActionInfo, ...] = ()


@dataclass(frozen=True, slots=True)
class Grounding:
    """Which object of the map a description means."""

    outcome: Literal["match", "ambiguous", "none"]
    candidates: tuple[MapObject, ...] = ()
    """One for a match, the equals for ambiguous, the nearest misses (may be empty) for none."""


@dataclass(frozen=True, slots=True)
class InspectionReport:
    """What a look at a picture gave."""

    text: str
    """For the operator, plain words."""
    found: bool | None = None
    """Whether what was looked for is there; None if nothing in particular was looked for."""
    wanted: str = ""
    """What was looked for, if anything in particular."""
    attention: bool = False
    """Whether a person should decide what follows."""
    unwanted: bool = False
    """Whether what was looked for should not be there: then it is well not to find it."""
    things: tuple[Detection, ...] = ()
    """What was found of it, or stands where nothing should; also where it was looked for elsewhere."""
    rules: tuple[str, ...] = ()
    """Which of the rules that were given apply to what is seen, word for word."""


@dataclass(frozen=True, slots=True)
class ReplyReading:
    """How an answer to a question is meant."""

    kind: Literal["yes", "no", "choice", "answer", "aside", "control", "unclear"]
    """`yes` includes "done", "I did it"; `answer` is what an open question asked for, in the person's words;
    `aside` is a question of their own or another order instead of an answer; `control` is a stop word and the
    like, handled elsewhere."""
    choice: str = ""
    """For `choice`: which of the offered ones, verbatim."""


class Language(Protocol):
    """The questions that need understanding.

    All may raise `parley.errors.LanguageError`; all are safe to call concurrently.
    """

    @property
    def label(self) -> str:
        """What operators are told about this engine, e.g. that it works without a model."""
        ...

    @property
    def sees_pictures(self) -> bool:
        """Whether it looks at the pictures of a situation; else nobody need fetch them."""
        ...

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """What the operator's message asks for: reply, actions, commands, memories.

        Engines that answer at once never call `on_draft`.
        """
        ...

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """The names of those memories of a short list that matter for `query`."""
        ...

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """How to repair a failure.

        `success` True: the correction, done after `delay_s`; with the command `stop` alone the robot is held.
        False: asks with `message_response` and `choices`. None: `message_response` answers what the operator
        asked (and `queue` is what they want done afterwards), while the question to them remains open.
        With any of them `afterwards` is what the operator wants done behind the rest of the plan.
        """
        ...

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """Which object a description means, seen from `pose`."""
        ...

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> InspectionReport:
        """What a picture shows, with regard to `request`.

        Args:
            image: The picture.
            request: What to look for or at.
            rules: What people told the robot, in their words; an engine that cannot tell which of it applies
                names none.
            known: The map, for telling what stands in which place.
        """
        ...

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """How an answer to a question is meant."""
        ...
