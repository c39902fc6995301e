"""An engine follows its catalogue while it runs, and refuses what its robot cannot do."""

from __future__ import annotations

import json

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.messages import ros, topics
from parley.transport.local import LocalTransport
from parley.umrf.action import RunHandle, action
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
