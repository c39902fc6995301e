"""What the chat interface has heard about each robot, and the situation a message is understood in."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, Literal

from parley.agents.chat.conversation import Conversation
from parley.agents.chat.log import Log
from parley.agents.chat.memories import memory_query
from parley.agents.planner.flow import pending_calls, pending_ids
from parley.agents.presence import Presence
from parley.agents.questions import LastAsked, OpenQuestions
from parley.agents.recovery.repair import failed_situation
from parley.agents.shown_pictures import remembered_pictures, sent_pictures
from parley.clock import Clock
from parley.language.base import Situation
from parley.language.dialogue.state import Order
from parley.latest import Latest
from parley.memory.client import recall, recall_newest
from parley.memory.sayings import asks_for_all
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.memory import MemoryEntry
from parley.messages.principal import Principal
from parley.messages.status import ActionInfo, ActorStatus, GraphEvent, PlanProposal, PlanUpdate
from parley.transport.base import Transport
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["Situations"]

_STATUS: Final[dict[str, Literal["paused", "running"]]] = {
    "paused": "paused",
    "held": "paused",
    "running": "running",
}
"""A plan's states as a language engine is told them; all others are idle."""


class Situations:
    """Plans, failures, questions and conversations by robot.

    Args:
        transport: Where memories and pictures are asked for.
        presence: Which robots there are.
        objects: The things a robot's map knows, by the robot's name.
        history_exchanges: How many exchanges are remembered as context.
        clock: Its wall time is written down with what was done.
        rooms: Parts of a robot's map with a name, as goals.
    """

    def __init__(
        self,
        transport: Transport,
        presence: Presence,
        objects: Callable[[str], Sequence[MapObject]],
        history_exchanges: int,
        clock: Clock,
        rooms: Callable[[str], Sequence[MapObject]] = lambda _: (),
    ) -> None:
        self._transport, self._presence, self.objects = transport, presence, objects
        self._history_exchanges, self._clock = history_exchanges, clock
        self.rooms = rooms
        self.plans: dict[str, PlanUpdate] = {}
        self._catalogues: dict[str, Sequence[ActionInfo]] = {}
        self.questions = OpenQuestions()
        self._failures: Latest[str, ErrorHandlingMessage] = Latest()
        self._conversations: Latest[str, Conversation] = Latest()
        self._asked = LastAsked()
        self._logs: Latest[str, Log] = Latest()
        self._stopped_by: dict[str, set[Principal]] = {}
        """By robot that stands: who told it to."""
        self._changes: Latest[str, int] = Latest()
        self._ordered: dict[str, set[str]] = {}
        """By robot that is at something: who told it to, by name."""

    def on_feedback(self, feedback: ChatFeedback) -> None:
        """Something was said to an operator; it may be a question."""
        self.questions.on_feedback(feedback)
        self._asked.on_feedback(feedback)
        for target in feedback.targets if feedback.by_step else ():
            self.log(target).on_said(feedback.message)
        for target in feedback.targets if feedback.type == "error" else ():
            self.log(target).on_refused(feedback.message)

    def on_plan(self, update: PlanUpdate) -> None:
        """A robot's plan changed."""
        status = self._presence.get(update.target)
        if update.state != "paused" and self.state(update.target) == "paused":
            self._stopped_by.pop(update.target, None)
        if update.state == "idle" and self.state(update.target) != "idle":
            self._ordered.pop(update.target, None)
        self.plans[update.target] = update
        if status is not None:
            self._catalogues[update.target] = status.catalogue
        self.log(update.target).on_plan(update, self._clock.unix_ms(), status.catalogue if status else ())

    def on_event(self, event: GraphEvent) -> None:
        """A robot's step began, came further or ended."""
        self.log(event.actor).on_event(event)

    def on_order(self, said: ChatInput, order: ChatAction, why: str = "") -> None:
        """Somebody's words became steps for robots, or changes of what they do; `why` it is these robots."""
        plans = [item for item in order.system_cmd if item.command not in ("add_memory", "remove_memory")]
        for target in order.targets if order.queue or plans else ():
            self._changes[target] = self.changes(target) + 1
        for target in order.targets if order.queue else ():
            pose = _pose(self._presence.get(target))
            words, now_ms = order.words or said.message, self._clock.unix_ms()
            asked = Order(words, said.who.name, now_ms, tuple(order.queue), pose, why)
            self.log(target).on_order(asked)
            self._ordered.setdefault(target, set()).update({_name(said)} if said.who.is_person else ())

    def of_others(self, target: str, said: ChatInput) -> list[str]:
        """Who else, by name, told a robot to do what it is at; nobody of a plan that has not begun."""
        begun = said.who.is_person and self.state(target) not in ("idle", "awaiting_approval")
        return sorted(self._ordered.get(target, set()) - {"", _name(said)}) if begun else []

    def catalogue(self, target: str) -> Sequence[ActionInfo]:
        """What a robot can do, or could when its plan was heard of last."""
        return self._catalogues.get(target, ())

    def changes(self, target: str) -> int:
        """How often words have changed what a robot does."""
        return self._changes.get(target, 0)

    def note(self, target: str, words: str, reply: str) -> None:
        """Something was said and answered."""
        self.log(target).on_turn()
        self.conversation(target).operator(words)
        self.conversation(target).assistant(reply)

    def on_stop(self, target: str, said: ChatInput) -> None:
        """Somebody told a robot to stand still."""
        self._stopped_by.setdefault(target, set()).add(said.who)
        self.log(target).on_stop(said.message, said.who.name, self._clock.unix_ms())

    def log(self, target: str) -> Log:
        """What a robot was asked, did and saw."""
        return self._logs.setdefault(target, Log())

    def on_failure(self, failure: ErrorHandlingMessage) -> None:
        """A step failed; it is what later questions are about."""
        self._failures[failure.target] = failure

    def conversation(self, target: str) -> Conversation:
        """What was said to and by a robot."""
        return self._conversations.setdefault(target, Conversation(self._history_exchanges))

    def state(self, target: str) -> str:
        """A robot's plan's state."""
        plan = self.plans.get(target)
        return plan.state if plan is not None else "idle"

    def stands_for(self, target: str, who: Principal) -> bool:
        """Whether a robot stands because somebody, and nobody else, told it to."""
        plan = self.plans.get(target)
        if plan is None or plan.state != "paused":
            return False
        return {*self._stopped_by.get(target, ()), plan.held_by} == {who}

    def doing(self, target: str) -> str:
        """What a robot still has to do, in words; empty if that is nothing, or waits for a yes."""
        plan = self.plans.get(target)
        if plan is None or plan.state in ("idle", "awaiting_approval"):
            return ""
        is_over = ("finished", "skipped", "stopped")
        return "; ".join(step.label for step in plan.steps if step.state not in is_over and not step.for_next)

    def moves(self, target: str, status: ActorStatus | None) -> bool:
        """Whether a robot is under way, or may be: a step that moves it runs, or it does not stand."""
        plan = self.plans.get(target)
        if plan is None or plan.state != "running":
            return status is not None and status.state == "running" and status.at_rest is False
        moving = {info.name for info in status.catalogue if "moves" in info.effects} if status else set()
        runs = [step.action.name for step in plan.steps if step.state in ("running", "paused")]
        return status is None or status.at_rest is False or bool(moving & set(runs))

    def is_under_way(self, target: str) -> bool:
        """Whether a robot is at something, or may begin any moment."""
        return self.state(target) in ("running", "awaiting_approval")

    def may_have_to_ask(self, target: str) -> bool:
        """Whether some steps of a robot wait for a person's yes."""
        return target in self.plans and self.plans[target].policy != "run_at_once"

    async def of(
        self,
        target: str,
        message: str,
        said: ChatInput,
        *,
        sees_pictures: bool,
        proposal: PlanProposal | None = None,
    ) -> Situation:
        """Everything a language engine is told about one message.

        Args:
            target: The robot.
            message: What is to be understood of what was said.
            said: The whole message, with its pictures and what it replies to.
            sees_pictures: Whether remembered pictures are of use.
            proposal: What waits for a yes.
        """
        turns = self.conversation(target).turns
        speaker = said.who.name if said.who.is_person else ""
        memory = await self._recalled(target, message, speaker)
        pictures = await sent_pictures(said.images)
        if sees_pictures:
            known = await remembered_pictures(self._transport, memory, target)
            pictures += tuple(each for each in known if each.jpeg not in [sent.jpeg for sent in pictures])
        objects, failure = tuple(self.objects(target)), self._failures.get(target)
        status, plan, asked = (
            self._presence.get(target),
            self.plans.get(target),
            self.questions.newest(target),
        )
        question = asked.message if asked is not None else self._asked.words(said.reply_to)
        return Situation(
            message=message,
            memory=memory,
            history=turns,
            queue=tuple(pending_calls(plan)) if plan else (),
            steps=pending_ids(plan) if plan else (),
            status=_STATUS.get(self.state(target), "idle"),
            objects=objects,
            rooms=tuple(self.rooms(target)),
            robot_pose=_pose(status),
            robot=target,
            robots=self._presence.names(),
            speaker=speaker,
            catalogue=status.catalogue if status else (),
            failure=failed_situation(failure, memory=memory, objects=objects, status=status)
            if failure is not None and question and self.state(target) == "held"
            else None,
            question=question,
            pictures=pictures,
            dialogue=self.log(target).state(status, proposal, self._clock.unix_ms()),
        )

    async def _recalled(self, target: str, message: str, speaker: str) -> tuple[MemoryEntry, ...]:
        if asks_for_all(message):
            return await recall_newest(self._transport, scope=target)
        query = memory_query(message, self.conversation(target).turns, speaker)
        return await recall(self._transport, query, scope=target)


def _name(said: ChatInput) -> str:
    """Who speaks."""
    return said.who.name or said.author


def _pose(status: ActorStatus | None) -> Pose2D | None:
    """Where a robot is, if it tells."""
    pose = status.pose if status is not None else None
    return Pose2D(pose.x, pose.y, pose.yaw) if pose is not None else None
