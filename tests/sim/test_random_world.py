"""The random worlds are fit for stories: what is in them can be reached and seen."""

from __future__ import annotations

import pytest

from parley.clock import SimClock
from parley.sim.simulator import Simulator
from parley.world.approach import approach_pose
from tests.sim.random_world import random_world


@pytest.mark.parametrize("seed", range(8))
async def test_everything_can_be_reached_and_the_item_is_seen_in_its_holder(seed: int) -> None:
    made = random_world(seed)
    objects = made.world.object_map()
    assert objects.get(made.item_id) is None
    async with Simulator(made.world, clock=SimClock(), speed=None) as simulator:
        occupancy, start = simulator.occupancy(made.robot), simulator.pose(made.robot)
        spots = {item.id: approach_pose(occupancy, item, start, radius_m=0.2) for item in objects.objects}
        assert None not in spots.values()
        spot = spots[made.holder_id]
        assert spot is not None
        simulator.change({"move": {made.robot: (spot.x_m, spot.y_m, spot.yaw_rad)}})
        photograph = await simulator.photograph(made.robot)
    seen = {sighting.label: sighting.pixels for sighting in photograph.sightings}
    assert seen[made.item] > 500


def test_the_same_seed_gives_the_same_world_and_another_other_names() -> None:
    assert random_world(3) == random_world(3)
    assert random_world(3).holder != random_world(4).holder
