"""A mission as one graph of several actors, which their engines carry out."""

from __future__ import annotations

import json

from parley.agents.planner.mission_graph import mission_graph
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.messages.team import MissionInfo, MissionPart
from parley.umrf.io import write_graph
from parley.umrf.show import show
from tests.engine.rig import engine_of, rigged


def waits(seconds: float) -> ActionCall:
    given, waited = {"seconds": Parameter("number", seconds)}, {"waited": Parameter("number")}
    return ActionCall(name="WaitFor", input_parameters=given, output_parameters=waited)


def part(robot: str, *steps: ActionCall, after: tuple[str, ...] = (), **more: str) -> MissionPart:
    return MissionPart(robot=robot, order=robot, steps=steps, after=after, **more)


def mission(*parts: MissionPart) -> MissionInfo:
    return MissionInfo(id="m", words="A and C open the way, B follows", parts=parts)


async def test_engines_that_get_it_keep_each_part_behind_those_it_waits_for() -> None:
    graph = mission_graph(
        mission(
            part("A", waits(0.02), waits(0.02)),
            part("B", waits(0.001), ActionCall(name="NoOp"), after=("A", "C")),
            part("C", waits(0.001)),
            part("B", waits(0.001), instead_of="A"),
        )
    )
    assert [node.actor for node in graph.nodes] == ["A", "A", "B", "B", "C"], "as it was ordered"
    assert "• WaitFor_2 @B  (waits for WaitFor_1, WaitFor_4)" in show(graph, "text")
    async with rigged(heartbeat_s=0.02) as rig, engine_of("B", rig), engine_of("C", rig):
        rig.start(json.loads(write_graph(graph)), ("A", "B", "C"))
        for actor in ("A", "B", "C"):
            await rig.until_graph("mission_m", "FINISHED", actor)
        ran = [(e.node, e.state) for e in rig.events if e.actor == "B" and e.kind == "node"]
        begun = ran.index(("WaitFor_2", "RUNNING"))
        assert {("WaitFor_1", "FINISHED"), ("WaitFor_4", "FINISHED")} <= {*ran[:begun]}
        assert ("NoOp_3", "FINISHED") in ran[begun:]
        assert not rig.rejections
