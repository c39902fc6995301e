"""What the reference's ROS wrapper gets wrong (W..) and other programs would notice."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from typer.testing import CliRunner

from parley.cli import command_line
from parley.errors import UnavailableError
from parley.messages import ros, topics
from parley.messages.ros import UmrfGraphModify, UmrfGraphResume, UmrfGraphStart, UmrfGraphStop
from parley.umrf.action import Outcome, RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph, write_graph
from tests.umrf.spec_actions import chain, node, planner_chain

from .rig import engine_of, rigged


@pytest.mark.spec("W8", "11.5")
async def test_the_name_in_the_graph_counts_for_a_modify() -> None:
    async with rigged() as rig:
        first = [node("WaitFor", 0, seconds=0.02)]
        rig.start(planner_chain("g", first))
        await rig.until_graph("g", "RUNNING")
        longer = planner_chain("g", [*first, node("NoOp", 1)])
        rig.transport.publisher(topics.GRAPH_MODIFY).publish(
            ros.UmrfGraphModify(
                umrf_graph_name="another",
                modified_graph=write_graph(read_graph(longer), faithful=True),
                targets=("A",),
            )
        )
        await rig.until_node("g", "NoOp_1", ["RUNNING", "FINISHED"])


@pytest.mark.spec("W9")
async def test_a_second_engine_of_one_name_is_refused_in_words_and_leaves_nothing_open() -> None:
    async with rigged() as rig:
        ends = rig.transport.endpoints()
        with pytest.raises(UnavailableError, match="answered already"):
            async with engine_of("A", rig):
                pass
        assert rig.transport.endpoints() == ends
        rig.start(chain("g", [node("NoOp")]))
        await rig.until_graph("g", "FINISHED")


@pytest.mark.spec("W10", "12.4")
@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        (UmrfGraphStart, {"umrf_graph_name", "umrf_graph_json", "targets", "name_match_required"}),
        (UmrfGraphStop, {"umrf_graph_name", "targets"}),
        (UmrfGraphResume, {"umrf_graph_name", "targets"}),
        (UmrfGraphModify, {"umrf_graph_name", "targets", "modified_graph", "continue_from"}),
        (ros.UmrfGraphFeedback, {"actor", "history"}),
    ],
)
def test_the_messages_have_the_fields_of_the_contract(kind: Any, fields: set[str]) -> None:
    """W10: the reference's README fills a field that no longer exists."""
    assert set(kind.__dataclass_fields__) == fields


@pytest.mark.spec("W11")
@pytest.mark.parametrize("command", [["graph", "check"], ["bench", "engine"], ["actions", "list"]])
def test_an_argument_that_nobody_knows_is_named_instead_of_ending_in_an_exception(
    command: list[str],
) -> None:
    found = CliRunner().invoke(command_line(), [*command, "--ros-args"])
    assert found.exit_code == 2
    assert "--ros-args" in found.output


@pytest.mark.spec("D23")
@pytest.mark.parametrize("value", [float("nan"), float("inf"), "no number"])
async def test_outputs_that_json_cannot_hold_are_the_error_of_their_node(value: Any) -> None:
    @action(inputs={}, outputs={"size": "number"})
    async def give(ctx: RunHandle) -> Outcome:
        ctx.log("half \ud800")
        return Outcome(outputs={"size": value})

    giver = {"name": "Give", "type": "sync", "output_parameters": {"size": {"pvf_type": "number"}}}
    async with rigged(catalogue=Catalogue([give.spec])) as rig:
        rig.start({"graph_name": "g", "actions": [giver]})
        await rig.until_graph("g", "FINISHED")
        assert rig.node_states("g", "Give_0") == ["RUNNING", "ERROR"]
        await rig.until(lambda: rig.last_feedback("g")["graph_state"] == "FINISHED")


@pytest.mark.spec("4.2", "10.6")
async def test_every_native_type_of_output_is_told_as_such() -> None:
    values = {"words": ["a", "b"], "flags": [True], "size": 1.5, "sizes": [1.0], "name": "a", "flag": False}
    kinds = {
        "words": "strings", "flags": "bools", "size": "number", "sizes": "numbers", "name": "string",
        "flag": "bool",
    }  # fmt: skip

    @action(inputs={}, outputs=kinds)
    async def give(ctx: RunHandle) -> Outcome:
        return Outcome(outputs=values, facts={f"{name}_seen": value for name, value in values.items()})

    outputs = {name: {"pvf_type": kind} for name, kind in kinds.items()}
    async with rigged(catalogue=Catalogue([give.spec])) as rig:
        rig.start(
            {"graph_name": "g", "actions": [{"name": "Give", "type": "sync", "output_parameters": outputs}]}
        )
        await rig.until_graph("g", "FINISHED")
        [end] = [item for item in rig.events if item.node == "Give_0" and item.result]
        told = {name: (item.type, item.value) for name, item in end.outputs.items()}
        assert told == {
            name + ending: (kinds[name], value) for name, value in values.items() for ending in ("", "_seen")
        }


@pytest.mark.spec("D2", "D14")
@pytest.mark.parametrize("name", ["NoOp", "InThread"])
async def test_a_hundred_graphs_at_once_all_end(name: str) -> None:
    values = {"text": "x"} if name == "InThread" else {}
    async with rigged() as rig:
        for index in range(100):
            rig.start(chain(f"g{index}", [node(name, 0, **values), node("NoOp", 1)]))
            await asyncio.sleep(0)
        await rig.until(lambda: [item.state for item in rig.events].count("FINISHED") == 300)
        assert {tuple(rig.graph_states(f"g{index}")) for index in range(100)} == {("RUNNING", "FINISHED")}
