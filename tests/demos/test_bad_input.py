"""Bad input on every topic of a running system: a clear refusal, nothing lost, and it goes on."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Any

import pytest

from parley.demos.catalogue import load_demo
from parley.messages import topics
from parley.messages.ros import String, UmrfGraphModify, UmrfGraphPause, UmrfGraphStart, UmrfGraphStop
from tests.demos.house import FULL_SPEED, House, running

JSON_TOPICS = [
    topics.CHAT_INPUT,
    topics.CHAT_ACTION,
    topics.UMRF_CORRECTION,
    topics.ERROR_HANDLING,
    topics.ADD_TO_MEMORY,
    topics.REMOVE_MEMORY,
    topics.DISPLAY_FEED,
    topics.PLAN_DECISION,
    topics.STEP,
    topics.STOP,
]


@pytest.fixture
async def home() -> AsyncIterator[House]:
    async with running(load_demo("nursing-home").system(FULL_SPEED)) as house:
        yield house


async def still_works(home: House) -> None:
    """The system understands and drives as before."""
    await home.say("go to the TV")
    assert set(await home.done()) == {"finished"}


@pytest.mark.parametrize("topic", JSON_TOPICS, ids=lambda topic: topic.name)
async def test_malformed_json_is_refused_and_everything_goes_on(home: House, topic: Any) -> None:
    for text in ("{not json", "[]", '{"a": NaN}', "[" * 100_000):
        before = len(home.observer.refusals)
        home.observer.send(topic, String(text))
        await home.observer.until(lambda: len(home.observer.refusals) > before, timeout_s=10)  # noqa: B023
        refusal = home.observer.refusals[before]
        assert refusal.what == topic.name
        assert refusal.problems[0].message
    reply = await home.say("what can you do?")
    assert reply.type == "response"


@pytest.mark.parametrize(
    ("topic", "message"),
    [
        (topics.GRAPH_START, UmrfGraphStart(umrf_graph_json="{", targets=("David",))),
        (topics.GRAPH_START, UmrfGraphStart(umrf_graph_name="nobody knows", targets=("David",))),
        (topics.GRAPH_MODIFY, UmrfGraphModify(modified_graph="{}", targets=("David",))),
        (topics.GRAPH_PAUSE, UmrfGraphPause("nobody knows", ("David",))),
        (topics.GRAPH_STOP, UmrfGraphStop("nobody knows", ("David",))),
    ],
    ids=["malformed start", "unknown start", "empty modify", "unknown pause", "unknown stop"],
)
async def test_bad_graph_commands_are_refused_with_a_reason(home: House, topic: Any, message: Any) -> None:
    home.observer.send(topic, message)
    await home.observer.until(lambda: bool(home.observer.refusals), timeout_s=10)
    assert home.observer.refusals[0].what == topic.name
    assert home.observer.refusals[0].problems
    await still_works(home)


async def test_graph_whose_parameters_do_not_match_is_refused_with_all_reasons(home: House) -> None:
    graph = """{"graph_name": "g", "actions": [{"name": "NavigateTo", "type": "sync",
        "input_parameters": {"pose": {"position": {"x": {"pvf_type": "string", "pvf_value": "far"}}},
                             "speed": {"pvf_type": "number", "pvf_value": 9}}}]}"""
    home.observer.send(topics.GRAPH_START, UmrfGraphStart(umrf_graph_json=graph, targets=("David",)))
    await home.observer.until(lambda: bool(home.observer.refusals), timeout_s=10)
    paths = [problem.path for problem in home.observer.refusals[0].problems]
    assert len(paths) > 1
    assert any("position.x" in path for path in paths)
    assert any("speed" in path for path in paths)


async def test_unknown_robot_action_and_command_in_a_chat_action(home: House) -> None:
    home.observer.send(topics.CHAT_ACTION, String('{"targets": ["Nobody"], "queue": []}'))
    await home.observer.until(lambda: len(home.observer.refusals) >= 1, timeout_s=10)
    assert home.observer.refusals[0].problems[0].code == "unknown_robot"
    home.observer.send(topics.CHAT_ACTION, String('{"targets": ["David"], "queue": [{"Fly": {}}]}'))
    await home.observer.until(lambda: len(home.observer.refusals) >= 2, timeout_s=10)
    assert "Fly" in home.observer.refusals[1].problems[0].message
    home.observer.send(topics.CHAT_ACTION, String('{"targets": ["David"], "system_cmd": [{"__init__": {}}]}'))
    await home.observer.until(lambda: len(home.observer.refusals) >= 3, timeout_s=10)
    assert "__init__" in home.observer.refusals[2].problems[0].message
    await still_works(home)


@pytest.mark.parametrize(
    "text", ["", " \n ", "x" * 100_000, "go " * 33_000], ids=["empty", "blank", "100 kB", "words"]
)
async def test_messages_of_no_sense_get_a_sentence(home: House, text: str) -> None:
    reply = await home.say(text)
    assert reply.type == "error"
    assert 10 < len(reply.message) < 300
    await still_works(home)
