"""Words of people's own, taught in the chat: the real chat interface, planner, memory node and engine."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import pytest

from parley.clock import WallClock
from parley.gate.book import RuleBook
from parley.gate.orders import Heard, admit
from parley.gate.rule_talk import RuleTalk
from parley.gate.rules import RuleKeeper
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatInput, SystemCommand
from parley.messages.memory import taught_name
from parley.messages.principal import Principal, person
from parley.messages.status import ActorStatus
from tests.agents.test_recollections import House, opened_house
from tests.language.builtin.worlds import CATALOGUE, thing


@pytest.fixture
async def house() -> AsyncIterator[House]:
    async with opened_house(BuiltinLanguage()) as found:
        found.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", catalogue=CATALOGUE))
        yield found


async def test_taught_sentence_is_kept_shown_used_replaced_and_forgotten(house: House) -> None:
    reply = await house.say("'quick look' means take a picture", author="Kim")
    assert reply.message == "I will remember what “quick look” means: Snap."
    (entry,) = await house.store.taught()
    assert (entry.taught, entry.data, entry.source, entry.way) == (
        "quick look",
        "take a picture",
        "Kim",
        "told",
    )
    assert entry.words == "'quick look' means take a picture"
    reply = await house.say("Quick look, please.", author="Kim")
    assert reply.message.startswith("I will take a picture. I know that because you told me at ")
    assert reply.sources == (entry.name,)
    await house.say("'quick look' means turn left by ninety degrees")
    assert "turn left" in (await house.say("quick look")).message
    assert (
        await house.say("what does quick look mean?")
    ).message == "“quick look” means “turn left by ninety degrees”."
    assert (await house.say("which words did I teach you?")).message == "I was taught: “quick look”."
    assert (
        await house.say("forget what quick look means")
    ).message == "I have forgotten what “quick look” means."
    assert (await house.say("which words did I teach you?")).message.startswith("Nobody has taught me")
    assert "turn left" not in (await house.say("quick look")).message


async def test_teaching_which_one_is_meant_answers_the_question_about_it() -> None:
    things = (thing("blue tray", 1), thing("red tray", 2))
    async with opened_house(BuiltinLanguage(), objects=things) as house:
        house.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", catalogue=CATALOGUE))
        assert "Which one do you mean" in (await house.say("pick up the tray")).message
        learned = await house.say("no, by tray I mean the blue one")
        assert learned.message == "I will remember: “tray” is the blue tray."
        await house.observer.until(lambda: len(house.observer.said) > 2, timeout_s=10)
        assert house.observer.said[2].message.startswith("I will pick up the blue tray.")
        await house.say("by the den I mean the red tray")
        await house.say("which words did I teach you?")
        assert len(house.observer.said) == 5  # nothing was done again


async def test_a_rule_may_speak_of_a_place_by_the_name_that_was_taught_for_it() -> None:
    book = RuleBook(WallClock())
    rules = RuleTalk(book, RuleKeeper(book))
    async with opened_house(BuiltinLanguage(), (thing("blue tray", 1),), rules) as house:
        house.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", catalogue=CATALOGUE))
        assert "do not know where" in (await house.say("keep out of my corner")).message
        await house.say("by my corner I mean the blue tray")
        asked = await house.say("keep out of my corner")
        assert asked.message.startswith("I understand this as a rule: Stays out of “corner”")


async def test_what_cannot_be_taught_is_said_and_not_kept(house: House) -> None:
    reply = await house.say("'stop' means take a picture")
    assert "“stop” keeps its meaning" in reply.message
    assert await house.store.all() == []
    reply = await house.say("a red light means that the pump is broken")
    assert "learn" not in reply.message  # that is no word of somebody's own


async def test_program_teaches_nothing(house: House) -> None:
    program = Principal(kind="program", name="p", key="k")
    said = ChatInput(message="'quick look' means take a picture", targets=("A",), id="1", by=program)
    house.observer.publish(topics.CHAT_INPUT, said)
    async with asyncio.timeout(10):
        await house.observer.until(lambda: bool(house.observer.said), timeout_s=10)
    assert house.observer.said[0].message == "Only people teach me what words mean."
    assert await house.store.all() == []


def test_language_engine_teaches_nothing() -> None:
    add = {"name": taught_name("office"), "data": "the office is closed"}
    answer = ChatAction(system_cmd=(SystemCommand(command="add_memory", arguments=add),))
    heard = Heard(words="the office is closed", by=person("Kim"), robot="A")
    (command,) = admit(answer, heard).order.system_cmd
    assert command.arguments["way"] == "concluded"
