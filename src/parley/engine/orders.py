"""How far an engine is with each order: what it tells those whose steps wait for it. Pure.

An order is done when the last of its steps in the graph has come to its end by itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from typing import Final

from parley.engine.interrupted import order_of
from parley.latest import Latest
from parley.messages.status import OrderState
from parley.umrf.executor import GraphRun
from parley.umrf.model import ENDED, NodeState, Result
from parley.umrf.transition import Transition

__all__ = ["KEPT", "Orders"]

KEPT: Final = 30
"""So many of the newest orders are told of."""


class Orders:
    """The orders of one actor."""

    def __init__(self) -> None:
        self._stopped: Latest[tuple[str, str], bool] = Latest()
        """Steps that were stopped before their end: their state alone does not tell it."""

    def note(self, run: GraphRun, transition: Transition) -> bool:
        """Take a change of a graph; whether how far an order is may be different by it."""
        if transition.kind != "node" or transition.result is None:
            return False
        node = run.node(transition.node)
        if node is None or not order_of(node):
            return False
        key = (run.name, transition.node)
        self._stopped.pop(key, None)
        if transition.result is Result.ON_STOPPED:
            self._stopped[key] = True
        return True

    def states(self, runs: Iterable[GraphRun]) -> dict[str, OrderState]:
        """How far each order is, the newest last."""
        found: dict[str, OrderState] = {}
        for run in runs:
            failed: set[str] = set()
            for node, state in () if run.outer else run.nodes:
                if not (order := order_of(node)):
                    continue
                if state is NodeState.ERROR:
                    failed.add(order)
                found.pop(order, None)
                found[order] = self._state(run, node.full_name, state, order in failed)
        return dict(islice(found.items(), max(0, len(found) - KEPT), None))

    def _state(self, run: GraphRun, node: str, state: NodeState, failed: bool) -> OrderState:
        if state is NodeState.FINISHED:
            return "left" if (run.name, node) in self._stopped else "done"
        if run.state in ENDED:
            return "left"
        return "failed" if failed else "open"
