"""Dock, and what is before it: a battery empties, that is told, the robot drives to a dock and fills it."""

from __future__ import annotations

from typing import Any

import pytest

from parley.actions.dock import dock
from parley.config import SystemConfig
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import NavigationControl
from parley.system import System
from parley.world.geometry import Pose2D
from tests.actions.room import room
from tests.demos.house import running
from tests.sim.worlds import box, two_rooms

DOCK = box("plug", 4.5, 0.3, (0.5, 0.2, 0.3), **{"class": "charger"}, listed=True, mapped=True, charges=True)
FAR_DOCK = {**DOCK, "name": "plug_2", "pose": (5.5, 3.7, 0.0)}


def weak(charge: float) -> dict[str, Any]:
    return {"A": {"battery": charge}}


async def test_a_robot_drives_to_the_nearest_dock_and_charges_there() -> None:
    async with room({"add": [FAR_DOCK, DOCK], "robots": weak(0.1)}) as here:
        await dock(here.context)
        assert here.robot.pose().distance_to(Pose2D(4.5, 0.3)) < 1.0
        began, began_s = here.robot.battery() or 0.0, here.simulator.clock.now_s()
        assert here.person.told == ["I am charging. My battery is 10 % full."]
        await here.simulator.clock.sleep(180)
        gained = (here.robot.battery() or 0.0) - began
        assert gained == pytest.approx((here.simulator.clock.now_s() - began_s) / 1800, rel=0.02)


async def test_without_a_dock_or_current_it_says_so() -> None:
    async with room() as here:
        with pytest.raises(ActionFailure, match="no charging dock") as failed:
            await dock(here.context)
        assert failed.value.code is FailureCode.NO_MATCH
    async with room({"add": [DOCK | {"charges": False}], "robots": weak(0.5)}) as here:
        with pytest.raises(ActionFailure, match="does not charge") as failed:
            await dock(here.context)
        assert failed.value.code is FailureCode.HARDWARE


async def test_an_empty_robot_does_not_drive_and_says_why() -> None:
    async with room({"robots": weak(0.001)}) as here:
        control = NavigationControl(lambda _: None, lambda: False)
        with pytest.raises(ActionFailure, match="battery is empty"):
            await here.robot.navigate(Pose2D(5.0, 3.0), control, timeout_s=60)
        assert here.robot.battery() == 0.0
        await here.simulator.clock.sleep(1)
        assert here.robot.velocity().speed_mps < 0.01


async def test_the_operator_hears_once_that_it_is_low_and_sends_it_to_charge() -> None:
    world = two_rooms({"add": [DOCK], "robots": weak(0.18)})
    async with running(System(world, SystemConfig(speed=None))) as house:

        def low() -> list[str]:
            return [said.message for said in house.observer.said if said.message.startswith("My battery")]

        await house.observer.until(lambda: bool(low()), timeout_s=20)
        await house.say("go and charge")
        assert (await house.done(), house.actions()) == (["finished"], ["Dock"])
        house.system.simulator.change({"robots": weak(0.04)})
        await house.observer.until(lambda: len(low()) > 1, timeout_s=20)
        house.system.simulator.change({"robots": weak(0.0)})
        await house.observer.until(lambda: len(low()) > 2, timeout_s=20)
        assert low() == [
            *(
                f"My battery is low: {number} %. Say “go and charge” when you can spare me."
                for number in (18, 4)
            ),
            "My battery is empty. Please have me brought to where I am charged.",
        ]
