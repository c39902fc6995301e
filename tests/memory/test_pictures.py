"""Pictures from outside: what is taken, what is refused, and what is left of them."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from parley.memory.pictures import (
    MAX_BYTES,
    MAX_SIDE,
    PictureError,
    check_picture,
    modest_jpeg,
    pixels_to_jpeg,
)
from tests.memory.photos import opened, photo


@pytest.mark.parametrize("kind", ["JPEG", "PNG"])
def test_small_picture_keeps_its_size_and_becomes_a_jpeg(kind: str) -> None:
    kept = opened(modest_jpeg(photo(40, 30, kind=kind)))
    assert (kept.format, kept.size, kept.mode) == ("JPEG", (40, 30), "RGB")


def test_large_picture_is_brought_to_the_bound_in_proportion() -> None:
    assert opened(modest_jpeg(photo(4000, 1000))).size == (MAX_SIDE, MAX_SIDE // 4)


def test_what_the_camera_noted_is_dropped_and_the_picture_stands_upright() -> None:
    notes = Image.Exif()
    notes[0x0112] = 6  # turned by a quarter
    notes[0x010F] = "Maker"
    kept = opened(modest_jpeg(photo(40, 20, exif=notes.tobytes())))
    assert kept.size == (20, 40)
    assert dict(kept.getexif()) == {}


def test_what_is_transparent_becomes_white() -> None:
    kept = opened(modest_jpeg(photo(8, 8, (255, 0, 0, 0), "PNG")))
    assert min(kept.getpixel((4, 4))) > 240  # type: ignore[arg-type]


def test_address_form_of_browsers_is_read_too() -> None:
    assert opened(modest_jpeg("data:image/jpeg;base64," + photo())).size == (8, 6)


def bomb(width: int, height: int) -> str:
    """A PNG of few bytes that says it is huge."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        body = kind + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))

    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", b"") + chunk(b"IEND", b"")
    return base64.b64encode(data).decode("ascii")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("", "not a JPEG or PNG"),
        ("no base64!", "did not arrive whole"),
        ("äöü", "did not arrive whole"),
        (base64.b64encode(b"a text").decode(), "not a JPEG or PNG"),
        (photo(kind="GIF"), "not a JPEG or PNG"),
        (photo(400, 400)[:2000], "damaged"),
        ("A" * (MAX_BYTES * 4 // 3 + 8), "too large"),
        (bomb(30_000, 30_000), "too many points"),
        (bomb(8_000, 6_000), "too many points"),
    ],
    ids=["empty", "text", "letters", "bytes", "gif", "cut", "large", "bomb", "many points"],
)
def test_what_is_no_picture_or_too_much_is_refused_in_plain_words(data: str, words: str) -> None:
    with pytest.raises(PictureError, match=words):
        modest_jpeg(data)


def test_check_tells_the_same_without_unpacking() -> None:
    assert check_picture(photo()) == ""
    assert "JPEG" in check_picture("aGk=")


def test_camera_picture_is_brought_to_the_bound_too() -> None:
    assert opened(pixels_to_jpeg(np.zeros((10, 2 * MAX_SIDE, 3), np.uint8))).size == (MAX_SIDE, 5)
