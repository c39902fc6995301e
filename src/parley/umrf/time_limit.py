"""The time-out of an action: robot time, pauses left out."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from typing import TypeVar

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode
from parley.messages.plain import in_words

__all__ = ["PausableTime", "within"]

T = TypeVar("T")


class PausableTime:
    """Robot time that stands still during a pause."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._began_s = clock.now_s()
        self._paused_at_s: float | None = None
        self._paused_s = 0.0

    def pause(self) -> None:
        """Stand still; idempotent."""
        if self._paused_at_s is None:
            self._paused_at_s = self._clock.now_s()

    def resume(self) -> None:
        """Go on; idempotent."""
        if self._paused_at_s is not None:
            self._paused_s += self._clock.now_s() - self._paused_at_s
            self._paused_at_s = None

    def passed_s(self) -> float:
        """Robot time since the beginning, without the pauses."""
        now_s = self._clock.now_s() if self._paused_at_s is None else self._paused_at_s
        return now_s - self._began_s - self._paused_s


async def within(
    work: Awaitable[T],
    limit_s: float,
    *,
    name: str,
    clock: Clock,
    time: PausableTime,
    going: Callable[[], Awaitable[object]],
    on_expiry: Callable[[], float],
) -> T:
    """Wait for `work`; after `limit_s` it is cancelled, waited for, and has failed however it ends.

    Args:
        work: What is limited.
        limit_s: Robot time it may take.
        name: Of the action, for the failure.
        clock: Whose time it is.
        time: How much of it has passed.
        going: Returns once no pause is in force.
        on_expiry: Called when the time is over; gives the wall time after which to cancel, for work that can
            only be asked to end; infinite if it surely ends.

    Raises:
        ActionFailure: `timed_out`.
    """
    expired = False
    async with asyncio.timeout(None) as scope:

        async def watch() -> None:
            nonlocal expired
            while (left_s := limit_s - time.passed_s()) > 0:
                await going()
                await clock.sleep(left_s)
            expired = True
            if (grace_s := on_expiry()) < math.inf:
                await asyncio.sleep(grace_s)
                scope.reschedule(0.0)

        watcher = asyncio.create_task(watch(), name=f"time-out of {name}")
        try:
            result = await work
        except BaseException as error:
            if expired:
                raise _failure(name, limit_s) from error
            raise
        finally:
            watcher.cancel()
    if expired:
        raise _failure(name, limit_s)
    return result


def _failure(name: str, limit_s: float) -> ActionFailure:
    return ActionFailure(
        FailureCode.TIMED_OUT, f"{in_words(name).capitalize()} took longer than {limit_s:g} s."
    )
