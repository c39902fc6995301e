"""Stops from the topic, for robots of this process and of others."""

from __future__ import annotations

import asyncio

from parley.engine.stop_listener import StopListener
from parley.gate.stop_line import StopLine
from parley.messages import topics
from parley.messages.status import ActorStatus, StopCommand
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport

from .rig import KIM


async def test_a_robot_of_another_process_that_was_away_is_stopped_when_it_is_heard_again() -> None:
    line, heard = StopLine(), asyncio.Queue[StopCommand]()
    async with LocalTransport() as transport:
        listener = StopListener(line, transport, lambda problems: None)
        await listener.open()
        await transport.subscribe(
            topics.STOP, lambda message: heard.put_nowait(decode(StopCommand, message.data))
        )
        beats = transport.publisher(topics.ACTOR_STATUS)
        beats.publish(to_string(ActorStatus(actor="Bob")))
        line.pull(["Ada"], by=KIM)
        beats.publish(to_string(ActorStatus(actor="Ada", state="running")))
        again = await asyncio.wait_for(heard.get(), 5)
        assert (again.command, again.targets) == ("stop", ("Ada",))
        beats.publish(to_string(ActorStatus(actor="Ada", state="stopped")))
        line.reset(by=KIM)
        beats.publish(to_string(ActorStatus(actor="Ada", state="idle")))
        await asyncio.sleep(0.05)
        assert heard.empty()
        await listener.close()
