"""The planner with real engines: the test plays chat interface, error handler and the person who approves."""

from __future__ import annotations

import json
from typing import Any

import pytest

from parley.agents.planner.sending import Patience
from parley.errors import FailureCode
from parley.messages import ros, topics
from parley.messages.chat import ActionCall, ChatAction, Flow, SystemCommand
from parley.messages.principal import person
from parley.messages.pvf import Parameter
from parley.messages.ros import String
from parley.messages.status import ActorStatus, Rejection, RejectionProblem, StopCommand
from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import Graph, GraphState, LogMessage, Node, NodeState
from tests.agents.crew import (
    ENGINE,
    Body,
    Crew,
    ThesisEngine,
    ask,
    crew,
    decide,
    drive,
    find,
    look,
    proposals,
)


def feedback(party: Crew, graph: Graph, actor: str = "A") -> None:
    message = ros.UmrfGraphFeedback(actor=actor, history=(write_graph(graph),))
    party.transport.publisher(topics.GRAPH_FEEDBACK).publish(message)


# -- orders --------------------------------------------------------------------------------------------


async def test_first_order_starts_a_graph_and_every_step_runs_once() -> None:
    async with crew("A") as party:
        party.order(find("box"), drive(), look("box"))
        await party.until(lambda: party.steps() == ["finished"] * 3)
        assert party.body.did == ["find box", "drive 3", "look box"]
        assert party.wire.commands() == ["start"]
        assert party.observer.state("A") == "idle"


async def test_step_that_waits_for_a_person_is_shown_as_waiting() -> None:
    async with crew("A") as party:
        party.order(ask("ready"))
        await party.until(lambda: party.steps() == ["waiting"])
        party.body.gate("ready").set()
        await party.state("idle")


@pytest.mark.spec("P19")
async def test_graph_names_are_never_used_twice() -> None:
    async with crew("A", "B") as party:
        for count in range(1, 4):
            for name in ("A", "B"):
                party.order(look("box"), target=name)
                await party.until(lambda n=name, c=count: len(party.bodies[n].did) == c)  # type: ignore[misc]
                await party.state("idle", name)
        names = [read_graph(start.umrf_graph_json).name for start in party.wire.of(topics.GRAPH_START)]
        assert len(names) == len(set(names)) == 6


@pytest.mark.spec("P3")
async def test_order_while_one_runs_is_appended_and_disturbs_nothing() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"))
        await party.doing("look box")
        party.order(look("door"))
        await party.until(lambda: "modify" in party.wire.commands())
        assert party.wire.continued_from() == ""
        party.body.gate("box").set()
        await party.until(lambda: party.steps() == ["finished"] * 2)
        assert party.body.did == ["look box", "look door"]


async def test_orders_that_race_with_the_end_of_the_plan_all_run_once_and_in_order() -> None:
    async with crew("A") as party:
        wanted = [f"look {number}" for number in range(30)]
        for number in range(30):
            party.order(look(str(number)))
            if number % 3 == 0:
                await party.until(lambda n=number: f"look {n}" in party.body.did)  # type: ignore[misc]
        await party.until(lambda: len(party.body.did) == 30)
        assert party.body.did == wanted
        await party.state("idle")


@pytest.mark.spec("P13")
async def test_two_robots_have_plans_of_their_own() -> None:
    async with crew("A", "B") as party:
        party.bodies["A"].gate("box")
        party.order(look("box"), target="A")
        party.order(look("door"), target="B")
        await party.state("idle", "B")
        assert party.bodies["B"].did == ["look door"]
        await party.state("running", "A")
        party.command("clear", "B")
        await party.settled()
        assert party.observer.state("A") == "running"


async def test_order_for_several_robots_runs_on_each() -> None:
    async with crew("A", "B") as party:
        order = ChatAction(queue=(look("box"),), targets=("A", "b"), by=ENGINE)
        party.observer.publish(topics.CHAT_ACTION, order)
        await party.until(lambda: party.bodies["A"].did == party.bodies["B"].did == ["look box"])


async def test_robot_is_found_whatever_the_capitals() -> None:
    async with crew("A") as party:
        party.order(look("box"), target=" a ")
        await party.until(lambda: party.body.did == ["look box"])


async def test_unknown_robot_moves_nobody_and_is_told() -> None:
    async with crew("A") as party:
        party.order(look("box"), target="Z")
        await party.hears("There is no robot called Z. I know A.")
        assert party.observer.refusals[-1].problems[0].code == "unknown_robot"
        assert party.wire.commands() == []


def repeated(call: ActionCall, times: int) -> ActionCall:
    return call.model_copy(update={"flow": Flow(repeat=times)})


async def test_step_that_is_to_be_repeated_runs_so_often_and_what_follows_once() -> None:
    async with crew("A") as party:
        party.order(repeated(look("box"), 3), look("door"))
        await party.until(lambda: party.steps() == ["finished"] * 4)
        assert party.body.did == ["look box", "look box", "look box", "look door"]


async def test_one_repetition_can_be_dropped() -> None:
    async with crew("A") as party:
        party.order(ask("ready"), repeated(look("box"), 3))
        await party.until(lambda: party.steps() == ["waiting", "queued", "queued", "queued"])
        party.command("pop", parameters=2)
        await party.until(lambda: party.steps() == ["waiting", "queued", "queued"])
        party.body.gate("ready").set()
        await party.state("idle")
        assert party.body.did.count("look box") == 2


async def test_more_repetitions_than_a_person_can_follow_are_refused() -> None:
    async with crew("A") as party:
        party.order(repeated(look("box"), 1000))
        await party.until(lambda: party.observer.refusals)
        assert party.observer.refusals[-1].problems[0].code == "too_long"
        assert party.wire.commands() == []


async def test_order_without_a_robot_moves_nobody() -> None:
    async with crew("A") as party:
        party.observer.publish(topics.CHAT_ACTION, ChatAction(queue=(look("box"),)))
        await party.until(lambda: party.observer.refusals)
        assert party.observer.refusals[-1].problems[0].code == "no_robot"
        assert party.wire.commands() == []


@pytest.mark.parametrize(
    "call",
    [
        ActionCall(name="Fly"),
        ActionCall(name="Look"),
        ActionCall(name="Look", input_parameters={"what": Parameter("number", 3.0)}),
        drive(),
    ],
    ids=["unknown action", "missing value", "wrong type", "nobody gives the value"],
)
async def test_order_that_the_robot_cannot_carry_out_is_refused_whole(call: ActionCall) -> None:
    async with crew("A") as party:
        party.order(look("box"), call)
        await party.hears("cannot carry out")
        assert party.wire.commands() == []
        assert party.body.did == []


async def test_stop_is_carried_out_even_if_it_comes_with_an_impossible_order() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.order(drive(1))
        await party.doing("drive 1")
        party.order(ActionCall(name="Fly"), commands=[SystemCommand(command="stop")])
        await party.state("paused")
        assert await party.body.stands_still()


# -- dropping steps ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "pop",
    ['{"pop": {"parameters": 1}}', '{"pop": {"parameters": "1"}}', '{"pop": 1}', '{"pop": {"index": 1.0}}'],
)
async def test_pop_drops_the_step_in_every_spelling(pop: str) -> None:
    async with crew("A") as party:
        party.body.gate("1")
        party.order(look("1"), look("2"), look("3"))
        await party.doing("look 1")
        by = '"by": {"kind": "engine"}'
        text = f'{{"message_response": "", "queue": [], "system_cmd": [{pop}], "targets": ["A"], {by}}}'
        party.transport.publisher(topics.CHAT_ACTION).publish(String(text))
        await party.until(lambda: len(party.steps()) == 2)
        party.body.gate("1").set()
        await party.state("idle")
        assert party.body.did == ["look 1", "look 3"]


async def test_several_pops_of_one_message_count_the_steps_as_they_were() -> None:
    async with crew("A") as party:
        party.body.gate("1")
        party.order(look("1"), look("2"), look("3"), look("4"))
        await party.doing("look 1")
        pops = [SystemCommand(command="pop", arguments={"parameters": index}) for index in (1, 2)]
        party.order(commands=pops)
        await party.until(lambda: len(party.steps()) == 2)
        party.body.gate("1").set()
        await party.state("idle")
        assert party.body.did == ["look 1", "look 4"]


@pytest.mark.parametrize("arguments", [{}, {"parameters": 7}, {"parameters": "two"}, {"parameters": -1}])
@pytest.mark.spec("P15")
async def test_impossible_pop_changes_nothing_and_is_told(arguments: dict[str, Any]) -> None:
    async with crew("A") as party:
        party.body.gate("1")
        party.order(look("1"), look("2"))
        await party.doing("look 1")
        party.command("pop", **arguments)
        await party.hears("There is no s")
        assert len(party.steps()) == 2
        assert party.wire.commands() == ["start"]


async def test_skipping_the_last_step_says_that_nothing_is_left() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.order(drive(1))
        await party.doing("drive 1")
        party.command("skip")
        await party.hears("Nothing else is left to do.")
        await party.state("idle")
        assert party.steps() == ["skipped"]


# -- failures ------------------------------------------------------------------------------------------


@pytest.mark.spec("P16")
async def test_failure_is_reported_with_all_keys_of_the_thesis() -> None:
    async with crew("A") as party:
        party.body.failures["drive 3"] = 1
        party.order(find("box"), drive(), look("box"), look("door"))
        await party.state("held")
        (message,) = party.wire.objects(topics.ERROR_HANDLING)
        thesis = {"error_message", "action_called", "umrf_queue", "target"}
        thesis |= {"process_instrutions", "process_data_text", "process_data_images"}
        assert thesis <= set(message)
        assert message["error_message"] == "I cannot drive 3."
        assert list(message["action_called"]) == ["Drive"]
        assert [list(call) for call in message["umrf_queue"]] == [["Look"], ["Look"]]
        assert message["target"] == "A"
        assert (message["code"], message["details"]) == ("blocked", {"by": "a box"})
        assert [list(call) for call in message["completed"]] == [["Find"]]
        assert party.body.did == ["find box", "drive 3"]


async def test_correction_takes_the_failed_steps_place_and_the_rest_follows() -> None:
    async with crew("A") as party:
        party.body.failures["find box"] = 1
        party.order(find("box"), drive(), look("door"))
        await party.state("held")
        party.correct(find("red box"))
        await party.state("idle")
        assert party.body.did == ["find box", "find red box", "drive 7", "look door"]


async def test_corrected_step_gets_the_values_of_the_step_before_the_failed_one() -> None:
    async with crew("A") as party:
        party.body.failures["drive 3"] = 1
        party.order(find("box"), drive())
        await party.state("held")
        party.correct(drive())
        await party.state("idle")
        assert party.body.did == ["find box", "drive 3", "drive 3"]


async def test_empty_correction_leaves_the_failed_step_out() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        party.correct()
        await party.state("idle")
        assert party.body.did == ["look box", "look door"]


@pytest.mark.spec("P14")
async def test_orders_during_a_repair_run_after_it() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        party.order(look("lid"))
        await party.settled()
        assert party.body.did == ["look box"]
        party.correct(look("big box"))
        await party.state("idle")
        assert party.body.did == ["look box", "look big box", "look door", "look lid"]


async def test_correction_that_cannot_be_carried_out_holds_the_robot_and_says_what_helps() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        party.correct(ActionCall(name="Fly"))
        await party.hears("try again")
        assert party.observer.state("A") == "held"
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["look box", "look box", "look door"]


async def test_late_correction_of_a_step_that_was_dropped_moves_nobody() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"))
        await party.state("held")
        party.command("clear")
        await party.state("idle")
        party.correct(look("door"))
        await party.settled()
        assert party.body.did == ["look box"]


async def test_correction_given_while_paused_waits_for_going_on() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.body.far.add(1)
        party.order(look("box"), drive(1))
        await party.doing("look box")
        party.command("stop")
        await party.state("paused")
        party.order(look("door"))
        await party.hears("Say “carry on”")
        party.body.gate("box").set()
        await party.settled()
        assert party.body.did == ["look box"]
        party.body.far.clear()
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["look box", "drive 1", "look door"]


# -- memory --------------------------------------------------------------------------------------------


async def test_memories_are_handed_on_to_whoever_remembers() -> None:
    async with crew("A") as party:
        party.command("add_memory", name="key", data="the key is red", info="key")
        party.command("remove_memory", name="lamp")
        await party.until(lambda: party.wire.of(topics.REMOVE_MEMORY))
        (added,) = party.wire.objects(topics.ADD_TO_MEMORY)
        assert added["key"]["data"] == "the key is red"
        assert (added["key"]["info"], added["key"]["type"]) == ("key", "text")
        assert list(party.wire.objects(topics.REMOVE_MEMORY)[0]) == ["lamp"]


async def test_memory_without_a_name_gets_one_of_its_own() -> None:
    async with crew("A") as party:
        for text in ("one", "two"):
            party.command("add_memory", data=text, info=text)
        await party.until(lambda: len(party.wire.of(topics.ADD_TO_MEMORY)) == 2)
        first, second = (next(iter(added)) for added in party.wire.objects(topics.ADD_TO_MEMORY))
        assert first != second


async def test_memory_without_content_is_refused() -> None:
    async with crew("A") as party:
        party.command("add_memory", name="key")
        await party.until(lambda: party.observer.refusals)
        assert party.wire.of(topics.ADD_TO_MEMORY) == []


# -- approval ------------------------------------------------------------------------------------------


async def test_where_approval_is_wanted_nothing_runs_before_it() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.order(look("box"))
        await party.until(lambda: proposals(party))
        await party.state("awaiting_approval")
        assert (party.body.did, party.wire.commands()) == ([], [])
        (proposal,) = proposals(party)
        assert [list(call) for call in proposal["steps"]] == [["Look"]]
        decide(party, id=proposal["id"], decision="approve")
        await party.state("idle")
        assert party.body.did == ["look box"]


async def test_rejected_plan_is_forgotten() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.order(look("box"))
        await party.until(lambda: proposals(party))
        decide(party, id=proposals(party)[0]["id"], decision="reject")
        await party.state("idle")
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.hears("no longer waiting")
        assert party.wire.commands() == []


async def test_edited_plan_runs_as_edited() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.order(look("box"))
        await party.until(lambda: proposals(party))
        decide(party, id=proposals(party)[0]["id"], decision="edit", steps=[look("door").model_dump()])
        await party.until(lambda: party.body.did == ["look door"])


async def test_impossible_edit_leaves_the_plan_waiting() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.order(look("box"))
        await party.until(lambda: proposals(party))
        identity = proposals(party)[0]["id"]
        decide(party, id=identity, decision="edit", steps=[{"Fly": {}}])
        await party.hears("I cannot do step 1, “Fly”")
        decide(party, id=identity, decision="approve")
        await party.until(lambda: party.body.did == ["look box"])


async def test_going_ahead_asks_again_and_dropping_rejects() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.order(look("box"))
        await party.state("awaiting_approval")
        party.command("start")
        await party.hears("Look: what “box”. Shall I?")
        assert party.body.did == []
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.until(lambda: party.body.did == ["look box"])
        party.order(look("door"))
        await party.state("awaiting_approval")
        party.command("clear")
        await party.state("idle")
        decide(party, id=proposals(party)[1]["id"], decision="approve")
        await party.hears("no longer waiting")
        assert party.body.did == ["look box"]


async def test_policy_is_switched_on_and_off_and_an_empty_one_switches_nothing() -> None:
    async with crew("A") as party:
        decide(party, target="a", decision="policy", policy="ask_first")
        decide(party, decision="policy")
        await party.settled()
        party.order(look("box"))
        await party.until(lambda: proposals(party))
        assert party.wire.commands() == []
        decide(party, id=proposals(party)[0]["id"], decision="reject")
        decide(party, decision="policy", policy="run_at_once")
        await party.settled()
        party.order(look("door"))
        await party.until(lambda: party.body.did == ["look door"])


# -- refusals and silence ------------------------------------------------------------------------------


@pytest.mark.spec("P2")
async def test_start_that_an_engine_refuses_is_told_and_nothing_counts_as_running() -> None:
    async with crew(heartless=["Z"], patience=Patience(answer_s=60)) as party:
        party.order(look("box"), target="Z")
        await party.until(lambda: party.wire.of(topics.GRAPH_START))
        name = read_graph(party.wire.of(topics.GRAPH_START)[0].umrf_graph_json).name
        refusal = Rejection(
            source="engine", target="Z", what="umrf_graph_start", graph_name=name,
            problems=(RejectionProblem(message="no such action", code="unknown_action"),),
        )  # fmt: skip
        party.observer.publish(topics.REJECTION, refusal)
        await party.hears("I could not do that")
        assert (party.observer.state("Z"), party.steps("Z")) == ("idle", ["stopped"])


async def test_order_during_an_emergency_stop_waits_for_release_and_going_on() -> None:
    async with crew("A") as party:
        party.observer.publish(topics.STOP, StopCommand())
        await party.until(lambda: any(r.state == "received" for r in party.observer.stop_reports))
        party.order(look("box"))
        await party.hears("Release the stop first")
        await party.state("paused")
        party.observer.publish(topics.STOP, StopCommand(command="reset", by=person("Kim")))
        await party.until(lambda: any(r.state == "reset" for r in party.observer.stop_reports))
        await party.settled()
        assert party.body.did == []
        party.command("start")
        await party.until(lambda: party.body.did == ["look box"])


async def test_repair_during_an_emergency_stop_goes_on_after_release() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        party.observer.publish(topics.STOP, StopCommand())
        await party.until(lambda: any(r.state == "received" for r in party.observer.stop_reports))
        party.correct(look("lid"))
        await party.hears("Release the stop first")
        party.observer.publish(topics.STOP, StopCommand(command="reset", by=person("Kim")))
        await party.until(lambda: any(r.state == "reset" for r in party.observer.stop_reports))
        await party.settled()
        assert party.body.did == ["look box"]
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["look box", "look lid", "look door"]


async def test_robot_that_never_answers_is_told_and_asked_again_by_going_on() -> None:
    async with crew(heartless=["Z"], patience=Patience(answer_s=0.05)) as party:
        party.order(look("box"), target="Z")
        await party.hears("Z does not answer. The plan is kept")
        await party.state("paused", "Z")
        party.command("start", "Z")
        await party.until(lambda: len(party.wire.of(topics.GRAPH_START)) == 2)


async def test_graph_that_comes_to_life_after_nobody_answered_is_stopped() -> None:
    async with crew(heartless=["Z"], patience=Patience(answer_s=0.05)) as party:
        party.order(look("box"), target="Z")
        await party.hears("Z does not answer")
        graph = read_graph(party.wire.of(topics.GRAPH_START)[0].umrf_graph_json)
        feedback(party, Graph(graph.name, graph.nodes, state=GraphState.RUNNING), "Z")
        await party.until(lambda: party.wire.of(topics.GRAPH_STOP))
        assert party.wire.of(topics.GRAPH_STOP)[0].umrf_graph_name == graph.name


@pytest.mark.spec("P4")
async def test_late_feedback_and_events_of_a_dropped_graph_change_nothing() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"))
        await party.doing("look box")
        old = party.observer.plans["A"].graph_name
        party.command("clear")
        party.body.gate("box").set()
        await party.state("idle")
        party.body.gate("door")
        party.order(look("door"))
        await party.doing("look door")
        failed = Node("Look", 0, state=NodeState.ERROR, messages=(LogMessage(1, "late"),))
        feedback(party, Graph(old, (failed,), state=GraphState.STOPPED))
        await party.settled()
        assert party.observer.state("A") == "running"
        assert party.wire.of(topics.ERROR_HANDLING) == []


@pytest.mark.parametrize("text", ["", "{", "[]", json.dumps({"graph_name": 3})])
async def test_feedback_that_cannot_be_read_is_refused_and_the_next_counts(text: str) -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"))
        await party.doing("look box")
        message = ros.UmrfGraphFeedback(actor="A", history=(text,))
        party.transport.publisher(topics.GRAPH_FEEDBACK).publish(message)
        await party.until(lambda: party.observer.refusals)
        party.body.gate("box").set()
        await party.state("idle")


async def test_robot_that_is_lost_is_told_and_its_plan_goes_on_when_it_is_back() -> None:
    async with crew("A") as party:
        party.body.far.add(3)
        party.order(find("box"), drive(), look("door"))
        await party.until(lambda: party.steps() == ["finished", "running", "queued"])
        await party.lose("A")
        await party.hears("I have lost contact with A. Its plan is kept.")
        await party.engine("A")
        await party.hears("My plan was interrupted. It is kept")
        await party.settled()
        assert party.body.did == ["find box", "drive 3"]
        party.body.far.clear()
        party.command("start")
        await party.until(lambda: "look door" in party.body.did)
        assert party.body.did == ["find box", "drive 3", "drive 3", "look door"]


async def test_robot_that_is_heard_again_just_goes_on() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"), look("door"))
        await party.doing("look box")
        party.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", state="leaving"))
        await party.hears("I have lost contact with A")
        await party.settled()
        party.body.gate("box").set()
        await party.state("idle")
        assert party.body.did == ["look box", "look door"]


@pytest.mark.parametrize("command", ["start", "order"])
async def test_graph_that_an_engine_lost_unnoticed_is_started_again_only_by_going_on(command: str) -> None:
    async with crew("A", heartless=["A"]) as party:
        party.body.gate("box")
        party.order(look("box"))
        await party.doing("look box")
        graph = party.observer.plans["A"].graph_name
        what = "umrf_graph_resume" if command == "start" else "umrf_graph_modify"
        refusal = Rejection(
            source="engine", target="A", what=what, graph_name=graph,
            problems=(RejectionProblem(message="unknown", code="unknown_graph"),),
        )  # fmt: skip
        party.observer.publish(topics.REJECTION, refusal)
        if command == "order":
            await party.hears("My plan was interrupted")
            await party.state("paused")
        else:
            await party.until(lambda: len(party.wire.of(topics.GRAPH_START)) == 2)


async def test_robot_that_goes_in_good_order_ends_its_plan_and_says_so() -> None:
    async with crew("A") as party:
        party.body.gate("box")
        party.order(look("box"), look("door"))
        await party.doing("look box")
        await party.dismiss("A")
        await party.hears("The plan was stopped.")
        assert party.observer.state("A") == "idle"


async def test_stop_reaches_a_robot_that_is_out_of_hearing() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.order(drive(1))
        await party.doing("drive 1")
        party.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", state="leaving"))
        party.command("clear")
        await party.state("idle")
        await party.settled()
        assert await party.body.stands_still()


# -- an engine that only sends feedback ----------------------------------------------------------------


def full() -> list[ActionCall]:
    """Finding and driving, spelt out as an engine needs it that does not say what its actions take."""
    blank = {"x": Parameter("number")}
    return [
        find("box").model_copy(update={"output_parameters": blank}),
        drive().model_copy(update={"input_parameters": blank}),
    ]


@pytest.mark.spec("P6", "P9")
async def test_engine_without_heartbeat_is_driven_by_its_feedback_alone() -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body()
        async with ThesisEngine(party.transport, "Z", body):
            party.order(*full(), look("box"), target="Z")
            await party.until(lambda: party.steps("Z") == ["finished"] * 3)
            assert body.did == ["find box", "drive 3", "look box"]


@pytest.mark.spec("P1", "W1")
async def test_engine_without_heartbeat_is_paused_on_both_spellings_and_goes_on() -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body(far={1})
        async with ThesisEngine(party.transport, "Z", body):
            party.order(drive(1), target="Z")
            await party.until(lambda: body.way > 0)
            party.command("stop", "Z")
            await party.until(lambda: party.wire.of(topics.GRAPH_PAUSE_TEMOTO))
            assert len(party.wire.of(topics.GRAPH_PAUSE)) == 1
            await party.state("paused", "Z")
            assert await body.stands_still()
            body.far.clear()
            party.command("start", "Z")
            await party.until(lambda: party.steps("Z") == ["finished"])


async def test_engine_of_ours_is_paused_on_the_right_spelling_only() -> None:
    async with crew("A") as party:
        party.body.far.add(1)
        party.order(drive(1))
        await party.doing("drive 1")
        party.command("stop")
        await party.state("paused")
        assert party.wire.of(topics.GRAPH_PAUSE_TEMOTO) == []


async def test_engine_that_does_not_say_that_an_error_halted_its_graph_is_told_where_to_go_on() -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body()
        body.failures["look box"] = 1
        async with ThesisEngine(party.transport, "Z", body):
            party.order(look("box"), look("door"), target="Z")
            await party.state("held", "Z")
            party.correct(look("lid"), target="Z")
            await party.until(lambda: body.did == ["look box", "look lid", "look door"])
            assert party.wire.continued_from() == "Look_2"


async def test_engine_that_cannot_end_a_step_is_stopped_and_started_with_the_rest() -> None:
    async with crew(heartless=["Z"]) as party:
        body = Body(far={1})
        async with ThesisEngine(party.transport, "Z", body):
            party.order(drive(1), look("door"), target="Z")
            await party.until(lambda: body.way > 0)
            party.command("skip", "Z")
            await party.until(lambda: body.did == ["drive 1", "look door"])
            assert party.wire.commands() == ["start", "stop", "start"]


async def test_failure_code_survives_the_way_through_the_engines_log() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"))
        await party.until(lambda: party.observer.failures)
        assert party.observer.failures[0].code is FailureCode.BLOCKED
