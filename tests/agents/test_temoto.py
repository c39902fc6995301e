"""An engine of TeMoto beside ours: what it does not say is found out by asking it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest

from parley.agents import temoto
from parley.agents.temoto import TemotoActors
from parley.clock import WallClock
from parley.messages import ros, topics
from parley.messages.status import ActorStatus, StopCommand
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from parley.umrf.executor import GraphRun
from parley.umrf.io import write_descriptor, write_graph
from parley.umrf.transition import Transition
from tests.agents.crew import Body, Crew, ThesisEngine, actions_of, crew, drive, look


class TemotoEngine(ThesisEngine):
    """The one of the thesis, which can be asked too."""

    def __init__(self, transport: LocalTransport, actor: str, body: Body) -> None:
        super().__init__(transport, actor, body)
        self._catalogue = actions_of(body)
        self.refuses = self.keeps = self.is_silent = False
        """Whether it takes no command; has it what it refused; is all its feedback lost."""
        self.answers = asyncio.Event()
        self.answers.set()
        self._kept: list[str] = []

    async def open(self) -> None:
        await super().open()
        served = await self.transport.serve(topics.GRAPH_GET, self._tell)
        self.opened.push_async_callback(served.close)

    async def _tell(self, _: ros.UmrfGraphGetRequest) -> ros.UmrfGraphGetResponse:
        await self.answers.wait()
        actions = tuple(write_descriptor(spec) for spec in self._catalogue)
        held = tuple(write_graph(run.snapshot()) for run in self._runs.all)
        return ros.UmrfGraphGetResponse(actions, (), (*held, *self._kept))

    def _ours(self, message: Any, command: Callable[[], object]) -> None:
        if not self.refuses:
            super()._ours(message, command)
        elif self.keeps and isinstance(message, ros.UmrfGraphStart):
            self._kept.append(message.umrf_graph_json)

    def _observed(self, run: GraphRun, transition: Transition) -> None:
        if not self.is_silent:
            super()._observed(run, transition)


@asynccontextmanager
async def with_temoto() -> AsyncIterator[tuple[Crew, TemotoEngine, Body]]:
    """A crew with an engine of TeMoto for Z, which is known."""
    body = Body()
    async with crew() as party:
        temoto = TemotoEngine(party.transport, "Z", body)
        guests = TemotoActors(party.transport, WallClock(), {"Z": "umrf_graph_get"}, ask_s=0.05, takes_s=0.1)
        party.bodies["Z"] = body
        async with guests, temoto:
            await party.until(lambda: "Z" in party.observer.robots)
            yield party, temoto, body


async def test_what_an_engine_of_temoto_can_do_is_known_while_it_is_there() -> None:
    told: list[ActorStatus] = []
    async with crew() as party:
        hears = lambda message: told.append(decode(ActorStatus, message.data))  # noqa: E731
        await party.transport.subscribe(topics.ACTOR_STATUS, hears)
        async with TemotoActors(party.transport, WallClock(), {"Z": "umrf_graph_get"}, ask_s=0.05):
            async with TemotoEngine(party.transport, "Z", Body()):
                await party.until(lambda: told)
                assert (told[0].actor, told[0].engine, told[0].state) == ("Z", "temoto", "idle")
                assert [info.name for info in told[0].catalogue] == [spec.name for spec in actions_of(Body())]
                assert told[0].catalogue[1].inputs == {"x": "number"}
            await party.until(lambda: told[-1].state == "leaving")
        assert [status.sequence for status in told] == sorted({status.sequence for status in told})


async def test_one_that_hangs_is_told_of_soon_but_not_while_it_does_what_it_was_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(temoto, "SILENT_S", 0.3)
    monkeypatch.setattr(temoto, "ENDS_S", 1.0)
    told: list[ActorStatus] = []
    async with with_temoto() as (party, engine, _):
        hears = lambda message: told.append(decode(ActorStatus, message.data))  # noqa: E731
        await party.transport.subscribe(topics.ACTOR_STATUS, hears)

        def trouble() -> str:
            return next((status.trouble for status in reversed(told) if status.actor == "Z"), "")

        await party.until(lambda: told)
        engine.answers.clear()
        await party.until(lambda: trouble() == "silent", within_s=1.0)
        engine.answers.set()
        await party.until(lambda: trouble() == "")

        await party.settled()
        engine.refuses = True  # it has no such graph
        engine.answers.clear()
        party.transport.publisher(topics.GRAPH_STOP).publish(ros.UmrfGraphStop("none", ("Z",)))
        await asyncio.sleep(0.6)
        assert trouble() == ""
        await party.until(lambda: trouble() == "silent", within_s=2.0)


@pytest.mark.parametrize("keeps", [False, True])
async def test_a_start_that_it_refuses_in_silence_is_told_to_the_operator(keeps: bool) -> None:
    async with with_temoto() as (party, temoto, body):
        temoto.refuses, temoto.keeps = True, keeps
        party.order(look("box"), target="Z")
        await party.hears("Z has not begun, and does not say why.")
        await party.until(lambda: party.steps("Z") == ["stopped"])
        assert body.did == []
        temoto.refuses = False
        party.order(look("lid"), target="Z")
        await party.until(lambda: body.did == ["look lid"])


async def test_a_plan_goes_on_although_all_feedback_of_its_engine_is_lost() -> None:
    async with with_temoto() as (party, temoto, body):
        temoto.is_silent = True
        party.order(drive(1), look("box"), target="Z")
        await party.until(lambda: party.steps("Z") == ["finished"] * 2)
        assert body.did == ["drive 1", "look box"]
        assert not any("not" in text for text in party.texts())


async def test_it_is_paused_by_its_own_spelling_and_goes_on() -> None:
    async with with_temoto() as (party, _, body):
        body.far.add(1)
        party.order(drive(1), target="Z")
        await party.until(lambda: body.way > 0)
        party.command("stop", "Z")
        await party.state("paused", "Z")
        assert len(party.wire.of(topics.GRAPH_PAUSE_TEMOTO)) == 1
        assert await body.stands_still()
        body.far.clear()
        party.command("start", "Z")
        await party.until(lambda: party.steps("Z") == ["finished"])


async def test_an_emergency_stop_ends_what_it_carries_out_and_nothing_begins_again_by_itself() -> None:
    async with with_temoto() as (party, _, body):
        body.far.add(1)
        party.order(drive(1), look("box"), target="Z")
        await party.until(lambda: body.way > 0)
        party.observer.publish(topics.STOP, StopCommand(targets=("Z",), id="1"))
        await party.until(lambda: party.wire.of(topics.GRAPH_STOP))
        assert await body.stands_still()
        await party.settled()
        assert body.did == ["drive 1"]
        await party.hears("The plan was stopped. Not done: go there")
        assert party.steps("Z") == ["stopped"] * 2
        assert "start" not in party.wire.commands()[1:]
