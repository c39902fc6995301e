"""Answers in the middle of a repair: questions aside, orders, promises, what was tried."""

from __future__ import annotations

import pytest

from parley.errors import FailureCode
from parley.language.base import Picture
from parley.messages.chat import ChatAction
from tests.language.dev_set import commands, plan
from tests.language.offline.repair.test_recovery import CANDIDATES, ambiguous, answered, failing

BLOCKED = {"near": "refrigerator_1", "at": {"x": 1.0, "y": 5.0}}


async def blocked(reply: str) -> ChatAction:
    return await answered(
        1, FailureCode.BLOCKED, reply, details=BLOCKED, error_message="A box is in the way."
    )


@pytest.mark.parametrize(
    ("reply", "said"),
    [
        ("why?", "A box is in the way. I wanted to go to the refrigerator."),
        ("Why", "A box is in the way."),
        ("what happened?", "A box is in the way."),
        ("where is it?", "by the refrigerator"),
        ("what do you see?", "A box is in the way."),
        ("what were you doing?", "I was at this step: go to the refrigerator. After that I am to look"),
        ("is there another way?", "no other way"),
        ("where is John?", "sofa"),
        ("what can you do?", "go to places"),
        ("who are you?", "Rob"),
    ],
)
async def test_question_is_answered_and_changes_nothing(reply: str, said: str) -> None:
    action = await blocked(reply)
    assert (action.success, action.queue, action.system_cmd) == (None, (), ())
    assert said in action.message_response


async def test_what_was_seen_is_told() -> None:
    details = {"wanted": "bottle", "seen": ["carton", "jar"]}
    action = await answered(2, FailureCode.NO_MATCH, "what do you see?", details=details)
    assert (action.success, action.message_response) == (None, "When I looked, I saw a carton and a jar.")


async def test_question_about_a_candidate_is_no_choice() -> None:
    action = await answered(4, FailureCode.AMBIGUOUS, "where is the small one?", details=CANDIDATES)
    assert action.success is None


@pytest.mark.parametrize(
    "reply",
    ["can you try again?", "could you go around it?", "why don't you try again?", "please try once more"],
)
async def test_request_put_as_a_question_is_a_request(reply: str) -> None:
    action = await blocked(reply)
    assert (action.success, plan(action)) == (True, ["NavigateTo()"])


@pytest.mark.parametrize(
    "reply", ["go around it", "drive around it", "find another way", "take another way", "use the other door"]
)
async def test_going_around_is_another_try(reply: str) -> None:
    action = await blocked(reply)
    assert (plan(action), action.message_response) == (
        ["NavigateTo()"],
        "All right, I look for a way around it.",
    )


@pytest.mark.parametrize(
    ("reply", "steps"),
    [
        ("go to the TV", ["go TV"]),
        ("go to the TV and stop there", ["go TV"]),
        ("go to the TV and wait there", ["go TV"]),
        ("no, go to the TV instead", ["go TV"]),
        ("skip it and go to the TV", ["go TV"]),
    ],
)
async def test_other_order_takes_the_place_of_the_failed_step(reply: str, steps: list[str]) -> None:
    action = await blocked(reply)
    assert (action.success, plan(action), commands(action)) == (True, steps, [])


@pytest.mark.parametrize(
    "reply", ["forget it and go to the TV", "cancel that, go to the TV", "Never mind. Go to the TV."]
)
async def test_other_order_instead_of_everything_drops_the_rest(reply: str) -> None:
    action = await blocked(reply)
    assert (action.success, plan(action), commands(action)) == (True, ["go TV"], ["clear"])


@pytest.mark.parametrize(
    "reply", ["after that go to the TV", "go to the TV afterwards", "when you are done, go to the TV"]
)
async def test_order_for_afterwards_is_confirmed_and_leaves_the_question_open(reply: str) -> None:
    action = await blocked(reply)
    assert (action.success, plan(action)) == (None, ["go TV"])
    assert "afterwards" in action.message_response


@pytest.mark.parametrize("reply", ["I'll move it", "I will come and help", "I am coming"])
async def test_promise_is_waited_for(reply: str) -> None:
    action = await blocked(reply)
    assert (action.success, action.queue) == (None, ())
    assert "when it is done" in action.message_response


@pytest.mark.parametrize(
    ("reply", "delay_s"),
    [
        ("try again in five minutes", 300.0),
        ("give it two minutes", 120.0),
        ("wait 30 seconds and try again", 30.0),
    ],
)
async def test_another_try_later_says_how_much_later(reply: str, delay_s: float) -> None:
    action = await blocked(reply)
    assert (action.success, plan(action), action.delay_s) == (True, ["NavigateTo()"], delay_s)


async def test_fact_about_something_else_is_kept_and_the_question_remains() -> None:
    action = await blocked("The key is on the bookshelf.")
    assert (action.success, action.queue, commands(action)) == (None, (), ["add key_location"])


@pytest.mark.parametrize("reply", ["done", "I did it", "it is done"])
async def test_done_clears_the_way_or_ends_a_step_that_was_the_operators(reply: str) -> None:
    assert plan(await blocked(reply)) == ["NavigateTo()"]
    assert (await answered(3, FailureCode.NOT_CAPABLE, reply)).queue == ()


@pytest.mark.parametrize("reply", ["I have put it on you", "done", "it is there now"])
async def test_handing_over_ends_the_step_that_asked_for_it(reply: str) -> None:
    action = await answered(3, FailureCode.NOT_UNDERSTOOD, reply)
    assert (action.success, action.queue, action.system_cmd) == (True, (), ())


async def test_no_to_another_try_asks_what_else() -> None:
    action = await answered(1, FailureCode.TIMED_OUT, "no")
    assert (action.success, action.choices) == (False, ("go on without it", "stop"))


async def test_looking_elsewhere_looks_for_the_same_thing_there() -> None:
    action = await answered(2, FailureCode.NO_MATCH, "look on the bookshelf")
    assert plan(action) == ["go bookshelf", "look water bottle"]


async def test_after_a_vain_try_the_same_is_offered_last() -> None:
    failed = (await failing(1, FailureCode.BLOCKED)).failed_action
    action = await answered(1, FailureCode.BLOCKED, None, tried=((failed,),))
    assert action.message_response.startswith("That did not help.")
    assert action.choices == ("go on without it", "stop", "try again")


async def test_offline_engine_says_that_it_cannot_see_into_the_picture_of_an_answer() -> None:
    picture = (Picture("a.jpg", b"jpeg", sent=True),)
    bare = await ambiguous("", pictures=picture)
    assert (bare.success, bare.queue) == (None, ())
    assert bare.message_response == "I cannot see what is in a picture. Please tell me in words."
    worded = await ambiguous("the small one", pictures=picture)
    assert worded.success and plan(worded)
    assert worded.message_response.startswith("I cannot see what is in a picture. Thank you.")


@pytest.mark.parametrize(
    ("error", "code", "reply", "named"),
    [
        ("'sofa' could be large sofa or small sofa.", FailureCode.AMBIGUOUS, "the second one", "small sofa"),
        ("Several objects match.", FailureCode.AMBIGUOUS, "the large one", "large sofa"),
        ("There is no such object.", FailureCode.NO_MATCH, "sorry, I meant the large sofa", "large sofa"),
        (
            "There is no such object.",
            FailureCode.NO_MATCH,
            "my mistake, it should be the small sofa",
            "small sofa",
        ),
    ],
)
async def test_what_was_meant_is_taken_where_nothing_is_listed(
    error: str, code: FailureCode, reply: str, named: str
) -> None:
    action = await answered(4, code, reply, error_message=error)
    assert action.success
    assert action.message_response == f"Thank you. I take the {named}."


async def test_what_may_be_meant_is_found_on_the_map() -> None:
    action = await answered(
        4, FailureCode.AMBIGUOUS, None, error_message="'sofa' could be small sofa or large sofa."
    )
    assert action.choices == ("small sofa", "large sofa")


async def test_instead_means_not_that_step_again() -> None:
    action = await blocked("ok then go to the small sofa instead")
    assert (
        action.message_response
        == "All right. I will go to the small sofa. After that I go on with the rest of the plan."
    )
