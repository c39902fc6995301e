"""The stop while nothing else works: its thread, its line, messages with a stop word."""

from __future__ import annotations

import asyncio
import json
import os
import sqlite3
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import ExitStack, asynccontextmanager, closing, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from parley.clock import Clock, WallClock
from parley.gate.stop_line import StopLine
from parley.messages import topics
from parley.messages.status import Pulse, StopCommand, StopReport
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from parley.web import stop_desk
from parley.web.config import WebConfig
from parley.web.robot_state import STOP_DEADLINE_S
from parley.web.server import WebServer
from parley.web.stopping import WRITTEN_WITHIN_S, Stopper
from tests.transport.backends import until
from tests.web.rig import HandClock, Rig, Robots, served

BLOCKED_S = 1.5
"""For so long the loop of the product does nothing; a stop that had to wait for it would be as late."""


@dataclass
class Drive:
    """A robot on the line, told in whatever thread."""

    line: StopLine
    halted_s: list[float] = field(default_factory=list)
    told: list[StopCommand] = field(default_factory=list)
    rests: bool = True

    def tie(self, name: str) -> None:
        self.line.attach(
            name,
            halt=lambda: self.halted_s.append(time.monotonic()),
            resume=lambda: None,
            told=self.told.append,
        )


@asynccontextmanager
async def fronted(clock: Clock | None = None, **settings: Any) -> AsyncIterator[tuple[Rig, Drive]]:
    """A server whose engines are in this process."""
    line = StopLine()
    drive = Drive(line)
    drive.tie("Ada")
    async with LocalTransport() as transport:
        robots = Robots(transport)
        await robots.listen()
        config = WebConfig(port=0, **settings)
        async with (
            WebServer(
                transport, config, clock=clock, stop_line=line, at_rest=lambda _: drive.rests
            ) as server,
            httpx.AsyncClient(base_url=server.url, timeout=20) as http,
        ):
            rig = Rig(server, robots, http)
            robots.appear("Ada")
            await rig.until(lambda: "Ada" in server.backend.state.robots.views)
            yield rig, drive
    line.close()


@contextmanager
def lined(url: str, cookie: str = "") -> Iterator[ClientConnection]:
    """A page's line, open."""
    address, headers = url.replace("http", "ws") + "api/stop/line", {"Cookie": cookie} if cookie else None
    with connect(address, origin=Origin(url.rstrip("/")), additional_headers=headers) as line:
        assert line.recv(timeout=10) == "{}"
        yield line


def answer_on(line: ClientConnection) -> dict[str, Any]:
    """What it says next, besides signs of life."""
    while (text := line.recv(timeout=10)) == "{}":
        pass
    return dict(json.loads(text))


async def while_blocked(deed: Any) -> tuple[Any, float]:
    """What a deed of another thread gives while the loop is held up; and when it began to be."""
    outcome = asyncio.create_task(asyncio.to_thread(deed))
    await asyncio.sleep(0)
    began_s = time.monotonic()
    time.sleep(BLOCKED_S)  # noqa: ASYNC251 - this is what is tried
    return await outcome, began_s


async def test_a_stop_gets_through_on_both_ways_while_the_loop_is_blocked() -> None:
    async with fronted() as (rig, drive):
        stack = ExitStack()
        line = await asyncio.to_thread(stack.enter_context, lined(rig.url))

        def press() -> tuple[dict[str, Any], dict[str, Any], float]:
            time.sleep(0.05)
            line.send(json.dumps({"id": "s1", "targets": ["ada"]}))
            first = answer_on(line)
            with httpx.Client(base_url=rig.url) as http:
                second = http.post("/api/stop", json={"id": "s1", "targets": ["Ada"]}).json()
            return first, second, time.monotonic()

        (first, second, answered_s), began_s = await while_blocked(press)
        assert first["robots"] == second["robots"] == {"Ada": "stands"}
        assert answered_s - began_s < BLOCKED_S
        assert min(drive.halted_s) - began_s < BLOCKED_S
        assert [command.id for command in drive.told] == ["s1"]
        assert drive.line.latched("Ada")
        await rig.heard()
        assert {stop.id for stop in rig.robots.stops} == {"s1"}
        await asyncio.to_thread(stack.close)


async def test_the_line_tells_when_a_robot_stands_and_of_one_that_does_not_answer() -> None:
    clock = HandClock()
    async with fronted(clock) as (rig, drive):
        drive.rests = False

        def press() -> list[dict[str, str]]:
            with lined(rig.url) as line:
                line.send(json.dumps({"id": "s1", "targets": ["Ada", "Bob"]}))
                states = [answer_on(line)["robots"]]
                drive.rests = True
                states.append(answer_on(line)["robots"])
                clock.ahead_s = STOP_DEADLINE_S + 0.1
                return [*states, answer_on(line)["robots"]]

        assert await asyncio.to_thread(press) == [
            {"Ada": "moves", "Bob": "sent"},
            {"Ada": "stands", "Bob": "sent"},
            {"Ada": "stands", "Bob": "silent"},
        ]


async def test_a_message_with_a_stop_word_holds_before_anybody_reads_it() -> None:
    async with fronted() as (rig, drive):

        def say() -> int:
            time.sleep(0.05)
            with httpx.Client(base_url=rig.url, timeout=20) as http:
                post = {"id": "m1", "text": "Stop!! you are on my foot", "targets": ["Ada"]}
                return http.post("/api/chat", json=post).status_code

        status, began_s = await while_blocked(say)
        assert status == 200
        assert drive.halted_s[0] - began_s < BLOCKED_S
        assert [(c.command, c.id, c.words) for c in drive.told] == [
            ("hold", "m1", "Stop!! you are on my foot")
        ]
        await rig.heard()
        assert [said.id for said in rig.robots.inputs] == ["m1"]


@pytest.mark.parametrize("words", ["Ada, stop!", "Everybody stop!"])
async def test_a_message_holds_those_too_whom_its_words_call(words: str) -> None:
    async with fronted() as (rig, drive):
        await rig.http.post("/api/chat", json={"id": "m1", "text": words, "targets": ["Bob"]})
        assert drive.line.held_by("Ada")


async def test_a_message_that_is_sent_again_does_not_hold_a_second_time() -> None:
    async with fronted() as (rig, drive):
        post = {"id": "m1", "text": "wait", "targets": ["Ada"]}
        await rig.http.post("/api/chat", json=post)
        drive.line.go_on("m1")
        await rig.http.post("/api/chat", json=post)
        assert not drive.line.held_by("Ada")


async def test_who_was_signed_out_stops_nobody_and_is_hung_up_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stop_desk, "BEAT_S", 0.05)
    async with fronted() as (rig, drive):
        account = {"name": "Kim", "role": "supervisor", "password": "correct horse battery"}
        await rig.http.post("/api/people", json=account)
        cookie = "; ".join(f"{name}={value}" for name, value in rig.http.cookies.items())
        line = await asyncio.to_thread((stack := ExitStack()).enter_context, lined(rig.url, cookie))
        assert (await rig.http.delete("/api/session")).status_code == 200
        with pytest.raises(ConnectionClosed):
            await asyncio.to_thread(line.send, json.dumps({"id": "s1", "targets": []}))
            await asyncio.to_thread(answer_on, line)
        assert not drive.line.latched("Ada")
        await asyncio.to_thread(stack.close)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a file that nobody reads yet")
async def test_a_stop_is_said_not_to_be_saved_only_where_that_failed_or_takes_long(tmp_path: Path) -> None:
    file = tmp_path / "stops.json"
    os.mkfifo(tmp_path / "stops.json.new")  # whoever writes it waits for a reader, as for a slow disk
    line = StopLine(file)
    stopper = Stopper(line, dict, lambda command: None, WallClock())
    stop = stopper.stop((), by=None, id="s1")
    assert stopper.is_kept(stop)
    assert not stopper.is_kept(replace(stop, began_s=stop.began_s - WRITTEN_WITHIN_S))
    with (tmp_path / "stops.json.new").open():  # what is no file on a disk cannot be brought there
        assert await asyncio.wait_for(asyncio.wrap_future(line.written), 10) != ""
        assert not stopper.is_kept(stop)
    (tmp_path / "stops.json.new").unlink()
    line.close()


async def test_only_a_person_at_the_page_releases() -> None:
    async with fronted() as (rig, drive):
        await rig.http.post("/api/stop", json={"id": "s1"})
        assert drive.line.latched("Ada")
        assert (await rig.http.post("/api/stop", json={"command": "reset"})).status_code == 200
        assert not drive.line.latched("Ada")


async def test_a_message_with_a_stop_word_gets_through_while_the_conversation_cannot_be_kept(
    tmp_path: Path,
) -> None:
    async with fronted(data_dir=tmp_path) as (rig, drive):
        with closing(sqlite3.connect(tmp_path / "web.db", isolation_level=None)) as other:
            other.execute("BEGIN EXCLUSIVE")
            post = {"id": "m1", "text": "stop", "targets": ["Ada"]}
            assert (await rig.http.post("/api/chat", json=post)).status_code == 200
            assert drive.line.held_by("Ada")
            await rig.heard()
            assert [said.id for said in rig.robots.inputs] == ["m1"]


async def test_a_message_that_is_refused_holds_nobody() -> None:
    async with fronted(without={"chat"}) as (rig, drive):
        post = {"id": "m1", "text": "stop", "targets": ["Ada"]}
        assert (await rig.http.post("/api/chat", json=post)).status_code == 404
        assert [command.command for command in drive.told] == ["hold", "go_on"]


async def test_a_reset_that_is_heard_late_does_not_release_what_was_stopped_since() -> None:
    async with fronted() as (rig, drive):
        await rig.http.post("/api/stop", json={"id": "s1"})
        await rig.http.post("/api/stop", json={"command": "reset", "id": "r1"})
        await rig.http.post("/api/stop", json={"id": "s2"})
        await rig.heard()
        (late,) = [heard for heard in rig.robots.stops if heard.command == "reset"]
        drive.line.reset(late.targets, by=late.by, id=late.id)
        assert drive.line.latched("Ada")


async def test_a_stop_that_no_robot_confirmed_goes_with_each_sign_of_life_of_the_page() -> None:
    pulses: list[Pulse] = []
    async with served("Ada") as rig:
        await rig.server.backend.transport.subscribe(
            topics.PULSE, lambda told: pulses.append(decode(Pulse, told.data))
        )
        await until(lambda: pulses and not pulses[-1].stops)
        await rig.http.post("/api/stop", json={"id": "s1", "targets": ["Ada"]})
        await until(lambda: [(stop.id, stop.targets) for stop in pulses[-1].stops] == [("s1", ("Ada",))])
        rig.robots.tell(topics.STOP_REPORT, StopReport(actor="Ada", id="s1", state="received"))
        await until(lambda: not pulses[-1].stops)
    assert pulses[-1].leaving, "who ends in order holds nobody"
