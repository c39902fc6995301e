"""Which pictures there are to be seen, and the newest of each feed. No loop, no clock."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from PIL import Image

from parley.messages.ros import CompressedImage
from parley.web.models import Change, FeedChange, FeedInfo

__all__ = ["CONTINUOUS_WITHIN_MS", "FeedBook", "Picture"]

CONTINUOUS_WITHIN_MS: Final = 2000
"""Three pictures that follow each other as quickly as this make a feed a continuous one."""

Key = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Picture:
    """The newest picture of a feed."""

    data: bytes
    unix_ms: int
    """When it was taken, by its stamp."""
    number: int
    """Counts the pictures of the feed."""


class FeedBook:
    """All feeds by robot and name.

    Args:
        emit: Gets each change.
    """

    def __init__(self, emit: Callable[[Change], None]) -> None:
        self._emit = emit
        self.infos: dict[Key, FeedInfo] = {}
        self.pictures: dict[Key, Picture] = {}
        self._quick: dict[Key, int] = {}

    def announce(self, robot: str, name: str, *, continuous: bool = False) -> None:
        """A feed exists, whether or not a picture came yet."""
        key = (robot, name)
        if key not in self.infos:
            self._put(FeedInfo(robot=robot, name=name, continuous=continuous))

    def on_picture(self, robot: str, name: str, message: CompressedImage) -> Picture:
        """A picture came."""
        key = (robot, name)
        stamp = message.header.stamp
        unix_ms = stamp.sec * 1000 + stamp.nanosec // 1_000_000
        before = self.pictures.get(key)
        info = self.infos.get(key) or FeedInfo(robot=robot, name=name)
        if before is not None and unix_ms - before.unix_ms <= CONTINUOUS_WITHIN_MS:
            self._quick[key] = self._quick.get(key, 0) + 1
        width, height = (info.width, info.height)
        if before is None or len(before.data) != len(message.data):
            width, height = _size(message.data) or (width, height)
        self.pictures[key] = picture = Picture(message.data, unix_ms, before.number + 1 if before else 1)
        self._put(
            info.model_copy(
                update={
                    "continuous": info.continuous or self._quick.get(key, 0) >= 2,
                    "width": width,
                    "height": height,
                    "last_unix_ms": unix_ms,
                }
            )
        )
        return picture

    def _put(self, info: FeedInfo) -> None:
        """Keep `info`; a new picture alone is no change worth telling, but the first one is."""
        key = (info.robot, info.name)
        before = self.infos.get(key)
        self.infos[key] = info
        is_old = before is not None and (before.last_unix_ms > 0) == (info.last_unix_ms > 0)
        if (
            before is None
            or not is_old
            or before.model_copy(update={"last_unix_ms": info.last_unix_ms}) != info
        ):
            self._emit(FeedChange(seq=0, feed=info))


def _size(data: bytes) -> tuple[int, int] | None:
    try:
        with Image.open(io.BytesIO(data)) as picture:
            return picture.size
    except (OSError, Image.DecompressionBombError):
        return None
