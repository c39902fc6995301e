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


BOARDED_UP = {
    "add": [
        {
            "name": "boards",
            "class": "board",
            "description": "board",
            "pose": [0.9, 1.2, 0],
            "listed": False,
            "mapped": False,
            "parts": [
                {"size_m": [0.1, 3.4, 1.2], "at_m": [1.6, 0, 0], "colour": "#b08d57"},
                {"size_m": [2.9, 0.1, 1.2], "at_m": [0.2, 1.7, 0], "colour": "#b08d57"},
            ],
        }
    ]
}


async def test_dropping_an_order_that_failed_at_the_dock_leaves_all_agreeing_and_it_works_again(
    demo: Demo, tmp_path: Path
) -> None:
    """Thesis 5.4.3 with a world that makes navigation fail there, and what is answered meanwhile."""
    system = demo.system(SystemConfig(speed=None, data_dir=tmp_path))
    async with running(system) as house:
        await house.say("Go to shelf 2.")
        await house.done()
        assert system.simulator is not None
        system.simulator.change(BOARDED_UP)
        await house.say("Return to the charging dock.")
        assert "try again" in (await house.question()).choices
        for question in ("what went wrong?", "what is the plan?"):
            assert "Something is in the way by the charging dock" in (await house.say(question)).message
        await house.say("Clear everything.")
        await house.state("idle")
        assert [*house.observer.graph_states.values()] == ["HALTED", "STOPPED"]  # that of shelf 2 ran dry
        assert "Nothing is left to do" in (await house.say("what is the plan?")).message
        await house.say("Go to shelf 1.")
        assert await house.done() == ["finished", "finished"]
        system.simulator.change({"remove": ["boards"]})
        await house.say("Return to the charging dock.")
        assert await house.done() == ["finished", "finished"]
        assert house.distance_m("dock_1") < 1.4
