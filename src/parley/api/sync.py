"""`SyncParley`: the same without `await`, for notebooks and small scripts; a thread of its own works."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar

from parley.api.door import ANSWERS_WITHIN_S, NOBODY, Command, Parley
from parley.api.running import GraphRun
from parley.config import SystemConfig
from parley.errors import ParleyError
from parley.messages.chat import ActionCall, ChatFeedback
from parley.messages.memory import MemoryEntry
from parley.messages.principal import Principal
from parley.messages.status import PlanProposal, PlanRuling, PlanUpdate

if TYPE_CHECKING:
    from parley.api.listening import Event, Events
    from parley.language.base import Language
    from parley.robots.own import RobotBase
    from parley.site import Site
    from parley.umrf.action import Action, ActionSpec

__all__ = ["SyncParley"]

T = TypeVar("T")


class SyncParley:
    """`Parley` without `await`: every method waits. Use as ``with``, or `open` and `close` in a notebook.

    See `Parley` for the arguments. Any thread may call its methods.
    """

    def __init__(
        self,
        world: str | Path | Site | None = None,
        *,
        robots: Iterable[RobotBase | type[RobotBase]] = (),
        actions: Iterable[Action[..., Any] | ActionSpec | str | Path] = (),
        language: str | Language | None = None,
        config: SystemConfig | Mapping[str, Any] | str | Path | None = None,
        by: Principal = NOBODY,
    ) -> None:
        self._parley = Parley(world, robots=robots, actions=actions, language=language, config=config, by=by)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread: threading.Thread | None = None

    def open(self) -> Self:
        """Start. What cannot be started is told as by `Parley`."""
        if self._loop is not None:
            raise ParleyError("it is open already")
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="parley", daemon=True)
        self._thread.start()
        try:
            self._wait(self._parley.__aenter__())
        except BaseException:
            self._end()
            raise
        return self

    def close(self) -> None:
        """End. Idempotent."""
        if self._loop is not None:
            try:
                self._wait(self._parley.__aexit__(None, None, None))
            finally:
                self._end()

    def __enter__(self) -> Self:
        return self.open()

    def __exit__(self, *exc: object) -> None:
        self.close()

    # -- as in `Parley` ----------------------------------------------------------------------------------

    @property
    def robots(self) -> tuple[str, ...]:
        """See `Parley.robots`."""
        return self._parley.robots

    def plan(self, robot: str) -> PlanUpdate:
        """See `Parley.plan`."""
        return self._parley.plan(robot)

    def question(self, robot: str) -> ChatFeedback | None:
        """See `Parley.question`."""
        return self._parley.question(robot)

    def proposal(self, robot: str) -> PlanProposal | None:
        """See `Parley.proposal`."""
        return self._parley.proposal(robot)

    def settled(self, robot: str, *, timeout_s: float | None = None) -> PlanUpdate:
        """See `Parley.settled`."""
        return self._wait(self._parley.settled(robot, timeout_s=timeout_s))

    def say(
        self, robot: str, text: str, *, by: Principal | None = None, timeout_s: float = ANSWERS_WITHIN_S
    ) -> ChatFeedback:
        """See `Parley.say`."""
        return self._wait(self._parley.say(robot, text, by=by, timeout_s=timeout_s))

    def answer(self, robot: str, text: str, *, by: Principal | None = None) -> None:
        """See `Parley.answer`."""
        self._wait(self._parley.answer(robot, text, by=by))

    def order(self, robot: str, *steps: ActionCall, by: Principal | None = None) -> PlanRuling:
        """See `Parley.order`."""
        return self._wait(self._parley.order(robot, *steps, by=by))

    def control(self, robot: str, command: Command, *, by: Principal | None = None) -> PlanRuling:
        """See `Parley.control`."""
        return self._wait(self._parley.control(robot, command, by=by))

    def approve(self, proposal: PlanProposal, *, by: Principal | None = None) -> ChatFeedback:
        """See `Parley.approve`."""
        return self._wait(self._parley.approve(proposal, by=by))

    def reject(self, proposal: PlanProposal, *, by: Principal | None = None) -> ChatFeedback:
        """See `Parley.reject`."""
        return self._wait(self._parley.reject(proposal, by=by))

    def stop(self, *robots: str, by: Principal | None = None) -> None:
        """See `Parley.stop`: in this thread, whatever the other one does."""
        self._parley.stop(*robots, by=by)

    def reset(self, *robots: str, by: Principal | None = None) -> None:
        """See `Parley.reset`."""
        self._parley.reset(*robots, by=by)

    def remember(self, name: str, text: str, *, info: str = "", by: Principal | None = None) -> None:
        """See `Parley.remember`."""
        self._wait(self._parley.remember(name, text, info=info, by=by))

    def forget(self, name: str, *, by: Principal | None = None) -> None:
        """See `Parley.forget`."""
        self._wait(self._parley.forget(name, by=by))

    def memories(self, about: str = "", *, limit: int = 0) -> list[MemoryEntry]:
        """See `Parley.memories`."""
        return self._wait(self._parley.memories(about, limit=limit))

    def run(
        self,
        graph: str | Path | Mapping[str, Any],
        robot: str,
        *,
        by: Principal | None = None,
        timeout_s: float | None = None,
    ) -> str:
        """Start a UMRF graph (see `Parley.start`) and wait until it has ended; its state then."""

        async def run() -> str:
            started: GraphRun = await self._parley.start(graph, robot, by=by)
            return await started.wait(timeout_s=timeout_s)

        return self._wait(run())

    def events(self, robot: str = "", *, timeout_s: float | None = None) -> Iterator[Event]:
        """What happens from now on; ends when nothing did for `timeout_s` of wall time."""

        async def listen() -> Events:
            return self._parley.events(robot)

        return self._each(self._wait(listen()), timeout_s)

    def _each(self, events: Events, timeout_s: float | None) -> Iterator[Event]:
        async def following() -> Event | None:
            try:
                async with asyncio.timeout(timeout_s):
                    return await anext(events)
            except (TimeoutError, StopAsyncIteration):
                return None

        try:
            while (event := self._wait(following())) is not None:
                yield event
        finally:
            if self._loop is not None:
                self._loop.call_soon_threadsafe(events.close)

    def _wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Do something in the other thread; Ctrl-C ends it there as well."""
        if self._loop is None:
            work.close()
            raise ParleyError("this Parley is not open: use it inside `with`, or call open()")
        future = asyncio.run_coroutine_threadsafe(work, self._loop)
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def _end(self) -> None:
        loop, thread, self._loop, self._thread = self._loop, self._thread, None, None
        if loop is None or thread is None:
            return
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.run_until_complete(loop.shutdown_default_executor())
        loop.close()
