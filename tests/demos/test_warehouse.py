"""The demonstration of thesis 5.4.2: which storing area, the package, a cylinder at an edge, and home."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.catalogue import Demo, load_demo
from parley.umrf.action import ActionSpec
from tests.demos.house import played, running


@pytest.fixture(scope="module")
def demo() -> Demo:
    return load_demo("warehouse")


@pytest.mark.parametrize(("variant", "seed"), [("", 0), ("more_words", 5)])
async def test_story_holds_and_what_stands_at_the_edge_is_told(
    demo: Demo, tmp_path: Path, variant: str, seed: int
) -> None:
    reason, events, system = await played(demo, tmp_path, variant, seed)
    assert reason == ""
    assert [event["code"] for event in events if event["event"] == "failure"] == ["attention"]
    found = {item.description for item in system.known.objects if item.found}
    assert found == {"package"}  # the cylinder was taken away, and that was seen
    kept = {event["name"] for event in events if event["event"] == "memory"}
    assert variant or "the_loading_area_has_been_cleared" in kept


def never_there(spec: ActionSpec, over: asyncio.Event) -> ActionSpec:
    """A drive that hangs the first time, and does not hear that it is to end."""
    runs = itertools.count()

    async def run(context: Any, **inputs: Any) -> Any:
        assert spec.run is not None
        if next(runs):
            return await spec.run(context, **inputs)
        while not over.is_set():
            with contextlib.suppress(asyncio.CancelledError):
                await over.wait()
        return None

    return replace(spec, run=run)


async def test_dropping_an_order_whose_drive_never_ends_leaves_plan_engine_and_robot_agreeing(
    demo: Demo, tmp_path: Path
) -> None:
    """Thesis 5.4.3: navigation hung at the dock, the graph was cleared, and planner and engine parted."""
    over = asyncio.Event()
    actions = [never_there(spec, over) if spec.name == "NavigateTo" else spec for spec in BUILTIN_ACTIONS]
    system = demo.system(SystemConfig(speed=None, data_dir=tmp_path), actions=actions)
    async with running(system) as house:
        await house.say("Return to the charging dock.")
        await house.observer.until(
            lambda: house.observer.plans[house.robot].steps[-1].state == "running", timeout_s=20
        )
        await house.say("Clear everything.")
        await house.state("idle")
        await house.say("Go to shelf 1.")
        assert await house.done() == ["finished", "finished"]
        assert house.distance_m("shelf_1") < 1.4
        over.set()
