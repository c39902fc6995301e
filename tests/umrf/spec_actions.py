"""The actions that the example graphs of the UMRF contract assume (section 15), and a few more for tests."""

from __future__ import annotations

import asyncio
import itertools
import sys
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import Outcome, RunHandle, action
from parley.umrf.catalogue import Catalogue


@dataclass(frozen=True)
class Text:
    text: str


@dataclass(frozen=True)
class Waited:
    waited: float


@action
async def join_text(ctx: RunHandle, left: str, right: str) -> Text:
    """Join two texts."""
    return Text(f"{left}-{right}")


@action
async def same_text(ctx: RunHandle, text: str, expected: str) -> bool:
    """Compare two texts."""
    return text == expected


@action
async def find_nothing(ctx: RunHandle) -> Text | bool:
    """Return false, and so no text."""
    return False


@action
async def wait_for(ctx: RunHandle, seconds: float) -> Waited:
    """Wait."""
    await ctx.clock.sleep(seconds)
    return Waited(seconds)


class CountTo:
    """Count its own runs."""

    def __init__(self) -> None:
        self.runs = 0

    async def run(self, ctx: RunHandle, limit: float) -> bool:
        self.runs += 1
        return self.runs >= limit


count_to = action(CountTo)


@action
async def raise_error(ctx: RunHandle, text: str) -> None:
    """Log a text and raise, as the reference's actions do."""
    ctx.log(text)
    raise RuntimeError("as planned")


@action
async def fail(ctx: RunHandle, reason: str) -> None:
    """Fail on purpose."""
    raise ActionFailure(FailureCode.BLOCKED, reason, {"by": "a box"})


@action
async def crash(ctx: RunHandle) -> None:
    """Have a defect."""
    raise KeyError("shelf")


@action
async def measure(ctx: RunHandle) -> Outcome:
    """Tell more than was declared."""
    return Outcome(facts={"text": "beside", "seen": Text("a box"), "thing": object()})


@action
async def chatter(ctx: RunHandle) -> None:
    """Tell of every little progress."""
    for index in range(50):
        ctx.progress(index / 50, str(index))
    await asyncio.sleep(0.15)


@action
async def leave(ctx: RunHandle) -> None:
    """Try to end the program."""
    sys.exit(3)


@action
async def fail_badly(ctx: RunHandle) -> None:
    """Fail with facts that JSON cannot hold."""
    raise ActionFailure(FailureCode.BLOCKED, "half \ud800", {"thing": object()})


@action
async def no_op(ctx: RunHandle) -> None:
    """Do nothing."""


@action(pausable=False)
async def insist(ctx: RunHandle, seconds: float) -> None:
    """Wait without caring for a pause."""
    await ctx.clock.sleep(seconds)


@action
async def stubborn(ctx: RunHandle, seconds: float) -> None:
    """Ignore being cancelled."""
    end_s = time.monotonic() + seconds
    while (left_s := end_s - time.monotonic()) > 0:
        try:
            await asyncio.sleep(left_s)
        except asyncio.CancelledError:
            continue


@action
def in_thread(ctx: RunHandle, text: str) -> Text:
    """Say which thread runs it."""
    ctx.log(threading.current_thread().name)
    ctx.progress(0.5, "half")
    return Text(text.upper())


@action
def thread_loop(ctx: RunHandle) -> None:
    """Work in a thread until asked to stop."""
    while not ctx.stop_requested:
        time.sleep(0.005)


SPECS = [
    item.spec
    for item in (
        join_text, same_text, find_nothing, wait_for, count_to, raise_error, fail, crash, no_op, insist,
        measure, chatter, leave, fail_badly, stubborn, in_thread, thread_loop,
    )
]  # fmt: skip
CATALOGUE = Catalogue(SPECS)

PLANNER_CONDITIONS = ["on_true -> run", "on_false -> run", "on_stopped -> ignore", "on_error -> ignore"]


def node(name: str, instance_id: int = 0, **values: Any) -> dict[str, Any]:
    """A node with all parameters of its descriptor spelt out; `values` fill inputs."""
    spec = CATALOGUE.get(name)
    assert spec is not None
    written: dict[str, Any] = {"name": name, "instance_id": instance_id, "type": "sync"}
    inputs = {key: {"pvf_type": item.type} for key, item in spec.inputs.items()}
    for key, value in values.items():
        inputs[key] |= {"pvf_value": value}
    if inputs:
        written["input_parameters"] = inputs
    if spec.outputs:
        written["output_parameters"] = {key: {"pvf_type": item.type} for key, item in spec.outputs.items()}
    return written


def chain(
    name: str,
    nodes: list[dict[str, Any]],
    *,
    conditions: list[str] | None = None,
    exit_conditions: list[str] | None = None,
) -> dict[str, Any]:
    """A linear graph of `nodes`."""
    nodes = [dict(item) for item in nodes]
    for before, after in itertools.pairwise(nodes):
        before["children"] = [_ref(after)]
        after["parents"] = [_ref(before) | ({"conditions": conditions} if conditions else {})]
    return {
        "graph_name": name,
        "graph_entry": [_ref(nodes[0])],
        "graph_exit": [_ref(nodes[-1]) | ({"conditions": exit_conditions} if exit_conditions else {})],
        "actions": nodes,
    }


def planner_chain(name: str, nodes: list[dict[str, Any]]) -> dict[str, Any]:
    """A graph as planners send it: ends HALTED, so that it can be extended (12.6)."""
    return chain(
        name,
        nodes,
        conditions=PLANNER_CONDITIONS,
        exit_conditions=["on_true -> ignore", "on_false -> ignore", "on_error -> ignore"],
    )


def _ref(item: Mapping[str, Any]) -> dict[str, Any]:
    return {"name": item["name"], "instance_id": item["instance_id"]}
