"""Pictures for tests, made on the spot."""

from __future__ import annotations

import base64
import io
from typing import Any

from PIL import Image


def photo(width: int = 8, height: int = 6, colour: Any = "red", kind: str = "JPEG", **options: Any) -> str:
    """Base64 of a picture in one colour."""
    mode = "RGBA" if isinstance(colour, tuple) and len(colour) == 4 else "RGB"
    buffer = io.BytesIO()
    Image.new(mode, (width, height), colour).save(buffer, format=kind, **options)
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def opened(data: str) -> Image.Image:
    """The picture in a base64 text."""
    picture = Image.open(io.BytesIO(base64.b64decode(data)))
    picture.load()
    return picture
