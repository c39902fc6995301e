"""Stops from the topic, for robots of this process and of others."""

from __future__ import annotations

import asyncio

from parley.engine.stop_listener import StopListener
from parley.gate.stop_line import StopLine
from parley.messages import ros, topics
from parley.messages.status import ActorStatus, StopCommand
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport
from tests.transport.backends import until

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


async def test_a_copy_of_a_stop_that_comes_late_does_not_undo_its_release() -> None:
    away, engine = StopLine(robots=["Ada"]), StopLine(robots=["Ada"])
    engine.attach("Ada", halt=lambda: None, resume=lambda: None, told=lambda _: None)
    async with LocalTransport() as transport:
        keeper = StopListener(away, transport, lambda _: None)
        own = StopListener(engine, transport, lambda _: None, {"Ada": "Ada"})
        stops, beats = transport.publisher(topics.STOP), transport.publisher(topics.ACTOR_STATUS)
        heard: list[str] = []
        await transport.subscribe(topics.STOP, lambda told: heard.append(told.data))
        away.pull(["Ada"], by=KIM)
        await keeper.open()
        await own.open()
        for _ in range(2):  # it beats twice before it is told to stand
            beats.publish(to_string(ActorStatus(actor="Ada")))
        await until(lambda: len(heard) == 2 and engine.latched("Ada"))
        assert heard[0] == heard[1], "one stop has one name, however often it is told"
        stops.publish(to_string(StopCommand(command="reset", by=KIM, id="r")))
        stops.publish(ros.String(heard[1]))
        stops.publish(to_string(StopCommand(id="new", targets=("Bob",))))
        await until(lambda: away.latched("Bob"))
        assert not engine.latched("Ada")
        stops.publish(to_string(StopCommand(id="another")))
        await until(lambda: engine.latched("Ada"))
        await keeper.close()
        await own.close()
