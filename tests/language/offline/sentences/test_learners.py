"""English as learners of it and offices write it."""

from __future__ import annotations

import pytest

from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.learners import usually_said
from parley.language.offline.words.text import plain, tokens
from tests.language.dev_set import situation


def said_usually(message: str) -> str:
    return plain(usually_said(tokens(message), Scene.of(situation("home", message))))


@pytest.mark.parametrize(("message", "usual"), [
    ("An inspection of the TV is required.", "inspect the TV."),
    ("Relocation of the robot to the bookshelf is hereby requested.", "move to the bookshelf."),
    ("Kindly carry out a check of the TV for dust.", "check the TV for dust."),
    ("A visit to the fridge is needed before noon.", "go to the fridge before noon."),
    ("Inspection of the TV, then return to the fridge.", "inspect the TV, then return to the fridge."),
    ("You are requested to go to the TV.", "go to the TV."),
    ("Information on the whereabouts of the cup is requested.", "tell me about the whereabouts of the cup."),
])  # fmt: skip
def test_what_an_office_requests_is_an_order(message: str, usual: str) -> None:
    assert said_usually(message) == usual


@pytest.mark.parametrize(("message", "usual"), [
    ("No go to the TV, go to the fridge.", "do not go to the TV, go to the fridge."),
    ("Go not to the TV.", "do not go to the TV."),
    ("Inspect please the TV.", "Inspect the TV."),
    ("Go to the chair what is near to the TV.", "Go to the chair that is near the TV."),
    ("Tell me where is the cup.", "Tell me where the cup is."),
    ("The cup where is?", "where is The cup?"),
    ("If TV dirty, inspect the fridge.", "If TV is dirty, inspect the fridge."),
    ("Check if is open the fridge.", "Check if the fridge is open."),
    ("Inspect the TV and after go to the fridge.", "Inspect the TV and then go to the fridge."),
    ("The TV is dirty, you inspect.", "The TV is dirty, inspect it."),
])  # fmt: skip
def test_what_a_learner_writes_is_put_as_it_is_usually_said(message: str, usual: str) -> None:
    assert said_usually(message) == usual


@pytest.mark.parametrize("message", [
    "What is near the TV?",
    "Go and see who is there.",
    "No smoking in the kitchen.",
    "Report to the fridge.",
    "Tell her to please come.",
    "Inspect the TV after you go to the fridge.",
    'Say "no go to the TV" to Mary.',
    "See whether I left it on.",
])  # fmt: skip
def test_what_is_usual_already_is_left_as_it_is(message: str) -> None:
    assert said_usually(message) == plain(tokens(message))
