"""The graphs one actor holds: which may start, which may be commanded, which are forgotten (11).

A plain object without a transport. Every command is one synchronous step, so commands are carried out in the
order in which they come and none waits for another.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Final

from parley.clock import Clock
from parley.errors import GraphRefusedError, Problem
from parley.umrf.action import RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import STOP_TIMEOUT_S, GraphRun
from parley.umrf.model import Graph, GraphState
from parley.umrf.transition import Transition

__all__ = ["GraphRuns", "RunObserver"]

KEPT_ENDED: Final = 20
"""How many graphs that have ended are kept for queries."""

_BUSY: Final = frozenset({GraphState.RUNNING, GraphState.PAUSED, GraphState.STOPPING})
_ENDED: Final = frozenset({GraphState.FINISHED, GraphState.STOPPED, GraphState.ERROR})

RunObserver = Callable[[GraphRun, Transition], None]
"""Told every transition of every graph."""


class GraphRuns:
    """All runs of one actor, by graph name.

    Args:
        actor: Its name.
        catalogue: What it can do.
        clock: See `GraphRun`.
        make_context: See `GraphRun`.
        observer: Told every transition of the newest run of each name.
        stop_timeout_s: See `GraphRun`.
    """

    def __init__(
        self,
        actor: str,
        catalogue: Catalogue,
        *,
        clock: Clock,
        make_context: Callable[[RunHandle], Any],
        observer: RunObserver,
        stop_timeout_s: float = STOP_TIMEOUT_S,
    ) -> None:
        self._actor, self._catalogue, self._clock = actor, catalogue, clock
        self._make_context, self._observer = make_context, observer
        self._stop_timeout_s = stop_timeout_s
        self._runs: dict[str, GraphRun] = {}
        self._replaced: list[GraphRun] = []
        self.latched = False
        """Whether an emergency stop forbids everything that would run an action."""

    @property
    def all(self) -> tuple[GraphRun, ...]:
        """Every run that is held, ended ones included, oldest first."""
        return tuple(self._runs.values())

    def start(self, graph: Graph) -> GraphRun:
        """Run a graph.

        Raises:
            GraphRefusedError: It cannot run here, its name is taken by a graph that still runs (which is left
                alone), or an emergency stop is in force.
        """
        self._refuse_if_latched(graph.name)
        old = self._runs.get(graph.name)
        if old is not None and old.state in _BUSY:
            raise _refused(
                graph.name,
                "already_running",
                f"a graph {graph.name!r} is {old.state} already",
                "stop it first, modify it, or choose another name",
            )
        run = GraphRun(
            graph,
            self._catalogue,
            actor=self._actor,
            clock=self._clock,
            make_context=self._make_context,
            observer=lambda transition: self._observed(run, transition),
            stop_timeout_s=self._stop_timeout_s,
        )
        if old is not None:
            del self._runs[graph.name]
            old.stop()
            self._replaced = [item for item in [*self._replaced, old] if not item.idle]
        self._runs[graph.name] = run
        self._forget_ended()
        run.start()
        return run

    def modify(self, graph: Graph, continue_from: str = "") -> None:
        """See `GraphRun.modify`.

        Raises:
            GraphRefusedError: Also when the graph is unknown, or when an emergency stop is in force and the
                change would run something.
        """
        run = self._get(graph.name)
        if continue_from:
            self._refuse_if_latched(graph.name)
        run.modify(graph, continue_from)

    def end_node(self, name: str, node: str) -> None:
        """See `GraphRun.end_node`.

        Raises:
            GraphRefusedError: The graph or the node is unknown.
        """
        self._get(name).end_node(node)

    def pause(self, name: str) -> None:
        """See `GraphRun.pause`.

        Raises:
            GraphRefusedError: The graph is unknown.
        """
        self._get(name).pause()

    def resume(self, name: str) -> None:
        """See `GraphRun.resume`.

        Raises:
            GraphRefusedError: The graph is unknown or has ended, or an emergency stop is in force.
        """
        run = self._get(name)
        self._refuse_if_latched(name)
        run.resume()

    def stop(self, name: str) -> None:
        """See `GraphRun.stop`.

        Raises:
            GraphRefusedError: The graph is unknown.
        """
        self._get(name).stop()

    def pause_all(self) -> None:
        """Pause whatever goes on, runs that were replaced meanwhile included."""
        for run in (*self._runs.values(), *self._replaced):
            run.pause()

    async def close(self) -> None:
        """Stop everything and wait for it, each run at most its time-out."""
        await asyncio.gather(*(run.close() for run in (*self._runs.values(), *self._replaced)))

    def _observed(self, run: GraphRun, transition: Transition) -> None:
        if self._runs.get(run.name) is run:
            self._observer(run, transition)

    def _get(self, name: str) -> GraphRun:
        run = self._runs.get(name)
        if run is None:
            known = ", ".join(self._runs) or "none"
            raise _refused(name, "unknown_graph", f"there is no graph {name!r}", f"known are: {known}")
        return run

    def _refuse_if_latched(self, name: str) -> None:
        if self.latched:
            raise _refused(
                name,
                "stop_latched",
                f"{self._actor} was stopped by the emergency stop",
                "make sure that it is safe, reset the stop, then go on",
            )

    def _forget_ended(self) -> None:
        ended = [name for name, run in self._runs.items() if run.state in _ENDED and run.idle]
        for name in ended[:-KEPT_ENDED]:
            del self._runs[name]


def _refused(name: str, code: str, message: str, remedy: str) -> GraphRefusedError:
    return GraphRefusedError(name, [Problem("", message, remedy, code)])
