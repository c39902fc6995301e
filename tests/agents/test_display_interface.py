"""The display interface over a real transport: pace, newest wins, feeds apart."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import time
from collections.abc import AsyncIterator
from typing import Any

import pytest
from PIL import Image

from parley.agents.display import display_interface
from parley.agents.display.display_interface import DisplayInterface
from parley.clock import WallClock
from parley.config import FeedSettings
from parley.messages import topics
from parley.messages.ros import CompressedImage, String
from parley.messages.status import Rejection
from parley.messages.topics import display_topic
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from tests.transport.backends import until


def picture(shade: int = 0, *, kind: str = "JPEG") -> str:
    out = io.BytesIO()
    Image.new("RGB", (16, 16), (shade, shade, shade)).save(out, kind)
    return base64.b64encode(out.getvalue()).decode()


def shade_of(image: CompressedImage) -> int:
    colour = Image.open(io.BytesIO(image.data)).convert("L").getpixel((8, 8))
    assert isinstance(colour, int)
    return colour


class Screen:
    """Sends pictures and notes what is shown and what is refused."""

    def __init__(self, transport: LocalTransport) -> None:
        self.transport = transport
        self.refused: list[Rejection] = []
        self._sender = transport.publisher(topics.DISPLAY_FEED)

    async def watch(self, target: str, name: str) -> list[CompressedImage]:
        shown: list[CompressedImage] = []
        await self.transport.subscribe(display_topic(target, name), shown.append)
        return shown

    def send(self, image: Any, target: str = "A", name: str = "camera") -> None:
        self._sender.publish(String(json.dumps({"target": target, "name": name, "image": image})))


@pytest.fixture
async def screen(request: pytest.FixtureRequest) -> AsyncIterator[Screen]:
    interval_s = getattr(request, "param", 0.0)
    async with LocalTransport() as transport:
        screen = Screen(transport)
        await transport.subscribe(
            topics.REJECTION, lambda message: screen.refused.append(decode(Rejection, message.data))
        )
        async with DisplayInterface(transport, WallClock(), min_interval_s=interval_s):
            yield screen
        assert transport.handler_failures == 0


async def test_a_picture_comes_out_as_jpeg_on_the_topic_of_its_feed(screen: Screen) -> None:
    shown = await screen.watch("A", "camera")
    text = picture(120)
    screen.send(text)
    await until(lambda: shown)
    image = shown[0]
    assert (image.format, image.data) == ("jpeg", base64.b64decode(text))
    assert image.header.frame_id == "camera"
    assert abs(image.header.stamp.sec - time.time()) < 60
    assert 0 <= image.header.stamp.nanosec < 1_000_000_000


async def test_who_opens_the_page_late_sees_the_last_picture(screen: Screen) -> None:
    first = await screen.watch("A", "camera")
    screen.send(picture(10))
    await until(lambda: first)
    late = await screen.watch("A", "camera")
    await until(lambda: late)
    assert shade_of(late[0]) == shade_of(first[0])


async def test_pngs_and_raw_pixels_are_shown_too(screen: Screen) -> None:
    shown = await screen.watch("A", "camera")
    screen.send(picture(40, kind="PNG"))
    await until(lambda: len(shown) == 1)
    screen.send({"data": [200] * 12, "height": 2, "width": 2, "encoding": "bgr8"})
    await until(lambda: len(shown) == 2)
    assert abs(shade_of(shown[0]) - 40) <= 2
    assert Image.open(io.BytesIO(shown[1].data)).size == (2, 2)


@pytest.mark.parametrize("screen", [0.02], indirect=True)
async def test_pictures_that_come_too_soon_replace_each_other_and_the_last_one_is_shown(
    screen: Screen,
) -> None:
    shown = await screen.watch("A", "camera")
    screen.send(picture(0))
    await until(lambda: shown)
    for shade in (60, 120, 180):
        screen.send(picture(shade))
    await until(lambda: len(shown) > 1)
    await asyncio.sleep(0.06)
    assert [round(shade_of(image) / 60) for image in shown] == [0, 3]


@pytest.mark.parametrize("screen", [3600.0], indirect=True)
async def test_no_picture_is_shown_before_its_time(screen: Screen) -> None:
    shown = await screen.watch("A", "camera")
    for shade in range(20):
        screen.send(picture(shade))
        await asyncio.sleep(0.002)
    await until(lambda: shown)
    assert len(shown) == 1


@pytest.mark.parametrize("screen", [3600.0], indirect=True)
async def test_a_feed_that_waits_delays_no_other(screen: Screen) -> None:
    shown = {name: await screen.watch("A", name) for name in ("camera", "map")}
    screen.send(picture(1), name="camera")
    await until(lambda: shown["camera"])
    screen.send(picture(2), name="camera")
    screen.send(picture(3), name="map")
    await until(lambda: shown["map"])
    assert len(shown["camera"]) == 1


async def test_feeds_of_several_robots_stay_apart(screen: Screen) -> None:
    shown = {target: await screen.watch(target, "camera") for target in "AB"}
    screen.send(picture(50), target="A")
    screen.send(picture(200), target="B")
    await until(lambda: all(shown.values()))
    assert abs(shade_of(shown["A"][0]) - 50) <= 2
    assert abs(shade_of(shown["B"][0]) - 200) <= 2


@pytest.mark.parametrize(
    ("image", "path"),
    [
        ("no base64!", "image"),
        ({"data": "AAAA", "height": 1, "width": 1, "encoding": "odd"}, "image.encoding"),
        ({"data": "AAAA", "height": 2, "width": 1, "encoding": "rgb8"}, "image.data"),
        ({"data": "AAAA", "height": 1, "width": 99_999, "encoding": "rgb8"}, "image.RawImage.width"),
        (3, "image.str"),
        (None, "image.str"),
    ],
)
async def test_what_is_no_picture_is_refused_by_field_and_the_next_is_shown(
    screen: Screen, image: Any, path: str
) -> None:
    shown = await screen.watch("A", "camera")
    screen.send(image)
    await until(lambda: screen.refused)
    (rejection,) = screen.refused
    assert (rejection.source, rejection.what) == ("display_interface", "display_feed")
    assert [problem.path for problem in rejection.problems] == [path]
    screen.send(picture(10))
    await until(lambda: shown)


async def test_more_feeds_than_a_screen_can_hold_are_refused_and_the_known_ones_go_on(
    screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(display_interface, "MAX_FEEDS", 2)
    shown = await screen.watch("A", "one")
    for name in ("one", "two", "three"):
        screen.send(picture(), name=name)
    await until(lambda: screen.refused)
    assert screen.refused[0].problems[0].path == "name"
    assert screen.refused[0].target == "A"
    await until(lambda: shown)
    screen.send(picture(99), name="one")
    await until(lambda: len(shown) == 2)


async def test_closing_leaves_no_task_and_no_end_behind() -> None:
    async with LocalTransport() as transport:
        before = asyncio.all_tasks()
        async with DisplayInterface(transport, WallClock(), min_interval_s=3600.0):
            sender = transport.publisher(topics.DISPLAY_FEED)
            sender.publish(String(json.dumps({"target": "A", "name": "c", "image": picture()})))
            await until(lambda: any("c" in end.name.split("/") for end in transport.endpoints()))
            sender.close()
        assert transport.endpoints() == ()
        assert asyncio.all_tasks() == before


async def test_single_feeds_have_settings_of_their_own_and_those_of_one_robot_come_first() -> None:
    settings = {
        "camera": FeedSettings(max_width_px=32),
        "A/camera": FeedSettings(max_width_px=64, interval_s=3600.0),
    }
    async with LocalTransport() as transport:
        screen = Screen(transport)
        async with DisplayInterface(transport, WallClock(), min_interval_s=0.0, feeds=settings):
            shown = {
                key: await screen.watch(*key) for key in [("A", "camera"), ("B", "camera"), ("B", "map")]
            }
            out = io.BytesIO()
            Image.new("RGB", (128, 128)).save(out, "JPEG")
            for _ in range(2):
                for key in shown:
                    screen.send(base64.b64encode(out.getvalue()).decode(), *key)
                await until(lambda: shown[("B", "map")] and shown[("B", "camera")] and shown[("A", "camera")])
            await until(lambda: len(shown[("B", "camera")]) == 2)
        widths = {key: Image.open(io.BytesIO(images[0].data)).width for key, images in shown.items()}
        assert widths == {("A", "camera"): 64, ("B", "camera"): 32, ("B", "map"): 128}
        assert len(shown[("A", "camera")]) == 1


async def test_nobody_is_alarmed_when_pictures_are_lost_in_a_burst(screen: Screen) -> None:
    said: list[String] = []
    await screen.transport.subscribe(topics.CHAT_FEEDBACK, said.append)
    for number in range(2 * display_interface.MAX_FEEDS):
        screen.send(picture(), name=f"camera {number}")
    shown = await screen.watch("A", "the last")
    screen.send(picture(120), name="the last")
    await until(lambda: shown)
    assert not said
