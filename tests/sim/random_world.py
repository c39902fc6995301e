"""Worlds with made-up names: whoever does its job in them cannot know a story by heart.

Every world has two rooms, a holder with an open front in which an item stands that no map knows, twins that
differ only in size, and a few other things. Names, places and sizes come from the seed.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import Any

import yaml

from parley.sim.world_file import WorldFile

__all__ = ["RandomWorld", "random_world"]

_SYLLABLES = ("bo", "da", "fe", "gu", "ka", "lo", "mi", "nu", "pe", "ra", "su", "ti", "vo", "wa", "zi")
_COLOURS = ("red", "blue", "yellow", "purple", "orange")

# Places along the walls of an 8 x 5 m house, with the direction into the room: none in front of the other.
_PLACES = (
    (1.2, 4.55, -math.pi / 2), (2.8, 4.55, -math.pi / 2), (0.45, 2.5, 0.0), (2.2, 0.45, math.pi / 2),
    (5.0, 4.55, -math.pi / 2), (6.8, 4.55, -math.pi / 2), (7.55, 2.4, math.pi), (5.6, 0.45, math.pi / 2),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class RandomWorld:
    """A world and the words by which people would speak of it."""

    world: WorldFile
    robot: str
    """Name of the robot."""
    holder: str
    """Description of the thing with the open front; its id is `holder_id`."""
    holder_id: str
    item: str
    """What stands in the holder, as a detector calls it; its name in the world is `item_id`."""
    item_id: str
    twin_class: str
    """What the two alike things are called, without their size."""
    small_twin_id: str
    large_twin_id: str
    others: tuple[str, ...]
    """Descriptions of everything else on the object map."""


def random_world(seed: int) -> RandomWorld:
    """A world that the same seed always gives again."""
    rng = random.Random(seed)
    names: set[str] = set()
    while len(names) < 7:
        names.add("".join(rng.sample(_SYLLABLES, 3)))
    robot, holder, item, twin, *others = rng.sample(sorted(names), 7)
    places = rng.sample(_PLACES, 6)
    item_label = f"{rng.choice(_COLOURS)} {item}"
    things = [
        _thing(f"{holder}_1", holder, holder, places[0], _holder_parts()),
        _item(f"{item}_1", item, item_label, f"{holder}_1", rng),
        _thing(f"{twin}_1", twin, f"small {twin}", places[1], _block(rng, 0.6)),
        _thing(f"{twin}_2", twin, f"large {twin}", places[2], _block(rng, 1.2)),
        *(
            _thing(f"{name}_1", name, name, place, _block(rng, 0.5))
            for name, place in zip(others, places[3:], strict=True)
        ),
    ]
    document = {
        "name": f"random {seed}",
        "walls": [
            {"from": [0, 0], "to": [8, 0]},
            {"from": [8, 0], "to": [8, 5]},
            {"from": [8, 5], "to": [0, 5]},
            {"from": [0, 5], "to": [0, 0]},
            {"from": [3.8, 0], "to": [3.8, 5], "doorways": [{"at_m": rng.uniform(1.2, 3.6), "width_m": 1.0}]},
        ],
        "things": things,
        "robots": [
            {
                "name": robot.capitalize(),
                "model": "turtlebot3_waffle",
                "pose": [rng.choice((1.8, 5.8)), 2.4, rng.uniform(-math.pi, math.pi)],
            }
        ],
    }
    return RandomWorld(
        world=WorldFile.parse(yaml.safe_dump(document), file=f"random world {seed}"),
        robot=robot.capitalize(),
        holder=holder,
        holder_id=f"{holder}_1",
        item=item_label,
        item_id=f"{item}_1",
        twin_class=twin,
        small_twin_id=f"{twin}_1",
        large_twin_id=f"{twin}_2",
        others=tuple(others),
    )


def _thing(
    name: str,
    class_name: str,
    description: str,
    place: tuple[float, float, float],
    parts: list[dict[str, Any]],
) -> dict[str, Any]:
    return {
        "name": name,
        "class": class_name,
        "description": description,
        "pose": list(place),
        "front_rad": 0.0,
        "parts": parts,
    }


def _item(name: str, class_name: str, label: str, holder: str, rng: random.Random) -> dict[str, Any]:
    colour = label.split()[0]
    return {
        "name": name,
        "class": class_name,
        "description": label,
        "inside": holder,
        "pose": [rng.uniform(-0.05, 0.1), rng.uniform(-0.15, 0.15), 0.0],
        "z_m": 0.14,
        "listed": False,
        "mapped": False,
        "parts": [{"shape": "cylinder", "size_m": [0.09, 0.09, 0.22], "colour": colour}],
    }


def _holder_parts() -> list[dict[str, Any]]:
    """A case open towards its own x."""
    return [
        {"size_m": [0.04, 0.7, 1.0], "at_m": [-0.28, 0, 0], "colour": "white"},
        {"size_m": [0.6, 0.04, 1.0], "at_m": [0, 0.33, 0], "colour": "white"},
        {"size_m": [0.6, 0.04, 1.0], "at_m": [0, -0.33, 0], "colour": "white"},
        {"size_m": [0.6, 0.7, 0.06], "at_m": [0, 0, 0.08], "colour": "white"},
        {"size_m": [0.6, 0.7, 0.06], "at_m": [0, 0, 0.94], "colour": "white"},
    ]


def _block(rng: random.Random, width_m: float) -> list[dict[str, Any]]:
    height_m = rng.uniform(0.35, 0.9)
    return [{"size_m": [0.5, width_m, height_m], "colour": rng.choice(_COLOURS)}]
