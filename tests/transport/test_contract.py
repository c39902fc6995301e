"""What every transport backend promises (`parley.transport.base`), run against each of them."""

from __future__ import annotations

import asyncio
import gc
from typing import Any

import pytest
import structlog

from parley.errors import (
    ParleyError,
    TransportError,
    TransportTimeoutError,
    TypeMismatchError,
    UnavailableError,
)
from parley.messages.ros import ChatRequest, ChatResponse, String
from parley.messages.topics import QoS, Service, Topic
from parley.transport.base import Endpoint, Transport
from parley.transport.local import LocalTransport
from tests.transport.backends import BACKENDS, Network, each, until

PLAIN = Topic("contract/plain", String, "std_msgs/msg/String", QoS(depth=100))
SHALLOW = Topic("contract/shallow", String, "std_msgs/msg/String", QoS(depth=3))
KEPT = Topic("contract/kept", String, "std_msgs/msg/String", QoS(depth=3, keep_all=True))
LATCHED = Topic("contract/latched", String, "std_msgs/msg/String", QoS(latched=True, depth=1))
ECHO = Service("contract/echo", ChatRequest, ChatResponse, "nl_interface_msgs/srv/Chat")


async def echo(request: ChatRequest) -> ChatResponse:
    return ChatResponse(f"you said {request.message}")


async def serve_echo(network: Network) -> None:
    await network.there.serve(ECHO, echo)
    await until(lambda: serves(network.here, ECHO))


def serves(transport: Transport, service: Service[ChatRequest, ChatResponse]) -> bool:
    return Endpoint(f"/{service.name}", service.ros_type, "server") in transport.endpoints()


# Publish and subscribe


async def test_messages_arrive_whole_once_and_in_the_order_they_were_sent(network: Network) -> None:
    heard: list[String] = []
    await network.there.subscribe(PLAIN, heard.append)
    sender = network.here.publisher(PLAIN)
    sent = [
        String(text) for text in ("", "plain", "ñandú 机器人 🤖", '{"json": "\\u0000"}', *map(str, range(50)))
    ]
    for message in sent:
        sender.publish(message)
    await until(lambda: len(heard) >= len(sent))
    assert heard == sent


@pytest.mark.parametrize("repeats", [False, True])
async def test_what_is_said_twice_is_heard_twice(network: Network, *, repeats: bool) -> None:
    topic, heard = Topic("contract/twice", String, PLAIN.ros_type, QoS(depth=100, repeats=repeats)), []
    taken = await network.there.subscribe(topic, lambda message: heard.append(message.data))
    sender = network.here.publisher(topic)
    said = ["yes", "yes", "no", "yes", "end"]
    for text in said:
        sender.publish(String(text))
    await until(lambda: "end" in heard)
    assert (heard, taken.dropped) == (said, 0)


async def test_every_subscriber_gets_every_message(network: Network) -> None:
    heard: tuple[list[String], list[String], list[String]] = ([], [], [])
    for inbox in heard:
        await network.there.subscribe(PLAIN, inbox.append)
    network.here.publisher(PLAIN).publish(String("to all"))
    await until(lambda: all(heard))
    assert [list(inbox) for inbox in heard] == [[String("to all")]] * 3


async def test_several_publishers_share_a_topic(network: Network) -> None:
    heard: list[str] = []
    await network.there.subscribe(PLAIN, lambda message: heard.append(message.data))
    for text in "abc":
        network.here.publisher(PLAIN).publish(String(text))
    await until(lambda: len(heard) == 3)
    assert sorted(heard) == ["a", "b", "c"]


async def test_publishing_without_a_subscriber_is_fine(network: Network) -> None:
    network.here.publisher(PLAIN).publish(String("into the void"))


async def test_async_handlers_take_one_message_after_the_other(network: Network) -> None:
    log: list[str] = []

    async def handle(message: String) -> None:
        log.append(f"{message.data} starts")
        await asyncio.sleep(0.002)
        log.append(f"{message.data} ends")

    await network.there.subscribe(PLAIN, handle)
    sender = network.here.publisher(PLAIN)
    for text in "ab":
        sender.publish(String(text))
    await until(lambda: len(log) == 4)
    assert log == ["a starts", "a ends", "b starts", "b ends"]


async def test_names_with_and_without_the_leading_slash_are_the_same(network: Network) -> None:
    heard: list[String] = []
    absolute = Topic(f"/{PLAIN.name}", String, PLAIN.ros_type, PLAIN.qos)
    await network.there.subscribe(absolute, heard.append)
    network.here.publisher(PLAIN).publish(String("x"))
    await until(lambda: heard)


async def test_a_late_subscriber_gets_the_last_message_of_a_latched_topic_and_then_new_ones(
    network: Network,
) -> None:
    early: list[str] = []
    heard: list[str] = []
    await network.there.subscribe(LATCHED, lambda message: early.append(message.data))
    sender = network.here.publisher(LATCHED)
    sender.publish(String("old"))
    sender.publish(String("last"))
    await until(lambda: "last" in early)  # sent, and not only on its way
    await network.there.subscribe(LATCHED, lambda message: heard.append(message.data))
    await until(lambda: heard)
    sender.publish(String("new"))
    await until(lambda: len(heard) > 1)
    assert heard == ["last", "new"]


async def test_a_late_subscriber_gets_nothing_old_from_other_topics(network: Network) -> None:
    early: list[str] = []
    heard: list[str] = []
    await network.there.subscribe(PLAIN, lambda message: early.append(message.data))
    sender = network.here.publisher(PLAIN)
    sender.publish(String("old"))
    await until(lambda: early)
    await network.there.subscribe(PLAIN, lambda message: heard.append(message.data))
    sender.publish(String("new"))
    await until(lambda: heard)
    assert heard == ["new"]


@pytest.mark.parametrize("depth", [None, 5])
async def test_a_slow_subscriber_loses_the_oldest_messages_and_knows_how_many(
    network: Network, depth: int | None
) -> None:
    kept = depth or SHALLOW.qos.depth
    heard: list[int] = []
    gate = asyncio.Event()

    async def slow(message: String) -> None:
        heard.append(int(message.data))
        await gate.wait()

    subscription = await network.there.subscribe(SHALLOW, slow, depth=depth)
    sender = network.here.publisher(SHALLOW)
    sender.publish(String("0"))
    await until(lambda: heard)
    for number in range(1, kept + 5):
        sender.publish(String(str(number)))
    await until(lambda: subscription.dropped == 4)
    gate.set()
    await until(lambda: len(heard) == kept + 1)
    assert heard == [0, *range(5, kept + 5)]
    assert subscription.dropped == 4


async def test_what_is_dropped_is_told_in_the_log_with_a_count() -> None:
    with structlog.testing.capture_logs() as logged:
        async with LocalTransport() as transport:
            subscription = await transport.subscribe(SHALLOW, lambda _: None, depth=1)
            sender = transport.publisher(SHALLOW)
            for number in range(10):
                sender.publish(String(str(number)))
            assert subscription.dropped == 9
    told = [line["dropped"] for line in logged if line["log_level"] == "warning"]
    assert told == [1, 2, 4, 8]


async def test_of_a_topic_that_keeps_all_a_slow_subscriber_loses_nothing(network: Network) -> None:
    heard: list[int] = []
    gate = asyncio.Event()

    async def slow(message: String) -> None:
        heard.append(int(message.data))
        await gate.wait()

    subscription = await network.there.subscribe(KEPT, slow, depth=2)
    sender = network.here.publisher(KEPT)
    for number in range(1000):
        sender.publish(String(str(number)))
    await until(lambda: heard)
    gate.set()
    await until(lambda: len(heard) == 1000)
    assert heard == list(range(1000))
    assert subscription.dropped == 0


async def test_publishing_returns_at_once_and_a_hung_subscriber_delays_no_other(network: Network) -> None:
    heard: list[String] = []

    async def hang(_: String) -> None:
        await asyncio.Event().wait()

    await network.there.subscribe(PLAIN, hang)
    await network.there.subscribe(PLAIN, heard.append)
    sender = network.here.publisher(PLAIN)
    for number in range(50):
        sender.publish(String(str(number)))
    assert heard == []
    await until(lambda: len(heard) == 50)


async def test_a_handler_that_raises_gets_the_next_message_all_the_same(network: Network) -> None:
    heard: list[str] = []

    async def fail(message: String) -> None:
        heard.append(message.data)
        if message.data == "cancelled":
            lost: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            lost.cancel()
            await lost
        raise ValueError("a defect of the handler")

    await network.there.subscribe(PLAIN, fail)
    sender = network.here.publisher(PLAIN)
    for text in ("raises", "cancelled", "last"):
        sender.publish(String(text))
    await until(lambda: len(heard) == 3)
    assert heard == ["raises", "cancelled", "last"]


async def test_a_closed_subscription_hears_nothing_more(network: Network) -> None:
    closed: list[str] = []
    open_: list[str] = []
    subscription = await network.there.subscribe(PLAIN, lambda message: closed.append(message.data))
    await network.there.subscribe(PLAIN, lambda message: open_.append(message.data))
    sender = network.here.publisher(PLAIN)
    sender.publish(String("before"))
    await until(lambda: closed and open_)
    await subscription.close()
    await subscription.close()
    sender.publish(String("after"))
    await until(lambda: len(open_) == 2)
    assert closed == ["before"]


async def test_a_handler_may_close_its_own_subscription(network: Network) -> None:
    heard: list[str] = []
    others: list[str] = []

    async def once(message: String) -> None:
        heard.append(message.data)
        await subscription.close()

    subscription = await network.there.subscribe(PLAIN, once)
    await network.there.subscribe(PLAIN, lambda message: others.append(message.data))
    sender = network.here.publisher(PLAIN)
    sender.publish(String("first"))
    await until(lambda: others)
    sender.publish(String("second"))
    await until(lambda: len(others) == 2)
    assert heard == ["first"]


async def test_subscriptions_along_each_other_keep_the_order_and_one_that_is_closed_holds_up_no_other() -> (
    None
):
    heard: list[str] = []

    async def hang(message: String) -> None:
        heard.append(message.data)
        await asyncio.Event().wait()

    async with LocalTransport() as transport:
        first = await transport.subscribe(PLAIN, lambda message: heard.append(message.data))
        other = Topic("other", String, PLAIN.ros_type, PLAIN.qos)
        await transport.subscribe(other, lambda message: heard.append(message.data), along=first)
        third = Topic("third", String, PLAIN.ros_type, PLAIN.qos)
        hung = await transport.subscribe(third, hang, along=first)
        for number, topic in enumerate((PLAIN, other, PLAIN, third, other)):
            transport.publisher(topic).publish(String(str(number)))
        await until(lambda: len(heard) == 4)
        await hung.close()
        await until(lambda: len(heard) == 5)
    assert heard == ["0", "1", "2", "3", "4"]


async def test_a_closed_publisher_sends_nothing_more(network: Network) -> None:
    heard: list[str] = []
    await network.there.subscribe(PLAIN, lambda message: heard.append(message.data))
    closed, open_ = network.here.publisher(PLAIN), network.here.publisher(PLAIN)
    closed.close()
    closed.close()
    closed.publish(String("closed"))
    open_.publish(String("open"))
    await until(lambda: heard)
    assert heard == ["open"]


# Types


async def test_one_name_with_two_types_is_refused_naming_both(network: Network) -> None:
    other = Topic(PLAIN.name, ChatRequest, "nl_interface_msgs/msg/Other")
    network.here.publisher(PLAIN)
    with pytest.raises(TypeMismatchError, match=r"std_msgs/msg/String.*nl_interface_msgs/msg/Other"):
        network.here.publisher(other)
    with pytest.raises(TypeMismatchError):
        await network.here.subscribe(other, lambda _: None)


async def test_a_message_of_another_type_is_refused_before_it_is_sent(network: Network) -> None:
    sender = network.here.publisher(PLAIN)
    with pytest.raises(TypeMismatchError, match="ChatRequest"):
        sender.publish(ChatRequest("no string"))  # type: ignore[arg-type]


async def test_a_service_called_with_another_type_is_refused(network: Network) -> None:
    await serve_echo(network)
    other = Service(ECHO.name, ChatRequest, ChatResponse, "nl_interface_msgs/srv/Other")
    with pytest.raises(TypeMismatchError):
        await network.here.call(other, ChatRequest("x"), timeout_s=5.0)
    wrong: Any = String("x")
    with pytest.raises(TypeMismatchError, match="String"):
        await network.here.call(ECHO, wrong, timeout_s=5.0)


# Services


async def test_a_call_returns_what_the_server_answers(network: Network) -> None:
    await serve_echo(network)
    answer = await network.here.call(ECHO, ChatRequest("häß"), timeout_s=5.0)
    assert answer == ChatResponse("you said häß")


async def test_calls_are_answered_side_by_side(network: Network) -> None:
    arrived = 0
    all_here = asyncio.Event()

    async def wait_for_both(request: ChatRequest) -> ChatResponse:
        nonlocal arrived
        arrived += 1
        if arrived == 2:
            all_here.set()
        await all_here.wait()
        return ChatResponse(request.message)

    await network.there.serve(ECHO, wait_for_both)
    await until(lambda: serves(network.here, ECHO))
    answers = await asyncio.gather(
        *(network.here.call(ECHO, ChatRequest(text), timeout_s=5.0) for text in ("a", "b"))
    )
    assert answers == [ChatResponse("a"), ChatResponse("b")]


async def test_calling_a_service_nobody_serves_says_so_at_once(network: Network) -> None:
    with pytest.raises(UnavailableError, match="contract/echo"):
        await network.here.call(ECHO, ChatRequest("x"), timeout_s=60.0)


async def test_a_call_without_an_answer_in_time_says_so_and_later_calls_work(network: Network) -> None:
    async def slow_once(request: ChatRequest) -> ChatResponse:
        if request.message == "slow":
            await asyncio.Event().wait()
        return ChatResponse("quick")

    await network.there.serve(ECHO, slow_once)
    await until(lambda: serves(network.here, ECHO))
    with pytest.raises(TransportTimeoutError, match=r"contract/echo.*0\.02 s"):
        await network.here.call(ECHO, ChatRequest("slow"), timeout_s=0.02)
    assert await network.here.call(ECHO, ChatRequest("x"), timeout_s=5.0) == ChatResponse("quick")


@pytest.mark.parametrize("defect", [ValueError("too purple"), TimeoutError("too purple")])
async def test_a_server_that_fails_is_told_to_the_caller_with_its_reason(
    network: Network, defect: Exception
) -> None:
    async def fail(_: ChatRequest) -> ChatResponse:
        raise defect

    await network.there.serve(ECHO, fail)
    await until(lambda: serves(network.here, ECHO))
    with pytest.raises(TransportError, match="too purple") as caught:
        await network.here.call(ECHO, ChatRequest("x"), timeout_s=5.0)
    assert type(caught.value) is TransportError


async def test_a_server_whose_own_peer_is_missing_is_not_mistaken_for_a_missing_server(
    network: Network,
) -> None:
    async def needs_another(_: ChatRequest) -> ChatResponse:
        raise UnavailableError("nobody answers service deeper")

    await network.there.serve(ECHO, needs_another)
    await until(lambda: serves(network.here, ECHO))
    with pytest.raises(TransportError, match="deeper") as caught:
        await network.here.call(ECHO, ChatRequest("x"), timeout_s=5.0)
    assert not isinstance(caught.value, UnavailableError)


async def test_a_service_has_one_server_until_it_is_closed(network: Network) -> None:
    server = await network.there.serve(ECHO, echo)
    with pytest.raises(UnavailableError, match="contract/echo"):
        await network.there.serve(ECHO, echo)
    await server.close()
    await server.close()
    await until(lambda: not serves(network.here, ECHO))
    with pytest.raises(UnavailableError):
        await network.here.call(ECHO, ChatRequest("x"), timeout_s=5.0)
    await serve_echo(network)
    assert await network.here.call(ECHO, ChatRequest("x"), timeout_s=5.0) == ChatResponse("you said x")


async def test_a_cancelled_call_is_cancelled_and_not_turned_into_an_error(network: Network) -> None:
    called = asyncio.Event()

    async def hang(_: ChatRequest) -> ChatResponse:
        called.set()
        await asyncio.Event().wait()
        return ChatResponse()

    await network.there.serve(ECHO, hang)
    await until(lambda: serves(network.here, ECHO))
    call = asyncio.create_task(network.here.call(ECHO, ChatRequest("x"), timeout_s=60.0))
    await called.wait()
    call.cancel()
    with pytest.raises(asyncio.CancelledError):
        await call


# Who is there


async def test_endpoints_show_who_is_there_and_changes_are_told(network: Network) -> None:
    changes: list[int] = []
    forget = network.here.on_endpoints_changed(lambda: changes.append(len(changes)))
    expected = {
        Endpoint("/contract/plain", PLAIN.ros_type, "publisher"),
        Endpoint("/contract/plain", PLAIN.ros_type, "subscription"),
        Endpoint("/contract/echo", ECHO.ros_type, "server"),
    }
    publisher = network.there.publisher(PLAIN)
    subscription = await network.there.subscribe(PLAIN, lambda _: None)
    server = await network.there.serve(ECHO, echo)
    await until(lambda: expected <= set(network.here.endpoints()))
    told = len(changes)
    assert told >= 1

    publisher.close()
    await subscription.close()
    await server.close()
    await until(lambda: not expected & set(network.here.endpoints()))
    assert len(changes) > told

    forget()
    forget()
    told = len(changes)
    network.there.publisher(PLAIN)
    await until(lambda: expected & set(network.here.endpoints()))
    assert len(changes) == told


# Closing


@pytest.mark.parametrize("backend", each())
async def test_closing_ends_everything_that_was_opened_and_leaves_no_task(backend: str) -> None:
    before = asyncio.all_tasks()
    started = asyncio.Event()
    ended: list[str] = []

    async def hang(_: String) -> None:
        started.set()
        try:
            await asyncio.Event().wait()
        finally:
            ended.append("handler")

    async def hang_server(_: ChatRequest) -> ChatResponse:
        await asyncio.Event().wait()
        return ChatResponse()

    async with BACKENDS[backend]() as network:
        subscription = await network.there.subscribe(PLAIN, hang)
        server = await network.there.serve(ECHO, hang_server)
        publisher = network.here.publisher(PLAIN)
        await until(lambda: serves(network.here, ECHO))
        publisher.publish(String("x"))
        await started.wait()
        call = asyncio.create_task(network.here.call(ECHO, ChatRequest("x"), timeout_s=60.0))
        await asyncio.sleep(0.01)

    with pytest.raises(ParleyError, match="contract/echo"):
        await call
    assert ended == ["handler"]
    # Closing an end whose transport is closed already is harmless, and so is sending through it.
    publisher.publish(String("x"))
    publisher.close()
    await subscription.close()
    await server.close()
    assert asyncio.all_tasks() == before
    gc.collect()  # an exception nobody took would be warned about here
