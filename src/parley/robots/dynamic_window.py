"""Dynamic-window control: of the velocities reachable within one cycle, the best that hits nothing."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from parley.robots.base import DriveLimits, Velocity

__all__ = ["choose_velocity"]

Floats = NDArray[np.float64]

_SPEEDS, _TURNS = 5, 15
_HORIZON_S, _STRIDE_S = 1.5, 0.15
_TURN_FIRST_RAD = 0.8
_COMFORT_M = 0.15


def choose_velocity(
    now: Velocity, target_m: tuple[float, float], obstacles_m: Floats, limits: DriveLimits, cycle_s: float
) -> Velocity:
    """The next velocity towards a target.

    Args:
        now: The present velocity.
        target_m: x and y of where to go, in the robot's frame.
        obstacles_m: Shape (n, 2), what the lidar sees, in the robot's frame.
        limits: Of the drive.
        cycle_s: Time until the next call.

    Returns:
        A velocity within the limits; turning on the spot if nothing else is safe (a round robot always may).
    """
    bearing = math.atan2(target_m[1], target_m[0])
    on_the_spot = Velocity(0.0, float(np.clip(2.0 * bearing, -limits.max_turn_radps, limits.max_turn_radps)))
    if abs(bearing) > _TURN_FIRST_RAD:
        return on_the_spot
    slowest = max(0.0, now.linear_mps - limits.max_acceleration_mps2 * cycle_s)
    # Never faster than what still stops at the target.
    distance = math.hypot(*target_m)
    fastest = min(
        limits.max_speed_mps,
        now.linear_mps + limits.max_acceleration_mps2 * cycle_s,
        max(0.04, math.sqrt(limits.max_acceleration_mps2 * distance)),
    )
    reach = limits.max_turn_acceleration_radps2 * cycle_s
    turns = np.linspace(
        max(-limits.max_turn_radps, now.angular_radps - reach),
        min(limits.max_turn_radps, now.angular_radps + reach),
        _TURNS,
    )
    speeds = np.linspace(min(slowest, fastest), fastest, _SPEEDS)
    speed, turn_rate = (grid.ravel() for grid in np.meshgrid(speeds, turns))
    paths = _arcs(speed, turn_rate)
    gaps = _gaps(paths, obstacles_m)
    already = float(np.hypot(obstacles_m[:, 0], obstacles_m[:, 1]).min(initial=np.inf))
    # Standing too close already, it may move on as long as it comes no closer.
    safe = (gaps >= min(limits.keep_out_m, already - 0.005)) | (speed < 1e-3)
    if not safe.any():
        return on_the_spot
    miss = np.hypot(*(paths - np.asarray(target_m)[:, None, None])).min(axis=1)
    narrow = np.maximum(0.0, limits.keep_out_m + _COMFORT_M - gaps)
    cost = np.where(safe, miss + 0.5 * narrow + 0.01 * np.abs(turn_rate), np.inf)
    best = int(np.argmin(cost))
    return Velocity(float(speed[best]), float(turn_rate[best]))


def _arcs(speed: Floats, turn_rate: Floats) -> Floats:
    """Positions along the arcs; shape (2, number of velocities, number of moments)."""
    moments = np.arange(_STRIDE_S, _HORIZON_S + 1e-9, _STRIDE_S)
    yaw = turn_rate[:, None] * moments
    # The limit of v/w * sin(w t) for w -> 0 is v t: sinc says so without dividing by zero.
    chord = speed[:, None] * moments * np.sinc(yaw / math.tau)
    return np.stack([chord * np.cos(yaw / 2), chord * np.sin(yaw / 2)])


def _gaps(paths: Floats, obstacles_m: Floats) -> Floats:
    """The least distance between each path and any obstacle."""
    if len(obstacles_m) == 0:
        return np.full(paths.shape[1], np.inf)
    squares = (paths[0, :, :, None] - obstacles_m[:, 0]) ** 2 + (
        paths[1, :, :, None] - obstacles_m[:, 1]
    ) ** 2
    return np.asarray(np.sqrt(squares.min(axis=(1, 2))))
