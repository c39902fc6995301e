"""Conditions and concurrency of plans with real engines: what runs, in which order, and what is left out."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from parley.errors import FailureCode
from parley.messages import topics
from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.messages.pvf import Parameter
from parley.messages.status import StepCommand
from parley.umrf.io import read_graph
from parley.umrf.model import Response, Result
from tests.agents.crew import Body, ThesisEngine, ask, crew, decide, drive, find, look, proposals


def check(what: str) -> ActionCall:
    """Ends with whether `what` is among the things that are there."""
    return ActionCall(
        name="Check", input_parameters={"what": Parameter("string", what)}, reason=f"check the {what}"
    )


def when(call: ActionCall, step: int, result: bool = True) -> ActionCall:
    return call.model_copy(update={"flow": Flow(if_=FlowIf(step=step, result=result))})


def beside(call: ActionCall, step: int) -> ActionCall:
    return call.model_copy(update={"flow": Flow(together_with=step)})


BRANCHES = [
    check("box"),
    when(look("lid"), 0),
    when(look("label"), 0),
    when(look("floor"), 0, False),
    look("door"),
]


@dataclass(frozen=True)
class Case:
    """An order, what is there, what is done in which order, and the states of the steps at the end."""

    name: str
    order: list[ActionCall]
    there: set[str]
    did: list[str]
    skipped: set[int] = field(default_factory=set)


CASES = [
    Case(
        "condition holds", BRANCHES, {"box"},
        ["check box", "look lid", "look label", "look door"], {3},
    ),
    Case("condition fails", BRANCHES, set(), ["check box", "look floor", "look door"], {1, 2}),
    Case("only a condition that fails", [check("box"), when(look("lid"), 0)], set(), ["check box"], {1}),
    Case(
        "condition further back holds",
        [check("box"), look("door"), when(look("lid"), 0), look("floor")], {"box"},
        ["check box", "look door", "look lid", "look floor"],
    ),
    Case(
        "condition further back fails",
        [check("box"), look("door"), when(look("lid"), 0), look("floor")], set(),
        ["check box", "look door", "look floor"], {2},
    ),
    Case(
        "condition on a step whose own condition fails",
        [check("box"), when(check("lid"), 0), when(look("label"), 1), when(look("paper"), 1, False)], set(),
        ["check box"], {1, 2, 3},
    ),
    Case(
        "condition in a condition",
        [
            check("box"), when(check("lid"), 0), when(look("label"), 1),
            when(look("paper"), 1, False), look("door"),
        ],
        {"box"}, ["check box", "check lid", "look paper", "look door"], {2},
    ),
    Case(
        "what lives on a step with a condition goes with it",
        [check("box"), when(find("box"), 0), drive(), look("door")], set(),
        ["check box", "look door"], {1, 2},
    ),
    Case(
        "two ways that give the same meet",
        [check("box"), when(find("box"), 0), when(find("lid!"), 0, False), drive(), look("door")], set(),
        ["check box", "find lid!", "drive 4", "look door"], {1},
    ),
]  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
@pytest.mark.spec("10.4")
async def test_steps_run_as_their_conditions_say(case: Case) -> None:
    async with crew("A") as party:
        party.body.there = case.there
        party.order(*case.order)
        ends = ["skipped" if index in case.skipped else "finished" for index in range(len(case.order))]
        await party.until(lambda: party.steps() == ends)
        assert party.body.did == case.did
        await party.state("idle")
        assert party.observer.failures == []


async def test_conditions_next_to_what_they_ask_are_edges_and_cost_no_further_command() -> None:
    async with crew("A") as party:
        party.order(*BRANCHES)
        await party.state("running")
        await party.state("idle")
        assert party.wire.commands() == ["start"]
        graph = read_graph(party.wire.of(topics.GRAPH_START)[0].umrf_graph_json)
        _, lid, _, floor, door = graph.nodes
        assert lid.parents[0].conditions[Result.ON_FALSE] is Response.IGNORE
        assert floor.parents[0].conditions[Result.ON_TRUE] is Response.IGNORE
        assert [(parent.node.name, parent.required) for parent in door.parents] == [("Look", False)] * 2


async def test_thing_that_is_not_found_is_an_answer_where_steps_ask_for_it() -> None:
    async with crew("A") as party:
        party.body.failures["find box"] = 1
        party.body.code = FailureCode.NO_MATCH
        party.order(find("box"), when(drive(), 0), when(look("floor"), 0, False), look("door"))
        await party.until(lambda: party.steps() == ["finished", "skipped", "finished", "finished"])
        assert party.body.did == ["find box", "look floor", "look door"]
        assert party.observer.failures == []


@pytest.mark.spec("10.4")
async def test_steps_run_at_the_same_time_and_what_follows_waits_for_both() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.body.gate("lid")
        party.order(look("box"), beside(look("lid"), 0), look("door"))
        await party.until(lambda: party.steps() == ["running", "running", "queued"])
        party.body.gate("lid").set()
        await party.until(lambda: party.steps() == ["running", "finished", "queued"])
        await party.settled()
        assert "look door" not in party.body.did
        party.body.gate("box").set()
        await party.until(lambda: party.steps() == ["finished"] * 3)
        assert party.body.did[-1] == "look door"
        assert len(party.body.did) == 3
        assert party.wire.commands() == ["start"]


async def test_step_that_fails_stops_the_one_beside_it_and_both_are_done_after_the_repair() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.body.gate("box")
        party.order(drive(1), beside(look("box"), 0), look("door"))
        await party.until(lambda: party.steps() == ["running", "running", "queued"])
        party.body.broken.add("box")
        party.body.gate("box").set()
        await party.state("held")
        assert await party.body.stands_still()
        party.body.broken.clear()
        party.body.far.clear()
        party.correct(look("lid"))
        await party.until(lambda: party.steps() == ["finished"] * 3)
        assert sorted(party.body.did[:4]) == ["drive 1", "drive 1", "look box", "look lid"]
        assert party.body.did[-1] == "look door"
        assert len(party.body.did) == 5


async def test_repair_in_several_steps_runs_the_last_beside_what_was_stopped() -> None:
    async with crew("A") as party:
        party.body.failures["drive 1"] = 1
        party.body.gate("box")
        party.order(beside_first := look("box"), beside(drive(1), 0), look("door"))
        assert beside_first.flow is None
        await party.state("held")
        party.body.gate("box").set()
        party.correct(find("box"), drive())
        await party.state("idle")
        assert party.body.did.count("find box") == 1
        assert party.body.did.index("find box") < party.body.did.index("drive 3")
        assert party.body.did[-1] == "look door"


async def test_trying_a_condition_again_decides_what_depends_on_it() -> None:
    async with crew("A") as party:
        party.body.there = {"box"}
        party.body.failures["check box"] = 1
        party.order(*BRANCHES)
        await party.state("held")
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["check box", "check box", "look lid", "look label", "look door"]


async def test_leaving_a_condition_out_leaves_out_what_depends_on_it() -> None:
    async with crew("A") as party:
        party.body.failures["check box"] = 1
        party.order(*BRANCHES)
        await party.state("held")
        party.command("skip")
        await party.state("idle")
        assert party.body.did == ["check box", "look door"]


async def test_skipping_one_of_two_lets_the_other_end_before_what_follows() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.body.gate("box")
        party.order(drive(1), beside(look("box"), 0), look("door"))
        await party.until(lambda: party.steps() == ["running", "running", "queued"])
        party.command("skip")
        await party.until(lambda: party.steps() == ["skipped", "running", "queued"])
        party.body.gate("box").set()
        await party.until(lambda: party.steps() == ["skipped", "finished", "finished"])


async def test_second_of_two_running_steps_can_be_dropped() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.body.gate("box")
        party.order(look("box"), beside(drive(1), 0), look("door"))
        await party.until(lambda: party.steps() == ["running", "running", "queued"])
        party.command("pop", parameters=1)
        await party.until(lambda: party.steps() == ["running", "skipped", "queued"])
        assert await party.body.stands_still()
        party.body.gate("box").set()
        await party.until(lambda: party.steps() == ["finished", "skipped", "finished"])


async def test_dropping_a_condition_drops_what_depends_on_it() -> None:
    async with crew("A") as party:
        party.order(ask("ready"), *[_later(call) for call in BRANCHES])
        await party.until(lambda: party.steps()[:1] == ["waiting"])
        party.command("pop", parameters=1)
        await party.until(lambda: party.steps() == ["waiting", "queued"])
        party.body.gate("ready").set()
        await party.state("idle")
        assert party.body.did == ["ask ready", "look door"]


def _later(call: ActionCall) -> ActionCall:
    if call.flow is None or call.flow.if_ is None:
        return call
    return when(call, call.flow.if_.step + 1, call.flow.if_.result)


async def test_pause_and_going_on_keep_branches_and_joins() -> None:
    async with crew("A") as party:
        party.body.there = {"box"}
        party.body.far.add(1)
        party.body.gate("lid")
        party.order(check("box"), when(drive(1), 0), beside(when(look("lid"), 0), 1), look("door"))
        await party.until(lambda: party.steps() == ["finished", "running", "running", "queued"])
        party.command("stop")
        await party.until(lambda: party.observer.state("A") == "paused")
        assert await party.body.stands_still()
        party.order(look("floor"))
        await party.until(lambda: len(party.steps()) == 5)
        party.body.gate("lid").set()
        party.body.far.clear()
        party.command("start")
        await party.state("idle")
        assert party.steps() == ["finished"] * 5
        assert party.body.did[-2:] == ["look door", "look floor"]
        assert len(party.body.did) == 5


async def test_orders_with_conditions_are_added_to_a_running_plan() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"))
        await party.doing("look box")
        party.order(*BRANCHES)
        await party.until(lambda: len(party.steps()) == 6)
        party.body.gate("box").set()
        await party.state("idle")
        assert party.body.did == ["look box", "check box", "look floor", "look door"]
        shown = [step.action.flow for step in party.observer.plans["A"].steps]
        assert [flow.if_.step if flow and flow.if_ else None for flow in shown] == [None, None, 1, 1, 1, None]


async def test_approved_plan_runs_with_its_conditions() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.body.there = {"box"}
        party.order(*BRANCHES)
        await party.state("awaiting_approval")
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.until(lambda: party.body.did[-1:] == ["look door"])
        assert party.body.did == ["check box", "look lid", "look label", "look door"]


async def test_robot_that_comes_back_goes_on_with_the_branch_it_was_in() -> None:
    async with crew("A") as party:
        party.body.there = {"box"}
        party.body.far.add(1)
        party.order(check("box"), when(drive(1), 0), when(look("floor"), 0, False), look("door"))
        await party.until(lambda: party.steps() == ["finished", "running", "skipped", "queued"])
        await party.lose("A")
        await party.engine("A")
        await party.hears("My plan was interrupted")
        party.body.far.clear()
        party.command("start")
        await party.until(lambda: party.body.did[-1:] == ["look door"])
        assert party.body.did == ["check box", "drive 1", "drive 1", "look door"]


IMPOSSIBLE: list[tuple[str, list[ActionCall], str, str]] = [
    ("unknown step", [when(look("box"), 7)], "queue[0].flow.if.step", "unknown_step"),
    ("negative step", [look("box"), when(look("lid"), -1)], "queue[1].flow.if.step", "unknown_step"),
    ("itself", [when(look("box"), 0)], "queue[0].flow.if.step", "forward_step"),
    ("later step", [when(look("box"), 1), check("box")], "queue[0].flow.if.step", "forward_step"),
    (
        "circle", [beside(look("box"), 1), beside(look("lid"), 0)],
        "queue[0].flow.together_with", "forward_step",
    ),
    (
        "waits for what runs beside it",
        [
            check("box"),
            look("lid").model_copy(update={"flow": Flow(if_=FlowIf(step=0), together_with=0)}),
        ],
        "queue[1].flow.if.step", "impossible_flow",
    ),
    (
        "repeated beside another",
        [look("box"), look("lid").model_copy(update={"flow": Flow(together_with=0, repeat=2)})],
        "queue[1].flow.repeat", "impossible_flow",
    ),
    (
        "two ways to go at once", [drive(1), beside(drive(2), 0)],
        "queue[1].flow.together_with", "impossible_flow",
    ),
    (
        "value that one way does not bring",
        [check("box"), when(find("box"), 0), when(look("lid"), 0, False), drive()],
        "queue[3].input_parameters.x", "missing_input",
    ),
]  # fmt: skip


@pytest.mark.parametrize(
    ("order", "path", "code"), [case[1:] for case in IMPOSSIBLE], ids=[c[0] for c in IMPOSSIBLE]
)
async def test_impossible_flow_is_refused_with_place_and_remedy(
    order: list[ActionCall], path: str, code: str
) -> None:
    async with crew("A") as party:
        party.order(*order)
        await party.hears("cannot carry out")
        problem = party.observer.refusals[-1].problems[0]
        assert (problem.path, problem.code) == (path, code)
        assert problem.remedy
        assert party.wire.commands() == []


async def test_all_problems_of_a_flow_are_told_at_once() -> None:
    async with crew("A") as party:
        party.order(when(look("box"), 9), beside(look("lid"), 5), look("door"))
        await party.until(lambda: party.observer.refusals)
        assert len(party.observer.refusals[-1].problems) == 2


async def test_condition_on_a_repeated_step_asks_for_its_last_run() -> None:
    async with crew("A") as party:
        twice = check("box").model_copy(update={"flow": Flow(repeat=2)})
        party.order(twice, when(look("lid"), 0), when(look("floor"), 0, False))
        await party.until(lambda: party.body.did == ["check box"] * 2 + ["look floor"])
        await party.until(lambda: party.steps() == ["finished", "finished", "skipped", "finished"])


# -- an engine that only sends feedback ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("there", "did", "ends"),
    [
        ({"box"}, ["look lid", "look label"], ["finished", "finished", "finished", "skipped", "finished"]),
        (set(), ["look floor"], ["finished", "skipped", "skipped", "finished", "finished"]),
    ],
    ids=["holds", "fails"],
)
async def test_conditions_hold_for_an_engine_that_does_not_say_how_steps_ended(
    there: set[str], did: list[str], ends: list[str]
) -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body(there=there)
        async with ThesisEngine(party.transport, "Z", body):
            party.order(*BRANCHES, target="Z")
            await party.until(lambda: party.steps("Z") == ends)
            assert body.did == ["check box", *did, "look door"]
            assert party.texts() == []


async def test_last_condition_that_fails_ends_the_plan_of_such_an_engine() -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body()
        async with ThesisEngine(party.transport, "Z", body):
            party.order(check("box"), when(look("lid"), 0), target="Z")
            await party.until(lambda: party.steps("Z") == ["finished", "skipped"])
            await party.state("idle", "Z")


async def test_such_an_engine_runs_steps_at_the_same_time() -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body()
        body.gate("box")
        async with ThesisEngine(party.transport, "Z", body):
            party.order(look("box"), beside(look("lid"), 0), look("door"), target="Z")
            await party.until(lambda: party.steps("Z") == ["running", "finished", "queued"])
            body.gate("box").set()
            await party.until(lambda: party.steps("Z") == ["finished"] * 3)
            assert sorted(body.did[:2]) == ["look box", "look lid"]


@pytest.mark.parametrize("command", ["skip", "pop"])
async def test_one_of_several_steps_cannot_be_left_out_there_and_that_is_said(command: str) -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body()
        body.gate("box")
        body.gate("lid")
        async with ThesisEngine(party.transport, "Z", body):
            party.order(look("box"), beside(look("lid"), 0), look("door"), target="Z")
            await party.until(lambda: party.steps("Z") == ["running", "running", "queued"])
            party.command(command, "Z", parameters=1)
            await party.hears("I can only stop all that I am doing at the same time")
            body.gate("lid").set()
            body.gate("box").set()
            await party.until(lambda: party.steps("Z") == ["finished"] * 3)
            assert sorted(body.did) == ["look box", "look door", "look lid"], "nothing was done twice"


async def test_step_that_somebody_else_ended_is_shown_as_stopped_and_what_asks_for_it_is_left_out() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.order(drive(1), when(look("lid"), 0), look("door"))
        await party.doing("drive 1")
        graph = party.observer.plans["A"].graph_name
        end = StepCommand(target="A", graph_name=graph, node="Drive_0")
        party.observer.publish(topics.STEP, end)
        await party.until(lambda: party.steps() == ["stopped", "skipped", "finished"])
        shown = [update["steps"][0]["state"] for update in party.wire.objects(topics.PLAN) if update["steps"]]
        assert "finished" not in shown
        assert party.body.did == ["drive 1", "look door"]


async def test_what_ran_beside_a_step_that_somebody_else_ended_still_hands_on_what_it_gave() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"), beside(find("lid"), 0), drive(), look("door"))
        await party.until(lambda: party.steps()[:2] == ["running", "finished"])
        graph = party.observer.plans["A"].graph_name
        party.observer.publish(topics.STEP, StepCommand(target="A", graph_name=graph, node="Look_0"))
        await party.state("idle")
        assert party.steps() == ["stopped", "finished", "finished", "finished"]
        assert party.body.did[-2:] == ["drive 3", "look door"]
