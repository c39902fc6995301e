"""Pictures that people upload: looked at before anybody takes them on."""

from __future__ import annotations

import base64
import binascii
import io
from typing import Final

from PIL import Image

from parley.messages.chat import ChatImage
from parley.web.bodies import ImageUpload
from parley.web.problems import WebProblem
from parley.web.store import KeptPicture

__all__ = ["MAX_PIXELS", "checked_image", "kept_picture", "read_image"]

MAX_PIXELS: Final = 40_000_000
"""A small file can claim to be a huge picture; nobody should have to unpack one."""
_SIGNATURES: Final = ((b"\xff\xd8\xff", "image/jpeg"), (b"\x89PNG\r\n\x1a\n", "image/png"))


def read_image(text: str) -> tuple[bytes, str]:
    """The bytes and the media type of a picture in base64.

    Raises:
        WebProblem: It is neither a JPEG nor a PNG.
    """
    try:
        data = base64.b64decode(text.partition(",")[2] if text.startswith("data:") else text, validate=True)
    except (binascii.Error, ValueError):
        data = b""
    found = [kind for start, kind in _SIGNATURES if data.startswith(start)]
    if not found:
        raise WebProblem(422, "The picture cannot be read.", "Use a JPEG or PNG picture.", path="images")
    return data, found[0]


def checked_image(text: str) -> tuple[bytes, str]:
    """The same, of a picture that comes from outside: it also has to say a size that can be unpacked.

    Raises:
        WebProblem: It is no picture, or too large a one.
    """
    data, kind = read_image(text)
    try:
        with Image.open(io.BytesIO(data), formats=("JPEG", "PNG")) as picture:
            width, height = picture.size
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError, Image.DecompressionBombWarning):
        width, height = 0, 0
    if not 0 < width * height <= MAX_PIXELS:
        raise WebProblem(
            422,
            "The picture is damaged or too large.",
            f"Use a JPEG or PNG picture of at most {MAX_PIXELS // 1_000_000} million points.",
            path="images",
        )
    return data, kind


def kept_picture(key: str, image: ImageUpload | ChatImage) -> KeptPicture:
    """A picture that goes with a message, as it is kept.

    Raises:
        WebProblem: It is no picture, or too large a one.
    """
    data, media_type = checked_image(image.data)
    return KeptPicture(key, media_type, data)
