"""What the simulator costs with all robots of a world driving, without their cameras and with them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import Final

from parley.clock import SimClock
from parley.robots.base import Velocity
from parley.sim.simulator import Simulator
from parley.sim.world_file import WorldFile

__all__ = ["SimulatorFigures", "measure_simulator"]

CAMERA_HZ: Final = 5.0
_CURVE: Final = Velocity(0.1, 0.5)
_COMMAND_S: Final = 0.1


@dataclass(frozen=True, slots=True)
class SimulatorFigures:
    """One run, measured in this process."""

    robots: int
    pictures: int
    robot_s: float
    """Robot time that passed."""
    wall_s: float
    cpu_s: float

    @property
    def per_core(self) -> float:
        """Robot time for each second of one core: what is less than 1 is no real time."""
        return self.robot_s / self.cpu_s


async def measure_simulator(world: WorldFile, robot_s: float) -> AsyncIterator[SimulatorFigures]:
    """Let every robot drive in a circle for so long at full speed, then once more with pictures at 5 Hz."""
    for with_cameras in (False, True):
        yield await _driven(world, robot_s, with_cameras=with_cameras)


async def _driven(world: WorldFile, robot_s: float, *, with_cameras: bool) -> SimulatorFigures:
    clock, names, pictures = SimClock(), [robot.name for robot in world.robots], 0
    async with Simulator(world, clock=clock, speed=None) as simulator:

        async def drive() -> None:
            while clock.now_s() < end_s:
                for name in names:
                    simulator.command(name, _CURVE)
                await clock.sleep(_COMMAND_S)

        async def photograph(name: str) -> None:
            nonlocal pictures
            while clock.now_s() < end_s:
                with clock.hold():
                    await simulator.photograph(name, 0.0)
                pictures += 1
                await clock.sleep(1 / CAMERA_HZ)

        began_s, wall_s, cpu_s = clock.now_s(), time.perf_counter(), time.process_time()
        end_s = began_s + robot_s
        await asyncio.gather(drive(), *(photograph(name) for name in names if with_cameras))
        return SimulatorFigures(
            len(names),
            pictures,
            clock.now_s() - began_s,
            time.perf_counter() - wall_s,
            time.process_time() - cpu_s,
        )
