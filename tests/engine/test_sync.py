"""What engines tell each other, over a network that loses, doubles and swaps messages."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.clock import WallClock
from parley.engine.sync import Sync
from parley.errors import ActionFailure, FailureCode, Problem
from parley.messages.pvf import Parameter
from parley.messages.status import ActorStatus, SyncEntry, SyncNotice
from parley.umrf.model import Node, Result
from parley.umrf.remote import RemoteEnd
from tests.umrf.watched import until


class Network:
    """Delivers every notice to everybody, unless chance has it otherwise."""

    def __init__(self, seed: int, loss: float) -> None:
        self.random, self.loss = random.Random(seed), loss
        self.members: list[Sync] = []
        self.said = 0
        self.heard: dict[str, list[SyncEntry]] = {}
        self.complaints: list[Problem] = []

    def join(self, actor: str, timeout_s: float = 5.0) -> Sync:
        heard = self.heard[actor] = []
        sync = Sync(
            actor,
            WallClock(),
            self.send,
            complain=lambda name, problem: self.complaints.append(problem),
            hear=lambda session, entry: heard.append(entry),
            timeout_s=timeout_s,
        )
        self.members.append(sync)
        return sync

    def send(self, notice: SyncNotice) -> None:
        self.said += 1
        loop = asyncio.get_running_loop()
        for member in self.members:
            for _ in range(self.random.choice((1, 1, 2))):
                if self.random.random() >= self.loss:
                    loop.call_later(self.random.random() * 0.005, member.take, notice)


async def started(network: Network, *syncs: Sync) -> None:
    for sync in syncs:
        sync.open("g", {other.actor for other in syncs} - {sync.actor})
    silent = await asyncio.gather(*(sync._sessions["g"].handshake() for sync in syncs))
    assert silent == [[] for _ in syncs]


def ends(count: int) -> list[RemoteEnd]:
    return [RemoteEnd(Result.ON_TRUE, {"n": Parameter("number", float(index))}) for index in range(count)]


@pytest.mark.spec("13", "D25")
@given(seed=st.integers(0, 10_000), loss=st.sampled_from([0.0, 0.2, 0.5]), count=st.integers(1, 4))
@settings(max_examples=12, deadline=None)
def test_every_end_arrives_once_and_in_order_whatever_the_network_does(
    seed: int, loss: float, count: int
) -> None:
    async def play() -> None:
        network = Network(seed, loss)
        first, second = network.join("A"), network.join("B")
        await started(network, first, second)
        given_ends, node = ends(count), Node("Work", 0, actor="A")
        first._sessions["g"].ended("g", node, given_ends[0])

        async def all_ends() -> list[RemoteEnd]:
            return [await second._sessions["g"].end_of("g", node) for _ in range(count)]

        waiting = asyncio.create_task(all_ends())
        for end in given_ends[1:]:
            first._sessions["g"].ended("g", node, end)
        found = await waiting
        assert [end.outputs["n"].value for end in found] == [float(index) for index in range(count)]
        await until(lambda: first._sessions["g"].settled)
        assert not network.complaints
        first.close()
        second.close()

    asyncio.run(play())


@pytest.mark.spec("13", "D34")
@given(
    seed=st.integers(0, 10_000),
    loss=st.sampled_from([0.0, 0.2, 0.5]),
    commands=st.lists(st.sampled_from(["pause", "resume", "end", "stop"]), min_size=1, max_size=6),
)
@settings(max_examples=10, deadline=None)
def test_every_command_arrives_once_and_in_order_whatever_the_network_does(
    seed: int, loss: float, commands: list[Any]
) -> None:
    async def play() -> None:
        network = Network(seed, loss)
        syncs = [network.join(name) for name in "ABC"]
        await started(network, *syncs)
        for command in commands:
            syncs[0]._sessions["g"].tell(SyncEntry(kind="command", graph_name="g", command=command))
        await until(lambda: syncs[0]._sessions["g"].settled)
        for name in "BC":
            assert [entry.command for entry in network.heard[name]] == commands
        assert not network.complaints
        for sync in syncs:
            sync.close()

    asyncio.run(play())


async def test_what_was_confirmed_is_kept_no_longer_than_somebody_may_need_it() -> None:
    network = Network(1, 0.0)
    first, second = network.join("A", timeout_s=0.05), network.join("B")
    await started(network, first, second)
    session, node = first._sessions["g"], Node("Work", 0, actor="A")
    for end in ends(3):
        session.ended("g", node, end)
    await until(lambda: session.settled)
    assert len(session._said) == 3
    await asyncio.sleep(0.06)
    session.ended("g", node, ends(4)[3])
    await until(lambda: session.settled)
    assert len(session._said) == 1
    found = [await second._sessions["g"].end_of("g", node) for _ in range(4)]
    assert [end.outputs["n"].value for end in found] == [0.0, 1.0, 2.0, 3.0]
    assert not network.complaints


async def test_a_run_that_does_not_begin_answers_nobody() -> None:
    network = Network(1, 0.0)
    first, second = network.join("A"), network.join("B", timeout_s=0.05)
    first.open("g", {"B"}).close()
    assert await second.open("g", {"A"}).handshake() == ["A"]


async def test_who_does_not_answer_any_more_is_told_once_and_holds_nobody_else_up() -> None:
    network = Network(1, 0.0)
    first, second, third = (network.join(name, timeout_s=0.1) for name in "ABC")
    await started(network, first, second, third)
    network.members.remove(third)
    session, node = first._sessions["g"], Node("Work", 0, actor="A")
    session.ended("g", node, ends(1)[0])
    await until(lambda: session.settled)
    assert [item.message for item in network.complaints] == ["C did not confirm that Work_0 has ended"]
    session.ended("g", node, ends(2)[1])
    found = [await second._sessions["g"].end_of("g", node) for _ in range(2)]
    assert [end.outputs["n"].value for end in found] == [0.0, 1.0]
    first.close()


async def test_what_was_given_up_does_not_hold_back_what_comes_later() -> None:
    network = Network(1, 0.0)
    first, second = network.join("A", timeout_s=0.1), network.join("B")
    await started(network, first, second)
    session, node = first._sessions["g"], Node("Work", 0, actor="A")
    network.members.remove(second)
    session.ended("g", node, ends(1)[0])
    await until(lambda: session.settled)
    network.members.append(second)
    session.ended("g", node, ends(2)[1])
    assert (await second._sessions["g"].end_of("g", node)).outputs["n"].value == 1.0
    second.close()


async def test_what_is_repeated_by_two_does_not_make_them_talk_without_end() -> None:
    network = Network(1, 0.0)
    syncs = [network.join(name) for name in "ABC"]
    await started(network, *syncs)
    network.members.remove(syncs[2])
    before = network.said
    for sync in syncs[:2]:
        node = Node("Work", 0, actor=sync.actor)
        sync._sessions["g"].ended("g", node, ends(1)[0])
    await asyncio.sleep(0.1)
    assert network.said - before < 10
    for sync in syncs:
        sync.close()


async def test_a_run_knows_only_who_knows_it() -> None:
    network = Network(1, 0.0)
    first, second = network.join("A"), network.join("B")
    await started(network, first, second)
    old = first._sessions["g"]
    await started(network, first, second)
    stop = SyncEntry(kind="command", graph_name="g", command="stop")
    own = second._sessions["g"].id
    for run, knows in ((old.id, own), ("another", own), (first._sessions["g"].id, old.id)):
        late = SyncNotice(actor="A", graph_name="g", run=run, heard={"B": (knows, 0)}, said=(stop,))
        second.take(late)
    assert network.heard["B"] == []


async def test_an_end_of_an_earlier_run_does_not_count() -> None:
    network = Network(1, 0.0)
    first, second = network.join("A"), network.join("B")
    await started(network, first, second)
    node = Node("Work", 0, actor="A")
    old = first._sessions["g"]
    await started(network, first, second)
    old.ended("g", node, ends(1)[0])
    first._sessions["g"].ended("g", node, ends(2)[1])
    found = await second._sessions["g"].end_of("g", node)
    assert found.outputs["n"].value == 1.0
    await asyncio.sleep(0.02)
    assert not second._sessions["g"]._ends["g", "Work_0"]
    old.close()
    first.close()


async def test_who_is_not_named_may_take_part_and_gets_what_was_before() -> None:
    network = Network(2, 0.0)
    first, second = network.join("A"), network.join("B")
    own = first.open("g", ())
    node = Node("Work", 0, actor="A")
    own.ended("g", node, ends(1)[0])
    late = second.open("g", {"A"})
    assert await late.handshake() == []
    assert (await late.end_of("g", node)).result is Result.ON_TRUE
    own.ended("g", node, ends(2)[1])
    assert (await late.end_of("g", node)).outputs["n"].value == 1.0


async def test_who_is_not_named_comes_too_late_after_the_time_to_answer() -> None:
    network = Network(2, 0.0)
    first, second = network.join("A", timeout_s=0.02), network.join("B", timeout_s=0.05)
    first.open("g", ())
    await asyncio.sleep(0.03)
    assert await second.open("g", {"A"}).handshake() == ["A"]


def alive(actor: str, **graphs: str) -> ActorStatus:
    return ActorStatus(actor=actor, state="running", graphs=graphs)


@pytest.mark.spec("13")
@pytest.mark.parametrize(
    ("tell", "says"),
    [
        (lambda sync: None, "has not been heard of at work on g for 0.05 s"),
        (lambda sync: sync.note(alive("B", g="FINISHED")), "has not been heard of at work on g for 0.05 s"),
        (lambda sync: sync.note(alive("B", h="RUNNING")), "has not been heard of at work on g for 0.05 s"),
        (lambda sync: sync.note(ActorStatus(actor="B", state="leaving")), "has left"),
    ],
)
async def test_a_peer_that_is_not_at_work_is_given_up(tell: Callable[[Sync], None], says: str) -> None:
    sync = Network(3, 0.0).join("A", timeout_s=0.05)
    session = sync.open("g", {"B"})
    tell(sync)
    with pytest.raises(ActionFailure) as failure:
        await session.end_of("g", Node("Work", 0, actor="B"))
    assert failure.value.code is FailureCode.UNAVAILABLE
    assert failure.value.message == f"Work_0 is for B, which {says}."


async def test_a_peer_that_is_at_work_is_waited_for() -> None:
    sync = Network(3, 0.0).join("A", timeout_s=0.05)
    session = sync.open("g", {"B"})
    waiting = asyncio.create_task(session.end_of("g", Node("Work", 0, actor="B")))
    for _ in range(20):
        sync.note(alive("B", g="PAUSED"))
        await asyncio.sleep(0.01)
    assert not waiting.done()
    waiting.cancel()


def test_why_a_peer_did_not_answer_is_said() -> None:
    sync = Network(4, 0.0).join("A")
    assert sync.absence("B") == "B is not there"
    sync.note(ActorStatus(actor="B", state="stopped"))
    assert sync.absence("B") == "B was stopped by the emergency stop"
    assert sync.stopped(["B", "C"]) == ["B"]
    sync.note(ActorStatus(actor="B", state="idle"))
    assert sync.absence("B") == "B is there, but did not take up the graph"
