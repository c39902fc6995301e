"""Who hears reports is served behind what their sender does now; who hears anything else, at once."""

from __future__ import annotations

import asyncio

import pytest

from parley.messages import topics
from parley.messages.ros import String
from parley.messages.topics import Topic
from parley.transport.local import LocalTransport


@pytest.mark.parametrize(
    ("topic", "order"), [(topics.GRAPH_EVENTS, ["began", "heard"]), (topics.STEP, ["heard", "began"])]
)
async def test_the_next_step_begins_before_transitions_are_heard(
    topic: Topic[String], order: list[str]
) -> None:
    done: list[str] = []

    async def step() -> None:
        done.append("began")

    async with LocalTransport() as transport:
        await transport.subscribe(topic, lambda _: done.append("heard"))
        await asyncio.sleep(0)
        transport.publisher(topic).publish(String("over"))
        next_step = asyncio.create_task(step())
        for _ in range(5):
            await asyncio.sleep(0)
        await next_step
    assert done == order
