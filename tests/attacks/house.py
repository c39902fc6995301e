"""Two simulated robots in a hall, with a language engine that says whatever a case wants.

People are played as the page does it: what they say carries who they are, and a yes names what was shown.
"""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from typing import Any, Final

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.actions.context import ActionContext
from parley.config import SystemConfig
from parley.errors import ActionFailure, FailureCode
from parley.language.base import Language
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatImage, ChatInput
from parley.messages.memory import AddToMemory, MemoryEntry, RemoveMemory
from parley.messages.principal import Principal, person
from parley.messages.status import PlanDecision, PlanProposal, StopCommand
from parley.sim.world_file import WorldFile
from parley.system import System
from parley.transport.local import LocalTransport
from parley.umrf.action import ActionSpec, action
from tests.attacks.witness import Witness

KIM: Final = person("Kim", device="page on a tablet")
LEE: Final = person("Lee", device="page on a phone")
VIEWER: Final = person("Vic", device="page on a wall", role="viewer")
ADA: Final = "Ada"
BO: Final = "Bo"
ROBOTS: Final = (ADA, BO)
PATIENCE_S: Final = 20.0
MARKER: Final = "marker"
"""A memory that is added and removed again to know that everything before it was handled."""

HALL: Final = """
name: hall
walls:
  - {from: [0, 0], to: [12, 0]}
  - {from: [12, 0], to: [12, 7]}
  - {from: [12, 7], to: [0, 7]}
  - {from: [0, 7], to: [0, 0]}
things:
  - {name: shelf_1, class: shelf, description: tall shelf, pose: [10.5, 1.0, 0.0],
     parts: [{size_m: [0.5, 0.5, 0.9], colour: brown}]}
  - {name: box_1, class: box, description: red box, pose: [10.5, 3.5, 0.0],
     parts: [{size_m: [0.4, 0.4, 0.4], colour: red}]}
  - {name: clock_1, class: clock, description: wall clock, pose: [1.0, 6.5, 0.0],
     parts: [{size_m: [0.3, 0.1, 0.9], colour: white}]}
  - {name: bench_1, class: bench, description: long bench, pose: [10.5, 5.8, 0.0],
     parts: [{size_m: [0.6, 0.4, 0.4], colour: green}]}
robots:
  - {name: Ada, model: turtlebot3_waffle, pose: [1.5, 1.5, 0.0]}
  - {name: Bo, model: turtlebot3_waffle, pose: [1.5, 4.5, 0.0]}
"""
HOME: Final = {ADA: (1.5, 1.5, 0.0), BO: (1.5, 4.5, 0.0)}


class Hostile(ScriptedLanguage):
    """A model under somebody else's control: it says what the case says, the rest as an honest one would."""

    def __init__(self) -> None:
        behind: Language = BuiltinLanguage()
        super().__init__(behind)

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return "hostile model"

    def forget(self) -> None:
        """Begin a new script."""
        self._script.clear()
        self.asked.clear()


@dataclass(frozen=True)
class Report:
    """What was seen."""

    report: str


class Deeds:
    """What the robots' own actions wait for and did."""

    def __init__(self) -> None:
        self.waved: list[str] = []
        self.opened: list[str] = []
        """What was done that cannot be undone."""
        self.broken = True
        """Whether fetching fails."""

    def actions(self) -> tuple[ActionSpec, ...]:
        deeds = self

        @action(phrases=("wave at {whom}",), effects=("gestures",), risk="low")
        async def wave_at(ctx: ActionContext, whom: str) -> None:
            """Wave at somebody."""
            deeds.waved.append(f"{ctx.actor} {whom}")

        @action(phrases=("open the {valve}",), effects=("opens",), risk="high")
        async def open_valve(ctx: ActionContext, valve: str) -> None:
            """Open a valve, which cannot be undone."""
            deeds.opened.append(f"{ctx.actor} {valve}")

        @action(phrases=("guard {what}",), effects=("waits",), risk="none")
        async def guard(ctx: ActionContext, what: str) -> None:
            """Stand guard for an hour."""
            for _ in range(3600):
                await ctx.clock.sleep(1.0)
                await ctx.run.wait_while_paused()

        @action(phrases=("report {what}",), effects=("looks", "speaks"), risk="none")
        async def report(ctx: ActionContext, what: str) -> Report:
            """Say what is seen; `what` is that."""
            return Report(f"I see a {what}.")

        @action(phrases=("fetch {thing}",), effects=("carries",), risk="low")
        async def fetch(ctx: ActionContext, thing: str) -> None:
            """Fetch a thing."""
            if deeds.broken:
                raise ActionFailure(FailureCode.BLOCKED, f"I cannot reach the {thing}.", {"thing": thing})

        return tuple(item.spec for item in (wave_at, open_valve, guard, report, fetch))


@dataclass
class House:
    """A running system, the people in it, and everything that was seen."""

    system: System
    language: Hostile
    deeds: Deeds
    witness: Witness
    count: itertools.count[int] = field(default_factory=itertools.count)

    # -- people ----------------------------------------------------------------------------------------

    def say(
        self,
        text: str,
        *to: str,
        by: Principal | None = KIM,
        answers: ChatFeedback | None = None,
        images: tuple[ChatImage, ...] = (),
    ) -> str:
        """A person writes; the id of the message."""
        said = ChatInput(
            message=text,
            targets=to or (ADA,),
            type="response" if answers is not None else "request",
            reply_to=answers.id if answers is not None else "",
            id=f"m{next(self.count)}",
            author=by.name if by is not None else "",
            images=images,
            by=by,
        )
        self.witness.heard(said)
        self.witness.publish(topics.CHAT_INPUT, said)
        return said.id

    async def tell(self, text: str, *to: str, by: Principal | None = KIM) -> ChatFeedback:
        """Say something and wait for the reply."""
        identity = self.say(text, *to, by=by)
        return await self.reply(identity)

    async def reply(self, identity: str) -> ChatFeedback:
        """The first reply to a message."""
        await self.until(lambda: any(f.reply_to == identity for f in self.witness.said))
        return next(f for f in self.witness.said if f.reply_to == identity)

    def decide(
        self, proposal: PlanProposal, decision: str = "approve", *, by: Principal | None = KIM, **more: Any
    ) -> None:
        """A person presses a button of a card as it was shown."""
        fields = {
            "id": proposal.id,
            "target": proposal.target,
            "decision": decision,
            "digest": proposal.digest,
            "by": by,
        }
        self.witness.publish(topics.PLAN_DECISION, PlanDecision.model_validate(fields | more))

    def policy(self, robot: str, policy: str, by: Principal | None = KIM) -> None:
        """A person chooses which plans wait for a yes."""
        fields = {"target": robot, "decision": "policy", "policy": policy, "by": by}
        self.witness.publish(topics.PLAN_DECISION, PlanDecision.model_validate(fields))

    def press(self, command: str, *to: str, by: Principal | None = KIM) -> None:
        """Press or release the emergency stop."""
        order = StopCommand.model_validate(
            {"command": command, "targets": to, "id": f"s{next(self.count)}", "by": by}
        )
        self.witness.publish(topics.STOP, order)

    # -- waiting ---------------------------------------------------------------------------------------

    async def until(self, condition: Callable[[], object], within_s: float = PATIENCE_S) -> None:
        """Wait until what was seen makes `condition` true."""
        await self.witness.until(lambda: bool(condition()), timeout_s=within_s)

    async def passes(self, seconds: float) -> None:
        """Let robot time pass."""
        await self.system.clock.sleep(seconds)

    async def settled(self, seconds: float = 1.5) -> None:
        """Let everything that is under way arrive, and robots begin to move."""
        for _ in range(2):
            await self.passes(seconds / 2)
            await self.until(self.witness.is_told)
        await self._set_off()
        seen = len(self.witness.memory_events)
        body = {MARKER: {"type": "text", "data": MARKER}}
        self.witness.publish(topics.ADD_TO_MEMORY, AddToMemory.model_validate(body))
        await self.until(lambda: any(e.name == MARKER for e in self.witness.memory_events[seen:]))
        seen = len(self.witness.memory_events)
        self.witness.publish(topics.REMOVE_MEMORY, RemoveMemory({MARKER: {}}))
        await self.until(lambda: any(e.name == MARKER for e in self.witness.memory_events[seen:]))
        await self.passes(0.2)

    async def _set_off(self) -> None:
        """Let who began or went on with a drive get going: finding the way takes a moment of its own."""
        start = {robot: self.system.robots[robot].pose() for robot in ROBOTS}
        for _ in range(40):
            still = [r for r in ROBOTS if self.system.robots[r].pose().distance_to(start[r]) < 0.1]
            if not any(self.witness.drives(robot) for robot in still):
                return
            await self.passes(0.5)

    async def state(self, wanted: str, robot: str = ADA) -> None:
        """Wait until a plan is in this state."""
        await self.until(lambda: self.witness.state(robot) == wanted)

    async def doing(self, action_name: str, robot: str = ADA) -> None:
        """Wait until a step of this action is under way."""
        await self.until(lambda: self.witness.running(robot) == action_name)

    async def moving(self, robot: str = ADA) -> None:
        """Wait until a robot is on its way."""
        start = self.system.robots[robot].pose()
        while self.system.robots[robot].pose().distance_to(start) < 0.3:
            await self.passes(0.2)

    async def asked(self, robot: str = ADA) -> ChatFeedback:
        """The open question of a robot, once there is one."""
        await self.until(lambda: self.witness.questions.newest(robot) is not None)
        question = self.witness.questions.newest(robot)
        assert question is not None
        return question

    async def proposal(self, robot: str = ADA, *, after: int = 0) -> PlanProposal:
        """The newest plan that waits for a yes."""

        def found() -> list[PlanProposal]:
            return [p for p in self.witness.proposals[after:] if p.target == robot]

        await self.until(found)
        return found()[-1]

    # -- order -----------------------------------------------------------------------------------------

    async def order(
        self, answer: ChatAction, robot: str = ADA, words: str = "please do that"
    ) -> ChatFeedback:
        """A person orders something that an honest engine understands as `answer`, at once or approved."""
        self.language.will("interpret", answer)
        return await self.tell(words, robot)

    async def know(self, *entries: MemoryEntry) -> None:
        """Have things remembered from earlier."""
        store = self.system.store
        assert store is not None
        for entry in entries:
            await store.add(entry)

    async def memories(self) -> list[MemoryEntry]:
        """Everything that is remembered."""
        store = self.system.store
        assert store is not None
        return await store.all()

    async def fresh(self, policy: str) -> None:
        """As on the first day: no plan, no latch, no memory, everybody at home.

        Raises:
            TimeoutError: Something of before does not come to rest.
        """
        self.language.forget()
        self.deeds.__init__()  # type: ignore[misc]
        for robot in ROBOTS:
            self.press("reset", robot)
            identity = self.say("cancel everything", robot)
            await self.reply(identity)
            if (question := self.witness.questions.newest(robot)) is not None:
                self.say("nothing", robot, answers=question)  # what pictures show is asked until it is told
        await self.until(lambda: all(self.witness.at_rest(robot) for robot in ROBOTS), 10.0)
        for robot in ROBOTS:
            self.policy(robot, policy)
        await self.until(lambda: all(self.witness.policy_of(robot) == policy for robot in ROBOTS), 10.0)
        store = self.system.store
        assert store is not None
        for entry in await store.all():
            await store.remove(entry.name, entry.scope)
        away = {
            robot: HOME[robot]
            for robot in ROBOTS
            if self.system.robots[robot].pose().distance_to(_pose(HOME[robot])) > 0.05
        }
        if away:
            self.system.simulator.change({"move": away})
        await self.passes(0.2)
        self.witness.forget()


def _pose(home: tuple[float, float, float]) -> Any:
    from parley.world.geometry import Pose2D

    return Pose2D(*home)


@asynccontextmanager
async def running(config: SystemConfig | None = None) -> AsyncIterator[House]:
    """A house with everything in it, as fast as the machine can."""
    language, deeds = Hostile(), Deeds()
    actions = (*BUILTIN_ACTIONS, *deeds.actions())
    settings = config or SystemConfig(speed=None)
    system = System(WorldFile.parse(HALL), settings, language=language, actions=actions)
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(system)
        assert isinstance(system.transport, LocalTransport)
        witness = await stack.enter_async_context(Witness(system.transport, system.clock, language))
        house = House(system, language, deeds, witness)
        await house.until(lambda: set(ROBOTS) <= witness.robots)
        yield house


class Houses:
    """Gives a house as on the first day, a new one where the old one does not come to rest."""

    def __init__(self) -> None:
        self._stack = AsyncExitStack()
        self._house: House | None = None
        self.built = 0

    async def fresh(self, policy: str) -> House:
        """A house under a policy."""
        if self._house is not None:
            try:
                await self._house.fresh(policy)
            except TimeoutError:
                await self.close()
        if self._house is None:
            self._house = await self._stack.enter_async_context(running())
            self.built += 1
            await self._house.fresh(policy)
        return self._house

    async def close(self) -> None:
        """Close what is open."""
        self._house = None
        async with asyncio.timeout(30):
            await self._stack.aclose()
        self._stack = AsyncExitStack()
