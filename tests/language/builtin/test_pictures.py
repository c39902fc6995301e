"""What the built-in engine says of a picture: what is there, never how it is."""

from __future__ import annotations

import numpy as np
import pytest

from parley.language.builtin.pictures import inspect
from parley.robots.base import CameraImage, Detection

BOX = Detection("red box", 400, (0, 0, 9, 9), 1.2)
PERSON = Detection("person", 900, (0, 0, 9, 9), 2.0)


@pytest.mark.parametrize(
    ("request_", "found"),
    [
        ("box", True),
        ("the red box", True),
        ("crate", False),
        ("whether there is a box on the desk", True),
        ("whether the box is there", True),
        ("whether there is a crate", False),
        ("whether there is no crate", True),
        ("whether somebody is in the office", True),
        ("whether the box is open", None),
        ("whether Kim wants tea", None),
        ("what you see", None),
    ],
)
def test_whether_something_is_there_is_seen_and_how_it_is_is_not(request_: str, found: bool | None) -> None:
    picture = CameraImage(10, 10, "rgb8", np.zeros((10, 10, 3), np.uint8), 0.0, (BOX, PERSON))
    assert inspect(picture, request_).found is found
