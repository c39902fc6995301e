"""Tells robots again and again that whoever is at this page or terminal could stop them."""

from __future__ import annotations

import asyncio
import contextlib
import uuid
from collections.abc import Callable, Sequence
from typing import Final, Self

from parley.messages import topics
from parley.messages.status import Pulse, StopCommand
from parley.messages.wire import to_string
from parley.transport.base import Transport

__all__ = ["PULSE_S", "Desk"]

PULSE_S: Final = 0.15


class Desk:
    """Use as ``async with``, on the loop that publishes stops: where that hangs, no stop gets out either.

    Args:
        transport: Where robots are.
        untaken: Gives the emergency stops that robots have not confirmed.
    """

    def __init__(self, transport: Transport, untaken: Callable[[], Sequence[StopCommand]]) -> None:
        self._transport, self._untaken, self._server = transport, untaken, uuid.uuid4().hex

    async def __aenter__(self) -> Self:
        self._publisher = self._transport.publisher(topics.PULSE)
        self._telling = asyncio.create_task(self._tell(), name="pulse")
        return self

    async def __aexit__(self, *exc: object) -> None:
        self._telling.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self._telling
        self._publisher.publish(to_string(Pulse(server=self._server, leaving=True)))
        self._publisher.close()

    async def _tell(self) -> None:
        while True:
            self._publisher.publish(to_string(Pulse(server=self._server, stops=tuple(self._untaken()))))
            await asyncio.sleep(PULSE_S)
