"""A planner, real engines with small actions, and what crosses the wire between them, for tests."""

from __future__ import annotations

import asyncio
import json
from collections import Counter
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from typing import Any, cast

from parley.agents.base import Node
from parley.agents.chat.chat_interface import ChatInterface
from parley.agents.planner.asking import SHALL_I
from parley.agents.planner.ordering import Judge
from parley.agents.planner.sending import Patience
from parley.agents.planner.umrf_planner import UmrfPlanner
from parley.agents.recovery.error_handler import ErrorHandler
from parley.clock import WallClock
from parley.demos.observer import Observer
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.engine.runs import GraphRuns
from parley.errors import ActionFailure, FailureCode
from parley.gate.rule_talk import RuleTalk
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.proposals import ProposalStore
from parley.messages import ros, topics
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.principal import Principal, person
from parley.messages.pvf import Parameter
from parley.messages.ros import String
from parley.messages.status import ActorStatus, PlanDecision
from parley.robots.base import Robot
from parley.transport.base import Transport
from parley.transport.local import LocalTransport
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph, write_graph
from parley.umrf.transition import Transition
from parley.world.object_map import MapObject

STEP_S = 0.005
KIM = person("Kim")
ENGINE = Principal(kind="engine", name="scripted")


@dataclass(frozen=True)
class Found:
    x: float


@dataclass
class Body:
    """What one robot did, and what its actions wait for or fail with."""

    did: list[str] = field(default_factory=list)
    """Runs of actions, in order."""
    way: int = 0
    """Grows while it drives."""
    far: set[float] = field(default_factory=set)
    """Places to which driving does not end by itself."""
    gates: dict[str, asyncio.Event] = field(default_factory=dict)
    """Looking at these things ends when the event is set."""
    failures: Counter[str] = field(default_factory=Counter)
    """How often the run of that text fails yet."""
    code: FailureCode = FailureCode.BLOCKED
    """How it fails."""
    there: set[str] = field(default_factory=set)
    """What checking finds."""
    broken: set[str] = field(default_factory=set)
    """Looking at these things fails, at its end."""

    def note(self, text: str) -> None:
        self.did.append(text)
        if self.failures[text] > 0:
            self.failures[text] -= 1
            raise ActionFailure(self.code, f"I cannot {text}.", {"by": "a box"})

    def gate(self, what: str) -> asyncio.Event:
        return self.gates.setdefault(what, asyncio.Event())

    async def stands_still(self) -> bool:
        before = self.way
        await asyncio.sleep(10 * STEP_S)
        return self.way == before


def actions_of(body: Body) -> Catalogue:
    """Finding gives coordinates, driving needs them; looking needs nothing."""

    @action(effects=("locates",))
    async def find(ctx: RunHandle, target: str) -> Found:
        """Find a thing."""
        body.note(f"find {target}")
        return Found(float(len(target)))

    @action(effects=("moves",))
    async def drive(ctx: RunHandle, x: float) -> None:
        """Drive to a place, three paces at least."""
        body.note(f"drive {x:g}")
        paces = 0
        while paces < 3 or x in body.far:
            await asyncio.sleep(STEP_S)
            await ctx.wait_while_paused()
            body.way += 1
            paces += 1

    @action(effects=("looks",), pausable=False)
    async def look(ctx: RunHandle, what: str) -> None:
        """Look at a thing."""
        body.note(f"look {what}")
        if what in body.gates:
            await body.gates[what].wait()
        if what in body.broken:
            raise ActionFailure(FailureCode.BLOCKED, f"I cannot see the {what}.")

    @action(effects=("looks",), pausable=False)
    async def check(ctx: RunHandle, what: str) -> bool:
        """Say whether a thing is there."""
        body.note(f"check {what}")
        return what in body.there

    @action(risk="high", pausable=False)
    async def press(ctx: RunHandle, what: str) -> None:
        """Press a thing, which may have consequences."""
        body.note(f"press {what}")

    @action(effects=("asks_operator",), pausable=False)
    async def ask(ctx: RunHandle, question: str) -> None:
        """Wait for a person."""
        body.note(f"ask {question}")
        await body.gate(question).wait()

    return Catalogue([find.spec, drive.spec, look.spec, check.spec, press.spec, ask.spec])


def find(target: str) -> ActionCall:
    return ActionCall(
        name="Find", input_parameters={"target": Parameter("string", target)}, reason=f"find the {target}"
    )


def drive(x: float | None = None) -> ActionCall:
    inputs = {"x": Parameter("number", x)} if x is not None else {}
    return ActionCall(name="Drive", input_parameters=inputs, reason="go there")


def look(what: str) -> ActionCall:
    return ActionCall(
        name="Look", input_parameters={"what": Parameter("string", what)}, reason=f"look at the {what}"
    )


def ask(question: str) -> ActionCall:
    return ActionCall(name="Ask", input_parameters={"question": Parameter("string", question)})


WATCHED: tuple[topics.Topic[Any], ...] = (
    topics.GRAPH_START, topics.GRAPH_MODIFY, topics.GRAPH_PAUSE, topics.GRAPH_PAUSE_TEMOTO,
    topics.GRAPH_RESUME, topics.GRAPH_STOP, topics.STEP, topics.PLAN, topics.ERROR_HANDLING,
    topics.ADD_TO_MEMORY, topics.REMOVE_MEMORY, topics.STOP, topics.ACTOR_STATUS,
)  # fmt: skip


class Wire(Node):
    """Keeps what crosses the topics between planner and engines, in order."""

    name = "wire"

    def __init__(self, transport: LocalTransport) -> None:
        super().__init__(transport)
        self.seen: list[tuple[str, Any]] = []

    async def open(self) -> None:
        for topic in WATCHED:
            await self.subscribe_raw(topic, lambda m, name=topic.name: self.seen.append((name, m)))  # type: ignore[misc]

    def of(self, topic: topics.Topic[Any]) -> list[Any]:
        """Messages of one topic."""
        return [message for name, message in self.seen if name == topic.name]

    def objects(self, topic: topics.Topic[String]) -> list[dict[str, Any]]:
        """JSON payloads of one topic."""
        return [json.loads(message.data) for message in self.of(topic)]

    def commands(self) -> list[str]:
        """The last words of the topics for engines, in order."""
        names = [name for name, _ in self.seen]
        return [name.rpartition("_")[2] for name in names if name.startswith("umrf_")]

    def continued_from(self) -> str:
        """Where the last change of a graph said to go on."""
        modified: list[ros.UmrfGraphModify] = self.of(topics.GRAPH_MODIFY)
        return modified[-1].continue_from


class Cable:
    """A transport that can be cut: then nothing gets through either way, and nobody is told."""

    def __init__(self, transport: LocalTransport) -> None:
        self._transport, self.cut = transport, False

    def publisher(self, topic: topics.Topic[Any]) -> Any:
        end = self._transport.publisher(topic)
        send = end.publish
        end.publish = lambda message: None if self.cut else send(message)  # type: ignore[method-assign]
        return end

    async def subscribe(self, topic: topics.Topic[Any], handler: Any, **how: Any) -> Any:
        def receive(message: Any) -> Any:
            return None if self.cut else handler(message)

        return await self._transport.subscribe(topic, receive, **how)

    async def serve(self, service: Any, handler: Any) -> Any:
        return await self._transport.serve(service, handler)


@dataclass
class Crew:
    """Everybody, and ways to talk to them; the robots are A, B, ..."""

    transport: LocalTransport
    observer: Observer
    wire: Wire
    language: ScriptedLanguage
    stack: AsyncExitStack
    planner: UmrfPlanner
    bodies: dict[str, Body] = field(default_factory=dict)
    _engines: dict[str, tuple[Cable, AsyncExitStack]] = field(default_factory=dict)

    @property
    def body(self) -> Body:
        return self.bodies["A"]

    async def engine(
        self, name: str, robot: Robot | None = None, journal: Journal | None = None
    ) -> ActionEngine:
        """Let an engine of ours come."""
        body = self.bodies.setdefault(name, Body())
        cable, stack = Cable(self.transport), await self.stack.enter_async_context(AsyncExitStack())
        self._engines[name] = (cable, stack)
        self.observer.robots.discard(name)
        engine = ActionEngine(
            name, transport=cast(Transport, cable), catalogue=actions_of(body), clock=WallClock(),
            make_context=lambda handle: handle, robot=robot, journal=journal,
        )  # fmt: skip
        await stack.enter_async_context(engine)
        await self.until(lambda: name in self.observer.robots)
        return engine

    async def dismiss(self, name: str) -> None:
        """Close its engine."""
        await self._engines[name][1].aclose()

    async def lose(self, name: str) -> None:
        """Its engine dies without a word; that its heartbeat is missed is told at once instead of in 5 s."""
        cable, stack = self._engines[name]
        cable.cut = True
        await stack.aclose()
        self.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor=name, state="leaving"))

    def cut(self, name: str, *, off: bool) -> None:
        """Nothing gets through to its engine or from it, or all does again; nobody is told."""
        self._engines[name][0].cut = off

    def order(
        self,
        *calls: ActionCall,
        target: str = "A",
        commands: Sequence[SystemCommand] = (),
        by: Principal = ENGINE,
    ) -> None:
        """What a language engine made of what a person said; `by` somebody else."""
        order = ChatAction(
            queue=calls, system_cmd=tuple(commands), targets=(target,), message_response="ok", by=by,
            behalf=KIM,
        )  # fmt: skip
        self.observer.publish(topics.CHAT_ACTION, order)

    def command(self, command: str, target: str = "A", **arguments: Any) -> None:
        asked = SystemCommand.model_validate({"command": command, "arguments": arguments})
        self.order(target=target, commands=[asked], by=KIM)

    def correct(
        self, *calls: ActionCall, target: str = "A", success: bool = True, by: Principal = ENGINE
    ) -> None:
        correction = ChatAction(queue=calls, targets=(target,), success=success, by=by)
        self.observer.publish(topics.UMRF_CORRECTION, correction)

    async def until(self, condition: Callable[[], Any], within_s: float = 10.0) -> None:
        async with asyncio.timeout(within_s):
            while not condition():  # noqa: ASYNC110 - several parties' states are awaited, not one event
                await asyncio.sleep(0.002)

    async def state(self, wanted: str, target: str = "A") -> None:
        await self.until(lambda: target in self.observer.plans and self.observer.state(target) == wanted)

    async def settled(self) -> None:
        """Let everything that is under way arrive."""
        await asyncio.sleep(0.06)

    async def doing(self, text: str, target: str = "A") -> None:
        """Wait until the robot has begun with this, and the planner knows it."""
        await self.until(lambda: text in self.bodies[target].did)
        await self.until(lambda: {"running", "waiting"} & set(self.steps(target)))

    def steps(self, target: str = "A") -> list[str]:
        plan = self.observer.plans.get(target)
        return [step.state for step in plan.steps] if plan else []

    def texts(self) -> list[str]:
        return [said.message for said in self.observer.said]

    async def hears(self, text: str) -> None:
        """Wait until somebody says something with `text` in it."""
        await self.until(lambda: any(text in said for said in self.texts()))


def proposals(party: Crew) -> list[dict[str, Any]]:
    """What was proposed so far."""
    return [item for item in party.wire.objects(topics.PLAN) if item["kind"] == "proposal"]


def decide(party: Crew, **decision: Any) -> None:
    """Decide as a person who sees what is proposed."""
    shown = {item["id"]: item["digest"] for item in proposals(party)}
    said = {"target": "A", "by": KIM, "digest": shown.get(decision.get("id"), ""), **decision}
    party.observer.publish(topics.PLAN_DECISION, PlanDecision.model_validate(said))


@asynccontextmanager
async def crew(
    *robots: str, talking: bool = False, heartless: Sequence[str] = (), ask_first: Sequence[str] = (),
    patience: Patience | None = None, proposals: ProposalStore | None = None, judge: Judge | None = None,
    rules: RuleTalk | None = None, objects: Sequence[MapObject] = (),
) -> AsyncIterator[Crew]:  # fmt: skip
    """A planner and engines for `robots`; at the end no handler may have failed.

    Args:
        robots: They have an engine of ours.
        talking: Whether chat interface and error handler are there too, with a scripted language.
        heartless: Known robots that send no heartbeat.
        ask_first: Robots whose plans wait for approval.
        patience: How long the planner waits.
        proposals: Where it keeps what waits for a yes.
        judge: What rules say about steps.
        rules: Hears what people say about rules.
        objects: What is on the map.
    """
    async with AsyncExitStack() as stack:
        transport = await stack.enter_async_context(LocalTransport())
        clock, language = WallClock(), ScriptedLanguage()
        observer = await stack.enter_async_context(Observer(transport, clock))
        wire = await stack.enter_async_context(Wire(transport))
        planner = await stack.enter_async_context(
            UmrfPlanner(
                transport, clock, known_robots=heartless, policies=dict.fromkeys(ask_first, "ask_first"),
                patience=patience or Patience(answer_s=1.0, progress_s=1.0, end_s=2.0), proposals=proposals,
                judge=judge, objects=lambda _: objects,
            )
        )  # fmt: skip
        if talking:
            handler = ErrorHandler(transport, language, clock, objects=lambda _: objects, rules=rules)
            await stack.enter_async_context(handler)
            chat = ChatInterface(transport, language, clock, objects=lambda _: objects, rules=rules)
            await stack.enter_async_context(chat)
        party = Crew(transport, observer, wire, language, stack, planner)
        for name in robots:
            await party.engine(name)
        yield party
        assert transport.handler_failures == 0
        assert [said for said in observer.said if said.message.endswith(SHALL_I) and not said.asks_yes] == []


class ThesisEngine(Node):
    """Stands for the reference engine: no heartbeat, no events, no refusals, feedback for nodes only.

    What it leaves unsaid is what `spec/umrf.md` 12.1 and D17 list: pausing, resuming, and that an error
    halted the graph.
    """

    name = "thesis_engine"

    def __init__(self, transport: LocalTransport, actor: str, body: Body) -> None:
        super().__init__(transport)
        self._actor = actor
        self._runs = GraphRuns(
            actor, actions_of(body), clock=WallClock(), make_context=lambda handle: handle,
            observer=self._observed,
        )  # fmt: skip

    async def open(self) -> None:
        self.opened.push_async_callback(self._runs.close)
        runs = self._runs
        await self.subscribe_raw(
            topics.GRAPH_START, lambda m: self._ours(m, lambda: runs.start(read_graph(m.umrf_graph_json)))
        )
        await self.subscribe_raw(
            topics.GRAPH_MODIFY,
            lambda m: self._ours(m, lambda: runs.modify(read_graph(m.modified_graph), m.continue_from)),
        )
        await self.subscribe_raw(
            topics.GRAPH_PAUSE_TEMOTO, lambda m: self._ours(m, lambda: runs.pause(m.umrf_graph_name))
        )
        await self.subscribe_raw(
            topics.GRAPH_RESUME, lambda m: self._ours(m, lambda: runs.resume(m.umrf_graph_name))
        )
        await self.subscribe_raw(
            topics.GRAPH_STOP, lambda m: self._ours(m, lambda: runs.stop(m.umrf_graph_name))
        )

    def _ours(self, message: Any, command: Callable[[], object]) -> None:
        if self._actor in message.targets:
            command()

    def _observed(self, run: GraphRun, transition: Transition) -> None:
        states = [str(node.state) for node in run.snapshot().nodes]
        if transition.kind == "node":
            told = transition.state in ("RUNNING", "STOPPING", "FINISHED", "ERROR")
            told = told and transition.cause not in ("pause", "resume")
        else:
            told = transition.cause in ("stop", "dry") and "ERROR" not in states
        if told:
            text = write_graph(run.snapshot())
            self.send(topics.GRAPH_FEEDBACK, ros.UmrfGraphFeedback(actor=self._actor, history=(text,)))
