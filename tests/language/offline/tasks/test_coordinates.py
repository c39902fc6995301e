"""Places on the map named by numbers."""

from __future__ import annotations

import pytest

from parley.language.offline.tasks.going import coordinates
from parley.language.offline.words.text import tokens


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("the point (2.00, 1.50)", (2.0, 1.5)),
        ("the point (-0.25, -1.50)", (-0.25, -1.5)),
        ("(-2, 1)", (-2.0, 1.0)),
        ("x -0.5 m, y 1.5 m", (-0.5, 1.5)),
    ],
)
def test_coordinates_keep_their_sign(text: str, place: tuple[float, float]) -> None:
    assert coordinates(tokens(text)) == place


@pytest.mark.parametrize("text", ["the red box", "3 boxes", "room 2-3"])
def test_what_names_no_place_by_numbers_is_none(text: str) -> None:
    assert coordinates(tokens(text)) is None
