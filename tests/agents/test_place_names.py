"""What people call the place where a robot stands, and what only sounds like it."""

from __future__ import annotations

from typing import Any

import pytest

from parley.agents.chat.place_names import corrected_place, forgotten_place, named_here, taken_off
from parley.files import words_in

DATA: dict[str, Any] = words_in("parley.agents.chat", "place_names")


@pytest.mark.parametrize(("said", "name"), DATA["tests"].items())
def test_what_the_place_is_called_is_read(said: str, name: str) -> None:
    assert named_here(said) == name


@pytest.mark.parametrize("said", DATA["others"])
def test_what_is_no_name_of_a_place_is_left_to_whoever_understands_it(said: str) -> None:
    assert named_here(said) == ""


@pytest.mark.parametrize(("said", "name"), DATA["corrections"].items())
def test_a_correction_says_what_it_is_instead(said: str, name: str) -> None:
    assert corrected_place(said) == name


@pytest.mark.parametrize("said", ["no", "no thanks", "not now", "no, go to the door", "that is wrong", "yes"])
def test_a_plain_no_corrects_nothing(said: str) -> None:
    assert corrected_place(said) == ""


@pytest.mark.parametrize(("said", "name"), DATA["losses"].items())
def test_what_is_to_be_forgotten_is_read(said: str, name: str) -> None:
    assert (forgotten_place(said) or taken_off(said)) == name


@pytest.mark.parametrize(
    "said", ["forget it", "forget that", "forget what I said", "don't forget the pharmacy"]
)
def test_what_names_nothing_is_not_taken_off(said: str) -> None:
    assert forgotten_place(said) == taken_off(said) == ""
