"""Numbers with units, and places in numbers."""

import pytest

from parley.language.offline.words.quantities import plain_coordinates, quantities, taken_by
from parley.language.offline.words.text import tokens


@pytest.mark.parametrize(
    ("said", "value"),
    [
        ("45 mm", 45.0),
        ("45mm", 45.0),
        ("half a minute", 0.5),
        ("an hour and a half", 1.5),
        ("one hundred and twenty", 120.0),
        ("twenty-five percent", 25.0),
        ("minus 5 degrees", -5.0),
        ("a metre twenty", 1.2),
    ],
)
def test_a_number_is_read_in_digits_and_in_words(said: str, value: float) -> None:
    assert [quantity.value for quantity in quantities(tokens(said))] == [value]


def test_an_article_is_no_number() -> None:
    assert quantities(tokens("go to a table")) == []


@pytest.mark.parametrize(
    ("parameter", "said", "value"),
    [
        ("minutes", "half an hour", 30.0),
        ("duration_s", "two minutes", 120.0),
        ("height_mm", "4 cm", 40.0),
        ("distance", "50 cm", 0.5),
        ("temp_c", "37 degrees", 37.0),
        ("volume_ul", "50 microlitres", 50.0),
    ],
)
def test_a_number_is_turned_into_the_unit_of_the_parameter(parameter: str, said: str, value: float) -> None:
    (quantity,) = quantities(tokens(said))

    assert taken_by(parameter).value_of(quantity) == pytest.approx(value)


def test_a_temperature_does_not_take_minutes() -> None:
    (quantity,) = quantities(tokens("20 minutes"))

    assert taken_by("celsius").fit(quantity) == 0


@pytest.mark.parametrize("said", ["(1.5, -2)", "x=1.5, y=-2", "x 1.5 y -2"])
def test_a_place_in_numbers_is_one_place_however_it_is_written(said: str) -> None:
    assert plain_coordinates(f"drive to {said}") == "drive to x 1.5 y -2"


def test_three_numbers_keep_their_axes() -> None:
    assert plain_coordinates("fly to (12, -3, 8)") == "fly to x 12 y -3 z 8"


def test_both_numbers_of_a_size_have_its_unit() -> None:
    said = quantities(tokens("trim it to 40 by 60 cm"))
    assert [(one.value, one.dimensions) for one in said] == [
        (40.0, frozenset({"length"})),
        (60.0, frozenset({"length"})),
    ]
