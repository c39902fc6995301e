"""Pictures of every kind become JPEGs with the right colours; everything else is refused by field."""

from __future__ import annotations

import base64
import io
import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from parley.agents.display.images import MAX_SIDE_PX, to_jpeg
from parley.agents.display.raw_images import RAW_ENCODINGS, picture_of
from parley.errors import InvalidMessageError
from parley.messages.display import RawImage

RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)


def quarters() -> NDArray[np.uint8]:
    """32 x 48 pixels: red, green over blue, white."""
    pixels = np.zeros((32, 48, 3), np.uint8)
    pixels[:16, :24], pixels[:16, 24:], pixels[16:, :24], pixels[16:, 24:] = RED, GREEN, BLUE, WHITE
    return pixels


def encoded(picture: Image.Image, kind: str, **options: Any) -> str:
    out = io.BytesIO()
    picture.save(out, kind, **options)
    return base64.b64encode(out.getvalue()).decode()


def raw(
    data: Any, *, width: int = 48, height: int = 32, encoding: str = "rgb8", step: int | None = None
) -> RawImage:
    text = base64.b64encode(data).decode() if isinstance(data, bytes) else data
    return RawImage(data=text, height=height, width=width, encoding=encoding, step=step)


def assert_shows_quarters(jpeg: bytes) -> None:
    picture = Image.open(io.BytesIO(jpeg))
    assert picture.format == "JPEG"
    assert picture.size == (48, 32)
    shown = np.asarray(picture.convert("RGB")).astype(int)
    for place, colour in {(8, 12): RED, (8, 36): GREEN, (24, 12): BLUE, (24, 36): WHITE}.items():
        assert np.abs(shown[place] - colour).max() < 12, (place, shown[place])


def refused(image: str | RawImage) -> InvalidMessageError:
    with pytest.raises(InvalidMessageError) as refusal:
        to_jpeg(image)
    assert refusal.value.what == "DisplayFeed"
    return refusal.value


# Finished pictures


@pytest.mark.parametrize(
    "options", [{}, {"quality": 20}, {"subsampling": 0}, {"optimize": True}, {"comment": b"x" * 99}]
)
def test_a_plain_jpeg_passes_untouched(options: dict[str, Any]) -> None:
    text = encoded(Image.fromarray(quarters()), "JPEG", **options)
    assert to_jpeg(text) == base64.b64decode(text)


def test_a_grey_jpeg_passes_untouched() -> None:
    text = encoded(Image.fromarray(quarters()).convert("L"), "JPEG")
    assert to_jpeg(text) == base64.b64decode(text)


def test_a_jpeg_that_not_every_screen_can_show_is_encoded_anew() -> None:
    progressive = encoded(Image.fromarray(quarters()), "JPEG", progressive=True)
    assert to_jpeg(progressive) != base64.b64decode(progressive)
    assert_shows_quarters(to_jpeg(progressive))
    four_inks = encoded(Image.fromarray(quarters()).convert("CMYK"), "JPEG")
    assert Image.open(io.BytesIO(to_jpeg(four_inks))).mode == "RGB"


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "P"])
def test_a_png_keeps_its_colours(mode: str) -> None:
    assert_shows_quarters(to_jpeg(encoded(Image.fromarray(quarters()).convert(mode), "PNG")))


def test_what_is_transparent_in_a_png_shows_white() -> None:
    pixels = np.zeros((32, 48, 4), np.uint8)
    shown = np.asarray(Image.open(io.BytesIO(to_jpeg(encoded(Image.fromarray(pixels), "PNG")))))
    assert shown.min() > 250


def test_a_png_with_16_bits_of_grey_keeps_its_shades() -> None:
    pixels = np.full((16, 16), 0x8000, np.uint16)
    shown = np.asarray(Image.open(io.BytesIO(to_jpeg(encoded(Image.fromarray(pixels), "PNG")))))
    assert abs(int(shown.mean()) - 0x80) <= 2


def test_a_data_address_and_broken_lines_are_understood() -> None:
    text = encoded(Image.fromarray(quarters()), "PNG")
    lines = "\n".join(text[at : at + 76] for at in range(0, len(text), 76))
    assert_shows_quarters(to_jpeg(lines))
    assert_shows_quarters(to_jpeg(f"data:image/png;base64,{text}"))


def test_the_quality_is_the_one_asked_for() -> None:
    noise = np.random.default_rng(1).integers(0, 256, (64, 64, 3), np.uint8)
    text = encoded(Image.fromarray(noise), "PNG")
    assert len(to_jpeg(text, quality=20)) < len(to_jpeg(text, quality=85))


def corrupt(text: str) -> str:
    data = bytearray(base64.b64decode(text))
    data[len(data) // 2 : len(data) // 2 + 40] = bytes(40)
    return base64.b64encode(data).decode()


def cut(text: str) -> str:
    data = base64.b64decode(text)
    return base64.b64encode(data[: len(data) // 2]).decode()


NOISE = Image.fromarray(np.random.default_rng(1).integers(0, 256, (64, 64, 3), np.uint8))


@pytest.mark.parametrize(
    "text",
    [
        "no base64!",
        "abc",
        "",
        base64.b64encode(b"plain text").decode(),
        base64.b64encode(b"\xff\xd8\xff\xd9").decode(),
        base64.b64encode(b"\xff\xd8\xff\xc0\x00\x02\xff\xd9").decode(),
        base64.b64encode(b"\x89PNG\r\n\x1a\n").decode(),
        encoded(NOISE, "GIF"),
        encoded(NOISE, "BMP"),
        cut(encoded(NOISE, "PNG")),
        cut(encoded(NOISE, "JPEG")),
        corrupt(encoded(NOISE, "PNG")),
    ],
)
def test_what_is_no_whole_jpeg_or_png_is_refused(text: str) -> None:
    assert refused(text).path == "image"


def test_a_refusal_says_what_would_be_accepted() -> None:
    said = str(refused(base64.b64encode(b"plain text").decode()))
    assert all(word in said for word in ("JPEG", "PNG", "base64", "rgb8", "bgr8"))


@given(
    st.binary(max_size=200), st.sampled_from([b"", b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"])
)
def test_no_bytes_are_too_strange(data: bytes, start: bytes) -> None:
    refused(base64.b64encode(start + data).decode())


def png_claiming(width: int, height: int) -> str:
    """A small file that says it is large."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")

    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + b"\x08\x02\x00\x00\x00"
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b"")
    return base64.b64encode(b"\x89PNG\r\n\x1a\n" + body).decode()


@pytest.mark.parametrize(("width", "height"), [(MAX_SIDE_PX + 1, 1), (8000, 8000), (60_000, 60_000)])
def test_a_picture_that_claims_to_be_huge_is_not_unpacked(width: int, height: int) -> None:
    said = str(refused(png_claiming(width, height)))
    assert "pixels" in said
    assert "at most" in said or "exceeds limit" in said


def test_a_huge_plain_jpeg_does_not_pass_either() -> None:
    text = encoded(Image.new("L", (MAX_SIDE_PX + 8, 8)), "JPEG")
    assert f"{MAX_SIDE_PX + 8} x 8 pixels" in str(refused(text))


# Raw pixels


def with_alpha(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return np.dstack([pixels, np.full(pixels.shape[:2], 255, np.uint8)])


LAYOUTS: dict[str, NDArray[np.uint8]] = {
    "rgb8": quarters(),
    "bgr8": quarters()[:, :, ::-1],
    "rgba8": with_alpha(quarters()),
    "bgra8": with_alpha(quarters())[:, :, [2, 1, 0, 3]],
}


@pytest.mark.parametrize("encoding", LAYOUTS)
@pytest.mark.parametrize("as_numbers", [False, True])
def test_raw_pixels_keep_their_colours(encoding: str, as_numbers: bool) -> None:
    data = LAYOUTS[encoding].tobytes()
    assert_shows_quarters(to_jpeg(raw(list(data) if as_numbers else data, encoding=encoding)))


def test_raw_grey_stays_grey() -> None:
    data = np.full((32, 48), 77, np.uint8).tobytes()
    shown = np.asarray(Image.open(io.BytesIO(to_jpeg(raw(data, encoding="mono8")))))
    assert abs(int(shown.mean()) - 77) <= 1


@pytest.mark.parametrize("step", [144, 145, 160])
@pytest.mark.parametrize("whole_last_row", [True, False])
def test_bytes_behind_each_row_are_skipped(step: int, whole_last_row: bool) -> None:
    padded = np.full((32, step), 99, np.uint8)
    padded[:, :144] = quarters().reshape(32, 144)
    data = padded.tobytes()
    assert_shows_quarters(to_jpeg(raw(data if whole_last_row else data[: step * 31 + 144], step=step)))


def test_a_step_of_nought_means_that_rows_follow_each_other() -> None:
    assert_shows_quarters(to_jpeg(raw(quarters().tobytes(), step=0)))


@pytest.mark.parametrize(
    ("image", "field", "says"),
    [
        (raw(bytes(48 * 32 * 3 - 1)), "image.data", "expected 4608 bytes"),
        (raw(bytes(48 * 32 * 3 + 1)), "image.data", "got 4609"),
        (raw(b""), "image.data", "got 0"),
        (raw("no base64!"), "image.data", "base64"),
        (raw([0, 256] * 10, width=2, height=1), "image.data", "0 to 255"),
        (raw([-1, 0, 0], width=1, height=1), "image.data", "0 to 255"),
        (raw(bytes(9), width=2, height=1, step=5), "image.step", "too few"),
        (raw(bytes(9), encoding="yuv422"), "image.encoding", "'yuv422'"),
        (raw(bytes(9), width=8192, height=8192), "image.width", "8192 x 8192"),
    ],
)
def test_raw_pixels_that_do_not_fit_are_refused_by_field(image: RawImage, field: str, says: str) -> None:
    refusal = refused(image)
    assert refusal.path == field
    assert says in refusal.problem


def test_a_refused_encoding_names_those_that_are_supported() -> None:
    said = refused(raw(b"", encoding="odd")).problem
    assert all(encoding in said for encoding in RAW_ENCODINGS)


SCENE = (
    np.array(
        [
            [[200, 10, 20], [200, 10, 20], [30, 180, 40], [30, 180, 40]],
            [[200, 10, 20], [200, 10, 20], [30, 180, 40], [30, 180, 40]],
            [[50, 60, 220], [50, 60, 220], [90, 90, 90], [90, 90, 90]],
            [[50, 60, 220], [50, 60, 220], [90, 90, 90], [90, 90, 90]],
        ],
        np.uint8,
    )
    .repeat(4, axis=0)
    .repeat(4, axis=1)
)
"""Four patches of 8 x 8 pixels: red, green, blue, grey."""


def seen_through(pattern: str) -> RawImage:
    """The scene as a sensor with this colour filter measures it: one colour per pixel."""
    measured = np.zeros(SCENE.shape[:2], np.uint8)
    for place, colour in enumerate(pattern):
        row, column = place // 2, place % 2
        measured[row::2, column::2] = SCENE[row::2, column::2, "rgb".index(colour)]
    return RawImage(data=base64.b64encode(measured.tobytes()).decode(), height=16,
                    width=16, encoding=f"bayer_{pattern}8")  # fmt: skip


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_a_mosaic_gets_its_colours_back(pattern: str) -> None:
    picture = np.asarray(picture_of(seen_through(pattern)))
    inner = [slice(1, 7), slice(9, 15)]
    for rows in inner:
        for columns in inner:
            np.testing.assert_array_equal(picture[rows, columns], SCENE[rows, columns])


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_what_a_mosaic_measured_stays_as_it_is(pattern: str) -> None:
    picture = np.asarray(picture_of(seen_through(pattern)))
    for place, colour in enumerate(pattern):
        at = (slice(place // 2, None, 2), slice(place % 2, None, 2), "rgb".index(colour))
        np.testing.assert_array_equal(picture[at], SCENE[at])


def test_a_mosaic_of_one_pixel_is_a_picture_too() -> None:
    image = RawImage(data=[77], height=1, width=1, encoding="bayer_rggb8")
    assert np.asarray(picture_of(image)).tolist() == [[[77, 0, 0]]]


@pytest.mark.parametrize(
    ("bigendian", "data"), [(0, [0x34, 0x12, 0xFF, 0xFE]), (1, [0x12, 0x34, 0xFE, 0xFF])]
)
def test_16_bit_grey_keeps_its_upper_bits_in_either_byte_order(bigendian: int, data: list[int]) -> None:
    image = RawImage(data=data, height=1, width=2, encoding="mono16", is_bigendian=bigendian)
    assert np.asarray(picture_of(image)).tolist() == [[0x12, 0xFE]]


def test_bytes_behind_each_row_are_skipped_in_a_mosaic_too() -> None:
    image = RawImage(data=[1, 2, 99, 3, 4, 99], height=2, width=2, encoding="bayer_rggb8", step=3)
    tight = RawImage(data=[1, 2, 3, 4], height=2, width=2, encoding="bayer_rggb8")
    np.testing.assert_array_equal(np.asarray(picture_of(image)), np.asarray(picture_of(tight)))


@pytest.mark.parametrize("kind", ["JPEG", "PNG"])
def test_a_picture_that_is_too_wide_is_made_smaller_in_its_shape(kind: str) -> None:
    out = io.BytesIO()
    Image.new("RGB", (400, 100), (200, 40, 40)).save(out, kind)
    jpeg = to_jpeg(base64.b64encode(out.getvalue()).decode(), max_width_px=100)
    assert Image.open(io.BytesIO(jpeg)).size == (100, 25)


def test_a_jpeg_that_is_just_narrow_enough_passes_untouched() -> None:
    out = io.BytesIO()
    Image.new("RGB", (100, 25), (200, 40, 40)).save(out, "JPEG")
    assert to_jpeg(base64.b64encode(out.getvalue()).decode(), max_width_px=100) == out.getvalue()
