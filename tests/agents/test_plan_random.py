"""Random plans with random flows, outcomes, orders and delays, carried out by the real graph executor.

Whatever comes: it never hangs, every step ends in one state, and nothing that was done is done again.
"""

from __future__ import annotations

import asyncio
import itertools
from collections import Counter, deque
from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from parley.agents.planner.check import check_calls
from parley.agents.planner.effects import (
    AwaitResult,
    Effect,
    EndStep,
    ModifyGraph,
    PauseGraph,
    ReportFailure,
    ResumeGraph,
    Say,
    StartGraph,
    StopGraph,
)
from parley.agents.planner.plan import TargetPlan
from parley.clock import WallClock
from parley.engine.runs import GraphRuns
from parley.errors import ActionFailure, FailureCode, GraphRefusedError
from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.messages.pvf import Parameter
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import GraphRun
from parley.umrf.model import Graph, GraphState, NodeState
from parley.umrf.transition import Transition

FINAL = {"finished", "skipped", "stopped"}


class Rig:
    """A plan, a real executor, and everything in between under way until it is delivered."""

    def __init__(self, *, tells_all: bool = True) -> None:
        numbers = itertools.count()
        self.tells_all = tells_all
        """Whether there are events and commands for one step, as with our engines."""
        self.plan = TargetPlan(
            "A", new_graph_name=lambda: f"graph_{next(numbers)}", can_end_step=lambda: tells_all
        )
        self.labels = itertools.count()
        self.going: dict[str, asyncio.Future[str]] = {}
        self.done: Counter[str] = Counter()
        self.answers: set[str] = set()
        """What was not there, which is an end where others ask for it."""
        self.known: set[str] = set()
        """What the plan was told is done."""
        self.repeated: list[str] = []
        """What began although the plan knew that it was done."""
        self.commands: deque[Effect] = deque()
        self.events: deque[Transition] = deque()
        self.event_graphs: deque[str] = deque()
        self.feedback: dict[str, Graph] = {}
        self.awaited: deque[str] = deque()
        self.catalogue = Catalogue([self._work().spec])
        self.runs = GraphRuns(
            "A",
            self.catalogue,
            clock=WallClock(),
            make_context=lambda handle: handle,
            observer=self._observed,
        )

    def _work(self) -> Any:
        @action()
        async def work(ctx: RunHandle, label: str) -> bool:
            """Do what the test says."""
            outcome = asyncio.get_running_loop().create_future()
            assert label not in self.going
            if label in self.known:
                self.repeated.append(label)
            self.going[label] = outcome
            try:
                how = await outcome
            finally:
                del self.going[label]
            if how == "fail":
                raise ActionFailure(FailureCode.BLOCKED, "It did not work.")
            if how == "absent":
                self.answers.add(label)
                raise ActionFailure(FailureCode.NO_MATCH, "It is not there.")
            self.done[label] += 1
            return bool(how == "true")

        return work

    def _observed(self, run: GraphRun, transition: Transition) -> None:
        if self.tells_all:
            self.events.append(transition)
            self.event_graphs.append(run.name)
        self.feedback[run.name] = run.snapshot()

    def call(self, flow: Flow | None = None) -> ActionCall:
        label = f"step {next(self.labels)}"
        return ActionCall(name="Work", input_parameters={"label": Parameter("string", label)}, flow=flow)

    def order(self, flows: list[Flow | None]) -> list[Effect]:
        calls = [self.call(flow) for flow in flows]
        if check_calls(calls, self.catalogue.infos()):
            return []
        return self.plan.append(calls)

    def take(self, effects: list[Effect]) -> None:
        self.commands.extend(effects)

    def deliver_command(self) -> None:
        if self.commands:
            effect = self.commands.popleft()
            try:
                self._command(effect)
            except GraphRefusedError as error:
                what = {
                    StartGraph: "start",
                    ModifyGraph: "modify",
                    PauseGraph: "pause",
                    ResumeGraph: "resume",
                }
                codes = {problem.code for problem in error.problems}
                if type(effect) in what:
                    self.take(
                        self.plan.reports.on_refused(
                            error.graph_name, f"umrf_graph_{what[type(effect)]}", codes
                        )
                    )

    def _command(self, effect: Effect) -> None:
        match effect:
            case StartGraph(graph):
                self.runs.start(graph)
            case ModifyGraph(graph, continue_from):
                self.runs.modify(graph, continue_from)
            case PauseGraph(name):
                self.runs.pause(name)
            case ResumeGraph(name):
                self.runs.resume(name)
            case StopGraph(name):
                self.runs.stop(name)
            case EndStep(name, node):
                self.runs.end_node(name, node)
            case AwaitResult(name):
                self.awaited.append(name)
            case ReportFailure() | Say():
                pass

    def deliver_event(self) -> None:
        if self.events:
            event, graph = self.events.popleft(), self.event_graphs.popleft()
            if event.kind == "node" and event.result is not None:
                self.take(self.plan.reports.on_result(graph, event.node, event.result.value))

    def deliver_feedback(self) -> None:
        for graph in list(self.feedback.values()):
            states = {str(node.input_parameters["label"].value): node.state for node in graph.nodes}
            if graph.state is GraphState.RUNNING and NodeState.ERROR not in states.values():
                ended = {label for label, state in states.items() if state is NodeState.FINISHED}
                self.known |= ended & self.done.keys()
            self.take(self.plan.reports.on_graph(graph))
        self.feedback.clear()

    async def settle(self) -> None:
        """Deliver everything until nothing more comes of it."""
        for _ in range(300):
            await asyncio.sleep(0)
            if not (self.commands or self.events or self.feedback):
                await asyncio.sleep(0)
                await asyncio.sleep(0)
                if not (self.commands or self.events or self.feedback):
                    return
            self.deliver_command()
            self.deliver_event()
            self.deliver_feedback()
        raise AssertionError("it goes in circles")

    async def end(self) -> None:
        """Let everything succeed from now on; repair what failed and go on with what stands still."""
        for _ in range(200):
            await self.settle()
            if self.going and not self.paused:
                next(iter(self.going.values())).set_result("true")
            elif self.awaited:
                self.take(self.plan.reports.on_no_result(self.awaited.popleft()))
            elif self.plan.held or self.plan.pending:
                self.take(self.plan.start())
            else:
                return
        states = [(step.call.input_parameters["label"].value, step.state) for step in self.plan.steps]
        raise AssertionError(f"it hangs: {self.plan.run} {states}")

    @property
    def paused(self) -> bool:
        return self.plan.update().state in ("paused", "held")


@st.composite
def flows(draw: st.DrawFn) -> list[Flow | None]:
    """Flows of a queue, mostly possible ones."""
    found: list[Flow | None] = []
    for index in range(draw(st.integers(1, 6))):
        kind = draw(st.sampled_from(["plain", "if", "if", "together"])) if index else "plain"
        step = draw(st.integers(0, index - 1)) if index else 0
        if kind == "if":
            found.append(Flow(if_=FlowIf(step=step, result=draw(st.booleans()))))
        elif kind == "together":
            found.append(Flow(together_with=step))
        else:
            found.append(None)
    return found


MOVES = st.one_of(
    st.tuples(st.just("order"), flows()),
    st.tuples(st.sampled_from(["true", "true", "false", "fail", "absent"]), st.integers(0, 3)),
    st.tuples(st.sampled_from(["command", "event", "feedback", "loop", "settle"]), st.just(0)),
    st.tuples(st.sampled_from(["pause", "start", "skip", "clear", "give_up"]), st.just(0)),
    st.tuples(st.sampled_from(["pop", "correct", "edit", "undo"]), st.integers(0, 4)),
)


async def _move(rig: Rig, kind: str, value: Any) -> None:
    plan = rig.plan
    orders: dict[str, Callable[[], list[Effect]]] = {
        "order": lambda: rig.order(value),
        "pause": plan.pause,
        "start": plan.start,
        "skip": plan.skip,
        "clear": plan.clear,
        "give_up": plan.give_up,
        "pop": lambda: plan.pop(value),
        "correct": lambda: plan.correct([rig.call() for _ in range(value % 3)]),
        "edit": lambda: plan.edit([rig.call() for _ in range(value)]),
        "undo": lambda: plan.edit([rig.call() for _ in range(value)], {step.id for step in plan.steps}),
    }
    if kind in orders:
        rig.take(orders[kind]())
    elif kind in ("true", "false", "fail", "absent"):
        waiting = [future for future in rig.going.values() if not future.done()]
        if waiting:
            waiting[value % len(waiting)].set_result(kind)
            await asyncio.sleep(0)
    elif kind == "settle":
        await rig.settle()
    else:
        {"command": rig.deliver_command, "event": rig.deliver_event, "feedback": rig.deliver_feedback}.get(
            kind, lambda: None
        )()
        await asyncio.sleep(0)


async def _play(first: list[Flow | None], moves: list[tuple[str, Any]], *, tells_all: bool) -> None:
    rig = Rig(tells_all=tells_all)
    try:
        rig.take(rig.order(first))
        for kind, value in moves:
            await _move(rig, kind, value)
        await rig.end()
    finally:
        for future in list(rig.going.values()):
            if not future.done():
                future.set_result("true")
        await rig.runs.close()
    assert {step.state for step in rig.plan.steps} <= FINAL
    assert rig.plan.update().state == "idle"
    assert not rig.going
    finished = {
        step.call.input_parameters["label"].value for step in rig.plan.steps if step.state == "finished"
    }
    assert finished <= rig.done.keys() | rig.answers
    assert rig.repeated == []
    if tells_all:
        assert [label for label, times in rig.done.items() if times > 1] == []


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(flows(), st.lists(MOVES, max_size=25))
def test_random_plans_end_and_nothing_is_done_twice(
    first: list[Flow | None], moves: list[tuple[str, Any]]
) -> None:
    asyncio.run(_play(first, moves, tells_all=True))


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(flows(), st.lists(MOVES, max_size=25))
def test_random_plans_end_with_an_engine_that_tells_nothing_but_whole_graphs(
    first: list[Flow | None], moves: list[tuple[str, Any]]
) -> None:
    asyncio.run(_play(first, moves, tells_all=False))
