"""Notices wait for a listener, and each is said once."""

from __future__ import annotations

import asyncio

from parley.agents.notices import Notices
from parley.messages import topics
from parley.messages.ros import String
from parley.transport.local import LocalTransport


async def test_what_was_told_before_anybody_listened_is_said_when_somebody_does() -> None:
    heard: list[str] = []

    def listen(message: String) -> None:
        heard.append(message.data)

    async with LocalTransport() as transport:
        await transport.subscribe(topics.CHAT_FEEDBACK, lambda _: None)  # a part of the system, no person
        async with Notices(transport) as notices:
            notices.tell("first", ["A"])
            await transport.subscribe(topics.CHAT_FEEDBACK, listen)
            notices.tell("second", ["A"], "error")
            await asyncio.sleep(0.05)
    assert len(heard) == 2
    assert "first" in heard[0]
    assert "second" in heard[1]
