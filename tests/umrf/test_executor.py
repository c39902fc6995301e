"""One run of a graph: states, commands, failures, and that nothing is left behind."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest

from parley.clock import WallClock
from parley.errors import FailureCode, GraphRefusedError
from parley.messages.failure import FailureReport
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState, Result
from parley.umrf.transition import Transition

from .spec_actions import CATALOGUE, chain, node, planner_chain
from .watched import Watched, until

LONG = 60.0


async def settle() -> None:
    """Let everything happen that needs no time."""
    for _ in range(20):
        await asyncio.sleep(0)


def refusal(error: pytest.ExceptionInfo[GraphRefusedError]) -> str:
    return error.value.problems[0].code


# -- ends ---------------------------------------------------------------------------------------------------


async def test_a_linear_graph_runs_in_order_and_finishes() -> None:
    watched = Watched(chain("g", [node("NoOp", index) for index in range(5)]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.runs() == [f"NoOp_{index}" for index in range(5)]
    assert watched.states() == ["RUNNING", "FINISHED"]
    await watched.run.close()


@pytest.mark.spec("10.3", "17")
async def test_running_is_announced_before_the_action_begins() -> None:
    watched = Watched(chain("g", [node("NoOp")]))
    watched.run.start()
    assert [item.state for item in watched.told] == ["RUNNING", "RUNNING"]
    await watched.run.wait()


@pytest.mark.spec("2", "10.5")
async def test_an_empty_graph_halts_as_soon_as_it_is_started() -> None:
    watched = Watched({"graph_name": "g", "graph_entry": [], "graph_exit": [], "actions": []})
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED


@pytest.mark.spec("5.3")
async def test_a_result_of_false_goes_on_by_default() -> None:
    watched = Watched(chain("g", [node("SameText", 0, text="a", expected="b"), node("NoOp", 1)]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    assert (
        next(item.result for item in watched.told if item.node == "SameText_0" and item.result) == "on_false"
    )


@pytest.mark.spec("10.9", "8.1", "D5", "8.2")
async def test_an_error_runs_through_to_the_exit_by_default() -> None:
    watched = Watched(chain("g", [node("Crash", 0), node("NoOp", 1), node("NoOp", 2)]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert watched.run.state is GraphState.FINISHED
    assert watched.bypassed() == ["NoOp_1", "NoOp_2"]
    assert watched.state("NoOp_1") is NodeState.UNINITIALIZED


@pytest.mark.spec("10.5-better", "D19", "P10")
async def test_a_missing_output_halts_the_graph_and_names_the_input() -> None:
    watched = Watched(chain("g", [node("FindNothing", 0), node("SameText", 1, expected="x")]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.told[-1].message == "SameText_1 has no data for text"


async def test_a_graph_starts_only_once() -> None:
    watched = Watched(chain("g", [node("NoOp")]))
    watched.run.start()
    with pytest.raises(GraphRefusedError) as error:
        watched.run.start()
    assert refusal(error) == "already_started"
    await watched.run.wait()


# -- failures -----------------------------------------------------------------------------------------------


@pytest.mark.spec("12.6", "10.1-better", "D36", "17")
async def test_a_failure_is_logged_as_a_report_in_the_same_transition_as_the_error() -> None:
    watched = Watched(chain("g", [node("Fail", 0, reason="A box is in the way.")]))
    watched.run.start()
    await watched.run.wait()
    [error] = [item for item in watched.told if item.state == "ERROR"]
    report = FailureReport.parse(error.message)
    assert report == FailureReport(
        message="A box is in the way.", code=FailureCode.BLOCKED, details={"by": "a box"}
    )
    assert watched.log("Fail_0") == [error.message]


@pytest.mark.spec("10.1-better", "D36", "10.1")
async def test_a_defect_of_an_action_is_an_internal_failure_that_names_it() -> None:
    watched = Watched(chain("g", [node("Crash", 0)]))
    watched.run.start()
    await watched.run.wait()
    report = FailureReport.parse(watched.log("Crash_0")[-1])
    assert report.code is FailureCode.INTERNAL
    assert report.message == "Crash failed: KeyError: 'shelf'."


async def test_facts_that_cannot_be_written_are_left_out_of_the_report() -> None:
    watched = Watched(chain("g", [node("FailBadly", 0)]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    report = FailureReport.parse(watched.log("FailBadly_0")[-1])
    assert (report.message, report.code, report.details) == ("half ?", FailureCode.BLOCKED, {})


@pytest.mark.spec("17")
async def test_an_action_cannot_end_the_program() -> None:
    watched = Watched(chain("g", [node("Leave", 0)]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert "exit(3)" in watched.log("Leave_0")[-1]


@pytest.mark.spec("10.1")
async def test_a_plain_log_line_does_not_hide_the_reason_of_a_defect() -> None:
    watched = Watched(chain("g", [node("RaiseError", 0, text="getting on")]))
    watched.run.start()
    await watched.run.wait()
    assert FailureReport.parse(watched.log("RaiseError_0")[-1]).message == (
        "Raise error failed: RuntimeError: as planned."
    )


@pytest.mark.spec("3")
async def test_only_the_ten_newest_log_lines_are_kept() -> None:
    handles: list[Any] = []
    told: list[Transition] = []
    run = GraphRun(
        read_graph(chain("g", [node("NoOp")])),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=handles.append,
        observer=told.append,
    )
    run.start()
    await run.wait()
    handles[0].progress(1.0, "too late to be told")
    for index in range(15):
        handles[0].log(f"{index} \ud800")
    found = run.snapshot().nodes[0].messages
    assert [item.message for item in found] == [f"{index} ?" for index in range(5, 15)]
    assert not [item for item in told if item.kind == "progress"]


async def test_a_context_that_cannot_be_made_is_the_failure_of_the_node() -> None:
    def broken(handle: object) -> None:
        raise LookupError("no camera configured")

    run = GraphRun(
        read_graph(planner_chain("g", [node("NoOp")])),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=broken,
    )
    run.start()
    assert await run.wait() is Result.ON_HALTED
    assert run.snapshot().nodes[0].state is NodeState.ERROR


async def test_a_defect_of_an_observer_does_not_stop_the_run() -> None:
    def broken(transition: Transition) -> None:
        raise ValueError("cannot draw this")

    run = GraphRun(
        read_graph(chain("g", [node("NoOp")])),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=lambda handle: handle,
        observer=broken,
    )
    run.start()
    assert await run.wait() is Result.ON_TRUE


async def test_facts_are_told_with_the_end_of_the_node_and_not_handed_on() -> None:
    watched = Watched(chain("g", [node("Measure", 0), node("SameText", 1, text="own", expected="own")]))
    watched.run.start()
    await watched.run.wait()
    [ended] = [item for item in watched.told if item.node == "Measure_0" and item.result]
    assert {name: item.value for name, item in ended.outputs.items() if item.type == "string"} == {
        "text": "beside",
        "seen::text": "a box",
    }
    assert watched.run.outputs("Measure_0") == {}
    assert [item.result for item in watched.told if item.node == "SameText_1"][-1] is Result.ON_TRUE


async def test_progress_that_comes_too_fast_is_thinned_and_the_newest_is_told() -> None:
    watched = Watched(chain("g", [node("Chatter", 0)]))
    watched.run.start()
    await watched.run.wait()
    told = [item.progress_text for item in watched.told if item.kind == "progress"]
    assert told == ["0", "49"]


# -- threads ------------------------------------------------------------------------------------------------


async def test_plain_functions_run_in_a_named_thread() -> None:
    watched = Watched(chain("g", [node("InThread", 0, text="hi")]))
    watched.run.start()
    await watched.run.wait()
    assert watched.log("InThread_0") == ["action InThread_0"]
    assert watched.run.outputs("InThread_0") == {"text": "HI"}
    assert [item.progress_text for item in watched.told if item.kind == "progress"] == ["half"]
    await watched.run.close()


@pytest.mark.spec("10.1", "11.2")
async def test_stopping_tells_a_thread_and_waits_for_it() -> None:
    watched = Watched(chain("g", [node("ThreadLoop", 0)]))
    watched.run.start()
    await asyncio.sleep(0.02)
    watched.run.stop()
    assert await watched.run.wait() is Result.ON_STOPPED
    assert watched.states("ThreadLoop_0") == ["RUNNING", "STOPPING", "FINISHED"]


# -- pause and resume ---------------------------------------------------------------------------------------


@pytest.mark.spec("11.3", "11.4")
async def test_an_action_that_honours_pauses_is_paused_at_once() -> None:
    watched = Watched(chain("g", [node("WaitFor", 0, seconds=LONG)]))
    watched.run.start()
    watched.run.pause()
    assert (watched.run.state, watched.state("WaitFor_0")) == (GraphState.PAUSED, NodeState.PAUSED)
    watched.run.pause()
    watched.run.resume()
    assert (watched.run.state, watched.state("WaitFor_0")) == (GraphState.RUNNING, NodeState.RUNNING)
    watched.run.resume()
    assert watched.states() == ["RUNNING", "PAUSED", "RUNNING"]
    await watched.run.close()


@pytest.mark.spec("11.3-better", "D3", "10.3")
async def test_an_action_that_ignores_pauses_is_let_finish_and_its_children_are_held() -> None:
    watched = Watched(chain("g", [node("Insist", 0, seconds=0.01), node("NoOp", 1)]))
    watched.run.start()
    watched.run.pause()
    assert (watched.run.state, watched.state("Insist_0")) == (GraphState.RUNNING, NodeState.PAUSE_REQUESTED)
    assert watched.run.holding
    await asyncio.sleep(0.05)
    assert (watched.run.state, watched.state("Insist_0")) == (GraphState.PAUSED, NodeState.FINISHED)
    assert watched.runs() == ["Insist_0"]
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.runs() == ["Insist_0", "NoOp_1"]


@pytest.mark.spec("11.3")
async def test_a_plain_action_is_paused_when_it_has_looked() -> None:
    may_look, looked, may_end = threading.Event(), threading.Event(), threading.Event()

    @action
    def drive(ctx: RunHandle) -> None:
        """Move on, look once, move on."""
        may_look.wait(5)
        assert ctx.paused
        looked.set()
        may_end.wait(5)

    watched = Watched(
        chain("g", [{"name": "Drive", "instance_id": 0, "type": "sync"}]), catalogue=Catalogue([drive.spec])
    )
    watched.run.start()
    await asyncio.sleep(0.01)
    watched.run.pause()
    assert (watched.state("Drive_0"), watched.run.state) == ("PAUSE_REQUESTED", "RUNNING")
    may_look.set()
    await until(lambda: watched.run.state == "PAUSED")
    assert looked.is_set() and watched.state("Drive_0") == "PAUSED"
    watched.run.resume()
    may_end.set()
    assert await watched.run.wait() is Result.ON_TRUE


async def test_nothing_begins_during_a_pause() -> None:
    began = threading.Event()

    @action
    def drive(ctx: RunHandle) -> None:
        """Say that it moves."""
        began.set()

    graph = chain("g", [{"name": "Drive", "instance_id": 0, "type": "sync"}])
    watched = Watched(graph, catalogue=Catalogue([drive.spec]))
    watched.run.start()
    watched.run.pause()
    assert (watched.state("Drive_0"), watched.run.state) == ("PAUSED", "PAUSED")
    await asyncio.sleep(0.01)
    assert not began.is_set()
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_TRUE and began.is_set()


async def test_a_pause_can_be_taken_back_before_it_took_hold() -> None:
    watched = Watched(chain("g", [node("Insist", 0, seconds=0.01), node("NoOp", 1)]))
    watched.run.start()
    watched.run.pause()
    watched.run.resume()
    assert watched.state("Insist_0") is NodeState.RUNNING
    assert await watched.run.wait() is Result.ON_TRUE
    assert "PAUSED" not in watched.states()


@pytest.mark.spec("10.3", "11.3")
async def test_a_paused_action_that_ends_holds_its_children_too() -> None:
    watched = Watched(chain("g", [node("WaitFor", 0, seconds=0.001), node("NoOp", 1)]))
    watched.run.start()
    watched.run.pause()
    await asyncio.sleep(0.02)
    assert watched.runs() == ["WaitFor_0"]
    assert watched.run.state is GraphState.PAUSED
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_TRUE


@pytest.mark.parametrize("pause_first", [False, True])
@pytest.mark.spec("11.2", "11.2-better", "D4", "17")
async def test_stop_ends_stopped_also_when_paused(pause_first: bool) -> None:
    watched = Watched(chain("g", [node("WaitFor", 0, seconds=LONG), node("NoOp", 1)]))
    watched.run.start()
    if pause_first:
        watched.run.pause()
    watched.run.stop()
    assert await watched.run.wait() is Result.ON_STOPPED
    assert watched.run.state is GraphState.STOPPED
    assert watched.states()[-2:] == ["STOPPING", "STOPPED"]
    assert watched.state("WaitFor_0") is NodeState.FINISHED
    assert watched.state("NoOp_1") is NodeState.UNINITIALIZED


@pytest.mark.spec("11.2")
async def test_stopping_twice_or_after_the_end_changes_nothing() -> None:
    watched = Watched(chain("g", [node("NoOp")]))
    watched.run.start()
    await watched.run.wait()
    told = len(watched.told)
    watched.run.stop()
    watched.run.pause()
    assert watched.run.state is GraphState.FINISHED
    assert len(watched.told) == told


@pytest.mark.spec("11.2", "8.2")
async def test_an_action_that_does_not_stop_ends_in_error_after_the_time_out() -> None:
    watched = Watched(chain("g", [node("Stubborn", 0, seconds=0.15)]), stop_timeout_s=0.02)
    watched.run.start()
    await settle()
    watched.run.stop()
    assert await watched.run.wait() is Result.ON_ERROR
    assert watched.run.state is GraphState.ERROR
    assert watched.state("Stubborn_0") is NodeState.ERROR
    assert "did not stop within 0.02 s" in watched.log("Stubborn_0")[-1]
    told = len(watched.told)
    await watched.run.close()
    assert len(watched.told) == told, "its late end changes nothing"
    assert watched.run.idle


@pytest.mark.spec("11.2")
async def test_stopping_one_node_follows_its_edges() -> None:
    raw = chain("g", [node("WaitFor", 0, seconds=LONG), node("NoOp", 1)], conditions=["on_stopped -> run"])
    watched = Watched(raw)
    watched.run.start()
    watched.run.end_node("WaitFor_0")
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.states("WaitFor_0") == ["RUNNING", "STOPPING", "FINISHED"]
    with pytest.raises(GraphRefusedError):
        watched.run.end_node("WaitFor_7")


@pytest.mark.spec("D32", "6")
async def test_nodes_that_outlive_their_graph_can_be_stopped() -> None:
    raw = {
        "graph_name": "g",
        "graph_entry": [{"name": "NoOp"}, {"name": "WaitFor"}],
        "graph_exit": [{"name": "NoOp"}],
        "actions": [node("NoOp"), node("WaitFor", 0, seconds=LONG)],
    }
    watched = Watched(raw)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.state("WaitFor_0") is NodeState.RUNNING
    watched.run.pause()
    assert watched.state("WaitFor_0") is NodeState.PAUSED
    watched.run.stop()
    await settle()
    assert watched.state("WaitFor_0") is NodeState.FINISHED
    assert watched.run.state is GraphState.FINISHED


def triggering(response: str, watched_node: dict[str, Any]) -> dict[str, Any]:
    """NoOp_0 ends at once and answers its edge to the other entry with `response`."""
    ref = {"name": watched_node["name"], "instance_id": watched_node["instance_id"]}
    back = {"name": "NoOp", "required": False, "conditions": [f"on_true -> {response}"]}
    return {
        "graph_name": "g",
        "graph_entry": [ref, {"name": "NoOp"}],
        "graph_exit": [],
        "actions": [watched_node | {"parents": [back]}, node("NoOp") | {"children": [ref]}],
    }


@pytest.mark.spec("D30", "5.3")
async def test_restart_stops_a_running_child_and_runs_it_again() -> None:
    watched = Watched(triggering("restart", node("WaitFor", 0, seconds=LONG)))
    watched.run.start()
    await settle()
    assert watched.states("WaitFor_0") == ["RUNNING", "STOPPING", "FINISHED", "RUNNING"]
    assert watched.run.state is GraphState.RUNNING
    await watched.run.close()


async def test_a_restart_does_not_outlive_a_stop() -> None:
    watched = Watched(triggering("restart", node("ThreadLoop", 0)))
    watched.run.start()
    async with asyncio.timeout(5):
        while watched.state("ThreadLoop_0") is not NodeState.STOPPING:  # noqa: ASYNC110 - nobody tells
            await asyncio.sleep(0)  # every turn: its thread may end within two
    watched.run.stop()
    assert await watched.run.wait() is Result.ON_STOPPED
    assert watched.states("ThreadLoop_0") == ["RUNNING", "STOPPING", "FINISHED"]


async def test_a_node_that_did_not_stop_earlier_is_no_reason_for_a_stop_to_fail() -> None:
    watched = Watched(triggering("stop", node("Stubborn", 0, seconds=0.1)), stop_timeout_s=0.01)
    watched.run.start()
    await watched.run.wait()
    assert (watched.run.state, watched.state("Stubborn_0")) == (GraphState.HALTED, NodeState.ERROR)
    with pytest.raises(GraphRefusedError) as error:
        watched.run.resume("Stubborn_0")
    assert refusal(error) == "still_stopping"
    watched.run.stop()
    assert await watched.run.wait() is Result.ON_STOPPED
    await watched.run.close()


async def test_a_node_paused_by_an_edge_goes_on_with_a_resume() -> None:
    watched = Watched(triggering("pause", node("WaitFor", 0, seconds=LONG)))
    watched.run.start()
    await settle()
    assert (watched.run.state, watched.state("WaitFor_0")) == (GraphState.RUNNING, NodeState.PAUSED)
    watched.run.resume()
    assert watched.state("WaitFor_0") is NodeState.RUNNING
    await watched.run.close()


@pytest.mark.spec("10.4")
async def test_a_node_that_triggers_itself_is_still_running_then() -> None:
    raw = {
        "graph_name": "g",
        "graph_entry": [{"name": "NoOp"}],
        "graph_exit": [],
        "actions": [
            node("NoOp") | {"children": [{"name": "NoOp"}], "parents": [{"name": "NoOp", "required": False}]}
        ],
    }
    watched = Watched(raw)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.runs() == ["NoOp_0"]


# -- continue and modify ------------------------------------------------------------------------------------


async def halted(*nodes: dict[str, Any]) -> Watched:
    watched = Watched(planner_chain("g", list(nodes)))
    watched.run.start()
    await watched.run.wait()
    assert watched.run.state is GraphState.HALTED
    return watched


@pytest.mark.spec("11.4-better", "11.4")
async def test_resuming_a_halted_graph_without_a_node_leaves_it_halted() -> None:
    watched = await halted(node("NoOp"))
    watched.run.resume()
    assert watched.run.state is GraphState.HALTED


@pytest.mark.spec("10.9", "11.4")
async def test_a_failed_step_can_be_tried_again_with_the_inputs_it_had() -> None:
    watched = await halted(node("JoinText", 0, left="a", right="b"), node("RaiseError", 1))
    assert watched.state("RaiseError_1") is NodeState.ERROR
    watched.run.resume("RaiseError_1")
    await watched.run.wait()
    assert watched.runs() == ["JoinText_0", "RaiseError_1", "RaiseError_1"]


@pytest.mark.spec("4.3-better")
async def test_a_step_that_is_run_out_of_turn_takes_what_its_parent_gave() -> None:
    first = node("JoinText", 0, left="a", right="b")
    watched = await halted(first)
    graph = planner_chain("g", [first, node("SameText", 1, expected="a-b")])
    watched.run.modify(read_graph(graph), "SameText_1")
    await watched.run.wait()
    assert [item.result for item in watched.told if item.node == "SameText_1"][-1] == "on_true"


async def test_a_step_without_its_inputs_is_not_run_out_of_turn() -> None:
    watched = await halted(
        node("Crash", 0), node("JoinText", 1, left="a", right="b"), node("SameText", 2, expected="x")
    )
    before, told = watched.run.snapshot(), len(watched.told)
    with pytest.raises(GraphRefusedError) as error:
        watched.run.resume("SameText_2")
    assert refusal(error) == "missing_input"
    assert "text" in str(error.value)
    assert (watched.run.snapshot(), len(watched.told)) == (before, told)


@pytest.mark.spec("D1", "11.5-better", "17")
async def test_continuing_from_a_running_node_is_no_change() -> None:
    nodes = [node("WaitFor", 0, seconds=0.01)]
    watched = Watched(planner_chain("g", nodes))
    watched.run.start()
    watched.run.modify(read_graph(planner_chain("g", [*nodes, node("NoOp", 1)])), "WaitFor_0")
    await watched.run.wait()
    assert watched.runs() == ["WaitFor_0", "NoOp_1"]


@pytest.mark.parametrize("name", ["NoOp_7", "None_0"])
@pytest.mark.spec("11.4")
async def test_an_unknown_node_to_continue_from_is_refused(name: str) -> None:
    watched = await halted(node("NoOp"))
    told = len(watched.told)
    with pytest.raises(GraphRefusedError) as error:
        watched.run.resume(name)
    assert refusal(error) == "unknown_node"
    with pytest.raises(GraphRefusedError) as error:
        watched.run.modify(read_graph(planner_chain("g", [node("NoOp")])), name)
    assert refusal(error) == "unknown_node"
    assert len(watched.told) == told


@pytest.mark.spec("11.5")
async def test_modifying_without_a_node_to_continue_from_leaves_a_halted_graph_halted() -> None:
    watched = await halted(node("NoOp"))
    watched.run.modify(read_graph(planner_chain("g", [node("NoOp"), node("NoOp", 1)])))
    assert watched.run.state is GraphState.HALTED
    assert watched.state("NoOp_1") is NodeState.UNINITIALIZED


@pytest.mark.spec("11.5")
async def test_a_paused_graph_can_be_modified_and_stays_paused() -> None:
    nodes = [node("WaitFor", 0, seconds=0.01), node("Crash", 1)]
    watched = Watched(planner_chain("g", nodes))
    watched.run.start()
    watched.run.pause()
    watched.run.modify(read_graph(planner_chain("g", [nodes[0], node("NoOp", 2)])))
    assert watched.run.state is GraphState.PAUSED
    watched.run.resume()
    await watched.run.wait()
    assert watched.runs() == ["WaitFor_0", "NoOp_2"]


async def test_a_node_that_ended_during_the_pause_goes_on_along_the_new_edges() -> None:
    nodes = [node("WaitFor", 0, seconds=0.001), node("Crash", 1)]
    watched = Watched(planner_chain("g", nodes))
    watched.run.start()
    watched.run.pause()
    await asyncio.sleep(0.02)
    watched.run.modify(read_graph(planner_chain("g", [nodes[0], node("NoOp", 2)])))
    watched.run.resume()
    await watched.run.wait()
    assert watched.runs() == ["WaitFor_0", "NoOp_2"]


async def test_a_node_that_ended_during_the_pause_may_be_removed() -> None:
    watched = Watched(planner_chain("g", [node("WaitFor", 0, seconds=0.001), node("Crash", 1)]))
    watched.run.start()
    await asyncio.sleep(0)  # it begins
    watched.run.pause()
    await until(lambda: watched.run.idle)
    watched.run.modify(read_graph(planner_chain("g", [node("NoOp", 2)])))
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_HALTED
    watched.run.resume("NoOp_2")
    await watched.run.wait()
    assert watched.runs() == ["WaitFor_0", "NoOp_2"]


@pytest.mark.spec("D12")
async def test_the_last_child_of_a_running_node_can_be_removed() -> None:
    nodes = [node("WaitFor", 0, seconds=0.01), node("Crash", 1)]
    watched = Watched(planner_chain("g", nodes))
    watched.run.start()
    watched.run.modify(read_graph(planner_chain("g", nodes[:1])))
    await watched.run.wait()
    assert watched.runs() == ["WaitFor_0"]


@pytest.mark.spec("11.5")
async def test_new_values_count_for_the_next_run_of_a_node() -> None:
    watched = await halted(node("JoinText", 0, left="a", right="b"))
    watched.run.modify(
        read_graph(planner_chain("g", [node("JoinText", 0, left="c", right="d")])), "JoinText_0"
    )
    await watched.run.wait()
    assert watched.run.outputs("JoinText_0") == {"text": "c-d"}


@pytest.mark.spec("D9", "11.5-better")
async def test_a_join_keeps_the_edges_it_has_seen_through_a_modify() -> None:
    def graph(*extra: dict[str, Any]) -> dict[str, Any]:
        fast, slow, join = node("NoOp", 0), node("WaitFor", 1, seconds=0.02), node("NoOp", 2)
        fast["children"] = slow["children"] = [{"name": "NoOp", "instance_id": 2}]
        join["parents"] = [{"name": "NoOp", "instance_id": 0}, {"name": "WaitFor", "instance_id": 1}]
        entries = [
            {"name": item["name"], "instance_id": item["instance_id"]} for item in (fast, slow, *extra)
        ]
        return {
            "graph_name": "g",
            "graph_entry": entries,
            "graph_exit": [{"name": "NoOp", "instance_id": 2}],
            "actions": [fast, slow, join, *extra],
        }

    watched = Watched(graph())
    watched.run.start()
    await settle()
    assert watched.state("NoOp_0") is NodeState.FINISHED
    watched.run.modify(read_graph(graph(node("NoOp", 3))))
    assert await watched.run.wait() is Result.ON_TRUE


@pytest.mark.parametrize("end", ["finish", "stop"])
@pytest.mark.spec("11.5")
async def test_an_ended_graph_cannot_be_modified_or_resumed(end: str) -> None:
    seconds = 0.0 if end == "finish" else LONG
    watched = Watched(chain("g", [node("WaitFor", 0, seconds=seconds)]))
    watched.run.start()
    if end == "stop":
        watched.run.stop()
    await watched.run.wait()
    with pytest.raises(GraphRefusedError) as error:
        watched.run.modify(read_graph(chain("g", [node("NoOp")])))
    assert refusal(error) == "graph_ended"
    with pytest.raises(GraphRefusedError) as error:
        watched.run.resume()
    assert refusal(error) == "graph_ended"


@pytest.mark.spec("D10", "11.5-better")
async def test_a_modify_that_cannot_run_names_every_reason_and_changes_nothing() -> None:
    watched = await halted(node("NoOp"))
    before = watched.run.snapshot()
    bad = planner_chain("g", [node("NoOp"), node("NoOp", 1), node("NoOp", 2)])
    bad["actions"][1]["name"] = "Unknown"
    bad["actions"][2]["actor"] = "B"
    with pytest.raises(GraphRefusedError) as error:
        watched.run.modify(read_graph(bad))
    assert {"unknown_action", "unknown_actor"} <= {problem.code for problem in error.value.problems}
    assert watched.run.snapshot() == before


# -- what is seen -------------------------------------------------------------------------------------------


@pytest.mark.spec("4.3", "4.3-better")
async def test_the_snapshot_shows_transferred_data_only_while_it_is_used() -> None:
    raw = chain("g", [node("JoinText", 0, left="a", right="b"), node("RaiseError", 1)])
    seen: list[Any] = []

    def look(transition: Transition) -> None:
        found = run.snapshot().node("RaiseError_1")
        assert found is not None
        seen.append((transition.node, transition.state, found.input_parameters["text"].value))

    run = GraphRun(
        read_graph(raw),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=lambda handle: handle,
        observer=look,
    )
    run.start()
    await run.wait()
    assert ("RaiseError_1", "RUNNING", "a-b") in seen
    assert ("RaiseError_1", "ERROR", None) in seen


async def test_closing_twice_and_before_the_start_is_harmless() -> None:
    watched = Watched(chain("g", [node("NoOp")]))
    await watched.run.close()
    await watched.run.close()
    assert watched.run.state is GraphState.STOPPED
