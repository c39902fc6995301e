"""Every picture of a display feed becomes a JPEG. Pure functions; the heavy ones belong in a thread."""

from __future__ import annotations

import base64
import binascii
import io
import struct
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from parley.errors import InvalidMessageError
from parley.messages.display import RawImage

__all__ = ["MAX_PIXELS", "MAX_SIDE_PX", "RAW_ENCODINGS", "to_jpeg"]

MAX_SIDE_PX = 8192
MAX_PIXELS = 40_000_000
"""A small file can claim to be a huge picture; nothing larger is unpacked."""

RAW_ENCODINGS: dict[str, tuple[int, ...]] = {
    "rgb8": (0, 1, 2),
    "bgr8": (2, 1, 0),
    "rgba8": (0, 1, 2, 3),
    "bgra8": (2, 1, 0, 3),
    "mono8": (0,),
}
"""sensor_msgs encoding -> where red, green, blue (and alpha) stand in a pixel."""

_BASELINE_FRAMES = (0xC0, 0xC1)
_OTHER_FRAMES = frozenset(range(0xC2, 0xD0)) - {0xC4, 0xC8, 0xCC}


def to_jpeg(image: str | RawImage, *, quality: int = 85) -> bytes:
    """The picture as a JPEG that every browser shows.

    A base64 text that holds a plain JPEG comes back untouched; other JPEGs and PNGs are encoded anew.

    Args:
        image: Base64 of a JPEG or PNG (a ``data:`` address is understood too), or raw pixels.
        quality: JPEG quality, where encoding is needed.

    Raises:
        InvalidMessageError: It is not such a picture or too large; names the field of the `DisplayFeed`.
    """
    if isinstance(image, RawImage):
        return _encode(_raw(image), quality)
    data = _base64(image.partition(",")[2] if image.startswith("data:") else image, "image")
    if _is_plain_jpeg(data):
        return data
    return _encode(_unpack(data), quality)


def _problem(field: str, text: str) -> InvalidMessageError:
    return InvalidMessageError("DisplayFeed", field, text)


def _base64(text: str, field: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        pass
    try:
        # Some encoders break lines.
        return base64.b64decode("".join(text.split()), validate=True)
    except (binascii.Error, ValueError) as error:
        raise _problem(field, f"not base64: {error}") from error


def _check_size(width: int, height: int, field: str) -> None:
    if not (0 < width <= MAX_SIDE_PX and 0 < height <= MAX_SIDE_PX and width * height <= MAX_PIXELS):
        raise _problem(
            field,
            f"{width} x {height} pixels; a side may have at most {MAX_SIDE_PX} and a picture {MAX_PIXELS}",
        )


def _is_plain_jpeg(data: bytes) -> bool:
    """Whether this is a whole baseline JPEG with 8 bits and one or three colours, judged by its markers."""
    if not data.startswith(b"\xff\xd8") or b"\xff\xd9" not in data[-64:]:
        return False
    for marker, body in _segments(data):
        if marker in _BASELINE_FRAMES and len(body) >= 6:
            precision, height, width, colours = struct.unpack_from(">BHHB", body)
            _check_size(width, height, "image")
            return precision == 8 and colours in (1, 3)
        if marker in _OTHER_FRAMES:
            return False
    return False


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
        raise _problem(
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


def _raw(image: RawImage) -> Image.Image:
    places = RAW_ENCODINGS.get(image.encoding)
    if places is None:
        raise _problem(
            "image.encoding", f"{image.encoding!r} is not supported; use one of {', '.join(RAW_ENCODINGS)}"
        )
    _check_size(image.width, image.height, "image.width")
    pixels = _raw_bytes(image, row_bytes=image.width * len(places))
    picture = pixels.reshape(image.height, image.width, len(places))[:, :, places]
    return _to_rgb(
        Image.fromarray(np.ascontiguousarray(picture.squeeze(axis=2) if len(places) == 1 else picture))
    )


def _raw_bytes(image: RawImage, *, row_bytes: int) -> NDArray[np.uint8]:
    """The pixel bytes without what stands behind each row."""
    step = image.step or row_bytes
    if step < row_bytes:
        raise _problem("image.step", f"{step} bytes are too few for a row of {row_bytes}")
    data = _bytes_of(image.data)
    # The padding of the last row may be missing.
    if not step * (image.height - 1) + row_bytes <= len(data) <= step * image.height:
        raise _problem(
            "image.data",
            f"expected {step * image.height} bytes ({image.height} rows of {step}), got {len(data)}",
        )
    padded = np.zeros(step * image.height, np.uint8)
    padded[: len(data)] = data
    return padded.reshape(image.height, step)[:, :row_bytes]


def _bytes_of(data: str | list[int]) -> NDArray[np.uint8]:
    if isinstance(data, str):
        return np.frombuffer(_base64(data, "image.data"), np.uint8)
    try:
        return np.frombuffer(bytes(data), np.uint8)
    except ValueError as error:
        raise _problem("image.data", "expected numbers from 0 to 255") from error


def _encode(picture: Image.Image, quality: int) -> bytes:
    out = io.BytesIO()
    picture.save(out, "JPEG", quality=quality)
    return out.getvalue()
