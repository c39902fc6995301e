"""What only a network can do to us: peers that are killed, freeze and come back; noise; bad ends."""

from __future__ import annotations

import asyncio
import signal
import sys
import threading
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Literal

import pytest
import structlog
import zenoh

from parley.config import NetworkSettings
from parley.errors import TransportTimeoutError, TypeMismatchError, UnavailableError
from parley.messages.ros import ChatRequest, String
from parley.messages.topics import QoS, Topic
from parley.transport.base import Endpoint
from parley.transport.zenoh import ZenohTransport
from parley.transport.zenoh.definitions import Definitions
from parley.transport.zenoh.graph import Graph
from parley.transport.zenoh.keys import Attachment, Node, all_tokens, key
from parley.transport.zenoh.lane import BYTES_AHEAD, Lane, Outbox
from tests.transport.backends import free_port, until
from tests.transport.peer import ECHO, HELLO, STOP, TALK

BIG = "x" * 200_000
KEPT = Topic("kept", String, "std_msgs/msg/String", QoS(kept=6))
"""Of a topic of which as much is kept."""
REPEATS = Topic("repeats", String, "std_msgs/msg/String", QoS(repeats=True))
Role = Literal["peer", "client", "router"]


@pytest.fixture
def at() -> str:
    return f"tcp/127.0.0.1:{free_port()}"


def listening(at: str, *, role: Role = "peer") -> ZenohTransport:
    return ZenohTransport(NetworkSettings(listen=(at,), interface="", role=role))


def connecting(at: str, *, role: Role = "peer") -> ZenohTransport:
    return ZenohTransport(NetworkSettings(listen=(), connect=(at,), interface="", role=role))


@asynccontextmanager
async def peer(how: str, at: str) -> AsyncIterator[asyncio.subprocess.Process]:
    process = await asyncio.create_subprocess_exec(sys.executable, "-m", "tests.transport.peer", how, at)
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
        await process.wait()


def sees(transport: ZenohTransport, name: str) -> bool:
    return any(end.name == f"/{name}" for end in transport.endpoints())


def hears(transport: ZenohTransport, topic: Topic[String]) -> bool:
    return Endpoint(f"/{topic.name}", topic.ros_type, "subscription") in transport.endpoints()


# Peers


async def test_a_peer_that_is_killed_is_gone_and_so_is_what_it_was_asked(at: str) -> None:
    async with listening(at) as here, peer("connect", at) as process:
        await until(lambda: sees(here, ECHO.name))
        call = asyncio.create_task(here.call(ECHO, ChatRequest("hang"), timeout_s=60.0))
        assert (await here.call(ECHO, ChatRequest("a"), timeout_s=5.0)).response == "a 0"
        process.kill()
        with pytest.raises(UnavailableError, match="peer/echo went away"):
            await call
        await until(lambda: here.endpoints() == ())


async def test_a_peer_that_is_frozen_is_gone_and_comes_back_when_it_thaws(at: str) -> None:
    async with listening(at) as here, peer("connect", at) as process:
        await until(lambda: sees(here, ECHO.name))
        talker = here.publisher(TALK)
        process.send_signal(signal.SIGSTOP)
        with pytest.raises(TransportTimeoutError):
            await here.call(ECHO, ChatRequest("x"), timeout_s=0.05)
        hanging = asyncio.create_task(here.call(ECHO, ChatRequest("x"), timeout_s=60.0))
        await until(lambda: not sees(here, ECHO.name))
        with pytest.raises(UnavailableError, match="went away"):
            await hanging
        process.send_signal(signal.SIGCONT)
        await until(lambda: hears(here, TALK) and sees(here, ECHO.name))
        talker.publish(String("again"))

        answer = ""
        while answer != "x 1":  # how many it has heard
            answer = (await here.call(ECHO, ChatRequest("x"), timeout_s=5.0)).response


async def test_a_peer_that_takes_nothing_holds_up_no_stop_to_others_and_the_rest_not_for_ever(
    at: str,
) -> None:
    stops: list[String] = []
    talk: list[String] = []
    async with listening(at) as here, connecting(at) as healthy, peer("connect", at) as process:
        await healthy.subscribe(STOP, stops.append)
        await healthy.subscribe(TALK, talk.append)
        await until(lambda: sees(here, HELLO.name) and hears(here, STOP))
        stop, talker = here.publisher(STOP), here.publisher(TALK)
        process.send_signal(signal.SIGSTOP)
        for _ in range(99):
            talker.publish(String(BIG))
        talker.publish(String("last"))
        await until(lambda: talk)
        stop.publish(String("now"))
        await until(lambda: stops)
        assert talk[-1].data == BIG  # what else was sent is held up yet
        await until(lambda: talk[-1].data == "last")
        assert len(talk) == 100


async def test_a_peer_that_is_started_anew_is_found_again(at: str) -> None:
    hellos: list[String] = []
    async with connecting(at) as here:
        await here.subscribe(HELLO, hellos.append)
        for times in (1, 2):
            async with peer("listen", at):
                await until(lambda: sees(here, ECHO.name))
                assert await here.call(ECHO, ChatRequest("x"), timeout_s=5.0)
                await until(lambda: len(hellos) == times)  # noqa: B023 - waited for at once
            await until(lambda: not sees(here, ECHO.name))


async def test_through_a_router_and_again_when_it_was_away(at: str) -> None:
    heard: list[str] = []
    async with AsyncExitStack() as ends:
        async with listening(at, role="router"):
            one = await ends.enter_async_context(connecting(at, role="client"))
            other = await ends.enter_async_context(connecting(at, role="client"))
            await other.subscribe(TALK, lambda message: heard.append(message.data))
            await until(lambda: hears(one, TALK))
            talker = one.publisher(TALK)
            talker.publish(String("first"))
            await until(lambda: heard)
        await until(lambda: not hears(one, TALK))
        async with listening(at, role="router"):
            await until(lambda: hears(one, TALK))
            talker.publish(String("second"))
            await until(lambda: len(heard) == 2)
    assert heard == ["first", "second"]


async def test_who_wants_it_hears_late_what_it_missed_while_the_router_was_away_once_and_in_turn(
    at: str,
) -> None:
    heard: list[str] = []
    acted: list[str] = []
    newcomer: list[str] = []
    async with AsyncExitStack() as ends:
        async with listening(at, role="router"):
            one = await ends.enter_async_context(connecting(at, role="client"))
            other = await ends.enter_async_context(connecting(at, role="client"))
            shows = await other.subscribe(KEPT, lambda message: heard.append(message.data), late=True)
            acts = await other.subscribe(KEPT, lambda message: acted.append(message.data))
            await until(lambda: hears(one, KEPT))
            talker = one.publisher(KEPT)
            talker.publish(String("first"))
            await until(lambda: heard and acted)
        await until(lambda: not hears(one, KEPT))
        missed = [str(number) for number in range(8)]
        for text in missed:
            talker.publish(String(text))
        async with listening(at, role="router"):
            await until(lambda: hears(one, KEPT))
            await other.subscribe(KEPT, lambda message: newcomer.append(message.data), late=True)
            talker.publish(String("last"))
            await until(lambda: heard[-1:] == acted[-1:] == newcomer[-1:] == ["last"])
    assert heard == ["first", *missed[3:], "last"], "as much as is kept"
    assert acted == ["first", "last"]
    assert newcomer == ["last"], "who came later missed nothing"
    assert (shows.dropped, acts.dropped) == (3, 8)


async def test_a_process_that_ends_without_closing_ends_well_though_messages_come(at: str) -> None:
    async with listening(at) as here, peer("drop", at) as process:
        talker = here.publisher(TALK)
        ending = asyncio.create_task(process.wait())
        while not ending.done():
            talker.publish(String("x"))
            await asyncio.sleep(0)
        assert ending.result() == 0


async def test_a_network_that_cannot_be_reached_is_said_at_once(at: str) -> None:
    async with listening(at):
        with pytest.raises(UnavailableError, match="network cannot be reached"):
            async with listening(at):
                pass


async def test_an_opening_that_is_broken_off_leaves_nothing_open(at: str) -> None:
    def lanes() -> int:
        return sum(thread.name.startswith("zenoh ") for thread in threading.enumerate())

    async with listening(at) as here:
        before = lanes()
        opening = asyncio.create_task(connecting(at).__aenter__())
        await asyncio.sleep(0)
        opening.cancel()
        with pytest.raises(asyncio.CancelledError):
            await opening
        await until(lambda: lanes() == before)
        assert here.endpoints() == ()


async def test_processes_of_another_domain_are_not_seen(at: str) -> None:
    other = ZenohTransport(NetworkSettings(domain=1, listen=(), connect=(at,), interface=""))
    heard: list[String] = []
    async with listening(at) as here, other, connecting(at) as same:
        await here.subscribe(TALK, heard.append)
        await until(lambda: sees(same, TALK.name))
        other.publisher(TALK).publish(String("other"))
        same.publisher(TALK).publish(String("same"))
        await until(lambda: heard)
        assert not any(end.role == "subscription" for end in other.endpoints())
    assert heard == [String("same")]


# Others on the network


class Stranger:
    """Somebody who speaks the network's language, but not ours; it sees who of us is there."""

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session
        self.seen: list[str] = []
        see: zenoh.handlers.Callback[zenoh.Sample] = zenoh.handlers.Callback(
            lambda sample: self.seen.append(str(sample.key_expr)), indirect=False
        )
        session.liveliness().declare_subscriber(all_tokens(0), see, history=True)

    async def sees(self, name: str) -> None:
        await until(lambda: any(f"/%{name.replace('/', '%')}/" in token for token in self.seen))


@pytest.fixture
def stranger(at: str) -> Iterator[Stranger]:
    config = zenoh.Config()
    for name, value in (
        ("listen/endpoints", f'["{at}"]'),
        ("scouting/multicast/enabled", "false"),
        ("timestamping/enabled", "true"),
    ):
        config.insert_json5(name, value)
    with zenoh.open(config) as session:
        yield Stranger(session)


TALK_KEY = key(0, TALK.name, TALK.ros_type, Definitions().hash(TALK.ros_type))
ECHO_KEY = key(0, ECHO.name, ECHO.ros_type, Definitions().hash(ECHO.ros_type))
X = bytes.fromhex("00010000 02000000 7800")


async def test_noise_is_told_and_not_handed_on_and_the_next_message_is(at: str, stranger: Stranger) -> None:
    heard: list[String] = []
    talker = stranger.session.declare_publisher(TALK_KEY)
    with structlog.testing.capture_logs() as logged:
        async with connecting(at) as here:
            await here.subscribe(TALK, heard.append)
            await stranger.sees(TALK.name)
            for data, attachment in ((b"noise", b""), (X, b"no ROS"), (X, None)):
                talker.put(data, attachment=attachment)
            await until(lambda: len(heard) == 2)
    assert heard == [String("x")] * 2
    assert [line["topic"] for line in logged if line["event"] == "a message cannot be read"] == [TALK.name]


async def test_messages_that_were_lost_on_the_way_are_counted(at: str, stranger: Stranger) -> None:
    heard: list[String] = []
    talker = stranger.session.declare_publisher(TALK_KEY)
    async with connecting(at) as here:
        subscription = await here.subscribe(TALK, heard.append)
        await stranger.sees(TALK.name)
        for sender, numbers in ((b"a", (7, 8, 12)), (b"b", (1, 2**62, 3))):  # nobody is so far on
            for number in numbers:
                talker.put(X, attachment=Attachment(number, 0, sender * 16).to_bytes())
        await until(lambda: len(heard) == 6)
        assert subscription.dropped == 3 + 1


@pytest.mark.parametrize(("topic", "lost"), [(REPEATS, 1), (TALK, 16 + 3)])
async def test_equal_words_are_one_loss_where_they_are_said_until_they_are_taken_and_else_many(
    at: str, topic: Topic[String], lost: int
) -> None:
    heard: list[str] = []
    async with AsyncExitStack() as ends:
        async with listening(at, role="router"):
            one = await ends.enter_async_context(connecting(at, role="client"))
            other = await ends.enter_async_context(connecting(at, role="client"))
            taken = await other.subscribe(topic, lambda message: heard.append(message.data))
            await until(lambda: hears(one, topic))
            talker = one.publisher(topic)
            talker.publish(String("before"))
            await until(lambda: heard)
        await until(lambda: not hears(one, topic))
        for text in ("first", "second", "gone", *["first", "second"] * 8):
            talker.publish(String(text))
        async with listening(at, role="router"):
            await until(lambda: hears(one, topic))
            for text in ("first", "second", "first", "after"):
                talker.publish(String(text))
            await until(lambda: heard[-1:] == ["after"])
    assert heard == ["before", "first", "second", "first", "after"]
    assert taken.dropped == lost


async def test_a_call_that_is_no_call_is_refused_and_the_next_is_answered(
    at: str, stranger: Stranger
) -> None:
    async def echo(request: ChatRequest) -> object:
        return request

    async with connecting(at) as here:
        await here.serve(ECHO, echo)  # type: ignore[arg-type]
        await stranger.sees(ECHO.name)
        for payload in (b"noise", X):  # then a handler that answers with something else
            replies = await asyncio.to_thread(lambda: list(stranger.session.get(ECHO_KEY, payload=payload)))  # noqa: B023
            assert [reply.ok for reply in replies] == [None]
            assert replies[0].err is not None


# Parts


def test_what_waits_to_be_sent_is_as_much_as_the_depth_and_more_if_it_is_little() -> None:
    small, big, all_ = Outbox(2), Outbox(2), Outbox(None)
    for number in range(1000):
        small.put(b"%d" % number, b"")
    for number in range(9):
        big.put(b"%d" % number * BYTES_AHEAD, b"")
        all_.put(b"%d" % number * BYTES_AHEAD, b"")
    assert (small.dropped, big.dropped, all_.dropped) == (0, 7, 0)
    assert [taken[0][:1] for taken in iter(big.take, None)] == [b"7", b"8"]
    assert len(list(iter(small.take, None))) == 1000
    assert len(list(iter(all_.take, None))) == 9
    assert not big.put(b"x" * 10, b"")  # what was taken counts no more


async def test_a_lane_goes_on_after_what_failed_and_hands_errors_to_who_waits() -> None:
    lane = Lane("test")
    with structlog.testing.capture_logs() as logged:
        lane.do(lambda: 1 / 0)
        assert await lane.ask(lambda: "done") == "done"
    assert [line["lane"] for line in logged] == ["test"]
    with pytest.raises(ZeroDivisionError):
        await lane.ask(lambda: 1 / 0)
    lane.close()


def test_two_types_of_one_name_are_told_once_and_refused_here() -> None:
    graph = Graph()
    node = Node(0, "abc", "other")

    def token(number: int, ros_type: str) -> str:
        return node.end_token(number, Endpoint("/talk", ros_type, "publisher"), "hash", TALK.qos)

    changes: list[int] = []
    graph.on_changed(lambda: changes.append(1))
    with structlog.testing.capture_logs() as logged:
        for number, ros_type in enumerate(("std_msgs/msg/String", "std_msgs/msg/Int32", "std_msgs/msg/Bool")):
            graph.seen(token(number, ros_type), is_there=True)
        graph.seen(token(0, "std_msgs/msg/String"), is_there=True)
        graph.seen(node.token(), is_there=True)
        graph.seen("@ros2_lv/0/noise", is_there=True)
        graph.seen(token(9, "std_msgs/msg/String"), is_there=False)
    assert len(changes) == 3
    assert [line["types"] for line in logged] == [["std_msgs/msg/Int32", "std_msgs/msg/String"]]
    with pytest.raises(TypeMismatchError, match="std_msgs/msg/String, not std_msgs/msg/Empty"):
        graph.check("talk", "std_msgs/msg/Empty", service=False)
    graph.check("talk", "std_srvs/srv/Empty", service=True)


def test_an_end_that_was_closed_here_is_not_there_any_more_whatever_its_token_says() -> None:
    graph = Graph()
    end = Endpoint("/talk", "std_msgs/msg/String", "publisher")
    token = Node(0, "abc", "here").end_token(1, end, "hash", TALK.qos)
    graph.add_own(token, end)
    graph.seen(token, is_there=True)
    assert graph.endpoints() == (end,)
    graph.remove_own(token)
    graph.seen(token, is_there=True)
    assert graph.endpoints() == ()
    graph.seen(token, is_there=False)
    assert graph.endpoints() == ()


async def test_a_topic_with_a_type_nobody_defined_is_refused(at: str) -> None:
    async with listening(at) as here:
        with pytest.raises(Exception, match="my_msgs/msg/Thing"):
            here.publisher(Topic("thing", String, "my_msgs/msg/Thing"))
        assert here.endpoints() == ()
