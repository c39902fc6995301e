"""AskOperator: puts the question, understands the answer, and asks again at most twice."""

from __future__ import annotations

import pytest

from parley.actions.ask_operator import ATTEMPTS, ask_operator
from parley.errors import ActionFailure, FailureCode
from parley.language.base import ReplyReading
from parley.language.builtin.engine import BuiltinLanguage
from tests.actions.room import room

QUESTION = "Please put the box on me and tell me when it is done."


@pytest.mark.parametrize("reply", ["done", "I have put it on you", "yes"])
async def test_answer_is_given_on_word_for_word(reply: str) -> None:
    async with room(language=BuiltinLanguage()) as here:
        here.person.answers.append(reply)
        assert (await ask_operator(here.context, QUESTION)).answer == reply
        assert here.person.asked == [QUESTION]


async def test_a_request_is_met_or_refused_with_one_tap_and_no_engine_is_asked() -> None:
    async with room() as here:  # its language was told nothing, and would fail
        here.person.answers.extend(["It is on you", "I can't"])
        assert (await ask_operator(here.context, QUESTION)).answer == "It is on you"
        with pytest.raises(ActionFailure) as caught:
            await ask_operator(here.context, QUESTION)
        assert caught.value.code is FailureCode.DECLINED
        assert here.person.offered == [("It is on you", "I can't")] * 2


async def test_an_open_question_offers_nothing() -> None:
    async with room(language=BuiltinLanguage()) as here:
        here.person.answers.append("the red one")
        await ask_operator(here.context, "Which box shall I take?")
        assert here.person.offered == [()]


async def test_no_is_a_failure_that_names_the_request() -> None:
    async with room(language=BuiltinLanguage()) as here:
        here.person.answers.append("no, I won't")
        with pytest.raises(ActionFailure) as caught:
            await ask_operator(here.context, QUESTION)
        assert caught.value.code is FailureCode.DECLINED
        assert caught.value.details == {"question": QUESTION, "reply": "no, I won't"}


async def test_unclear_answer_is_asked_again_with_what_can_be_said() -> None:
    async with room() as here:
        here.script.will("read_reply", ReplyReading("unclear"), ReplyReading("yes"))
        here.person.answers.extend(["purple", "done"])
        assert (await ask_operator(here.context, QUESTION)).answer == "done"
        assert here.person.asked[1].startswith("I did not understand that.")
        assert QUESTION in here.person.asked[1]
        assert "skip it" in here.person.asked[1]


async def test_answers_that_are_never_understood_end_in_a_failure() -> None:
    async with room() as here:
        here.script.will("read_reply", *[ReplyReading("unclear")] * ATTEMPTS)
        here.person.answers.extend(["purple"] * ATTEMPTS)
        with pytest.raises(ActionFailure) as caught:
            await ask_operator(here.context, QUESTION)
        assert caught.value.code is FailureCode.NOT_UNDERSTOOD
        assert len(here.person.asked) == ATTEMPTS


async def test_words_for_the_plan_are_no_answer_and_do_not_use_up_the_attempts() -> None:
    async with room() as here:
        here.script.will("read_reply", ReplyReading("yes"))  # words of stopping are read by code
        here.person.answers.extend(["stop"] * (ATTEMPTS + 1) + ["done"])
        assert (await ask_operator(here.context, QUESTION)).answer == "done"
        assert set(here.person.asked) == {QUESTION}


async def test_going_on_after_a_pause_does_not_count_as_the_answer() -> None:
    async with room(language=BuiltinLanguage()) as here:
        here.run.paused = True
        here.person.answers.extend(["carry on", "done"])
        assert (await ask_operator(here.context, QUESTION)).answer == "done"
        assert here.person.asked == [QUESTION, QUESTION]


async def test_going_on_is_an_answer_where_nothing_is_paused() -> None:
    async with room() as here:
        here.script.will("read_reply", ReplyReading("yes"))
        here.person.answers.append("carry on")
        assert (await ask_operator(here.context, QUESTION)).answer == "carry on"


@pytest.mark.parametrize(
    "reply", ["where should I put it?", "forget it and go to the box", "go to the box", "are you all right?"]
)
async def test_question_or_other_order_is_no_answer_but_passed_on_and_asked_again(reply: str) -> None:
    async with room(language=BuiltinLanguage()) as here:
        here.person.answers.extend([reply] * ATTEMPTS + ["done"])
        assert (await ask_operator(here.context, QUESTION)).answer == "done"
        assert here.person.referred == [reply] * ATTEMPTS
        assert here.person.asked == [QUESTION] * (ATTEMPTS + 1)


@pytest.mark.parametrize("reply", ["tea with milk", "the red one", "in the hall", "put it by the door"])
async def test_open_question_takes_whatever_answers_it(reply: str) -> None:
    async with room(language=BuiltinLanguage()) as here:
        here.person.answers.append(reply)
        assert (await ask_operator(here.context, "What shall I bring you?")).answer == reply
        assert here.person.referred == []
