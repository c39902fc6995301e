"""People walk by themselves: seen where they are, on their way, and not into a robot."""

from __future__ import annotations

import asyncio
import math

import pytest

from parley.clock import SimClock
from parley.errors import FileFormatError
from parley.robots.simulated import SimulatedRobot
from parley.sim.floor_plan import survey
from parley.sim.simulator import Simulator
from parley.world.geometry import Pose2D
from tests.robots.test_simulated import control, is_at
from tests.sim.worlds import box, two_rooms

KIM = box(
    "Kim", 2.4, 1.0, (0.35, 0.35, 1.7), **{"class": "person"}, walks={"over": [(2.4, 3.0)], "speed_mps": 0.5}
)


async def test_somebody_walks_to_and_fro_and_is_seen_where_they_are() -> None:
    async with Simulator(two_rooms({"add": [KIM]}), clock=SimClock(), speed=None) as simulator:
        assert simulator.people("A") == (("Kim", 2.4, 1.0),)
        first = (await simulator.photograph("A")).sightings
        await simulator.clock.sleep(1.0)
        ((name, x, y),) = simulator.people("A")
        assert (name, x) == ("Kim", 2.4)
        assert y == pytest.approx(1.5, abs=0.05)
        later = (await simulator.photograph("A")).sightings
        boxes = [next(seen.box for seen in sightings if seen.name == "Kim") for sightings in (first, later)]
        assert boxes[1][0] < boxes[0][0] - 30, "to the left in the picture"
        simulator.change({"add": [box("parcel", 5.0, 3.5, (0.1, 0.1, 0.1))]})
        await simulator.clock.sleep(4.0)
        assert simulator.world.thing("Kim").pose[1] == pytest.approx(2.5, abs=0.1), "on the way back"


async def test_nobody_walks_into_a_robot_and_the_robot_drives_past() -> None:
    in_the_way = KIM | {"pose": (1.0, 2.4, 0.0), "walks": {"over": [(1.0, 0.6)], "speed_mps": 0.5}}
    async with Simulator(two_rooms({"add": [in_the_way]}), clock=SimClock(), speed=None) as simulator:
        await simulator.clock.sleep(10.0)
        x, y, _ = simulator.world.thing("Kim").pose
        assert 0.6 < math.dist((x, y), (1.0, 1.0)) < 0.8
        robot = SimulatedRobot(simulator, "A", survey(two_rooms(), 0.3))
        goal, near = Pose2D(1.0, 3.4, 1.5), list[float]()

        def look(_: float) -> None:
            near.append(
                math.dist(simulator.world.thing("Kim").pose[:2], (robot.pose().x_m, robot.pose().y_m))
            )

        await asyncio.wait_for(robot.navigate(goal, control(look), timeout_s=90), 30)
        assert is_at(robot.pose(), goal)
        assert min(near) > 0.37


def test_who_walks_is_on_no_map() -> None:
    with pytest.raises(FileFormatError, match="neither mapped nor listed"):
        two_rooms({"add": [KIM | {"mapped": True}]})
