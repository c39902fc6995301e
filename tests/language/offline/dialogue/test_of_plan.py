"""Questions about what is planned, being done or done."""

from __future__ import annotations

import pytest

from parley.evaluation.steps import write_calls
from parley.language.offline.dialogue.of_plan import of_plan
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import keys, tokens
from parley.messages.chat import ActionCall
from tests.language.dev_set import situation


def answered(message: str, *steps: str) -> str | None:
    catalogue = situation("warehouse", message).catalogue
    queue = tuple(ActionCall.model_validate(call) for call in write_calls(steps, {}, catalogue))
    words = tuple(word for word in tokens(message) if word.is_word)
    found = of_plan(
        words, keys(words), Scene.of(situation("warehouse", message, queue=queue, status="running"))
    )
    return None if found is None else found.text


@pytest.mark.parametrize(
    ("message", "said"),
    [
        ("is area B still on your list?", "Yes, area B is stop 2 of 2, after area A."),
        ("is area C planned?", "No, area C is not in my plan."),
        ("when is it area B's turn?", "Area B is stop 2 of 2"),
        ("did you forget area C?", "Area C is not in my plan."),
        ("have you been to area A yet?", "Not yet, I am on it now."),
        ("are you nearly finished?", "Not yet: 2 stops are left"),
        ("how much of the round have you done?", "2 stops are left"),
        ("will you be at area B soon?", "Area B is stop 2 of 2"),
    ],
)
def test_the_plan_answers_what_is_asked_of_it(message: str, said: str) -> None:
    assert (answered(message, "go area A", "go area B") or "").startswith(said)


def test_with_nothing_planned_nothing_is_left() -> None:
    assert (answered("do you still have anything to do?") or "").startswith("Nothing is left")
    assert (answered("have you been to area A yet?") or "").startswith("No, nobody has sent me")


@pytest.mark.parametrize(
    "message",
    ["is area A still open?", "why are you going to area A?", "do not check area B", "what is in area A?"],
)
def test_other_questions_are_left_to_others(message: str) -> None:
    assert answered(message, "go area A", "go area B") is None
