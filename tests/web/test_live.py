"""The live stream: nothing lost, nothing twice, nobody waits for a slow client."""

from __future__ import annotations

import asyncio
import socket
from typing import Any

from parley.agents.planner.umrf_planner import UmrfPlanner
from parley.clock import WallClock
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.map import MapView
from parley.messages.ros import UmrfGraphFeedback
from parley.messages.status import PlanProposal, PlanUpdate, PoseInfo
from parley.umrf.io import write_graph
from parley.umrf.model import Graph, GraphState, Node
from parley.web.config import WebConfig
from parley.web.live import CONFIRM_WITHIN_S, MAX_STRANGERS
from parley.web.server import WebServer
from tests.web.rig import JPEG, HandClock, Page, served


def applied(page: Page) -> dict[str, Any]:
    """The robots as a page knows them: snapshot, then changes."""
    robots = {robot["name"]: robot for robot in page.snapshots[-1]["robots"]}
    for change in page.changes:
        if change["kind"] == "robot":
            robots[change["robot"]["name"]] = change["robot"]
        elif change["kind"] == "robot_gone":
            robots.pop(change["name"], None)
    return robots


async def until_it_knows(page: Page, robots: int) -> None:
    await page.until(lambda: len(applied(page)) == robots)


async def until_it_is_at(page: Page, seq: int) -> None:
    await page.until(lambda: page.seq == seq)


async def until_it_heard(page: Page, entries: int) -> None:
    await page.until(lambda: len(page.of("chat")) >= entries)


async def until_it_shows(page: Page, number: int) -> None:
    await page.until(lambda: page.frames and page.frames[-1][1][-1] == number)


async def test_two_pages_know_the_same() -> None:
    async with served("Ada") as rig:
        one, two = await rig.page(), await rig.page()
        for number in range(50):
            rig.robots.appear("Ada", "running" if number % 2 else "idle", sequence=number)
            rig.robots.appear(f"robot {number}")
        for page in (one, two):
            await until_it_knows(page, 51)
        last = max(one.seq, two.seq)
        for page in (one, two):
            await until_it_is_at(page, last)
        assert applied(one) == applied(two)


async def test_each_page_is_told_in_its_own_language_and_answers_with_what_was_offered() -> None:
    async with served("Ada") as rig:
        rig.robots.say("I will go to the box.")
        await rig.until(lambda: rig.server.backend.state.chat.entries)
        english, estonian = await rig.page(), await rig.page(language="et-EE")
        rig.robots.ask("Where shall I bring it?", "stay here", "the den")
        for page in (english, estonian):
            await until_it_heard(page, 1)
        assert [english.snapshots[0]["chat"][0]["message"]] == ["I will go to the box."]
        assert [estonian.snapshots[0]["chat"][0]["message"]] == ["Teen nii: mine kohta box."]
        asked = estonian.of("chat")[0]["entry"]
        assert asked["message"] == "Kuhu ma selle viin?"
        assert (asked["choices"], asked["shown_choices"]) == (["stay here", "the den"], ["jää siia", "den"])
        header = {"accept-language": "et"}
        found = (await rig.http.get("/api/chat", headers=header)).json()["entries"]
        assert found[0]["message"] == "Teen nii: mine kohta box."
        missing = await rig.http.get("/api/chat/images/none", headers=header)
        assert missing.json()["detail"] == "Seda pilti enam ei hoita."


async def test_after_a_break_a_page_gets_what_it_missed_and_only_that() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.appear("Bob")
        await page.until(lambda: page.of("robot"))
        await page.io.disconnect()
        rig.robots.appear("Cleo")
        rig.robots.appear("Dora")
        await rig.until(lambda: "Dora" in rig.server.backend.state.robots.views)
        await page.open(rig.url, again=True)
        await page.until(lambda: len(page.of("robot")) == 3)
        assert [change["robot"]["name"] for change in page.of("robot")] == ["Bob", "Cleo", "Dora"]
        numbers = [change["seq"] for change in page.changes]
        assert numbers == sorted(set(numbers))
        assert len(page.snapshots) == 1


async def test_a_page_of_another_run_starts_anew() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        await page.io.disconnect()
        page.run, page.seq = "another", 3
        await page.open(rig.url, again=True)
        await page.until(lambda: len(page.snapshots) == 2)


async def test_what_a_page_missed_for_too_long_comes_as_a_snapshot() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        await page.io.disconnect()
        log = rig.server.backend.state.log
        for number in range(6000):
            rig.server.backend.state.robots.add(f"robot {number}")
            rig.server.backend.state.robots.remove(f"robot {number}")
        assert log.since(page.seq) is None
        await page.open(rig.url, again=True)
        await page.until(lambda: len(page.snapshots) == 2)
        assert page.seq == log.seq


async def test_pictures_come_to_those_who_watch() -> None:
    async with served("Ada") as rig:
        watching, other = await rig.page(), await rig.page()
        rig.robots.show("Ada", "inspection")
        await watching.until(lambda: watching.of("feed"))
        await watching.io.emit("watch", [{"robot": "Ada", "name": "inspection"}])
        await watching.until(lambda: watching.frames)
        meta, data = watching.frames[0]
        assert data == JPEG
        assert (meta["robot"], meta["name"], meta["unix_ms"]) == ("Ada", "inspection", 1_790_000_000_000)
        assert other.frames == []


async def test_a_page_that_confirms_nothing_gets_two_pictures_and_then_the_newest() -> None:
    clock = HandClock()
    async with served("Ada", clock=clock) as rig:
        slow, quick = await rig.page(), await rig.page()
        slow.confirms = False
        feed = [{"robot": "Ada", "name": "inspection"}]
        rig.robots.show("Ada", "inspection")
        await slow.until(lambda: slow.of("feed"))
        for page in (slow, quick):
            await page.io.emit("watch", feed)
        for number in range(1, 20):
            rig.robots.show("Ada", "inspection", JPEG + bytes([number]), 1_790_000_000_000 + number)
            await until_it_shows(quick, number)
        assert len(quick.frames) >= 19
        assert len(slow.frames) == 2
        clock.ahead_s = CONFIRM_WITHIN_S + 0.1  # what was not confirmed counts as lost
        rig.robots.show("Ada", "inspection", JPEG + bytes([20]), 1_790_000_000_020)
        await until_it_shows(slow, 20)
        assert len(slow.frames) == 3


async def test_a_page_may_look_away_while_pictures_are_on_their_way() -> None:
    names = [f"camera {number}" for number in range(8)]
    feeds = [{"robot": "Ada", "name": name} for name in names]
    async with served("Ada") as rig:
        page = await rig.page()
        for name in names:
            rig.robots.show("Ada", name)
        await page.until(lambda: len({change["feed"]["name"] for change in page.of("feed")}) == len(names))
        for _ in range(20):
            await page.io.emit("watch", feeds)
            await page.io.emit("watch", [])
        await page.io.emit("watch", feeds[-1:])
        rig.robots.show("Ada", names[-1], JPEG + b"!")
        await until_it_shows(page, ord("!"))


async def test_nonsense_from_a_page_does_no_harm() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        pieces: list[Any] = [None, 5, "x", [1], [{"robot": "Ada"}], {"a": []}, [{"robot": "", "name": ""}]]
        for nonsense in pieces:
            await page.io.emit("watch", nonsense)
        await page.io.emit("no such event", {"a": 1})
        rig.robots.appear("Bob")
        await page.until(lambda: page.of("robot"))


async def test_a_server_that_starts_later_shows_the_plans_that_wait() -> None:
    async with (
        served() as rig,
        UmrfPlanner(rig.robots.transport, WallClock(), known_robots=["Ada"], approval="ask_first"),
    ):
        rig.robots.tell(topics.CHAT_ACTION, ChatAction(queue=(ActionCall(name="Look"),), targets=("Ada",)))
        await rig.until(lambda: rig.server.backend.state.plans.proposals)
        async with WebServer(rig.robots.transport, WebConfig(port=0)) as late:
            page = Page()
            rig.pages.append(page)
            await page.open(late.url)
            await page.until(lambda: page.snapshots)
            await page.until(lambda: page.snapshots[0]["proposals"] or page.of("proposal"))
            assert late.backend.state.plans.proposals == rig.server.backend.state.plans.proposals


async def test_what_asks_for_a_yes_does_so_until_that_is_decided() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.tell(topics.PLAN, PlanProposal(id="p1", target="Ada", steps=(ActionCall(name="Look"),)))
        await page.until(lambda: page.of("proposal"))
        rig.robots.say("I would look?", asks_yes=True)
        await page.until(lambda: page.of("chat"))
        rig.robots.tell(topics.PLAN, PlanUpdate(target="Ada", state="idle"))
        await page.until(lambda: len(page.of("chat")) == 2)
        assert [one["entry"]["asks_yes"] for one in page.of("chat")] == [True, False]


async def test_a_graph_that_others_started_is_shown_whole() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        whole = write_graph(Graph("g9", (Node("Look"), Node("Move")), state=GraphState.RUNNING))
        feedback = rig.robots.transport.publisher(topics.GRAPH_FEEDBACK)
        feedback.publish(UmrfGraphFeedback("Ada", ("{", whole)))
        await page.until(lambda: page.of("plan"))
        plan = page.of("plan")[0]["plan"]
        assert (plan["kind"], [step["action"] for step in plan["steps"]]) == ("graph", ["Look", "Move"])


async def test_places_on_the_map_come_with_the_snapshot_and_then_live() -> None:
    async with served("Ada") as rig:
        rig.robots.tell(topics.MAP_VIEW, MapView(actor="Ada", pose=PoseInfo(x=1, y=2)))
        await rig.heard()
        page = await rig.page()
        assert page.snapshots[0]["views"][0]["pose"]["x"] == 1
        rig.robots.tell(topics.MAP_VIEW, MapView(actor="Ada", pose=PoseInfo(x=3, y=2)))
        await page.until(lambda: page.views)
        assert page.views[-1]["pose"]["x"] == 3


async def test_who_only_asks_gets_the_same_changes() -> None:
    async with served("Ada") as rig:
        before = (await rig.http.get("/api/snapshot")).json()
        rig.robots.appear("Bob")
        await rig.until(lambda: "Bob" in rig.server.backend.state.robots.views)
        query = {"since": before["seq"], "run": before["run"]}
        changes = (await rig.http.get("/api/changes", params=query)).json()
        assert [change["robot"]["name"] for change in changes] == ["Bob"]
        other = await rig.http.get("/api/changes", params=query | {"run": "another"})
        assert other.status_code == 409


async def test_a_client_that_stops_reading_holds_nobody_up() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        _, writer = await stalled_client(rig.url)
        for number in range(100):
            rig.robots.say(f"{number} {'x' * 200_000}")
            await until_it_heard(page, number + 1)
        waiting = [client.queue.qsize() for client in rig.server.live.server.eio.sockets.values()]
        assert len(waiting) == 2
        assert max(waiting) <= 4, "what a slow client has not taken must not pile up"
        writer.close()


async def stalled_client(url: str) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    """A client that opens the live stream and then never reads again."""
    host, _, port = url.removeprefix("http://").rstrip("/").rpartition(":")
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    raw.setblocking(False)
    await asyncio.get_running_loop().sock_connect(raw, (host, int(port)))
    reader, writer = await asyncio.open_connection(sock=raw, limit=1024)
    writer.write(
        (
            f"GET /socket.io/?EIO=4&transport=websocket HTTP/1.1\r\nHost: {host}:{port}\r\n"
            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        ).encode()
    )
    await reader.readuntil(b"\r\n\r\n")
    text = b"40"  # Engine.IO message, Socket.IO connect
    mask = b"\0\0\0\0"
    writer.write(bytes([0x81, 0x80 | len(text)]) + mask + text)
    await writer.drain()
    return reader, writer


async def test_a_page_that_was_opened_stays_however_many_strangers_listen() -> None:
    async with served("Ada") as rig:
        await rig.http.get("/")
        cookie = "; ".join(f"{name}={value}" for name, value in rig.http.cookies.items())
        page = await rig.page(headers={"Cookie": cookie})
        first = await rig.page()
        for _ in range(MAX_STRANGERS // 2):
            await rig.page()
        await first.io.wait()
        rig.robots.appear("Bob")
        await until_it_knows(page, 2)
