"""What is ordered while a robot is stopped for safety is kept, and done after the stop is released."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import pytest

from parley.messages import topics
from parley.messages.principal import person
from parley.messages.status import StopCommand
from tests.agents.crew import Crew, crew, look


async def pressed(party: Crew, command: str) -> None:
    """The stop button, or its release, and that the engine did it."""
    wanted = "received" if command == "stop" else "reset"
    before = len(party.observer.stop_reports)
    party.observer.publish(topics.STOP, StopCommand.model_validate({"command": command, "by": person("Kim")}))
    await party.until(lambda: wanted in [r.state for r in party.observer.stop_reports[before:]])


async def kept_then_done(party: Crew, *did: str, orders: int = 1) -> None:
    """Nothing moves and nothing counts as failed until the stop is released and somebody says to go on.

    Each of the `orders` is answered with the reason for which nothing is done.
    """
    await party.state("paused")
    await party.hears("I was stopped for safety")
    done = list(party.body.did)
    await party.settled()
    assert party.body.did == done
    assert sum("stopped for safety" in text for text in party.texts()) == orders
    assert not any("changed nothing" in text for text in party.texts())
    await pressed(party, "reset")
    await party.settled()
    assert party.body.did == done, "only a person says to go on"
    party.command("start")
    await party.state("idle")
    assert party.body.did == [*did]
    assert "failed" not in party.steps() and "stopped" not in party.steps()


@pytest.fixture
async def party() -> AsyncIterator[Crew]:
    async with crew("A") as party:
        yield party
        assert party.wire.of(topics.ERROR_HANDLING) == [] or party.body.failures


async def test_first_order_is_kept(party: Crew) -> None:
    await pressed(party, "stop")
    party.order(look("box"), look("lid"))
    await kept_then_done(party, "look box", "look lid")


async def test_order_behind_what_was_done_before_is_kept(party: Crew) -> None:
    party.order(look("box"))
    await party.state("idle")
    await pressed(party, "stop")
    party.order(look("lid"))
    await kept_then_done(party, "look box", "look lid")


async def test_order_to_a_graph_that_ran_dry_is_kept(party: Crew) -> None:
    party.body.failures["look box"] = 1
    party.order(look("box"), look("lid"))
    await party.state("held")
    await pressed(party, "stop")
    party.correct(look("cup"))
    await kept_then_done(party, "look box", "look cup", "look lid")


async def test_second_order_is_kept_as_well(party: Crew) -> None:
    await pressed(party, "stop")
    party.order(look("box"))
    await party.state("paused")
    await party.until(lambda: any(s["state"] == "stopped" for s in party.wire.objects(topics.ACTOR_STATUS)))
    party.order(look("lid"))
    await party.until(lambda: len(party.steps()) == 2)
    await kept_then_done(party, "look box", "look lid", orders=2)


async def test_order_after_the_release_goes_on_without_more_ado(party: Crew) -> None:
    await pressed(party, "stop")
    party.order(look("box"))
    await party.state("paused")
    await pressed(party, "reset")
    party.command("start")
    await party.state("idle")
    party.order(look("lid"))
    async with asyncio.timeout(5):
        await party.until(lambda: party.body.did == ["look box", "look lid"])


async def test_order_that_is_dropped_before_the_release_is_not_done(party: Crew) -> None:
    await pressed(party, "stop")
    party.order(look("box"))
    await party.state("paused")
    party.command("clear")
    await party.state("idle")
    await pressed(party, "reset")
    await party.settled()
    assert party.body.did == []
