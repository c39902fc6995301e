"""The simulated camera: one ray per pixel, shaded in numpy; no graphics library is needed.

The ray caster tells which geom every pixel shows. That is the segmentation, and from it comes what the
robot's detector reports.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from parley.sim.robot_model import CameraModel
from parley.world.geometry import Pose2D

__all__ = ["Frame", "RayCaster", "Sighting", "sightings"]

Floats = NDArray[np.float32]

_SUN = np.array([0.42, 0.28, 0.86], dtype=np.float32)
_TILE_M = 0.5
_DOUBTED_PX = 30
"""Of something that covers so few pixels a detector is as sure as not."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One picture with, for every pixel, which body it shows and how far that is."""

    rgb: NDArray[np.uint8]
    """Shape (height, width, 3)."""
    body_ids: NDArray[np.int32]
    """Shape (height, width); -1: nothing, 0: the floor."""
    distances_m: Floats
    """Shape (height, width), along the ray; `inf` where there is nothing."""
    points_m: Floats
    """Shape (height, width, 3): what each pixel shows, in the map frame; the eye where there is nothing."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """One body in a frame."""

    name: str
    label: str
    pixels: int
    box: tuple[int, int, int, int]
    """left, top, right, bottom in pixels (right and bottom exclusive)."""
    distance_m: float
    """Median over its pixels."""
    x_m: float
    y_m: float
    """The middle of what is seen of it, in the map frame."""
    span_m: tuple[float, float]
    """How far that reaches along the map's x and y."""
    confidence: float
    """How sure a detector would be of it, 0 to 1: the less it sees of it, the less."""


@dataclass(frozen=True, slots=True, eq=False)
class _Hits:
    geoms: NDArray[np.int32]
    distances: Floats
    """`inf` where there is nothing."""
    normals: Floats
    """Turned towards the eye."""


class RayCaster:
    """Draws one model, from data of its own, so that the physics is not disturbed; one thread at a time."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self.people: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        """Where those stand who walk; None: where they begin."""
        # Copies: reading attributes of the model, or comparing with its enums, costs more than the casting.
        self._geom_colours = model.geom_rgba[:, :3].astype(np.float32)
        self._geom_bodies = model.geom_bodyid.astype(np.int32)
        self._geom_is_floor = np.asarray(model.geom_type == int(mujoco.mjtGeom.mjGEOM_PLANE))

    @property
    def model(self) -> mujoco.MjModel:
        """The model it draws."""
        return self._model

    def photograph(self, qpos: NDArray[np.float64], body_id: int, pose: Pose2D, camera: CameraModel) -> Frame:
        """What the camera of the robot with body `body_id` at `pose` sees."""
        self._arrange(qpos)
        eye = np.array(
            [
                pose.x_m + camera.mount_forward_m * math.cos(pose.yaw_rad),
                pose.y_m + camera.mount_forward_m * math.sin(pose.yaw_rad),
                camera.mount_height_m,
            ]
        )
        rays = _pinhole_rays(camera, pose.yaw_rad)
        return self._draw(eye, rays, (camera.height_px, camera.width_px), body_id)

    def map_view(
        self, qpos: NDArray[np.float64], bounds_m: tuple[float, float, float, float], width_px: int
    ) -> Frame:
        """The world from straight above; `bounds_m` is x_min, y_min, x_max, y_max in the map frame."""
        self._arrange(qpos)
        x_min, y_min, x_max, y_max = bounds_m
        height_px = max(1, round(width_px * (y_max - y_min) / (x_max - x_min)))
        # From this far up all rays are nearly parallel, so walls hide nothing.
        eye = np.array([(x_min + x_max) / 2, (y_min + y_max) / 2, 400.0])
        x, y = np.meshgrid(np.linspace(x_min, x_max, width_px), np.linspace(y_max, y_min, height_px))
        rays = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1) - eye
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        return self._draw(eye, rays, (height_px, width_px), -1, shadows=True)

    def _arrange(self, qpos: NDArray[np.float64]) -> None:
        self._data.qpos[:] = qpos
        if self.people is not None:
            self._data.mocap_pos[:], self._data.mocap_quat[:] = self.people
        mujoco.mj_kinematics(self._model, self._data)

    def _draw(
        self,
        eye: NDArray[np.float64],
        rays: NDArray[np.float64],
        shape: tuple[int, int],
        exclude: int,
        *,
        shadows: bool = False,
    ) -> Frame:
        hits = self._cast(eye, rays, exclude)
        hit = hits.geoms >= 0
        points = eye.astype(np.float32) + np.where(hit, hits.distances, 0.0)[:, None] * rays.astype(
            np.float32
        )
        light = _brightness(hits.normals, rays.astype(np.float32))
        if shadows:
            light *= np.where(self._shaded(points, hit), np.float32(0.62), np.float32(1.0))
        colours = self._colours(hits.geoms, points) * light[:, None]
        colours[~hit] = (0.93, 0.94, 0.95)
        bodies = np.where(hit, self._geom_bodies[hits.geoms], np.int32(-1))
        return Frame(
            (np.clip(colours, 0.0, 1.0) * 255).astype(np.uint8).reshape(*shape, 3),
            bodies.reshape(shape),
            hits.distances.reshape(shape),
            points.reshape(*shape, 3),
        )

    def _cast(self, eye: NDArray[np.float64], rays: NDArray[np.float64], exclude: int) -> _Hits:
        count = len(rays)
        geoms = np.empty(count, dtype=np.int32)
        distances = np.empty(count)
        normals = np.empty(count * 3)
        mujoco.mj_multiRay(
            self._model, self._data, eye, rays.ravel(), None, 1, exclude,
            geoms, distances, normals, count, mujoco.mjMAXVAL,
        )  # fmt: skip
        distances[geoms < 0] = np.inf
        return _Hits(geoms, distances.astype(np.float32), normals.reshape(-1, 3).astype(np.float32))

    def _colours(self, geoms: NDArray[np.int32], points: Floats) -> Floats:
        colours = self._geom_colours[geoms]
        floor = (geoms >= 0) & self._geom_is_floor[geoms]
        tiles = np.floor(points[floor, :2] / _TILE_M).sum(axis=1) % 2
        colours[floor] *= (0.94 + 0.06 * tiles)[:, None].astype(np.float32)
        return np.asarray(colours)

    def _shaded(self, points: Floats, hit: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which points the sun does not reach: rays are cast back from a far point towards them."""
        sun = points[hit].mean(axis=0).astype(np.float64) + 60.0 * _SUN
        rays = points - sun
        reach = np.linalg.norm(rays, axis=1)
        hits = self._cast(sun, rays / reach[:, None], -1)
        return np.asarray(hit & (hits.distances < reach - 0.02), dtype=np.bool_)


def sightings(
    frame: Frame, names: Mapping[int, tuple[str, str]], min_pixels: int = 12
) -> tuple[Sighting, ...]:
    """What stands in a frame, largest first.

    Args:
        frame: The picture.
        names: Name and label of every body worth reporting, by body id.
        min_pixels: What covers less is not reported.
    """
    seen: list[Sighting] = []
    for body_id, pixels in zip(*np.unique(frame.body_ids, return_counts=True), strict=True):
        if int(body_id) not in names or pixels < min_pixels:
            continue
        name, words = names[int(body_id)]
        rows, columns = np.nonzero(frame.body_ids == body_id)
        box = int(columns.min()), int(rows.min()), int(columns.max()) + 1, int(rows.max()) + 1
        distance = round(float(np.median(frame.distances_m[rows, columns])), 3)
        low, high = (edge(frame.points_m[rows, columns, :2], axis=0) for edge in (np.min, np.max))
        x, y = np.round((low + high) / 2, 3).tolist()
        span = tuple(np.round(high - low, 3).tolist())
        sure = round(float(pixels / (pixels + _DOUBTED_PX)), 2)
        seen.append(Sighting(name, words, int(pixels), box, distance, x, y, span, sure))
    return tuple(sorted(seen, key=lambda sighting: (-sighting.pixels, sighting.name)))


def _brightness(normals: Floats, rays: Floats) -> Floats:
    towards_eye = -(normals * rays).sum(axis=1)
    facing = np.where(towards_eye < 0, -1.0, 1.0).astype(np.float32)
    sun = np.maximum(facing * (normals @ _SUN), 0.0)
    return np.asarray(0.5 + 0.3 * sun + 0.32 * np.abs(towards_eye), dtype=np.float32)


def _pinhole_rays(camera: CameraModel, yaw_rad: float) -> NDArray[np.float64]:
    """Unit vectors in the map frame, row by row from the upper left pixel."""
    focal_px = camera.width_px / 2 / math.tan(camera.fov_rad / 2)
    left = (camera.width_px - 1) / 2 - np.arange(camera.width_px)
    up = (camera.height_px - 1) / 2 - np.arange(camera.height_px)
    left_grid, up_grid = np.meshgrid(left / focal_px, up / focal_px)
    cos, sin = math.cos(camera.pitch_rad), math.sin(camera.pitch_rad)
    forward, upward = cos - sin * up_grid, sin + cos * up_grid
    east = math.cos(yaw_rad) * forward - math.sin(yaw_rad) * left_grid
    north = math.sin(yaw_rad) * forward + math.cos(yaw_rad) * left_grid
    rays = np.stack([east, north, upward], axis=2).reshape(-1, 3)
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))
