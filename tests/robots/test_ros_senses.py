"""Pictures of a ROS robot, and what its detector says of them in its own time."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Any

import numpy as np
import pytest

from parley.clock import SimClock
from parley.errors import ActionFailure, FailureCode
from parley.messages import ros, ros_robot
from parley.robots.base import CameraImage, Detection
from parley.robots.ros_senses import ATTENDS_S, DETECTOR_S, PICTURE_S, PICTURES, RosTopics, Senses
from parley.robots.ros_values import detected
from parley.transport.base import Publisher, Transport
from parley.transport.local import LocalTransport
from tests.transport.backends import until

TOPICS = RosTopics(camera="camera", detections="detections")
BOX = (Detection("box", 100, (0, 0, 10, 10), confidence=0.9),)
NOTHING: tuple[Detection, ...] = ()


class Camera:
    """A robot's camera and detector, which tell when they are told to, and a clock that goes when told to."""

    def __init__(self, transport: Transport) -> None:
        self.clock = SimClock()
        self.senses = Senses(TOPICS, self.clock.now_s, self.clock.now_s, self.clock.timeout)
        self._transport = transport
        self._pictures: Publisher[Any] = transport.publisher(
            TOPICS.topic(TOPICS.camera, ros_robot.Image, PICTURES)
        )
        self._found: Publisher[Any] = transport.publisher(
            TOPICS.topic(TOPICS.detections, ros_robot.Detection2DArray, PICTURES)
        )

    async def asked(self) -> asyncio.Task[CameraImage]:
        """Somebody wants a picture."""
        task = asyncio.create_task(self.senses.picture(self._transport))
        await settled()
        return task

    async def takes(self, number: int) -> None:
        """A picture, `number` grey."""
        data = np.full((2, 2, 3), number, np.uint8).tobytes()
        self._pictures.publish(ros_robot.Image(_top(number), 2, 2, "rgb8", 0, 6, data))
        await settled()

    async def sees(self, number: int, found: tuple[Detection, ...] = BOX) -> None:
        """The detector speaks of a picture."""
        self._found.publish(detected(found, _top(number)))
        await settled()

    async def waits(self, seconds: float) -> None:
        """Time passes."""
        self.clock.advance(seconds)
        await settled()


def _top(number: int) -> ros.Header:
    return ros.Header(ros.Time(number, 0), "map")


async def settled() -> None:
    """Everything that can be handled now is."""
    for _ in range(20):
        await asyncio.sleep(0)


@pytest.fixture
async def camera() -> AsyncIterator[Camera]:
    async with LocalTransport() as transport:
        yield Camera(transport)


async def test_a_detector_that_is_late_is_waited_for_longer_than_a_camera(camera: Camera) -> None:
    wanted = await camera.asked()
    await camera.waits(PICTURE_S - 0.1)
    await camera.takes(1)
    await camera.waits(PICTURE_S + 0.1)
    for number in range(2, 200):  # the camera goes on meanwhile
        await camera.takes(number)
    await camera.sees(1)
    image = await wanted
    assert [found.label for found in image.detections or ()] == ["box"]
    assert image.data[0, 0, 0] == 1


async def test_who_wants_a_picture_takes_none_away_from_who_waits_for_one(camera: Camera) -> None:
    first = await camera.asked()
    await camera.takes(1)
    second = await camera.asked()
    await camera.sees(1)
    assert first.done() and (await first).detections
    assert not second.done(), "it was taken before it was asked for"
    await camera.takes(2)
    await camera.sees(2, NOTHING)
    await camera.sees(3)  # comes before its picture does
    assert (await second).detections == ()


async def test_without_a_word_of_the_detector_the_picture_is_given_and_without_a_picture_it_is_said(
    camera: Camera,
) -> None:
    wanted = await camera.asked()
    await camera.takes(1)
    await camera.waits(DETECTOR_S + 0.1)
    assert (await wanted).detections is None
    dark = await camera.asked()
    await camera.waits(PICTURE_S + 0.1)
    with pytest.raises(ActionFailure) as told:
        await dark
    assert told.value.code is FailureCode.HARDWARE


async def test_the_camera_is_listened_to_while_somebody_waits(camera: Camera) -> None:
    wanted = await camera.asked()
    await camera.takes(1)
    await camera.waits(DETECTOR_S - 0.1)
    await camera.senses.rest()
    await camera.sees(1)
    assert (await wanted).detections


async def test_a_button_is_heard_whether_its_driver_latches_what_it_says_or_not() -> None:
    topics = RosTopics(emergency="e_stop")
    asked = {
        name: [topic.qos.latched for topic in topics.heard(name, kind, qos)]
        for name, kind, qos in topics.told()
    }
    assert sorted(asked.pop("e_stop")) == [False, True]
    assert {len(ways) for ways in asked.values()} == {1}
    async with LocalTransport() as transport:
        senses = Senses(topics, SimClock().now_s, SimClock().now_s, SimClock().timeout)
        await senses.listen(transport)
        button = transport.publisher(topics.topic("e_stop", ros_robot.Bool))
        for pressed in (True, False):
            button.publish(ros_robot.Bool(pressed))
            await settled()
            assert senses.emergency is pressed


async def test_a_base_is_not_blamed_for_the_time_in_which_nobody_here_could_hear_it() -> None:
    async with LocalTransport() as transport:
        camera = Camera(transport)
        camera.senses._on_odom(ros_robot.Odometry())
        attending = asyncio.create_task(camera.senses.attend())
        await settled()
        camera.clock.advance(10.0)
        assert camera.senses.fresh(1.0), "as soon as it goes on"
        assert not camera.senses.returned(1.0)
        await until(lambda: camera.senses.returned(1.0))
        camera.senses._on_odom(ros_robot.Odometry())
        camera.clock.advance(10.0)
        for fresh in (True, False):
            await asyncio.sleep(2 * ATTENDS_S)
            assert camera.senses.fresh(1.0) == fresh
            for _ in range(12):
                camera.clock.advance(ATTENDS_S)
                await asyncio.sleep(1.5 * ATTENDS_S)
        attending.cancel()
