"""Statements parted where they end, questions turned, looks said in other words."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.dialogue.turning import turned
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.finite import dislocated, parted, verb_at
from parley.language.offline.sentences.look_only import as_look, is_look
from parley.language.offline.sentences.rounds import as_round
from parley.language.offline.words.text import plain, tokens
from parley.world.object_map import MapObject


@pytest.mark.parametrize(
    ("said", "sentences"),
    [
        ("Ada asked for tea, she is cold", "Ada asked for tea. she is cold"),
        ("bring the box, it is in the hall", "bring the box. it is in the hall"),
        ("I moved it away so the way is free", "I moved it away. the way is free"),
        ("the box\nis in the hall", "the box is in the hall"),
        ("if the door is open, it is cold", "if the door is open, it is cold"),
        ("go to the desk, the door and the box", "go to the desk, the door and the box"),
    ],
)
def test_whole_statements_are_parted_and_nothing_else(said: str, sentences: str) -> None:
    assert plain(parted(tokens(said))) == sentences


def test_a_subject_that_is_said_twice_counts_once() -> None:
    assert plain(dislocated(tokens("the red one, that is mine"))) == "the red one is mine"


def test_the_verb_of_a_statement_is_found_in_any_form() -> None:
    assert [verb_at(tokens(text)) for text in ("Ada drinks tea", "the hens end here", "go home")] == [1, 2, 0]


@pytest.mark.parametrize(
    ("said", "look"),
    [
        ("go and have a look please", "check"),
        ("could you take a closer look at it", "inspect it"),
        ("go nearer", "go to it"),
        ("look for it", "look for it"),
        ("look at the desk", "look at the desk"),
    ],
)
def test_looks_in_other_words_are_put_plainly(said: str, look: str) -> None:
    assert plain(as_look(tokens(said))) == look


def test_only_looks_are_looks() -> None:
    assert is_look(tokens("please go and see"))
    assert not is_look(tokens("go to the desk"))


@pytest.mark.parametrize(
    ("question", "statement"),
    [
        ("is the side door open", "the side door is open"),
        ("is there tea in the hall", "there is tea in the hall"),
        ("has Ada finished her tea", "Ada has finished her tea"),
        ("does the side door squeak", "the side door squeaks"),
        ("are you ready", ""),
    ],
)
def test_a_question_is_turned_into_what_it_asks_about(question: str, statement: str) -> None:
    door = MapObject(id="door_1", description="side door", x_m=4.0, y_m=1.0, class_name="door")
    assert plain(turned(tokens(question), Scene.of(Situation(message="", objects=(door,))))) == statement


def test_a_round_is_a_visit() -> None:
    assert plain(as_round(tokens("do a quick round of the halls"))) == "visit the halls"
