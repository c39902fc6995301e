"""A robot's camera as a continuous feed: real pictures, only while somebody watches."""

from __future__ import annotations

import asyncio
import io

from PIL import Image

from parley.agents.display.camera_feed import FEED
from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.messages.ros import CompressedImage
from parley.messages.topics import display_topic
from tests.demos.house import running

QUICK = SystemConfig(speed=None, camera_hz=20, display_interval_s=0)


async def test_pictures_come_while_somebody_watches_and_stop_with_them() -> None:
    pictures: list[CompressedImage] = []
    several = asyncio.Event()

    def see(picture: CompressedImage) -> None:
        pictures.append(picture)
        if len(pictures) >= 3:
            several.set()

    async with running(load_demo("nursing-home").system(QUICK)) as home:
        assert (home.robot, FEED) not in home.observer.feeds
        watching = await home.system.transport.subscribe(display_topic(home.robot, FEED), see)
        await asyncio.wait_for(several.wait(), 20)
        picture = Image.open(io.BytesIO(pictures[-1].data))
        assert (picture.format, picture.size) == ("JPEG", (320, 240))
        await watching.close()
        await asyncio.sleep(0.3)
        seen = len(pictures)
        later = await home.system.transport.subscribe(display_topic(home.robot, FEED), see)
        await asyncio.sleep(0.02)
        assert len(pictures) == seen + 1  # the last picture is there for who comes later
        await later.close()


async def test_broken_camera_is_tried_again_and_disturbs_nothing() -> None:
    pictures: list[CompressedImage] = []
    async with running(load_demo("nursing-home").system(QUICK)) as home:
        home.system.simulator.change({"robots": {home.robot: {"camera": "broken"}}})
        await home.system.transport.subscribe(display_topic(home.robot, FEED), pictures.append)
        assert (await home.say("what can you do?")).type == "response"
        assert pictures == []
