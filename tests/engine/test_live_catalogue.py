"""An engine follows its catalogue while it runs, and refuses what its robot cannot do."""

from __future__ import annotations

import json
from typing import Any

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.messages import ros, topics
from parley.transport.local import LocalTransport
from parley.umrf.action import Action, RunHandle, action
from parley.umrf.catalogue import Catalogue
from tests.umrf.spec_actions import join_text

from .rig import DummyRobot, Rig


@action(capabilities=("arm",))
async def grasp(ctx: RunHandle) -> None:
    """Needs an arm."""


@action
async def glance(ctx: RunHandle) -> None:
    """Need nothing."""


async def test_heartbeats_follow_the_catalogue_and_what_a_robot_lacks_is_neither_told_nor_done() -> None:
    catalogue, robot = Catalogue([join_text.spec]), DummyRobot()
    async with LocalTransport() as transport:
        rig = Rig(transport, robot)
        await rig.listen()
        async with ActionEngine(
            "A", transport=transport, catalogue=catalogue, clock=WallClock(), robot=robot, heartbeat_s=0.02,
            make_context=lambda handle: handle,
        ):  # fmt: skip
            await rig.until(lambda: rig.statuses)
            assert [info.name for info in rig.statuses[-1].catalogue] == ["JoinText"]
            catalogue.replace([grasp.spec, glance.spec])
            await rig.until(lambda: [info.name for info in rig.statuses[-1].catalogue] == ["Glance"])
            graph = {"graph_name": "g", "actions": [{"name": "Grasp", "type": "sync"}]}
            start = transport.publisher(topics.GRAPH_START)
            start.publish(ros.UmrfGraphStart("", json.dumps(graph), ("A",)))
            await rig.until(lambda: rig.rejections)
    assert [problem.code for problem in rig.rejections[0].problems] == ["not_capable"]
    assert rig.events == []


async def test_a_graph_that_is_known_by_content_has_its_own_name_and_data_and_follows_the_catalogue() -> None:
    seen: list[str] = []

    def visit(who: str) -> Action[..., Any]:
        @action(name="Visit")
        async def visit(ctx: RunHandle, doors: list[str]) -> None:
            seen.append(f"{who} {ctx.graph_name} {doors}")
            doors.pop()
            if ctx.graph_name == "second" and len(seen) == 2:
                raise ConnectionError

        return visit

    doors = {"doors": {"pvf_type": "strings", "pvf_value": ["red", "blue"]}}
    node = {"name": "Visit", "type": "sync", "input_parameters": doors, "parley": {"retries": 1}}
    catalogue = Catalogue([visit("old").spec])
    async with LocalTransport() as transport:
        rig = Rig(transport, DummyRobot())
        await rig.listen()
        async with ActionEngine(
            "A", transport=transport, catalogue=catalogue, clock=WallClock(), make_context=lambda run: run
        ):
            for name in ("first", "second", "third"):
                if name == "third":
                    catalogue.replace([visit("new").spec])
                graph = {"graph_name": name, "actions": [node]}
                start = transport.publisher(topics.GRAPH_START)
                start.publish(ros.UmrfGraphStart("", json.dumps(graph), ("A",)))
                await rig.until(lambda: [e.state for e in rig.events].count("FINISHED") == 2)
                rig.events.clear()
    both = "['red', 'blue']"
    assert seen == [f"{who} {both}" for who in ("old first", "old second", "old second", "new third")]
