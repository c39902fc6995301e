"""`Parley`: robots that are talked to, from Python. The synchronous form is `parley.api.sync`.

It is one more client of the topics. Whatever it sends says on whose account, and the same gate rules
about it as about what comes from the page: there is no way round it here.
"""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import AsyncIterator, Iterable, Mapping, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Literal, Self

from parley.api.running import GraphRun, Page, about, graph_text, served, why_not
from parley.config import SystemConfig
from parley.errors import ConfigError, NotAllowedError, ParleyError
from parley.gate.table import Effect, verdict
from parley.latest import Latest
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, CommandName, SystemCommand
from parley.messages.memory import (
    AddToMemory,
    GetMemory,
    MemoryBody,
    MemoryEntry,
    MemoryEvent,
    MemoryList,
    RemoveMemory,
)
from parley.messages.principal import Principal
from parley.messages.pvf import SEPARATOR, Parameter, native_type
from parley.messages.ros import ChatRequest, UmrfGraphStart
from parley.messages.status import (
    PlanDecision,
    PlanProposal,
    PlanRuling,
    PlanUpdate,
    StopCommand,
)
from parley.messages.wire import decode, encode

if TYPE_CHECKING:  # loaded when it is opened
    from parley.api.listening import Event, Events, Listener
    from parley.language.base import Language
    from parley.robots.own import RobotBase
    from parley.site import Site
    from parley.system import System
    from parley.umrf.action import Action, ActionSpec

__all__ = ["Parley", "step"]

NOBODY: Final = Principal()
"""A program that nobody vouches for: it may look, stop, speak, and propose."""
OPENS_WITHIN_S: Final = 30.0
ANSWERS_WITHIN_S: Final = 60.0
_CONTROL: Final[Mapping[str, CommandName]] = {
    "pause": "stop", "resume": "start", "skip": "skip", "clear": "clear",
}  # fmt: skip

Command = Literal["pause", "resume", "skip", "clear"]


def step(action: str, **inputs: Any) -> ActionCall:
    """One step of an order: ``step("GetCoordinates", target="table")``; ``__`` in a name stands for ``::``.

    Args:
        action: The action's name.
        **inputs: Its inputs; what an earlier step finds out is handed on by itself.
    """
    flat = {name.replace("__", SEPARATOR): value for name, value in inputs.items()}
    return ActionCall(
        name=action,
        input_parameters={name: Parameter(native_type(value), value) for name, value in flat.items()},
    )


class Parley:
    """Robots that understand people. Use as ``async with``; what was opened is closed, whatever happens.

    Args:
        world: Where they are: a demonstration by name, a folder or `world.yaml`, or a `Site`. None: nowhere.
        robots: Robots of your own (`RobotBase`), or classes of them, which get their class's name. Empty: the
            simulated ones of the world.
        actions: What robots can do besides: actions (`action`), or folders with such.
        language: What understands people: ``builtin``, ``provider:model``, ``provider:model@address``, or an
            engine of your own; None: as in `config`.
        config: The settings, as an object, by their names, or the file with them.
        by: On whose account everything happens where a call does not say it. Say ``person("Ada")`` only for
            somebody who is there and whose words these are: what they may do is done, and the log says so.

    Raises, when it is opened:
        ConfigError: A setting, a file, a name is wrong.
        MissingExtraError: A part is not installed; says which.
    """

    def __init__(
        self,
        world: str | Path | Site | None = None,
        *,
        robots: Iterable[RobotBase | type[RobotBase]] = (),
        actions: Iterable[Action[..., Any] | ActionSpec | str | Path] = (),
        language: str | Language | None = None,
        config: SystemConfig | Mapping[str, Any] | str | Path | None = None,
        by: Principal = NOBODY,
    ) -> None:
        self._by = by
        self._make = partial(_system, world, robots, actions, language, config)
        self._stack = AsyncExitStack()
        self._system: System | None = None
        self._door: Listener | None = None
        self._stops: Latest[str, None] = Latest()
        """The stops that were made here, by id."""
        self._loop: asyncio.AbstractEventLoop | None = None

    async def __aenter__(self) -> Self:
        from parley.agents.chat.rulings import Rulings
        from parley.api.listening import Listener

        self._loop = asyncio.get_running_loop()
        async with AsyncExitStack() as stack:
            system = self._system = await stack.enter_async_context(await asyncio.to_thread(self._make))
            self._rulings = Rulings(system.transport)
            door = Listener(system.transport, self._rulings.on_ruling)
            self._door = await stack.enter_async_context(door)
            async with asyncio.timeout(OPENS_WITHIN_S):
                await door.until(lambda: door.statuses.keys() >= set(system.robot_names))
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()
        self._system = self._door = None

    # -- looking -----------------------------------------------------------------------------------------

    @property
    def robots(self) -> tuple[str, ...]:
        """The names of the robots."""
        return self._opened.robot_names

    def plan(self, robot: str) -> PlanUpdate:
        """The plan of a robot as it is."""
        name = self._named(robot)
        return self._listener.plans.get(name) or PlanUpdate(target=name)

    def question(self, robot: str) -> ChatFeedback | None:
        """What a robot asks and waits for, oldest first; None: nothing."""
        return self._listener.questions.newest(self._named(robot))

    def proposal(self, robot: str) -> PlanProposal | None:
        """What a robot proposed last and waits to be approved; None: nothing."""
        return self._listener.offered.newest(self._named(robot))

    def events(self, robot: str = "") -> Events:
        """What happens from now on: what is said, plans, steps, stops, refusals, memories, failures.

        Args:
            robot: Whose; empty: everybody's.
        """
        name = self._named(robot) if robot else ""
        return self._listener.stream(lambda event: not name or name in about(event))

    async def settled(self, robot: str, *, timeout_s: float | None = None) -> PlanUpdate:
        """Wait until a robot does nothing more by itself: it is done, held, asks, or waits for a yes.

        Raises:
            TimeoutError: It is still busy after `timeout_s` of wall time.
        """
        name = self._named(robot)
        async with asyncio.timeout(timeout_s):
            await self._listener.until(
                lambda: self.plan(name).state != "running" or self.question(name) is not None
            )
        return self.plan(name)

    # -- talking -----------------------------------------------------------------------------------------

    async def say(
        self, robot: str, text: str, *, by: Principal | None = None, timeout_s: float = ANSWERS_WITHIN_S
    ) -> ChatFeedback:
        """Say something to a robot and return its reply; what it then does, `events` and `settled` tell.

        Raises:
            TimeoutError: It does not reply within `timeout_s` of wall time.
        """
        said = ChatInput(message=text, targets=(self._named(robot),), id=_new_id(), by=self._who(by))
        return await self._replied(topics.CHAT_INPUT, said, said.targets[0], said.id, timeout_s)

    async def answer(self, robot: str, text: str, *, by: Principal | None = None) -> None:
        """Answer what a robot asks.

        Raises:
            ParleyError: It asks nothing.
            NotAllowedError: Who answers may not.
        """
        name, who = self._named(robot), self._who(by)
        question = self.question(name)
        if question is None:
            raise ParleyError(f"{name} asks nothing at the moment")
        self._allow(who, Effect.ANSWER, name)
        said = ChatInput(
            message=text, targets=(name,), type="response", reply_to=question.id, id=_new_id(), by=who
        )
        self._listener.publish(topics.CHAT_INPUT, said)
        await self._listener.until(lambda: self.question(name) is not question)

    # -- plans -------------------------------------------------------------------------------------------

    async def order(self, robot: str, *steps: ActionCall, by: Principal | None = None) -> PlanRuling:
        """Have a robot do steps, behind what it does already.

        Returns:
            What became of it: ``done`` (it begins), ``asked`` (it waits for a person's yes, see `proposal`),
            ``refused``.
        """
        return await self._ruled(self._named(robot), ChatAction(queue=steps), by)

    async def control(self, robot: str, command: Command, *, by: Principal | None = None) -> PlanRuling:
        """Pause a robot, let it go on (`resume`), leave out a step (`skip`), or drop its plan (`clear`).

        Raises:
            NotAllowedError: Who wants it may not.
        """
        if command not in _CONTROL:
            raise ConfigError(f"there is no command {command!r}; there are: {', '.join(_CONTROL)}")
        wanted = ChatAction(system_cmd=(SystemCommand(command=_CONTROL[command]),))
        ruling = await self._ruled(self._named(robot), wanted, by)
        if ruling.outcome == "refused":
            raise NotAllowedError(f"{self._who(by)} may not {command} {ruling.target}: a person decides that")
        return ruling

    async def approve(self, proposal: PlanProposal, *, by: Principal | None = None) -> ChatFeedback:
        """Say yes to what a robot proposed, as `proposal` says it: to nothing else does the yes count.

        Returns:
            What the robot says to it: it begins, or asks anew because things changed meanwhile.

        Raises:
            NotAllowedError: Who says it is no person, or one who only looks.
        """
        return await self._decided(proposal, "approve", Effect.APPROVE, by)

    async def reject(self, proposal: PlanProposal, *, by: Principal | None = None) -> ChatFeedback:
        """Say no to what a robot proposed.

        Raises:
            NotAllowedError: Who says it is no person, or one who only looks.
        """
        return await self._decided(proposal, "reject", Effect.REJECT, by)

    # -- stopping ----------------------------------------------------------------------------------------

    def stop(self, *robots: str, by: Principal | None = None) -> None:
        """Emergency stop of these robots, of all if none is named. From any thread; it waits for nothing.

        Raises:
            ParleyError: A drive could not be told; says whose. The others are stopped.
        """
        names, who, id = tuple(map(self._named, robots)), self._who(by), _new_id()
        self._stops[id] = None
        outcomes = self._opened.stop_line.pull(names, by=who, id=id, words="stop()", wait_s=0.0)
        self._tell(topics.STOP, StopCommand(targets=names, id=id, by=who, words="stop()"))
        failed = [f"{item.robot}: {item.problem}" for item in outcomes if item.state == "failed"]
        if failed:
            raise ParleyError(f"not stopped: {'; '.join(failed)}")

    def reset(self, *robots: str, by: Principal | None = None) -> None:
        """Release the emergency stop of these robots, of all if none is named; nothing moves by it.

        Raises:
            NotAllowedError: Who releases is no person, or one who only looks.
            ParleyError: A drive could not be told; it stays stopped.
        """
        names, who, id = tuple(map(self._named, robots)), self._who(by), _new_id()
        self._allow(who, Effect.RESET, *names)
        problems = self._opened.stop_line.reset(names, by=who, id=id)
        if problems:
            raise ParleyError("; ".join(problem.message for problem in problems))
        told = {status.stop for status in self._listener.statuses.values() if status.stop}
        stops = tuple(sorted({*told, *self._stops}))
        self._tell(topics.STOP, StopCommand(command="reset", targets=names, id=id, by=who, stops=stops))

    # -- memory ------------------------------------------------------------------------------------------

    async def remember(self, name: str, text: str, *, info: str = "", by: Principal | None = None) -> None:
        """Have robots remember something under a name; what stood there before is kept as history.

        Args:
            name: By which it is replaced and forgotten.
            text: What is remembered.
            info: What it is about, e.g. ``where the key is``.
            by: Who says it; of a person it counts as told.

        Raises:
            ParleyError: It was not remembered; says why.
        """
        who = self._who(by)
        self._allow(who, Effect.REMEMBER)
        way: Literal["told", ""] = "told" if who.is_person else ""
        body = MemoryBody(
            data=text,
            info=info,
            source=who.name or who.kind,
            way=way,
            words=text if way else "",
            by=who,
        )
        await self._changed(topics.ADD_TO_MEMORY, AddToMemory({name: body}), name)

    async def forget(self, name: str, *, by: Principal | None = None) -> None:
        """Have robots forget what they remember under a name.

        Raises:
            NotAllowedError: Who wants it may not.
            ParleyError: There is no such memory.
        """
        who = self._who(by)
        self._allow(who, Effect.FORGET)
        await self._changed(topics.REMOVE_MEMORY, RemoveMemory.of(name, who), name)

    async def memories(self, about: str = "", *, limit: int = 0) -> list[MemoryEntry]:
        """What is remembered: everything, oldest first, or what matters for `about`, best first."""
        request = GetMemory(request=about, kind="search" if about else "list", limit=limit, pictures=False)
        reply = await self._opened.transport.call(
            topics.GET_MEMORY, ChatRequest(encode(request)), timeout_s=ANSWERS_WITHIN_S
        )
        return list(decode(MemoryList, reply.response).memories)

    # -- graphs ------------------------------------------------------------------------------------------

    async def start(
        self, graph: str | Path | Mapping[str, Any], robot: str, *, by: Principal | None = None
    ) -> GraphRun:
        """Start a UMRF graph beside the plan of a robot. Its actions obey rules and stops as all do.

        Args:
            graph: JSON, as text, as an object, or the file with it. Its name must be one that does not run.
            robot: Who carries it out.
            by: Who wants it. What a plan would need a yes for, a graph does not get without a person.

        Raises:
            GraphRefusedError: It cannot run; with every reason.
            NotAllowedError: Who wants it may not, or not without a person's yes.
        """
        name, who, text = self._named(robot), self._who(by), graph_text(graph)
        from parley.umrf.io import read_graph

        wanted = read_graph(text)
        self._judged(name, who, sorted({node.name for node in wanted.nodes}))
        self._opened.rules.act_for(name, who)
        run = GraphRun(self._listener, wanted.name, name)
        try:
            self._listener.send(topics.GRAPH_START, UmrfGraphStart(umrf_graph_json=text, targets=(name,)))
            async with asyncio.timeout(ANSWERS_WITHIN_S):
                await run.begun()
        except BaseException:
            run.close()
            raise
        self._listener.publish(
            topics.AUDIT, AuditEvent(effect=Effect.BEGIN, by=who, robot=name, detail={"graph": wanted.name})
        )
        return run

    def _judged(self, robot: str, who: Principal, actions: Sequence[str]) -> None:
        """Let the gate say whether somebody may begin with these actions."""
        config, told = self._opened.config, self._listener.plans.get(robot)
        policy = (told.policy if told is not None else None) or config.approval_of.get(robot, config.approval)
        why = why_not(who, actions, policy, self.plan(robot), self._listener.statuses.get(robot))
        if why:
            self._tell(topics.AUDIT, AuditEvent(effect=Effect.BEGIN, by=who, robot=robot, outcome="refused"))
            raise NotAllowedError(f"a graph of {who} for {robot} {why}; say by=person(..)")

    # -- the page ----------------------------------------------------------------------------------------

    @asynccontextmanager
    async def page(self, *, port: int | None = None, lan: bool = False) -> AsyncIterator[Page]:
        """Serve the page for operators: ``async with parley.page() as page: print(page.address)``.

        Whoever is at this computer may do everything there, unless there are accounts in the data folder.

        Args:
            port: Where; None: the usual one, or a free one where that is taken.
            lan: Let other devices in, over HTTPS, with `Page.code`.

        Raises:
            MissingExtraError: The page is not installed.
            ConfigError: The port is taken.
        """
        async with served(self._opened, port=port, lan=lan) as page:
            yield page

    # -- inside ------------------------------------------------------------------------------------------

    @property
    def _opened(self) -> System:
        if self._system is None:
            raise ParleyError("this Parley is not open: use it inside `async with` (or `with SyncParley`)")
        return self._system

    @property
    def _listener(self) -> Listener:
        assert self._opened is not None
        if self._door is None:
            raise ParleyError("this Parley is not open yet")
        return self._door

    def _allow(self, who: Principal, effect: Effect, *robots: str) -> None:
        """Let the gate say whether somebody may; that they may not is written down."""
        if verdict(who, effect) == "allow":
            return
        for robot in robots or ("",):
            self._tell(topics.AUDIT, AuditEvent(effect=effect, by=who, robot=robot, outcome="refused"))
        raise NotAllowedError(f"{who} may not {effect.value}: say by=person(..) for a person who does")

    def _tell(self, topic: topics.Topic[Any], message: Any) -> None:
        """Publish from any thread; on the loop at once, so that what is said next comes behind it."""
        assert self._loop is not None
        try:
            here = asyncio.get_running_loop() is self._loop
        except RuntimeError:  # none runs in this thread
            here = False
        if here:
            self._listener.publish(topic, message)
        else:
            self._loop.call_soon_threadsafe(self._listener.publish, topic, message)

    def _who(self, by: Principal | None) -> Principal:
        return self._by if by is None else by

    def _named(self, robot: str) -> str:
        """A robot's name as it is written.

        Raises:
            ConfigError: There is no such robot.
        """
        found = next((name for name in self.robots if name.casefold() == robot.strip().casefold()), None)
        if found is None:
            raise ConfigError(f"there is no robot {robot!r}; there are: {', '.join(self.robots)}")
        return found

    async def _replied(
        self, topic: topics.Topic[Any], message: Any, robot: str, reply_to: str, timeout_s: float
    ) -> ChatFeedback:
        """Send something and return what the robot says to it."""

        def replies(event: Event) -> bool:
            if not isinstance(event, ChatFeedback) or robot not in event.targets:
                return False
            said = event.type in ("response", "error") or not reply_to
            return event.reply_to == reply_to or (said and not event.reply_to)

        async with self._listener.stream(replies) as heard, asyncio.timeout(timeout_s):
            self._listener.publish(topic, message)
            reply = await anext(heard)
        assert isinstance(reply, ChatFeedback)
        return reply

    async def _decided(
        self,
        proposal: PlanProposal,
        decision: Literal["approve", "reject"],
        effect: Effect,
        by: Principal | None,
    ) -> ChatFeedback:
        who = self._who(by)
        self._allow(who, effect, proposal.target)
        decided = PlanDecision(
            id=proposal.id, target=proposal.target, decision=decision, digest=proposal.digest, by=who
        )
        return await self._replied(topics.PLAN_DECISION, decided, proposal.target, "", ANSWERS_WITHIN_S)

    async def _ruled(self, robot: str, order: ChatAction, by: Principal | None) -> PlanRuling:
        """Send an order and return what the gate made of it."""
        wanted = order.model_copy(update={"targets": (robot,), "id": _new_id(), "by": self._who(by)})
        self._rulings.expect(wanted)
        self._listener.publish(topics.CHAT_ACTION, wanted)
        rulings = await self._rulings.about(wanted, ANSWERS_WITHIN_S)
        if not rulings:
            raise ParleyError(f"nobody says what became of the order to {robot}; look at its plan")
        return rulings[0]

    async def _changed(self, topic: topics.Topic[Any], message: Any, name: str) -> None:
        def concerns(event: Event) -> bool:
            return isinstance(event, MemoryEvent) and event.name == name

        async with self._listener.stream(concerns) as heard, asyncio.timeout(ANSWERS_WITHIN_S):
            self._listener.publish(topic, message)
            event = await anext(heard)
        if isinstance(event, MemoryEvent) and event.kind == "failed":
            raise ParleyError(event.message)


def _new_id() -> str:
    return uuid.uuid4().hex


def _system(*given: Any) -> System:
    """Make the system that was described; runs in a thread, as files are read and libraries loaded."""
    from parley.api.making import make_system

    return make_system(*given)
