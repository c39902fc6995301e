"""Nodes that are tried again, that may take only so long, and that are skipped: told beside UMRF."""

from __future__ import annotations

import asyncio
import json
import threading
from typing import Any

import pytest

from parley.errors import ActionFailure, FailureCode, GraphRefusedError
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import Result

from .spec_actions import CATALOGUE, chain, node
from .watched import Watched, until


class Door:
    """Fails as often as it is told to, in its own way."""

    def __init__(self, failures: int, code: FailureCode = FailureCode.BLOCKED) -> None:
        self.calls, self.failures, self.code = 0, failures, code
        self.given: list[str] = []

    def catalogue(self) -> Catalogue:
        @action
        async def open_door(ctx: RunHandle, name: str) -> None:
            """Open it."""
            self.calls += 1
            self.given.append(name)
            if self.calls <= self.failures:
                raise ActionFailure(self.code, f"no {self.calls}")

        return Catalogue([open_door.spec, *CATALOGUE])


def one(action_name: str, limits: dict[str, Any], /, **values: str) -> dict[str, Any]:
    inputs = {key: {"pvf_type": "string", "pvf_value": value} for key, value in values.items()}
    return chain(
        "g",
        [
            {
                "name": action_name,
                "instance_id": 0,
                "type": "sync",
                "input_parameters": inputs,
                "parley": limits,
            }
        ],
    )


@pytest.mark.parametrize(("retries", "result", "calls"), [(2, Result.ON_TRUE, 3), (1, Result.ON_ERROR, 2)])
async def test_a_node_that_fails_is_tried_again_so_often(retries: int, result: Result, calls: int) -> None:
    door = Door(2)
    watched = Watched(one("OpenDoor", {"retries": retries}, name="red"), catalogue=door.catalogue())
    watched.run.start()
    assert await watched.run.wait() is result
    assert door.given == ["red"] * calls
    again = [item for item in watched.told if item.cause == "retry"]
    assert [item.state for item in again] == ["RUNNING"] * (calls - 1)
    assert "attempt 1 failed, another one follows" in watched.log("OpenDoor_0")
    assert "ERROR" not in watched.states("OpenDoor_0")[:-1]
    if result is Result.ON_ERROR:
        assert "no 2" in watched.told[-2].message


@pytest.mark.parametrize("code", [FailureCode.DECLINED, FailureCode.FORBIDDEN, FailureCode.ATTENTION])
async def test_what_a_person_or_a_rule_refused_is_not_tried_again(code: FailureCode) -> None:
    door = Door(2, code)
    watched = Watched(one("OpenDoor", {"retries": 5}, name="red"), catalogue=door.catalogue())
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert door.calls == 1


async def test_a_pause_holds_the_next_attempt() -> None:
    door, may_fail = Door(0), asyncio.Event()

    @action(pausable=False)
    async def push(ctx: RunHandle) -> None:
        """Fail when it may."""
        door.calls += 1
        await may_fail.wait()
        raise ActionFailure(FailureCode.BLOCKED, "no")

    watched = Watched(one("Push", {"retries": 1}), catalogue=Catalogue([push.spec]))
    watched.run.start()
    await until(lambda: door.calls)
    watched.run.pause()
    may_fail.set()
    await until(lambda: watched.run.state == "PAUSED")
    assert (door.calls, watched.state("Push_0")) == (1, "PAUSED")
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_ERROR
    assert door.calls == 2


async def test_a_stop_ends_what_would_be_tried_again() -> None:
    graph = chain("g", [node("WaitFor", 0, seconds=60.0) | {"parley": {"retries": 3}}])
    watched = Watched(graph)
    watched.run.start()
    await asyncio.sleep(0.01)
    watched.run.end_node("WaitFor_0")
    await watched.run.wait()
    assert watched.states("WaitFor_0") == ["RUNNING", "STOPPING", "FINISHED"]


async def test_a_node_has_a_time_limit_of_its_own_for_each_attempt() -> None:
    graph = chain("g", [node("WaitFor", 0, seconds=60.0) | {"parley": {"timeout_s": 0.02, "retries": 1}}])
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert [item.cause for item in watched.told if item.state == "RUNNING" and item.node] == [
        "start",
        "retry",
    ]
    assert "Wait for took longer than 0.02 s" in watched.log("WaitFor_0")[-1]


async def test_a_graph_inside_has_the_time_limit_of_its_node() -> None:
    inner = read_graph(chain("Inner", [node("WaitFor", 0, seconds=60.0)]))
    graph = chain(
        "g",
        [
            {
                "name": "Inner",
                "instance_id": 0,
                "type": "sync",
                "parley": {"timeout_s": 0.02},
                "output_parameters": node("WaitFor")["output_parameters"],
            }
        ],
    )
    watched = Watched(graph, catalogue=Catalogue([*CATALOGUE], [inner]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert "Inner took longer than 0.02 s" in watched.log("Inner_0")[-1]


async def test_nothing_is_tried_again_beside_a_thread_that_does_not_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("parley.umrf.node_run.THREAD_GRACE_S", 0.01)
    may_end, calls = threading.Event(), list[int]()

    @action
    def grind(ctx: RunHandle) -> None:
        """Never look up."""
        calls.append(1)
        may_end.wait(5)

    watched = Watched(one("Grind", {"timeout_s": 0.01, "retries": 3}), catalogue=Catalogue([grind.spec]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    may_end.set()
    assert calls == [1]


async def test_a_skipped_node_is_seen_in_the_whole_graph_until_it_runs() -> None:
    conditions = ["on_true -> bypass"]
    watched = Watched(chain("g", [node("NoOp", 0), node("NoOp", 1)], conditions=conditions))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    text = write_graph(watched.run.snapshot())
    first, second = json.loads(text)["actions"]
    assert ("parley" in first, second["parley"], second["state"]) == (
        False,
        {"skipped": "on_true"},
        "UNINITIALIZED",
    )
    assert read_graph(text).node("NoOp_1") is not None


def test_limits_are_kept_in_both_forms_and_what_makes_no_sense_is_refused() -> None:
    graph = read_graph(one("NoOp", {"retries": 2, "timeout_s": 1.5, "phrases": ["of a descriptor"]}))
    for faithful in (True, False):
        written = json.loads(write_graph(graph, faithful=faithful))
        assert written["actions"][0]["parley"] == {"retries": 2, "timeout_s": 1.5}
    for wrong in (
        {"retries": -1},
        {"retries": True},
        {"retries": 1000},
        {"timeout_s": 0},
        {"timeout_s": "1"},
    ):
        with pytest.raises(GraphRefusedError, match=next(iter(wrong))):
            read_graph(one("NoOp", wrong))
