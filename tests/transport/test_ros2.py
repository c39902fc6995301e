"""What only nodes of ROS have to mind, where ROS is sourced."""

from __future__ import annotations

import asyncio

from structlog.testing import capture_logs

from parley.messages.ros import String
from tests.transport.backends import NEEDS_ROS, ros2_node, until
from tests.transport.peer import TALK

pytestmark = [*NEEDS_ROS]


async def test_ends_that_close_while_ros_waits_for_them_are_no_error() -> None:
    async with ros2_node("closes", look_s=0.1) as here, ros2_node("stays", look_s=0.1) as there:
        heard: list[str] = []
        kept = await there.subscribe(TALK, lambda told: heard.append(told.data))
        publisher = here.publisher(TALK)
        await until(lambda: here.node.count_subscribers(TALK.name) and here.meets_all())
        with capture_logs() as logs:
            for _ in range(10):
                closing = [await there.subscribe(TALK, lambda _: None) for _ in range(20)]
                for end in closing:
                    publisher.publish(String("on and on"))
                    await asyncio.sleep(0)
                    await end.close()
            publisher.publish(String("after that"))
            await until(lambda: heard[-1:] == ["after that"])
        await kept.close()
        assert [entry for entry in logs if entry["log_level"] == "error"] == []
