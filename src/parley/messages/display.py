"""`display_feed` payloads (thesis 4.3.9.1): a finished picture as base64, or raw pixels."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from parley.messages.base import Payload

__all__ = ["DisplayFeed", "RawImage"]


class RawImage(Payload):
    """Uncompressed pixels as sensor_msgs/Image spells them."""

    data: str | list[int] = Field(repr=False)
    """Base64 text, or the bytes as numbers (the thesis's actions send both)."""
    height: int = Field(gt=0, le=8192)
    width: int = Field(gt=0, le=8192)
    encoding: str
    """sensor_msgs encoding: `rgb8`, `bgr8`, `rgba8`, `bgra8`, `mono8`, `mono16`, `bayer_rggb8`, ..."""
    step: int | None = Field(default=None, ge=0)
    """Bytes per row; absent means tightly packed."""
    is_bigendian: int = Field(default=0, ge=0, le=1)
    """Whether 16-bit values have their upper byte first (sensor_msgs)."""


class DisplayFeed(Payload):
    """One picture of one feed of one robot."""

    target: str = Field(min_length=1)
    name: str = Field(min_length=1)
    image: str | RawImage = Field(repr=False)
    info: dict[str, Any] = Field(default_factory=dict)
