"""Whoever could stop robots must be heard: else they stand, and a stop of meanwhile comes first."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from parley.clock import WallClock
from parley.engine.hearing import BACK_S, PAST_S, SILENT_S, TELL_S, Desks, Hearing
from parley.engine.stop_listener import StopListener
from parley.gate.stop_line import StopLine
from parley.messages import topics
from parley.messages.status import Pulse, StopCommand
from parley.messages.wire import to_string
from parley.transport.desk import PULSE_S, Desk
from parley.transport.local import LocalTransport
from tests.transport.backends import until


class Ada:
    """A drive on a line, and pages that can reach it."""

    def __init__(self, transport: LocalTransport) -> None:
        self.line, self.told, self.stands = StopLine(), list[str](), False
        self.line.attach(
            "Ada",
            halt=lambda: self.stand(True),
            resume=lambda: self.stand(False),
            told=lambda _: None,
        )
        self.transport, self._pulses = transport, transport.publisher(topics.PULSE)

    def stand(self, stands: bool) -> None:
        self.stands = stands

    async def pulses(self, server: str, for_s: float, *stops: StopCommand) -> None:
        """A page is heard for a while, and then no more."""
        for _ in range(int(for_s / PULSE_S) + 1):
            self._pulses.publish(to_string(Pulse(server=server, stops=stops)))
            await asyncio.sleep(PULSE_S)


@asynccontextmanager
async def hearing() -> AsyncIterator[Ada]:
    async with LocalTransport() as transport:
        ada = Ada(transport)
        listener = StopListener(ada.line, transport, lambda _: None, {"Ada": "Ada"})
        watch = Hearing(ada.line, ["Ada"], transport, WallClock(), ada.told.append)
        await listener.open()
        await watch.open()
        yield ada
        await watch.close()
        await listener.close()


async def test_who_never_heard_a_page_and_whose_pages_ended_in_order_goes_on() -> None:
    async with hearing() as ada:
        await asyncio.sleep(SILENT_S + 0.2)
        async with Desk(ada.transport, tuple):
            await asyncio.sleep(SILENT_S + 0.2)
        await asyncio.sleep(SILENT_S + 0.2)
        assert not ada.stands and not ada.told


async def test_one_page_is_enough_and_when_all_are_silent_it_stands_until_one_is_back() -> None:
    async with hearing() as ada:
        await ada.pulses("a", 0)
        await ada.pulses("b", SILENT_S + 0.3)
        assert not ada.stands
        await asyncio.sleep(SILENT_S + 0.1)
        assert ada.stands
        await asyncio.sleep(TELL_S - SILENT_S + 0.1)
        assert len(ada.told) == 1
        await ada.pulses("a", BACK_S - 0.3)
        assert ada.stands, "what was pressed meanwhile may still be on its way"
        await ada.pulses("a", 0.6)
        assert not ada.stands
        assert "That does not hold me any more" in ada.told[1]


async def test_a_stop_that_was_pressed_meanwhile_wins_and_comes_with_the_first_sign_of_the_page() -> None:
    stop = StopCommand(id="s", targets=("Ada",))
    async with hearing() as ada:
        await ada.pulses("a", 0)
        await until(lambda: ada.stands)
        await ada.pulses("a", 0, stop)
        assert ada.line.latched("Ada")
        await ada.pulses("a", BACK_S + 0.3, stop)
        assert ada.stands and ada.line.in_force("Ada") == "s" and not ada.line.held_by("Ada")


async def test_who_is_let_go_by_a_page_that_falls_silent_again_stands_again() -> None:
    async with hearing() as ada:
        await ada.pulses("a", 0)
        await until(lambda: ada.stands)
        await ada.pulses("a", 0)
        for hold in ada.line.held_by("Ada"):
            ada.line.go_on(hold)
        assert not ada.stands
        await until(lambda: ada.stands)


def test_a_page_that_is_silent_for_long_is_past_and_own_lateness_is_nobodys() -> None:
    desks = Desks()
    desks.heard(Pulse(server="a"), 0.0)
    assert desks.silent_s(5.0, late_s=4.5) == 0.5
    desks.heard(Pulse(server="b"), PAST_S + 5.0)
    assert desks.silent_s(PAST_S + 5.0) == 0.0
    desks.heard(Pulse(server="b", leaving=True), PAST_S + 6.0)
    assert desks.silent_s(PAST_S + 60.0) == 0.0
