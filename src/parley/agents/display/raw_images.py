"""Raw pixels as sensor_msgs/Image spells them become pictures: colours in any order, grey, Bayer mosaics."""

from __future__ import annotations

import base64
import binascii

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from parley.errors import InvalidMessageError
from parley.messages.display import RawImage

__all__ = ["RAW_ENCODINGS", "decode_base64", "display_problem", "picture_of"]

_COLOURS: dict[str, tuple[int, ...]] = {
    "rgb8": (0, 1, 2),
    "bgr8": (2, 1, 0),
    "rgba8": (0, 1, 2, 3),
    "bgra8": (2, 1, 0, 3),
    "mono8": (0,),
}
"""Encoding -> where red, green, blue (and alpha) stand in a pixel."""

_MOSAICS: dict[str, str] = {
    "bayer_rggb8": "rggb",
    "bayer_bggr8": "bggr",
    "bayer_gbrg8": "gbrg",
    "bayer_grbg8": "grbg",
}
"""Encoding -> the colours of the upper left two by two pixels, row by row."""

_MONO16 = "mono16"

RAW_ENCODINGS: tuple[str, ...] = (*_COLOURS, _MONO16, *_MOSAICS)
"""Names of `sensor_msgs/image_encodings.hpp` that are understood."""

_NEIGHBOURS = np.array([[1.0, 2.0, 1.0], [2.0, 4.0, 2.0], [1.0, 2.0, 1.0]], np.float32)
"""Weights of bilinear interpolation from pixels two apart."""


def display_problem(field: str, text: str) -> InvalidMessageError:
    """What is wrong with a field of a `DisplayFeed`."""
    return InvalidMessageError("DisplayFeed", field, text)


def picture_of(image: RawImage) -> Image.Image:
    """The pixels as a picture of mode `L`, `RGB` or `RGBA`.

    Of 16-bit grey the upper eight bits are kept. The missing two colours of each pixel of a mosaic are
    interpolated from its neighbours; the one that was measured stays as it is.

    Raises:
        InvalidMessageError: The encoding is unknown, or the data do not fit the size; names the field.
    """
    if (places := _COLOURS.get(image.encoding)) is not None:
        pixels = _rows(image, image.width * len(places)).reshape(image.height, image.width, len(places))
        return Image.fromarray(np.ascontiguousarray(pixels[:, :, places].squeeze()))
    if image.encoding == _MONO16:
        high_byte = 0 if image.is_bigendian else 1
        return Image.fromarray(np.ascontiguousarray(_rows(image, image.width * 2)[:, high_byte::2]))
    if (pattern := _MOSAICS.get(image.encoding)) is not None:
        return Image.fromarray(_demosaic(_rows(image, image.width), pattern))
    raise display_problem(
        "image.encoding", f"{image.encoding!r} is not supported; use one of {', '.join(RAW_ENCODINGS)}"
    )


def decode_base64(text: str, field: str) -> bytes:
    """The bytes of a base64 text, with or without line breaks.

    Raises:
        InvalidMessageError: It is no base64; names `field`.
    """
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        pass
    try:
        # Some encoders break lines.
        return base64.b64decode("".join(text.split()), validate=True)
    except (binascii.Error, ValueError) as error:
        raise display_problem(field, f"not base64: {error}") from error


def _demosaic(raw: NDArray[np.uint8], pattern: str) -> NDArray[np.uint8]:
    """Bilinear: each missing colour is the weighted mean of the nearest pixels that measured it."""
    height, width = raw.shape
    picture = np.empty((height, width, 3), np.uint8)
    values = raw.astype(np.float32)
    for channel, colour in enumerate("rgb"):
        measured = np.zeros(raw.shape, np.float32)
        for place in (index for index, letter in enumerate(pattern) if letter == colour):
            measured[place // 2 :: 2, place % 2 :: 2] = 1.0
        weights, sums = _around(measured), _around(values * measured)
        # A picture one pixel wide or high may not know a colour at all.
        known = np.divide(sums, weights, out=np.zeros_like(sums), where=weights > 0)
        picture[:, :, channel] = np.where(measured > 0, values, np.rint(known))
    return picture


def _around(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """The weighted sum of each pixel and its neighbours; outside of the picture there is nothing."""
    (height, width), wide = values.shape, np.pad(values, 1)
    found = np.zeros_like(values)
    for (row, column), weight in np.ndenumerate(_NEIGHBOURS):
        found += weight * wide[row : row + height, column : column + width]
    return found


def _rows(image: RawImage, row_bytes: int) -> NDArray[np.uint8]:
    """The pixel bytes, shape (height, row_bytes), without what stands behind each row."""
    step = image.step or row_bytes
    if step < row_bytes:
        raise display_problem("image.step", f"{step} bytes are too few for a row of {row_bytes}")
    data = _bytes_of(image.data)
    # The padding of the last row may be missing.
    if not step * (image.height - 1) + row_bytes <= len(data) <= step * image.height:
        raise display_problem(
            "image.data",
            f"expected {step * image.height} bytes ({image.height} rows of {step}), got {len(data)}",
        )
    padded = np.zeros(step * image.height, np.uint8)
    padded[: len(data)] = data
    return padded.reshape(image.height, step)[:, :row_bytes]


def _bytes_of(data: str | list[int]) -> NDArray[np.uint8]:
    if isinstance(data, str):
        return np.frombuffer(decode_base64(data, "image.data"), np.uint8)
    try:
        return np.frombuffer(bytes(data), np.uint8)
    except ValueError as error:
        raise display_problem("image.data", "expected numbers from 0 to 255") from error
