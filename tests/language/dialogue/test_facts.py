"""What becomes a memory, and what never does."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.language.base import Situation, Turn
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Dialogue
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.status import PlanProposal
from tests.language.builtin.worlds import SENTENCES, situation

ENGINE = BuiltinLanguage()
STOPS = ("stop", "STOP STOP", "halt", "freeze", "wait", "stooop", "don't move", "watch out", "stand still")
WHY = ("Kim is behind you", "the box is on the floor", "you are at the desk", "there is a cat",
       "somebody is in the yard", "")  # fmt: skip
ASKED = (
    "where is {}",
    "is {} in the office",
    "who put {} on the desk",
    "did you see {}",
    "why is {} in the yard",
)
THINGS = ("the red box", "Kim", "the printer", "my coat", "it")
TAILS = ("", " now", " please", ", Ada", "!", " and hurry")
ALARMS = ("somebody fell in the yard", "there is smoke in the office", "help, the printer is on fire")


def stored(answer: ChatAction) -> list[str]:
    return [str(c.arguments.get("data")) for c in answer.system_cmd if c.command == "add_memory"]


def messages() -> st.SearchStrategy[str]:
    stops = st.builds(
        "{}{} {}".format, st.sampled_from(STOPS), st.sampled_from((",", "!", "")), st.sampled_from(WHY)
    )
    asked = st.builds("{}?".format, st.builds(str.format, st.sampled_from(ASKED), st.sampled_from(THINGS)))
    orders = st.builds("{}{}".format, st.sampled_from(SENTENCES), st.sampled_from(TAILS))
    return st.one_of(stops, asked, orders, st.sampled_from(ALARMS))


@settings(max_examples=150, deadline=None)
@given(messages())
def test_no_stop_order_question_or_alarm_is_ever_stored(message: str) -> None:
    import asyncio

    assert stored(asyncio.run(ENGINE.interpret(situation(message)))) == [], message


async def test_a_fact_is_corrected_by_a_pronoun() -> None:
    before = (Turn("operator", "Kim is in the office"), Turn("assistant", "I will remember that."))
    answer = await ENGINE.interpret(situation("no sorry, she has moved to the yard", history=before))
    (command,) = answer.system_cmd
    assert (command.arguments["name"], command.arguments["data"]) == ("kim_location", "Kim is at the yard")


async def test_a_fact_about_something_else_is_no_correction_of_the_one_before() -> None:
    before = (Turn("operator", "Kim is in the office"), Turn("assistant", "I will remember that."))
    for told in ("remember that Ada is at the ramp", "please remember that Ada moved to the ramp"):
        assert "Kim" not in "".join(stored(await ENGINE.interpret(situation(told, history=before))))


async def test_other_facts_are_kept_in_the_persons_words() -> None:
    answer = await ENGINE.interpret(situation("Kim is allergic to wool by the way"))
    assert stored(answer) == ["Kim is allergic to wool"]


async def test_an_answer_to_a_question_is_no_fact() -> None:
    for reply in ("it is on the tray", "my hands are full", "the tray is full"):
        assert stored(await ENGINE.interpret(situation(reply, question="Is it done?"))) == []
    aside = await ENGINE.interpret(situation("Kim is allergic to wool", question="Is it done?"))
    assert stored(aside) == ["Kim is allergic to wool"]


async def test_what_is_to_be_forgotten_is_named() -> None:
    known = (MemoryEntry(name="kim_location", data="Kim is in the office", info="Where Kim is"),)
    answer = await ENGINE.interpret(situation("forget where Kim is", memory=known))
    assert [(c.command, c.arguments["name"]) for c in answer.system_cmd] == [
        ("remove_memory", "kim_location")
    ]


async def test_what_a_robot_saw_is_not_lost_by_words_that_may_be_about_its_plan() -> None:
    seen = MemoryEntry(name="gate_sighting", data="I saw the gate by the ramp.", way="seen")
    shown = MemoryEntry(name="picture_of_gate", data="", type="image", way="seen")
    asked = await ENGINE.interpret(situation("forget the gate", memory=(seen, shown)))
    assert asked.system_cmd == ()
    (choice,) = asked.choices
    answer = await ENGINE.interpret(situation(choice, memory=(seen, shown)))
    assert [command.command for command in answer.system_cmd] == ["remove_memory", "remove_memory"]
    assert answer.message_response == "I forget this: I saw the gate by the ramp; picture of gate."


async def test_forget_that_takes_back_what_was_told_last_whatever_was_asked_since() -> None:
    turns = (
        Turn("operator", "Kim is in the office"), Turn("assistant", "I will remember that."),
        Turn("operator", "where is Kim?"), Turn("assistant", "I remember: Kim is in the office."),
    )  # fmt: skip
    answer = await ENGINE.interpret(situation("forget that", history=turns))
    assert [(c.command, c.arguments["name"]) for c in answer.system_cmd] == [
        ("remove_memory", "kim_location")
    ]
    ordered = (*turns, Turn("operator", "go to the yard"), Turn("assistant", "I will go to the yard."))
    assert (await ENGINE.interpret(situation("forget that", history=ordered))).system_cmd == ()


async def test_an_order_may_wait_for_something_that_is_told() -> None:
    asked = "when Kim is back, go to the office"
    promise = await ENGINE.interpret(situation(asked))
    assert promise.queue == () and stored(promise) == []
    before = (Turn("operator", asked), Turn("assistant", promise.message_response))
    assert (await ENGINE.interpret(situation("Kim is not back yet", history=before))).queue == ()
    offered = Dialogue(proposal=PlanProposal(id="7", target="Ada", why="It is not certain."))
    for dialogue in (Dialogue(), offered):
        told: Situation = situation("Kim is back now", history=before, dialogue=dialogue)
        assert [call.name for call in (await ENGINE.interpret(told)).queue] == ["drive_to"]


async def test_an_emergency_stands_still_tells_everybody_and_asks() -> None:
    answer = await ENGINE.interpret(situation("somebody fell in the yard!", status="running"))
    assert answer.alarm and answer.message_response.endswith("?")
    assert [command.command for command in answer.system_cmd] == ["stop"]


AMISS = (
    "there is a puddle next to the pump",
    "somebody has left the front gate open again",
    "the parcel is missing from the desk",
    "nobody has looked at the printer since Monday",
)


@pytest.mark.parametrize("message", AMISS)
async def test_what_is_amiss_is_not_remembered_and_a_look_is_offered(message: str) -> None:
    answer = await ENGINE.interpret(situation(message))
    assert stored(answer) == []
    assert [call.name for call in answer.offer][-1:] == ["look"], answer.message_response


async def test_there_being_something_is_a_fact_and_so_is_what_somebody_asks_to_keep() -> None:
    for message in (
        "there is a water bottle in the blue crate",
        "remember that a bag is missing at the desk",
    ):
        assert len(stored(await ENGINE.interpret(situation(message)))) == 1, message


TALK = (
    "thanks, that was quick",
    "the blue crate is to be painted",
    "the pump is due a look",
    "useless tin can",
)


@pytest.mark.parametrize("message", TALK)
async def test_thanks_wishes_and_insults_are_no_facts(message: str) -> None:
    assert stored(await ENGINE.interpret(situation(message))) == []


@pytest.mark.parametrize(
    ("message", "reply"),
    [
        ("thanks, that's all", "You are welcome."),
        ("that's it, thank you", "You are welcome."),
        ("good night", "Goodbye."),
    ],
)
async def test_who_ends_a_talk_is_not_greeted(message: str, reply: str) -> None:
    answer = await BuiltinLanguage().interpret(situation(message))
    assert answer.message_response == reply


@pytest.mark.parametrize(
    ("message", "kept"),
    [
        ("Kim is in the yard. Go to the moon.", ["Kim is in the yard"]),
        ("the red box is on the desk, can you zorb it?", ["the red box is on the desk"]),
        ("if Kim is in the yard, go to the moon", []),
        ("go to the moon, Kim said so", []),
    ],
)
async def test_a_fact_beside_an_order_that_is_asked_about_is_kept_in_mind(
    message: str, kept: list[str]
) -> None:
    answer = await ENGINE.interpret(situation(message))
    assert (stored(answer), answer.queue) == ([], ())
    said = answer.message_response
    assert all(f"keep in mind that {fact}. " in said for fact in kept) and ("in mind" in said) == bool(kept)
    after = (Turn("operator", message), Turn("assistant", said))
    asked = "where is Kim?" if "Kim" in message else "where is the red box?"
    found = (await ENGINE.interpret(situation(asked, history=after))).message_response
    assert all(fact.rpartition(" ")[2] in found for fact in kept)


async def test_each_of_two_facts_is_kept_with_whom_it_is_about_and_none_of_whom_nobody_named() -> None:
    both = await ENGINE.interpret(situation("Kim is in the office and Ada is at the desk"))
    assert stored(both) == ["Kim is in the office", "Ada is at the desk"]
    assert stored(await ENGINE.interpret(situation("here they are, on your tray"))) == []


async def test_a_fact_is_kept_as_the_whole_sentence() -> None:
    fact = "Ada hides three spoons in her bag"
    assert stored(await ENGINE.interpret(situation(f"{fact}."))) == [fact]


async def test_what_was_forgotten_is_not_told_from_the_conversation_either() -> None:
    past = (
        Turn("operator", "remember that the pump was mended"),
        Turn("assistant", "I forget this: the pump was mended."),
    )
    asked = situation("what do you know about the pump?", history=past)
    assert "have not told me anything" in (await ENGINE.interpret(asked)).message_response


async def test_a_stop_is_for_whom_it_calls() -> None:
    for message, called in (("Bo, stop!", ("Bo",)), ("everybody stop", ("Ada", "Bo")), ("stop", ("Ada",))):
        answer = await ENGINE.interpret(situation(message, robots=("Ada", "Bo")))
        assert answer.targets == called, message
