"""What the door opens: a graph that runs, the page; who may start one; and which robots an event is about."""

from __future__ import annotations

import asyncio
import importlib
import json
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from parley.errors import GraphRefusedError, Problem
from parley.extras import needs
from parley.gate.ruling import Policy, rule
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatFeedback
from parley.messages.incident import Incident
from parley.messages.memory import MemoryEvent
from parley.messages.principal import Principal
from parley.messages.ros import UmrfGraphPause, UmrfGraphStop
from parley.messages.status import ActorStatus, GraphEvent, PlanProposal, PlanUpdate, Rejection

if TYPE_CHECKING:  # loaded when it is opened
    from parley.api.listening import Event, Listener
    from parley.system import System
    from parley.web.server import WebServer

__all__ = ["GraphRun", "Page", "about", "graph_text", "served", "why_not"]

_ENDED: Final = ("FINISHED", "STOPPED", "ERROR")


class Page:
    """The page for operators, while it is served."""

    def __init__(self, server: WebServer) -> None:
        self._server = server

    @property
    def address(self) -> str:
        """Where it is on this computer."""
        return self._server.url

    @property
    def code(self) -> str:
        """What the next device signs in with; empty where nobody has to."""
        return self._server.pairing_code


@asynccontextmanager
async def served(system: System, *, port: int | None, lan: bool) -> AsyncIterator[Page]:
    """The page of a system that is open; see `Parley.page`."""
    await asyncio.to_thread(_load_web)  # takes a while, and robots stand while the loop is blocked
    from parley.web.config import WebConfig
    from parley.web.server import WebServer

    given = {"lan": lan} | ({} if port is None else {"port": port})
    async with WebServer(
        system.transport,
        WebConfig.of(system.config, **given),
        port_is_wish=port is None,
        stop_line=system.stop_line,
        at_rest=system.at_rest,
        language=system.language,
    ) as server:
        yield Page(server)


def _load_web() -> None:
    with needs("web"):
        importlib.import_module("parley.web.server")


def why_not(
    who: Principal, actions: Sequence[str], policy: Policy, plan: PlanUpdate, status: ActorStatus | None
) -> str:
    """Why somebody may not begin with these actions, in words; empty if they may.

    Args:
        who: Who wants it.
        actions: Their names.
        policy: What the robot needs a yes for.
        plan: What it does.
        status: What it can do.
    """
    from parley.gate.risk import always_asks

    infos = {info.name: info for info in status.catalogue} if status is not None else {}
    ruling = rule(
        who,
        policy,
        [ActionCall(name=action) for action in actions],
        (),
        needs_yes=plan.held_by is not None and plan.held_by.is_person and not who.is_person,
        risky=any(always_asks(infos.get(action)) for action in actions),
    )
    if ruling.begins == "now":
        return ""
    return "needs a person's yes" if ruling.begins == "ask" else "is not theirs to start"


class GraphRun:
    """A graph that was started: ``async for event in run`` gives each transition once, in order."""

    def __init__(self, listener: Listener, name: str, robot: str) -> None:
        self.name, self.robot = name, robot
        self.state = ""
        """The newest state of the graph, e.g. ``RUNNING`` or ``FINISHED``."""
        self._listener = listener
        self._events = listener.stream(self._concerns)
        self._kept: list[GraphEvent] = []

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> GraphEvent:
        if self._kept:
            return self._kept.pop(0)
        if self.state in _ENDED:
            self.close()
            raise StopAsyncIteration
        event = await anext(self._events)
        if isinstance(event, Rejection):
            problems = [Problem(item.path, item.message, item.remedy, item.code) for item in event.problems]
            raise GraphRefusedError(self.name, problems or [Problem("", "it was refused")])
        assert isinstance(event, GraphEvent)
        if event.kind == "graph":
            self.state = event.state
        return event

    async def begun(self) -> None:
        """Wait until it has begun.

        Raises:
            GraphRefusedError: It was refused.
        """
        self._kept.append(await anext(self))

    async def wait(self, *, timeout_s: float | None = None) -> str:
        """Wait until it has ended; its state then.

        Raises:
            TimeoutError: It has not within `timeout_s` of wall time.
        """
        async with asyncio.timeout(timeout_s):
            async for _ in self:
                pass
        return self.state

    def pause(self) -> None:
        """Hold it. Whoever may look may hold; going on is a person's to say (`Parley.control`)."""
        self._listener.send(topics.GRAPH_PAUSE, UmrfGraphPause(self.name, (self.robot,)))

    def stop(self) -> None:
        """End it."""
        self._listener.send(topics.GRAPH_STOP, UmrfGraphStop(self.name, (self.robot,)))

    def close(self) -> None:
        """Listen no more; the graph goes on. Idempotent."""
        self._events.close()

    def _concerns(self, event: Event) -> bool:
        if isinstance(event, GraphEvent):
            return event.graph_name == self.name and event.actor == self.robot
        return (
            isinstance(event, Rejection)
            and event.graph_name == self.name
            and event.what == topics.GRAPH_START.name
        )


def about(event: Event) -> tuple[str, ...]:
    """The robots an event is about; a memory of everybody's is about nobody in particular."""
    match event:
        case ChatFeedback():
            return event.targets
        case PlanUpdate() | PlanProposal() | Rejection():
            return (event.target,)
        case MemoryEvent():
            return (event.scope,)
        case Incident():
            return (event.robot,)
    return (event.actor,)


def graph_text(graph: str | Path | Mapping[str, Any]) -> str:
    """The JSON text of a graph that is given as text, as an object, or by its file."""
    if isinstance(graph, Mapping):
        return json.dumps(graph)
    if isinstance(graph, str) and graph.lstrip().startswith("{"):
        return graph
    from parley.files import read_text

    return read_text(Path(graph))
