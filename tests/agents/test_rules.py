"""Rules in a running system: kept, tried without driving, and held while the robot drives."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.observer import Observer
from parley.errors import FileFormatError
from parley.messages import topics
from parley.messages.chat import ChatAction, SystemCommand
from parley.messages.principal import Principal, person
from parley.messages.ros import ChatRequest
from parley.messages.rule_requests import RuleRequest, RulesAnswer
from parley.messages.rules import Hours
from parley.messages.status import PlanProposal, PlanUpdate, StopCommand
from parley.messages.wire import decode, encode
from parley.system import System
from tests.demos.house import House
from tests.sim.worlds import two_rooms

EAST = {"id": "east", "name": "east room", "kind": "keep_out", "rectangle": (2.9, -1.0, 9.0, 9.0)}
KIM = person("Kim", role="supervisor")


class Crew(House):
    """A robot in two rooms, how far east it ever was, and the rules."""

    farthest_m = 0.0

    @property
    def held(self) -> list[str]:
        return [rule.id for rule in self.system.rules.rules.rules]

    async def watch(self) -> None:
        while True:
            self.farthest_m = max(self.farthest_m, self.system.robots["A"].pose().x_m)
            await self.system.clock.sleep(0.05)

    async def ask(self, what: str, by: Principal | None = KIM, **more: Any) -> RulesAnswer:
        request = RuleRequest.model_validate({"what": what, "by": by} | more)
        response = await self.system.transport.call(topics.RULES, ChatRequest(encode(request)), timeout_s=10)
        return decode(RulesAnswer, response.response)


@asynccontextmanager
async def crew(config: SystemConfig | None = None) -> AsyncIterator[Crew]:
    config = config or SystemConfig(speed=None)
    system = System(two_rooms(), config, actions=BUILTIN_ACTIONS)
    async with system, Observer(system.transport, system.clock) as observer:
        made = Crew(system, observer, "A")
        watch = asyncio.create_task(made.watch())
        await observer.until(lambda: "A" in observer.robots, timeout_s=10)
        yield made
        watch.cancel()


async def test_a_robot_that_is_asked_into_a_closed_room_says_why_and_never_enters() -> None:
    async with crew() as it:
        await it.ask("put", rule=EAST)
        start_m = it.farthest_m
        await it.say("go to the green crate")
        await it.observer.until(lambda: any("“east room”" in said.message for said in it.observer.said))
        assert it.farthest_m == start_m
        assert it.actions() == []


@pytest.mark.parametrize("refused", ["as a plan", "under way"])
async def test_go_anyway_goes_nowhere(refused: str) -> None:
    async with crew() as it:
        if refused == "as a plan":
            await it.ask("put", rule=EAST)
        it.observer.say("go to the green crate", "A")
        if refused == "under way":
            while it.farthest_m < 1.3:
                await it.system.clock.sleep(0.05)
            await it.ask("put", rule=EAST)
            asked = await it.question()
        await it.observer.until(lambda: any("“east room”" in said.message for said in it.observer.said))
        stood_m = it.farthest_m
        it.observer.say("go anyway", "A", answer=refused == "under way")
        await it.observer.until(lambda: any("whoever asks" in said.message for said in it.observer.said))
        told = next(said.message for said in it.observer.said if "whoever asks" in said.message)
        assert "Stays out of “east room”: every robot." in told and "Operators and supervisors" in told
        if refused == "under way":
            await it.observer.until(lambda: it.observer.said[-1].message == asked.message)
        await it.system.clock.sleep(2.0)
        assert it.farthest_m < stood_m + 0.2, "it only came to a stand"


async def test_trying_a_plan_says_what_would_become_of_it_and_moves_nothing() -> None:
    async with crew() as it:
        await it.ask("put", rule=EAST)
        start = it.system.robots["A"].pose()
        tried = (await it.ask("try", robot="A", words=("green crate", "the moon"), language="et")).verdict
        assert tried is not None
        assert [item.code for item in tried.forbidden] == ["zone_entered"]
        assert "east room" in tried.forbidden[0].text
        assert tried.unknown == ("the moon",)
        assert tried.length_m > 3
        free = (await it.ask("try", robot="A", goal=(1.0, 3.0))).verdict
        assert free is not None and not free.forbidden and len(free.way) > 10
        both = (await it.ask("try", robot="A", words=("green crate",), goal=(1.0, 3.0))).verdict
        assert both is not None and len(both.goals) == 2 and both.goals[-1] == both.way[-1]
        assert it.system.robots["A"].pose() == start
        assert "no robot 'Z'" in (await it.ask("try", robot="Z", goal=(1.0, 3.0))).problem


@pytest.mark.parametrize("by", [None, person("Ada", role="viewer"), Principal(kind="engine", name="m")])
async def test_who_may_not_change_rules_changes_none(by: Principal | None) -> None:
    async with crew() as it:
        await it.ask("put", rule=EAST)
        for change in ({"what": "put", "rule": EAST | {"id": "other"}}, {"what": "drop", "id": "east"}):
            assert (await it.ask(**change, by=by)).problem
        assert [view.rule.id for view in (await it.ask("list", by=by)).rules] == ["east"]


async def test_rules_are_told_in_words_and_kept_over_a_restart(tmp_path: Path) -> None:
    config = SystemConfig(speed=None, data_dir=tmp_path)
    async with crew(config) as it:
        answer = await it.ask("put", rule=EAST | {"when": {"from": "14:00", "to": "15:00"}})
        assert answer.file == "rules.yaml"
        assert answer.rules[0].text == "Stays out of “east room” between 14:00 and 15:00: every robot."
        assert answer.rules[0].rule.by == "Kim"
        assert "ei sõida" in (await it.ask("list", language="et")).rules[0].text
        assert (await it.ask("drop", id="nothing")).problem == "There is no such rule any more."
    async with crew(config) as it:
        assert [rule.id for rule in it.system.rules.rules.rules] == ["east"]
        assert (await it.ask("drop", id="east")).rules == ()
    (tmp_path / "rules.yaml").write_text("rules:\n- {id: a, kind: fly}\n", encoding="utf-8")
    with pytest.raises(FileFormatError, match="line 2"):
        async with crew(config):
            pass


async def test_a_told_rule_is_shown_as_what_it_becomes_and_counts_after_a_yes() -> None:
    async with crew() as it:
        it.observer.say("never go into the green crate between two and three", "A")
        asked = await it.question()
        assert asked.message.startswith(
            "I understand this as a rule: Stays out of “green crate” between 14:00"
        )
        assert "On the map it reaches from (4.65, 1.45) to (5.75, 2.55) metres." in asked.message
        assert asked.choices[-1] == "no" and len(asked.choices) == 3
        assert "Until you answer, A will not drive." in asked.message
        assert it.held == []
        it.observer.say("perhaps", "A", answer=True)
        await it.observer.until(lambda: it.observer.said[-1].closes == asked.id, timeout_s=10)
        await it.say((await it.question()).choices[1], answer=True)
        assert it.held == ["keep-out-green-crate"]
        assert it.system.rules.rules.rules[0].when == Hours(start="02:00", end="03:00")
        assert "Stays out of" in (await it.say("what rules are there?")).message
        it.observer.say("drop the rule about the crate", "A")
        assert "Shall I drop this rule" in (await it.question()).message
        assert (await it.say("yes", answer=True)).message == "The rule does not hold any more."
        assert it.held == []


async def test_a_yes_to_a_rule_needs_no_mark_and_to_go_on_is_no_yes() -> None:
    async with crew() as it:
        await it.say("go to the green crate")
        it.observer.say("never go into the green crate", "A")
        await it.question()
        it.observer.say("carry on", "A")
        await it.observer.until(lambda: any("as soon as you have" in x.message for x in it.observer.said))
        assert it.held == []
        it.observer.say("yes", "A")
        await it.observer.until(lambda: bool(it.held), timeout_s=10)


async def test_a_dont_is_a_rule_unless_it_is_about_what_waits_for_a_yes() -> None:
    async with crew() as it:
        waits = PlanProposal(id="p1", target="A", labels=("Go to “red crate”",), digest="d")
        it.observer.publish(topics.PLAN, waits)
        it.observer.publish(topics.PLAN, PlanUpdate(target="A", state="awaiting_approval"))
        it.observer.say("don't go near the green crate", "A")
        assert "Stays out of “green crate”" in (await it.question()).message


async def test_a_rule_that_is_told_while_another_is_asked_about_leaves_that_question_open() -> None:
    async with crew() as it:
        it.observer.say("never go into the green crate", "A")
        first = await it.question()
        it.observer.say("not faster than half a metre per second", "A", answer=True)
        await it.observer.until(lambda: "0.5" in it.observer.said[-1].message)
        again = it.observer.said[-2]
        assert (again.type, again.closes, again.message) == ("request", first.id, first.message)
        await it.say("yes", answer=True)
        assert [rule.kind for rule in it.system.rules.rules.rules] == ["speed"]
        await it.say("what rules are there?", answer=True)
        await it.say("yes", answer=True)
        assert len(it.held) == 2


@pytest.mark.parametrize("answer", ["yes", "no"])
async def test_a_drive_stands_while_a_zone_before_it_is_asked_about(answer: str) -> None:
    async with crew() as it:
        await it.say("go to the green crate")
        while it.farthest_m < 1.3:
            await it.system.clock.sleep(0.05)
        it.observer.say("nobody to the green crate", "A")
        asked = await it.question()
        await it.system.clock.sleep(1.0)
        stood_m = it.farthest_m
        it.observer.say("go to the green crate", "A")
        await it.observer.until(lambda: it.observer.said[-1].closes == asked.id)
        await it.system.clock.sleep(3.0)
        assert it.farthest_m == pytest.approx(stood_m), "nothing else that is said lets it drive"
        await it.say(answer, answer=True)
        if answer == "no":
            assert await it.done() == ["finished"] * 4
        else:
            await it.observer.until(lambda: bool(it.observer.failures), timeout_s=20)
            assert it.observer.failures[0].code == "forbidden"
            assert it.farthest_m < 4.25 - it.system.robots["A"].radius_m
            await it.question()
            told = len(it.observer.said)
            it.observer.say("try again", "A", answer=True)
            await it.observer.until(
                lambda: any("must not go" in said.message for said in it.observer.said[told:]), timeout_s=20
            )
            assert it.observer.state("A") == "held"


async def test_a_robot_stands_until_the_answer_also_after_an_emergency_stop_was_released() -> None:
    async with crew() as it:
        await it.say("go to the green crate")
        while it.farthest_m < 1.3:
            await it.system.clock.sleep(0.05)
        it.observer.say("nobody to the green crate", "A")
        await it.question()
        await it.system.clock.sleep(1.0)
        for command in (StopCommand(id="s", by=KIM), StopCommand(command="reset", id="r", by=KIM)):
            it.observer.publish(topics.STOP, command)
        reports = it.observer.stop_reports
        await it.observer.until(lambda: any(report.state == "reset" for report in reports))
        stood_m = it.farthest_m
        go_on = ChatAction(system_cmd=(SystemCommand(command="start"),), targets=("A",), by=KIM)
        it.observer.publish(topics.CHAT_ACTION, go_on)  # a press on the page
        await it.observer.until(lambda: it.observer.state("A") == "running")
        await it.system.clock.sleep(5.0)
        assert it.farthest_m == pytest.approx(stood_m)
        await it.say("no", answer=True)
        assert await it.done() == ["finished"] * 2


async def test_a_rule_that_nobody_had_agreed_to_at_the_end_of_a_process_is_told_by_the_next(
    tmp_path: Path,
) -> None:
    config = SystemConfig(speed=None, data_dir=tmp_path)
    lost = "so this is no rule: Stays out of “green crate”: every robot."

    def told(it: Crew) -> int:
        return sum(lost in said.message for said in it.observer.said)

    async with crew(config) as it:
        it.observer.say("nobody into the green crate", "A")
        await it.question()
    async with crew(config) as it:
        await it.observer.until(lambda: told(it) == 1)
        assert it.held == []
        it.observer.say("nobody into the green crate", "A")
        await it.question()
        await it.say("no", answer=True)
    async with crew(config) as it:
        await it.say("what rules are there?")
        assert (told(it), it.held) == (0, [])


async def test_after_a_no_nothing_holds_and_orders_are_no_rules() -> None:
    async with crew() as it:
        it.observer.say("nobody into the green crate", "A")
        await it.question()
        assert "stay as they are" in (await it.say("no", answer=True)).message
        await it.say("where is the green crate?")
        assert it.held == []
        assert (await it.say("what rules are there")).message == "There are no rules."
