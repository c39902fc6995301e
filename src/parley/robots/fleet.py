"""The robots of one system, whatever they are made of."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from types import TracebackType
from typing import Protocol, Self

from parley.clock import Clock, WallClock
from parley.errors import ConfigError
from parley.gate.book import RuleBook
from parley.gate.fence import Fence
from parley.gate.judge import RobotFacts
from parley.robots.base import Robot
from parley.robots.own import RobotBase
from parley.world import grids
from parley.world.occupancy import NO_MAP, OccupancyMap

__all__ = ["Fleet", "OwnFleet"]


class Fleet(Protocol):
    """Robots, the time they live in, and the maps they drive by. Use as ``async with``."""

    @property
    def clock(self) -> Clock:
        """Robot time."""
        ...

    async def __aenter__(self) -> Self: ...

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    @property
    def names(self) -> tuple[str, ...]:
        """Who there is."""
        ...

    def occupancy(self, robot: str) -> OccupancyMap:
        """The map a robot drives by."""
        ...

    def facts(self, robot: str) -> RobotFacts:
        """What rules need to know about a robot."""
        ...

    def robot(self, name: str, rules: RuleBook) -> Robot:
        """The robot, held to the rules; asked for once it is open."""
        ...


class OwnFleet:
    """Robots that somebody wrote a class for; implements `Fleet`, in wall time.

    Args:
        robots: Of different names.
        occupancy: The map they drive by; None: none; then they have to find ways by themselves.

    Raises:
        ConfigError: Two have one name, or one has none; or what is needed for maps is not installed.
    """

    def __init__(self, robots: Sequence[RobotBase], occupancy: OccupancyMap | None = None) -> None:
        names = Counter(robot.name for robot in robots)
        if "" in names or max(names.values(), default=0) > 1:
            raise ConfigError(f"each robot needs a name of its own, not {', '.join(map(repr, names))}")
        if occupancy is not None:
            grids.require()
        self.clock: Clock = WallClock()
        self._robots = {robot.name: robot for robot in robots}
        self._occupancy = occupancy or NO_MAP

    async def __aenter__(self) -> Self:
        try:
            for robot in self._robots.values():
                await robot.open()
        except BaseException:
            self._close()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._close()

    def _close(self) -> None:
        for robot in self._robots.values():
            robot.close()

    @property
    def names(self) -> tuple[str, ...]:
        """See `Fleet.names`."""
        return tuple(self._robots)

    def occupancy(self, robot: str) -> OccupancyMap:
        """See `Fleet.occupancy`: the one given, else the robot's own."""
        return self._occupancy if self._occupancy is not NO_MAP else self._robots[robot].own_map or NO_MAP

    def facts(self, robot: str) -> RobotFacts:
        """See `Fleet.facts`."""
        own = self._robots[robot]
        return RobotFacts(self.occupancy(robot).name, own.radius_m, own.limits.max_speed_mps)

    def robot(self, name: str, rules: RuleBook) -> RobotBase:
        """See `Fleet.robot`."""
        own = self._robots[name]
        fence = Fence(rules, name, braking_mps2=own.limits.max_acceleration_mps2)
        occupancy = self.occupancy(name)
        own.settle(None if occupancy is NO_MAP else occupancy, self.clock, fence)
        return own
