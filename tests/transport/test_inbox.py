"""Messages that come from threads of their own, as those of a network do."""

from __future__ import annotations

import asyncio
import threading
import time

import pytest

from parley.messages.ros import String
from parley.messages.topics import QoS, Topic
from parley.transport.inbox import Inbox
from tests.transport.backends import until

TOPIC = Topic("threads", String, "std_msgs/msg/String", QoS(depth=3))
KEPT = Topic("kept", String, "std_msgs/msg/String", QoS(depth=3, keep_all=True))


def fail() -> None:
    raise AssertionError("a handler failed")


@pytest.mark.parametrize("topic", [TOPIC, KEPT])
async def test_what_threads_put_in_is_handled_on_the_loop_or_counted_as_dropped(topic: Topic[String]) -> None:
    heard: list[tuple[str, int]] = []
    on = set()

    def handle(message: String) -> None:
        on.add(threading.get_ident())
        name, number = message.data.split()
        heard.append((name, int(number)))

    inbox = Inbox(topic, handle, depth=None, along=None, on_failure=fail)

    def send(name: str) -> None:
        for number in range(2000):
            inbox.put(String(f"{name} {number}"))

    senders = [asyncio.to_thread(send, name) for name in "abc"]
    await asyncio.gather(*senders)
    await until(lambda: len(heard) + inbox.dropped == 6000)
    assert on == {threading.get_ident()}
    for name in "abc":
        numbers = [number for other, number in heard if other == name]
        assert numbers == sorted(numbers)
    assert heard[-1][1] == 1999
    assert (inbox.dropped == 0) == topic.qos.keep_all
    await inbox.close()


async def test_what_comes_after_the_closing_is_not_kept() -> None:
    inbox = Inbox(TOPIC, lambda _: fail(), depth=None, along=None, on_failure=fail)
    await inbox.close()
    await asyncio.to_thread(inbox.put, String("late"))
    assert inbox.dropped == 0
    assert not inbox.pop()


async def test_many_messages_at_once_let_others_in() -> None:
    handled: list[String] = []

    def handle(message: String) -> None:
        time.sleep(0.002)
        handled.append(message)

    inbox = Inbox(KEPT, handle, depth=None, along=None, on_failure=fail)
    for number in range(100):
        inbox.put(String(str(number)))
    turns = 0
    while len(handled) < 100:
        await asyncio.sleep(0)
        turns += 1
    assert turns > 10
    await inbox.close()
