"""What keeps a drive out of zones and within speed limits while it moves, below every action.

A drive asks `limit` before each command takes effect; whoever plans ways asks `walls`. Both look at the rules
as they are at that moment.
"""

from __future__ import annotations

import math
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from parley.gate.book import RuleBook
from parley.gate.judge import Finding
from parley.gate.ways import with_walls
from parley.gate.wording import hours_text, zone_text
from parley.messages.rules import Rule
from parley.sentences import sentence
from parley.world.geometry import Pose2D, Velocity
from parley.world.occupancy import OccupancyMap
from parley.world.planning import NoPathError, plan_path

__all__ = ["Fence"]

_REACTION_S: Final = 0.12
"""Until a command has become motion, and until the next one may."""
_MARGIN_M: Final = 0.02
_TURN_OUT_M: Final = 0.08
_SAMPLES: Final = 14
_TURNS: Final = 5
_SHARES: Final = (1.0, 0.75, 0.5, 0.25, 0.1)
_STILL_MPS: Final = 1e-3
_TOLERANCE_M: Final = 1e-9
"""Of the arithmetic; more would let a robot creep in, step by step."""


class Fence:
    """The fence of one robot.

    Args:
        book: The rules.
        robot: Whose.
        braking_mps2: How fast it can slow down.
    """

    def __init__(self, book: RuleBook, robot: str, *, braking_mps2: float) -> None:
        self._book, self._robot, self._braking_mps2 = book, robot, braking_mps2
        self._inside: dict[tuple[str, int], float] = {}

    @property
    def closed_now(self) -> tuple[tuple[str, int], ...]:
        """What the robot must keep out of now; changes when the rules or the hours do."""
        return tuple((rule.id, self._book.revision) for rule in self._closed())

    def _closed(self) -> list[Rule]:
        return [rule for rule in self._book.active(self._robot) if _closes(rule)]

    def walls(self, occupancy: OccupancyMap, start: Pose2D) -> OccupancyMap:
        """The map with what the robot must keep out of drawn in; from inside, it may find its way out."""
        shapes = [self._book.shape(rule) for rule in self._closed()]
        return with_walls(occupancy, shapes, (start.x_m, start.y_m), self._radius_m)

    @property
    def _radius_m(self) -> float:
        return self._book.facts(self._robot).radius_m

    def why_closed(self, goal: Pose2D) -> Finding | None:
        """Which rule keeps the robot out of a place; None if it may be there."""
        for rule in self._closed():
            if self._book.shape(rule).distance_to(goal.x_m, goal.y_m) < self._radius_m:
                said = sentence(
                    "I must not go into {zone}{hours}.", zone=zone_text(rule), hours=hours_text(rule.when)
                )
                return Finding(-1, rule.id, "zone_entered", said)
        return None

    def why_no_way(
        self, occupancy: OccupancyMap, start: Pose2D, goal: Pose2D, radius_m: float
    ) -> Finding | None:
        """Which rule leaves no way to a goal; None if there is none without the rules either."""
        try:
            way = plan_path(occupancy, start, goal, radius_m=radius_m).points_m
        except NoPathError:
            return None
        for rule in self._closed():
            if (self._book.shape(rule).distance_m(way) < radius_m).any():
                said = sentence(
                    "The only way there leads through {zone}, where I must not go{hours}.",
                    zone=zone_text(rule),
                    hours=hours_text(rule.when),
                )
                return Finding(-1, rule.id, "zone_on_way", said)
        return None

    def limit(self, pose: Pose2D, measured: Velocity, command: Velocity) -> Velocity:
        """What of a command may take effect.

        Args:
            pose: Where the robot is.
            measured: How it moves.
            command: How it is told to move.

        Returns:
            The same, slower, or turning on the spot: a round robot always may.
        """
        if not self._book.in_force:
            return Velocity()
        rules = [
            rule for rule in self._book.active(self._robot) if rule.kind in ("keep_out", "slow", "speed")
        ]
        if not rules or max(command.speed_mps, measured.speed_mps) < _STILL_MPS:
            return command
        fastest = self._fastest(rules, self._points_ahead(pose, measured, command))
        command = command.slower(min(1.0, fastest / max(command.speed_mps, _STILL_MPS)))
        closed = [(self._book.shape(rule), self._nearest_m(rule, pose)) for rule in rules if _closes(rule)]
        turning = Velocity(0.0, command.angular_radps)
        for allowed in (*(command.slower(share) for share in _SHARES), turning):
            points = self._points_ahead(pose, measured, allowed)
            if all((shape.distance_m(points) >= keep_m).all() for shape, keep_m in closed):
                return allowed
        return turning if measured.speed_mps < _STILL_MPS else Velocity()

    def _fastest(self, rules: list[Rule], points: NDArray[np.float64]) -> float:
        """The least of the speeds allowed where it is and where it will be before it could stand."""
        fastest = math.inf
        for rule in rules:
            if rule.max_speed_mps is None:
                continue
            near = rule.kind == "speed" or (
                (self._book.shape(rule).distance_m(points) < self._radius_m + _MARGIN_M).any()
            )
            if near:
                fastest = min(fastest, rule.max_speed_mps)
        return fastest

    def _points_ahead(self, pose: Pose2D, measured: Velocity, command: Velocity) -> NDArray[np.float64]:
        """Where the robot may be until it stands, if it is told to stop after this; shape (n, 2)."""
        # A drive takes its time for a turn too: any rate from none to those may be the one it brakes with.
        rates = (0.0, command.angular_radps, measured.angular_radps)
        turns = np.unique(np.linspace(min(rates), max(rates), _TURNS))
        forward = {_faster(measured.linear_mps, command.linear_mps), measured.linear_mps}
        left = {_faster(measured.lateral_mps, command.lateral_mps), measured.lateral_mps}
        # Each axis comes to what it is told in its own time, so the ways in between count too.
        return np.concatenate([self._braking(pose, x, y, turns) for x, y in product(forward, left)])

    def _braking(
        self, pose: Pose2D, forward_mps: float, left_mps: float, turns: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """The ways to standing still from a velocity, one for each turning rate; shape (n, 2)."""
        until_s = _REACTION_S + max(abs(forward_mps), abs(left_mps)) / self._braking_mps2
        step_s = until_s / _SAMPLES
        moments = (np.arange(_SAMPLES) + 0.5) * step_s
        slower = self._braking_mps2 * np.maximum(0.0, moments - _REACTION_S)
        ahead = np.sign(forward_mps) * np.maximum(0.0, abs(forward_mps) - slower) * step_s
        aside = np.sign(left_mps) * np.maximum(0.0, abs(left_mps) - slower) * step_s
        yaw = pose.yaw_rad + turns[:, None] * moments
        x = pose.x_m + np.cumsum(ahead * np.cos(yaw) - aside * np.sin(yaw), axis=1)
        y = pose.y_m + np.cumsum(ahead * np.sin(yaw) + aside * np.cos(yaw), axis=1)
        here = [[pose.x_m, pose.y_m]]
        return np.concatenate([here, np.stack([x.ravel(), y.ravel()], axis=1)])

    def _nearest_m(self, rule: Rule, pose: Pose2D) -> float:
        """How near its middle may come to a zone's border, negative inside.

        Who stands inside already may leave: never deeper than it was by more than it takes to turn out, and
        the farther out it is, the less.
        """
        key, now_m = (rule.id, self._book.revision), self._book.shape(rule).distance_to(pose.x_m, pose.y_m)
        if now_m >= self._radius_m:
            self._inside.pop(key, None)
            return min(self._radius_m + _MARGIN_M, now_m) - _TOLERANCE_M
        deepest = max(self._inside.get(key, -math.inf), now_m - self._radius_m - _TURN_OUT_M)
        self._inside[key] = deepest
        return deepest


def _faster(now_mps: float, told_mps: float) -> float:
    """What a drive comes to that is told a speed: it may be faster still for a while."""
    return now_mps if now_mps * told_mps > told_mps**2 else told_mps


def _closes(rule: Rule) -> bool:
    return rule.kind == "keep_out"
