"""Buttons: sent again until the planner has them, never behind what came later, and told of if it has not."""

from __future__ import annotations

import asyncio
from typing import Literal

import pytest

from parley.messages import topics
from parley.messages.chat import ActionCall, ChatRead, Press, PressTaken
from parley.messages.status import PlanProposal, PlanStep, PlanUpdate
from parley.web import outbox
from tests.transport.backends import until
from tests.web.rig import Rig, served


async def planned(rig: Rig) -> None:
    """Let a planner come that says what it takes, and propose something."""
    rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1"))
    steps = (ActionCall(name="GoTo"),)
    rig.robots.tell(topics.PLAN, PlanProposal(id="p1", target="Ada", steps=steps, digest="d"))
    await rig.heard()


async def post(rig: Rig, what: str, **body: str) -> None:
    answer = await rig.http.post(f"/api/plans/Ada/{what}", json=body)
    assert answer.status_code == 200, answer.text


async def test_a_button_is_sent_again_as_it_was_until_the_planner_has_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "AGAIN_S", 0.02)
    async with served("Ada") as rig:
        await planned(rig)
        await post(rig, "command", command="pause")
        await until(lambda: len(rig.robots.orders) > 2)
        (press,) = {order.press for order in rig.robots.orders}
        assert press is not None and press.to == "r1"
        rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1", id=press.id))
        await until(lambda: not rig.server.backend.outbox.waiting)


async def test_a_planner_of_another_make_gets_a_button_once() -> None:
    async with served("Ada") as rig:
        await post(rig, "command", command="pause")
        await rig.heard()
        assert [order.press for order in rig.robots.orders] == [None]
        await until(lambda: not rig.server.backend.outbox.waiting)


class Engine:
    """What the engine of Ada hears."""

    def __init__(self, rig: Rig) -> None:
        self.rig, self.heard = rig, list[str]()

    async def listen(self) -> None:
        transport = self.rig.robots.transport
        await transport.subscribe(
            topics.GRAPH_PAUSE, lambda m: self.heard.append(f"pause {m.umrf_graph_name}")
        )
        await transport.subscribe(
            topics.GRAPH_RESUME, lambda m: self.heard.append(f"resume {m.umrf_graph_name}")
        )

    def told(self, state: str) -> None:
        """It says how its graph fares."""
        self.rig.robots.appear(
            state="idle" if state == "HALTED" else state.lower(),
            graphs={"g": state, "old": "HALTED"},
            holds=sorted(self._held),
        )

    @property
    def _held(self) -> set[str]:
        held = set[str]()
        for stop in self.rig.robots.stops:
            (held.add if stop.command == "hold" else held.discard)(stop.id)
        return held

    @property
    def is_held(self) -> bool:
        """Whether its drive is."""
        return bool(self._held)


async def test_a_pause_needs_nobody_who_plans_nor_does_going_on_after_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "HALTED_WITHIN_S", 0.1)
    monkeypatch.setattr(outbox, "PRESSED_WITHIN_S", 0.3)
    async with served("Ada") as rig:
        page, engine = await rig.page(), Engine(rig)
        await engine.listen()
        rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1"))
        steps = (PlanStep(action=ActionCall(name="Go"), state="running"),)
        rig.robots.tell(topics.PLAN, PlanUpdate(target="Ada", graph_name="g", state="running", steps=steps))
        engine.told("RUNNING")
        await rig.heard()

        await post(rig, "command", command="pause")
        await until(lambda: engine.is_held and engine.heard == ["pause g"])
        engine.told("PAUSED")
        await page.until(lambda: page.of("chat"))
        assert "stands still" in page.of("chat")[-1]["entry"]["message"]
        assert engine.is_held, "what is planned late must not move it"

        await post(rig, "command", command="resume")
        await until(lambda: engine.heard[1:] == ["resume g"] and not engine.is_held)
        await page.until(lambda: "to go on" in page.of("chat")[-1]["entry"]["message"])
        engine.told("RUNNING")
        await rig.heard()

        await post(rig, "command", command="resume")
        await post(rig, "command", command="pause")  # before the one before it is told to the robot
        await until(lambda: engine.heard[2:] == ["pause g"])
        engine.told("PAUSED")
        taken = [order.press for order in rig.robots.orders if order.system_cmd[0].command == "stop"][-1]
        assert taken is not None
        rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1", id=taken.id))
        await until(lambda: not engine.is_held)
        await until(lambda: not rig.server.backend.outbox.waiting)
        assert engine.heard[3:] == []


async def test_a_plan_that_waits_for_a_person_is_not_gone_on_with_past_who_plans(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "HALTED_WITHIN_S", 0.05)
    monkeypatch.setattr(outbox, "PRESSED_WITHIN_S", 0.2)
    async with served("Ada") as rig:
        page, engine = await rig.page(), Engine(rig)
        await engine.listen()
        await planned(rig)
        engine.told("PAUSED")
        await rig.heard()
        engine.told("HALTED")
        await rig.heard()
        await post(rig, "command", command="pause")
        await page.until(lambda: page.of("chat"))
        assert page.of("chat")[-1]["entry"]["message"].endswith("stands still; all else has to wait.")
        engine.told("PAUSED")
        await rig.heard()
        await post(rig, "command", command="resume")
        await page.until(lambda: len(page.of("chat")) > 1)
        assert "nothing may have been done" in page.of("chat")[-1]["entry"]["message"]
        assert engine.heard == []


async def test_what_was_pressed_before_something_else_is_not_sent_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "AGAIN_S", 0.02)
    async with served("Ada", "Bob") as rig:
        await planned(rig)
        await post(rig, "decision", id="p1", decision="approve", digest="d")
        await rig.http.post("/api/plans/Bob/command", json={"command": "resume"})
        await until(lambda: len(rig.robots.decisions) > 1)
        await post(rig, "command", command="clear")
        await rig.heard()
        yes = len(rig.robots.decisions)
        await until(lambda: sum(order.targets == ("Ada",) for order in rig.robots.orders) > 3)
        assert len(rig.robots.decisions) == yes
        numbers = {order.targets: order.press.number for order in rig.robots.orders if order.press}
        assert rig.robots.decisions[0].press is not None
        assert rig.robots.decisions[0].press.number < numbers["Bob",] < numbers["Ada",]
        others = sum(order.targets == ("Bob",) for order in rig.robots.orders)
        await until(lambda: sum(order.targets == ("Bob",) for order in rig.robots.orders) > others)


@pytest.mark.parametrize("halting", ["pause", "clear", "stop"])
async def test_what_was_said_before_a_halt_is_not_said_again_after_it(
    monkeypatch: pytest.MonkeyPatch, halting: str
) -> None:
    monkeypatch.setattr(outbox, "AGAIN_S", 0.02)
    async with served("Ada") as rig:
        rig.robots.tell(topics.CHAT_READ, ChatRead())
        await planned(rig)
        await rig.http.post("/api/chat", json={"id": "m1", "text": "go home", "targets": ["Ada"]})
        await until(lambda: len(rig.robots.inputs) > 1)
        if halting == "stop":
            await rig.http.post("/api/stop", json={"command": "stop", "targets": ["Ada"]})
            await until(lambda: rig.robots.stops)
        await post(rig, "command", command="resume" if halting == "stop" else halting)
        await rig.heard()
        said = len(rig.robots.inputs)
        await until(lambda: len(rig.robots.orders) > 3)
        assert len(rig.robots.inputs) == said


async def test_a_button_that_the_planner_does_not_take_is_told_of_and_can_be_pressed_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "PRESSED_WITHIN_S", 0.1)
    monkeypatch.setattr(outbox, "HALTED_WITHIN_S", 0.05)
    async with served("Ada") as rig:
        page = await rig.page()
        await planned(rig)
        for decision in ("approve", "reject"):
            await post(rig, "decision", id="p1", decision=decision, digest="d")
            await until(lambda: not rig.server.backend.outbox.waiting)
        await page.until(lambda: len(page.of("chat")) == 2)
        yes, no = (change["entry"]["message"] for change in page.of("chat"))
        assert "planning does not answer" in yes
        assert "Press Stop" not in yes
        assert "Press Stop" in no
        rig.robots.tell(topics.PLAN, PlanUpdate(target="Ada", graph_name="g", state="running", waits=()))
        await page.until(lambda: page.of("proposal_gone"))


async def test_robots_that_words_hold_which_nobody_reads_are_paused_before_they_are_let_go(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "AGAIN_S", 0.02)
    monkeypatch.setattr(outbox, "RESEND_WITHIN_MS", 100)
    async with served("Ada") as rig:
        rig.robots.tell(topics.CHAT_READ, ChatRead())
        await planned(rig)
        await rig.http.post("/api/chat", json={"id": "m1", "text": "stop", "targets": ["Ada"]})
        await until(lambda: len(rig.robots.inputs) > 1)
        await rig.http.post("/api/plans/Ada/command", json={"command": "resume"})  # takes nothing back

        def pauses() -> list[Press | None]:
            return [order.press for order in rig.robots.orders if order.system_cmd[0].command == "stop"]

        await until(lambda: len(pauses()) > 2)
        assert [stop.command for stop in rig.robots.stops] == ["hold"]
        press = pauses()[0]
        assert press is not None
        rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1", id=press.id))
        await until(lambda: [(stop.command, stop.id) for stop in rig.robots.stops][1:] == [("go_on", "m1")])
        assert not await rig.server.backend.store.unsent()


async def test_a_step_is_dropped_by_what_it_is_called_and_not_by_its_place() -> None:
    async with served("Ada") as rig:
        look = ActionCall(name="Look")
        steps = (
            PlanStep(action=look, id="s1", state="finished"),
            PlanStep(action=look, id="s2", state="running"),
            PlanStep(action=look, id="s3"),
        )
        rig.robots.tell(topics.PLAN, PlanUpdate(target="Ada", graph_name="g", state="running", steps=steps))
        await rig.heard()
        await rig.http.post("/api/plans/Ada/command", json={"command": "pop", "index": 1})
        await rig.heard()
        assert rig.robots.orders[0].system_cmd[0].arguments["step"] == "s3"


async def test_a_planner_that_was_started_anew_is_told_when_people_want_to_be_asked() -> None:
    async with served("Ada") as rig:
        await planned(rig)
        await rig.http.put("/api/plans/Ada/policy", json={"policy": "ask_first"})
        await rig.heard()
        rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r2"))
        await until(lambda: len(rig.robots.decisions) > 1)
        assert {(d.decision, d.policy) for d in rig.robots.decisions} == {("policy", "ask_first")}


@pytest.mark.parametrize(
    ("outcome", "status", "told"),
    [
        ("done", 200, ""),
        ("refused", 422, "Step 3 leads into the bedroom."),
        ("past", 409, "The plan has changed."),
        ("", 504, "Nobody has said yet"),
    ],
)
async def test_whoever_changes_steps_is_told_what_came_of_it(
    monkeypatch: pytest.MonkeyPatch, outcome: Literal["", "done", "refused", "past"], status: int, told: str
) -> None:
    monkeypatch.setattr(outbox, "PRESSED_WITHIN_S", 0.3)
    async with served("Ada") as rig:
        await planned(rig)
        step = PlanStep(action=ActionCall(name="Look"), id="s1")
        rig.robots.tell(topics.PLAN, PlanUpdate(target="Ada", graph_name="g", state="paused", steps=(step,)))
        await rig.heard()
        put = asyncio.create_task(rig.http.put("/api/plans/Ada/steps", json={"steps": [], "revision": 0}))
        await until(lambda: rig.robots.decisions)
        press = rig.robots.decisions[0].press
        assert press is not None
        rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1", id=press.id))
        if outcome:
            rig.robots.tell(topics.PRESS_TAKEN, PressTaken(run="r1", id=press.id, outcome=outcome, why=told))
        answer = await put
        assert answer.status_code == status
        assert told in answer.json().get("detail", "")
