"""A process of its own at the other end of a network, for tests that kill, freeze or drop it."""

from __future__ import annotations

import asyncio
import sys

from parley.config import NetworkSettings
from parley.messages.ros import ChatRequest, ChatResponse, String
from parley.messages.topics import QoS, Service, Topic
from parley.transport.zenoh import ZenohTransport

ECHO = Service("peer/echo", ChatRequest, ChatResponse, "nl_interface_msgs/srv/Chat")
HELLO = Topic("peer/hello", String, "std_msgs/msg/String", QoS(latched=True, depth=1))
TALK = Topic("peer/talk", String, "std_msgs/msg/String", QoS(depth=100))
STOP = Topic("peer/stop", String, "std_msgs/msg/String", QoS(keep_all=True))


async def main(how: str, at: str) -> None:
    """Listen or connect, say hello, and echo; or connect and `drop`: end without closing."""
    listen, connect = ((at,), ()) if how == "listen" else ((), (at,))
    transport = ZenohTransport(NetworkSettings(listen=listen, connect=connect, interface="", silence_s=1.0))
    await transport.__aenter__()
    heard: list[str] = []
    enough = asyncio.Event()

    def hear(message: String) -> None:
        heard.append(message.data)
        if how == "drop" and len(heard) == 100:  # in the midst of a stream
            enough.set()

    async def echo(request: ChatRequest) -> ChatResponse:
        if request.message == "hang":
            await asyncio.Event().wait()
        return ChatResponse(f"{request.message} {len(heard)}")

    await transport.subscribe(TALK, hear)
    await transport.serve(ECHO, echo)
    transport.publisher(HELLO).publish(String("hello"))
    await enough.wait()


if __name__ == "__main__":
    rubbish = [[number] for number in range(500_000)]  # so that it takes a moment to end
    asyncio.run(main(*sys.argv[1:]))
