"""Policies, repairs that wait for a yes, edits of the plan in progress, what a plan tells about itself."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from parley.agents.planner.ordering import Judge
from parley.clock import WallClock
from parley.gate.book import RuleBook
from parley.gate.judge import Judgement, PlannedStep
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, Flow, FlowIf, SystemCommand
from parley.messages.principal import Principal
from parley.messages.pvf import Parameter
from parley.messages.rules import Rule, RuleSet
from parley.messages.status import ActionInfo, StopCommand
from parley.world.object_map import MapObject
from tests.agents.crew import ENGINE, KIM, Crew, crew, decide, drive, find, look, proposals

PROGRAM = Principal(kind="program", name="script")


def press(what: str) -> ActionCall:
    """An action of high risk."""
    return look(what).model_copy(update={"name": "Press"})


async def policy(party: Crew, wanted: str) -> None:
    decide(party, decision="policy", policy=wanted)
    await party.until(lambda: "A" in party.observer.plans and party.observer.plans["A"].policy == wanted)


# -- asking when it is risky ---------------------------------------------------------------------------


async def test_only_orders_with_a_risky_step_wait_where_that_is_wanted() -> None:
    async with crew("A") as party:
        await policy(party, "ask_when_risky")
        party.order(look("box"))
        await party.until(lambda: party.body.did == ["look box"])
        party.order(look("door"), press("bell"))
        await party.until(lambda: proposals(party))
        await party.state("awaiting_approval")
        assert party.body.did == ["look box"]
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.until(lambda: party.body.did == ["look box", "look door", "press bell"])


async def test_what_is_said_once_more_waits_once() -> None:
    async with crew("A", ask_first=["A"]) as party:
        for thing in ("box", "door", "box"):
            party.order(look(thing))
        await party.until(lambda: len(proposals(party)) == 3)
        _, door, box = proposals(party)
        await party.until(lambda: party.observer.plans["A"].waits == (door["id"], box["id"]))


@pytest.mark.parametrize("wanted", [("box", "lid", "door"), ("box",), ("door",), ("box", "lid")])
async def test_more_or_fewer_steps_are_no_yes_to_what_was_only_offered(wanted: tuple[str, ...]) -> None:
    kept = wanted in (("box", "lid", "door"), ("box",))
    async with crew("A") as party:
        told = ChatAction(
            queue=(look("box"), look("lid")), targets=("A",), needs_yes="box", by=ENGINE, behalf=KIM
        )
        party.observer.publish(topics.CHAT_ACTION, told)
        await party.until(lambda: proposals(party))
        (offered,) = proposals(party)
        steps = tuple(map(look, wanted))
        more = told.model_copy(update={"queue": steps, "needs_yes": "", "replaces": offered["id"]})
        party.observer.publish(topics.CHAT_ACTION, more)
        if kept:
            await party.until(lambda: len(proposals(party)) == 2)
            await party.settled()
            assert (proposals(party)[1]["why"], party.body.did) == ("box", [])
        else:
            await party.until(lambda: party.body.did == [f"look {thing}" for thing in wanted])


@pytest.mark.parametrize("untold", [{}, {"x": Parameter("number")}])
async def test_another_order_than_what_was_only_offered_is_done_though_both_drive(
    untold: dict[str, Parameter],
) -> None:
    way = drive().model_copy(update={"input_parameters": untold})
    async with crew("A") as party:
        told = ChatAction(queue=(find("box"), way), targets=("A",), needs_yes="box", by=ENGINE, behalf=KIM)
        party.observer.publish(topics.CHAT_ACTION, told)
        await party.until(lambda: proposals(party))
        (offered,) = proposals(party)
        other = {"queue": (find("lid"), way), "needs_yes": "", "replaces": offered["id"]}
        party.observer.publish(topics.CHAT_ACTION, told.model_copy(update=other))
        await party.until(lambda: len(party.body.did) == 2)
        assert party.body.did[0] == "find lid"


async def test_policy_from_the_start_is_told_when_the_robot_comes() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await party.until(lambda: "A" in party.observer.plans)
        assert party.observer.plans["A"].policy == "ask_first"


async def test_who_listens_later_is_told_the_plans_and_proposals_as_they_are() -> None:
    async with crew("A", "B", ask_first=["A"]) as party:
        party.order(look("box"))
        party.order(look("door"), target="B")
        await party.until(lambda: proposals(party) and "look door" in party.bodies["B"].did)
        await party.state("idle", "B")
        told: list[dict[str, Any]] = []
        late = await party.transport.subscribe(topics.PLAN, lambda said: told.append(json.loads(said.data)))
        await party.until(lambda: len(told) >= 3)
        now = party.wire.objects(topics.PLAN)
        for robot in ("A", "B"):
            updates = [item for item in now if item["kind"] == "update" and item["target"] == robot]
            assert [item for item in told if item["kind"] == "update" and item["target"] == robot] == [
                updates[-1]
            ]
        assert [item for item in told if item["kind"] == "proposal"] == proposals(party)[-1:]
        before = len(party.wire.objects(topics.PLAN))
        await late.close()
        await party.settled()
        assert len(party.wire.objects(topics.PLAN)) == before, "who leaves is no reason to tell anything"


# -- repairs -------------------------------------------------------------------------------------------


async def failed(party: Crew) -> None:
    """The first of two approved steps fails."""
    party.body.failures["look box"] = 1
    party.order(look("box"), look("door"))
    await party.until(lambda: proposals(party))
    decide(party, id=proposals(party)[0]["id"], decision="approve")
    await party.state("held")


async def test_repair_with_new_steps_waits_for_a_yes_where_everything_does() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("lid"))
        await party.until(lambda: len(proposals(party)) == 2)
        await party.hears("Shall I?")
        await party.settled()
        assert (party.body.did, party.observer.state("A")) == (["look box"], "held")
        decide(party, id=proposals(party)[1]["id"], decision="approve")
        await party.state("idle")
        assert party.body.did == ["look box", "look lid", "look door"]


async def test_going_on_is_no_yes_to_a_repair_that_waits() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("lid"))
        await party.until(lambda: len(proposals(party)) == 2)
        party.command("start")
        await party.hears("Look: what “lid”. Shall I?")
        assert party.body.did == ["look box"]
        decide(party, id=proposals(party)[1]["id"], decision="approve")
        await party.state("idle")
        assert party.body.did == ["look box", "look lid", "look door"]


async def test_repair_can_be_agreed_to_after_the_robot_was_told_to_stand_still() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("lid"))
        await party.until(lambda: len(proposals(party)) == 2)
        party.command("stop")
        await party.settled()
        decide(party, id=proposals(party)[1]["id"], decision="approve")
        await party.state("idle")
        assert party.body.did == ["look box", "look lid", "look door"]


async def test_repair_that_is_refused_leaves_the_robot_waiting_for_another_order() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("lid"))
        await party.until(lambda: len(proposals(party)) == 2)
        decide(party, id=proposals(party)[1]["id"], decision="reject")
        await party.hears("Then I am waiting here.")
        assert party.observer.state("A") == "held"
        party.command("skip")
        await party.state("idle")
        assert party.body.did == ["look box", "look door"]


async def test_repair_that_was_settled_otherwise_is_not_done_any_more() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("lid"))
        await party.until(lambda: len(proposals(party)) == 2)
        party.command("skip")
        await party.state("idle")
        decide(party, id=proposals(party)[1]["id"], decision="approve")
        await party.hears("no longer waiting")
        assert party.body.did == ["look box", "look door"]


async def test_trying_the_same_again_and_leaving_out_need_no_yes() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("box"))
        await party.state("idle")
        assert party.body.did == ["look box", "look box", "look door"]


async def test_repair_that_a_person_chose_goes_on_at_once() -> None:
    async with crew("A", ask_first=["A"]) as party:
        await failed(party)
        party.correct(look("lid"), by=KIM)
        await party.state("idle")
        assert party.body.did == ["look box", "look lid", "look door"]
        assert len(proposals(party)) == 1


async def test_repair_that_drops_the_plan_runs_its_own_steps() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        correction = ChatAction(
            queue=(find("lid"), drive()),
            system_cmd=(SystemCommand(command="clear"),),
            targets=("A",),
            success=True,
            by=ENGINE,
        )
        party.observer.publish(topics.UMRF_CORRECTION, correction)
        await party.until(lambda: party.body.did == ["look box", "find lid", "drive 3"])
        await party.state("idle")


async def test_orders_during_a_repair_are_shown_behind_the_failed_step_and_can_be_dropped() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"))
        await party.state("held")
        party.order(look("door"), look("lid"))
        await party.until(lambda: party.steps() == ["failed", "queued", "queued"])
        party.command("pop", parameters=1)
        await party.until(lambda: party.steps() == ["failed", "queued"])
        party.correct(look("floor"))
        await party.state("idle")
        assert party.body.did == ["look box", "look floor", "look lid"]


# -- editing the plan in progress ----------------------------------------------------------------------


def shown(party: Crew) -> list[str]:
    return [step.action.input_parameters["what"].value for step in party.observer.plans["A"].steps]


async def begun(party: Crew, *calls: ActionCall) -> None:
    """Robot A is at its first look, the others are still to come."""
    party.body.gate("box")
    party.order(look("box"), *calls)
    await party.doing("look box")
    await party.until(lambda: len(party.steps()) == 1 + len(calls))


async def test_who_repairs_what_goes_on_already_is_told_that_the_robot_stands() -> None:
    async with crew("A") as party:
        await begun(party)
        party.command("stop")
        await party.state("paused")
        party.correct()
        await party.hears("I am still standing still. Say “carry on” when I should go on.")


async def failed_while_it_stood(party: Crew) -> None:
    """A step that fails behind a stop, with another one after it."""
    party.body.broken.add("box")
    await begun(party, look("door"))
    party.command("stop")
    await party.state("paused")
    party.body.gate("box").set()
    await party.state("held")


async def test_who_repairs_a_step_that_failed_while_the_robot_stood_is_told_that_it_stands() -> None:
    async with crew("A") as party:
        await failed_while_it_stood(party)
        party.correct(look("lid"))
        await party.hears("I am still standing still. Say “carry on” when I should go on.")
        party.command("start")
        await party.until(lambda: party.body.did == ["look box", "look lid", "look door"])


@pytest.mark.parametrize("words", ["carry on", "try again"])
async def test_a_person_who_answers_with_words_for_going_on_lets_who_stood_before_it_failed_go_on(
    words: str,
) -> None:
    async with crew("A") as party:
        await failed_while_it_stood(party)
        answer = ChatAction(
            queue=(look("lid"),), targets=("A",), success=True, by=ENGINE, behalf=KIM, words=words
        )
        party.observer.publish(topics.UMRF_CORRECTION, answer)
        await party.until(lambda: party.body.did == ["look box", "look lid", "look door"])


async def test_who_did_not_hear_that_it_may_go_on_is_told_again_unless_it_was_stopped_since() -> None:
    async with crew("A") as party:
        party.order(drive(1), look("door"))
        await party.doing("drive 1")
        party.command("stop")
        await party.state("paused")
        for stopped in (True, False):
            await party.until(lambda: "paused" in party.steps())
            party.cut("A", off=True)
            party.command("start")
            if stopped:
                party.observer.publish(topics.STOP, StopCommand(id="s", by=KIM))
            await party.settled()
            party.cut("A", off=False)
            if stopped:
                await asyncio.sleep(1.5)
                assert party.observer.state("A") == "paused" and await party.body.stands_still()
        await party.state("idle")
        assert party.body.did == ["drive 1", "look door"]


async def test_edit_takes_the_place_of_all_that_has_not_begun_and_another_restores_it() -> None:
    async with crew("A") as party:
        await begun(party, look("door"), look("lid"))
        before = [step.action.model_dump() for step in party.observer.plans["A"].steps[1:]]
        revision = party.observer.plans["A"].revision
        decide(party, decision="edit", steps=[look("floor").model_dump()], revision=revision)
        await party.until(lambda: shown(party) == ["box", "floor"])
        later = party.observer.plans["A"].revision
        assert later > revision
        decide(party, decision="edit", steps=before, revision=later)
        await party.until(lambda: shown(party) == ["box", "door", "lid"])
        party.body.gate("box").set()
        await party.state("idle")
        assert party.body.did == ["look box", "look door", "look lid"]


async def test_edit_of_a_plan_that_has_changed_meanwhile_is_refused_and_changes_nothing() -> None:
    async with crew("A") as party:
        await begun(party, look("door"))
        revision = party.observer.plans["A"].revision
        party.order(look("lid"))
        await party.until(lambda: shown(party) == ["box", "door", "lid"])
        decide(party, decision="edit", steps=[], revision=revision)
        await party.hears("The plan has changed in the meantime")
        assert party.observer.refusals[-1].what == topics.PLAN_DECISION.name
        assert party.observer.refusals[-1].problems[0].code == "past_revision"
        assert shown(party) == ["box", "door", "lid"]


async def test_pausing_does_not_make_an_edit_too_late() -> None:
    async with crew("A") as party:
        await begun(party, look("door"))
        revision = party.observer.plans["A"].revision
        party.command("stop")
        await party.state("paused")
        assert party.observer.plans["A"].revision > revision
        decide(party, decision="edit", steps=[look("lid").model_dump()], revision=revision)
        await party.until(lambda: shown(party) == ["box", "lid"])
        party.body.gate("box").set()
        await party.settled()
        assert party.body.did == ["look box"]
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["look box", "look lid"]


@pytest.mark.parametrize(
    ("step", "path", "why"),
    [
        (ActionCall(name="Fly"), "steps[1].name", "I cannot do such a thing"),
        (
            ActionCall(name="Look"),
            "steps[1].input_parameters.what",
            "something that it needs is not given",
        ),
        (
            look("lid").model_copy(update={"flow": Flow(together_with=0)}),
            "steps[1].flow.together_with",
            "it does not fit there",
        ),
        (
            look("lid").model_copy(update={"flow": Flow(if_=FlowIf(step=9))}),
            "steps[1].flow",
            "it does not fit there",
        ),
    ],
    ids=["unknown action", "missing value", "together with what has begun", "unknown step"],
)
async def test_impossible_edit_is_refused_with_place_and_remedy(
    step: ActionCall, path: str, why: str
) -> None:
    async with crew("A") as party:
        await begun(party, look("door"))
        decide(party, decision="edit", steps=[look("floor").model_dump(), step.model_dump()])
        await party.hears("I cannot do step 3, “")  # as people count, with the one that has begun
        await party.hears(f"”: {why}. I left everything as it is.")
        problem = party.observer.refusals[-1].problems[0]
        assert problem.path == path
        assert problem.remedy
        assert shown(party) == ["box", "door"]


async def test_edit_keeps_conditions_on_what_it_keeps() -> None:
    async with crew("A") as party:
        check = look("door").model_copy(update={"name": "Check"})
        only_if = look("lid").model_copy(update={"flow": Flow(if_=FlowIf(step=0))})
        await begun(party)
        party.order(check, only_if, look("floor"))
        await party.until(lambda: len(party.steps()) == 4)
        first, second, third = (step.action for step in party.observer.plans["A"].steps[1:])
        decide(party, decision="edit", steps=[call.model_dump() for call in (third, first, second)])
        await party.until(lambda: shown(party) == ["box", "floor", "door", "lid"])
        flow = party.observer.plans["A"].steps[3].action.flow
        assert flow is not None
        assert flow.if_ == FlowIf(step=2)
        party.body.gate("box").set()
        await party.until(lambda: party.steps() == ["finished", "finished", "finished", "skipped"])
        assert party.body.did == ["look box", "look floor", "check door"]


async def test_edit_that_drops_what_another_step_depends_on_is_refused() -> None:
    async with crew("A") as party:
        check = look("door").model_copy(update={"name": "Check"})
        only_if = look("lid").model_copy(update={"flow": Flow(if_=FlowIf(step=0))})
        await begun(party)
        party.order(check, only_if)
        await party.until(lambda: len(party.steps()) == 3)
        kept = party.observer.plans["A"].steps[2].action
        decide(party, decision="edit", steps=[kept.model_dump()])
        await party.hears("I cannot do step 2, ")
        assert party.observer.refusals[-1].problems[0].path == "steps[0].flow"


async def test_edit_during_a_repair_counts_after_it() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        decide(party, decision="edit", steps=[look("lid").model_dump()])
        await party.until(lambda: shown(party) == ["box", "lid"])
        party.correct(look("big box"))
        await party.state("idle")
        assert party.body.did == ["look box", "look big box", "look lid"]


async def test_edit_of_an_idle_robot_is_an_order_that_a_person_has_agreed_to() -> None:
    async with crew("A", ask_first=["A"]) as party:
        decide(party, decision="edit", steps=[look("lid").model_dump()])
        await party.until(lambda: party.body.did == ["look lid"])


# -- what a plan tells ---------------------------------------------------------------------------------


async def test_revision_grows_with_each_change() -> None:
    async with crew("A") as party:
        party.order(look("box"), look("door"))
        await party.state("running")
        await party.state("idle")
        seen = [item["revision"] for item in party.wire.objects(topics.PLAN)]
        assert seen == list(range(seen[0], seen[0] + len(seen)))


async def test_edit_of_a_plan_as_it_was_before_a_restart_is_refused() -> None:
    async with crew("A") as party:
        await begun(party, look("door"), look("lid"))
        party.command("stop")
        await party.state("paused")
        revision = party.observer.plans["A"].revision
        party.body.gate("box").set()
    async with crew("A") as party:
        await begun(party, look("door"))
        decide(party, decision="edit", steps=[], revision=revision)
        await party.hears("The plan has changed in the meantime")
        assert shown(party) == ["box", "door"]
        party.body.gate("box").set()


async def test_step_is_shown_as_waiting_while_its_question_is_open() -> None:
    async with crew("A") as party:
        await begun(party, look("door"))
        question = ChatFeedback(message="Is it open?", targets=("A",), type="request", id="q")
        party.observer.publish(topics.CHAT_FEEDBACK, question)
        await party.until(lambda: party.steps() == ["waiting", "queued"])
        party.observer.publish(
            topics.CHAT_INPUT, ChatInput(message="yes", targets=("A",), type="response", reply_to="q")
        )
        await party.until(lambda: party.steps() == ["running", "queued"])


async def test_robot_that_goes_in_good_order_says_what_is_left_undone() -> None:
    async with crew("A") as party:
        await begun(party, look("door"))
        await party.dismiss("A")
        await party.hears("The plan was stopped. Not done: look at the box; look at the door.")
        assert party.steps() == ["stopped", "stopped"]


async def test_plan_of_a_robot_that_goes_while_it_is_held_is_kept_and_told() -> None:
    async with crew("A") as party:
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.state("held")
        await party.dismiss("A")
        await party.hears("Its plan is kept.")
        await party.engine("A")
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["look box", "look box", "look door"]


NO_DRIVING = Rule(id="r", kind="action", actions=("Drive",))


def judge_by(book: RuleBook) -> Judge:
    async def judged(
        robot: str, calls: Sequence[ActionCall], infos: Sequence[ActionInfo], *_: object
    ) -> Judgement:
        await asyncio.sleep(0)
        known = {info.name: info for info in infos}
        steps = [PlannedStep(call, known[call.name]) for call in calls]
        return book.judge_plan(robot=robot, steps=steps, by=KIM)

    return judged


@pytest.mark.parametrize("verdict", ["forbid", "ask"])
async def test_a_yes_is_weighed_by_the_rules_of_its_moment_and_not_of_the_card(verdict: str) -> None:
    book = RuleBook(WallClock())
    async with crew("A", judge=judge_by(book)) as party:
        party.order(press("bell"), drive(2.0), by=PROGRAM)
        await party.until(lambda: proposals(party))
        book.replace(RuleSet(rules=(NO_DRIVING.model_copy(update={"verdict": verdict}),)))
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        if verdict == "forbid":
            await party.hears("must not do")
            await party.state("idle")
        else:
            await party.until(lambda: len(proposals(party)) == 2)
            assert "drive" in proposals(party)[1]["why"]
            assert not party.body.did
            decide(party, id=proposals(party)[1]["id"], decision="approve")
            await party.until(lambda: party.body.way)
        assert not any("All right" in text for text in party.texts()) or verdict == "ask"
        assert bool(party.body.did) == (verdict == "ask")


async def test_a_yes_to_new_steps_does_not_let_go_on_what_a_person_told_to_wait() -> None:
    async with crew("A") as party:
        await begun(party)
        party.command("stop")
        await party.state("paused")
        party.order(press("bell"), by=PROGRAM)
        await party.until(lambda: proposals(party))
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.hears("I am still standing still.")
        party.body.gate("box").set()
        await party.settled()
        assert (party.observer.state("A"), party.body.did) == ("paused", ["look box"])
        party.command("start")
        await party.until(lambda: party.body.did == ["look box", "press bell"])


async def test_a_yes_is_no_yes_to_the_same_words_on_a_map_that_has_changed() -> None:
    box = MapObject("b", "box", 1.0, 0.0, "box", 0.5, 0.5)
    objects = [box]
    async with crew("A", ask_first=["A"], objects=objects) as party:
        party.order(look("box"))
        await party.until(lambda: proposals(party))
        objects[0] = replace(box, x_m=4.0)  # somebody carried it away
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.hears("What waits for your yes has changed since you saw it, so I have not begun.")
        await party.until(lambda: len(proposals(party)) == 2)
        decide(party, id=proposals(party)[1]["id"], decision="approve", digest=proposals(party)[0]["digest"])
        await party.until(lambda: len(proposals(party)) == 3)
        assert not party.body.did
        decide(party, id=proposals(party)[2]["id"], decision="approve")
        await party.until(lambda: party.body.did == ["look box"])


@pytest.mark.parametrize("waits", [False, True])
async def test_an_edit_that_the_rules_forbid_is_refused_when_it_is_made(waits: bool) -> None:
    book = RuleBook(WallClock(), RuleSet(rules=(NO_DRIVING,)))
    async with crew("A", ask_first=["A"] if waits else [], judge=judge_by(book)) as party:
        identity = ""
        if waits:
            party.order(look("box"))
            await party.until(lambda: proposals(party))
            identity = proposals(party)[0]["id"]
        else:
            await begun(party, look("door"))
        decide(party, decision="edit", id=identity, steps=[drive(2.0).model_dump()])
        await party.hears("must not do")
        assert party.observer.refusals[-1].problems[0].code == "forbidden"
        decide(party, decision="edit", id=identity, steps=[look("lid").model_dump()])
        party.body.gate("box").set()
        await party.until(lambda: "look lid" in party.body.did)
        await party.state("idle")
        assert not party.body.way


@pytest.mark.parametrize("more", [True, False])
async def test_what_waits_for_a_yes_is_asked_about_as_it_is_after_a_part_of_it_is_over(more: bool) -> None:
    async with crew("A") as party:
        await begun(party, look("door"))
        await policy(party, "ask_first")
        party.order(*([look("lid")] if more else []), commands=[skip()])
        await party.until(lambda: proposals(party))
        old = proposals(party)[0]
        assert old["lines"][0] == "Leave out: Look: what “box”"
        party.body.gate("box").set()
        await (party.until(lambda: len(proposals(party)) == 2) if more else party.hears("over by now"))
        await party.state("awaiting_approval" if more else "idle")
        decide(party, id=old["id"], decision="approve")
        changed = "What waits for your yes has changed since you saw it, so I have not begun."
        await party.hears(
            f"{changed} This is what I would do: Look: what “lid”. Shall I?" if more else "no longer waiting"
        )
        assert party.body.did == ["look box", "look door"]
        assert [item["lines"] for item in proposals(party)[1:]] == ([["Look: what “lid”"]] if more else [])


def skip() -> SystemCommand:
    """Leave out what is being done."""
    return SystemCommand(command="skip")
