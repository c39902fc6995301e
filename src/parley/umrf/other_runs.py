"""Runs of nodes that no action of this actor carries out: sub-graphs (10.8) and other actors' nodes (13)."""

from __future__ import annotations

import asyncio
import functools
import math
from collections.abc import Callable
from typing import Final

from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport
from parley.umrf.model import GraphState, Result
from parley.umrf.node_run import Ended, NodeRun

__all__ = ["RemoteRun", "SubgraphRun"]

_MARGIN_S: Final = 0.1
"""A sub-graph has so much longer to stop than its own nodes, so that it can say itself what did not."""


class SubgraphRun(NodeRun):
    """The node waits for an indexed graph that runs in its place."""

    _timed_out: Callable[[], None] | None = None

    async def _call(self) -> Ended:
        await self.wait_while_paused()
        inner = self.inner = self._host.begin_inner(self)
        inner.on_state = functools.partial(self._host.moved, self.node)
        try:
            result = await self._limited(inner.wait())
        finally:
            inner.on_state = None
        if inner.state is GraphState.ERROR and self._timed_out is not None:
            self._timed_out()
        # An inner graph that ran dry will not come to its exit: the outer one must hear of it.
        failed = result is Result.ON_HALTED
        return Ended(Result.ON_ERROR if failed else result, inner.exit_values())

    def _expired(self) -> float:
        """The time is over: the inner graph is stopped, which ends by itself."""
        if self.inner is not None:
            self.inner.stop()
        return math.inf

    @property
    def resumable(self) -> bool:
        """See `NodeRun.resumable`."""
        return self.inner is not None and self.inner.resumable

    @property
    def stands_still(self) -> bool:
        """Whether nothing goes on inside."""
        return self.inner is None or self.inner.state is GraphState.PAUSED

    def pause(self) -> None:
        """See `NodeRun.pause`."""
        super().pause()
        if self.inner is not None:
            self.inner.pause()

    def resume(self) -> None:
        """See `NodeRun.resume`."""
        super().resume()
        if self.inner is not None and self.resumable:
            self.inner.resume()

    def stop(self, timeout_s: float, timed_out: Callable[[], None]) -> None:
        """See `NodeRun.stop`; the inner graph is stopped, and the node ends when that has ended."""
        self._stopping, self._timed_out = True, timed_out
        self._stop_timer = self._loop.call_later(timeout_s + _MARGIN_S, timed_out)
        if self.inner is None:
            self.task.cancel()
        else:
            self.inner.stop()

    async def abandon(self) -> bool:
        """See `NodeRun.abandon`."""
        if self.inner is not None:
            await self.inner.close()
        return await super().abandon()


class RemoteRun(NodeRun):
    """The node waits until the engine of its actor says how it ended."""

    async def _call(self) -> Ended:
        peers = self._host.peers
        assert peers is not None
        end = await peers.end_of(self.graph_name, self.item.node)
        if end.result is Result.ON_ERROR:
            report = FailureReport.parse(end.message)
            code = report.code if end.message else FailureCode.INTERNAL
            raise ActionFailure(
                code, report.message or f"{self.item.node.actor} failed at {self.node}.", report.details
            )
        return Ended(end.result, {name: item.value for name, item in end.outputs.items() if item.has_data})

    def stop(self, timeout_s: float, timed_out: Callable[[], None]) -> None:
        """See `NodeRun.stop`; the other engine got the same command, and its node's end ends this one."""
        self._stopping = True
        self._stop_timer = self._loop.call_later(timeout_s, timed_out)
        self.resume()

    def may_repeat(self, ending: Ended | BaseException) -> bool:
        """See `NodeRun.may_repeat`; that is for the engine of its actor to do."""
        return False

    async def abandon(self) -> bool:
        """See `NodeRun.abandon`; nothing is lost by not waiting for others."""
        task = self.task
        task.cancel()
        await asyncio.wait([task])
        return True
