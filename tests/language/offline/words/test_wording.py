"""Words turned from one speaker to another."""

from __future__ import annotations

import pytest

from parley.language.offline.plan_changes.repeating import counted_times, without_recurrence
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.simultaneous import side_by_side
from parley.language.offline.words.saying import in_turn
from parley.language.offline.words.text import keys, plain, tokens
from parley.language.offline.words.wording import (
    as_others_say,
    asked_directly,
    counted_plainly,
    shared_out,
    still_there,
    turned,
)


@pytest.mark.parametrize(
    ("said", "repeated"),
    [
        ("until I call you", "until you call me"),
        ("bring me my box", "bring you your box"),
        ("when you see me", "when I see you"),
    ],
)
def test_the_operators_words_are_repeated_from_the_robots_side(said: str, repeated: str) -> None:
    assert plain(turned(tokens(said))) == repeated


@pytest.mark.parametrize(
    ("reported", "asked"),
    [
        ("whether she needs help", "Do you need help?"),
        ("if he is cold", "Are you cold?"),
        ("whether the box is open", "Is the box open?"),
        ("what he wants", "What do you want?"),
        ("what their name is", "What is your name?"),
        ("the box is open", "the box is open"),
    ],
)
def test_a_reported_question_is_put_directly(reported: str, asked: str) -> None:
    assert asked_directly(tokens(reported)) == asked


@pytest.mark.parametrize(
    ("said", "rest", "often"),
    [
        ("check the box every ten minutes", "check the box", "every ten minutes"),
        ("every hour, check the box", "check the box", "every hour"),
        ("check the box hourly", "check the box", "hourly"),
        ("check every box", "check every box", ""),
    ],
)
def test_how_often_is_told_from_what(said: str, rest: str, often: str) -> None:
    words, found = without_recurrence(tokens(said))
    assert (plain(words), found) == (rest, often)


def test_a_number_of_times_is_counted() -> None:
    assert counted_times(tokens("check the box three times")) == (tokens("check the box"), 3)
    assert counted_times(tokens("check the box")) == (tokens("check the box"), 1)


@pytest.mark.parametrize(
    ("said", "first", "second", "both"),
    [
        ("go to the box and at the same time say hello", "go to the box", "say hello", True),
        ("say hello while you drive to the box", "drive to the box", "say hello", True),
        ("check the box while waiting", "check the box", "", False),
        ("while you are at the door, check the box", "visit the door", "check the box", False),
    ],
)
def test_what_is_done_at_the_same_time_is_found(said: str, first: str, second: str, both: bool) -> None:
    found = side_by_side(tokens(said), opens_command)
    assert found is not None
    assert (keys(found[0]), keys(found[1]), found[2]) == (keys(tokens(first)), keys(tokens(second)), both)


def test_conditions_are_told_in_turn() -> None:
    assert in_turn(["look", "if so, go", "if not, stay"]) == "look; if so, go; if not, stay"


@pytest.mark.parametrize(
    ("say", "plainly"),
    [
        ("tell me how many cups you can see on the desk", "tell me how many cups on the desk"),
        ("how many cups there are on the desk", "how many cups on the desk"),
        ("tell me what you see", "tell me what you see"),
    ],
)
def test_what_is_counted_is_said_without_who_sees_it(say: str, plainly: str) -> None:
    assert plain(counted_plainly(tokens(say))) == plainly


def test_an_amount_for_each_is_an_amount() -> None:
    assert plain(shared_out(tokens("water both rows, five litres each"))) == "water both rows, five litres"
    assert plain(shared_out(tokens("check each room"))) == "check each room"


@pytest.mark.parametrize(("say", "plainly"), [
    ("if there is no tea left, go on", "if there is no tea, go on"),
    ("there are two cups remaining", "there are two cups"),
    ("there is a door on the left", "there is a door on the left"),
    ("there is a bag left at the gate", "there is a bag left at the gate"),
])  # fmt: skip
def test_what_is_left_over_is_there(say: str, plainly: str) -> None:
    assert plain(still_there(tokens(say))) == plainly


@pytest.mark.parametrize(
    ("said", "plainly_put"),
    [
        ("The campers on lot 4 say it smells of gas.", "The campers on lot 4 says it smells of gas."),
        (
            "The couple in hut 1 complain that the tap drips.",
            "The couple in hut 1 complains that the tap drips.",
        ),
        ("It would be nice if the guests had fresh sheets.", "the guests would like fresh sheets."),
        (
            "it would be lovely if the visitors could see the otters",
            "the visitors would like to see the otters",
        ),
        ("Neither of the taps has been tested yet.", "both taps have not been tested yet."),
        ("None of the boats has been washed.", "all the boats have not been washed."),
    ],
)
def test_what_others_tell_and_wish_is_put_plainly(said: str, plainly_put: str) -> None:
    assert plain(as_others_say(tokens(said))) == plainly_put


@pytest.mark.parametrize(
    "said",
    [
        "Then say that the shop is closed.",
        "The guests say hello.",
        "It would be nice if you could check the boats.",
        "It would be nice if somebody could see to it.",
        "None of the boats is blue.",
    ],
)
def test_orders_and_facts_stay_as_they_are(said: str) -> None:
    assert as_others_say(tokens(said)) == tokens(said)
