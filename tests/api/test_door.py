"""Robots from Python: what is said is done, and the gate is where it was."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from httpx import AsyncClient

from parley.api import (
    ConfigError,
    Events,
    GraphEvent,
    GraphRefusedError,
    NotAllowedError,
    Parley,
    ParleyError,
    PlanUpdate,
    Principal,
    Site,
    StopReport,
    SyncParley,
    action,
    person,
    program,
    step,
)
from parley.messages.audit import AuditList
from parley.messages.ros import ChatRequest
from parley.messages.topics import GET_AUDIT
from parley.messages.wire import decode
from parley.system import System
from tests.sim.worlds import two_rooms

ADA, BOT, KNOWN = person("Ada"), program("bot"), program("bot", key="warehouse")
GO = (step("GetCoordinates", target="green crate"), step("NavigateTo"))
EXAMPLES = Path(__file__).parent.parent.parent / "examples"


def site() -> Site:
    world = two_rooms()
    return Site(world.object_map(), None, world)


@asynccontextmanager
async def parley(by: Principal = ADA, **config: Any) -> AsyncIterator[Parley]:
    async with Parley(site(), by=by, config={"speed": None} | config) as opened:
        yield opened


async def ended(events: Events) -> list[str]:
    """The states of a plan's steps, once it has ended."""
    async for event in events:
        if isinstance(event, PlanUpdate) and event.state == "idle" and event.steps:
            return [step.state for step in event.steps]
    raise AssertionError("the stream ended")


async def test_what_a_person_says_is_done_and_told() -> None:
    async with parley() as p, p.events("a") as events:
        reply = await p.say("a", "go to the green crate")
        assert "green crate" in reply.message
        assert await ended(events) == ["finished", "finished"]
        assert (await p.settled("A")).state == "idle"


async def test_to_go_on_is_a_yes_to_what_a_robot_that_stands_has_just_asked() -> None:
    async with parley(speed=1.0) as p, p.events("A") as events:
        await p.say("A", "go to the green crate")
        await p.say("A", "stop")
        asked = await p.say("A", "turn around instead")
        assert p.proposal("A") is not None and "Shall I?" in asked.message
        await p.say("A", "carry on")
        while (states := await ended(events))[2:] != [
            "finished"
        ]:  # what is left out may end before the rest comes
            pass
        assert states == ["finished", "skipped", "finished"]
        assert p.proposal("A") is None and p.plan("A").steps[2].label.startswith("Turn")


async def test_who_is_told_to_stop_and_come_comes_when_it_hears_where_to() -> None:
    async with parley(speed=1.0) as p:
        await p.say("A", "turn around")
        await p.say("A", "stop and come to me")
        assert "green crate" in (await p.say("A", "I'm at the green crate")).message
        assert any("green crate" in step.label for step in p.plan("A").steps)


@pytest.mark.parametrize("by", [BOT, Principal()])
async def test_a_program_that_nobody_knows_proposes_by_words_and_by_orders(by: Principal) -> None:
    async with parley(by) as p:
        await p.say("A", "go to the green crate")
        by_words = p.proposal("A")
        assert (await p.order("A", *GO)).outcome == "asked"
        by_order = p.proposal("A")
        assert by_words is not None and by_order is not None and by_words.id != by_order.id
        assert p.plan("A").state == "awaiting_approval"


async def test_a_program_with_a_key_does_as_the_policy_says() -> None:
    async with parley(KNOWN) as p:
        assert (await p.order("A", *GO)).outcome == "done"
    async with parley(KNOWN, approval="ask_first") as p:
        assert (await p.order("A", *GO)).outcome == "asked"


async def test_a_yes_is_a_persons_and_counts_for_what_was_shown() -> None:
    async with parley(approval="ask_first") as p, p.events("A") as events:
        await p.say("A", "go to the green crate")
        shown = p.proposal("A")
        assert shown is not None
        for nobody in (BOT, KNOWN, person("Kim", role="viewer")):
            with pytest.raises(NotAllowedError):
                await p.approve(shown, by=nobody)
        await p.approve(shown.model_copy(update={"digest": "of something else"}))
        again = p.proposal("A")
        assert again is not None and again.id != shown.id and p.plan("A").state == "awaiting_approval"
        await p.approve(again)
        assert await ended(events) == ["finished", "finished"]


async def test_a_stop_comes_from_any_thread_and_is_released_by_a_person() -> None:
    async with parley() as p:
        thread = threading.Thread(target=p.stop, kwargs={"by": BOT})
        thread.start()
        thread.join()
        assert p._opened.stop_line.latched("A")
        with pytest.raises(NotAllowedError):
            p.reset(by=BOT)
        assert p._opened.stop_line.latched("A")
        p.reset("A")
        assert not p._opened.stop_line.latched("A")
        wanted = {("stop", BOT, "done"), ("reset", BOT, "refused"), ("reset", ADA, "done")}
        async with asyncio.timeout(20):
            while not wanted <= await logged(p):
                pass  # it is written behind


async def test_who_releases_a_stop_may_say_to_go_on_in_the_same_breath() -> None:
    async with parley(speed=1.0) as p:
        await p.say("A", "go to the green crate")
        for told in (False, True):  # before it has told that it was stopped, and after
            p.stop()
            if told:
                async with asyncio.timeout(20):
                    await p._listener.until(lambda: p._listener.statuses["A"].state == "stopped")
            p.reset()
            assert (await p.say("A", "carry on")).message == "I am going on."


async def logged(p: Parley) -> set[tuple[str, Principal | None, str]]:
    reply = await p._opened.transport.call(GET_AUDIT, ChatRequest("{}"), timeout_s=5)
    return {(entry.effect, entry.by, entry.outcome) for entry in decode(AuditList, reply.response).entries}


async def test_going_on_is_a_persons_to_say() -> None:
    async with parley(speed=1.0) as p:
        await p.say("A", "go to the green crate")
        await p.control("A", "pause")
        assert p.plan("A").state == "paused"
        with pytest.raises(NotAllowedError):
            await p.control("A", "resume", by=KNOWN)
        with pytest.raises(NotAllowedError, match="yes"):
            await p.start(graph("past it"), "A", by=KNOWN)
        assert p.plan("A").state == "paused"


def graph(name: str, action: str = "GetCoordinates") -> dict[str, Any]:
    number = {"pvf_type": "number"}
    pose = {"position": dict.fromkeys("xyz", number), "orientation": dict.fromkeys("rpy", number)}
    node = {"name": action, "instance_id": 0}
    return {
        "graph_name": name,
        "graph_entry": [node],
        "graph_exit": [node],
        "actions": [
            node
            | {
                "type": "sync",
                "input_parameters": {"target": {"pvf_type": "string", "pvf_value": "green crate"}},
                "output_parameters": {"pose": pose},
            }
        ],
    }


async def test_a_graph_runs_and_tells_each_transition_once(tmp_path: Path) -> None:
    file = tmp_path / "one.graph.json"
    file.write_text(json.dumps(graph("one")), encoding="utf-8")
    async with parley() as p:
        run = await p.start(file, "A")
        told = [event async for event in run]
        assert [event.sequence for event in told] == list(range(len(told)))
        assert run.state == told[-1].state
        assert all(isinstance(event, GraphEvent) and event.graph_name == "one" for event in told)


async def test_a_graph_needs_whoever_may_begin() -> None:
    async with parley(approval="ask_first") as p:
        for nobody in (BOT, KNOWN, person("Kim", role="viewer")):
            with pytest.raises(NotAllowedError):
                await p.start(graph("one"), "A", by=nobody)
        assert p._listener.statuses["A"].graphs == {}


async def test_a_graph_that_cannot_run_is_refused_with_its_reasons() -> None:
    async with parley() as p:
        with pytest.raises(GraphRefusedError, match="Fly"):
            await p.start(graph("no", "Fly"), "A")


async def test_memory_is_kept_found_and_forgotten_by_a_person() -> None:
    async with parley() as p:
        await p.remember("key", "The key is in the drawer.")
        (found,) = await p.memories("key")
        assert (found.data, found.way, found.source) == ("The key is in the drawer.", "told", "Ada")
        with pytest.raises(NotAllowedError):
            await p.forget("key", by=BOT)
        await p.forget("key")
        assert await p.memories() == []
        with pytest.raises(ParleyError, match="nothing under the name"):
            await p.forget("key")


async def test_a_question_is_answered() -> None:
    async with parley() as p:
        await p.order("A", step("AskOperator", question="Left or right?"))
        await p.settled("A")
        question = p.question("A")
        assert question is not None and "Left or right" in question.message
        await p.answer("A", "left")
        assert p.question("A") is None
        with pytest.raises(ParleyError, match="asks nothing"):
            await p.answer("A", "left")


async def test_own_actions_are_given_as_functions_and_as_folders() -> None:
    @action(phrases=("honk",), effects=("plays_sound",))
    async def honk(ctx: Any) -> None:
        """Honk."""
        ctx.operator.tell("Honk!")

    given: list[Any] = [honk, EXAMPLES / "actions"]
    async with (
        Parley(site(), by=ADA, config={"speed": None}, actions=given) as p,
        p.events("A") as events,
    ):
        assert (await p.order("A", step("Honk"), step("ReportBattery"))).outcome == "done"
        assert await ended(events) == ["finished", "finished"]


async def test_what_is_wrong_is_said_where_it_is_given() -> None:
    with pytest.raises(ConfigError, match="no folder or file"):
        async with Parley("nowhere"):
            pass
    with pytest.raises(ConfigError, match="no folder or file"):
        Site.load("nowhere")
    with pytest.raises(ConfigError, match="speeed"):
        async with Parley(site(), config={"speeed": 1}):
            pass
    with pytest.raises(ConfigError, match="no robots"):
        async with Parley(Site.floor(2, 2)):
            pass
    async with parley() as p:
        with pytest.raises(ConfigError, match="there are: A"):
            await p.say("B", "hello")
    with pytest.raises(ParleyError, match="not open"):
        p.plan("A")


async def test_a_listener_that_is_too_slow_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("parley.api.listening.KEPT", 3)
    async with parley() as p, p.events() as events:
        await p.say("A", "go to the green crate")
        await p.settled("A")
        with pytest.raises(ParleyError, match="lost"):
            await anext(events)
        await anext(events)


async def test_the_page_shows_the_same_robots() -> None:
    async with parley() as p, p.page(port=0) as page, AsyncClient(base_url=page.address) as browser:
        async with asyncio.timeout(20):
            while not (robots := (await browser.get("/api/robots")).json()):
                pass  # until its next heartbeat is heard
        assert [robot["name"] for robot in robots] == ["A"]
        assert page.code == ""


def test_without_await_it_does_the_same_and_leaves_no_thread() -> None:
    before = set(threading.enumerate())
    with SyncParley(site(), by=ADA, config={"speed": None}) as p:
        assert "green crate" in p.say("A", "go to the green crate").message
        assert [each.state for each in p.settled("A", timeout_s=60).steps] == ["finished", "finished"]
        assert p.run(graph("one"), "A", timeout_s=60)
        heard = p.events("A", timeout_s=0.5)
        p.stop("A")
        assert any(isinstance(event, StopReport) for event in heard)
    left = {t for t in threading.enumerate() if not t.name.startswith("asyncio_")} - before
    assert left == set()
    with pytest.raises(ParleyError, match="not open"):
        p.say("A", "hello")


def test_the_door_closes_what_it_opened_when_opening_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("parley.api.door.OPENS_WITHIN_S", 0.0)
    closed: list[bool] = []
    leave = System.__aexit__

    async def left(self: System, *exc: Any) -> None:
        await leave(self, *exc)
        closed.append(True)

    monkeypatch.setattr(System, "__aexit__", left)

    async def main() -> None:
        async with Parley(site()):
            pass

    with pytest.raises(TimeoutError):
        asyncio.run(main())
    assert closed == [True]
