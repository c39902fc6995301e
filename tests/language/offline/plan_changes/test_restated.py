"""Changes of the plan put as statements: stops that are named, and what the small words around them mean."""

from __future__ import annotations

import pytest

from parley.evaluation.steps import pending, read_steps, write_calls
from parley.language.offline.plan_changes.pending import pending_steps, pending_visits, ranked_steps
from parley.language.offline.plan_changes.restated import restated
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import tokens
from parley.messages.chat import ActionCall, ChatAction
from tests.language.dev_set import situation


def warehouse(message: str, *steps: str) -> Scene:
    asked = situation("warehouse", message, status="running")
    queue = tuple(ActionCall.model_validate(call) for call in write_calls(steps, {}, asked.catalogue))
    return Scene.of(situation("warehouse", message, queue=queue, status="running"))


def left(message: str, *steps: str) -> str | None:
    scene = warehouse(message, *(steps or ("go area A", "go area B", "go area C")))
    edit = restated(tokens(message), scene)
    if edit is None:
        return None
    action = ChatAction(system_cmd=edit.commands, queue=edit.queue)
    found = read_steps(pending(scene.situation.queue, action), scene.situation.catalogue)
    words = (("look " if step.verb == "look" else "") + step.arguments[0] for step in found)
    return " ".join(word.removeprefix("area ") for word in words)


@pytest.mark.parametrize(
    ("message", "kept"),
    [
        ("area B can wait until after area C", "A C B"),
        ("not area A until area C is done", "B C A"),
        ("area C must be done before area B", "A C B"),
        ("after area C you may do area B", "A C B"),
        ("area A comes later than area B", "B A C"),
        ("only the first two are still needed", "A B"),
        ("the first two will do", "A B"),
        ("area A is enough", "A"),
        ("everything but area B can be dropped", "B"),
        ("somebody else will do area B", "A C"),
        ("I will look at area C myself", "A B"),
        ("do not go to area B any more", "A C"),
        ("do area B at the very end instead", "A C B"),
    ],
)
def test_stops_and_small_words_make_a_change(message: str, kept: str) -> None:
    assert left(message) == kept


def test_only_the_look_is_left_out_where_only_that_is_spoken_of() -> None:
    steps = ("go area A", "look bags", "go area B", "look bags")
    assert left("at area B you do not have to look for bags any more", *steps) == "A look bags B"


@pytest.mark.parametrize(
    "message",
    ["I was at area A before area B", "area B is before area C. Area A is nice", "the moon is not needed"],
)
def test_what_only_tells_changes_nothing(message: str) -> None:
    assert left(message) is None


def test_one_reader_finds_the_steps_and_the_stops_that_are_meant() -> None:
    scene = warehouse("", "go area A", "look bags", "go area B", "look bags")
    assert pending_visits(tokens("the second stop"), scene) == [1]
    assert pending_steps(tokens("the third step"), scene) == [2]
    assert pending_steps(tokens("steps 2 and 3 of the plan"), scene) == [1, 2]
    assert pending_steps(tokens("the inspecting"), scene) == [2, 5]
    assert pending_steps(tokens("the area"), scene) == []
    assert ranked_steps(tokens("the ninth step"), 6) == [8]
