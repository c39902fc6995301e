"""Graphs of several actors: started together, results handed over, commands and stops that reach all (13)."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from parley.messages import ros, topics
from parley.messages.failure import FailureReport
from parley.messages.status import StepCommand, SyncEntry, SyncNotice
from parley.messages.wire import decode, to_string
from parley.umrf.action import ActionSpec, RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph
from tests.umrf.inner_graphs import ref
from tests.umrf.spec_actions import SPECS, chain, node, planner_chain

from .rig import DummyRobot, Rig, engine_of, rigged

BOTH = ("A", "B")
QUICK: dict[str, Any] = {"heartbeat_s": 0.02, "peer_timeout_s": 0.3}


@asynccontextmanager
async def crew(**options: Any) -> AsyncIterator[Rig]:
    """Engines for A and B on one transport."""
    async with rigged(**QUICK, **options) as rig, engine_of("B", rig, **QUICK, **options):
        yield rig


def of(actor: str, item: dict[str, Any]) -> dict[str, Any]:
    return item | {"actor": actor}


def relay() -> dict[str, Any]:
    """A says something, B checks it, then both do something of their own, then A."""
    return chain(
        "g",
        [
            of("A", node("JoinText", 0, left="a", right="b")),
            of("B", node("SameText", 1, expected="a-b")),
            node("NoOp", 2),
            of("A", node("NoOp", 3)),
        ],
    )


async def ended(rig: Rig, name: str, state: str) -> None:
    for actor in BOTH:
        await rig.until_graph(name, state, actor)


# -- handing over -------------------------------------------------------------------------------------------


@pytest.mark.spec("13", "W8")
async def test_values_and_results_are_handed_over_in_both_directions() -> None:
    async with crew() as rig:
        rig.start(relay(), BOTH)
        await ended(rig, "g", "FINISHED")
        for actor in BOTH:
            for index, name in enumerate(("JoinText", "SameText", "NoOp", "NoOp")):
                assert rig.node_states("g", f"{name}_{index}", actor) == ["RUNNING", "FINISHED"]
        results = {
            (item.actor, item.result) for item in rig.events if item.node == "SameText_1" and item.result
        }
        assert results == {("A", "on_true"), ("B", "on_true")}


async def finished(rig: Rig, count: int) -> None:
    await rig.until(lambda: rig.graph_states("g").count("FINISHED") == count)


async def test_a_graph_may_be_run_together_again() -> None:
    async with crew() as rig:
        for index in range(3):
            rig.start(relay(), BOTH)
            await finished(rig, 2 * index + 2)
        assert not rig.rejections


@pytest.mark.spec("13", "10.9")
async def test_a_failure_is_seen_everywhere_with_its_report() -> None:
    async with crew() as rig:
        rig.start(planner_chain("g", [of("B", node("Fail", 0, reason="A box is in the way."))]), BOTH)
        await ended(rig, "g", "HALTED")
        messages = [item.message for item in rig.events if item.state == "ERROR"]
        assert len(messages) == 2
        assert {FailureReport.parse(text).message for text in messages} == {"A box is in the way."}
        assert {FailureReport.parse(text).code for text in messages} == {"blocked"}


@pytest.mark.spec("13", "D25")
async def test_an_end_that_comes_early_is_kept() -> None:
    """D25: on the reference a notification that comes before the node waits is lost."""

    @action(name="Uneven")
    async def slowly(ctx: RunHandle) -> None:
        await asyncio.sleep(0.1)

    quick = ActionSpec("Uneven", {}, {}, run=SPECS[8].run)
    graph = chain("g", [{"name": "Uneven", "type": "sync", "instance_id": 0}, of("B", node("NoOp", 1))])
    async with (
        rigged(catalogue=Catalogue([*SPECS, slowly.spec]), **QUICK) as rig,
        engine_of("B", rig, catalogue=Catalogue([*SPECS, quick]), **QUICK),
    ):
        rig.start(graph, BOTH)
        await rig.until_graph("g", "FINISHED", "B")
        assert rig.node_states("g", "NoOp_1", "A") == []
        await rig.until_graph("g", "FINISHED", "A")


@pytest.mark.spec("13")
async def test_an_end_that_comes_twice_counts_once() -> None:
    async with crew() as rig:
        again = rig.transport.publisher(topics.SYNC)
        sent: set[str] = set()

        def repeat(message: ros.String) -> None:
            if decode(SyncNotice, message.data).said and message.data not in sent:
                sent.add(message.data)
                for _ in range(3):
                    again.publish(message)

        await rig.transport.subscribe(topics.SYNC, repeat)
        count, wait = of("B", node("CountTo", 0, limit=4)), of("A", node("WaitFor", 1, seconds=0.001))
        count |= {
            "children": [ref(wait)],
            "parents": [ref(wait, required=False, conditions=["on_true -> run"])],
        }
        wait |= {
            "children": [ref(count)],
            "parents": [ref(count, conditions=["on_true -> ignore", "on_false -> run"])],
        }
        graph = {
            "graph_name": "g",
            "graph_entry": [ref(count)],
            "graph_exit": [ref(count, conditions=["on_false -> ignore"])],
            "actions": [count, wait],
        }
        rig.start(graph, BOTH)
        await ended(rig, "g", "FINISHED")
        for actor in BOTH:
            assert rig.node_states("g", "CountTo_0", actor).count("RUNNING") == 4
            assert rig.node_states("g", "WaitFor_1", actor).count("RUNNING") == 3


async def test_sub_graphs_may_name_the_actors_too() -> None:
    inner = chain("Inner", [of("B", node("JoinText", 0, left="a", right="b")), of("A", node("NoOp", 1))])
    catalogue = Catalogue(SPECS, [read_graph(inner)])
    async with crew(catalogue=catalogue) as rig:
        rig.start(chain("g", [{"name": "Inner", "instance_id": 0, "type": "sync"}, node("NoOp", 2)]), BOTH)
        await ended(rig, "g", "FINISHED")
        for actor in BOTH:
            assert rig.graph_states("g__Inner__0", actor) == ["RUNNING", "FINISHED"]


# -- starting -----------------------------------------------------------------------------------------------


@pytest.mark.spec("13", "D34")
async def test_a_start_that_others_did_not_get_is_refused_and_says_whose() -> None:
    async with crew() as rig:
        rig.start(relay(), ("A",))
        await rig.until(lambda: rig.rejections)
        [problem] = rig.rejections[0].problems
        assert (rig.rejections[0].target, problem.code) == ("A", "peer_silent")
        assert problem.message == "B is there, but did not take up the graph"
        assert not rig.events, "nothing has run"
        rig.start(relay(), BOTH)
        await ended(rig, "g", "FINISHED")


@pytest.mark.spec("13")
async def test_an_actor_that_is_not_there_is_named() -> None:
    graph = relay()
    graph["actions"][1]["actor"] = "C"
    async with crew() as rig:
        rig.start(graph, BOTH)
        await rig.until(lambda: len(rig.rejections) == 2)
        assert {item.target for item in rig.rejections} == set(BOTH)
        assert {problem.message for item in rig.rejections for problem in item.problems} == {"C is not there"}


@pytest.mark.spec("11.1-better")
async def test_a_shared_graph_that_runs_is_not_disturbed_by_a_second_start() -> None:
    graph = chain("g", [of("B", node("WaitFor", 0, seconds=0.1)), of("A", node("NoOp", 1))])
    async with crew() as rig:
        rig.start(graph, BOTH)
        await ended(rig, "g", "RUNNING")
        rig.start(graph, BOTH)
        await rig.until(lambda: len(rig.rejections) == 2)
        assert {item.problems[0].code for item in rig.rejections} == {"already_running"}
        await ended(rig, "g", "FINISHED")


async def test_a_graph_that_cannot_run_is_refused_without_asking_others() -> None:
    graph = relay()
    graph["actions"][0]["name"] = "Unknown"
    graph["graph_entry"][0]["name"] = "Unknown"
    graph["actions"][1]["parents"][0]["name"] = "Unknown"
    async with crew() as rig:
        rig.start(graph, ("A",))
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "unknown_action"


async def test_a_stop_while_the_others_are_awaited_ends_the_start() -> None:
    async with crew() as rig:
        rig.start(relay(), ("A",))
        await asyncio.sleep(0.05)
        rig.stop("g")
        await rig.until_graph("g", "STOPPED")
        await rig.until(lambda: rig.rejections)
        assert rig.graph_states("g") == ["STOPPING", "STOPPED"]


# -- losing others ------------------------------------------------------------------------------------------


@pytest.mark.spec("13", "D34")
async def test_an_actor_that_leaves_is_a_failure_of_its_node() -> None:
    """D34: on the reference a late peer throws from a thread of the node and ends the process."""
    graph = planner_chain("g", [of("B", node("WaitFor", 0, seconds=60)), of("A", node("NoOp", 1))])
    async with rigged(**QUICK) as rig:
        async with engine_of("B", rig, **QUICK):
            rig.start(graph, BOTH)
            await ended(rig, "g", "RUNNING")
            await rig.until(lambda: rig.node_states("g", "WaitFor_0", "A"))
            # Its last words (its stopped node) must not arrive: it is to be missed.
            await _deafen(rig)
        await rig.until_graph("g", "HALTED", "A")
        [failed] = [item for item in rig.events if item.state == "ERROR"]
        report = FailureReport.parse(failed.message)
        assert (failed.actor, failed.node, report.code) == ("A", "WaitFor_0", "unavailable")
        assert report.message == "WaitFor_0 is for B, which has left."


async def _deafen(rig: Rig) -> None:
    """Take the topic on which engines hand over results away from all of them."""
    for subscription in list(rig.transport._subscriptions["/" + topics.SYNC.name.lstrip("/")]):
        await subscription.close()


@pytest.mark.spec("13")
async def test_an_end_that_nobody_confirms_is_told() -> None:
    graph = planner_chain("g", [of("A", node("NoOp", 0)), of("A", node("WaitFor", 1, seconds=60))])
    graph["actions"][0]["actor"] = "B"
    async with crew() as rig:
        rig.start(graph, BOTH)
        await rig.until(lambda: rig.node_states("g", "WaitFor_1", "A"))
        await _deafen(rig)
        rig.transport.publisher(topics.GRAPH_STOP).publish(ros.UmrfGraphStop("g", BOTH))
        await rig.until(lambda: [item for item in rig.rejections if item.what == "sync"])
        [problem] = [item.problems[0] for item in rig.rejections if item.what == "sync"]
        assert (problem.code, problem.message) == ("peer_lost", "B did not confirm that WaitFor_1 has ended")


# -- commands -----------------------------------------------------------------------------------------------


def working(seconds: float = 60.0) -> dict[str, Any]:
    """A works; B waits for it and has something of its own beside it."""
    graph = planner_chain("g", [of("A", node("WaitFor", 0, seconds=seconds)), of("B", node("NoOp", 1))])
    own = of("B", node("WaitFor", 7, seconds=60))
    graph["actions"].append(own)
    graph["graph_entry"].append(ref(own))
    return graph


async def at_work(rig: Rig) -> None:
    rig.start(working(), BOTH)
    await ended(rig, "g", "RUNNING")
    for actor in BOTH:
        for full_name in ("WaitFor_0", "WaitFor_7"):
            await rig.until_node("g", full_name, ["RUNNING"], actor)


@pytest.mark.spec("13", "11.2", "D34")
async def test_a_stop_given_to_one_reaches_all() -> None:
    async with crew() as rig:
        await at_work(rig)
        rig.stop("g")
        await ended(rig, "g", "STOPPED")
        for actor in BOTH:
            for full_name in ("WaitFor_0", "WaitFor_7"):
                assert rig.node_states("g", full_name, actor) == ["RUNNING", "STOPPING", "FINISHED"]
        assert not rig.rejections


@pytest.mark.spec("13", "11.3", "11.4", "D34")
async def test_pause_and_resume_given_to_one_reach_all() -> None:
    async with crew() as rig:
        await at_work(rig)
        rig.pause("g")
        await ended(rig, "g", "PAUSED")
        rig.resume("g")
        await ended(rig, "g", "RUNNING")
        for actor in BOTH:
            assert rig.node_states("g", "WaitFor_0", actor) == ["RUNNING", "PAUSED", "RUNNING"]


@pytest.mark.spec("13", "11.5")
async def test_a_modify_given_to_one_reaches_all() -> None:
    async with crew() as rig:
        first = of("A", node("WaitFor", 0, seconds=0.3))
        rig.start(planner_chain("g", [first, of("B", node("NoOp", 1))]), BOTH)
        await ended(rig, "g", "RUNNING")
        rig.modify(planner_chain("g", [first, of("B", node("JoinText", 1, left="a", right="b"))]))
        await ended(rig, "g", "HALTED")
        for actor in BOTH:
            assert rig.node_states("g", "JoinText_1", actor) == ["RUNNING", "FINISHED"]
            assert not rig.node_states("g", "NoOp_1", actor)


@pytest.mark.spec("13", "11.5")
async def test_a_modify_that_one_of_them_refuses_changes_nothing_anywhere() -> None:
    poorer = Catalogue([spec for spec in SPECS if spec.name != "JoinText"])
    async with rigged(**QUICK) as rig, engine_of("B", rig, **QUICK, catalogue=poorer):
        first, last = of("A", node("WaitFor", 0, seconds=60)), of("B", node("NoOp", 1))
        rig.start(planner_chain("g", [first, last]), BOTH)
        await ended(rig, "g", "RUNNING")
        everybody = node("JoinText", 2, left="a", right="b")
        rig.modify(planner_chain("g", [first, everybody, last]))
        await rig.until(lambda: rig.rejections)
        (refusal,) = rig.rejections
        assert (refusal.target, refusal.what) == ("A", "umrf_graph_modify")
        assert [item.code for item in refusal.problems] == ["peer_refused"]
        assert "B has no action 'JoinText'" in refusal.problems[0].message
        assert not [item for item in rig.events if item.cause == "modify"]
        rig.modify(planner_chain("g", [first, node("NoOp", 3), last]))
        await rig.until(lambda: {item.actor for item in rig.events if item.cause == "modify"} == {*BOTH})
        rig.stop("g")
        await ended(rig, "g", "STOPPED")


@pytest.mark.spec("13", "11.5")
async def test_a_modify_is_refused_when_one_of_them_is_gone() -> None:
    first, last = of("A", node("WaitFor", 0, seconds=60)), of("B", node("NoOp", 1))
    async with rigged(**QUICK) as rig:
        async with engine_of("B", rig, **QUICK):
            rig.start(planner_chain("g", [first, last]), BOTH)
            await ended(rig, "g", "RUNNING")
        rig.modify(planner_chain("g", [first, of("B", node("NoOp", 2))]))
        await rig.until(lambda: rig.rejections)
        assert [item.problems[0].message for item in rig.rejections] == ["B is not there"]
        assert not [item for item in rig.events if item.cause == "modify"]


async def test_a_modify_with_a_new_actor_is_refused() -> None:
    async with crew() as rig:
        await at_work(rig)
        graph = working()
        graph["actions"][1]["actor"] = "C"
        rig.modify(graph)
        await rig.until(lambda: rig.rejections)
        assert [item.problems[0].code for item in rig.rejections] == ["unknown_actor"]


@pytest.mark.spec("13")
async def test_a_step_of_another_actor_can_be_ended() -> None:
    async with crew() as rig:
        await at_work(rig)
        step = rig.transport.publisher(topics.STEP)
        step.publish(to_string(StepCommand(target="B", graph_name="g", node="WaitFor_0")))
        for actor in BOTH:
            await rig.until_node("g", "WaitFor_0", ["RUNNING", "STOPPING", "FINISHED"], actor)
        assert rig.graph_states("g") == ["RUNNING", "RUNNING"]


async def test_a_command_to_all_is_not_carried_out_twice() -> None:
    async with crew() as rig:
        first = of("A", node("NoOp", 0))
        rig.start(planner_chain("g", [first]), BOTH)
        await ended(rig, "g", "HALTED")
        rig.transport.publisher(topics.GRAPH_MODIFY).publish(
            ros.UmrfGraphModify(
                modified_graph=json.dumps(planner_chain("g", [first, node("NoOp", 1)])),
                continue_from="NoOp_1",
                targets=BOTH,
            )
        )
        for actor in BOTH:
            await rig.until_node("g", "NoOp_1", ["RUNNING", "FINISHED"], actor)
            await rig.until_graph("g", "HALTED", actor)
            assert rig.node_states("g", "NoOp_1", actor) == ["RUNNING", "FINISHED"]


async def test_a_passed_on_command_that_cannot_be_carried_out_is_told() -> None:
    said: list[SyncNotice] = []
    async with crew() as rig:

        def keep(message: ros.String) -> None:
            said.extend([notice] if (notice := decode(SyncNotice, message.data)).actor == "A" else [])

        listening = await rig.transport.subscribe(topics.SYNC, keep)
        await at_work(rig)
        await listening.close()
        end = SyncEntry(kind="command", graph_name="g", command="end", node="NoOp_9")
        rig.transport.publisher(topics.SYNC).publish(
            to_string(said[-1].model_copy(update={"first": 100, "said": (end,)}))
        )
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].what == "sync end"
        rig.transport.publisher(topics.SYNC).publish(ros.String("{"))
        await rig.until(lambda: len(rig.rejections) == 3)


@pytest.mark.spec("13")
async def test_an_emergency_stop_of_one_holds_all_until_it_is_reset() -> None:
    async with crew(robot=DummyRobot()) as rig:
        await at_work(rig)
        rig.emergency("stop", targets=("B",))
        await ended(rig, "g", "PAUSED")
        await rig.until(lambda: any(item.actor == "B" and item.state == "stopped" for item in rig.statuses))
        await asyncio.sleep(0.05)
        rig.resume("g")
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].message == "B was stopped by the emergency stop"
        assert rig.graph_states("g", "A")[-1] == "PAUSED"
        rig.emergency("reset", targets=("B",))
        await rig.until(lambda: rig.reports[-1].state == "reset")
        await asyncio.sleep(0.05)
        rig.resume("g")
        await ended(rig, "g", "RUNNING")


async def test_who_leaves_does_not_wait_for_others() -> None:
    began_s = time.monotonic()
    async with crew(stop_timeout_s=30.0) as rig:
        await at_work(rig)
    assert time.monotonic() - began_s < 10
