"""What a robot that comes, or whose engine was started anew, has not brought to an end; asked of its engine.

Until that is known orders to it wait: whoever plans for a robot first has to know what it does.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Final

from parley.agents.base import Node
from parley.engine.interrupted import Interrupted
from parley.engine.unfinished import interrupted_of
from parley.errors import GraphRefusedError, InvalidMessageError, TransportError
from parley.messages import topics
from parley.messages.robot import UnfinishedRun, UnfinishedRuns
from parley.messages.ros import ChatRequest
from parley.messages.status import ActorStatus
from parley.messages.wire import decode
from parley.transport.base import absolute
from parley.umrf.model import GraphState

__all__ = ["Taken", "Welcome"]

ANSWERS_WITHIN_S: Final = 5.0

Taken = Callable[[str, UnfinishedRun, Interrupted], str]
"""Gets a robot and one of its runs, as it was told and read; what is to be said of it."""


class Welcome:
    """Asks the engines of robots that come.

    Args:
        node: Whose transport.
        come: Gets each heartbeat; of a robot that `is_asked` at that moment `arrived` follows.
        take: Takes up one run.
        tell: Gets a robot, what it has to say by itself, and whether that asks for a yes.
        arrived: Gets a robot with its graphs and their states, once it has answered; None: it did not.
        met: Gets a robot whose engine has answered, and whether there was anything to say of it.
    """

    def __init__(
        self,
        node: Node,
        come: Callable[[ActorStatus], None],
        take: Taken,
        tell: Callable[[str, str, bool], None],
        arrived: Callable[[str, dict[str, str] | None], None],
        met: Callable[[str, bool], None],
    ) -> None:
        self._node, self._come, self._take, self._tell = node, come, take, tell
        self._arrived, self._met = arrived, met
        self._last: dict[str, int] = {}
        """Number of the last heartbeat of each robot that has answered."""
        self._asked: set[str] = set()
        self._answered = asyncio.Event()

    def is_asked(self, actor: str) -> bool:
        """Whether its answer is awaited."""
        return actor in self._asked

    async def settled(self, actor: str) -> None:
        """Wait while its answer is awaited."""
        while actor in self._asked:
            await self._answered.wait()

    async def met(self, actor: str) -> None:
        """Wait until a robot has come and answered."""
        while actor not in self._last:
            await self._answered.wait()

    def on_status(self, status: ActorStatus) -> None:
        """A heartbeat."""
        actor, last = status.actor, self._last.get(status.actor)
        if status.state == "leaving":
            self._last.pop(actor, None)
        elif last is not None and status.sequence >= last:
            self._last[actor] = status.sequence
        elif actor not in self._asked and self._is_served(actor):
            self._asked.add(actor)
            self._node.spawn(self._ask(status), name=f"welcome {actor}")
        self._come(status)

    def _is_served(self, actor: str) -> bool:
        name = absolute(topics.actor_unfinished(actor).name)
        return any(end.role == "server" and end.name == name for end in self._node.transport.endpoints())

    async def _ask(self, status: ActorStatus) -> None:
        actor, texts = status.actor, list[str]()
        graphs: dict[str, str] | None = None
        try:
            service = topics.actor_unfinished(actor)
            answer = await self._node.transport.call(service, ChatRequest(), timeout_s=ANSWERS_WITHIN_S)
            graphs, texts = self._taken(actor, decode(UnfinishedRuns, answer.response))
            self._last[actor] = status.sequence
        except (TransportError, InvalidMessageError) as error:
            self._node.log.warning("cannot say what is unfinished", robot=actor, error=str(error))
        self._asked.discard(actor)
        self._arrived(actor, graphs)
        for text in texts:
            self._tell(actor, text, False)
        if graphs is not None:
            self._met(actor, bool(texts))
        answered, self._answered = self._answered, asyncio.Event()
        answered.set()

    def _taken(self, actor: str, told: UnfinishedRuns) -> tuple[dict[str, str], list[str]]:
        graphs: dict[str, str] = {}
        texts: list[str] = []
        for run in told.runs:
            try:
                was = interrupted_of(actor, run)
            except GraphRefusedError as error:
                self._node.log.error("graph of an engine cannot be read", robot=actor, error=str(error))
                continue
            if run.goes_on == "engine":
                stands = run.left and was.graph.state is not GraphState.HALTED
                graphs[was.graph.name] = (GraphState.PAUSED if stands else was.graph.state).value
            texts.append(self._take(actor, run, was))
        return graphs, [text for text in texts if text]
