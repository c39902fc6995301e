"""What robots do with their plans when nobody is connected for a while: go on, wait, or drive home."""

from __future__ import annotations

import asyncio
from typing import Any, ClassVar, Final

from parley.agents.base import Node
from parley.agents.presence import Presence, linked_to
from parley.clock import Clock
from parley.latest import Latest
from parley.messages import topics
from parley.messages.attendance import Attendance, Unattended
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, CommandName, SystemCommand
from parley.messages.principal import Principal
from parley.messages.status import ActorStatus, PlanProposal, PlanUpdate, PoseInfo
from parley.sentences import sentence
from parley.transport.base import Transport

__all__ = ["PRESENCE", "Absence", "UnattendedPlans"]

PRESENCE: Final = Principal(kind="program", name="presence", key="presence")
SILENT_S: Final = 15.0
"""Wall time after which nobody counts as connected through a server that tells nothing any more."""
LOOK_S: Final = 1.0
LATE_S: Final = 5.0
"""What those who hang up had sent by then is still on its way."""

_TEXTS: Final[dict[Unattended, str]] = {
    "go_on": "Nobody is connected any more. I go on with what I was told.",
    "hold": "Nobody is connected any more, so I wait here. Say “carry on” when I should go on.",
    "go_home": "Nobody is connected any more, so I drop the rest and go back to where I started.",
}
_REASON: Final = "go back to where I started"


class Absence:
    """Since when nobody is connected. Pure: the time is handed in."""

    def __init__(self) -> None:
        self._servers: dict[str, tuple[int, float]] = {}
        self._since_s: float | None = None

    def heard(self, told: Attendance, now_s: float) -> None:
        """A server tells how many there are."""
        self._servers[told.server] = (told.people, now_s)

    def since_s(self, now_s: float) -> float | None:
        """Since when there is nobody; None: there is somebody, or no server that would know."""
        people = sum(count for count, at_s in self._servers.values() if now_s - at_s <= SILENT_S)
        if people or not self._servers:
            self._since_s = None
        elif self._since_s is None:
            self._since_s = now_s
        return self._since_s


class UnattendedPlans(Node):
    """Looks after plans that nobody looks after.

    Args:
        transport: Where the topics are.
        clock: Wall time.
        choice: What robots do whose order says nothing of it.
        after_s: Wall time for which nobody must be connected.
    """

    name: ClassVar[str] = "unattended plans"

    def __init__(self, transport: Transport, clock: Clock, choice: Unattended, after_s: float) -> None:
        super().__init__(transport)
        self._clock, self._choice, self._after_s = clock, choice, after_s
        self._absence, self._presence = Absence(), Presence(clock, linked=linked_to(transport))
        self._choices: Latest[str, Unattended] = Latest()
        """As the newest order of each robot says."""
        self._running: set[str] = set()
        self._asking: set[str] = set()
        """Robots whose plans all wait for a yes, which nobody would give."""
        self._homes: Latest[str, PoseInfo] = Latest()
        """Where each robot stood when it was heard of first."""
        self._settled: set[str] = set()
        """Robots that did their part in this absence."""
        self._elsewhere: set[str] = set()
        """Robots with an order of somebody who needs no page: nobody was connected when it came, or since."""

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ATTENDANCE, Attendance, self._on_attendance)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        await self.subscribe_plans(self._on_plan)
        self.spawn(self._watch(), name="watch")
        self.spawn(self._presence.watch(), name="presence")

    def look(self) -> None:
        """See whether somebody is there, and what is to be done if not."""
        now_s = self._clock.wall_s()
        since_s = self._absence.since_s(now_s)
        if since_s is None:
            self._settled.clear()
            self._elsewhere.clear()
        elif now_s - since_s >= self._after_s:
            for robot in sorted(self._running - self._settled - self._elsewhere):
                self._settled.add(robot)
                self._settle(robot)

    async def _watch(self) -> None:
        while True:
            self.look()
            await asyncio.sleep(LOOK_S)

    def _on_attendance(self, told: Attendance) -> None:
        self._absence.heard(told, self._clock.wall_s())
        self.look()

    def _on_input(self, said: ChatInput) -> None:
        now_s = self._clock.wall_s()
        since_s = self._absence.since_s(now_s)
        if since_s is not None and now_s - since_s >= LATE_S:
            self._elsewhere.update(said.targets)
        if said.unattended is not None:
            self._choices |= dict.fromkeys(said.targets, said.unattended)

    def _on_status(self, status: ActorStatus) -> None:
        self._presence.on_status(status)
        if status.pose is not None:
            self._homes.setdefault(status.actor, status.pose)

    def _on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        if isinstance(told, PlanProposal):
            return
        (self._asking.add if told.policy == "ask_first" else self._asking.discard)(told.target)
        if told.state == "running":
            self._running.add(told.target)
        else:
            self._running.discard(told.target)
            if told.steps and all(step.state == "finished" for step in told.steps):
                self._settled.discard(told.target)  # what begins now is understood only after they had gone

    def _settle(self, robot: str) -> None:
        choice = self._choices.get(robot, self._choice)
        home = self._homes.get(robot)
        if choice == "go_home" and (home is None or robot in self._asking):
            choice = "hold"
        if choice == "hold":
            self._order(robot, "stop")
        elif choice == "go_home" and home is not None:
            drive = ActionCall(name="NavigateTo", input_parameters=_pose(home), reason=self.spoken(_REASON))
            self._order(robot, "clear", drive)
        if robot in self._presence.gone:
            return  # nobody knows what it does
        text = self.spoken(sentence(_TEXTS[choice]))
        self.publish(topics.CHAT_FEEDBACK, ChatFeedback(message=text, targets=(robot,), type="info"))

    def _order(self, robot: str, command: CommandName, *queue: ActionCall) -> None:
        order = ChatAction(
            system_cmd=(SystemCommand(command=command),), queue=queue, targets=(robot,), by=PRESENCE
        )
        self.publish(topics.CHAT_ACTION, order)


def _pose(home: PoseInfo) -> dict[str, Any]:
    def number(value: float) -> dict[str, Any]:
        return {"pvf_type": "number", "pvf_value": value}

    position = {"x": number(home.x), "y": number(home.y), "z": number(0.0)}
    return {
        "pose": {
            "position": position,
            "orientation": {"r": number(0.0), "p": number(0.0), "y": number(home.yaw)},
        }
    }
