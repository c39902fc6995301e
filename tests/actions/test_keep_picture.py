"""KeepPicture: the picture is shown, remembered under its name with where it was taken, and said so."""

from __future__ import annotations

import pytest

from parley.actions.inspect import FEED
from parley.actions.keep_picture import UNNAMED, keep_picture
from parley.errors import ActionFailure, FailureCode
from tests.actions.room import room
from tests.memory.photos import opened


async def test_what_the_camera_sees_is_shown_and_remembered_for_all() -> None:
    async with room() as here:
        here.run.node = "KeepPicture_3"
        await keep_picture(here.context, "the open gate")
        (entry,) = here.person.memories
        assert (entry.name, entry.type, entry.scope) == ("the open gate", "image", "")
        assert entry.source == "A/KeepPicture"
        assert entry.info.startswith("the open gate, ")
        ((feed, image, info),) = here.person.shown
        assert (feed, info) == (FEED, {"request": "the open gate"})
        assert opened(entry.data).size == (image.width, image.height)
        assert here.person.told == ["I keep this picture as “the open gate”."]


async def test_picture_without_a_name_gets_one() -> None:
    async with room() as here:
        await keep_picture(here.context)
        assert [entry.name for entry in here.person.memories] == [UNNAMED]


async def test_broken_camera_is_a_hardware_failure_and_nothing_is_remembered() -> None:
    async with room({"robots": {"A": {"camera": "broken"}}}) as here:
        with pytest.raises(ActionFailure) as caught:
            await keep_picture(here.context, "gate")
        assert caught.value.code is FailureCode.HARDWARE
        assert here.person.memories == []
        assert here.person.told == []
