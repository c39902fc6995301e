"""What a picture shows of what is asked for."""

from __future__ import annotations

import numpy as np
import pytest

from parley.language.builtin.pictures import inspect
from parley.robots.base import CameraImage, Detection

SEEN = ("desk", "oil can", "red box")


@pytest.mark.parametrize(
    ("request_", "found", "wanted"),
    [
        ("whether there is a box on the desk", True, "red box"),
        ("whether there is oil on the desk", True, "oil can"),
        ("whether there is a lamp on the desk", False, "lamp"),
        ("if you see any rope there", False, "rope"),
        ("red box", True, "red box"),
        ("box", False, "box"),
    ],
)
def test_whether_something_is_there_is_not_where_it_would_be(request_: str, found: bool, wanted: str) -> None:
    detections = tuple(Detection(label, 500, (0, 0, 2, 2), 1.0) for label in SEEN)
    image = CameraImage(4, 4, "rgb8", np.zeros((4, 4, 3), dtype=np.uint8), 0.0, detections)
    report = inspect(image, request_)
    assert (report.found, report.wanted) == (found, wanted)
