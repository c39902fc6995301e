"""What an engine has not brought to an end, told to whoever plans for its robot from now on.

That is what an earlier process of the engine left when it was killed, and what goes on now: whoever planned
it may have been killed too, and come back.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Final

import structlog

from parley.engine.engine import ActionEngine
from parley.engine.interrupted import Interrupted
from parley.errors import GraphRefusedError
from parley.messages import topics
from parley.messages.robot import GoesOn, UnfinishedRun, UnfinishedRuns
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.wire import encode
from parley.transport.base import Server, Transport
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import GraphState, NodeState

__all__ = ["Unfinished", "interrupted_of"]

log = structlog.get_logger(__name__)

_GOING: Final = (GraphState.RUNNING, GraphState.PAUSED)


class Unfinished:
    """Answers `/<actor>/parley_unfinished` for one engine, from before its first heartbeat.

    Args:
        actor: Whose engine.
        left: What its journal says an earlier process left, oldest first.
    """

    def __init__(self, actor: str, left: Sequence[Interrupted]) -> None:
        self._actor, self._left = actor, tuple(left)
        self._restored: set[str] = set()
        self._engine: ActionEngine | None = None
        self._ready = asyncio.Event()
        self._server: Server | None = None

    async def open(self, transport: Transport) -> None:
        """Answer from now on; who asks waits until `take_up`."""
        self._server = await transport.serve(topics.actor_unfinished(self._actor), self._answer)

    async def close(self) -> None:
        """Answer no longer."""
        self._ready.set()
        if self._server is not None:
            await self._server.close()

    def take_up(self, engine: ActionEngine) -> None:
        """Let the engine hold what only it can go on with; one step after the other is planned anew."""
        self._engine = engine
        for was in self._left:
            if self._is_anew(was):
                continue
            try:
                engine.restore(was)
            except GraphRefusedError as error:
                log.warning("cannot be gone on with", graph=was.graph.name, reason=str(error))
            else:
                self._restored.add(was.graph.name)
        self._ready.set()

    def _is_anew(self, was: Interrupted) -> bool:
        return was is self._left[-1] and was.is_sequence and bool(was.remaining)

    async def _answer(self, request: ChatRequest) -> ChatResponse:
        await self._ready.wait()
        runs = {run.name: run for run in self._engine.runs.all} if self._engine is not None else {}
        if runs.keys() - self._restored:
            self._left = ()  # whoever begins something new has done with what an earlier process left
        told = []
        for was in self._left:
            goes_on: GoesOn = "anew" if self._is_anew(was) else "no"
            run = runs.get(was.graph.name)
            if run is not None and run.state in (GraphState.PAUSED, GraphState.HALTED):
                goes_on = "engine"
                del runs[was.graph.name]
            elif run is not None:
                continue
            told.append(_told(was, goes_on, left=True))
        for run in runs.values():
            if _is_open(run):
                shared = run.peers is not None and bool(run.peers.actors)
                now = Interrupted(self._actor, run.snapshot(), 0, run.kept_outputs(), None, shared)
                told.append(_told(now, "engine", left=False))
        return ChatResponse(encode(UnfinishedRuns(runs=tuple(told))))


def _is_open(run: GraphRun) -> bool:
    """Whether it goes on, or waits for the repair of a step that failed; inside of another it is no own."""
    if run.outer:
        return False
    failed = any(node.state is NodeState.ERROR for node in run.snapshot().nodes)
    return run.state in _GOING or (run.state is GraphState.HALTED and failed)


def _told(was: Interrupted, goes_on: GoesOn, *, left: bool) -> UnfinishedRun:
    return UnfinishedRun(
        graph=write_graph(was.graph, faithful=True),
        outputs={node: dict(given) for node, given in was.outputs.items()},
        unix_ms=was.unix_ms,
        shared=was.shared,
        left=left,
        goes_on=goes_on,
    )


def interrupted_of(actor: str, run: UnfinishedRun) -> Interrupted:
    """What was told, as a planner takes it up.

    Raises:
        GraphRefusedError: Its graph cannot be read.
    """
    return Interrupted(actor, read_graph(run.graph), run.unix_ms, run.outputs, None, run.shared)
