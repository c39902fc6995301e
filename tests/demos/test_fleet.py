"""Three robots in one hall: one order is split, explained and approved; questions about the team."""

from __future__ import annotations

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import partial
from pathlib import Path

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.demos.story import Variant
from parley.language.base import Language
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.principal import person
from parley.messages.status import ActorStatus, PoseInfo, StopCommand
from parley.messages.team import WAITS_FOR, MissionList, MissionPart
from parley.messages.wire import decode
from tests.demos.house import PATIENCE_S, House, played, running

ROBOTS = ("Spot", "TIAGo", "Leo")


@asynccontextmanager
async def hall(
    variant: str = "", language: Language | None = None, **settings: object
) -> AsyncIterator[House]:
    demo = load_demo("fleet")
    config = SystemConfig(speed=None).changed(settings)
    system = demo.system(config, demo.story.variant(variant), language=language)
    async with running(system) as home:
        yield home


async def told(home: House, text: str, *robots: str) -> ChatFeedback:
    """What is answered to something that is said to several robots."""
    heard = len(home.observer.said)
    home.observer.say(text, robots[0], also=robots[1:])

    def replies() -> list[ChatFeedback]:
        return [said for said in home.observer.said[heard:] if said.type in ("response", "error")]

    await home.observer.until(lambda: bool(replies()), timeout_s=PATIENCE_S)
    return replies()[0]


def how_often(home: House, words: str) -> int:
    """How often something with these words was said."""
    return sum(words in said.message for said in home.observer.said)


def more_often(home: House, words: str, times: int) -> bool:
    """Whether it was said once more since then."""
    return how_often(home, words) > times


def goals(home: House) -> dict[str, list[str]]:
    """By robot the places that it is sent to."""
    plans = {robot: home.observer.plans.get(robot) for robot in ROBOTS}
    return {
        robot: [str(step.action.input_parameters["target"].value) for step in plan.steps if step.for_next]
        for robot, plan in plans.items()
        if plan is not None
    }


async def test_an_order_to_all_is_split_told_in_one_and_begins_with_one_yes() -> None:
    async with hall(approval="ask_first") as home:
        reply = await told(home, "Check all three areas", *ROBOTS)
        proposed = {
            robot: [
                call.input_parameters["inspect"].value for call in offered.steps if call.name == "Inspect"
            ]
            for robot, offered in home.observer.proposed.items()
        }
        areas = sorted(str(area) for own in proposed.values() for area in own)
        assert areas == ["Area A", "Area B", "Area C"]  # each by one robot
        assert len(proposed) > 1
        assert all(robot in reply.message for robot in proposed)
        assert "nearest to “Area" in reply.message
        assert reply.message.endswith("Shall I?")
        asked = next(iter(proposed))
        await home.say("yes", asked)
        for robot in proposed:
            await home.state("running", robot)
        assert sorted(goal for own in goals(home).values() for goal in own) == areas


async def test_what_is_not_certain_is_asked_and_nothing_begins() -> None:
    async with hall() as home:
        asked = await told(home, "go to the pump and the gate", *ROBOTS)
        assert asked.choices == (
            "go to the pump and the gate, split between you",
            "each of you: go to the pump and the gate",
        )
        told_off = await told(home, "everybody but Spot go to the pump and the gate", *ROBOTS)
        assert told_off.choices == (
            "TIAGo and Leo go to the pump and the gate, between them",
            "each of you but Spot: go to the pump and the gate",
        )
        which = await home.say("both of you go to the pump", "Leo")
        assert "Which of us do you mean?" in which.message
        for text in ("split the areas between you", "let Leo do that", "one of you go to the moon"):
            assert (await home.say(text, "Spot")).message.endswith(("?", "in full."))
        assert not any(goals(home).values())


async def test_who_is_stopped_while_the_order_is_understood_is_told_of_as_stopped() -> None:
    language, read = ScriptedLanguage(BuiltinLanguage()), asyncio.Event()
    language.will("interpret", read)
    async with hall(language=language) as home:
        home.observer.say("Leo goes to the pump, Spot goes to Area B", "TIAGo")
        await home.observer.until(lambda: bool(language.asked), timeout_s=PATIENCE_S)
        stop = StopCommand(targets=("Leo",), id="stop", by=person("Kim"))
        home.observer.publish(topics.STOP, stop)
        await home.observer.until(lambda: bool(home.observer.stop_reports), timeout_s=PATIENCE_S)
        read.set()

        def replies() -> list[str]:
            return [said.message for said in home.observer.said if said.type == "response"]

        await home.observer.until(lambda: bool(replies()), timeout_s=PATIENCE_S)
        assert "Leo was stopped meanwhile, so nobody does its part: Go to “pump”." in replies()[0]
        assert goals(home)["Leo"] == []


async def test_who_can_take_no_part_in_what_everybody_was_told_is_named_with_the_reason() -> None:
    lost = Variant.model_validate({"world": {"robots": {"TIAGo": {"localisation": "lost"}}}})
    async with running(load_demo("fleet").system(SystemConfig(speed=None), lost)) as home:
        await home.observer.until(lambda: home.observer.robots == {*ROBOTS})
        answer = (await told(home, "Check all three areas", *ROBOTS)).message
        assert answer.endswith("TIAGo does not know where it is, so it takes no part.")
        home.observer.publish(topics.STOP, StopCommand(targets=("Leo",), id="stop", by=person("Kim")))
        await home.observer.until(lambda: bool(home.observer.stop_reports), timeout_s=PATIENCE_S)
        answer = (await told(home, "Everybody back to the dock", *ROBOTS)).message
        assert "Leo is stopped, so it takes no part." in answer


async def test_why_it_is_that_robot_is_told_by_whoever_is_asked() -> None:
    async with hall() as home:
        await home.say("one of you go to the pump", "Leo")
        why = "Spot is nearest to “pump”"
        assert why in (await home.say("why?", "Spot")).message
        for text in ("why?", "why Spot?", "why not Leo?", "how did you choose?"):
            assert why in (await home.say(text, "Leo")).message
        await home.say("let Leo go to Area C", "Spot")
        assert "“let Leo go to Area C”" in (await home.say("why Leo?", "Spot")).message


async def test_one_goes_the_others_wait_and_robots_are_asked_about() -> None:
    async with hall() as home:
        nearest = await home.say("which of you is nearest to the pump?", "Leo")
        assert "Spot is nearest to “pump”" in nearest.message
        await home.say("one of you go to the pump, the others wait at the charging dock", "Leo")
        assert goals(home) == {"Spot": ["pump"], "TIAGo": ["charging dock"], "Leo": ["charging dock"]}
        doing = (await home.say("what is Leo doing?", "Spot")).message
        assert doing.startswith("Leo says: “")
        assert "go to the charging dock" in doing
        await home.say("Let TIAGo go to Area A", "Spot")
        assert goals(home)["TIAGo"] == ["charging dock", "Area A"]
        assert goals(home)["Spot"] == ["pump"]


async def test_whoever_hears_that_all_shall_stop_all_do() -> None:
    async with hall() as home:
        await home.say("everybody back to the dock", "Spot")
        for robot in ROBOTS:
            await home.state("running", robot)
        await home.say("All robots stop now", "Spot")
        for robot in ROBOTS:
            await home.state("paused", robot)
        own = ChatInput(message="stop", targets=("Leo",), by=person("Kim"), id="kim")
        home.observer.publish(topics.CHAT_INPUT, own)
        await home.observer.until(
            lambda: any(said.reply_to == "kim" for said in home.observer.said), timeout_s=PATIENCE_S
        )
        going = await home.say("carry on, all of you", "Spot")
        assert going.message.endswith(
            "That lets nobody but those go on whom you have stopped; Leo still stands."
        )
        await home.state("running", "TIAGo")
        assert home.observer.state("Leo") == "paused"


async def test_whoever_hears_that_all_of_them_shall_drop_everything_all_do() -> None:
    async with hall() as home:
        await told(home, "go to the pump", *ROBOTS)
        await home.say("Stop, all of you", "Spot")
        await home.say("cancel all", "Spot")  # all steps, of whoever hears it
        await home.state("idle", "Spot")
        assert home.observer.state("Leo") == "paused"
        await home.say("Cancel everything, all of you", "TIAGo")
        for robot in ROBOTS:
            await home.state("idle", robot)


async def test_some_stop_and_others_go_on_as_one_says_it_of_them() -> None:
    async with hall(speed=10.0) as home:
        await home.say("everybody back to the dock", "Spot")
        for robot in ROBOTS:
            await home.state("running", robot)
        await told(home, "Everyone stop. Only Leo goes on.", "Spot")
        for robot in ("Spot", "TIAGo"):
            await home.state("paused", robot)
        assert home.observer.state("Leo") == "running"
        await told(home, "Spot goes on, the others wait.", "Spot")
        await home.state("paused", "Leo")
        await home.state("running", "Spot")
        await told(home, "Everyone except Spot, carry on.", "Spot")
        for robot in ROBOTS:
            await home.state("running", robot)
        await told(home, "tell TIAGo to stop", "Leo")
        await home.state("paused", "TIAGo")
        assert {home.observer.state("Spot"), home.observer.state("Leo")} == {"running"}


async def test_who_calls_the_mission_off_drops_all_its_parts_and_nothing_else() -> None:
    async with hall() as home:
        await home.say("go to the dock", "Leo")
        await told(home, "Check all three areas, split between you", *ROBOTS)
        await home.say("cancel the mission", "Spot")
        await home.observer.until(
            lambda: any("has ended. " in said.message for said in home.observer.said),
            timeout_s=PATIENCE_S,
        )
        open_yet = {
            str(step.label)
            for plan in home.observer.plans.values()
            for step in plan.steps
            if step.state not in ("stopped", "skipped", "finished") and not step.for_next
        }
        assert open_yet == {"Go to “charging dock”"}


async def test_one_part_is_dropped_the_rest_goes_on_and_how_far_it_is_is_told_of_all() -> None:
    async with hall() as home:
        await told(home, "Check all three areas, split between you", *ROBOTS)
        far = await home.say("have all three areas been checked by now?", "Spot")
        assert "TIAGo still has to do: Go to “Area A”" in far.message
        dropped = await home.say("Cancel TIAGo's part only, the rest stays as it is.", "Spot")
        assert dropped.message == "TIAGo gives up what is left of its plan."
        assert dropped.targets == ("Spot", "TIAGo")
        await home.observer.until(
            lambda: any("has ended. " in said.message for said in home.observer.said),
            timeout_s=PATIENCE_S,
        )
        assert [state.state for state in home.observer.plans["Leo"].steps][-1] == "finished"
        far = await home.say("has area A been checked?", "Leo")
        assert far.message.startswith("TIAGo left out: Go to “Area A”")
        assert (await home.say("cancel Leo's part", "Spot")).message == "Leo has nothing left to do."
        await home.say("emergency stop", "Leo")
        assert "emergency stop" in (await home.say("what happened to Leo?", "Spot")).message


async def said_by(home: House, who: str, text: str, robot: str) -> None:
    """Somebody says something, and it is answered."""
    heard = len(home.observer.said)
    said = ChatInput(message=text, targets=(robot,), id=f"{who} {heard}", by=person(who))
    home.observer.publish(topics.CHAT_INPUT, said)
    await home.observer.until(
        lambda: any(one.type == "response" for one in home.observer.said[heard:]), timeout_s=PATIENCE_S
    )


@pytest.mark.parametrize("words", ["emergency stop all", "Emergency stop for all robots!"])
async def test_an_emergency_stop_of_all_holds_all_until_it_is_released(words: str) -> None:
    async with hall() as home:
        home.observer.say(words, "Spot")
        await home.observer.until(
            lambda: {one.actor for one in home.observer.stop_reports if one.state == "at_rest"} == {*ROBOTS},
            timeout_s=PATIENCE_S,
        )


@pytest.mark.parametrize(
    ("order", "words"),
    [("go to the pump", "Cancel everything, everybody"), ("go to the pump", "cancel everything"),
     ("Spot goes to the pump, Leo goes to the loading gate", "cancel the mission"),
     ("Spot goes to the pump, Leo goes to the loading gate", "cancel Spot's part")],
)  # fmt: skip
async def test_what_somebody_else_ordered_is_given_up_only_after_a_yes_and_stands_at_once(
    order: str, words: str
) -> None:
    async with hall(speed=4.0) as home:
        await said_by(home, "Ruth", order, "Spot")
        await said_by(home, "Kim", "go to Area C" if "Leo" not in order else "go to Area A", "TIAGo")
        await said_by(home, "Kim", words, "TIAGo" if "everybody" in words else "Spot")
        await home.state("paused", "Spot")
        asked = "I ask first: Ruth told me to do this. This is what I would do: Give up the plan as it is."
        await home.observer.until(
            lambda: any(asked in one.message and "Spot" in one.targets for one in home.observer.said),
            timeout_s=PATIENCE_S,
        )
        assert home.observer.state("TIAGo") == ("idle" if "everybody" in words else "running")
        assert goals(home)["Spot"] == ["pump"]
        assert home.observer.state("Leo") == (
            "paused" if "mission" in words else "running" if "Leo" in order else "idle"
        )
        await said_by(home, "Kim", "yes", "Spot")
        await home.state("idle", "Spot")
        await said_by(home, "Ruth", "go to the pump", "Spot")
        await said_by(home, "Ruth", "cancel everything", "Spot")
        assert home.observer.said[-1].message == "I have dropped everything."


async def test_words_that_say_too_little_of_a_team_are_asked_back_and_its_questions_are_of_all() -> None:
    async with hall(speed=4.0) as home:
        own = await home.say("go to Area A, then to Area B and then to the pump", "Spot")
        assert own.type == "response"
        left = await home.say("what is left to do?", "Spot")  # nobody else is at anything
        assert left.message.startswith("Left to do: go to Area A; go to Area B; go to the pump.")
        await home.say("go to the charging dock", "TIAGo")
        left = await home.say("what is left to do?", "Spot")
        assert "TIAGo says: “Left to do: go to the charging dock.”" in left.message
        assert "go to Area B; go to the pump" in left.message
        for question in ("Who's still on the way?", "which of you still has something to do?"):
            assert (
                "Spot says: “This is what I am doing: go to Area A."
                in (await home.say(question, "Leo")).message
            )
        only = await home.say("only Spot", "Spot")
        assert only.choices == ("Only Spot goes on", "Let Spot take over from TIAGo")
        judged = await home.say("If area C is clean, all of you come to the dock", "Spot")
        assert judged.choices == ("All of you come to the dock",)
        assert goals(home)["Leo"] == []
        await home.say("Leo takes over your job", "Spot")
        assert goals(home)["Leo"] == ["Area A", "Area B", "pump"]
        await home.observer.until(lambda: goals(home)["Spot"] == [], timeout_s=PATIENCE_S)


async def test_some_stay_whoever_they_are_and_only_the_others_go() -> None:
    async with hall() as home:
        await home.say("One of you stay here, the others go to the dock", "Spot")
        assert sorted(goals(home).values()) == [[], ["charging dock"], ["charging dock"]]
        await cancelled(home)
        await home.say("two of you stay put, the third one goes to the pump", "TIAGo")
        assert goals(home) == {"Spot": ["pump"], "TIAGo": [], "Leo": []}


async def cancelled(home: House) -> None:
    """All of them have dropped all."""
    for robot in ROBOTS:
        await home.say("cancel everything", robot)
    await home.observer.until(lambda: not any(goals(home).values()), timeout_s=PATIENCE_S)


async def test_where_one_robot_shall_not_go_is_asked_as_its_rule_whoever_hears_it() -> None:
    async with hall() as home:
        home.observer.say("Don't send Leo anywhere near area C", "Spot", also=("TIAGo", "Leo"))
        await home.observer.until(
            lambda: any(
                said.type == "request" and said.targets == ("Leo",) and "Stays out of" in said.message
                for said in home.observer.said
            ),
            timeout_s=PATIENCE_S,
        )
        assert not [said for said in home.observer.said if said.targets != ("Leo",)]


async def test_robots_are_counted_left_out_by_name_and_never_given_two_parts_at_once() -> None:
    async with hall() as home:
        await home.say("two of you go to the loading gate, the other one waits at the dock", "Spot")
        assert sorted(goals(home).values()) == [["charging dock"], ["loading gate"], ["loading gate"]]
        await cancelled(home)
        await home.say("everybody but Leo go to the pump", "Spot")
        assert goals(home) == {"Spot": ["pump"], "TIAGo": ["pump"], "Leo": []}
        await cancelled(home)
        twice = await home.say("Spot goes to the pump, Leo goes to Area C and Spot goes to Area A", "TIAGo")
        assert twice.message.endswith("Please tell each of us its part.")
        await home.say("nobody move", "Spot")
        back = await home.say("Everybody back!", "Leo")
        assert back.choices == ("Everybody back to the charging dock",)
        assert not any(goals(home).values())
        for question in ("where is Spot?", "what are you all doing?"):
            assert "Spot says: “" in (await home.say(question, "Leo")).message


async def test_what_was_said_to_a_team_is_given_on_as_work_and_not_as_its_parts() -> None:
    async with hall() as home:
        await home.say("one of you go to the pump, the others wait at the dock", "Leo")
        await cancelled(home)
        assert (await home.say("let Spot do that", "Leo")).message.endswith("in full.")
        await home.say("one of you go to Area A", "Spot")
        await cancelled(home)
        await home.say("let Leo do that", "Spot")
        assert goals(home) == {"Spot": [], "TIAGo": [], "Leo": ["Area A"]}


async def test_what_another_robot_does_already_is_asked_about_and_nothing_older_is_done() -> None:
    async with hall(speed=4.0) as home:  # TIAGo is under way while it is spoken of
        await home.say("go to the pump", "Spot")
        await home.done("Spot")
        await home.say("let TIAGo go to Area A", "Spot")
        asked = await home.say("let Leo do that", "Spot")
        assert asked.choices == ("Let Leo take over from TIAGo",)
        assert goals(home) == {"Spot": ["pump"], "TIAGo": ["Area A"], "Leo": []}
        told = await home.say("one of you go to the pump, the others go to Area B instead", "Spot")
        assert "What TIAGo had to do before is left out." in told.message
        home.observer.say("Leo should go to the pump instead", "Spot")  # Leo does it, and says so
        await home.observer.until(lambda: goals(home)["Leo"][-1:] == ["pump"], timeout_s=PATIENCE_S)
        await home.say("cancel everything", "Leo")
        await home.say("cancel everything", "TIAGo")
        await home.say("let TIAGo go to Area C", "Spot")
        await home.say("cancel everything", "TIAGo")
        await home.say("let Leo do that", "Spot")
        assert goals(home)["Leo"] == ["Area C"]


async def test_after_a_no_another_one_does_what_was_said_last_or_what_the_hearer_is_at() -> None:
    async with hall(speed=4.0) as home:
        await home.say("let TIAGo go to the pump", "Spot")
        await home.state("running", "TIAGo")
        told = await home.say("No, let Leo do that", "Spot")
        assert "TIAGo gives up what is left of its plan." in told.message
        await home.state("running", "Leo")
        await home.state("idle", "TIAGo")
        await home.say("let Spot go", "Leo")
        await home.state("running", "Spot")
        await home.state("idle", "Leo")
        await home.say("cancel everything", "Spot")
        await home.say("let TIAGo go to the pump", "Spot")
        await home.state("running", "TIAGo")
        await home.say("No, let Spot do that", "Spot")
        await home.state("running", "Spot")
        await home.state("idle", "TIAGo")
        await home.say("stop", "TIAGo")
        await home.say("go to Area A", "TIAGo")
        await home.say("yes", "TIAGo")
        await home.state("running", "TIAGo")
        await home.say("stop", "TIAGo")
        refused = await home.say("let TIAGo go", "Spot")
        assert refused.message == "TIAGo is waiting for somebody, so it gets no part."
        assert goals(home)["Spot"][-1:] == ["pump"]


async def test_a_yes_that_comes_late_is_asked_for_again_before_anybody_begins() -> None:
    async with hall(approval="ask_first") as home:
        await told(home, "check all areas", *ROBOTS)
        await home.say("where are you?", "TIAGo")
        again = await home.say("yes", "TIAGo")
        assert again.message.endswith("Shall I?")
        assert {home.observer.state(name) for name in ROBOTS} == {"awaiting_approval"}
        await home.say("yes", "TIAGo")
        for name in ROBOTS:
            await home.done(name)


async def test_who_is_said_to_stay_put_stands_whoever_hears_it_and_whatever_the_reason() -> None:
    async with hall(speed=4.0) as home:
        await told(home, "everybody go to the pump", *ROBOTS)
        for name, words in (("TIAGo", "TIAGo stays put"), ("Spot", "let Spot wait, it is in the way")):
            await home.state("running", name)
            home.observer.say(words, "Leo")
            await home.state("paused", name)
        assert home.observer.state("Leo") == "running"


async def test_behind_a_stop_that_answers_a_question_others_are_told_too() -> None:
    async with hall() as home:
        await home.say("look for the toolbox in Area B", "Spot")
        await home.question("Spot")
        home.observer.say("stop. Everybody back to the dock", "Spot", answer=True)
        await home.observer.until(
            lambda: any(one.message.endswith("Shall I?") for one in home.observer.said),
            timeout_s=PATIENCE_S,
        )
        home.observer.say("yes", "Spot")
        await home.observer.until(
            lambda: any("Everybody back to the dock” is done" in one.message for one in home.observer.said),
            timeout_s=PATIENCE_S,
        )
        assert all(home.distance_m("dock_1", name) < 1.6 for name in ROBOTS)


@pytest.mark.parametrize(
    ("first", "then", "ends"),
    [
        ("Everybody go to the pump", "Forget it, all of you wait at the dock", ["charging dock"] * 3),
        ("Everybody go to the pump", "Everybody go to the dock instead", ["charging dock"] * 3),
        ("Spot goes to Area A and Leo goes to the pump", "actually, swap them", ["pump", "", "Area A"]),
        ("One of you go to the pump", "Leo, not you", ["", "", "pump"]),
        ("Everybody go to the pump", "Forget it, one of you goes to the gate", ["loading gate", "", ""]),
    ],
)
@pytest.mark.parametrize("approval", ["run_at_once", "ask_first"])
async def test_another_order_to_a_team_comes_in_place_of_the_one_before(
    first: str, then: str, ends: list[str], approval: str
) -> None:
    async with hall(speed=4.0, approval=approval) as home:
        for words in (first, then):
            reply = await home.say(words, "Spot")
            if approval == "ask_first":
                assert reply.message.endswith("Shall I?")
                home.observer.say("yes", reply.targets[-1])

            def begun() -> bool:
                plans = home.observer.plans
                at = [name for name in ROBOTS if name in plans and plans[name].state == "running"]
                return bool(at) and "awaiting_approval" not in [plan.state for plan in plans.values()]

            await home.observer.until(begun, timeout_s=PATIENCE_S)

        def last() -> list[str]:  # of each, there already or not
            over = ("skipped", "stopped")
            plans = [home.observer.plans.get(name) for name in ROBOTS]
            left = [[step for step in plan.steps if step.state not in over] if plan else [] for plan in plans]
            return [str(steps[-1].label).split("“")[-1].strip("”") if steps else "" for steps in left]

        def asked() -> list[str]:  # what became another plan meanwhile is asked about anew
            return [name for name, plan in home.observer.plans.items() if plan.state == "awaiting_approval"]

        while last() != ends:
            await home.observer.until(lambda: last() == ends or bool(asked()), timeout_s=PATIENCE_S)
            for name in asked():
                await home.say("yes", name)


@pytest.mark.parametrize(
    ("words", "hearers", "ends", "stands"),
    [
        ("no wait, Spot to the dock and TIAGo to the gate", ROBOTS, ["dock", "gate", "pump"], ["Leo"]),
        ("stop, Leo go to Area B", ROBOTS, ["pump", "pump", "Area B"], ["Spot", "TIAGo"]),
        ("stop everyone! TIAGo to Area A, Leo to Area C", ROBOTS[:1], ["pump", "Area A", "Area C"], ["Spot"]),
        ("stop, go to the dock", ROBOTS[:1], ["dock", "pump", "pump"], []),
        ("two of you go wait by the gate, one stays here", ROBOTS, ["gate", "gate", "pump"], ["Leo"]),
    ],
)
async def test_an_order_behind_a_stop_is_taken_up_once_while_the_others_stand(
    words: str, hearers: tuple[str, ...], ends: list[str], stands: list[str]
) -> None:
    async with hall(speed=4.0) as home:
        await home.say("Everybody go to the pump", "Spot")
        for name in ROBOTS:
            await home.state("running", name)
        heard = len(home.observer.said)
        home.observer.say(words, hearers[0], also=hearers[1:])

        def told_how() -> list[str]:
            new = home.observer.said[heard:]
            return [one.message for one in new if re.match("This is how we|I ask first", one.message)]

        await home.observer.until(lambda: bool(told_how()), timeout_s=PATIENCE_S)
        if told_how()[0].endswith("Shall I?"):
            assert all(home.observer.state(name) == "paused" for name in ROBOTS if name in words or stands)
            home.observer.say("yes", hearers[0])  # also if it is no part of it

        def is_so() -> bool:
            plans = home.observer.plans
            over = ("skipped", "stopped")
            left = [[step for step in plans[name].steps if step.state not in over] for name in ROBOTS]
            places = [str(steps[-1].label).split("“")[-1].strip("”") for steps in left]
            still = [name for name in ROBOTS if plans[name].state == "paused"]
            return all(map(str.endswith, places, ends)) and still == stands

        await home.observer.until(is_so, timeout_s=PATIENCE_S)
        assert len(told_how()) == 1
        if told_how()[0].startswith("I ask first"):
            assert told_how()[0].startswith(
                "I ask first: you told me to stop. This is what I would do: 1. Give up"
            )
        assert not [one for one in home.observer.said[heard:] if "please say it again" in one.message]


async def test_what_is_no_work_those_who_are_stopped_answer_themselves() -> None:
    async with hall() as home:
        await told(home, "emergency stop all", *ROBOTS)
        reply = await told(home, "thank you, that was good work", *ROBOTS)
        assert "No robot is left" not in reply.message
        for asking in ("release the stop", "Please reset the emergency stop!"):
            before = how_often(home, "by a press")
            home.observer.say(asking, "Leo")
            await home.observer.until(partial(more_often, home, "by a press", before), timeout_s=PATIENCE_S)


async def test_words_to_a_team_that_are_not_read_are_no_order_to_whoever_hears_them() -> None:
    async with hall() as home:
        for text in ("Half of you go to the pump.", "Make sure there's always one of you at the dock."):
            assert (await home.say(text, "Spot")).message.startswith("I cannot tell which of us")
        unknown = await home.say("Listen here: everybody go to the pump", "Spot")
        assert unknown.choices in (("everybody go to the pump",), ())
        bare = await home.say("Spot area A, TIAGo area B", "Leo")
        assert bare.choices[0] == "Spot checks area A, TIAGo checks area B"
        assert not any(goals(home).values())


async def test_what_comes_after_the_work_of_another_one_waits_for_it() -> None:
    async with hall() as home:
        home.observer.say("go to Area B", "Leo")
        await home.observer.until(lambda: goals(home).get("Leo") == ["Area B"], timeout_s=PATIENCE_S)
        told = await home.say("When Leo is there, TIAGo goes to the pump and you stay here", "Spot")
        assert "TIAGo, as soon as Leo has done its part" in told.message
        assert "Spot stays where it is." in told.message
        await home.done("TIAGo")
        names = [step.action.name for step in home.observer.plans["TIAGo"].steps]
        assert names[0] == WAITS_FOR


async def test_who_was_stopped_goes_with_the_yes_to_something_else_and_not_by_a_step_left_out() -> None:
    async with hall() as home:
        await home.say("go to Area A", "TIAGo")
        await home.observer.until(lambda: drives(home, "TIAGo"), timeout_s=PATIENCE_S)
        await home.say("stop", "TIAGo")
        await home.state("paused", "TIAGo")
        await home.say("go to the pump instead", "TIAGo")
        await home.say("yes", "TIAGo")
        await home.done("TIAGo")
        assert home.distance_m("pump_1", "TIAGo") < 1.6
        assert not any("still standing" in said.message for said in home.observer.said)
        await home.say("go to Area A, then to Area B", "TIAGo")
        await home.observer.until(lambda: drives(home, "TIAGo"), timeout_s=PATIENCE_S)
        await home.say("stop", "TIAGo")
        await home.say("skip it", "TIAGo")
        await home.observer.until(
            lambda: any("still standing" in said.message for said in home.observer.said), timeout_s=PATIENCE_S
        )
        assert home.observer.state("TIAGo") == "paused"
        await home.say("carry on", "TIAGo")
        await home.done("TIAGo")
        assert home.distance_m("area_b", "TIAGo") < 1.6


async def test_going_on_past_what_was_found_does_not_look_again_and_who_wants_to_know_is_told_it() -> None:
    async with hall() as home:
        await home.say("check if Area C is clear", "Leo")
        assert "red crate in Area C" in (await home.question("Leo")).message
        await home.say("go on", "Leo")  # nobody pressed it: it is said
        assert await home.done("Leo") == ["finished", "finished", "finished"]  # the look found something
        assert sum("not clear" in said.message for said in home.observer.said if said.type == "info") == 1
        assert "red crate" in (await home.say("did any of you find anything?", "TIAGo")).message
        assert "is clear" in (await home.say("Is Area C clear?", "Spot")).message  # it offers to look


async def test_who_follows_begins_when_the_other_is_there() -> None:
    async with hall() as home:
        await home.say("Leo goes to Area C, Spot follows when it is there", "TIAGo")
        await home.state("running", "Spot")
        assert waits(home, "Spot") == "running"
        await home.observer.until(lambda: waits(home, "Spot") == "finished", timeout_s=PATIENCE_S)
        assert {step.state for step in home.observer.plans["Leo"].steps} == {"finished"}
        assert set(await home.done("Spot")) == {"finished"}


def drives(home: House, robot: str) -> bool:
    """Whether a robot is under way: before, it only finds out where to."""
    plan = home.observer.plans.get(robot)
    return plan is not None and any(
        s.action.name == "NavigateTo" and s.state == "running" for s in plan.steps
    )


def waits(home: House, robot: str) -> str:
    """How the step stands in which a robot waits for another one."""
    plan = home.observer.plans.get(robot)
    return next((step.state for step in plan.steps if step.action.name == WAITS_FOR), "") if plan else ""


async def test_who_waits_asks_when_the_other_will_not_do_its_part_and_stands_while_it_is_stopped() -> None:
    async with hall() as home:
        await home.say("Leo goes to the pump, Spot follows when it is there", "TIAGo")
        await home.say("cancel everything", "Leo")
        assert "Leo has not done its part" in (await home.question("Spot")).message
        home.observer.say("yes", "Spot", answer=True)
        await home.observer.until(lambda: waits(home, "Spot") == "finished", timeout_s=PATIENCE_S)
        await home.say("cancel everything", "Spot")
        await home.say("Leo goes to Area C, TIAGo goes to Area A when Leo is there", "Spot")
        await home.say("stop", "TIAGo")
        assert set(await home.done("Leo")) == {"finished"}
        assert home.observer.state("TIAGo") == "paused"
        assert waits(home, "TIAGo") != "finished"
        await home.say("carry on", "TIAGo")
        assert set(await home.done("TIAGo")) == {"finished"}
        assert home.distance_m("area_a", "TIAGo") < 1.6


async def test_a_wait_outlives_its_planner_and_the_end_of_everything(tmp_path: Path) -> None:
    async with hall(data_dir=tmp_path) as home:
        await home.say("Leo goes to Area C, Spot follows when it is there", "TIAGo")
        await home.observer.until(lambda: waits(home, "Spot") == "running", timeout_s=PATIENCE_S)
    async with hall(data_dir=tmp_path) as home:
        await home.state("paused", "Spot")
        assert waits(home, "Spot") in ("queued", "paused")
        await home.say("carry on", "Leo")
        await home.say("carry on", "Spot")
        assert set(await home.done("Spot")) == {"finished"}
        assert home.distance_m("area_c", "Leo") < 1.6


async def test_what_a_robot_leaves_undone_is_offered_to_the_best_of_the_others() -> None:
    async with hall("blocked_doorway") as home:
        await told(home, "Check all three areas", *ROBOTS)

        def offers(robot: str) -> list[ChatFeedback]:
            return [said for said in home.observer.said if f"what is left of {robot}’s part" in said.message]

        home.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="Leo", state="leaving"))
        await home.observer.until(lambda: bool(offers("Leo")), timeout_s=PATIENCE_S)
        await home.observer.until(lambda: bool(offers("TIAGo")), timeout_s=PATIENCE_S)  # its way is blocked
        assert goals(home)["TIAGo"] == ["Area A"]  # nothing is given on by itself
        (words,) = offers("TIAGo")[0].choices
        taker = words.split()[1]
        await home.say(words, "TIAGo")
        await home.observer.until(lambda: "Area A" in goals(home)[taker], timeout_s=PATIENCE_S)
        assert set(await home.done("TIAGo")) <= {"finished", "stopped"}
        assert set(await home.done(taker)) == {"finished"}
        assert home.distance_m("area_a", taker) < 1.6


async def test_of_a_robot_that_is_gone_nobody_answers_for_it() -> None:
    async with hall() as home:
        gone = ActorStatus(actor="Ada", pose=PoseInfo(x=1.0, y=1.0, yaw=0.0))
        home.observer.publish(topics.ACTOR_STATUS, gone)
        home.observer.publish(topics.ACTOR_STATUS, gone.model_copy(update={"state": "leaving"}))
        for question in ("where is Ada?", "how is the work going?", "Ada, where are you?"):
            assert "Ada is not there at the moment" in (await home.say(question, "Leo")).message


async def test_what_one_finds_the_other_is_asked_to_look_for_no_longer() -> None:
    words = "Leo, look for the red crate in Area A. Spot, look for the red crate in Area C."
    async with hall() as home:
        await told(home, words, *ROBOTS)

        def offers() -> list[ChatFeedback]:
            return [said for said in home.observer.said if "has found “red crate”" in said.message]

        await home.observer.until(lambda: bool(offers()), timeout_s=PATIENCE_S)
        (offer,) = offers()
        assert offer.targets == ("Leo",)
        assert offer.message.startswith("I ask first: Spot has found “red crate”.")
        assert offer.message.endswith("Shall I?")
        assert home.observer.state("Leo") == "running", "it goes on until somebody says yes"
        await home.say("yes", "Leo")
        await home.state("idle", "Leo")
        looked = [step for step in home.observer.plans["Leo"].steps if step.action.name == "Inspect"]
        assert all(step.state != "finished" for step in looked)


@pytest.mark.parametrize(("variant", "reason"), [("other_words", ""), ("no_area", "other_reply")])
async def test_story_holds_and_breaks_where_the_world_makes_it(
    tmp_path: Path, variant: str, reason: str
) -> None:
    ended, events, _ = await played(load_demo("fleet"), tmp_path, variant, seed=3)
    assert ended.partition(":")[0] == reason
    assert [event for event in events if event["event"] == "failure"] == []


async def test_who_stands_since_a_restart_was_told_by_nobody_and_is_said_to_stand(tmp_path: Path) -> None:
    async with hall(data_dir=tmp_path, speed=1.0) as home:
        await told(home, "go to the pump", "Spot", "TIAGo")
        await home.state("running", "Spot")
        await home.state("running", "TIAGo")
    async with hall(data_dir=tmp_path) as home:
        for robot in ("Spot", "TIAGo"):
            await home.state("paused", robot)
        doing = await home.say("what are you doing?", "Spot")
        assert doing.message.startswith("I stand still. Say “carry on” and I go to the pump")
        still = await home.say("All of you, carry on", "Spot")
        assert still.message.endswith("Spot, TIAGo still stands.")


async def test_one_order_is_seen_as_one_and_its_end_is_told_truly(tmp_path: Path) -> None:
    async with hall(data_dir=tmp_path) as home:
        seen: list[MissionList] = []
        await home.system.transport.subscribe(
            topics.MISSIONS, lambda message: seen.append(decode(MissionList, message.data))
        )

        def parts() -> dict[str, MissionPart]:
            return {part.robot: part for mission in seen[-1].missions for part in mission.parts}

        await told(home, "Check all three areas", *ROBOTS)
        await home.observer.until(lambda: all(p.state == "running" for p in parts().values()))
        leo = parts()["Leo"]
        await home.say("go to the pump", "Leo")
        order = ChatAction(
            system_cmd=(SystemCommand(command="clear", arguments={"order": leo.order}),),
            targets=("Leo",),
            by=person("Kim"),
        )
        home.observer.publish(topics.CHAT_ACTION, order)
        await home.observer.until(lambda: bool(seen[-1].missions[0].closing), timeout_s=PATIENCE_S)
        assert {name: part.state for name, part in parts().items()} == {
            "Spot": "done", "TIAGo": "done", "Leo": "undone",
        }  # fmt: skip
        closing = seen[-1].missions[0].closing
        assert "Leo left out: " in closing
        assert "Spot" not in closing
        assert "pump" in str(goals(home)["Leo"])  # only the part was dropped
