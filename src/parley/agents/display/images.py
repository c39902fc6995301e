"""Every picture of a display feed becomes a JPEG. Pure functions; the heavy ones belong in a thread."""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator

import numpy as np
from PIL import Image

from parley.agents.display.raw_images import RAW_ENCODINGS, decode_base64, display_problem, picture_of
from parley.errors import InvalidMessageError
from parley.messages.display import RawImage

__all__ = ["MAX_PIXELS", "MAX_SIDE_PX", "to_jpeg"]

MAX_SIDE_PX = 8192
MAX_PIXELS = 40_000_000
"""A small file can claim to be a huge picture; nothing larger is unpacked."""

_BASELINE_FRAMES = (0xC0, 0xC1)
_OTHER_FRAMES = frozenset(range(0xC2, 0xD0)) - {0xC4, 0xC8, 0xCC}


def to_jpeg(image: str | RawImage, *, quality: int = 85, max_width_px: int | None = None) -> bytes:
    """The picture as a JPEG that every browser shows.

    A plain JPEG, as base64, that is not too wide comes back untouched; the rest is encoded anew.

    Args:
        image: Base64 of a JPEG or PNG (a ``data:`` address is understood too), or raw pixels.
        quality: JPEG quality, where encoding is needed.
        max_width_px: Wider pictures are made smaller, keeping their shape.

    Raises:
        InvalidMessageError: It is not such a picture or too large; names the field of the `DisplayFeed`.
    """
    if isinstance(image, RawImage):
        _check_size(image.width, image.height, "image.width")
        return _encode(_narrowed(_to_rgb(picture_of(image)), max_width_px), quality)
    data = decode_base64(image.partition(",")[2] if image.startswith("data:") else image, "image")
    width = _plain_jpeg_width(data)
    if width is not None and (max_width_px is None or width <= max_width_px):
        return data
    return _encode(_narrowed(_unpack(data), max_width_px), quality)


def _check_size(width: int, height: int, field: str) -> None:
    if not (0 < width <= MAX_SIDE_PX and 0 < height <= MAX_SIDE_PX and width * height <= MAX_PIXELS):
        raise display_problem(
            field,
            f"{width} x {height} pixels; a side may have at most {MAX_SIDE_PX} and a picture {MAX_PIXELS}",
        )


def _plain_jpeg_width(data: bytes) -> int | None:
    """Width of a whole baseline JPEG with 8 bits and one or three colours, by its markers; else None."""
    if not data.startswith(b"\xff\xd8") or b"\xff\xd9" not in data[-64:]:
        return None
    for marker, body in _segments(data):
        if marker in _BASELINE_FRAMES and len(body) >= 6:
            precision, height, width, colours = struct.unpack_from(">BHHB", body)
            _check_size(width, height, "image")
            return int(width) if precision == 8 and colours in (1, 3) else None
        if marker in _OTHER_FRAMES:
            return None
    return None


def _segments(data: bytes) -> Iterator[tuple[int, bytes]]:
    """The marker segments of a JPEG up to its compressed data."""
    at = 2
    while at + 4 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker == 0xFF:
            at += 1
            continue
        (length,) = struct.unpack_from(">H", data, at + 2)
        if marker == 0xDA or length < 2:
            return
        yield marker, data[at + 4 : at + 2 + length]
        at += 2 + length


def _unpack(data: bytes) -> Image.Image:
    try:
        picture = Image.open(io.BytesIO(data), formats=("PNG", "JPEG"))
        _check_size(*picture.size, "image")
        picture.load()
    except InvalidMessageError:
        raise
    except Exception as error:
        # Broken files make the decoders raise nearly anything; to the sender it is one thing.
        raise display_problem(
            "image",
            f"not a readable JPEG or PNG ({error}); send one of these as base64, or an object with data, "
            f"height, width and encoding ({', '.join(RAW_ENCODINGS)})",
        ) from error
    return _to_rgb(picture)


def _to_rgb(picture: Image.Image) -> Image.Image:
    """Three 8-bit colours; what is transparent shows white, 16-bit grey keeps its upper bits."""
    if picture.mode.startswith("I"):
        grey = np.asarray(picture).astype(np.uint32) >> 8
        return Image.fromarray(grey.astype(np.uint8))
    if picture.mode in ("RGBA", "LA", "PA") or "transparency" in picture.info:
        picture = picture.convert("RGBA")
        page = Image.new("RGBA", picture.size, "white")
        return Image.alpha_composite(page, picture).convert("RGB")
    return picture if picture.mode in ("RGB", "L") else picture.convert("RGB")


def _encode(picture: Image.Image, quality: int) -> bytes:
    out = io.BytesIO()
    picture.save(out, "JPEG", quality=quality)
    return out.getvalue()


def _narrowed(picture: Image.Image, max_width_px: int | None) -> Image.Image:
    if max_width_px is None or picture.width <= max_width_px:
        return picture
    height_px = max(1, round(picture.height * max_width_px / picture.width))
    return picture.resize((max_width_px, height_px), Image.Resampling.BILINEAR)
