"""A robot class of one's own: a cart whose motors exist only here. `parley robot check` accepts it."""

import math
import threading

from parley.api import DriveLimits, Pose2D, RobotBase, Velocity

TICK_S = 0.02


class Cart(RobotBase):
    """Replace the thread by your base: read the pose from it, hand the velocity to it."""

    capabilities = frozenset({"drive", "horn"})
    radius_m = 0.3
    limits = DriveLimits(max_speed_mps=0.5, max_turn_radps=1.5)

    def __init__(self, name: str, x: float = 1.0, y: float = 1.0) -> None:
        super().__init__(name)
        self._pose, self._velocity = Pose2D(x, y), Velocity()
        threading.Thread(target=self._roll, daemon=True).start()

    def pose(self) -> Pose2D:
        return self._pose

    def velocity(self) -> Velocity:
        return self._velocity

    def send(self, velocity: Velocity) -> None:
        self._velocity = velocity

    def _roll(self) -> None:
        tick = threading.Event()
        while not tick.wait(TICK_S):
            here, now = self._pose, self._velocity
            ahead, yaw = now.linear_mps * TICK_S, here.yaw_rad + now.angular_radps * TICK_S
            x, y = here.x_m + ahead * math.cos(yaw), here.y_m + ahead * math.sin(yaw)
            self._pose = Pose2D(x, y, yaw)
