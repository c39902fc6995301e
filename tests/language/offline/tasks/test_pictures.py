"""What a picture shows, in the words of the robot's detector."""

from __future__ import annotations

import numpy as np
import pytest

from parley.errors import LanguageError
from parley.language.offline import OfflineLanguage
from parley.robots.base import CameraImage, Detection


def picture(*detections: Detection) -> CameraImage:
    return CameraImage(320, 240, "rgb8", np.zeros((240, 320, 3), np.uint8), 0.0, detections)


BOTTLE = Detection("water bottle", 400, (150, 100, 170, 140), 0.8)
SHELF = Detection("bookshelf", 9000, (0, 0, 90, 200))
SPECK = Detection("cup", 12, (10, 10, 14, 13))


@pytest.mark.parametrize(
    "request_text",
    [
        "water bottle",
        "the bottle",
        "is there a bottle?",
        "whether there is a water bottle in the fridge",
        "water",
        "the bottle on the table",
    ],
)
async def test_what_is_there_is_found(request_text: str) -> None:
    report = await OfflineLanguage().inspect(picture(SHELF, BOTTLE), request_text)
    assert report.found is True
    assert report.text == "I can see a water bottle, in the middle of the picture, about 0.8 m away."


async def test_what_is_missing_is_said_with_what_is_there() -> None:
    report = await OfflineLanguage().inspect(picture(SHELF), "water bottle")
    assert (report.found, report.wanted) == (False, "water bottle")
    assert report.text == "I cannot see a water bottle. I can see a bookshelf."


async def test_a_few_pixels_are_not_trusted() -> None:
    assert (await OfflineLanguage().inspect(picture(SPECK), "cup")).found is False


async def test_a_general_look_lists_what_is_seen() -> None:
    report = await OfflineLanguage().inspect(picture(SHELF, BOTTLE, SPECK), "what can be seen")
    assert (report.found, report.wanted) == (None, "")
    assert (
        report.text == "I can see a bookshelf on the left of the picture "
        "and a water bottle in the middle of the picture, about 0.8 m away."
    )


async def test_a_condition_is_left_to_the_operator() -> None:
    report = await OfflineLanguage().inspect(picture(SHELF), "whether the bookshelf is all right")
    assert report.found is True
    assert "Whether the bookshelf is all right, I cannot judge by myself" in report.text


async def test_without_a_detector_nothing_is_claimed() -> None:
    image = CameraImage(2, 2, "rgb8", np.zeros((2, 2, 3), np.uint8), 0.0, None)
    with pytest.raises(LanguageError, match="cannot judge pictures"):
        await OfflineLanguage().inspect(image, "cup")
