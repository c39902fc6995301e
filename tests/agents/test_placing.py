"""Telling a robot what the place is called where it stands: asked, corrected, forgotten."""

from __future__ import annotations

import math

import pytest

from parley.config import SystemConfig
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages import topics
from parley.messages.chat import ChatInput
from parley.messages.principal import Role, person
from tests.agents.test_places import LAB, Crew, crew


async def told(it: Crew, text: str, *, answer: bool = False, role: Role = "supervisor") -> str:
    """What the robot says to a supervisor's words."""
    heard = len(it.observer.said)
    question = it.observer.questions.newest("A") if answer else None
    said = ChatInput(
        message=text,
        targets=("A",),
        type="response" if answer else "request",
        reply_to=question.id if question else "",
        by=person("Kim", role=role),
    )
    it.observer.publish(topics.CHAT_INPUT, said)
    await it.observer.until(lambda: len(it.observer.said) > heard, timeout_s=30)
    return it.observer.said[heard].message


async def test_this_is_the_pharmacy_is_asked_about_and_is_a_place_to_go_to_after_a_yes() -> None:
    async with crew() as it:
        here = it.system.robots["A"].pose()
        asked = await told(it, "This is the pharmacy.")
        assert asked == "I note “pharmacy” here, where I stand. All right?"
        assert "pharmacy" not in await it.names()
        assert await told(it, "yes", answer=True) == "“pharmacy” is on the map now."
        await it.say("go to the green crate")
        assert await it.done() == ["finished", "finished"]
        assert it.system.robots["A"].pose().x_m > 3
        await it.say("go to the pharmacy")
        await it.observer.until(lambda: "pharmacy" in it.observer.plans["A"].steps[0].label)
        assert await it.done() == ["finished", "finished"]
        pose = it.system.robots["A"].pose()
        assert math.dist((pose.x_m, pose.y_m), (here.x_m, here.y_m)) < 0.15
        assert await told(it, "this is the pharmacy") == "I know: “pharmacy” is here."


async def test_a_correction_changes_the_name_before_and_after_the_yes() -> None:
    async with crew() as it:
        await told(it, "this is the pharmacy")
        again = await told(it, "no, it is the laundry", answer=True)
        assert again == "I note “laundry” here, where I stand. All right?"
        await told(it, "yes", answer=True)
        asked = await told(it, "no, it is the drying room")
        assert asked == "I note “drying room” here in place of “laundry”. All right?"
        await told(it, "yes", answer=True)
        assert await it.names() == {"green crate", "drying room"}
        await told(it, "hello")
        assert "in place of" not in await told(it, "no, it is the attic"), "it is about something else by now"


async def test_what_is_forgotten_is_off_the_map_after_a_yes() -> None:
    async with crew() as it:
        await told(it, "this is where the wheelchairs stand")
        await told(it, "yes", answer=True)
        assert "wheelchairs" in await it.names()
        assert await told(it, "forget the wheelchairs") == "I take “wheelchairs” off the map. All right?"
        assert await told(it, "no", answer=True) == "All right, the map stays as it is."
        await told(it, "take the wheelchairs off the map")
        assert await told(it, "yes", answer=True) == "“wheelchairs” is off the map."
        assert await it.names() == {"green crate"}
        assert await told(it, "take the attic off the map") == "There is no “attic” on my map."


async def test_a_name_that_is_somewhere_else_is_moved_only_after_a_yes() -> None:
    async with crew() as it:
        await it.ask(put=LAB)
        assert "another name" in await told(it, "this is the lab")
        asked = await told(it, "this is the green crate")
        assert (
            asked == "“green crate” is on my map already, 4.3 m from here. Shall I move it to where I stand?"
        )
        await told(it, "no", answer=True)
        assert {thing.x for thing in (await it.map()).objects} == {5.2}


@pytest.mark.parametrize("said", ["this is urgent", "this is the last time", "this is Kim"])
async def test_what_is_no_place_is_understood_as_before(said: str) -> None:
    async with crew() as it:
        assert "I note" not in await told(it, said)


async def test_whatever_engine_there_is_it_is_not_asked_what_a_place_is_called() -> None:
    language = ScriptedLanguage()
    async with crew(language=language) as it:
        assert "“pharmacy”" in await told(it, "this is the pharmacy")
        assert "on the map" in await told(it, "yes", answer=True)
        assert language.asked == []


async def test_only_supervisors_name_places() -> None:
    async with crew() as it:
        assert "Only supervisors" in await told(it, "this is the pharmacy", role="operator")


async def test_a_robot_answers_in_estonian() -> None:
    async with crew(SystemConfig(speed=None, speaks="et")) as it:
        assert await told(it, "see on apteek") == "Panen siia, kus ma seisan, kaardile „apteek“. Kas sobib?"
        assert await told(it, "jah", answer=True) == "„apteek“ on nüüd kaardil."
        assert await told(it, "unusta apteek") == "Võtan kaardilt maha: „apteek“. Kas sobib?"
