"""The plan of one robot, without any transport: each test plays the engine by reporting graph states."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.agents.planner.approval import Approvals, PlanBoard
from parley.agents.planner.effects import (
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
from parley.agents.planner.plan import KEEP_DONE, TargetPlan
from parley.agents.planner.steps import Step, with_values
from parley.errors import FailureCode
from parley.messages.chat import ActionCall, Flow, SystemCommand
from parley.messages.failure import FailureReport
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo
from parley.umrf.model import Graph, GraphState, LogMessage, Node, NodeState


def find(target: str) -> ActionCall:
    """An action that gives coordinates."""
    return ActionCall(
        name="Find",
        input_parameters={"target": Parameter("string", target)},
        output_parameters={"x": Parameter("number")},
        reason=f"find the {target}",
    )


def drive() -> ActionCall:
    """An action that needs coordinates from the step before."""
    return ActionCall(name="Drive", input_parameters={"x": Parameter("number")})


def look(what: str = "box") -> ActionCall:
    """An action that needs nothing."""
    return ActionCall(name="Look", input_parameters={"what": Parameter("string", what)})


class Engine:
    """The other side: applies what the plan sends and reports states as an engine would."""

    def __init__(self, plan: TargetPlan) -> None:
        self.plan = plan
        self.graph = Graph("")
        self.states: dict[str, NodeState] = {}
        self.graph_state = GraphState.RUNNING
        self.messages: dict[str, str] = {}

    def take(self, effects: list[object]) -> list[object]:
        """Apply what was sent."""
        for effect in effects:
            if isinstance(effect, StartGraph):
                self.graph, self.states = effect.graph, {}
                self.graph_state = GraphState.RUNNING
                self.states[effect.graph.nodes[0].full_name] = NodeState.RUNNING
            elif isinstance(effect, EndStep) and self.states.get(effect.node) is NodeState.RUNNING:
                self.states[effect.node] = NodeState.FINISHED
                self.graph_state = GraphState.HALTED
            elif isinstance(effect, ModifyGraph):
                kept = {node.full_name for node in effect.graph.nodes}
                assert not any(s is NodeState.RUNNING for n, s in self.states.items() if n not in kept)
                self.graph = effect.graph
                if effect.continue_from:
                    assert effect.graph.node(effect.continue_from) is not None
                    self.states[effect.continue_from] = NodeState.RUNNING
                    self.graph_state = GraphState.RUNNING
        return effects

    def settle(self) -> None:
        """Report until nothing more comes of it."""
        for _ in range(5):
            if not self.report():
                return

    def report(self) -> list[object]:
        """What feedback says now."""
        nodes = tuple(
            Node(
                name=node.name,
                instance_id=node.instance_id,
                state=self.states.get(node.full_name, NodeState.UNINITIALIZED),
                messages=(LogMessage(1, self.messages[node.full_name]),)
                if node.full_name in self.messages
                else (),
            )
            for node in self.graph.nodes
        )
        graph = Graph(self.graph.name, nodes, state=self.graph_state)
        return self.take(list(self.plan.reports.on_graph(graph)))

    def finish(self, *outputs: tuple[str, float]) -> list[object]:
        """The running node ends well, the next one starts, or the graph runs dry."""
        name = next(n for n, state in self.states.items() if state is NodeState.RUNNING)
        self.states[name] = NodeState.FINISHED
        self.plan.reports.on_outputs(self.graph.name, name, dict(outputs))
        order = [node.full_name for node in self.graph.nodes]
        following = order[order.index(name) + 1 :]
        if following:
            self.states[following[0]] = NodeState.RUNNING
        else:
            self.graph_state = GraphState.HALTED
        return self.report()

    def fail(self, code: FailureCode = FailureCode.BLOCKED) -> list[object]:
        """The running node fails and the graph halts."""
        name = next(n for n, state in self.states.items() if state is NodeState.RUNNING)
        self.states[name] = NodeState.ERROR
        self.messages[name] = FailureReport(message="it did not work", code=code).to_text()
        self.graph_state = GraphState.HALTED
        return self.report()


@pytest.fixture
def plan() -> TargetPlan:
    numbers = itertools.count()
    return TargetPlan("A", new_graph_name=lambda: f"graph_{next(numbers)}")


@pytest.fixture
def engine(plan: TargetPlan) -> Engine:
    return Engine(plan)


def states(plan: TargetPlan) -> list[str]:
    return [step.state for step in plan.steps]


def names(graph: Graph) -> list[str]:
    return [node.full_name for node in graph.nodes]


@pytest.mark.spec("12.6")
def test_first_order_starts_a_linear_graph_whose_errors_halt_it(plan: TargetPlan) -> None:
    (start,) = plan.append([find("box"), drive()])
    assert isinstance(start, StartGraph)
    assert names(start.graph) == ["Find_0", "Drive_1"]
    assert [str(r) for r in start.graph.nodes[1].parents[0].conditions.values()] == [
        "run", "run", "ignore", "ignore",
    ]  # fmt: skip
    assert {str(response) for response in start.graph.exit[0].conditions.values()} == {"ignore"}


def test_done_steps_end_idle_and_the_next_order_gets_a_graph_of_its_own(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look()])))
    engine.finish()
    assert (states(plan), plan.update().state) == (["finished"], "idle")
    (again,) = plan.append([look("door")])
    assert isinstance(again, StartGraph)
    assert again.graph.name == "graph_1"


@pytest.mark.spec("P3")
def test_append_while_running_modifies_without_naming_a_node(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    (modify,) = plan.append([look("door")])
    assert isinstance(modify, ModifyGraph)
    assert (names(modify.graph), modify.continue_from) == (["Look_0", "Look_1"], "")


def test_append_before_the_start_is_confirmed_waits_for_it(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    assert plan.append([look("door")]) == []
    (modify,) = engine.report()
    assert isinstance(modify, ModifyGraph)
    assert len(modify.graph.nodes) == 2


@pytest.mark.spec("P9")
def test_append_that_races_with_the_end_is_nudged_on(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    engine.take(list(plan.append([look("door")])))
    engine.states["Look_0"] = NodeState.FINISHED
    engine.graph_state = GraphState.HALTED
    (nudge,) = engine.report()
    assert isinstance(nudge, ModifyGraph)
    assert nudge.continue_from == "Look_1"


def test_stale_halt_after_the_nudge_is_not_a_failure_but_lasting_silence_is(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look(), look("door")])))
    engine.report()
    engine.states["Look_0"] = NodeState.FINISHED
    engine.graph_state = GraphState.HALTED
    engine.report()
    engine.states["Look_1"] = NodeState.UNINITIALIZED
    engine.graph_state = GraphState.HALTED
    assert engine.report() == []
    (failure,) = plan.reports.on_no_progress("graph_0", "Look_1")
    assert isinstance(failure, ReportFailure)


@pytest.mark.spec("P8")
def test_failure_holds_the_robot_and_is_reported_once(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([find("box"), drive(), look()])))
    engine.finish(("x", 1.5))
    (report,) = engine.fail()
    assert isinstance(report, ReportFailure)
    assert report.message.code is FailureCode.BLOCKED
    assert [call.name for call in report.message.umrf_queue] == ["Look"]
    assert [call.name for call in report.message.completed] == ["Find"]
    assert engine.report() == []
    assert plan.update().state == "held"


def test_a_step_that_failed_while_all_stood_still_is_tried_again(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.fail(FailureCode.HARDWARE)
    engine.graph_state = GraphState.PAUSED  # somebody had stopped it before
    engine.report()
    modify, resume = plan.start()
    assert isinstance(modify, ModifyGraph) and isinstance(resume, ResumeGraph)
    engine.take([modify])
    engine.graph_state = GraphState.HALTED
    (again,) = engine.report()
    assert isinstance(again, ModifyGraph) and again.continue_from == "Look_1"


def test_correction_replaces_the_failed_step_and_continues_there(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([find("box"), drive()])))
    engine.fail(FailureCode.AMBIGUOUS)
    (modify,) = plan.correct([find("red box")])
    assert isinstance(modify, ModifyGraph)
    assert (names(modify.graph), modify.continue_from) == (["Find_2", "Drive_3"], "Find_2")
    assert not plan.held


@pytest.mark.spec("P14")
def test_orders_during_a_repair_run_after_it(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.fail()
    assert plan.append([look("door")]) == []
    (modify,) = plan.correct([look("lid")])
    assert isinstance(modify, ModifyGraph)
    assert [n.input_parameters["what"].value for n in modify.graph.nodes] == ["lid", "door"]


def test_trying_again_hands_over_what_the_step_before_gave(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([find("box"), drive()])))
    engine.finish(("x", 1.5))
    engine.fail()
    (modify,) = plan.start()
    assert isinstance(modify, ModifyGraph)
    again = modify.graph.node(modify.continue_from)
    assert again is not None
    assert again.input_parameters["x"].value == 1.5


def test_trying_again_repeats_the_giver_where_its_outputs_are_unknown(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([find("box"), drive()])))
    engine.finish()
    engine.fail()
    (modify,) = plan.start()
    assert isinstance(modify, ModifyGraph)
    assert modify.continue_from.startswith("Find_")
    assert [node.name for node in modify.graph.nodes] == ["Find", "Find", "Drive"]


def test_leaving_out_a_failed_step_drops_what_depends_on_it(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([find("box"), drive(), look()])))
    engine.fail(FailureCode.NO_MATCH)
    (modify,) = plan.skip()
    assert isinstance(modify, ModifyGraph)
    assert [node.name for node in modify.graph.nodes] == ["Look"]
    assert states(plan) == ["skipped", "skipped", "queued"]


def test_a_step_that_failed_and_is_left_out_is_told_as_left_out(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look("box"), look("door")])))
    engine.settle()
    engine.fail()
    engine.take(list(plan.skip()))
    engine.settle()
    assert states(plan) == ["skipped", "running"]
    engine.finish()
    assert (states(plan), plan.update().state) == (["skipped", "finished"], "idle")


def test_going_on_after_an_alert_leaves_nothing_out(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look(), look("door")])))
    engine.fail(FailureCode.ATTENTION)
    (modify,) = plan.correct([])
    assert isinstance(modify, ModifyGraph)
    assert modify.continue_from == "Look_1"
    assert states(plan) == ["finished", "queued"]


@pytest.mark.spec("P7", "P15")
def test_skip_ends_the_running_step_and_goes_on_with_the_next(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look(), look("door")])))
    engine.report()
    (end,) = plan.skip()
    assert end == EndStep("graph_0", "Look_0")
    engine.states["Look_0"] = NodeState.FINISHED
    engine.graph_state = GraphState.HALTED
    (modify,) = engine.report()
    assert isinstance(modify, ModifyGraph)
    assert modify.continue_from == "Look_1"
    assert states(plan) == ["skipped", "queued"]


@pytest.mark.parametrize("can_end_step", [True, False])
def test_undoing_a_skip_lets_what_began_instead_make_way(can_end_step: bool) -> None:
    numbers = itertools.count()
    plan = TargetPlan("A", new_graph_name=lambda: f"graph_{next(numbers)}", can_end_step=lambda: can_end_step)
    engine = Engine(plan)
    first, second, third = look("bed"), look("door"), look("lamp")
    engine.take(list(plan.append([first, second, third])))
    engine.settle()
    before = [(step.call, step.id) for step in plan.steps]

    def settle(effects: list[Effect]) -> None:
        engine.take(list(effects))
        for stopped in (effect for effect in effects if isinstance(effect, StopGraph)):
            engine.take(list(plan.reports.on_graph(Graph(stopped.graph_name, state=GraphState.STOPPED))))
        engine.settle()

    settle(plan.skip())
    gone, begun = plan.steps[0] if can_end_step else None, plan.current
    assert begun is not None and begun.call == second
    undoes = {step.id for step in (gone, begun) if step is not None}
    settle(plan.edit([first, second, third], undoes))
    assert [(step.call, step.state) for step in plan.steps] == [
        (first, "running"), (second, "queued"), (third, "queued"),
    ]  # fmt: skip
    if can_end_step:
        assert [(step.call, step.id) for step in plan.steps] == before
    for _ in range(3):
        engine.finish()
    assert states(plan) == ["finished"] * 3, "nothing was left out"


def test_what_was_given_up_and_is_put_back_behind_another_order_is_still_part_of_its_own(
    engine: Engine,
) -> None:
    plan = engine.plan

    def settle(effects: list[Effect]) -> None:
        engine.take(list(effects))
        for stopped in (effect for effect in effects if isinstance(effect, StopGraph)):
            engine.take(list(plan.reports.on_graph(Graph(stopped.graph_name, state=GraphState.STOPPED))))
        engine.settle()

    settle(plan.append([look("box"), look("lid")], "both", "first"))
    gone = {step.id for step in plan.steps}
    settle(plan.clear())
    settle(plan.append([look("door")], "the door", "second"))
    settle(plan.edit([look("box"), look("lid")], gone))
    assert [(step.order, step.words) for step in plan.steps] == [
        ("second", "the door"), ("first", "both"), ("first", "both"),
    ]  # fmt: skip
    assert gone == {step.id for step in plan.steps[1:]}


def test_skip_without_the_command_for_steps_restarts_the_rest(engine: Engine) -> None:
    numbers = itertools.count()
    plan = TargetPlan("A", new_graph_name=lambda: f"graph_{next(numbers)}", can_end_step=lambda: False)
    other = Engine(plan)
    other.take(list(plan.append([look(), look("door")])))
    other.report()
    assert plan.skip() == [StopGraph("graph_0")]
    other.graph_state = GraphState.STOPPED
    (start,) = other.report()
    assert isinstance(start, StartGraph)
    assert [n.input_parameters["what"].value for n in start.graph.nodes] == ["door"]


def test_second_skip_while_the_graph_is_stopping_leaves_out_the_next_step_too() -> None:
    numbers = itertools.count()
    plan = TargetPlan("A", new_graph_name=lambda: f"graph_{next(numbers)}", can_end_step=lambda: False)
    other = Engine(plan)
    other.take(list(plan.append([look(), look("door"), look("lid")])))
    other.report()
    assert plan.skip() == [StopGraph("graph_0")]
    assert plan.skip() == []
    other.graph_state = GraphState.STOPPED
    (start,) = other.report()
    assert isinstance(start, StartGraph)
    assert [n.input_parameters["what"].value for n in start.graph.nodes] == ["lid"]


def test_what_ended_before_a_stop_took_hold_is_not_done_again() -> None:
    numbers = itertools.count()
    plan = TargetPlan("A", new_graph_name=lambda: f"graph_{next(numbers)}", can_end_step=lambda: False)
    other = Engine(plan)
    other.take(list(plan.append([look(), look("door"), look("lid")])))
    other.report()
    assert plan.skip() == [StopGraph("graph_0")]
    other.states = {"Look_0": NodeState.FINISHED, "Look_1": NodeState.FINISHED, "Look_2": NodeState.RUNNING}
    other.report()
    other.graph_state, other.states["Look_2"] = GraphState.STOPPED, NodeState.FINISHED
    (start,) = other.report()
    assert isinstance(start, StartGraph)
    assert [n.input_parameters["what"].value for n in start.graph.nodes] == ["lid"]


def test_what_ran_on_beside_a_step_that_failed_during_a_pause_is_not_done_again() -> None:
    plan = TargetPlan("A", new_graph_name=lambda: "graph_0", can_end_step=lambda: False)
    other = Engine(plan)
    beside = look("door").model_copy(update={"flow": Flow(together_with=0)})
    other.take(list(plan.append([look(), beside])))
    other.states = {"Look_0": NodeState.RUNNING, "Look_1": NodeState.RUNNING}
    other.report()
    plan.pause()
    other.graph_state = GraphState.PAUSED
    other.states = {"Look_0": NodeState.ERROR, "Look_1": NodeState.PAUSED}
    other.report()
    other.take(list(plan.start()))
    other.graph_state = GraphState.RUNNING
    other.states = {"Look_1": NodeState.RUNNING}
    other.report()
    other.states["Look_1"] = NodeState.FINISHED
    other.report()
    assert [step.state for step in plan.steps] == ["queued", "finished"]


@pytest.mark.parametrize("ours", [True, False])
def test_what_is_added_to_a_paused_plan_is_in_the_graph_of_our_engines_and_waits_elsewhere(
    ours: bool,
) -> None:
    plan = TargetPlan("A", new_graph_name=lambda: "graph_0", can_end_step=lambda: ours)
    engine = Engine(plan)
    engine.take(list(plan.append([look(), look("door")])))
    engine.report()
    assert plan.pause() == [PauseGraph("graph_0")]
    engine.graph_state = GraphState.PAUSED
    engine.report()
    assert plan.update().state == "paused"
    added = plan.append([look("lid")])
    *modified, resume = [*added, *plan.start()]
    (modify,) = modified  # once, and over a crash only what an engine has is kept
    assert isinstance(modify, ModifyGraph) and modify.continue_from == ""
    assert len(modify.graph.nodes) == 3
    assert resume == ResumeGraph("graph_0")
    assert bool(added) is ours


def test_going_on_unchanged_resumes(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    plan.pause()
    assert plan.start() == [ResumeGraph("graph_0")]


def test_to_go_on_is_said_again_until_it_is_seen_or_somebody_says_stop(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    plan.pause()
    assert plan.start() == [ResumeGraph("graph_0")]
    engine.graph_state = GraphState.PAUSED
    engine.report()
    assert plan.reports.on_no_resume("graph_0") == [ResumeGraph("graph_0")]
    assert plan.reports.on_return({"graph_0": "PAUSED"}) == [ResumeGraph("graph_0")]
    engine.graph_state = GraphState.RUNNING
    engine.report()
    engine.graph_state = GraphState.PAUSED
    engine.report()
    assert not plan.reports.on_no_resume("graph_0"), "somebody else paused it since"
    plan.start()
    plan.pause()
    assert not plan.reports.on_no_resume("graph_0")
    plan.start()
    plan.reports.on_refused("graph_0", "umrf_graph_resume", {"stop_latched"})
    assert not plan.reports.on_no_resume("graph_0")


def test_pause_that_overtook_the_start_is_sent_again(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    assert plan.pause() == [PauseGraph("graph_0")]
    plan.reports.on_refused("graph_0", "umrf_graph_pause")
    assert engine.report() == [PauseGraph("graph_0")]


@pytest.mark.spec("P5")
def test_clear_stops_and_nothing_new_starts_before_the_end_is_reported(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look(), look("door")])))
    engine.report()
    assert plan.clear() == [StopGraph("graph_0")]
    assert plan.append([look("lid")]) == []
    engine.graph_state = GraphState.STOPPED
    (start,) = engine.report()
    assert isinstance(start, StartGraph)
    assert start.graph.name == "graph_1"


@pytest.mark.spec("P4")
def test_late_reports_of_an_old_graph_change_nothing(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    plan.clear()
    plan.reports.on_graph(Graph("graph_0", state=GraphState.STOPPED))
    engine.take(list(plan.append([look("door")])))
    before = states(plan)
    late = Graph("graph_0", (Node("Look", 0, state=NodeState.ERROR),), state=GraphState.STOPPED)
    assert plan.reports.on_graph(late) == []
    assert states(plan) == before


def test_an_end_that_is_never_reported_does_not_block_for_ever(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    plan.clear()
    plan.append([look("door")])
    (start,) = plan.reports.on_no_end("graph_0")
    assert isinstance(start, StartGraph)


def test_pop_drops_the_named_step(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look("1"), look("2"), look("3")])))
    engine.report()
    (modify,) = plan.pop(1)
    assert isinstance(modify, ModifyGraph)
    assert [n.input_parameters["what"].value for n in modify.graph.nodes] == ["1", "3"]


def test_step_is_dropped_by_what_it_is_whatever_ended_meanwhile(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look("1"), look("2"), look("3")])))
    engine.report()
    shown = plan.update().steps
    pop = SystemCommand(command="pop", arguments={"parameters": 2, "step": shown[2].id})
    engine.finish()
    step = plan.meant(pop)
    assert step is not None
    assert step.call.input_parameters["what"].value == "3"
    plan.drop(step)
    assert plan.meant(pop) is None
    assert [item.call.input_parameters["what"].value for item in plan.pending] == ["2"]


@pytest.mark.parametrize("index", [None, -1, 5])
@pytest.mark.spec("P15")
def test_impossible_pop_changes_nothing_and_says_so(
    plan: TargetPlan, engine: Engine, index: int | None
) -> None:
    engine.take(list(plan.append([look("1"), look("2")])))
    engine.report()
    (said,) = plan.pop(index)
    assert isinstance(said, Say)
    assert said.type == "error"
    assert len(plan.pending) == 2


def test_after_giving_up_the_next_order_takes_the_failed_steps_place(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([find("box"), drive()])))
    engine.fail()
    plan.give_up()
    assert plan.update().state == "held"
    (modify,) = plan.append([look()])
    assert isinstance(modify, ModifyGraph)
    assert [node.name for node in modify.graph.nodes] == ["Look"]


@pytest.mark.spec("P2")
def test_refused_start_leaves_nothing_running(plan: TargetPlan) -> None:
    plan.append([look()])
    plan.reports.on_refused("graph_0", "umrf_graph_start")
    assert (plan.run, plan.update().state) == ("none", "idle")


def test_silent_robot_is_reported_and_the_plan_kept(plan: TargetPlan) -> None:
    plan.append([look()])
    (said,) = plan.reports.on_no_answer("graph_0")
    assert isinstance(said, Say)
    (start,) = plan.start()
    assert isinstance(start, StartGraph)


def test_correction_without_a_failure_is_late_and_changes_nothing(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    assert plan.correct([look("lid")]) == []


@pytest.mark.spec("P11")
def test_finished_steps_do_not_pile_up_in_the_graph(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look(str(n)) for n in range(KEEP_DONE + 30)])))
    for _ in range(KEEP_DONE + 20):
        engine.finish()
    (modify,) = plan.append([look("last")])
    assert isinstance(modify, ModifyGraph)
    assert len(modify.graph.nodes) == KEEP_DONE + 10 + 1


def _move(plan: TargetPlan, engine: Engine, move: str) -> list[Effect]:
    running = any(state is NodeState.RUNNING for state in engine.states.values())
    live = bool(engine.graph.name) and engine.graph.name == plan.graph_name
    if move in ("finish", "fail"):
        if running and live:
            engine.finish(("x", 1.0)) if move == "finish" else engine.fail()
        return []
    if move == "clear":
        engine.states.clear()
    orders: dict[str, Callable[[], list[Effect]]] = {
        "append": lambda: plan.append([find("box"), drive()]),
        "correct": lambda: plan.correct([find("red box")]),
        "skip": plan.skip,
        "pop": lambda: plan.pop(1),
        "clear": plan.clear,
        "pause": plan.pause,
        "start": plan.start,
    }
    return orders[move]()


@given(
    st.lists(
        st.sampled_from(["append", "finish", "fail", "correct", "skip", "pop", "clear", "pause", "start"])
    )
)
@pytest.mark.spec("P7")
def test_ids_rise_along_the_plan_and_are_never_reused(moves: list[str]) -> None:
    numbers = itertools.count()
    plan = TargetPlan("A", new_graph_name=lambda: f"graph_{next(numbers)}")
    engine = Engine(plan)
    seen: dict[tuple[str, int], ActionCall] = {}
    for move in moves:
        engine.take(list(_move(plan, engine, move)))
        for step in plan.steps:
            if step.instance_id >= 0:
                key = (plan.graph_name, step.instance_id)
                assert seen.setdefault(key, step.call).name == step.call.name
        ids = [node.instance_id for node in engine.graph.nodes]
        assert ids == sorted(set(ids))


def test_step_that_began_just_before_it_was_dropped_is_ended(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look("1"), look("2"), look("3")])))
    engine.report()
    plan.pop(1)
    assert plan.reports.on_refused("graph_0", "umrf_graph_modify", {"node_active"}) == []
    engine.states |= {"Look_0": NodeState.FINISHED, "Look_1": NodeState.RUNNING}
    assert EndStep("graph_0", "Look_1") in engine.report()


def test_stop_between_dropping_everything_and_the_next_start_is_kept(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    plan.clear()
    plan.append([look("door")])
    plan.pause()
    engine.graph_state = GraphState.STOPPED
    assert engine.report() == []
    assert plan.update().state == "paused"
    (start,) = plan.start()
    assert isinstance(start, StartGraph)


def test_change_that_a_latched_stop_refused_is_sent_again_when_going_on(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look()])))
    engine.fail()
    plan.correct([look("lid")])
    (said,) = plan.reports.on_refused("graph_0", "umrf_graph_modify", {"stop_latched"})
    assert isinstance(said, Say)
    (modify,) = plan.start()
    assert isinstance(modify, ModifyGraph)
    assert modify.continue_from == "Look_1"


def test_leaving_out_the_last_step_says_that_nothing_is_left(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.fail()
    assert plan.skip() == [Say("Nothing else is left to do.")]
    assert plan.update().state == "idle"


def test_robot_that_is_back_without_its_graph_waits_for_going_on(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look()])))
    engine.report()
    assert plan.reports.on_return({"graph_0": "RUNNING"}) == []
    (said,) = plan.reports.on_return({})
    assert isinstance(said, Say)
    assert plan.update().state == "paused"
    (start,) = plan.start()
    assert isinstance(start, StartGraph)


def test_leaving_out_a_step_lets_nobody_go_on_who_was_told_to_stop(plan: TargetPlan, engine: Engine) -> None:
    engine.take(list(plan.append([look(), look("door")])))
    engine.report()
    plan.pause()
    engine.graph_state = GraphState.PAUSED
    engine.report()
    plan.skip()
    engine.states["Look_0"] = NodeState.FINISHED
    assert engine.report() == []
    assert plan.update().state == "paused"
    engine.graph_state = GraphState.HALTED
    plan.start()
    (modify,) = engine.report()
    assert isinstance(modify, ModifyGraph)
    assert modify.continue_from == "Look_1"


@pytest.mark.parametrize("stale", [False, True])
def test_stop_that_overtook_the_continuation_is_sent_again(
    plan: TargetPlan, engine: Engine, stale: bool
) -> None:
    engine.take(list(plan.append([look(), look("door")])))
    engine.fail()
    plan.correct([look("lid")])
    if stale:
        engine.report()
    assert plan.pause() == [PauseGraph("graph_0")]
    engine.graph_state = GraphState.RUNNING
    assert engine.report() == [PauseGraph("graph_0")]


def test_a_pause_or_a_clear_that_a_robot_did_not_hear_holds_when_it_is_back(
    plan: TargetPlan, engine: Engine
) -> None:
    engine.take(list(plan.append([look("box"), look("door")])))
    engine.report()
    assert plan.pause() == [PauseGraph("graph_0")]
    assert plan.reports.on_return({"graph_0": "RUNNING"}) == [PauseGraph("graph_0")]
    assert plan.clear() == [StopGraph("graph_0")]
    assert plan.reports.on_no_end("graph_0") == []
    assert plan.reports.on_return({"graph_0": "PAUSED"}) == [StopGraph("graph_0")]
    assert plan.reports.on_return({"graph_0": "STOPPED"}) == []


def test_steps_are_put_into_words_anew_when_it_comes_to_be_known_what_a_robot_can_do(
    plan: TargetPlan,
) -> None:
    can: list[ActionInfo] = []
    approvals = Approvals()
    board = PlanBoard(lambda _: tuple(can))
    plan.append([look()], "")

    def label() -> str:
        board.show(plan, approvals)
        return board.shown[0].steps[0].label

    assert label() == "Look: what “box”"
    can.append(ActionInfo(name="Look", inputs={"what": "string"}, label="Look at {what}"))
    assert label() == "Look at “box”"
    can.clear()
    assert label() == "Look at “box”", "a robot that is gone for a moment can do what it could"


def test_a_way_is_called_by_what_was_looked_up_also_when_it_is_tried_again(
    plan: TargetPlan, engine: Engine
) -> None:
    axes = ("pose::position::x", "pose::position::y")
    where = {axis: Parameter("number") for axis in axes}
    search = find("box").model_copy(update={"output_parameters": where})
    way = drive().model_copy(update={"input_parameters": where})
    numbers = dict.fromkeys(axes, "number")
    can = (
        ActionInfo(name="Find", inputs={"target": "string"}, outputs=numbers, effects=("locates",)),
        ActionInfo(name="Drive", inputs=numbers, label="Go to {place}", effects=("moves",)),
    )
    board, approvals = PlanBoard(lambda _: can), Approvals()
    engine.take(list(plan.append([search, way], "")))
    engine.report()
    engine.finish(*((axis, 4.5) for axis in axes))
    engine.fail()
    engine.take(list(plan.correct([with_values(way, dict.fromkeys(axes, 4.5))])))
    board.show(plan, approvals)
    assert [step.label for step in board.shown[0].steps][-1] == "Go to “box”"
    plan.steps[-1].call = with_values(way, dict.fromkeys(axes, 7.0))
    board.show(plan, approvals)
    assert [step.label for step in board.shown[0].steps][-1] == "Go to “x 7.0 m, y 7.0 m”"


def test_what_an_earlier_process_left_is_told_as_what_it_goes_on_with_and_nothing_else_is(
    plan: TargetPlan, engine: Engine
) -> None:
    plan.restore([Step(look("box"))], "before")
    assert plan.update().continues == "before"
    engine.take(list(plan.start()))
    engine.settle()
    assert (plan.update().continues, plan.graph_name) == ("before", "graph_0")
    engine.finish()
    engine.take(list(plan.append([look("door")])))
    assert (plan.update().continues, plan.graph_name) == ("", "graph_1")
