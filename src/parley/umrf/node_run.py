"""One run of one node: what the action is given, and how it is paused and stopped."""

from __future__ import annotations

import asyncio
import inspect
import math
import threading
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Protocol, TypeVar

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import ActionSpec, Outcome, RunHandle, bind_inputs, outcome_of
from parley.umrf.flow import FlowNode
from parley.umrf.model import GraphState, Result
from parley.umrf.motion import Motion
from parley.umrf.remote import Peers
from parley.umrf.reports import harmless
from parley.umrf.text import clean_text
from parley.umrf.threads import in_thread
from parley.umrf.time_limit import PausableTime, within

__all__ = ["Ended", "Host", "Inside", "NodeRun"]

PROGRESS_INTERVAL_S: Final = 0.1
ROUND_S: Final = 0.01
"""Robot time between the beginnings of two rounds of a spontaneous node: one that returns at once must not
keep everything else from running."""
ABANDON_S: Final = 0.1
_FINAL: Final = frozenset(
    {
        FailureCode.ATTENTION,
        FailureCode.DECLINED,
        FailureCode.FORBIDDEN,
        FailureCode.NOT_CAPABLE,
        FailureCode.NOT_UNDERSTOOD,
    }
)
"""Failures that trying again does not change, or should not."""
THREAD_GRACE_S: Final = 2.0
"""Wall time that a plain action has to notice that its time is over, before its thread is abandoned."""
DEAF_S: Final = 5.0
"""Wall time that any other has to end after it was cancelled for that reason; then it has failed."""


_GOING: Final = asyncio.Event()
_GOING.set()
"""Of all runs that were never paused."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Ended:
    """How a run ended that did not fail."""

    result: Result
    outputs: Mapping[str, Any] = field(default_factory=dict)
    facts: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, outcome: Outcome) -> Ended:
        """The end of an action that returned."""
        return cls(Result.ON_TRUE if outcome.result else Result.ON_FALSE, outcome.outputs, outcome.facts)


class Inside(Protocol):
    """What a node needs to know of the graph that runs in its place; a `GraphRun`."""

    name: str
    state: GraphState
    on_state: Callable[[GraphState], None] | None

    @property
    def idle(self) -> bool:
        """See `GraphRun.idle`."""
        ...

    @property
    def over(self) -> bool:
        """See `GraphRun.over`."""
        ...

    @property
    def resumable(self) -> bool:
        """See `GraphRun.resumable`."""
        ...

    def exit_values(self) -> Mapping[str, Any]:
        """See `GraphRun.exit_values`."""
        ...

    def pause(self) -> None:
        """See `GraphRun.pause`."""
        ...

    def resume(self) -> None:
        """See `GraphRun.resume`."""
        ...

    def stop(self) -> None:
        """See `GraphRun.stop`."""
        ...

    async def wait(self) -> Result:
        """See `GraphRun.wait`."""
        ...

    async def close(self) -> None:
        """See `GraphRun.close`."""
        ...


class Host(Protocol):
    """What a run needs to know of the graph that it is part of; a `GraphRun`. All is called on the loop."""

    name: str
    actor: str
    clock: Clock
    """Robot time for actions; progress is spaced by wall time."""
    peers: Peers | None
    make_context: Callable[[RunHandle], Any]

    def asks(self, node: str) -> bool:
        """Whether what follows depends on whether that node ends true or false, as the graph is now."""
        ...

    def progressed(self, run: NodeRun, fraction: float | None, text: str) -> None:
        """Told how far a run is, at most every 100 ms."""
        ...

    def moved(self, node: str, state: GraphState) -> None:
        """Told when the run of that node has come to stand still, and when it goes on by itself."""
        ...

    def ended(self, run: NodeRun) -> None:
        """Told once a run is over, however it ended."""
        ...

    def overdue(self, run: NodeRun) -> None:
        """Told of a run whose time is over and that goes on although it was cancelled."""
        ...

    def begin_inner(self, run: NodeRun) -> Inside:
        """Run the graph behind a node, with its inputs."""
        ...


class NodeRun:
    """A run that goes on; what the action sees of it is `parley.umrf.action.RunHandle`.

    Args:
        item: The node; its inputs are read when the run begins.
        host: The graph it is part of.
        attempt: Which attempt of the node it is, from 1.
    """

    def __init__(self, item: FlowNode, host: Host, attempt: int = 1) -> None:
        self.attempt, self._host = attempt, host
        self.actor, self.graph_name, self.node, self.clock = host.actor, host.name, item.name, host.clock
        self.motion = Motion(item.name)
        self.inner: Inside | None = None
        """The graph that runs in its place, once it has begun."""
        self.restart_wanted = False
        self.last_log = ""
        self.item = item
        values = item.values.items()  # lists are its own: what it does to them must not reach the graph
        self._values = {name: value[:] if type(value) is list else value for name, value in values}
        self._loop = asyncio.get_running_loop()
        self._thread = threading.get_ident()
        self._going = _GOING
        self._paused = self._looked = self._stopping = self._threaded = self._over = False
        self._begun = self._in_thread = False
        self._progress: tuple[float | None, str] | None = None
        self._progress_timer: asyncio.TimerHandle | None = None
        self._stop_timer: asyncio.TimerHandle | None = None
        self._time: PausableTime | None = None
        self._task: asyncio.Task[Ended] | None = None

    def begin(self) -> None:
        """Start; the host is told of the end."""
        work = self._next_round() if self.item.spontaneous else self._call()
        self._task = self._loop.create_task(work, name=f"{self.graph_name}/{self.node}")
        self._task.add_done_callback(self._end)

    async def _next_round(self) -> Ended:
        early_s = self.item.began_s + ROUND_S - self.clock.now_s()
        if early_s > 0:
            await self.clock.sleep(early_s)
        self.item.began_s = self.clock.now_s()
        return await self._call()

    async def _call(self) -> Ended:
        item = self.item
        if item.spec.pausable or self.attempt > 1:
            await self.wait_while_paused()  # nothing begins during a pause
        self._begun = True
        run = item.runner()
        arguments = bind_inputs(item.spec, self._values)
        context = self._host.make_context(self)
        if inspect.iscoroutinefunction(run):
            work = run(context, **arguments)
        else:
            self._threaded = self._in_thread = True
            work = in_thread(f"action {self.node}", self._to_its_end, run, context, arguments)
        try:
            returned = await self._limited(work)
        except (SystemExit, KeyboardInterrupt) as error:  # would end the loop, and with it every robot
            raise harmless(error) from error
        return Ended.of(outcome_of(item.spec, returned))

    def _to_its_end(self, run: Callable[..., T], context: Any, arguments: Mapping[str, Any]) -> T:
        try:
            return run(context, **arguments)
        finally:
            self._in_thread = False

    def _limited(self, work: Awaitable[T]) -> Awaitable[T]:
        """`work`, within the time-out of the action or the node, if there is one."""
        spec = self.item.spec
        limits = [limit for limit in (spec.timeout_s, self.item.node.timeout_s) if limit is not None]
        if not limits:
            return work
        self._time = PausableTime(self.clock)
        return within(
            work,
            min(limits),
            name=spec.name,
            clock=self.clock,
            time=self._time,
            going=self.wait_while_paused,
            on_expiry=self._expired,
        )

    def _expired(self) -> float:
        self._stopping = True
        self.motion.revoke()
        if self._threaded:
            return THREAD_GRACE_S
        self._stop_timer = self._loop.call_later(DEAF_S, self._host.overdue, self)
        return 0.0

    def _end(self, _: asyncio.Task[Ended]) -> None:
        self._over = True
        self.motion.revoke()  # what it may have left behind must not drive
        for timer in (self._progress_timer, self._stop_timer):
            if timer is not None:
                timer.cancel()
        self._host.ended(self)
        self._task = None  # what it raised knows its frames, and they know this run: a circle

    def ending(self) -> Ended | BaseException:
        """How it ended or what was raised, once it is over."""
        if self.task.cancelled():
            return asyncio.CancelledError()
        return self.task.exception() or self.task.result()

    def may_repeat(self, ending: Ended | BaseException) -> bool:
        """Whether the node is to be tried again after this end.

        Not if a person or a rule said no, nor beside what has still not ended.
        """
        if isinstance(ending, Ended):
            failed = ending.result is Result.ON_ERROR
        else:
            failed = not (isinstance(ending, ActionFailure) and ending.code in _FINAL)
        return failed and not self._in_thread and self.attempt <= self.item.node.retries

    @property
    def spec(self) -> ActionSpec:
        """What runs."""
        return self.item.spec

    @property
    def values(self) -> Mapping[str, Any]:
        """Its inputs by flat name, as they were when it began."""
        return self._values

    @property
    def resumable(self) -> bool:
        """Whether a resume lets something inside go on, although the node runs."""
        return False

    @property
    def stands_still(self) -> bool:
        """Whether it honours a pause now, a plain action when it has looked; others are let finish."""
        if not self._begun:
            return self.item.spec.pausable or self.attempt > 1
        return self.item.spec.pausable and (self._looked or not self._threaded)

    def pause(self) -> None:
        """Ask the action to stand still; its drive does so in any case."""
        self._looked, self._paused = False, True
        self.motion.pause()
        if self._going.is_set():
            self._going = asyncio.Event()
        if self._time is not None:
            self._time.pause()

    def resume(self) -> None:
        """Let the action go on."""
        self._let_go()
        self.motion.resume()

    def _let_go(self) -> None:
        self._paused = False
        self._going.set()
        if self._time is not None:
            self._time.resume()

    def stop(self, timeout_s: float, timed_out: Callable[[], None]) -> None:
        """Ask the action to end; `timed_out` is called if it has not after `timeout_s` of wall time."""
        self._stopping = True
        self.motion.revoke()
        self._let_go()
        if self._task is not None and not self._threaded:
            self._task.cancel()
        self._stop_timer = self._loop.call_later(timeout_s, timed_out)

    @property
    def task(self) -> asyncio.Task[Ended]:
        """What runs it, from its beginning to its end."""
        assert self._task is not None
        return self._task

    async def abandon(self) -> bool:
        """Cancel whatever still waits, also for a thread; False if the action does not let that happen."""
        task = self.task
        task.cancel()
        await asyncio.wait([task], timeout=ABANDON_S)
        if not task.done():  # nor may it keep the process from ending, which waits for all tasks it knows
            asyncio.tasks._unregister_task(task)
        return task.done()

    def log(self, text: str) -> None:
        """See `RunHandle.log`."""
        self.last_log = clean_text(text)
        self.item.note(self.last_log, self.clock.unix_ms())

    def progress(self, fraction: float | None, text: str = "") -> None:
        """See `RunHandle.progress`; what comes too soon waits, and the newest of it is sent."""
        if threading.get_ident() != self._thread:
            self._loop.call_soon_threadsafe(self.progress, fraction, text)
            return
        if self._over:
            return
        self._progress = (_share(fraction), text)
        if self._progress_timer is None:
            self._send_progress()

    def _send_progress(self) -> None:
        self._progress_timer = None
        if self._progress is None:
            return
        (fraction, text), self._progress = self._progress, None
        self._progress_timer = self._loop.call_later(PROGRESS_INTERVAL_S, self._send_progress)
        self._host.progressed(self, fraction, text)

    @property
    def paused(self) -> bool:
        """See `RunHandle.paused`; a plain action that looks during a pause stands still from then on."""
        if self._paused and not self._looked and threading.get_ident() != self._thread:
            self._looked = True
            self._loop.call_soon_threadsafe(self._has_looked)
        return self._paused

    def _has_looked(self) -> None:
        if self._paused and self.stands_still and not self._over:
            self._host.moved(self.node, GraphState.PAUSED)

    async def wait_while_paused(self) -> None:
        """See `RunHandle.wait_while_paused`."""
        await self._going.wait()

    @property
    def stop_requested(self) -> bool:
        """See `RunHandle.stop_requested`."""
        return self._stopping

    @property
    def result_asked(self) -> bool:
        """See `RunHandle.result_asked`."""
        return self._host.asks(self.node)


def _share(told: Any) -> float | None:
    """What an action says of its progress, as a share from 0 to 1; None if it is no number."""
    try:
        share = float(told)
    except (TypeError, ValueError, OverflowError):
        return None
    return None if math.isnan(share) else min(max(share, 0.0), 1.0)
