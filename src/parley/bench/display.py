"""How many pictures a second pass through the real display interface, and how long one takes."""

from __future__ import annotations

import asyncio
import base64
import io
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from PIL import Image

from parley.agents.display.display_interface import DisplayInterface
from parley.clock import WallClock
from parley.messages import topics
from parley.messages.display import DisplayFeed, RawImage
from parley.messages.ros import CompressedImage
from parley.messages.topics import display_topic
from parley.messages.wire import to_string
from parley.transport.local import LocalTransport

__all__ = ["DisplayFigures", "measure_display"]

SIZE_PX: Final = (640, 480)
_PATIENCE_S: Final = 30.0


@dataclass(frozen=True, slots=True)
class DisplayFigures:
    """One kind of picture, measured in this process."""

    kind: str
    frames: int
    wall_s: float
    cpu_s: float
    """Of the whole process: sender, display interface and receiver."""
    latency_ms: tuple[float, ...]
    """From sending a picture to having its JPEG."""

    @property
    def frames_per_s(self) -> float:
        """Of wall time, one picture after the other."""
        return self.frames / self.wall_s

    @property
    def frames_per_core_s(self) -> float:
        """Of processor time."""
        return self.frames / self.cpu_s


async def measure_display(frames: int) -> list[DisplayFigures]:
    """Send pictures of 640 x 480, each as soon as the one before came out.

    Args:
        frames: How many of each kind.
    """
    return [await _measure(kind, image, frames) for kind, image in _pictures().items()]


def _pictures() -> Mapping[str, str | RawImage]:
    """A scene with edges, gradients and noise, as what robots send."""
    width, height = SIZE_PX
    x, y = np.meshgrid(np.linspace(0, 255, width), np.linspace(0, 255, height))
    noise = np.random.default_rng(0).integers(0, 20, (height, width, 3))
    checks = ((x // 32 + y // 32) % 2 * 60)[..., None]
    pixels = np.clip(np.stack([x, y, 255 - x], axis=-1) * 0.7 + checks + noise, 0, 255).astype(np.uint8)
    picture = Image.fromarray(pixels)
    raw = base64.b64encode(pixels.tobytes()).decode()
    return {
        "jpeg_untouched": _encoded(picture, "JPEG"),
        "png": _encoded(picture, "PNG"),
        "rgb8": RawImage(data=raw, width=width, height=height, encoding="rgb8"),
    }


def _encoded(picture: Image.Image, kind: str) -> str:
    buffer = io.BytesIO()
    picture.save(buffer, kind)
    return base64.b64encode(buffer.getvalue()).decode()


async def _measure(kind: str, image: str | RawImage, frames: int) -> DisplayFigures:
    came = asyncio.Event()
    latency_ms: list[float] = []
    message = to_string(DisplayFeed(target="A", name="camera", image=image))

    def receive(_: CompressedImage) -> None:
        came.set()

    async with LocalTransport() as transport, DisplayInterface(transport, WallClock(), min_interval_s=0.0):
        await transport.subscribe(display_topic("A", "camera"), receive)
        sender = transport.publisher(topics.DISPLAY_FEED)
        wall_s, cpu_s = time.perf_counter(), time.process_time()
        for _ in range(frames):
            came.clear()
            sent_s = time.perf_counter()
            sender.publish(message)
            await asyncio.wait_for(came.wait(), _PATIENCE_S)
            latency_ms.append(1000 * (time.perf_counter() - sent_s))
        return DisplayFigures(
            kind, frames, time.perf_counter() - wall_s, time.process_time() - cpu_s, tuple(latency_ms)
        )
