"""What it takes to run a demonstration: start-up, latency of replies, speed of the simulation, memory."""

from __future__ import annotations

import asyncio
import resource
import statistics
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from parley.config import SystemConfig
from parley.demos.catalogue import Demo, load_demo
from parley.demos.observer import Observer
from parley.demos.runner import play
from parley.errors import ParleyError

__all__ = ["DemoFigures", "measure_demo"]


@dataclass(frozen=True, slots=True)
class DemoFigures:
    """Measured in this process."""

    ready_s: float
    """From reading the demonstration's files to the robot being there."""
    reply_ms: tuple[float, ...]
    """Wall time from each message of the story to its reply."""
    story_wall_s: float
    story_robot_s: float
    peak_rss_mb: float

    @property
    def reply_p50_ms(self) -> float:
        """Median latency of a reply."""
        return statistics.median(self.reply_ms)

    @property
    def real_time_factor(self) -> float:
        """Robot time per wall time over the whole story."""
        return self.story_robot_s / self.story_wall_s


async def measure_demo(name: str) -> DemoFigures:
    """Start a demonstration, then play its story at full speed.

    Raises:
        ParleyError: The story did not hold.
    """
    began_s = time.perf_counter()
    demo = await asyncio.to_thread(load_demo, name)
    ready_s = await _until_ready(demo, SystemConfig(speed=None), began_s)
    with tempfile.TemporaryDirectory(prefix="parley-") as folder:
        config = SystemConfig(speed=None, data_dir=Path(folder))
        result = await play(demo.story, lambda variant: demo.system(config, variant))
    if not result.held:
        raise ParleyError(f"the story did not hold, so nothing was measured: {result.text}")
    return DemoFigures(
        ready_s=ready_s,
        reply_ms=tuple(1000 * latency for latency in result.latencies_s),
        story_wall_s=result.wall_s,
        story_robot_s=result.robot_s,
        peak_rss_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    )


async def _until_ready(demo: Demo, config: SystemConfig, began_s: float) -> float:
    async with demo.system(config) as system, Observer(system.transport, system.clock) as observer:
        await observer.until(lambda: set(system.robot_names) <= observer.robots)
        return time.perf_counter() - began_s
