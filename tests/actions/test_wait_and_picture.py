"""Wait and TakePicture."""

from __future__ import annotations

import asyncio

import pytest

from parley.actions.inspect import FEED
from parley.actions.take_picture import take_picture
from parley.actions.wait import wait
from parley.errors import ActionFailure, FailureCode
from tests.actions.room import room


async def test_it_waits_robot_time_and_a_pause_does_not_count() -> None:
    async with room() as here:
        clock = here.simulator.clock
        began_s = clock.now_s()
        here.run.paused = True
        task = asyncio.create_task(_wait(here.context, 3.0))
        await clock.sleep(5.0)
        here.run.paused = False
        await task
        assert clock.now_s() - began_s == pytest.approx(8.0, abs=1.0)
        assert here.run.steps[-1] == (1.0, "0 s to go")


async def _wait(context: object, duration: float) -> None:
    await wait(context, duration)  # type: ignore[arg-type]


@pytest.mark.parametrize("duration", [0.0, -2.0, 1e9])
async def test_a_wait_that_is_none_or_has_no_end_is_refused(duration: float) -> None:
    async with room() as here:
        with pytest.raises(ActionFailure) as failure:
            await wait(here.context, duration)
        assert failure.value.code is FailureCode.NOT_CAPABLE


async def test_a_picture_is_shown_and_told_with_where_it_was_taken() -> None:
    async with room() as here:
        await take_picture(here.context, "crate")
        ((feed, image, info),) = here.person.shown
        assert (feed, info["request"]) == (FEED, "crate") and image.width > 0
        assert here.person.told == [f"Here is the picture, taken {here.context.whereabouts()}."]
