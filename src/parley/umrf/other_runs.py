"""Runs of nodes that no action of this actor carries out: sub-graphs (10.8) and other actors' nodes (13)."""

from __future__ import annotations

import asyncio
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport
from parley.umrf.action import RunHandle
from parley.umrf.flow import FlowNode
from parley.umrf.graph_index import GraphSpec
from parley.umrf.model import GraphState, Result
from parley.umrf.node_run import Ended, NodeRun
from parley.umrf.remote import Peers, RemoteSpec
from parley.umrf.saved import SavedRun

if TYPE_CHECKING:
    from parley.umrf.executor import GraphRun

__all__ = ["InnerRuns", "RemoteRun", "SubgraphRun", "run_of"]

_MARGIN_S: Final = 0.1
"""A sub-graph has so much longer to stop than its own nodes, so that it can say itself what did not."""


class InnerRuns:
    """The runs of the sub-graphs of one graph, also of those that ended and left a node behind.

    Args:
        make: Makes the run of a graph with its `parameters`.
    """

    def __init__(self, make: Callable[..., GraphRun]) -> None:
        self._make = make
        self._runs: dict[str, GraphRun] = {}
        self.saved: SavedRun | None = None
        """What an earlier process left of the graph whose sub-graphs these are."""

    def start(self, outer: str, item: FlowNode, values: Mapping[str, Any]) -> GraphRun:
        """Run the graph that stands behind `item` under the name of section 1."""
        assert isinstance(item.spec, GraphSpec)
        name = f"{outer}__{item.node.name}__{item.node.instance_id}"
        left = self._left(name)
        if left is None:
            run = self._make(replace(item.spec.graph, name=name), parameters=values)
        else:
            run = self._make(left.graph, parameters={})
        self._runs[item.name], run.outer = run, outer
        if left is None:
            run.start()
        else:
            run.restore(left)
            if run.holding:
                run.resume()
        return run

    def _left(self, name: str) -> SavedRun | None:
        """What is to be gone on with instead of begun; once, as the next run of the node is another one."""
        saved = self.saved
        found = saved.begun(name) if saved is not None else None
        if saved is not None and found is not None:
            self.saved = replace(saved, inner={key: item for key, item in saved.inner.items() if key != name})
        return found

    def pause(self) -> None:
        """Pause all."""
        for run in self._runs.values():
            run.pause()

    def resume(self) -> None:
        """Let go on what stands still."""
        for run in self._runs.values():
            if run.holding:
                run.resume()

    def stop(self) -> None:
        """Stop all."""
        for run in self._runs.values():
            run.stop()

    async def close(self) -> None:
        """Close all."""
        for run in self._runs.values():
            await run.close()


class SubgraphRun(NodeRun):
    """The node waits for an indexed graph that runs in its place.

    Args:
        start: Makes and starts that run with the node's inputs.
        on_state: Told when the inner graph stands still and when it goes on.
        **rest: See `NodeRun`.
    """

    def __init__(
        self,
        *,
        start: Callable[[Mapping[str, Any]], GraphRun],
        on_state: Callable[[GraphState], None],
        **rest: Any,
    ) -> None:
        super().__init__(**rest)
        self._start, self._on_state = start, on_state
        self._inner: GraphRun | None = None
        self._timed_out: Callable[[], None] | None = None

    async def _call(self, make_context: Callable[[RunHandle], Any]) -> Ended:
        await self.wait_while_paused()
        inner = self._inner = self._start(self._values)
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
        if self._inner is not None:
            self._inner.stop()
        return math.inf

    @property
    def inner_name(self) -> str:
        """See `NodeRun.inner_name`."""
        return self._inner.name if self._inner is not None else ""

    @property
    def stands_still(self) -> bool:
        """Whether nothing goes on inside."""
        return self._inner is None or self._inner.state is GraphState.PAUSED

    def pause(self) -> None:
        """See `NodeRun.pause`."""
        super().pause()
        if self._inner is not None:
            self._inner.pause()

    def resume(self) -> None:
        """See `NodeRun.resume`."""
        super().resume()
        if self._inner is not None and self._inner.holding:
            self._inner.resume()

    def stop(self, timeout_s: float, timed_out: Callable[[], None]) -> None:
        """See `NodeRun.stop`; the inner graph is stopped, and the node ends when that has ended."""
        self._stopping, self._timed_out = True, timed_out
        self._stop_timer = self._loop.call_later(timeout_s + _MARGIN_S, timed_out)
        if self._inner is None:
            self.task.cancel()
        else:
            self._inner.stop()

    async def abandon(self) -> bool:
        """See `NodeRun.abandon`."""
        if self._inner is not None:
            await self._inner.close()
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
    inner: InnerRuns,
    peers: Peers | None,
    *,
    on_state: Callable[[GraphState], None],
    graph_name: str,
    **rest: Any,
) -> NodeRun:
    """What carries out `item`: an action of this actor, a sub-graph, or another actor.

    Args:
        item: The node.
        inner: The runs of the sub-graphs of its graph.
        peers: The other actors, if there are any.
        on_state: See `SubgraphRun`.
        graph_name: See `NodeRun`.
        **rest: See `NodeRun`.
    """
    if isinstance(item.spec, GraphSpec):
        start = functools.partial(inner.start, graph_name, item)
        return SubgraphRun(start=start, on_state=on_state, item=item, graph_name=graph_name, **rest)
    if isinstance(item.spec, RemoteSpec) and peers is not None:
        return RemoteRun(peers=peers, item=item, graph_name=graph_name, **rest)
    return NodeRun(item, graph_name=graph_name, **rest)
