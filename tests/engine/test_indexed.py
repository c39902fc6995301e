"""Indexed graphs on the engine's topics: started by name, used inside others, queried, re-indexed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from parley.errors import GraphRefusedError
from parley.messages import ros, topics
from parley.umrf.catalogue import Catalogue
from parley.umrf.discovery import ActionFolder
from parley.umrf.model import Result
from tests.umrf.inner_graphs import CATALOGUE, greet_twice, use
from tests.umrf.spec_actions import SPECS, chain, node

from .rig import engine_of, rigged


@pytest.mark.spec("7.1")
def test_graph_files_are_found_two_levels_deep_and_bad_ones_are_skipped(tmp_path: Path) -> None:
    for place, name in (("a.graph.json", "A"), ("x/b.umrf.graph.json", "B"), ("x/y/c.graph.json", "C")):
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / place).write_text(json.dumps(chain(name, [node("NoOp")])))
    (tmp_path / "x" / "y" / "z").mkdir()
    (tmp_path / "x" / "y" / "z" / "d.graph.json").write_text(json.dumps(chain("D", [node("NoOp")])))
    (tmp_path / "broken.graph.json").write_text("{")
    (tmp_path / "twice.graph.json").write_text(json.dumps(chain("A", [node("NoOp", 7)])))
    (tmp_path / "latin.graph.json").write_bytes(b"\xff")
    index = ActionFolder(tmp_path)
    index.scan()
    graphs = index.found.graphs
    assert sorted(graph.name for graph in graphs) == ["A", "B", "C"]
    assert graphs[0].nodes[0].instance_id == 0, "of two graphs of one name the first counts"
    told = {text.partition(" ")[0] for text in index.found.problems}
    assert told == {"broken.graph.json", "latin.graph.json", "twice.graph.json:"}


@pytest.mark.spec("11.1", "7.1")
async def test_a_graph_is_started_by_its_name() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start_indexed("SayFalse")
        await rig.until_graph("SayFalse", "FINISHED")
        assert rig.events[-1].result == "on_false"


@pytest.mark.spec("11.1", "D33", "W2", "12.5-better")
async def test_an_unknown_name_is_refused_for_what_it_is() -> None:
    """D33: the reference says "cannot stop … doesn't exist" instead."""
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start_indexed("Nowhere")
        await rig.until(lambda: rig.rejections)
        [problem] = rig.rejections[0].problems
        assert (problem.code, problem.message) == ("unknown_graph", "there is no indexed graph 'Nowhere'")
        assert "SayFalse" in problem.remedy


@pytest.mark.spec("6-better")
async def test_an_indexed_graph_without_its_inputs_is_refused_and_names_them() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start_indexed("GreetTwice")
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "missing_input"
        assert "right" in rig.rejections[0].problems[0].message


@pytest.mark.spec("6", "10.2")
async def test_from_inside_a_process_graphs_are_started_with_parameters() -> None:
    async with rigged() as rig, engine_of("B", rig, catalogue=CATALOGUE) as engine:
        run = engine.start("GreetTwice", {"right": "you"})
        assert await run.wait() is Result.ON_TRUE
        assert run.exit_values() == {"text": "hello-you-again"}
        with pytest.raises(GraphRefusedError):
            engine.start("Nowhere")


@pytest.mark.spec("7.2")
async def test_a_graph_may_not_take_the_name_of_an_indexed_one() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        taken = chain("SayFalse", [node("NoOp")])
        rig.start(taken)
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "indexed_name"
        rig.start_indexed("SayFalse")
        await rig.until_graph("SayFalse", "FINISHED")
        rig.start(taken)  # a graph of that name exists already
        await rig.until(lambda: rig.graph_states("SayFalse") == ["RUNNING", "FINISHED"] * 2)


@pytest.mark.spec("12.4", "8.2")
async def test_the_query_service_lists_indexed_and_inner_graphs() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start(chain("g", [use("GreetTwice", right="x")]))
        await rig.until_graph("g", "FINISHED")
        found = await rig.transport.call(topics.actor_graph_get("A"), ros.UmrfGraphGetRequest(), timeout_s=5)
        indexed = {json.loads(text)["graph_name"]: json.loads(text) for text in found.graph_jsons_indexed}
        assert indexed["GreetTwice"]["graph_state"] == "INITIALIZED"
        running = [json.loads(text)["graph_name"] for text in found.graph_jsons_running]
        assert running == ["g", "g__GreetTwice__0"]


@pytest.mark.spec("1", "10.8", "12.5")
async def test_inner_graphs_have_feedback_and_events_of_their_own() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start(chain("g", [use("GreetTwice", right="x")]))
        await rig.until_graph("g", "FINISHED")
        inner = [item for item in rig.events if item.graph_name == "g__GreetTwice__0"]
        assert [item.sequence for item in inner] == list(range(6))
        await rig.until(lambda: rig.last_feedback("g__GreetTwice__0")["graph_state"] == "FINISHED")


async def test_inner_graphs_can_be_commanded_by_their_names() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start(chain("g", [use("WaitLong"), node("NoOp", 1)], conditions=["on_stopped -> run"]))
        await rig.until(lambda: rig.node_states("g__WaitLong__0", "WaitFor_0"))
        rig.stop("g__WaitLong__0")
        await rig.until_graph("g", "FINISHED")
        assert rig.graph_states("g__WaitLong__0") == ["RUNNING", "STOPPING", "STOPPED"]


async def test_a_graph_of_the_user_in_the_way_is_the_error_of_the_node() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start(chain("g__GreetTwice__0", [node("WaitFor", 0, seconds=60)]))
        rig.start(chain("g", [use("GreetTwice", right="x")]))
        await rig.until_graph("g", "FINISHED")
        assert rig.node_states("g", "GreetTwice_0") == ["RUNNING", "ERROR"]
        assert rig.graph_states("g__GreetTwice__0") == ["RUNNING"]


async def test_old_inner_graphs_are_forgotten_with_the_others() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        for index in range(30):
            rig.start(chain(f"g{index}", [use("RunDry")]))
            await rig.until_graph(f"g{index}", "FINISHED")
        found = await rig.transport.call(topics.GRAPH_GET, ros.UmrfGraphGetRequest(), timeout_s=5)
        assert len(found.graph_jsons_running) <= 22


async def test_the_emergency_stop_holds_what_runs_inside() -> None:
    async with rigged(catalogue=CATALOGUE) as rig:
        rig.start(chain("g", [use("WaitLong")]))
        await rig.until(lambda: rig.node_states("g__WaitLong__0", "WaitFor_0"))
        rig.emergency("stop")
        await rig.until_graph("g", "PAUSED")
        assert rig.graph_states("g__WaitLong__0") == ["RUNNING", "PAUSED"]
        rig.resume("g__WaitLong__0")
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "stop_latched"


@pytest.mark.spec("D34", "7.1")
async def test_the_index_may_change_while_graphs_run() -> None:
    """D34: the reference's indexer hands out references to lists that its thread rebuilds."""
    catalogue = Catalogue(SPECS)
    async with rigged(catalogue=catalogue) as rig:
        rig.start_indexed("Late")
        await rig.until(lambda: rig.rejections)
        catalogue.replace(SPECS, [graph for graph in CATALOGUE.graphs if graph.name == "WaitLong"])
        rig.start(chain("g", [use("WaitLong")]))
        await rig.until(lambda: rig.node_states("g__WaitLong__0", "WaitFor_0"))
        catalogue.replace([], [])
        rig.stop("g")
        await rig.until_graph("g", "STOPPED")
        rig.start(chain("h", [use("WaitLong")]))
        await rig.until(lambda: len(rig.rejections) == 2)
        assert rig.rejections[1].problems[0].code == "unknown_action"


def test_indexed_graphs_are_among_what_an_actor_can_do() -> None:
    [info] = [item for item in CATALOGUE.infos() if item.name == "GreetTwice"]
    assert (info.inputs, info.outputs) == ({"right": "string"}, {"text": "string"})
    assert greet_twice()["graph_name"] == info.name
