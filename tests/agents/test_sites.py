"""Who waits for what a robot tells of where it is."""

from __future__ import annotations

import asyncio

from parley.agents.sites import Sites
from parley.messages import topics
from parley.messages.status import ActorStatus
from parley.messages.wire import to_string
from parley.transport.local import LocalTransport


async def test_nobody_waits_for_a_robot_whose_engine_never_tells_where_it_is() -> None:
    async with LocalTransport() as transport, Sites(transport, lambda *_: None) as sites:
        beats = transport.publisher(topics.ACTOR_STATUS)
        for status in (ActorStatus(actor="Z", engine="temoto"), ActorStatus(actor="A")):
            beats.publish(to_string(status))
        waiting = asyncio.create_task(sites.known("A"))
        await asyncio.sleep(0.05)
        assert not waiting.done(), "the heartbeats were heard"
        async with asyncio.timeout(1.0):
            await sites.soon("Z")
            assert await sites.known("Z") is None
        waiting.cancel()
