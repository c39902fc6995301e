"""Indexed graphs used as actions: values in and out, failures, commands inside, recursion (10.8)."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from parley.clock import WallClock
from parley.errors import GraphRefusedError
from parley.messages.pvf import Parameter
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check
from parley.umrf.executor import GraphRun
from parley.umrf.graph_index import GraphSpec, entry_inputs, exit_outputs
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState, Result
from parley.umrf.transition import Transition

from .inner_graphs import CATALOGUE, bare, ref, use
from .spec_actions import SPECS, chain, node
from .watched import until


class Nest:
    """A run and the runs inside it, with everything each told."""

    def __init__(self, raw: dict[str, Any], catalogue: Catalogue = CATALOGUE, **options: Any) -> None:
        self.catalogue = catalogue
        self.told: dict[str, list[Transition]] = {}
        self.runs: dict[str, GraphRun] = {}
        self.run = self.make(read_graph(raw), **options)

    def make(self, graph: Any, parameters: Any = None, **options: Any) -> GraphRun:
        told = self.told[graph.name] = []
        self.runs[graph.name] = GraphRun(
            graph,
            self.catalogue,
            actor="A",
            clock=WallClock(),
            make_context=lambda handle: handle,
            observer=told.append,
            parameters=parameters or {},
            make_inner=lambda inner, parameters: self.make(inner, parameters, **options),
            **options,
        )
        return self.runs[graph.name]

    def states(self, name: str, full_name: str = "") -> list[str]:
        return [
            item.state
            for item in self.told.get(name, [])
            if item.node == full_name and item.kind != "progress" and item.cause != "bypass"
        ]


def nested_example() -> dict[str, Any]:
    """Section 15.4."""
    greet, same, last = (
        use("GreetTwice", right="world"),
        node("SameText", 0, expected="hello-world-again"),
        node("WaitFor", 0, seconds=0.001),
    )
    greet["children"] = [ref(same), ref(last)]
    same |= {"parents": [ref(greet, conditions=["on_error -> ignore"])], "children": [ref(last)]}
    last["parents"] = [
        ref(
            greet,
            required=False,
            conditions=["on_true -> ignore", "on_false -> ignore", "on_error -> run"],
        ),
        ref(same, required=False, conditions=["on_error -> run"]),
    ]
    return {
        "graph_name": "ex_nested",
        "graph_entry": [ref(greet)],
        "graph_exit": [ref(last)],
        "actions": [greet, same, last],
    }


# -- values -------------------------------------------------------------------------------------------------


@pytest.mark.spec("10.8", "1", "7.2")
async def test_the_example_of_the_contract_ends_as_it_says() -> None:
    nest = Nest(nested_example())
    nest.run.start()
    assert await nest.run.wait() is Result.ON_TRUE
    assert nest.states("ex_nested__GreetTwice__0") == ["RUNNING", "FINISHED"]
    same = [item.result for item in nest.told["ex_nested"] if item.node == "SameText_0"]
    assert same[-1] is Result.ON_TRUE
    assert nest.run.outputs("GreetTwice_0") == {"text": "hello-world-again"}


async def test_without_anybody_to_observe_them_sub_graphs_run_as_well() -> None:
    run = GraphRun(
        read_graph(nested_example()),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=lambda handle: handle,
    )
    run.start()
    assert await run.wait() is Result.ON_TRUE
    await run.close()


@pytest.mark.spec("10.8")
async def test_sub_graphs_stand_inside_sub_graphs() -> None:
    nest = Nest(chain("g", [use("GreetThrice", right="you"), node("SameText", 1, expected="x")]), CATALOGUE)
    nest.run.start()
    await nest.run.wait()
    assert nest.run.outputs("GreetThrice_0") == {"text": "hello-you-again-!"}
    assert set(nest.told) == {"g", "g__GreetThrice__0", "g__GreetThrice__0__GreetTwice__0"}


@pytest.mark.spec("6")
def test_entry_and_exit_say_what_goes_in_and_out() -> None:
    greet = CATALOGUE.graph("GreetTwice")
    assert greet is not None
    assert entry_inputs(greet) == {"right": Parameter("string")}
    assert exit_outputs(greet) == {"text": Parameter("string")}


@pytest.mark.spec("6")
async def test_an_input_that_the_entry_renames_goes_by_its_outer_name() -> None:
    raw = chain("Say", [node("SameText", 0, expected="x")])
    raw["graph_entry"][0]["remap"] = [{"from": "word", "to": "text"}]
    catalogue = Catalogue(SPECS, [read_graph(raw)])
    spec = catalogue.get("Say")
    assert spec is not None and list(spec.inputs) == ["word"]
    user = bare("Say") | {"input_parameters": {"word": {"pvf_type": "string", "pvf_value": "x"}}}
    nest = Nest(chain("g", [user]), catalogue)
    nest.run.start()
    assert await nest.run.wait() is Result.ON_TRUE
    assert [item.result for item in nest.told["g"]][-1] is Result.ON_TRUE


@pytest.mark.spec("7.3")
def test_a_descriptor_may_make_an_entry_input_optional() -> None:
    inner = chain("Inner", [bare("Speak") | {"input_parameters": {"text": {"pvf_type": "string"}}}])
    speak = ActionSpec("Speak", {"text": Parameter("string", required=False)}, {})
    catalogue = Catalogue([speak], [read_graph(inner)])
    spec = catalogue.get("Inner")
    assert isinstance(spec, GraphSpec)
    assert not spec.inputs["text"].required
    blank = bare("Inner") | {"input_parameters": {"text": {"pvf_type": "string"}}}
    assert check(read_graph(chain("g", [blank])), catalogue) == []


def test_actions_come_before_graphs_of_the_same_name_if_they_match() -> None:
    plain = ActionSpec("GreetTwice", {}, {})
    catalogue = Catalogue([plain], CATALOGUE.graphs)
    assert catalogue.match(read_graph(chain("g", [bare("GreetTwice")])).nodes[0]) is plain
    found = catalogue.match(read_graph(chain("g", [use("GreetTwice", right="x")])).nodes[0])
    assert isinstance(found, GraphSpec)


# -- start parameters ---------------------------------------------------------------------------------------


@pytest.mark.spec("6", "10.2")
async def test_a_graph_is_started_with_parameters() -> None:
    greet = CATALOGUE.graph("GreetTwice")
    nest = Nest(nested_example())
    run = nest.make(greet, {"right": "you", "unknown": 3})
    run.start()
    assert await run.wait() is Result.ON_TRUE
    assert run.exit_values() == {"text": "hello-you-again"}


@pytest.mark.spec("6-better", "D19")
@pytest.mark.parametrize("parameters", [{}, {"right": 5.0}, {"left": "again"}])
def test_a_start_without_a_required_input_is_refused_and_names_it(parameters: dict[str, Any]) -> None:
    """Better 6: on the reference such a start does nothing and says nothing."""
    with pytest.raises(GraphRefusedError) as error:
        Nest(nested_example()).make(CATALOGUE.graph("GreetTwice"), parameters)
    assert error.value.problems[0].code == "missing_input"
    assert "right" in str(error.value)


@pytest.mark.spec("6")
async def test_values_in_the_graph_are_not_overwritten_by_start_parameters() -> None:
    nest = Nest(nested_example())
    run = nest.make(CATALOGUE.graph("GreetTwice"), {"right": "you", "left": "bye"})
    run.start()
    await run.wait()
    assert run.exit_values() == {"text": "hello-you-again"}


@pytest.mark.spec("10.2")
@pytest.mark.parametrize(
    ("result", "ends", "runs"),
    [
        (Result.ON_TRUE, Result.ON_TRUE, True),
        (Result.ON_FALSE, Result.ON_TRUE, True),
        (Result.ON_ERROR, Result.ON_ERROR, False),
        (Result.ON_STOPPED, Result.ON_HALTED, False),
    ],
)
async def test_a_start_may_be_given_another_initial_result(result: Result, ends: Result, runs: bool) -> None:
    nest = Nest(chain("g", [node("NoOp", 0), node("NoOp", 1)]))
    nest.run.start(result)
    assert await nest.run.wait() is ends
    assert bool(nest.states("g", "NoOp_0")) is runs


# -- ends ---------------------------------------------------------------------------------------------------


@pytest.mark.spec("10.8", "10.8-better")
@pytest.mark.parametrize(
    ("name", "result"),
    [("FailInside", Result.ON_ERROR), ("RunDry", Result.ON_ERROR), ("SayFalse", Result.ON_FALSE)],
)
async def test_the_result_of_the_inner_graph_is_that_of_the_node_which_is_finished(
    name: str, result: Result
) -> None:
    """Better 10.8: an inner graph that halts counts as an error; the reference waits for ever."""
    nest = Nest(chain("g", [use(name, 0), node("NoOp", 1)], conditions=["on_error -> run"]))
    nest.run.start()
    assert await nest.run.wait() is Result.ON_TRUE
    [end] = [item for item in nest.told["g"] if item.node == f"{name}_0" and item.result]
    assert (end.state, end.result) == ("FINISHED", result)
    assert nest.states("g", "NoOp_1") == ["RUNNING", "FINISHED"]


@pytest.mark.spec("10.8")
async def test_the_failed_node_is_seen_in_the_feedback_of_the_inner_graph() -> None:
    nest = Nest(chain("g", [use("FailInside", 0)]))
    nest.run.start()
    await nest.run.wait()
    assert nest.states("g__FailInside__0", "Fail_0") == ["RUNNING", "ERROR"]


async def test_a_node_that_runs_again_runs_its_graph_again() -> None:
    greet, counter = use("GreetTwice", right="x"), node("CountTo", 0, limit=3)
    greet |= {
        "children": [ref(counter)],
        "parents": [ref(counter, required=False, conditions=["on_true -> ignore"])],
    }
    counter |= {"children": [ref(greet)], "parents": [ref(greet)]}
    nest = Nest(
        {
            "graph_name": "g",
            "graph_entry": [ref(greet)],
            "graph_exit": [ref(counter, conditions=["on_false -> ignore"])],
            "actions": [greet, counter],
        }
    )
    nest.run.start()
    assert await nest.run.wait() is Result.ON_TRUE
    assert nest.states("g", "GreetTwice_0") == ["RUNNING", "FINISHED"] * 3


# -- commands reach inside ----------------------------------------------------------------------------------


@pytest.mark.spec("10.8", "11.2", "D28")
@pytest.mark.parametrize("name", ["WaitLong", "WaitDeep"])
async def test_a_stop_reaches_the_inner_graph(name: str) -> None:
    nest = Nest(chain("g", [use(name, 0)]))
    nest.run.start()
    inner = "g__WaitLong__0" if name == "WaitLong" else "g__WaitDeep__0__WaitLong__0"
    await until(lambda: nest.states(inner, "WaitFor_0"))
    nest.run.stop()
    assert await nest.run.wait() is Result.ON_STOPPED
    assert nest.states(inner) == ["RUNNING", "STOPPING", "STOPPED"]
    assert nest.states("g", f"{name}_0") == ["RUNNING", "STOPPING", "FINISHED"]
    assert nest.states("g") == ["RUNNING", "STOPPING", "STOPPED"]
    await nest.run.close()


@pytest.mark.spec("10.8")
async def test_a_stop_of_the_node_stops_its_graph_and_its_edges_follow() -> None:
    nest = Nest(chain("g", [use("WaitLong", 0), node("NoOp", 1)], conditions=["on_stopped -> run"]))
    nest.run.start()
    await until(lambda: nest.states("g__WaitLong__0", "WaitFor_0"))
    nest.run.end_node("WaitLong_0")
    assert await nest.run.wait() is Result.ON_TRUE
    assert nest.runs["g__WaitLong__0"].state is GraphState.STOPPED


async def test_a_stop_before_the_inner_graph_has_begun_ends_the_node() -> None:
    nest = Nest(chain("g", [use("WaitLong", 0)]))
    nest.run.start()
    nest.run.stop()
    assert await nest.run.wait() is Result.ON_STOPPED
    assert "g__WaitLong__0" not in nest.runs


@pytest.mark.spec("11.2")
async def test_an_inner_node_that_does_not_stop_is_an_error_of_both_graphs() -> None:
    nest = Nest(chain("g", [use("StubbornInside", 0)]), stop_timeout_s=0.02)
    nest.run.start()
    await until(lambda: nest.states("g__StubbornInside__0", "Stubborn_0"))
    await asyncio.sleep(0)
    nest.run.stop()
    assert await nest.run.wait() is Result.ON_ERROR
    assert nest.runs["g__StubbornInside__0"].state is GraphState.ERROR
    assert nest.states("g", "StubbornInside_0") == ["RUNNING", "STOPPING", "ERROR"]
    await nest.run.close()
    assert all(run.idle for run in nest.runs.values())


@pytest.mark.spec("D3", "11.3", "11.3-better")
async def test_a_pause_reaches_the_inner_graph_and_a_resume_too() -> None:
    """D3: on the reference a pause never returns while a sub-graph runs."""
    nest = Nest(chain("g", [use("WaitDeep", 0)]))
    nest.run.start()
    inner = "g__WaitDeep__0__WaitLong__0"
    await until(lambda: nest.states(inner, "WaitFor_0"))
    nest.run.pause()
    assert [run.state for run in nest.runs.values()] == [GraphState.PAUSED] * 3
    assert nest.states("g", "WaitDeep_0") == ["RUNNING", "PAUSED"]
    nest.run.resume()
    assert [run.state for run in nest.runs.values()] == [GraphState.RUNNING] * 3
    assert nest.states("g", "WaitDeep_0") == ["RUNNING", "PAUSED", "RUNNING"]
    await nest.run.close()


@pytest.mark.spec("11.3-better")
async def test_the_outer_graph_is_paused_when_the_inner_one_has_come_to_stand_still() -> None:
    nest = Nest(chain("g", [use("InsistAWhile", 0), node("NoOp", 1)]))
    nest.run.start()
    await until(lambda: nest.states("g__InsistAWhile__0", "Insist_0"))
    nest.run.pause()
    assert nest.states("g", "InsistAWhile_0") == ["RUNNING", "PAUSE_REQUESTED"]
    await until(lambda: nest.run.state is GraphState.PAUSED)
    assert nest.states("g", "InsistAWhile_0") == ["RUNNING", "PAUSE_REQUESTED", "PAUSED"]
    assert nest.states("g__InsistAWhile__0", "NoOp_1") == []
    nest.run.resume()
    assert await nest.run.wait() is Result.ON_TRUE


async def test_an_inner_graph_does_not_begin_during_a_pause() -> None:
    nest = Nest(chain("g", [use("GreetTwice", right="x")]))
    nest.run.start()
    nest.run.pause()
    await asyncio.sleep(0.01)
    assert "g__GreetTwice__0" not in nest.runs
    assert nest.run.state is GraphState.PAUSED
    nest.run.resume()
    assert await nest.run.wait() is Result.ON_TRUE


async def test_an_inner_graph_that_is_paused_by_itself_shows_in_its_node() -> None:
    nest = Nest(chain("g", [use("WaitLong", 0)]))
    nest.run.start()
    await until(lambda: nest.states("g__WaitLong__0", "WaitFor_0"))
    inner = nest.runs["g__WaitLong__0"]
    inner.pause()
    assert nest.states("g", "WaitLong_0")[-1] == "PAUSED"
    inner.resume()
    assert nest.states("g", "WaitLong_0")[-1] == "RUNNING"
    await nest.run.close()


@pytest.mark.spec("D32")
async def test_what_an_inner_graph_left_running_is_stopped_with_the_outer_one() -> None:
    raw = {
        "graph_name": "LeaveOne",
        "graph_entry": [{"name": "NoOp"}, {"name": "WaitFor"}],
        "graph_exit": [{"name": "NoOp"}],
        "actions": [node("NoOp"), node("WaitFor", 0, seconds=60)],
    }
    catalogue = Catalogue(SPECS, [read_graph(raw)])
    nest = Nest(chain("g", [bare("LeaveOne"), node("WaitFor", 1, seconds=60)]), catalogue)
    nest.run.start()
    await until(lambda: nest.states("g", "WaitFor_1"))
    found = nest.runs["g__LeaveOne__0"].snapshot().node("WaitFor_0")
    assert found is not None and found.state is NodeState.RUNNING
    nest.run.stop()
    await until(lambda: nest.runs["g__LeaveOne__0"].idle)
    assert await nest.run.wait() is Result.ON_STOPPED


# -- refusals -----------------------------------------------------------------------------------------------


def codes(raw: dict[str, Any], catalogue: Catalogue = CATALOGUE) -> dict[str, str]:
    return {item.path: item.code for item in check(read_graph(raw), catalogue, actor="A")}


@pytest.mark.spec("10.8", "7.2")
def test_recursion_is_refused() -> None:
    assert codes(chain("g", [bare("First")])) == {
        "actions[0].First.actions[0].Second.actions[0].name": "recursion"
    }


@pytest.mark.spec("7.2")
def test_parameters_of_the_node_must_be_those_of_the_graph() -> None:
    assert codes(chain("g", [bare("GreetTwice")])) == {
        "actions[0].input_parameters.right": "missing_parameter",
        "actions[0].output_parameters.text": "missing_parameter",
    }
    assert codes(chain("g", [use("GreetTwice")])) == {"actions[0].input_parameters.right": "missing_input"}


@pytest.mark.spec("7.2")
def test_what_is_wrong_inside_is_told_with_its_place() -> None:
    inner = chain("Broken", [bare("Unknown")])
    catalogue = Catalogue(SPECS, [read_graph(inner)])
    assert codes(chain("g", [bare("Broken")]), catalogue) == {
        "actions[0].Broken.actions[0].name": "unknown_action"
    }


def test_a_graph_that_has_become_unusable_since_is_the_error_of_its_node() -> None:
    async def play() -> None:
        catalogue = Catalogue(SPECS, CATALOGUE.graphs)
        nest = Nest(
            chain("g", [node("WaitFor", 0, seconds=0.001), use("GreetTwice", 1, right="x")]), catalogue
        )
        nest.run.start()
        catalogue.replace([spec for spec in SPECS if spec.name != "JoinText"], CATALOGUE.graphs)
        assert await nest.run.wait() is Result.ON_ERROR
        assert nest.states("g", "GreetTwice_1") == ["RUNNING", "ERROR"]

    asyncio.run(play())
