"""The error handler node: repairs a failed step alone, or by asking the operator (thesis 4.3.7)."""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from parley.clock import Clock
from parley.errors import LanguageError
from parley.language.base import ErrorSituation, Language, Turn
from parley.language.control import control_of
from parley.memory.client import recall
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.ros import String
from parley.messages.status import ActorStatus, PlanUpdate
from parley.nodes.base import Mailboxes, Node
from parley.nodes.presence import Presence
from parley.transport.base import Transport
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["ErrorHandler"]


@dataclass(slots=True)
class _Repair:
    """One failed step and what was said about it."""

    failure: ErrorHandlingMessage
    attempts: int = 0
    """Questions asked so far."""
    question_id: str = ""
    """Open question, empty when none is."""
    seen_held: bool = False
    """Whether the plan was reported as held since; before that, its reports are older than the failure."""
    dialogue: list[Turn] = field(default_factory=list)


class ErrorHandler(Node):
    """One repair per robot at a time, attempts bounded across repeated failures of the same step.

    Args:
        transport: Where the topics are.
        language: What understands.
        clock: Wall time.
        objects: The things a robot's map knows, by the robot's name.
        max_attempts: How often the operator is asked before the robot is held.
        language_timeout_s: Wall time an answer of the language engine may take.
    """

    name: ClassVar[str] = "error_handler"

    def __init__(
        self,
        transport: Transport,
        language: Language,
        clock: Clock,
        *,
        objects: Callable[[str], Sequence[MapObject]] = lambda _: (),
        max_attempts: int = 3,
        language_timeout_s: float = 30.0,
    ) -> None:
        super().__init__(transport)
        self._language, self._objects = language, objects
        self._max_attempts, self._language_timeout_s = max_attempts, language_timeout_s
        self._presence = Presence(clock)
        self._mailboxes: Mailboxes[str] = Mailboxes(self._on_defect)
        self._repairs: dict[str, _Repair] = {}
        self._earlier: dict[str, _Repair] = {}
        """The last repair that was thought to have worked, to notice when the same step fails again."""

    async def open(self) -> None:
        """See `Node.open`."""
        await self.opened.enter_async_context(self._mailboxes)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._presence.on_status)
        await self.subscribe(topics.ERROR_HANDLING, ErrorHandlingMessage, self._on_failure)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)
        await self.subscribe_raw(topics.PLAN, self._on_plan)

    # -- from the wire ---------------------------------------------------------------------------------

    def _on_failure(self, failure: ErrorHandlingMessage) -> None:
        known = self._repairs.get(failure.target)
        if known is not None and failure.failure_id and known.failure.failure_id == failure.failure_id:
            return  # the same failure, reported twice
        repair = _Repair(failure)
        earlier = self._earlier.pop(failure.target, None)
        if earlier is not None and _same_step(earlier.failure, failure):
            repair.attempts, repair.dialogue = earlier.attempts, earlier.dialogue
        self._repairs[failure.target] = repair
        self._mailboxes.post(failure.target, lambda: self._attempt(repair, None))

    def _on_input(self, said: ChatInput) -> None:
        control = control_of(said.message, self._presence.names())
        named = self._presence.named_in(said.message) if control is not None else []
        for target in named or [self._presence.resolve(name) or name for name in said.targets]:
            repair = self._repairs.get(target)
            if repair is None:
                continue
            if control is not None and not (control == "start" and said.type == "response"):
                # Acted upon by the chat interface, whose reply closes the question too; nothing that is still
                # being worked out may move the robot.
                del self._repairs[target]
            elif said.type == "response" and repair.question_id and said.reply_to in ("", repair.question_id):
                repair.question_id = ""
                self._mailboxes.post(target, lambda r=repair: self._attempt(r, said.message))  # type: ignore[misc]

    def _on_plan(self, message: String) -> None:
        """A repair ends when the robot is no longer held, whoever brought that about."""
        if '"kind":"update"' not in message.data.replace(" ", ""):
            return
        update = PlanUpdate.model_validate_json(message.data)
        repair = self._repairs.get(update.target)
        if repair is None:
            return
        if update.state == "held":
            repair.seen_held = True
        elif repair.seen_held and repair.question_id:
            del self._repairs[update.target]
            text = "You need not answer my question any more."
            self._say(update.target, text, "info", closes=repair.question_id)

    # -- repairing -------------------------------------------------------------------------------------

    async def _attempt(self, repair: _Repair, reply: str | None) -> None:
        if self._repairs.get(repair.failure.target) is not repair:
            return  # settled otherwise in the meantime
        resolution = await self._resolve(repair, reply)
        if self._repairs.get(repair.failure.target) is not repair:
            return
        if reply is not None:
            repair.dialogue.append(Turn("operator", reply))
        if resolution.success:
            self._solved(repair, resolution)
        elif repair.attempts >= self._max_attempts:
            self._give_up(repair)
        else:
            self._ask(repair, resolution)

    async def _resolve(self, repair: _Repair, reply: str | None) -> ChatAction:
        """Ask the language engine; when it cannot answer, fall back to the failure's own sentence."""
        try:
            async with asyncio.timeout(self._language_timeout_s):
                return await self._language.resolve(await self._situation(repair, reply))
        except (LanguageError, TimeoutError) as error:
            self.log.warning("no resolution", target=repair.failure.target, error=repr(error))
            text = f"{repair.failure.error_message} What should I do?"
            return ChatAction(message_response=text, success=False)

    async def _situation(self, repair: _Repair, reply: str | None) -> ErrorSituation:
        failure = repair.failure
        status = self._presence.get(failure.target)
        memory = await recall(self.transport, _memory_query(failure, reply), scope=failure.target)
        return ErrorSituation(
            error_message=failure.error_message,
            failed_action=failure.action_called,
            code=failure.code,
            details=failure.details,
            completed=failure.completed,
            pending=failure.umrf_queue,
            memory=memory,
            objects=tuple(self._objects(failure.target)),
            dialogue=tuple(repair.dialogue),
            reply=reply,
            robot=failure.target,
            robot_pose=Pose2D(status.pose.x, status.pose.y, status.pose.yaw)
            if status and status.pose
            else None,
            catalogue=status.catalogue if status else (),
        )

    def _solved(self, repair: _Repair, resolution: ChatAction) -> None:
        target = repair.failure.target
        del self._repairs[target]
        self._earlier[target] = repair
        self.publish(
            topics.UMRF_CORRECTION, resolution.model_copy(update={"targets": (target,), "success": True})
        )
        self._say(target, resolution.message_response or "Thank you, I am going on.", "info")

    def _ask(self, repair: _Repair, resolution: ChatAction) -> None:
        repair.attempts += 1
        repair.question_id = uuid.uuid4().hex
        repair.dialogue.append(Turn("assistant", resolution.message_response))
        self._say(
            repair.failure.target,
            resolution.message_response,
            "request",
            choices=resolution.choices,
            question_id=repair.question_id,
        )

    def _give_up(self, repair: _Repair) -> None:
        """Hold the robot and say what remains (design section 2, last row of the table)."""
        target = repair.failure.target
        del self._repairs[target]
        stop = SystemCommand(command="stop", arguments={})
        self.publish(topics.UMRF_CORRECTION, ChatAction(system_cmd=(stop,), targets=(target,), success=False))
        left = _steps_left([repair.failure.action_called, *repair.failure.umrf_queue])
        text = (
            f"I could not solve this, so I am waiting here. {repair.failure.error_message} "
            f"{left} Say “try again”, “skip it” or “cancel everything”, or give me another order."
        )
        self._say(target, text, "info")

    # -- helpers ---------------------------------------------------------------------------------------

    def _say(
        self,
        target: str,
        text: str,
        kind: Literal["request", "info", "error"],
        *,
        choices: Sequence[str] = (),
        question_id: str = "",
        closes: str = "",
    ) -> None:
        feedback = ChatFeedback(
            message=text, targets=(target,), type=kind, choices=tuple(choices), id=question_id, closes=closes
        )
        self.publish(topics.CHAT_FEEDBACK, feedback)

    def _on_defect(self, target: str, error: Exception) -> None:
        repair = self._repairs.get(target)
        if repair is not None:
            self._give_up(repair)


def _same_step(first: ErrorHandlingMessage, second: ErrorHandlingMessage) -> bool:
    """Whether the same thing failed again, with nothing achieved in between."""
    return (
        first.code == second.code
        and first.action_called == second.action_called
        and len(first.completed) == len(second.completed)
    )


def _memory_query(failure: ErrorHandlingMessage, reply: str | None) -> str:
    values = [str(p.value) for p in failure.action_called.input_parameters.values() if p.type == "string"]
    return "\n".join([failure.error_message, *values, *([reply] if reply else [])])


def _steps_left(calls: Sequence[ActionCall]) -> str:
    reasons = [call.reason for call in calls if call.reason]
    if not reasons:
        return f"{len(calls)} steps are left." if len(calls) != 1 else "One step is left."
    return f"Left to do: {'; '.join(reasons)}."
