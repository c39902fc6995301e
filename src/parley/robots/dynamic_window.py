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
_SIDEWAYS, _SIDEWAYS_FIRST_RAD = 5, 1.7
"""Of an omnidirectional base: how many speeds to the side, and when it turns first."""
_LOOKS_AHEAD = 0.03
"""So much it costs each radian not to look where it goes: cameras and people expect it."""
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
    if abs(bearing) > (_SIDEWAYS_FIRST_RAD if limits.max_lateral_mps else _TURN_FIRST_RAD):
        return on_the_spot
    # Never faster than what still stops at the target.
    stops = max(0.04, math.sqrt(limits.max_acceleration_mps2 * math.hypot(*target_m)))
    forward, turn_rate, left = _window(now, limits, stops, cycle_s)
    speed = np.hypot(forward, left)
    paths = _arcs(speed, np.arctan2(left, forward), turn_rate)
    gaps = _gaps(paths, obstacles_m)
    already = float(np.hypot(obstacles_m[:, 0], obstacles_m[:, 1]).min(initial=np.inf))
    # Standing too close already, it may move on as long as it comes no closer.
    safe = (gaps >= min(limits.keep_out_m, already - 0.005)) | (speed < 1e-3)
    if not safe.any():
        return on_the_spot
    miss = np.hypot(*(paths - np.asarray(target_m)[:, None, None])).min(axis=1)
    narrow = np.maximum(0.0, limits.keep_out_m + _COMFORT_M - gaps)
    cost = np.where(safe, miss + 0.5 * narrow + 0.01 * np.abs(turn_rate), np.inf)
    if limits.max_lateral_mps:
        cost += _LOOKS_AHEAD * np.abs(bearing - turn_rate * _HORIZON_S)
    best = int(np.argmin(cost))
    return Velocity(float(forward[best]), float(turn_rate[best]), float(left[best]))


def _window(now: Velocity, limits: DriveLimits, stops_mps: float, cycle_s: float) -> list[Floats]:
    """What can be reached within one cycle: forward, turning and sideways, each of the same length."""
    gain, reach = limits.max_acceleration_mps2 * cycle_s, limits.max_turn_acceleration_radps2 * cycle_s
    fastest = min(limits.max_speed_mps, now.linear_mps + gain, stops_mps)
    speeds = np.linspace(min(max(0.0, now.linear_mps - gain), fastest), fastest, _SPEEDS)
    turns = np.linspace(
        max(-limits.max_turn_radps, now.angular_radps - reach),
        min(limits.max_turn_radps, now.angular_radps + reach),
        _TURNS,
    )
    aside = min(limits.max_lateral_mps, stops_mps)
    sides = np.array([0.0])
    if aside:
        low, high = now.lateral_mps - gain, now.lateral_mps + gain
        sides = np.append(
            np.linspace(max(-aside, min(low, aside)), min(aside, max(high, -aside)), _SIDEWAYS), 0.0
        )
    return [grid.ravel() for grid in np.meshgrid(speeds, turns, sides)]


def _arcs(speed: Floats, way: Floats, turn_rate: Floats) -> Floats:
    """Positions along the arcs that begin in direction `way`; shape (2, velocities, moments)."""
    moments = np.arange(_STRIDE_S, _HORIZON_S + 1e-9, _STRIDE_S)
    yaw = turn_rate[:, None] * moments
    # The limit of v/w * sin(w t) for w -> 0 is v t: sinc says so without dividing by zero.
    chord = speed[:, None] * moments * np.sinc(yaw / math.tau)
    return np.stack([chord * np.cos(way[:, None] + yaw / 2), chord * np.sin(way[:, None] + yaw / 2)])


def _gaps(paths: Floats, obstacles_m: Floats) -> Floats:
    """The least distance between each path and any obstacle."""
    if len(obstacles_m) == 0:
        return np.full(paths.shape[1], np.inf)
    squares = (paths[0, :, :, None] - obstacles_m[:, 0]) ** 2 + (
        paths[1, :, :, None] - obstacles_m[:, 1]
    ) ** 2
    return np.asarray(np.sqrt(squares.min(axis=(1, 2))))
