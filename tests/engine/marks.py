"""Actions that leave a mark in a file when they begin, and graphs of them, for processes that are killed."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph

MARKS_FILE = "PARLEY_TEST_MARKS"
"""Environment variable: the file with one line for each action that began; the gate is a file beside it."""


@dataclass(frozen=True)
class Given:
    gave: str


@dataclass(frozen=True)
class Thing:
    thing: object


def marks() -> Path:
    return Path(os.environ[MARKS_FILE])


def count(text: str) -> int:
    return marks().read_text(encoding="utf-8").split().count(text)


def leave(text: str) -> None:
    with marks().open("a", encoding="utf-8") as file:
        file.write(f"{text}\n")


@action(name="Mark")
async def leave_mark(ctx: RunHandle, text: str, waits_at: float, given: str = "") -> Given:
    """Mark the beginning; the `waits_at`-th time wait until the gate is open."""
    leave(text)
    while count(text) == waits_at and not marks().with_name("gate").exists():  # noqa: ASYNC110 - of another process
        await asyncio.sleep(0.002)
    return Given(f"{text}:{given}" if given else text)


@action
async def pace(ctx: RunHandle, text: str, given: str = "") -> Given:
    """Mark the beginning, and take a moment."""
    leave(text)
    await asyncio.sleep(0.005)
    return Given(text)


@action
async def third(ctx: RunHandle) -> bool:
    """Mark a check; true once there were three."""
    leave("check")
    return count("check") >= 3


@action(inputs={}, outputs={"thing": "object"})
async def give(ctx: RunHandle) -> Thing:
    """Give what no file can hold."""
    return Thing(object())


@action(inputs={"thing": "object"}, outputs={})
async def take(ctx: RunHandle, thing: object) -> None:
    """Take it."""


def ref(item: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    return {"name": item["name"], "instance_id": item["instance_id"]} | more


def mark(instance_id: int, text: str, *, waits_at: int = 0, **more: Any) -> dict[str, Any]:
    """A node that marks its beginning."""
    inputs = {
        "text": {"pvf_type": "string", "pvf_value": text},
        "waits_at": {"pvf_type": "number", "pvf_value": waits_at},
        "given": {"pvf_type": "string"},
    }
    return _node("Mark", instance_id, input_parameters=inputs, output_parameters=_GAVE) | more


_GAVE = {"gave": {"pvf_type": "string"}}


def _node(name: str, instance_id: int = 0, **more: Any) -> dict[str, Any]:
    return {"name": name, "instance_id": instance_id, "type": "sync"} | more


def _link(parent: dict[str, Any], child: dict[str, Any], *, gives: str = "", **edge: Any) -> None:
    remap = {"remap": [{"from": "gave", "to": gives}]} if gives else {}
    parent.setdefault("children", []).append(ref(child, **remap))
    child.setdefault("parents", []).append(ref(parent, **edge))


def _graph(name: str, *nodes: dict[str, Any]) -> dict[str, Any]:
    """The first node is the entry, the last one the exit."""
    return {
        "graph_name": name,
        "graph_entry": [ref(nodes[0])],
        "graph_exit": [ref(nodes[-1])],
        "actions": list(nodes),
    }


def branching() -> dict[str, Any]:
    """One, then three at once (one of them slow), one that is not chosen, a join of two, a last one."""
    first, quick, slow = mark(0, "first"), mark(1, "quick"), mark(2, "slow", waits_at=1)
    join, otherwise, never, last = mark(3, "join"), mark(4, "otherwise"), mark(5, "never"), mark(6, "last")
    for child in (quick, slow, otherwise):
        _link(first, child)
    _link(first, never, conditions=["on_true -> ignore"])
    _link(quick, join, gives="given")
    _link(slow, join)
    _link(join, last, gives="given")
    return _graph("g", first, quick, slow, join, otherwise, never, last)


def ladder(rungs: int) -> dict[str, Any]:
    """Again and again two at once that meet in one, which takes what one of them gave."""

    def step(instance_id: int) -> dict[str, Any]:
        inputs = {
            "text": {"pvf_type": "string", "pvf_value": f"n{instance_id}"},
            "given": {"pvf_type": "string"},
        }
        return _node("Pace", instance_id, input_parameters=inputs, output_parameters=_GAVE)

    nodes = [step(0)]
    for rung in range(rungs):
        left, right, meeting = (step(3 * rung + place) for place in (1, 2, 3))
        for side in (left, right):
            _link(nodes[-1], side)
        _link(left, meeting, gives="given")
        _link(right, meeting)
        nodes += [left, right, meeting]
    return _graph("g", *nodes)


def looping() -> dict[str, Any]:
    """Work and check until there were three checks; the third work waits."""
    work, check = mark(0, "work", waits_at=3), _node("Third")
    _link(work, check)
    _link(check, work, required=False, conditions=["on_false -> run", "on_true -> ignore"])
    graph = _graph("g", work, check)
    graph["graph_exit"][0]["conditions"] = ["on_false -> ignore"]
    return graph


def nested() -> dict[str, Any]:
    """An indexed graph between two actions."""
    before, inner, after = (
        mark(0, "before"),
        _node("Inner", output_parameters=_GAVE, input_parameters={"given": {"pvf_type": "string"}}),
        mark(1, "after"),
    )
    _link(before, inner, gives="given")
    _link(inner, after, gives="given")
    return _graph("g", before, inner, after)


def spontaneous() -> dict[str, Any]:
    """A monitor whose third round waits; each round sets off a check, the third of which ends the graph."""
    tick, check = mark(0, "tick", waits_at=3, type="spontaneous"), _node("Third")
    _link(tick, check)
    graph = _graph("g", tick, check)
    graph["graph_exit"][0]["conditions"] = ["on_false -> ignore"]
    return graph


def opaque() -> dict[str, Any]:
    """What the first gives is still needed by the last, and no file can hold it."""
    giver = _node("Give", output_parameters={"thing": {"pvf_type": "object"}})
    slow = mark(0, "slow", waits_at=1)
    taker = _node("Take", input_parameters={"thing": {"pvf_type": "object"}})
    _link(giver, slow)
    _link(giver, taker)
    _link(slow, taker)
    return _graph("g", giver, slow, taker)


def _inner() -> dict[str, Any]:
    nodes = [mark(0, "inner_first"), mark(1, "inner_slow", waits_at=1), mark(2, "inner_last")]
    _link(nodes[0], nodes[1])
    _link(nodes[1], nodes[2], gives="given")
    return _graph("Inner", *nodes)


CATALOGUE = Catalogue([leave_mark.spec, pace.spec, third.spec, give.spec, take.spec], [read_graph(_inner())])
