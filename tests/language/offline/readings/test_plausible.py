"""Which words can name a thing, and which can say what to look at."""

from __future__ import annotations

import pytest

from parley.language.offline.readings.plausible import is_request, names_something
from parley.language.offline.words.text import tokens


@pytest.mark.parametrize(
    "text",
    ["the box", "a red box with a lid", "person wearing a hat", "oil", "the door that is open", "cracks"],
)
def test_names_of_things_and_people_are_names(text: str) -> None:
    assert names_something(tokens(text))


@pytest.mark.parametrize(
    "text",
    [
        "only", "they are expecting you", "ready", "it", "somebody", "the box and go to the door",
        "she comes", "so off you go", "box first of all the", "way to the door", "neither",
    ],
)  # fmt: skip
def test_what_nobody_would_call_a_thing_is_no_name(text: str) -> None:
    assert not names_something(tokens(text))


@pytest.mark.parametrize(
    "text", ["whether the door is open", "how many boxes there are", "who it is", "somebody"]
)
def test_states_and_people_at_large_can_be_looked_at(text: str) -> None:
    assert is_request(tokens(text))


@pytest.mark.parametrize(
    "text",
    [
        "whether and while you are out",
        "whether the door is open and go to the hall",
        "whether it is shut and second",
    ],
)
def test_orders_inside_make_no_state(text: str) -> None:
    assert not is_request(tokens(text))
