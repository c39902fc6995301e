"""From a world file to a MuJoCo model.

Robots are planar bases: two slides and a hinge, driven by velocity servos along the robot's own axes whose
force is limited, so that a robot accelerates like a real one and cannot push through a wall. Wheels with
contacts were measured to drift and over-turn.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import mujoco
from PIL import ImageColor

from parley.sim.entries import RobotEntry
from parley.sim.robot_model import RobotModel
from parley.sim.solids import Solid
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D

__all__ = ["STEP_S", "BodyKind", "build_spec", "robot_body", "thing_body"]

STEP_S = 0.005
"""Length of a physics step."""

_SERVO_TIME_S = 0.05
_SOLID = {"contype": 1, "conaffinity": 1}
# Touches nothing, yet rays see it: geoms with contype = conaffinity = 0 that share a body with colliding ones
# are invisible to mj_multiRay.
_SEEN_ONLY = {"contype": 4, "conaffinity": 0}
_GEOM_TYPES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
}


@dataclass(frozen=True, slots=True)
class BodyKind:
    """The prefixes of body names, so that a body tells what it is."""

    ROBOT = "robot:"
    THING = "thing:"
    WALL = "wall:"


def robot_body(name: str) -> str:
    """The name of a robot's body; its joints and actuators carry suffixes."""
    return BodyKind.ROBOT + name


def thing_body(name: str) -> str:
    """The name of a thing's body."""
    return BodyKind.THING + name


def build_spec(world: WorldFile) -> mujoco.MjSpec:
    """The whole world as a MuJoCo specification, ready to be compiled.

    Robots stand at the origin: their joint positions are their poses in the map frame, set by who owns the
    data.
    """
    spec = mujoco.MjSpec()
    spec.option.timestep = STEP_S
    # Implicit in the servos' velocity: they stay stable although they are stiff.
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.gravity = (0.0, 0.0, 0.0)  # nothing can fall: robots slide in the plane, things are fixed
    floor = spec.worldbody.add_geom(
        name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=(0, 0, 1), **_SEEN_ONLY
    )
    floor.rgba = _rgba(ImageColor.getrgb(world.floor)[:3])
    for index, wall in enumerate(world.walls):
        _add_solids(spec.worldbody.add_body(name=f"{BodyKind.WALL}{index}"), wall.solids())
    for thing in world.standing():
        body = spec.worldbody.add_body(name=thing_body(thing.name), mocap=thing.walks is not None)
        # Who walks is moved as a whole: their frame is the body's.
        base = Pose2D(0.0, 0.0) if thing.walks is not None else world.base_of(thing)
        _add_solids(body, thing.solids(base))
    robots = {robot.name: _add_robot(spec, robot) for robot in world.robots}
    for thing in world.things:
        if carrier := world.carrier_of(thing):
            _add_solids(robots[carrier], thing.solids(world.base_of(thing)), mass=0, **_SEEN_ONLY)
    return spec


def _add_solids(body: mujoco.MjsBody, solids: Iterable[Solid], **more: float) -> None:
    for solid in solids:
        length, width, height = solid.size_m
        size = (
            (length / 2, height / 2, 0) if solid.shape == "cylinder" else (length / 2, width / 2, height / 2)
        )
        body.add_geom(
            type=_GEOM_TYPES[solid.shape],
            size=size,
            pos=(solid.x_m, solid.y_m, solid.z_m + height / 2),
            quat=(math.cos(solid.yaw_rad / 2), 0, 0, math.sin(solid.yaw_rad / 2)),
            rgba=_rgba(solid.rgb),
            **(_SOLID | more),
        )


def _add_robot(spec: mujoco.MjSpec, entry: RobotEntry) -> mujoco.MjsBody:
    name, model = robot_body(entry.name), entry.model
    body = spec.worldbody.add_body(name=name)
    for suffix, kind, axis in (
        ("x", mujoco.mjtJoint.mjJNT_SLIDE, (1, 0, 0)),
        ("y", mujoco.mjtJoint.mjJNT_SLIDE, (0, 1, 0)),
        ("yaw", mujoco.mjtJoint.mjJNT_HINGE, (0, 0, 1)),
    ):
        body.add_joint(name=f"{name}/{suffix}", type=kind, axis=axis)
    _add_hull(body, model)
    site = f"{name}/base"
    body.add_site(name=site)
    inertia = 0.5 * model.mass_kg * model.radius_m**2
    force = model.mass_kg * model.max_acceleration_mps2
    torque = inertia * model.max_turn_acceleration_radps2
    # Where it does not drive, the sideways servo holds speed zero as a wheel's grip would, much stronger.
    grip = 1.0 if model.max_lateral_mps else 20.0
    for suffix, gear, mass, limit in (
        ("forward", (1, 0, 0, 0, 0, 0), model.mass_kg, force),
        ("sideways", (0, 1, 0, 0, 0, 0), model.mass_kg, grip * force),
        ("turn", (0, 0, 0, 0, 0, 1), inertia, torque),
    ):
        servo = spec.add_actuator(name=f"{name}/{suffix}", trntype=mujoco.mjtTrn.mjTRN_SITE, target=site)
        servo.gear = gear
        servo.set_to_velocity(kv=mass / _SERVO_TIME_S)
        servo.forcerange = (-limit, limit)
        servo.forcelimited = True
    return body


def _add_hull(body: mujoco.MjsBody, model: RobotModel) -> None:
    """A round collision hull, and over it what makes the robot look like one."""
    base = min(model.base_height_m or model.height_m * 0.55, model.height_m)
    clearance = 0.01
    colour = _rgba(ImageColor.getrgb(model.colour)[:3])
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=(model.radius_m, (base - clearance) / 2, 0),
        pos=(0, 0, (base + clearance) / 2),
        mass=model.mass_kg,
        rgba=(0, 0, 0, 0) if model.legs else colour,  # rays pass what nobody sees: the legs are seen
        **_SOLID,
    )
    forward, height = model.hand_m
    if model.arm_reach_m:
        arm = {"size": (forward / 2, 0.03, 0.03), "pos": (forward / 2, 0, height - 0.03), "mass": 0}
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, rgba=_MARK, **arm, **_SEEN_ONLY)
    if model.legs:
        _add_legs(body, model, colour)
    else:
        _add_mast(body, model, base)


def _add_mast(body: mujoco.MjsBody, model: RobotModel, base_m: float) -> None:
    """A slim body over the base, and a mark that shows where the front is."""
    radius, height = model.radius_m, model.height_m
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=(radius * 0.45, (height - base_m) / 2, 0),
        pos=(0, 0, (height + base_m) / 2),
        mass=0,
        rgba=(0.75, 0.77, 0.8, 1),
        **_SEEN_ONLY,
    )
    slim = model.base_height_m is not None
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=(radius * 0.12, radius * 0.3, height * 0.05),
        pos=(radius * (0.5 if slim else 0.85), 0, height * (0.92 if slim else 0.6)),
        mass=0,
        rgba=_MARK,
        **_SEEN_ONLY,
    )


def _add_legs(body: mujoco.MjsBody, model: RobotModel, colour: tuple[float, ...]) -> None:
    """A long body on four legs, with a dark face."""
    radius, height = model.radius_m, model.height_m
    dark = (0.13, 0.14, 0.16, 1.0)
    parts = [
        ((radius * 0.95, radius * 0.3, height * 0.13), (0.0, 0.0, height * 0.82), colour),
        ((radius * 0.06, radius * 0.28, height * 0.11), (radius * 0.95, 0.0, height * 0.82), dark),
        ((radius * 0.02, radius * 0.12, height * 0.03), (radius * 1.0, 0.0, height * 0.88), _MARK),
    ]
    parts += [
        (
            (radius * 0.1, radius * 0.07, height * 0.35),
            (x * radius * 0.75, y * radius * 0.4, height * 0.36),
            dark,
        )
        for x in (-1, 1)
        for y in (-1, 1)
    ]
    for size, place, rgba in parts:
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=size, pos=place, mass=0, rgba=rgba, **_SEEN_ONLY)


_MARK = (0.95, 0.45, 0.1, 1.0)


def _rgba(rgb: tuple[int, ...]) -> tuple[float, float, float, float]:
    return rgb[0] / 255, rgb[1] / 255, rgb[2] / 255, 1.0
