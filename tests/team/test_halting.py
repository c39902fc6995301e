"""Who stops and who goes on, where that is said of several robots in one breath."""

from __future__ import annotations

import pytest

from parley.files import words_in
from parley.team.halting import Halting, halting

DATA = words_in("parley.team", "halting")


@pytest.mark.parametrize("case", DATA["tests"], ids=lambda case: str(case["say"]))
def test_sentences_of_the_data_are_read_as_it_says(case: dict[str, str | list[str]]) -> None:
    expected = Halting(tuple(case.get("stops", ())), tuple(case.get("goes", ())))
    assert halting(str(case["say"]), ("Ada", "Kim"), ("Ada",)) == expected
    assert halting(str(case["say"]), ("Ada",), ("Ada",)) is None  # one robot is no team


@pytest.mark.parametrize("say", DATA["none"])
def test_what_is_the_same_for_all_or_more_than_that_is_left_alone(say: str) -> None:
    assert halting(say, ("Ada", "Kim"), ("Ada",)) is None


@pytest.mark.parametrize(
    ("say", "stops", "goes"),
    [
        ("everyone except Ada and Kim, stop", ["Leo"], []),
        ("stop Ada and Kim, let Leo continue", ["Ada", "Kim"], ["Leo"]),
        ("Leo and Kim carry on, the other one waits", ["Ada"], ["Kim", "Leo"]),
        ("the others stop", ["Ada", "Kim"], []),
    ],
)
def test_those_that_are_not_named_are_the_others(say: str, stops: list[str], goes: list[str]) -> None:
    assert halting(say, ("Ada", "Kim", "Leo"), ("Leo",)) == Halting(tuple(stops), tuple(goes))


@pytest.mark.parametrize("say", ["the others carry on", "the other two stop"])
def test_the_others_of_all_are_nobody(say: str) -> None:
    assert halting(say, ("Ada", "Kim", "Leo"), ("Ada", "Kim", "Leo")) is None
