"""A server that is killed at a chosen moment; robots' side writes down what it hears.

Run as ``python -m tests.web.killed_server FOLDER MOMENT``: `never`, `kept` (a message is stored, and
goes out now) or `heard` (as soon as a robot got one). The kill is a real one, of this process by itself.
With `deaf` planning is there and takes nothing.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from pathlib import Path

from parley.messages import topics
from parley.messages.chat import PressTaken
from parley.messages.ros import String
from parley.messages.status import ActorStatus
from parley.messages.topics import Topic
from parley.messages.wire import to_string
from parley.transport.base import M, Publisher
from parley.transport.local import LocalTransport
from parley.web import outbox
from parley.web.config import WebConfig
from parley.web.server import WebServer


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


class DiesBeforeSending(LocalTransport):
    """What goes to robots is in the store, and goes out as soon as it is."""

    def publisher(self, topic: Topic[M]) -> Publisher[M]:
        return Dying() if topic.name == topics.CHAT_INPUT.name else super().publisher(topic)


class Dying:
    """An end that nothing leaves."""

    def publish(self, message: object) -> None:
        die()

    def close(self) -> None:
        pass


async def main(folder: Path, moment: str) -> None:
    with (folder / "heard.jsonl").open("a", encoding="utf-8") as heard:

        def hear(message: String) -> None:
            heard.write(message.data.replace("\n", " ") + "\n")
            heard.flush()
            os.fsync(heard.fileno())
            if moment == "heard":
                die()

        async with (DiesBeforeSending if moment == "kept" else LocalTransport)() as transport:
            taken = transport.publisher(topics.PRESS_TAKEN)

            def take(message: String) -> None:
                press = json.loads(message.data)["press"]
                taken.publish(to_string(PressTaken(run="r1", id=f"{press['page']}.{press['number']}")))
                hear(message)

            await transport.subscribe(topics.CHAT_INPUT, hear, depth=1000)
            if moment != "deaf":
                await transport.subscribe(topics.CHAT_ACTION, take, depth=1000)
            async with WebServer(transport, WebConfig(port=0, data_dir=folder)) as server:
                taken.publish(to_string(PressTaken(run="r1")))
                for name in ("Ada", "Bob"):
                    status = ActorStatus.model_validate({"actor": name, "state": "idle"})
                    transport.publisher(topics.ACTOR_STATUS).publish(to_string(status))
                sys.stdout.write(server.url + "\n")
                sys.stdout.flush()
                await asyncio.Event().wait()


if __name__ == "__main__":
    outbox.PRESSED_WITHIN_S = 30.0  # type: ignore[misc]  # the next one may be long in coming, where tests run
    asyncio.run(main(Path(sys.argv[1]), sys.argv[2]))
