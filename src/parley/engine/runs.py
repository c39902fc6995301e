"""The graphs one actor holds: which may start, which may be commanded, which are forgotten (11).

A plain object without a transport. Every command is one synchronous step, so commands are carried out in the
order in which they come and none waits for another.
"""

from __future__ import annotations

import asyncio
import itertools
import weakref
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from parley.clock import Clock
from parley.errors import GraphRefusedError, Problem
from parley.sentences import Sentence, sentence
from parley.umrf.action import RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import STOP_TIMEOUT_S, GraphRun
from parley.umrf.model import BUSY, ENDED, NOTHING, Graph, GraphState, Result
from parley.umrf.remote import Peers
from parley.umrf.saved import SavedRun
from parley.umrf.transition import Transition

__all__ = ["GraphRuns", "RunObserver", "stop_latched"]

KEPT_ENDED: Final = 20
"""How many graphs that have ended are kept for queries."""

KEPT_NODES: Final = 5000
"""Fewer of them are kept if they have more nodes than this together: the garbage collector looks at each."""

KEPT_HALTED: Final = 100
"""How many graphs that have run dry are kept, to be gone on with; each order to a robot leaves one."""

RunObserver = Callable[[GraphRun, Transition], None]
"""Told every transition of every graph."""


class GraphRuns:
    """All runs of one actor, by graph name; commands for others raise `GraphRefusedError`.

    Args:
        actor: Its name.
        catalogue: What it can do.
        clock: See `GraphRun`, for the next one and `stop_timeout_s` too.
        make_context: Builds what an action gets as its first argument.
        observer: Told every transition of the newest run of each name.
        stop_timeout_s: Wall time a node may take to stop.
        latched: Whether an emergency stop forbids everything that would run an action.
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
        latched: Callable[[], bool] = lambda: False,
    ) -> None:
        self.catalogue = catalogue
        """Counts for what is started or modified from now on; may be replaced."""
        self._actor, self._clock = actor, clock
        self._make_context, self._observer = make_context, observer
        self._stop_timeout_s = stop_timeout_s
        self._runs: dict[str, GraphRun] = {}
        self._replaced: list[GraphRun] = []
        self._rested = False
        """Whether a graph came to rest since it was looked which of them are to be forgotten."""
        self._latched = latched

    @property
    def latched(self) -> bool:
        """Whether an emergency stop is in force."""
        return self._latched()

    @property
    def all(self) -> tuple[GraphRun, ...]:
        """Every run that is held, ended ones included, oldest first."""
        return tuple(self._runs.values())

    def get(self, name: str) -> GraphRun | None:
        """The run of that graph name, or None."""
        return self._runs.get(name)

    def indexed(self, name: str) -> Graph:
        """The indexed graph of that name.

        Raises:
            GraphRefusedError: There is none.
        """
        graph = self.catalogue.graph(name)
        if graph is None:
            known = ", ".join(item.name for item in self.catalogue.graphs) or "none"
            raise _refused(
                name,
                "unknown_graph",
                f"there is no indexed graph {name!r}",
                f"send the graph itself as umrf_graph_json; indexed are: {known}",
            )
        return graph

    def start(
        self,
        graph: Graph | str,
        parameters: Mapping[str, Any] = NOTHING,
        result: Result = Result.ON_TRUE,
    ) -> GraphRun:
        """Run a graph.

        Args:
            graph: A graph, or the name of an indexed one.
            parameters: Inputs of its entry, by flat name.
            result: How its entry is to have ended.

        Raises:
            GraphRefusedError: It cannot run here, its name is taken by a graph that still runs (which is left
                alone) or by an indexed one, an input is missing, or an emergency stop is in force.
        """
        run = self.prepare(graph, parameters)
        run.start(result)
        return run

    def prepare(
        self, graph: Graph | str, parameters: Mapping[str, Any] = NOTHING, peers: Peers | None = None
    ) -> GraphRun:
        """Take up a graph as `start` does, without beginning it."""
        if isinstance(graph, str):
            graph = self.indexed(graph)
        elif self.catalogue.graph(graph.name) is not None and graph.name not in self._runs:
            raise _refused(
                graph.name,
                "indexed_name",
                f"{graph.name!r} is the name of an indexed graph",
                "choose another name, or start the indexed graph by its name",
            )
        self._refuse_if_latched(graph.name)
        self.refuse_if_busy(graph.name)
        run = self._hold(graph, parameters, peers)
        self._forget_ended()
        return run

    def restore(self, saved: SavedRun) -> GraphRun:
        """Take up what a killed process left of a graph; it stands still until it is resumed or stopped.

        Raises:
            GraphRefusedError: It can no longer run here, something that is still needed could not be kept, or
                there is a graph of that name.
        """
        self.refuse_if_busy(saved.graph.name)
        run = self._hold(saved.graph, NOTHING, None)
        try:
            run.restore(saved)
        except GraphRefusedError:
            del self._runs[run.name]
            raise
        return run

    def refuse_if_busy(self, name: str) -> None:
        """A graph that still runs is left alone.

        Raises:
            GraphRefusedError: There is one of that name.
        """
        old = self._runs.get(name)
        if old is not None and old.state in BUSY:
            raise _refused(
                name,
                "already_running",
                f"a graph {name!r} is {old.state} already",
                "stop it first, modify it, or choose another name",
            )

    def begin(self, run: GraphRun, result: Result = Result.ON_TRUE) -> None:
        """Start a prepared run, unless it was stopped meanwhile.

        Raises:
            GraphRefusedError: An emergency stop is in force.
        """
        if run.state is GraphState.INITIALIZED:
            self._refuse_if_latched(run.name)
            run.start(result)

    def drop(self, run: GraphRun) -> None:
        """Forget a prepared run that does not begin."""
        if run.state is GraphState.INITIALIZED and self._runs.get(run.name) is run:
            del self._runs[run.name]

    def modify(self, graph: Graph, continue_from: str = "") -> None:
        """See `GraphRun.modify`; also refused if an emergency stop is in force and it would run something."""
        self._to_change(graph, continue_from).modify(graph, continue_from)

    def check_modify(self, graph: Graph, continue_from: str = "") -> None:
        """Refuse what `modify` would refuse now, without doing it."""
        self._to_change(graph, continue_from).check_modify(graph, continue_from)

    def _to_change(self, graph: Graph, continue_from: str) -> GraphRun:
        run = self._get(graph.name)
        if continue_from:
            self._refuse_if_latched(graph.name)
        return run

    def end_node(self, name: str, node: str) -> None:
        """See `GraphRun.end_node`."""
        self._get(name).end_node(node)

    def pause(self, name: str) -> None:
        """See `GraphRun.pause`."""
        self._get(name).pause()

    def resume(self, name: str) -> None:
        """See `GraphRun.resume`; also refused if an emergency stop is in force."""
        run = self._get(name)
        self._refuse_if_latched(name)
        run.resume()

    def stop(self, name: str) -> None:
        """See `GraphRun.stop`."""
        self._get(name).stop()

    def pause_all(self) -> None:
        """Pause whatever goes on, runs that were replaced meanwhile included."""
        for run in (*self._runs.values(), *self._replaced):
            run.pause()

    async def close(self) -> None:
        """Stop everything and wait for it, each run at most its time-out."""
        await asyncio.gather(*(run.close() for run in (*self._runs.values(), *self._replaced)))

    def clear(self) -> None:
        """Forget all runs, once they are closed and nobody asks for them any more."""
        self._runs.clear()
        self._replaced.clear()

    def _hold(self, graph: Graph, parameters: Mapping[str, Any], peers: Peers | None) -> GraphRun:
        """Make a run and hold it in place of an older one of its name.

        A run does not know itself by way of its observer: as a circle it would outlive its time until the
        garbage collector looks at everything.
        """

        def observe(transition: Transition) -> None:
            if (known := made()) is not None and self._runs.get(known.name) is known:
                self._rested = self._rested or known.state not in BUSY
                self._observer(known, transition)

        run = GraphRun(
            graph,
            self.catalogue,
            actor=self._actor,
            clock=self._clock,
            make_context=self._make_context,
            observer=observe,
            stop_timeout_s=self._stop_timeout_s,
            parameters=parameters,
            peers=peers,
            make_inner=lambda graph, parameters: self._hold_inner(graph, parameters, peers),
        )
        made = weakref.ref(run)
        old = self._runs.pop(graph.name, None)
        if old is not None:
            old.stop()
            self._replaced = [item for item in [*self._replaced, old] if not item.idle]
        self._runs[graph.name] = run
        return run

    def _hold_inner(self, graph: Graph, parameters: Mapping[str, Any], peers: Peers | None) -> GraphRun:
        """The run of a sub-graph; others see it as a graph of its own (10.8)."""
        old = self._runs.get(graph.name)
        if old is not None and not old.outer and old.state in BUSY:
            raise _refused(graph.name, "already_running", f"{graph.name!r} is {old.state}", "stop it first")
        return self._hold(graph, parameters, peers)

    def _get(self, name: str) -> GraphRun:
        run = self._runs.get(name)
        if run is None:
            known = ", ".join(self._runs) or "none"
            raise _refused(name, "unknown_graph", f"there is no graph {name!r}", f"known are: {known}")
        return run

    def _refuse_if_latched(self, name: str) -> None:
        if self.latched:
            raise stop_latched(name, self._actor)

    def _forget_ended(self) -> None:
        if not self._rested:
            return
        self._rested = False
        ended: list[GraphRun] = []
        halted: list[GraphRun] = []
        for run in self._runs.values():
            if (run.state in ENDED or run.state is GraphState.HALTED) and run.idle:
                ran_dry = run.state is GraphState.HALTED and not run.outer
                (halted if ran_dry else ended).append(run)
        for run in (*ended[: -_kept(ended)], *halted[:-KEPT_HALTED]):
            del self._runs[run.name]


def _kept(ended: Sequence[GraphRun]) -> int:
    """How many of the newest of `ended` are kept; at least one."""
    nodes = itertools.accumulate(run.size for run in reversed(ended[-KEPT_ENDED:]))
    return max(1, sum(count <= KEPT_NODES for count in nodes))


def stop_latched(name: str, actors: str) -> GraphRefusedError:
    """Why nothing of the graph of that name may run: an emergency stop is in force at those actors."""
    remedy = "make sure that it is safe, reset the stop, then go on"
    return _refused(name, "stop_latched", stopped_by_stop(actors), remedy)


def stopped_by_stop(actors: str) -> Sentence:
    """Why nothing is begun there."""
    return sentence("{robot} was stopped by the emergency stop", robot=actors)


def _refused(name: str, code: str, message: str, remedy: str) -> GraphRefusedError:
    return GraphRefusedError(name, [Problem("", message, remedy, code)])
