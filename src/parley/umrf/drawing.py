"""A small layered drawing of boxes and arrows as SVG: no library, the same picture every time.

Boxes get a layer by the longest way from the first; arrows that lead backwards are drawn around the side.
Inside a layer boxes stand near the middle of those that lead to them.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar
from xml.sax.saxutils import escape

__all__ = ["draw_svg"]

K = TypeVar("K", bound=Hashable)

_CHARACTER: Final = 7.3
"""Width of a character of 12 px monospaced text, in px."""
_LABEL_CHARACTER: Final = 6.1
_LINE: Final = 16.0
_PADDING: Final = 10.0
_GAP_X: Final = 40.0
_GAP_Y: Final = 64.0
_MARGIN: Final = 24.0
_SWEEPS: Final = 4
_NO_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(slots=True)
class _Box:
    lines: tuple[str, ...]
    fill: str
    x: float = 0.0
    y: float = 0.0

    @property
    def width(self) -> float:
        return max(60.0, max(map(len, self.lines)) * _CHARACTER + 2 * _PADDING)

    @property
    def height(self) -> float:
        return len(self.lines) * _LINE + _PADDING

    @property
    def middle(self) -> float:
        return self.x + self.width / 2


def draw_svg(
    title: str,
    boxes: Mapping[K, tuple[tuple[str, ...], str]],
    arrows: Sequence[tuple[K, K, str]],
    *,
    first: K,
    last: K,
) -> str:
    """The picture.

    Args:
        title: What it shows, for whoever cannot see it.
        boxes: Lines of text (at least one) and background colour by key.
        arrows: From, to, label; both ends are among the boxes.
        first: Stands at the top.
        last: Stands at the bottom.
    """
    placed = {key: _Box(lines, fill) for key, (lines, fill) in boxes.items()}
    backward = _backward(list(placed), arrows, first)
    forward = [(one, other) for one, other, _ in arrows if (one, other) not in backward]
    layers = _layers(list(placed), forward, last)
    _order(layers, forward)
    labels = max((len(label) for _, _, label in arrows), default=0) * _LABEL_CHARACTER
    width, height = _place(layers, placed, labels)
    body = [
        *_arrows(placed, arrows, backward, width),
        *(line for key, box in placed.items() for line in _box(box, rounded=key in (first, last))),
    ]
    width += 60.0 if backward else 0.0
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" role="img" font-family="monospace" font-size="12">\n'
        f"<title>{_text(title)}</title>\n"
        '<defs><marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" '
        'orient="auto-start-reverse"><path d="M0 0L10 5L0 10z" fill="#455a64"/></marker></defs>\n'
        '<rect width="100%" height="100%" fill="#ffffff"/>\n' + "\n".join(body) + "\n</svg>\n"
    )


def _backward(keys: list[K], arrows: Sequence[tuple[K, K, str]], first: K) -> set[tuple[K, K]]:
    """The arrows that close a cycle, as met on a depth-first walk."""
    after: dict[K, list[K]] = {key: [] for key in keys}
    for one, other, _ in arrows:
        after[one].append(other)
    found: set[tuple[K, K]] = set()
    open_, done = set[K](), set[K]()
    for start in [first, *keys]:
        if start in done:
            continue
        open_.add(start)
        walk = [(start, iter(after[start]))]
        while walk:
            at, rest = walk[-1]
            target = next(rest, None)
            if target is None:
                walk.pop()
                open_.discard(at)
                done.add(at)
            elif target in open_:
                found.add((at, target))
            elif target not in done:
                open_.add(target)
                walk.append((target, iter(after[target])))
    return found


def _layers(keys: list[K], forward: list[tuple[K, K]], last: K) -> list[list[K]]:
    before: dict[K, int] = dict.fromkeys(keys, 0)
    after: dict[K, list[K]] = {key: [] for key in keys}
    for one, other in forward:
        before[other] += 1
        after[one].append(other)
    level = dict.fromkeys(keys, 0)
    ready = [key for key in keys if before[key] == 0]
    while ready:
        at = ready.pop()
        for target in after[at]:
            level[target] = max(level[target], level[at] + 1)
            before[target] -= 1
            if before[target] == 0:
                ready.append(target)
    level[last] = max([*level.values(), 0]) + (0 if _alone(level, last) else 1)
    layers: list[list[K]] = [[] for _ in range(max(level.values()) + 1)]
    for key in keys:
        layers[level[key]].append(key)
    return [layer for layer in layers if layer]


def _alone(level: Mapping[K, int], last: K) -> bool:
    """Whether `last` has the lowest layer for itself already."""
    lowest = max(level.values())
    return [key for key, at in level.items() if at == lowest] == [last]


def _order(layers: list[list[K]], forward: list[tuple[K, K]]) -> None:
    """Put each box near the mean place of those it hangs together with, downwards and upwards by turns."""
    above: dict[K, list[K]] = {}
    below: dict[K, list[K]] = {}
    for one, other in forward:
        above.setdefault(other, []).append(one)
        below.setdefault(one, []).append(other)
    for sweep in range(_SWEEPS):
        near = above if sweep % 2 == 0 else below
        place = {key: index / max(1, len(layer)) for layer in layers for index, key in enumerate(layer)}
        for layer in layers if sweep % 2 == 0 else reversed(layers):
            means = {
                key: sum(place[item] for item in near[key]) / len(near[key]) if key in near else place[key]
                for key in layer
            }
            layer.sort(key=means.__getitem__)
            place |= {key: index / len(layer) for index, key in enumerate(layer)}


def _place(layers: list[list[K]], boxes: Mapping[K, _Box], min_width: float) -> tuple[float, float]:
    """Give every box its coordinates, in px; the size of the picture, at least `min_width` wide."""
    widths = [sum(boxes[key].width for key in layer) + _GAP_X * (len(layer) - 1) for layer in layers]
    widest, y = max(*widths, min_width), _MARGIN
    for layer, width in zip(layers, widths, strict=True):
        x = _MARGIN + (widest - width) / 2
        for key in layer:
            boxes[key].x, boxes[key].y = x, y
            x += boxes[key].width + _GAP_X
        y += max(boxes[key].height for key in layer) + _GAP_Y
    return widest + 2 * _MARGIN, y - _GAP_Y + _MARGIN


def _arrows(
    boxes: Mapping[K, _Box],
    arrows: Sequence[tuple[K, K, str]],
    backward: set[tuple[K, K]],
    width: float,
) -> Iterator[str]:
    for one, other, label in arrows:
        start, end = boxes[one], boxes[other]
        y0, y1 = start.y + start.height, end.y
        if (one, other) in backward:
            x0, x1, side = start.x + start.width, end.x + end.width, width + 24.0
            y0, y1 = start.y + start.height / 2, end.y + end.height / 2
            path = f"M{x0:.1f} {y0:.1f}C{side:.1f} {y0:.1f} {side:.1f} {y1:.1f} {x1:.1f} {y1:.1f}"
            at, anchor = (width + 40.0, (y0 + y1) / 2), "end"
        else:
            bend = max(24.0, (y1 - y0) / 2)
            x0, x1 = start.middle, end.middle
            path = f"M{x0:.1f} {y0:.1f}C{x0:.1f} {y0 + bend:.1f} {x1:.1f} {y1 - bend:.1f} {x1:.1f} {y1:.1f}"
            at, anchor = ((x0 + x1) / 2, (y0 + y1) / 2), "middle"
        yield f'<path d="{path}" fill="none" stroke="#455a64" marker-end="url(#tip)"/>'
        if label:
            yield (
                f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" font-size="10" fill="#37474f" '
                f'stroke="#ffffff" stroke-width="3" paint-order="stroke">{_text(label)}</text>'
            )


def _box(box: _Box, *, rounded: bool) -> Iterator[str]:
    yield (
        f'<rect x="{box.x:.1f}" y="{box.y:.1f}" width="{box.width:.1f}" height="{box.height:.1f}" '
        f'rx="{12 if rounded else 4}" fill="{box.fill}" stroke="#455a64"/>'
    )
    for index, line in enumerate(box.lines):
        weight = ' font-weight="bold"' if index == 0 else ""
        yield (
            f'<text x="{box.middle:.1f}" y="{box.y + _PADDING / 2 + _LINE * (index + 0.75):.1f}" '
            f'text-anchor="middle" fill="#102027"{weight}>{_text(line)}</text>'
        )


def _text(text: str) -> str:
    return escape(_NO_XML.sub("\ufffd", text))
