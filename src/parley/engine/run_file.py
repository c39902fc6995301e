"""Graph files without a transport: what ``parley graph check`` and ``parley graph run`` stand on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from parley.clock import Clock
from parley.errors import GraphRefusedError, Problem
from parley.files import read_text
from parley.umrf.action import RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check, reasons
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import Graph, Result
from parley.umrf.transition import Observer

__all__ = ["check_file", "read_graph_file", "run_graph"]


def read_graph_file(path: Path) -> Graph:
    """Read a graph file.

    Raises:
        FileFormatError: It cannot be read as a file.
        GraphRefusedError: It is no graph; with every reason.
    """
    return read_graph(read_text(path))


def check_file(path: Path, catalogue: Catalogue, actor: str = "") -> list[Problem]:
    """Every reason why `actor` cannot run the graph in `path`; empty if it can.

    Raises:
        FileFormatError: It cannot be read as a file.
    """
    try:
        return check(read_graph_file(path), catalogue, actor=actor)
    except GraphRefusedError as error:
        return reasons(error, catalogue, actor=actor)


async def run_graph(
    graph: Graph,
    catalogue: Catalogue,
    *,
    actor: str,
    clock: Clock,
    make_context: Callable[[RunHandle], Any],
    observer: Observer | None = None,
) -> Result:
    """Run `graph` until it ends or halts, and clean up, also when cancelled; how it ended.

    Raises:
        GraphRefusedError: It cannot run here; with every reason.
    """
    run = GraphRun(graph, catalogue, actor=actor, clock=clock, make_context=make_context, observer=observer)
    run.start()
    try:
        return await run.wait()
    finally:
        await run.close()
