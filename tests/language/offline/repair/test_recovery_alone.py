"""Repairs without asking: protocols, changed memory, mended words, a missing step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.agents.recovery.repair import memory_query
from parley.errors import FailureCode
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.language.offline.facts.protocols import read_protocol
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.memory import MemoryEntry
from parley.world.geometry import Pose2D
from tests.language.dev_set import commands, plan
from tests.language.offline.repair.test_recovery import HOME, answered, failing


def told(*sentences: str) -> tuple[MemoryEntry, ...]:
    return tuple(MemoryEntry(name=f"m{index}", data=text) for index, text in enumerate(sentences))


async def alone(step: int, code: FailureCode, *sentences: str, **changes: object) -> ChatAction:
    return await answered(step, code, None, memory=told(*sentences), **changes)


# -- protocols --


@pytest.mark.parametrize(
    ("text", "acts"),
    [
        ("if you see a leak, stop and tell me", ["stop", "tell"]),
        ("When the way is blocked, wait a minute and try again.", ["wait", "again"]),
        ("whenever you are stuck, call me", ["tell"]),
        ("if something is in your way, go around it", ["around"]),
        ("If you cannot find something, look on the shelf and try again", ["order", "again"]),
        ("stop and tell me if you see smoke", ["stop", "tell"]),
        ("in case the path is blocked wait for 30 seconds then try again", ["wait", "again"]),
        ("please remember that when something goes wrong, you should stop", ["stop"]),
        ("If anything takes too long, cancel it", ["cancel"]),
    ],
)
def test_protocol_is_read_as_taught(text: str, acts: list[str]) -> None:
    protocol = read_protocol(text)
    assert protocol is not None
    assert [act.kind for act in protocol.acts] == acts


@pytest.mark.parametrize(
    "text",
    [
        "if the box is open, go to the door",
        "when you are done, go to the door",
        "go to the desk if the door is open",
        "is the way blocked?",
        "when the way is blocked?",
        "the way is blocked",
        "go to the box",
        "",
    ],
)
def test_condition_for_once_teaches_nothing(text: str) -> None:
    assert read_protocol(text) is None


async def test_teaching_is_confirmed_and_kept_in_the_operators_words() -> None:
    text = "When the way is blocked, wait a minute and try again."
    action = await OfflineLanguage().interpret(Situation(text, robot="Rob"))
    assert "remember" in action.message_response
    assert action.queue == ()
    (command,) = action.system_cmd
    assert command.arguments["data"] == text.rstrip(".")


async def test_protocol_is_carried_out_reported_and_its_memory_named() -> None:
    action = await alone(1, FailureCode.BLOCKED, "When the way is blocked, wait a minute and try again")
    assert (action.success, plan(action), action.delay_s, action.sources) == (
        True, ["NavigateTo()"], 60.0, ("m0",),
    )  # fmt: skip
    assert "wait a minute and try again" in action.message_response


async def test_protocol_to_stop_holds_the_robot_and_tells() -> None:
    action = await alone(
        2, FailureCode.ATTENTION, "if you see a leak, stop and tell me", error_message="I can see a leak."
    )
    assert (action.success, action.queue, commands(action)) == (True, (), ["stop"])
    assert "I can see a leak." in action.message_response


@pytest.mark.parametrize(
    ("sentence", "code", "message"),
    [
        ("When the way is blocked, try again", FailureCode.TIMED_OUT, "It took too long."),
        ("if you see a leak, stop", FailureCode.ATTENTION, "I can see a fire."),
        ("if you see a leak, stop", FailureCode.NO_MATCH, "I cannot see a leak."),
        ("if you cannot find the key, skip it", FailureCode.NO_MATCH, "I cannot see a cup."),
    ],
)
async def test_protocol_for_something_else_is_left_alone(
    sentence: str, code: FailureCode, message: str
) -> None:
    action = await alone(2, code, sentence, error_message=message)
    assert action.success is False


async def test_protocol_that_names_the_thing_goes_first() -> None:
    general, special = "if you cannot find something, skip it", "if you cannot find the bottle, try again"
    action = await alone(2, FailureCode.NO_MATCH, special, general)
    assert plan(action) == ["look water bottle"]


async def test_protocol_to_ask_asks() -> None:
    action = await alone(2, FailureCode.NO_MATCH, "if you cannot find something, ask me")
    assert action.success is False


async def test_protocol_that_did_not_help_is_not_carried_out_again() -> None:
    failed = (await failing(1, FailureCode.BLOCKED)).failed_action
    sentence = "When the way is blocked, wait a minute and try again"
    action = await alone(1, FailureCode.BLOCKED, sentence, tried=((failed,),))
    assert action.success is False


async def test_protocol_may_send_elsewhere() -> None:
    action = await alone(2, FailureCode.NO_MATCH, "If you cannot find the bottle, look on the bookshelf")
    assert plan(action) == ["go bookshelf", "look water bottle"]


# -- memory, words, steps --


async def test_thing_that_was_moved_is_looked_for_where_it_is_now() -> None:
    action = await alone(2, FailureCode.NO_MATCH, "The water bottle is on the bookshelf")
    assert (action.success, plan(action), action.sources) == (
        True, ["go bookshelf", "look water bottle"], ("m0",),
    )  # fmt: skip


async def test_place_that_several_things_fit_is_asked_about_with_the_fact() -> None:
    base = await failing(0, FailureCode.NO_MATCH, memory=told("Kim is on the sofa"))
    inputs = {name: value.with_value("Kim") for name, value in base.failed_action.input_parameters.items()}
    step = base.failed_action.model_copy(update={"input_parameters": inputs})
    action = await OfflineLanguage().resolve(replace(base, failed_action=step))
    assert (action.success, set(action.choices)) == (False, {"small sofa", "large sofa"})
    assert "Kim is on the sofa" in action.message_response
    chosen = await OfflineLanguage().resolve(replace(base, failed_action=step, reply="the small one"))
    assert plan(chosen) == ["GetCoordinates(small sofa)"]


@pytest.mark.parametrize(
    "words", ["go to the bookshelf", "drive to the bookshelf please", "at the bookshelf"]
)
async def test_place_given_as_a_whole_order_is_mended(words: str) -> None:
    base = await failing(0, FailureCode.NO_MATCH, memory=())
    inputs = {name: value.with_value(words) for name, value in base.failed_action.input_parameters.items()}
    step = base.failed_action.model_copy(update={"input_parameters": inputs})
    action = await OfflineLanguage().resolve(replace(base, failed_action=step))
    assert plan(action) == ["GetCoordinates(bookshelf)"]


async def test_thing_that_was_looked_at_from_afar_is_gone_to_first() -> None:
    looking = (await OfflineLanguage().interpret(replace(HOME, message="look at the bookshelf"))).queue[-1]
    base = await failing(
        2, FailureCode.NO_MATCH, memory=(), completed=(), robot_pose=Pose2D(-50.0, -50.0, 0.0)
    )
    action = await OfflineLanguage().resolve(replace(base, failed_action=looking))
    assert plan(action)[0] == "go bookshelf"
    assert action.queue[-1] == looking


async def test_thing_that_the_robot_stands_at_is_asked_about() -> None:
    looking = (await OfflineLanguage().interpret(replace(HOME, message="look at the bookshelf"))).queue[-1]
    shelf = next(item for item in HOME.objects if "bookshelf" in item.description)
    base = await failing(
        2, FailureCode.NO_MATCH, memory=(), completed=(), robot_pose=Pose2D(shelf.x_m, shelf.y_m, 0.0)
    )
    assert (await OfflineLanguage().resolve(replace(base, failed_action=looking))).success is False


async def test_value_that_got_lost_is_worked_out_again() -> None:
    missing = {"missing": ["pose::position::x"]}
    action = await alone(1, FailureCode.INTERNAL, details=missing)
    assert [step.name for step in action.queue] == ["GetCoordinates", "NavigateTo"]


@pytest.mark.parametrize("code", [FailureCode.BLOCKED, FailureCode.NO_MATCH, FailureCode.TIMED_OUT])
async def test_protocol_is_among_the_memories_that_matter_for_the_failure(code: FailureCode) -> None:
    taught = {
        FailureCode.BLOCKED: "When the way is blocked, wait a minute and try again.",
        FailureCode.NO_MATCH: "If you cannot find something, look on the shelf and try again",
        FailureCode.TIMED_OUT: "If anything takes too long, cancel it",
    }
    failure = ErrorHandlingMessage(
        error_message="Something happened.", action_called=ActionCall(name="Go"), target="A", code=code
    )
    index = [*told(*taught.values()), *told("The box is red.")]
    known = [entry.model_copy(update={"name": entry.data}) for entry in index]
    chosen = await OfflineLanguage().select_memories(memory_query(failure, None), known)
    assert taught[code] in chosen
    assert "The box is red." not in chosen
