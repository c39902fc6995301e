"""Which things of a group are meant: by number, by place in the row, by distance, so many of them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.group_words import Lead
from parley.language.offline.words.text import Phrase, Word, tokens
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["alike", "chosen", "in_order", "in_series", "labelled", "neighbour", "numbered_from"]


def labelled(kind: Phrase, label: str, objects: Sequence[MapObject]) -> MapObject | None:
    """The thing of a kind that has this number or letter."""
    found = ground_phrase((*kind, Word(label, label)), objects, strict=True)
    return found.candidates[0] if found.outcome == "match" else None


def chosen(items: Sequence[MapObject], lead: Lead, pose: Pose2D | None) -> tuple[MapObject, ...]:
    """Those of a group that the words before its noun mean; empty if that cannot be told.

    Args:
        items: The group.
        lead: What the words say.
        pose: The robot's; the nearest are taken where anybody may choose.
    """
    row = list(items) if lead.listed else in_order(items)
    if lead.parity >= 0:
        row = [
            item for item in row if (number := _number(item)) is not None and lead.parity in {2, number % 2}
        ]
    if lead.every_other:
        row = row[::2]
    if lead.ordinals:
        fitting = [place for place in lead.ordinals if place <= len(row)]
        return tuple(row[place - 1 if place > 0 else -1] for place in fitting) if len(row) > 1 else ()
    if lead.end and lead.count <= len(row):
        return tuple(row[: lead.count] if lead.end == "first" else row[-lead.count :])
    if lead.where == "outer":
        return _outer(row, lead.count)
    count = lead.count or (1 if lead.free else 0)
    if lead.where or (count and (lead.free or (lead.of and not lead.everything)) and count < len(row)):
        return _nearest(row, count, pose, far=lead.where == "far")
    unclear = count and count != len(row)
    return () if unclear else tuple(row)


def _nearest(
    row: Sequence[MapObject], count: int, pose: Pose2D | None, *, far: bool
) -> tuple[MapObject, ...]:
    if pose is None:
        return () if far else tuple(row[:count])
    sign = -1.0 if far else 1.0
    by_way = sorted(row, key=lambda item: sign * math.hypot(item.x_m - pose.x_m, item.y_m - pose.y_m))
    return tuple(by_way[:count])


def _outer(row: Sequence[MapObject], count: int) -> tuple[MapObject, ...]:
    """The two at the ends of a row, wherever it runs."""
    if count != 2 or len(row) < 3:
        return ()
    pairs = [(a, b) for i, a in enumerate(row) for b in row[i + 1 :]]
    return max(pairs, key=lambda pair: math.hypot(pair[0].x_m - pair[1].x_m, pair[0].y_m - pair[1].y_m))


def _number(item: MapObject) -> int | None:
    numbers = [word.key for word in tokens(item.description) if word.key.isdigit()]
    return int(numbers[-1]) if numbers else None


def in_order(items: Sequence[MapObject]) -> list[MapObject]:
    """By number where all have one, else as the map has them."""
    numbers = [_number(item) for item in items]
    if any(number is None for number in numbers):
        return list(items)
    return [item for _, item in sorted(zip(numbers, items, strict=True), key=lambda pair: pair[0] or 0)]


def neighbour(items: Sequence[MapObject], of: MapObject, way: int) -> MapObject | None:
    """The thing before (`way` -1) or after one of its kind: by number, else along the row they stand in."""
    number = _number(of)
    if number is not None:
        numbered = [item for item in items if _number(item) == number + way]
        return numbered[0] if len(numbered) == 1 else None
    row = _along(items)
    at = row.index(of) + way
    # Without numbers a row has two ends: only its direction from left to right is told apart.
    return row[at] if 0 <= at < len(row) else None


def _along(items: Sequence[MapObject]) -> list[MapObject]:
    """Things in the order in which they stand, along the longer side of what they cover."""
    width_m = max(i.x_m for i in items) - min(i.x_m for i in items)
    height_m = max(i.y_m for i in items) - min(i.y_m for i in items)
    return sorted(items, key=lambda i: i.x_m if width_m >= height_m else i.y_m)


def numbered_from(items: Sequence[MapObject], low: int, high: int) -> tuple[MapObject, ...]:
    """Those whose number is not below `low` and not above `high`, in order."""
    return tuple(i for i in in_order(items) if (number := _number(i)) is not None and low <= number <= high)


def in_series(items: Sequence[MapObject]) -> tuple[tuple[MapObject, ...], ...]:
    """Those that differ in nothing but a number or letter ("room 1", "room 2", no cloakroom), by name."""
    series: dict[tuple[str, ...], list[MapObject]] = {}
    for item in items:
        words = item.description.lower().split()
        if len(words) > 1 and (words[-1].isdigit() or len(words[-1]) == 1):
            series.setdefault(tuple(words[:-1]), []).append(item)
    return tuple(tuple(one) for one in series.values())


def alike(items: tuple[MapObject, ...], before: Sequence[MapObject]) -> tuple[MapObject, ...]:
    """Of some things those of the kind that was spoken of ("rooms 1 and 2. Now the others"), or all."""
    kinds = {item.class_name for item in before}
    same = tuple(item for item in items if item.class_name in kinds)
    return same if same and len(kinds) == 1 else items
