"""What is taken back in the same breath, lists, and what comes first though it is said later."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.arranging import arranged, each_in_turn, without_end
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.correcting import corrected
from parley.language.offline.sentences.itineraries import as_itinerary
from parley.language.offline.sentences.named import verb_first, with_articles
from parley.language.offline.sentences.numbering import unnumbered
from parley.language.offline.sentences.units import units
from parley.language.offline.words.text import Phrase, keys, plain, tokens

NAMES = {"desk", "hall", "lift", "blue door", "red door", "box 1", "box 2", "lift b"}


def is_stop(words: Phrase) -> bool:
    return " ".join(keys(words)).removeprefix("the ") in NAMES


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("go to the desk, no wait, the hall", "go to the hall"),
        ("inspect box 1, sorry, I meant box 2.", "inspect box 2."),
        ("look at box 1, I mean 2", "look at box 2"),
        ("go to the desk... actually make that the hall", "go to the hall"),
        ("go to the desk and check the hall, no, other way round", "check the hall and go to the desk"),
        ("go to the desk, hold on, it is locked, go to the hall", "go to the hall"),
        ("check the desk for mice no sorry not the desk the hall", "check the hall for mice"),
        ("go to the desk and check the hall. Skip the desk.", "check the hall."),
        ("inspect the desk and the hall. On second thought, leave the desk alone.", "inspect the hall."),
        ("look if the lift is locked, sorry, closed", "look if the lift is closed"),
        ("first the desk then the hall, sorry, the hall first", "first the hall then the desk"),
    ],
)
def test_the_last_word_counts(said: str, meant: str) -> None:
    assert plain(corrected(tokens(said), is_stop, opens_command)) == meant


@pytest.mark.parametrize(
    "said",
    [
        "go to the desk. No rush, I am here all day.",
        "go to the desk and wait there, then return",
        "no, thanks",
    ],
)
def test_what_only_sounds_like_a_correction_changes_nothing(said: str) -> None:
    assert corrected(tokens(said), is_stop, opens_command) == tokens(said)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("1) desk 2) hall", "desk. hall"),
        ("Step 1: desk. Step 2: hall.", "desk. hall."),
        ("first stop desk second stop hall", "desk. hall"),
        ("the last thing you do is check the desk.", "check the desk last."),
        ("go to box 1", "go to box 1"),
    ],
)
def test_the_numbers_of_a_list_are_no_words_of_it(said: str, meant: str) -> None:
    assert plain(unnumbered(tokens(said))) == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        (
            "The desk after the hall, the hall after the lift.",
            "go to the lift, then go to the hall, then go to The desk",
        ),
        (
            "the desk before the hall, and the lift before the desk",
            "go to the lift, then go to the desk, then go to the hall",
        ),
        ("the desk. the hall. back to the desk", "go to the desk, then go to the hall, then go to the desk"),
        (
            "the desk, then the hall, the lift at the very end",
            "go to the desk, then go to the hall, then go to the lift",
        ),
        ("inspect the desk after you have been to the hall", "go to the hall, then inspect the desk"),
        (
            "start with the desk, end with the hall; the lift goes between them",
            "go to the desk, then go to the lift, then go to the hall",
        ),
        (
            "the desk, the hall, the lift in reverse order",
            "go to the lift, then go to the hall, then go to the desk",
        ),
        ("the desk, then the hall, then back here", "go to the desk, then go to the hall, then come back"),
    ],
)
def test_stops_come_in_the_order_that_is_said_pair_by_pair(said: str, meant: str) -> None:
    found = as_itinerary(tokens(said), is_stop)
    assert found is not None
    assert plain(found) == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("Go to the desk, but on the way there check the hall.", "check the hall. Go to the desk."),
        ("Go to the desk. Go to the hall instead.", "Go to the hall."),
        ("Check the desk last. Then go to the hall.", "Then go to the hall. Check the desk."),
        ("Check the desk, but go to the hall before you do that.", "but go to the hall. Check the desk."),
        ("Leave the desk until last. Check the hall.", "Check the hall. go to the desk."),
        ("Go to the desk. Check the hall before you start.", "Check the hall. Go to the desk."),
        ("Go to the desk. But check the hall first.", "check the hall. Go to the desk."),
        ("Check the desk. Right at the start, go to the hall.", "go to the hall. Check the desk."),
    ],
)
def test_orders_come_where_they_are_meant(said: str, meant: str) -> None:
    found = arranged(units(tokens(said), is_stop, opens_command))
    assert found is not None
    assert plain(found) == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("The desk, the hall. Look at each of them.", "Look at The desk. Look at the hall."),
        (
            "The desk and the hall are left, check those two for dirt.",
            "check The desk for dirt. check the hall for dirt.",
        ),
        (
            "There was smoke at the desk or the lift. Check both.",
            "There was smoke at the desk or the lift. Check the desk. Check the lift.",
        ),
        (
            "The lift was loud. The noise came from the desk or the hall. Check both for rats.",
            "The lift was loud. The noise came from the desk or the hall. Check the desk for rats. "
            "Check the hall for rats.",
        ),
    ],
)
def test_what_is_to_be_done_with_each_is_done_in_the_order_of_the_list(said: str, meant: str) -> None:
    found = each_in_turn(units(tokens(said), is_stop, opens_command))
    assert found is not None
    assert plain(found) == meant


@pytest.mark.parametrize(
    "said",
    [
        "The hall was loud. Check both.",
        "The noise came from the desk or the hall. Go to the lift. Check both.",
        "There was smoke at the desk, the hall or the lift. Check both.",
    ],
)
def test_both_are_the_two_that_were_told_of_last_and_no_others(said: str) -> None:
    assert each_in_turn(units(tokens(said), is_stop, opens_command)) is None


def test_a_name_that_begins_like_an_order_gets_its_article() -> None:
    assert (
        plain(with_articles(tokens("check the hall, then lift b"), is_stop))
        == "check the hall, then the lift b"
    )


def test_what_to_do_may_stand_behind_the_name() -> None:
    assert plain(verb_first(tokens("the desk: inspect it. the hall: just go there"), is_stop)) == (
        "inspect the desk. go to the hall"
    )


def test_that_is_it_at_the_end_says_nothing() -> None:
    assert plain(without_end(tokens("go to the desk that's it thanks"))) == "go to the desk thanks"
