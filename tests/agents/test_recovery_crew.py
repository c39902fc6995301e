"""Recovery with real planner, engines and chat interface: hold and release (thesis 4.3.6)."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import cast

import pytest

from parley.agents.chat.texts import AFTERWARDS
from parley.clock import SimClock, WallClock
from parley.gate.book import RuleBook
from parley.gate.rule_talk import RuleTalk
from parley.gate.rules import RuleKeeper
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.rules import Rule, RuleSet
from parley.world.object_map import MapObject
from tests.agents.crew import Crew, crew, look
from tests.agents.test_plan_approval import judge_by

ASK = ChatAction(success=False, message_response="What should I do?")
AGAIN = ChatAction(success=True, message_response="I try again.", queue=(look("box"),))


def order(*steps: ActionCall) -> ChatAction:
    return ChatAction(message_response="All right.", queue=steps)


@pytest.fixture
async def failed() -> AsyncIterator[Crew]:
    """A robot whose first of two steps failed, and that asks."""
    async with crew("A", talking=True) as party:
        party.body.failures["look box"] = 1
        party.language.will("interpret", order(look("box"), look("door")))
        party.language.will("resolve", ASK)
        party.observer.say("look at the box and the door", "A")
        await party.hears("What should I do?")
        yield party


async def test_correction_releases_the_robot_and_the_rest_of_the_plan_follows(failed: Crew) -> None:
    failed.language.will("resolve", AGAIN)
    failed.observer.say("try it once more", "A", answer=True)
    await failed.state("idle")
    assert failed.body.did == ["look box", "look box", "look door"]


async def test_order_during_a_repair_waits_is_confirmed_and_then_carried_out(failed: Crew) -> None:
    failed.language.will("interpret", order(look("desk")))
    failed.observer.say("look at the desk", "A")
    await failed.hears(AFTERWARDS)
    assert failed.body.did == ["look box"]
    failed.language.will("resolve", AGAIN)
    failed.observer.say("try it once more", "A", answer=True)
    await failed.state("idle")
    assert failed.body.did == ["look box", "look box", "look door", "look desk"]


async def test_an_order_in_the_place_of_an_answer_is_confirmed_for_afterwards(failed: Crew) -> None:
    failed.language.will("resolve", ChatAction())  # no answer, so the chat takes it
    failed.language.will("interpret", order(look("desk")))
    failed.observer.say("look at the desk", "A", answer=True)
    await failed.hears(AFTERWARDS)
    await failed.until(lambda: failed.observer.questions.newest("A") is not None)
    assert failed.body.did == ["look box"]


async def test_order_said_as_the_answer_for_afterwards_is_carried_out_last(failed: Crew) -> None:
    later = ChatAction(message_response="I will do that afterwards.", queue=(look("desk"),))
    failed.language.will("resolve", later, AGAIN)
    failed.observer.say("after that look at the desk", "A", answer=True)
    await failed.hears("I will do that afterwards.")
    await failed.until(lambda: failed.observer.questions.newest("A") is not None)
    failed.observer.say("try it once more", "A", answer=True)
    await failed.state("idle")
    assert failed.body.did == ["look box", "look box", "look door", "look desk"]


async def test_order_instead_of_everything_drops_the_plan_and_runs(failed: Crew) -> None:
    clear = SystemCommand(command="clear")
    instead = ChatAction(success=True, message_response="Yes.", queue=(look("desk"),), system_cmd=(clear,))
    failed.language.will("resolve", instead)
    failed.observer.say("forget it and look at the desk", "A", answer=True)
    await failed.until(lambda: "look desk" in failed.body.did)
    await failed.state("idle")
    assert failed.body.did == ["look box", "look desk"]


async def test_question_to_the_robot_in_between_leaves_it_held_and_its_question_open(failed: Crew) -> None:
    failed.language.will("interpret", ChatAction(message_response="By the door."))
    failed.observer.say("where is it?", "A")
    await failed.hears("By the door.")
    assert failed.observer.state("A") == "held"
    assert failed.observer.questions.newest("A") is not None
    assert not any(AFTERWARDS in text for text in failed.texts())


@pytest.mark.spec("P18")
async def test_after_the_last_attempt_any_order_goes_on(failed: Crew) -> None:
    failed.language.will("resolve", ASK, ASK, ASK)
    for count in (2, 3, 4):
        failed.observer.say("hmm", "A", answer=True)
        await failed.until(
            lambda count=count: sum("What should I do?" in t for t in failed.texts()) >= min(count, 3)  # type: ignore[misc]
        )
    await failed.hears("Left to do: look at the box; look at the door.")
    assert failed.observer.state("A") == "held"
    failed.language.will("interpret", order(look("desk")))
    failed.observer.say("look at the desk", "A")
    await failed.until(lambda: "look desk" in failed.body.did)


async def test_protocol_to_stop_holds_the_robot_until_it_is_told_to_carry_on() -> None:
    async with crew("A", talking=True) as party:
        party.body.failures["look box"] = 1
        stop = SystemCommand(command="stop")
        party.language.will("interpret", order(look("box")))
        party.language.will(
            "resolve", ChatAction(success=True, message_response="Stopped.", system_cmd=(stop,))
        )
        party.observer.say("look at the box", "A")
        await party.hears("Stopped.")
        await party.state("held")
        assert party.body.did == ["look box"]
        party.observer.say("carry on", "A")
        await party.state("idle")
        assert party.body.did == ["look box", "look box"]


async def test_robots_that_fail_at_once_are_helped_each_for_itself() -> None:
    async with crew("A", "B", talking=True) as party:
        for name in ("A", "B"):
            party.bodies[name].failures["look box"] = 1
            party.language.will("interpret", order(look("box")))
            party.language.will("resolve", ASK)
            party.observer.say("look at the box", name)
            await party.until(lambda name=name: party.observer.questions.newest(name) is not None)  # type: ignore[misc]
        party.language.will("resolve", AGAIN)
        party.observer.publish(
            topics.CHAT_INPUT, ChatInput(message="B, try it once more", targets=("A",), type="response")
        )
        await party.state("idle", "B")
        assert party.bodies["B"].did == ["look box", "look box"]
        assert (party.observer.state("A"), party.bodies["A"].did) == ("held", ["look box"])
        assert party.observer.questions.newest("A") is not None


async def test_answer_for_nobody_is_not_taken_for_an_order() -> None:
    async with crew("A", "B", talking=True) as party:
        for name in ("A", "B"):
            party.bodies[name].failures["look box"] = 1
            party.language.will("interpret", order(look("box")))
            party.language.will("resolve", ASK)
            party.observer.say("look at the box", name)
            await party.until(lambda name=name: party.observer.questions.newest(name) is not None)  # type: ignore[misc]
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="the red one", type="response"))
        await party.hears("Which robot do you mean, A or B?")
        assert sum("Which robot" in text for text in party.texts()) == 1
        party.language.will("resolve", AGAIN)
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="A", type="response"))
        await party.state("idle", "A")
        assert party.bodies["A"].did == ["look box", "look box"]


async def test_a_rule_told_instead_of_an_answer_is_asked_about_and_then_the_repair_again() -> None:
    book = RuleBook(SimClock())
    store = MapObject("s", "store", 5.0, 0.0, "store", 1.0, 1.0)
    async with crew("A", talking=True, rules=RuleTalk(book, RuleKeeper(book)), objects=(store,)) as party:

        async def question(text: str) -> ChatFeedback:
            def found() -> ChatFeedback | None:
                asked = party.observer.questions.newest("A")
                return asked if asked is not None and text in asked.message else None

            await party.until(found)
            return cast(ChatFeedback, found())

        party.body.failures["look box"] = 1
        party.language.will("interpret", order(look("box")))
        party.language.will("resolve", ASK, AGAIN)
        party.observer.say("look at the box", "A")
        repair = await question("What should I do?")
        party.observer.say("nobody into the store between two and three", "A", answer=True)
        rule = await question("I understand this as a rule: Stays out of “store” between 14:00 and 15:00")
        assert [kind for kind, _ in party.language.asked].count("resolve") == 1, "no engine saw the rule"
        assert (party.body.did, party.observer.state("A")) == (["look box"], "held")
        party.observer.say("yes", "A", answer=True)
        await party.hears("The rule holds from now on: Stays out of “store”")
        assert [item.id for item in book.rules.rules] == ["keep-out-store"]
        again = await question("What should I do?")
        assert again.id not in (repair.id, rule.id)
        assert party.body.did == ["look box"], "the yes was the rule's"
        party.observer.say("try it once more", "A", answer=True)
        await party.state("idle")
        assert party.body.did == ["look box", "look box"]


async def test_an_order_that_the_rules_refuse_is_promised_neither_now_nor_for_afterwards() -> None:
    rules = RuleSet(rules=(Rule(id="r", kind="action", actions=("Look",)),))
    book = RuleBook(WallClock())
    async with crew("A", talking=True, judge=judge_by(book)) as party:
        party.body.failures["look box"] = 1
        party.language.will("interpret", order(look("box")), order(look("desk")))
        party.language.will("resolve", ASK)
        party.observer.say("look at the box", "A")
        await party.hears("What should I do?")
        book.replace(rules)
        party.observer.say("look at the desk", "A")
        await party.hears("I have not done that.")
        heard = party.texts()[party.texts().index("What should I do?") + 1 :]
        assert "must not do “look”" in heard[0], "the refusal comes first"
        assert heard[1:] == ["I have not done that."]
