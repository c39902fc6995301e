"""What robots did: rounds, the handover to the next shift, one round as a file; with the real log."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from parley.agents.audit_log import AuditLog
from parley.errors import FailureCode
from parley.gate.audit_store import AuditStore
from parley.messages import topics
from parley.messages.audit import AuditEntry
from parley.messages.chat import ActionCall, ChatAction, ChatInput
from parley.messages.failure import FailureReport
from parley.messages.incident import Incident
from parley.messages.principal import person
from parley.messages.status import GraphEvent, PlanDecision, PlanUpdate, StopCommand
from parley.web.round_file import round_file
from parley.web.rounds import rounds_of
from tests.web.rig import HandClock, Rig, served

KIM = person("Kim", device="page on a phone")
BEGAN_MS = HandClock().unix_ms() - 60_000
LOOK = ActionCall(name="Inspect", reason="look")


@asynccontextmanager
async def logged() -> AsyncIterator[Rig]:
    async with served("Ada") as rig:
        clock, transport = HandClock(), rig.robots.transport
        async with await AuditStore.open(":memory:", clock) as store, AuditLog(transport, store, clock):
            yield rig


def graph(rig: Rig, name: str, state: str, unix_ms: int, result: str = "") -> None:
    event = GraphEvent(
        actor="Ada", graph_name=name, sequence=0, kind="graph", state=state, result=result, unix_ms=unix_ms
    )
    rig.robots.tell(topics.GRAPH_EVENTS, event)


def node(rig: Rig, name: str, state: str, unix_ms: int, **more: str) -> None:
    event = GraphEvent.model_validate(
        {"actor": "Ada", "graph_name": "one", "sequence": 0, "kind": "node", "node": name, "state": state,
         "unix_ms": unix_ms, **more}
    )  # fmt: skip
    rig.robots.tell(topics.GRAPH_EVENTS, event)


def plan(rig: Rig, name: str, step: str, state: str, *orders: str) -> None:
    one = {"action": LOOK.model_dump(), "label": f"look at <{name}>", "state": step}
    steps = [{**one, "order": order} for order in orders] or [one]
    told = {"target": "Ada", "graph_name": name, "state": state, "steps": steps}
    rig.robots.tell(topics.PLAN, PlanUpdate.model_validate(told))


async def order(rig: Rig, name: str, words: str, began_ms: int) -> None:
    """Somebody says what they want, and the robot begins."""
    rig.robots.tell(topics.CHAT_INPUT, ChatInput(id=name, message=words, targets=("Ada",), by=KIM))
    rig.robots.tell(topics.CHAT_ACTION, ChatAction(queue=(LOOK,), targets=("Ada",), reply_to=name))
    plan(rig, name, "running", "running")
    await rig.heard()
    graph(rig, name, "RUNNING", began_ms)


async def test_every_round_stands_with_who_wanted_it_how_it_ended_and_what_was_seen() -> None:
    async with logged() as rig:
        await order(rig, "one", "look at the <box>", BEGAN_MS)
        rig.robots.show("Ada", "inspection", unix_ms=BEGAN_MS - 5)  # the feed is known now
        await rig.until(lambda: rig.server.backend.state.feeds.infos)
        rig.robots.show("Ada", "inspection", unix_ms=BEGAN_MS + 1000)
        plan(rig, "one", "finished", "idle")  # its graph only halts
        await rig.heard()
        await order(rig, "two", "look at the door", BEGAN_MS + 10_000)

        async def rounds(query: str = "") -> list[dict[str, Any]]:
            return list((await rig.http.get(f"/api/history?{query}")).json()["rounds"])

        await rig.heard()
        second, first = await rounds()
        assert (first["words"], first["by"], first["state"]) == (
            "look at the <box>",
            "Kim (page on a phone)",
            "done",
        )
        assert (second["state"], second["ended_unix_ms"], second["pictures"]) == ("running", 0, [])
        (picture,) = first["pictures"]
        assert (await rig.http.get(str(picture))).headers["content-type"] == "image/jpeg"
        assert [one["words"] for one in await rounds("q=door")] == ["look at the door"]
        assert await rounds("by=ada") == await rounds("robot=Bob") == []
        assert [one["number"] for one in await rounds(f"before={second['number']}")] == [first["number"]]

        file = await rig.http.get(f"/api/history/file?number={first['number']}&language=et")
        assert "attachment" in file.headers["content-disposition"]
        assert "look at the &lt;box&gt;" in file.text and "<box>" not in file.text
        assert "<li>vaata &lt;one&gt;</li>" in file.text
        assert [one["steps"] for one in await rounds("language=et")] == [["vaata <two>"], ["vaata <one>"]]
        assert "data:image/jpeg;base64," in file.text and "Kim (leht telefonis)" in file.text
        assert (await rig.http.get("/api/history/file?number=1")).status_code == 404


async def test_what_was_wished_while_it_went_on_stands_beside_what_was_wished_first() -> None:
    async with logged() as rig:
        await order(rig, "one", "look at the box", BEGAN_MS)
        for name in ("one", "two", "three"):  # nothing of the last becomes part of it
            words = {"one": "look at the box", "two": "Is the door shut?", "three": "no"}[name]
            rig.robots.tell(topics.CHAT_INPUT, ChatInput(id=name, message=words, targets=("Ada",), by=KIM))
            rig.robots.tell(
                topics.CHAT_ACTION, ChatAction(queue=(LOOK,), targets=("Ada",), reply_to=name, id=name)
            )
        plan(rig, "one", "finished", "running", "one", "two")
        await rig.heard()
        graph(rig, "one", "FINISHED", BEGAN_MS + 2000)
        await rig.heard()
        (found,) = (await rig.http.get("/api/history")).json()["rounds"]
        assert (found["words"], found["state"]) == ("look at the box. Is the door shut?", "done")
        for words, count in (("door", 1), ("BOX", 1), ("window", 0)):
            assert len((await rig.http.get(f"/api/history?q={words}")).json()["rounds"]) == count, words

        rig.robots.tell(
            topics.PLAN_DECISION, PlanDecision(target="Ada", decision="edit", steps=(LOOK,), by=KIM)
        )
        await rig.heard()
        graph(rig, "four", "RUNNING", BEGAN_MS + 3000)  # put back: that is not what was said last
        await rig.heard()
        (again, _) = (await rig.http.get("/api/history")).json()["rounds"]
        assert (again["words"], again["by"], again["steps"]) == ("", "Kim (page on a phone)", ["Inspect"])


@pytest.mark.parametrize("anew", ["two", "one"])
async def test_what_was_given_up_and_put_back_is_one_round_with_all_that_was_done(anew: str) -> None:
    async with logged() as rig:

        async def tell(name: str, state: str, **steps: str) -> None:
            shown = [
                {"action": LOOK.model_dump(), "id": what, "label": what, "state": step, "order": "o"}
                for what, step in steps.items()
            ]
            told = {"target": "Ada", "graph_name": name, "state": state, "steps": shown}
            rig.robots.tell(topics.PLAN, PlanUpdate.model_validate(told))
            await rig.heard()

        async def rounds(query: str = "") -> list[dict[str, Any]]:
            return list((await rig.http.get(f"/api/history?{query}")).json()["rounds"])

        rig.robots.tell(topics.CHAT_INPUT, ChatInput(id="o", message="all three", targets=("Ada",), by=KIM))
        rig.robots.tell(topics.CHAT_ACTION, ChatAction(queue=(LOOK,), targets=("Ada",), reply_to="o", id="o"))
        await tell("one", "running", box="running", door="queued", lamp="queued")
        graph(rig, "one", "RUNNING", BEGAN_MS)
        incident = Incident(
            id="1", code=FailureCode.ATTENTION, message="A bag.", robot="Ada", graph_name=anew, step=LOOK
        )
        await tell("one", "running", box="finished", door="running", lamp="queued")
        skips = anew == "one"  # of a plan that has run dry
        if skips:
            await tell("one", "idle", box="finished", door="skipped", lamp="skipped")
        else:
            await tell("", "idle", box="finished", door="stopped", lamp="stopped")
        (left,) = await rounds()
        assert (left["state"], left["left"]) == ("partly" if skips else "ended", ["door", "lamp"])

        put_back = PlanDecision(
            target="Ada", decision="edit", steps=(LOOK, LOOK), undoes=("door", "lamp"), by=person("Ann")
        )
        rig.robots.tell(topics.PLAN_DECISION, put_back)
        done = {"box": "finished"} if skips else {}
        await tell(anew, "running", **done, door="running", lamp="queued")
        graph(rig, anew, "RUNNING", BEGAN_MS + 10_000)
        rig.robots.tell(topics.INCIDENT, incident)
        await rig.heard()
        (goes_on,) = await rounds()
        assert (goes_on["number"], goes_on["state"]) == (left["number"], "running")
        await tell(anew, "idle", **done, door="finished", lamp="finished")
        await rig.heard()
        (whole,) = await rounds()
        assert (whole["number"], whole["words"], whole["state"]) == (left["number"], "all three", "done")
        assert (whole["steps"], whole["left"], whole["found"]) == (["box", "door", "lamp"], [], ["A bag."])
        assert whole["by"] == "Kim (page on a phone)"
        assert await rounds("q=three") == [whole] == await rounds("q=lamp")
        told = (await rig.http.get("/api/history/handover?since=1")).json()
        assert [one["number"] for one in told["rounds"]] == [whole["number"]]
        file = (await rig.http.get(f"/api/history/file?number={whole['number']}")).text
        assert "It was done." in file
        await order(rig, "three", "look at the door", BEGAN_MS + 20_000)  # and nothing else goes on with it
        await rig.heard()
        assert [one["words"] for one in await rounds()] == ["look at the door", "all three"]


async def test_what_a_restart_cut_off_is_one_round_with_who_wanted_it() -> None:
    async with served("Ada") as rig:
        clock, transport = HandClock(), rig.robots.transport
        async with await AuditStore.open(":memory:", clock) as store:

            async def tell(graph_name: str, state: str, step: str, continues: str = "") -> None:
                steps = [{"action": LOOK.model_dump(), "label": "look at the box", "state": step}]
                told = {"target": "Ada", "graph_name": graph_name, "state": state, "steps": steps}
                rig.robots.tell(topics.PLAN, PlanUpdate.model_validate({**told, "continues": continues}))
                await rig.heard()

            async def rounds() -> list[tuple[str, str, str, int]]:
                await rig.heard()
                found = (await rig.http.get("/api/history")).json()["rounds"]
                return [(one["words"], one["by"], one["state"], len(one["steps"])) for one in found]

            who = "Kim (page on a phone)"
            async with AuditLog(transport, store, clock):
                await order(rig, "one", "look at the box", BEGAN_MS)
                await rig.heard()
            async with AuditLog(transport, store, clock):
                await tell("", "paused", "queued", "one")
                assert await rounds() == [("look at the box", who, "running", 1)]
                await tell("two", "running", "running", "one")
                graph(rig, "two", "RUNNING", BEGAN_MS + 1000)
                assert await rounds() == [("look at the box", who, "running", 1)]
            async with AuditLog(transport, store, clock):  # and once more, and then it is given up
                await tell("", "paused", "queued", "two")
                await tell("", "idle", "stopped", "two")
                assert await rounds() == [("look at the box", who, "ended", 1)]

                rig.robots.tell(
                    topics.CHAT_INPUT, ChatInput(id="x", message="the door", targets=("Ada",), by=KIM)
                )
                rig.robots.tell(topics.CHAT_ACTION, ChatAction(queue=(LOOK,), targets=("Ada",), reply_to="x"))
                await rig.heard()
            async with AuditLog(transport, store, clock):  # before somebody says yes to it
                yes = PlanDecision(target="Ada", id="p", decision="approve", by=person("Ann"))
                rig.robots.tell(topics.PLAN_DECISION, yes)
                await tell("three", "running", "running")
                graph(rig, "three", "RUNNING", BEGAN_MS + 2000)
                assert (await rounds())[0] == ("the door", who, "running", 1)


async def test_how_long_it_took_counts_neither_the_wait_for_an_answer_nor_standing_still() -> None:
    async with logged() as rig:
        await order(rig, "one", "look at the box", BEGAN_MS)

        node(rig, "Inspect_1", "RUNNING", BEGAN_MS)
        node(rig, "Inspect_1", "PAUSED", BEGAN_MS + 1000)
        node(rig, "Inspect_1", "RUNNING", BEGAN_MS + 4000)
        node(rig, "Inspect_1", "FINISHED", BEGAN_MS + 6000)
        node(rig, "AskOperator_1", "RUNNING", BEGAN_MS + 6000)
        ask = ActionCall(name="AskOperator").model_dump()
        asks = {"action": ask, "node": "AskOperator_1", "state": "waiting"}
        told = {"target": "Ada", "graph_name": "one", "state": "running", "steps": [asks]}
        rig.robots.tell(topics.PLAN, PlanUpdate.model_validate(told))
        await rig.heard()
        node(rig, "AskOperator_1", "FINISHED", BEGAN_MS + 30_000)
        graph(rig, "one", "FINISHED", BEGAN_MS + 30_001)
        await rig.heard()
        (found,) = (await rig.http.get("/api/history")).json()["rounds"]
        assert (found["state"], found["worked_ms"]) == ("done", 3000)


async def test_the_next_shift_is_told_what_was_done_what_failed_what_waits_and_who_stopped_what() -> None:
    async with logged() as rig:
        await order(rig, "one", "look at the box", BEGAN_MS)
        report = FailureReport(message="I looked, but I cannot see the box.", code=FailureCode.NO_MATCH)
        node(rig, "Inspect_1", "ERROR", BEGAN_MS + 1000, result="on_error", message=report.to_text())
        graph(rig, "one", "FINISHED", BEGAN_MS + 2000, "on_error")
        rig.robots.tell(topics.STOP, StopCommand(targets=("Ada",), by=KIM))
        rig.robots.ask("Which box?", "red", "blue")
        await rig.heard()
        told = (await rig.http.get("/api/history/handover?since=1")).json()
        assert [(one["state"], one["reason"]) for one in told["rounds"]] == [("failed", report.message)]
        assert [text for _, text in told["stops"]] == ["Kim (page on a phone) stopped Ada."]
        assert "Ada asks: Which box?" in told["waits"]
        later = (await rig.http.get(f"/api/history/handover?since={BEGAN_MS + 1}")).json()
        assert later["rounds"] == []


async def test_of_a_robot_that_asks_nobody_is_told_that_it_was_held() -> None:
    async with logged() as rig:
        plan(rig, "one", "paused", "running")
        plan(rig, "one", "waiting", "held")
        await rig.heard()

        async def waits() -> list[str]:
            return list((await rig.http.get("/api/history/handover?since=1")).json()["waits"])

        assert await waits() == ["Ada cannot go on alone with: look at <one>"]
        rig.robots.ask("Which box?", "red", "blue")
        await rig.heard()
        assert await waits() == ["Ada asks: Which box?"]
        plan(rig, "one", "paused", "paused")
        await rig.heard()
        assert await waits() == ["Ada asks: Which box?", "Ada was held with steps left: look at <one>"]


async def test_what_a_stopped_robot_was_at_is_told_with_that_it_is_stopped() -> None:
    async with logged() as rig:
        plan(rig, "one", "paused", "paused")
        rig.robots.tell(topics.STOP, StopCommand(targets=("Ada",), by=KIM))
        await rig.heard()
        (only,) = (await rig.http.get("/api/history/handover?since=1")).json()["waits"]
        assert only == "Ada is stopped until somebody releases it, with steps left: look at <one>"


def test_what_has_no_end_in_the_log_is_not_said_to_have_been_ended() -> None:
    start = AuditEntry(
        number=1, unix_ms=BEGAN_MS, effect="start", robot="Ada", detail={"graph": "one"}, prev="", hash=""
    )
    (lost,) = rounds_of([start], [], frozenset())
    (goes_on,) = rounds_of([start], [], frozenset({("Ada", "one")}))
    assert (lost.state, goes_on.state) == ("unrecorded", "running")
    assert "Its end was not recorded." in round_file(lost, (), (), "en")


async def test_what_was_left_out_is_not_told_as_done() -> None:
    async with logged() as rig:
        await order(rig, "one", "look at the box and the door", BEGAN_MS)
        steps = [
            {"action": LOOK.model_dump(), "label": f"look at the {what}", "state": state}
            for what, state in (("box", "skipped"), ("door", "skipped"), ("box", "finished"))
        ]
        told = {"target": "Ada", "graph_name": "one", "state": "idle", "steps": steps}
        rig.robots.tell(topics.PLAN, PlanUpdate.model_validate(told))
        await rig.heard()
        graph(rig, "one", "FINISHED", BEGAN_MS + 5000)
        await rig.heard()
        (found,) = (await rig.http.get("/api/history")).json()["rounds"]
        assert (found["state"], found["left"]) == ("partly", ["look at the door"])  # the box came later
        file = (await rig.http.get(f"/api/history/file?number={found['number']}")).text
        assert "It was done in part." in file and "<dt>Left out</dt><dd>look at the door</dd>" in file


async def test_what_a_robot_came_upon_stands_with_the_round_and_with_no_other() -> None:
    async with logged() as rig:
        await order(rig, "one", "look at the boxes", BEGAN_MS)
        seen = {"robot": "Ada", "graph_name": "one", "step": LOOK}
        bag = Incident(id="1", code=FailureCode.ATTENTION, message="I can see a <bag>.", **seen)
        hidden = Incident(id="2", code=FailureCode.NO_MATCH, message="I cannot see the box.", **seen)
        rig.robots.tell(topics.INCIDENT, bag)
        rig.robots.tell(topics.INCIDENT, hidden)
        rig.robots.tell(topics.INCIDENT, bag.model_copy(update={"id": "3", "robot": "Bob"}))
        graph(rig, "one", "FINISHED", BEGAN_MS + 5000)
        await order(rig, "two", "look at the door", BEGAN_MS + 10_000)
        await rig.heard()
        second, first = (await rig.http.get("/api/history")).json()["rounds"]
        assert (first["found"], second["found"]) == (["I can see a <bag>."], [])
        file = (await rig.http.get(f"/api/history/file?number={first['number']}")).text
        assert "<dt>Found</dt><dd>I can see a &lt;bag&gt;.</dd>" in file
