"""Runs of nodes that no action of this actor carries out: sub-graphs (10.8) and other actors' nodes (13)."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Mapping
from typing import Any, Final

from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport
from parley.umrf.action import RunHandle
from parley.umrf.flow import FlowNode
from parley.umrf.graph_index import GraphSpec
from parley.umrf.model import GraphState, Result
from parley.umrf.node_run import Ended, Inside, NodeRun
from parley.umrf.remote import Peers, RemoteSpec

__all__ = ["RemoteRun", "SubgraphRun", "run_of"]

_MARGIN_S: Final = 0.1
"""A sub-graph has so much longer to stop than its own nodes, so that it can say itself what did not."""


class SubgraphRun(NodeRun):
    """The node waits for an indexed graph that runs in its place.

    Args:
        begin: Makes and starts that run with the node's inputs.
        on_state: Told when the inner graph stands still and when it goes on.
        **rest: See `NodeRun`.
    """

    def __init__(
        self,
        *,
        begin: Callable[[FlowNode, Mapping[str, Any]], Inside],
        on_state: Callable[[GraphState], None],
        **rest: Any,
    ) -> None:
        super().__init__(**rest)
        self._begin, self._on_state = begin, on_state
        self._timed_out: Callable[[], None] | None = None

    async def _call(self, make_context: Callable[[RunHandle], Any]) -> Ended:
        await self.wait_while_paused()
        inner = self.inner = self._begin(self.item, self._values)
        inner.on_state = self._on_state
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
    """The node waits until the engine of its actor says how it ended.

    Args:
        peers: Who says so.
        **rest: See `NodeRun`.
    """

    def __init__(self, *, peers: Peers, **rest: Any) -> None:
        super().__init__(**rest)
        self._peers = peers

    async def _call(self, make_context: Callable[[RunHandle], Any]) -> Ended:
        end = await self._peers.end_of(self.graph_name, self.item.node)
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


def run_of(
    item: FlowNode,
    peers: Peers | None,
    *,
    begin: Callable[[FlowNode, Mapping[str, Any]], Inside],
    on_state: Callable[[GraphState], None],
    **rest: Any,
) -> NodeRun:
    """What carries out `item`: an action of this actor, a sub-graph, or another actor.

    Args:
        item: The node.
        peers: The other actors, if there are any.
        begin: See `SubgraphRun`.
        on_state: See `SubgraphRun`.
        **rest: See `NodeRun`.
    """
    if isinstance(item.spec, GraphSpec):
        return SubgraphRun(begin=begin, on_state=on_state, item=item, **rest)
    if isinstance(item.spec, RemoteSpec) and peers is not None:
        return RemoteRun(peers=peers, item=item, **rest)
    return NodeRun(item, **rest)
