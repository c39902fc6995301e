"""The example graphs of the contract (section 15) end as they do on the reference."""

from __future__ import annotations

import json
from typing import Any

import pytest

from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState, Result

from .spec_actions import node, planner_chain
from .watched import Watched

HANDOVER = """{"graph_name": "ex_handover",
 "graph_entry": [{"name": "JoinText", "instance_id": 0}, {"name": "JoinText", "instance_id": 1}],
 "graph_exit": [{"name": "SameText", "instance_id": 0}],
 "actions": [
  {"name": "JoinText", "instance_id": 0, "type": "sync",
   "input_parameters": {"left": {"pvf_type": "string", "pvf_value": "a"}, "right": {"pvf_type": "string", "pvf_value": "b"}},
   "output_parameters": {"text": {"pvf_type": "string"}},
   "children": [{"name": "JoinText", "instance_id": 2, "remap": [{"from": "text", "to": "left"}]}]},
  {"name": "JoinText", "instance_id": 1, "type": "sync",
   "input_parameters": {"left": {"pvf_type": "string", "pvf_value": "c"}, "right": {"pvf_type": "string", "pvf_value": "d"}},
   "output_parameters": {"text": {"pvf_type": "string"}},
   "children": [{"name": "JoinText", "instance_id": 2, "remap": [{"from": "text", "to": "right"}]}]},
  {"name": "JoinText", "instance_id": 2, "type": "sync",
   "input_parameters": {"left": {"pvf_type": "string"}, "right": {"pvf_type": "string"}},
   "output_parameters": {"text": {"pvf_type": "string"}},
   "parents": [{"name": "JoinText", "instance_id": 0}, {"name": "JoinText", "instance_id": 1}],
   "children": [{"name": "SameText", "instance_id": 0}]},
  {"name": "SameText", "instance_id": 0, "type": "sync",
   "input_parameters": {"text": {"pvf_type": "string"}, "expected": {"pvf_type": "string", "pvf_value": "a-b-c-d"}},
   "parents": [{"name": "JoinText", "instance_id": 2}]}]}"""  # noqa: E501

LOOP = """{"graph_name": "ex_loop",
 "graph_entry": [{"name": "WaitFor", "instance_id": 0}, {"name": "WaitFor", "instance_id": 9}],
 "graph_exit": [{"name": "WaitFor", "instance_id": 9, "conditions": ["on_stopped -> run", "on_true -> ignore"]}],
 "actions": [
  {"name": "WaitFor", "instance_id": 0, "type": "sync",
   "input_parameters": {"seconds": {"pvf_type": "number", "pvf_value": 0.002}},
   "output_parameters": {"waited": {"pvf_type": "number"}},
   "parents": [{"name": "CountTo", "instance_id": 0, "required": false, "conditions": ["on_false -> run", "on_true -> ignore"]}],
   "children": [{"name": "CountTo", "instance_id": 0}]},
  {"name": "CountTo", "instance_id": 0, "type": "sync",
   "input_parameters": {"limit": {"pvf_type": "number", "pvf_value": 3}},
   "parents": [{"name": "WaitFor", "instance_id": 0}],
   "children": [{"name": "WaitFor", "instance_id": 0}, {"name": "WaitFor", "instance_id": 9}]},
  {"name": "WaitFor", "instance_id": 9, "type": "sync",
   "input_parameters": {"seconds": {"pvf_type": "number", "pvf_value": 60}},
   "output_parameters": {"waited": {"pvf_type": "number"}},
   "parents": [{"name": "CountTo", "instance_id": 0, "required": false, "conditions": ["on_true -> stop", "on_false -> ignore"]}]}]}"""  # noqa: E501

REPORT = '{"message": "door is closed"}'


@pytest.mark.spec("10.4", "10.6", "5.1")
async def test_fan_out_and_join_with_remaps_finish_on_true() -> None:
    watched = Watched(HANDOVER)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.run.state is GraphState.FINISHED
    assert watched.runs() == ["JoinText_0", "JoinText_1", "JoinText_2", "SameText_0"]
    await watched.run.close()


@pytest.mark.spec("10.4", "5.3", "D2", "11.2", "8.2")
async def test_a_loop_ends_by_stopping_another_node() -> None:
    watched = Watched(LOOP)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_STOPPED
    assert watched.run.state is GraphState.FINISHED
    assert watched.runs().count("CountTo_0") == 3
    assert watched.states("WaitFor_9") == ["RUNNING", "STOPPING", "FINISHED"]
    await watched.run.close()


def planner_graph(second: dict[str, Any]) -> dict[str, Any]:
    return planner_chain(
        "20250101120000", [node("WaitFor", 0, seconds=0.001), second, node("WaitFor", 2, seconds=0.001)]
    )


@pytest.mark.spec("12.6", "10.9", "11.5", "8.2", "17")
async def test_a_planner_graph_halts_on_an_error_and_goes_on_after_repair() -> None:
    watched = Watched(planner_graph(node("RaiseError", 1, text=REPORT)))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.state("RaiseError_1") is NodeState.ERROR
    failed = watched.run.snapshot().node("RaiseError_1")
    assert failed is not None and failed.messages[-1].message == REPORT
    assert watched.state("WaitFor_2") is NodeState.UNINITIALIZED

    repaired = planner_graph(node("JoinText", 1, left="a", right="b"))
    watched.run.modify(read_graph(json.dumps(repaired)), continue_from="JoinText_1")
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.runs() == ["WaitFor_0", "RaiseError_1", "JoinText_1", "WaitFor_2"]
    snapshot = watched.run.snapshot()
    assert {item.full_name: item.state.value for item in snapshot.nodes} == {
        "WaitFor_0": "FINISHED",
        "JoinText_1": "FINISHED",
        "WaitFor_2": "FINISHED",
    }
    assert snapshot.state is GraphState.HALTED
    await watched.run.close()


@pytest.mark.parametrize("source", [HANDOVER, LOOP])
@pytest.mark.spec("12.2-better", "D16")
async def test_every_transition_is_numbered_without_gaps(source: str) -> None:
    watched = Watched(source)
    watched.run.start()
    await watched.run.wait()
    await watched.run.close()
    assert [item.sequence for item in watched.told] == list(range(len(watched.told)))
