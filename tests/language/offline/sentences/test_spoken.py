"""How a message is put before it is read: run-on speech, frames, conditions, stops in few words."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.conditioning import as_conditions
from parley.language.offline.sentences.frames import unframed
from parley.language.offline.sentences.itineraries import as_itinerary
from parley.language.offline.sentences.run_on import punctuated
from parley.language.offline.sentences.told import in_order
from parley.language.offline.words.text import Phrase, keys, plain, tokens

_PLACES = {"desk", "door", "lamp room", "gate"}


def _is_stop(words: Phrase) -> bool:
    return " ".join(word for word in keys(words) if word not in {"the", "a"}) in _PLACES


def _is_person(words: Phrase) -> bool:
    return keys(words) == ("anna",)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("Desk, then door, gate last", "go to Desk, then go to door, then go to gate"),
        ("The gate once you have been at the desk.", "go to the desk, then go to The gate"),
        ("Inspect the desk. The door before it.", "inspect The door, then inspect the desk"),
        ("desk, door - inspect them in that order", "inspect desk, then inspect door"),
        ("Go to the gate, but not before you have been to the desk", "go to the desk, then go to the gate"),
    ],
)
def test_stops_in_few_words_become_orders_in_their_order(said: str, meant: str) -> None:
    read = as_itinerary(tokens(said), _is_stop)
    assert read is not None
    assert plain(read) == meant


@pytest.mark.parametrize(
    "said", ["Bring the desk, then the door", "desk or door", "is the desk before the door?", "desk"]
)
def test_what_is_more_or_less_than_stops_is_left_alone(said: str) -> None:
    assert as_itinerary(tokens(said), _is_stop) is None


def test_speech_without_marks_is_cut_where_an_order_begins() -> None:
    read = plain(punctuated(tokens("go to the desk check the door come to the gate"), _is_stop))
    assert read == "go to the desk. check the door. come to the gate"


def test_a_condition_without_marks_is_not_cut_from_its_order() -> None:
    said = tokens("if the door is open go to the desk")
    assert punctuated(said, _is_stop) == said


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("I would feel better if somebody looked at the gate", "look at the gate"),
        ("I'm afraid the door is open", "check whether the door is open"),
    ],
)
def test_a_frame_is_taken_off_an_order(said: str, meant: str) -> None:
    assert plain(unframed(tokens(said), _is_stop)) == meant


@pytest.mark.parametrize(
    "said", ["I do not want the door checked", "Anna would like a tea", "I am at the desk"]
)
def test_what_is_no_order_in_a_frame_stays_as_it_is(said: str) -> None:
    assert unframed(tokens(said), _is_stop) == tokens(said)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("Door open? Go to the desk.", "if Door is open, Go to the desk."),
        ("Go to the desk provided the door is shut", "Go to the desk if the door is shut"),
        ("Once Anna has left you may go to the desk", "wait until Anna has left. go to the desk"),
        ("Door open? Desk. Shut? Gate.", "if Door is open, go to Desk, otherwise go to Gate."),
    ],
)
def test_conditions_in_other_shapes_become_the_usual_one(said: str, meant: str) -> None:
    assert plain(as_conditions(tokens(said), _is_stop, _is_person)) == meant


def test_what_comes_before_all_that_is_put_in_front() -> None:
    read = plain(in_order(tokens("Go to the desk. Please, before all that, check the door."), _is_stop))
    assert keys(tokens(read))[:3] == ("check", "the", "door")
