"""A run of a graph with everything it told, for tests."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from parley.clock import WallClock
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import NodeState
from parley.umrf.transition import Transition

from .spec_actions import CATALOGUE


async def until(condition: Callable[[], Any]) -> None:
    """Wait, at most 5 s, until `condition` holds."""
    async with asyncio.timeout(5):
        while not condition():  # noqa: ASYNC110 - runs tell their observers, not those who wait
            await asyncio.sleep(0.001)


class Watched:
    """A run and everything it told."""

    def __init__(self, source: str | dict[str, Any], **options: Any) -> None:
        self.told: list[Transition] = []
        self.run = GraphRun(
            read_graph(source),
            options.pop("catalogue", CATALOGUE),
            actor="A",
            clock=WallClock(),
            make_context=lambda handle: handle,
            observer=self.told.append,
            **options,
        )

    def states(self, full_name: str = "") -> list[str]:
        """The states of one node, or of the graph, in order; a bypass is no change of state."""
        kind = "node" if full_name else "graph"
        return [
            item.state
            for item in self.told
            if item.kind == kind and item.node == full_name and item.cause != "bypass"
        ]

    def state(self, full_name: str) -> NodeState:
        found = self.run.snapshot().node(full_name)
        assert found is not None
        return found.state

    def log(self, full_name: str) -> list[str]:
        found = self.run.snapshot().node(full_name)
        assert found is not None
        return [item.message for item in found.messages]

    def runs(self) -> list[str]:
        """Full names in the order in which they began."""
        started = ("start", "edge", "continue", "restart")
        return [
            item.node for item in self.told if item.state == "RUNNING" and item.cause in started and item.node
        ]

    def bypassed(self) -> list[str]:
        return [item.node for item in self.told if item.cause == "bypass"]
