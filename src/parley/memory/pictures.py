"""Pictures that are to be remembered: checked before anything trusts them, and brought to a modest size."""

from __future__ import annotations

import base64
import binascii
import io
from typing import Any, Final

from PIL import Image, ImageOps, UnidentifiedImageError

__all__ = [
    "JPEG_QUALITY",
    "MAX_BYTES",
    "MAX_PICTURES",
    "MAX_PIXELS",
    "MAX_SIDE",
    "PictureError",
    "check_picture",
    "modest_jpeg",
    "pixels_to_jpeg",
]

MAX_BYTES: Final = 5 * 1024 * 1024
"""Of one picture as it comes; four of them fit one message."""
MAX_PICTURES: Final = 4
"""With one message."""
MAX_PIXELS: Final = 40_000_000
"""More are refused before they are unpacked: a small file can hold a huge empty picture."""
MAX_SIDE: Final = 1280
"""Pixels; the longer side of what is kept is at most this."""
JPEG_QUALITY: Final = 85


_TOO_MANY: Final = f"the picture has too many points (more than {MAX_PIXELS // 1_000_000} million)"


class PictureError(ValueError):
    """A picture cannot be used; the text says why in plain words."""


def modest_jpeg(data: str) -> str:
    """A picture from outside as one to be kept: JPEG, upright, at most `MAX_SIDE`, without hidden notes.

    Takes tens of milliseconds: call it in a thread.

    Args:
        data: Base64 of a JPEG or PNG.

    Returns:
        Base64 of a JPEG.

    Raises:
        PictureError: It is no picture, of another kind, or too large.
    """
    picture = _opened(_unpacked(data))
    try:
        upright = ImageOps.exif_transpose(picture)
        return _jpeg(upright)
    except (OSError, ValueError, SyntaxError) as error:
        raise PictureError("the picture is damaged") from error


def pixels_to_jpeg(pixels: Any) -> str:
    """A camera's picture (rows x columns x RGB, 8 bits) as base64 of a JPEG of at most `MAX_SIDE`."""
    return _jpeg(Image.fromarray(pixels))


def check_picture(data: str) -> str:
    """What is wrong with a picture, without unpacking all of it; empty if nothing is."""
    try:
        _opened(_unpacked(data))
    except PictureError as error:
        return str(error)
    return ""


def _unpacked(data: str) -> bytes:
    text = data.partition(",")[2] if data.startswith("data:") else data
    if len(text) > MAX_BYTES * 4 // 3 + 4:
        raise PictureError(f"the picture is too large (more than {MAX_BYTES // 1024 // 1024} MB)")
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError) as error:
        raise PictureError("the picture did not arrive whole") from error


def _opened(content: bytes) -> Image.Image:
    try:
        picture = Image.open(io.BytesIO(content), formats=("JPEG", "PNG"))
    except UnidentifiedImageError as error:
        raise PictureError("it is not a JPEG or PNG picture") from error
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise PictureError(_TOO_MANY) from error
    except (OSError, ValueError, SyntaxError) as error:
        raise PictureError("the picture is damaged") from error
    if picture.width * picture.height > MAX_PIXELS:
        raise PictureError(_TOO_MANY)
    return picture


def _jpeg(picture: Image.Image) -> str:
    picture.thumbnail((MAX_SIDE, MAX_SIDE))
    if picture.mode in ("RGBA", "LA", "PA") or "transparency" in picture.info:
        layered = picture.convert("RGBA")
        picture = Image.new("RGB", layered.size, "white")
        picture.paste(layered, mask=layered.getchannel("A"))
    buffer = io.BytesIO()
    picture.convert("RGB").save(buffer, format="JPEG", quality=JPEG_QUALITY)
    return base64.b64encode(buffer.getvalue()).decode("ascii")
