"""What holds for every message, whatever it says."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.offline import OfflineLanguage
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject
from tests.language.dev_set import CATALOGUES, commands, development_set, plan, situation

ENGINE = OfflineLanguage()
WORDS = sorted({word for case in development_set().cases for word in case.body.say.split()})
SENTENCES = st.lists(st.sampled_from(WORDS), max_size=14).map(" ".join)
WORLDS = st.sampled_from(["home", "warehouse", "nonsense", "primitives", "bare"])


@settings(max_examples=150, deadline=None)
@given(WORLDS, SENTENCES | st.text(max_size=80))
def test_any_message_gets_a_plain_answer_and_only_actions_of_the_catalogue(world: str, message: str) -> None:
    asked = situation(world, message)
    action = asyncio.run(ENGINE.interpret(asked))
    known = {info.name: info for info in asked.catalogue}
    assert action.message_response.strip()
    for step in action.queue:
        assert set(step.input_parameters) == set(known[step.name].inputs)
        assert set(step.output_parameters) == set(known[step.name].outputs)


@settings(max_examples=60, deadline=None)
@given(SENTENCES, st.sampled_from(list(FailureCode)))
def test_any_answer_to_a_failure_is_a_repair_a_question_or_an_answer(reply: str, code: FailureCode) -> None:
    failed = ActionCall(name="NavigateTo")
    asked = ErrorSituation("x", failed, code, reply=reply, catalogue=CATALOGUES["thesis"])
    action: ChatAction = asyncio.run(ENGINE.resolve(asked))
    assert action.message_response.strip()
    assert action.success is not False or action.message_response.rstrip().endswith("?")


NAMES = st.text("bdfgklmnprstvz", min_size=2, max_size=3).map(
    lambda letters: "".join(c + "u" for c in letters) + "q"
)


@settings(max_examples=40, deadline=None)
@given(st.lists(NAMES, min_size=4, max_size=4, unique=True))
def test_the_story_holds_with_words_nobody_has_seen(names: list[str]) -> None:
    """A fact about a person, a fact about a thing, a request that needs both."""
    person, thing, store, seat = names[0].capitalize(), *names[1:]
    world = situation("fresh", "", objects=())
    objects = (
        MapObject("s-one", store, 1, 1, store),
        MapObject("t-one", f"small {seat}", 4, 1, seat),
        MapObject("t-two", f"large {seat}", 8, 1, seat),
    )
    said: list[ChatAction] = []
    memory: tuple[MemoryEntry, ...] = ()
    for message in (
        f"{person} is on the {seat}",
        f"There is a {thing} in the {store}",
        f"get {person} the {thing}",
    ):
        action = asyncio.run(
            ENGINE.interpret(replace(world, message=message, objects=objects, memory=memory))
        )
        said.append(action)
        memory += tuple(
            MemoryEntry(name=c.arguments["name"], data=c.arguments["data"]) for c in action.system_cmd
        )
    assert commands(said[0]) == [f"add {person.lower()}_location"]
    assert commands(said[1]) == [f"add {thing}_location"]
    assert plan(said[2]) == [f"go {store}", f"look {thing}", "ask", f"go {seat}"]


@pytest.mark.parametrize(
    "message", ["mind", "you mind", "going", "mind going", "not", "?", "and", "if", "instead of"]
)
def test_a_word_alone_is_answered(message: str) -> None:
    answer = asyncio.run(ENGINE.interpret(situation("home", message)))
    assert answer.message_response
    assert not answer.queue


@pytest.mark.parametrize(
    "message",
    ["John is thirsty", "I need some tea", "go to the desk", "look at the desk", "follow me"],
)
def test_a_robot_that_can_do_nothing_says_so(message: str) -> None:
    answer = asyncio.run(ENGINE.interpret(situation("home", message, catalogue=())))
    assert answer.message_response
    assert not answer.queue
