"""Trees and graphs that are carried out with results written down before, so that both can be compared."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Mapping
from dataclasses import dataclass, field

from parley.clock import WallClock
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import GraphRun
from parley.umrf.model import Graph, Result
from parley_bt.shape import (
    Fallback,
    ForceSuccess,
    Inverter,
    Leaf,
    Parallel,
    Retry,
    Sequence,
    Shape,
)

MAX_RUNS = 40
"""Loops may go on for ever; so many runs are compared."""

Script = Mapping[str, str]
"""Full name -> how its runs end: one of T, F, E per run, again from the beginning when it is used up."""


class TooLongError(Exception):
    """Enough was seen."""


@dataclass
class Trace:
    """What happened."""

    runs: list[str] = field(default_factory=list)
    success: bool | None = None
    """Of the tree; None if it was cut off."""
    result: Result | None = None
    """Of the graph; None if it was cut off."""
    halted_others: bool = False
    """A parallel failed, and so others may have been running."""


def ending(script: Script, name: str, runs: list[str]) -> str:
    """How the run that was just added to `runs` ends."""
    if len(runs) > MAX_RUNS:
        raise TooLongError
    endings = script.get(name) or "T"
    return endings[(runs.count(name) - 1) % len(endings)]


def tick(shape: Shape, script: Script) -> Trace:
    """Carry out a tree by the rules that BehaviorTree.CPP documents for its nodes."""
    trace = Trace()
    with contextlib.suppress(TooLongError):
        trace.success = _tick(shape, script, trace)
    return trace


def _tick(shape: Shape, script: Script, trace: Trace) -> bool:
    match shape:
        case Leaf():
            trace.runs.append(shape.node.full_name)
            end = ending(script, shape.node.full_name, trace.runs)
            return end == "T" or (end == "F" and shape.false_succeeds)
        case Sequence():
            return all(_tick(child, script, trace) for child in shape.children)
        case Fallback():
            return any(_tick(child, script, trace) for child in shape.children)
        case Parallel():
            done = [_tick(child, script, trace) for child in shape.children]
            trace.halted_others |= not all(done) and not shape.all_end
            return all(done)
        case Retry():
            while not _tick(shape.child, script, trace):
                pass
            return True
        case Inverter():
            return not _tick(shape.child, script, trace)
        case ForceSuccess():
            _tick(shape.child, script, trace)
            return True


async def run(graph: Graph, script: Script) -> Trace:
    """Carry out a graph by the engine's executor."""
    trace = Trace()
    enough = asyncio.Event()

    async def step(ctx: RunHandle) -> bool:
        trace.runs.append(ctx.node)
        try:
            end = ending(script, ctx.node, trace.runs)
        except TooLongError:
            enough.set()
            await asyncio.Event().wait()
        if end == "E":
            raise RuntimeError("as written")
        return end == "T"

    names = {node.name for node in graph.nodes}
    catalogue = Catalogue([ActionSpec(name, {}, {}, run=step) for name in sorted(names)])
    going = GraphRun(graph, catalogue, actor="A", clock=WallClock(), make_context=lambda handle: handle)
    going.start()
    waits = [asyncio.ensure_future(going.wait()), asyncio.ensure_future(enough.wait())]
    await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
    trace.result = None if enough.is_set() else going.result
    for task in waits:
        task.cancel()
    await going.close()
    return trace


def has_parallel(shape: Shape) -> bool:
    """Whether something happens at once in a tree."""
    match shape:
        case Leaf():
            return False
        case Sequence() | Fallback():
            return any(has_parallel(child) for child in shape.children)
        case Parallel():
            return True
        case _:
            return has_parallel(shape.child)
