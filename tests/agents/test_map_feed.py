"""Maps for screens: the service, the positions, and the drawn feed, with the simulated robot driving."""

from __future__ import annotations

import base64
import io
import math

import numpy as np
import pytest
from PIL import Image

from parley.agents.display.map_drawing import MapPicture
from parley.agents.display.map_feed import FEED, MapViews
from parley.clock import WallClock
from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.errors import ActionFailure, FailureCode
from parley.messages import topics
from parley.messages.map import GetMap, MapInfo, MapView
from parley.messages.ros import ChatRequest, CompressedImage, String
from parley.messages.status import PoseInfo, Rejection
from parley.messages.topics import display_topic
from parley.messages.wire import decode, encode
from parley.robots.own import RobotBase
from parley.transport.local import LocalTransport
from parley.world.geometry import Pose2D, Velocity
from parley.world.object_map import MapObject
from parley.world.occupancy import FREE, OCCUPIED, OccupancyMap
from tests.demos.house import running
from tests.transport.backends import until

QUICK = SystemConfig(speed=20.0, display_interval_s=0)


async def test_the_map_comes_as_a_picture_with_what_stands_on_it() -> None:
    async with running(load_demo("nursing-home").system(QUICK)) as home:
        request = ChatRequest(encode(GetMap(robot=home.robot)))
        reply = await home.system.transport.call(topics.GET_MAP, request, timeout_s=10.0)
        info = decode(MapInfo, reply.response)
        picture = Image.open(io.BytesIO(base64.b64decode(info.image)))
        assert picture.size == (info.width, info.height)
        assert {thing.id for thing in info.objects} == {item.id for item in home.system.objects.objects}
        pose = home.system.robots[home.robot].pose()
        column = int((pose.x_m - info.origin.x) / info.resolution)
        row = int((pose.y_m - info.origin.y) / info.resolution)
        assert picture.getpixel((column, info.height - 1 - row)) == 254  # the robot stands on free floor


async def test_a_robot_without_a_map_has_an_empty_answer_and_nonsense_is_refused() -> None:
    refused: list[Rejection] = []
    async with running(load_demo("nursing-home").system(QUICK)) as home:
        transport = home.system.transport

        def note(message: String) -> None:
            refused.append(decode(Rejection, message.data))

        await transport.subscribe(topics.REJECTION, note)
        nobody = ChatRequest(encode(GetMap(robot="nobody")))
        assert (await transport.call(topics.GET_MAP, nobody, timeout_s=10.0)).response == "{}"
        assert refused == []
        assert (await transport.call(topics.GET_MAP, ChatRequest("map!"), timeout_s=10.0)).response == "{}"
        await until(lambda: refused)
        assert refused[0].what == topics.GET_MAP.name


async def test_a_driving_robot_shows_the_way_that_is_left_and_none_when_it_is_there() -> None:
    views: list[MapView] = []
    async with running(load_demo("nursing-home").system(QUICK)) as home:

        def note(message: String) -> None:
            views.append(decode(MapView, message.data))

        await home.system.transport.subscribe(topics.MAP_VIEW, note)
        await until(lambda: views)
        assert views[0].path == () and views[0].goal is None and views[0].scan
        assert views[0].room == "living room"
        thing = home.system.objects.objects[0].description
        home.observer.say(f"go to the {thing}", home.robot)
        await until(lambda: views[-1].path)
        first = next(view for view in views if view.path)
        assert first.goal is not None
        assert math.hypot(first.path[0][0] - first.pose.x, first.path[0][1] - first.pose.y) < 0.5
        await until(lambda: not views[-1].path)
        there = views[-1].pose
        assert math.hypot(first.goal.x - there.x, first.goal.y - there.y) < 0.2


async def test_nobody_is_told_where_the_robot_is_while_nobody_asks() -> None:
    async with running(load_demo("nursing-home").system(QUICK)) as home:
        views: list[MapView] = []

        def note(message: String) -> None:
            views.append(decode(MapView, message.data))

        watching = await home.system.transport.subscribe(topics.MAP_VIEW, note)
        await until(lambda: views)
        await watching.close()
        seen = len(views)
        again = await home.system.transport.subscribe(topics.MAP_VIEW, note)
        await until(lambda: len(views) > seen)
        await again.close()


async def test_the_drawn_map_is_a_feed_that_people_find_before_they_watch_it() -> None:
    pictures: list[CompressedImage] = []
    async with running(load_demo("nursing-home").system(QUICK)) as home:
        topic = display_topic(home.robot, FEED)
        assert any(
            end.name == topic.name and end.role == "publisher" for end in home.system.transport.endpoints()
        )
        await home.system.transport.subscribe(topic, pictures.append)
        await until(lambda: pictures)
        assert max(Image.open(io.BytesIO(pictures[0].data)).size) > 400


@pytest.fixture(scope="module")
def room() -> MapPicture:
    cells = np.full((40, 60), FREE, np.int8)
    cells[0] = OCCUPIED
    box = MapObject("box_1", "box", x_m=2.0, y_m=1.5, width_m=0.4, height_m=0.2)
    return MapPicture(OccupancyMap(cells, 0.05, 0.0, 0.0), [box], robot_radius_m=0.2)


def test_the_lowest_row_of_the_map_is_the_bottom_of_the_picture(room: MapPicture) -> None:
    picture = room.draw(MapView(actor="A", pose=PoseInfo(x=0.5, y=0.5)))
    assert picture.size == (720, 480)
    assert picture.getpixel((360, 478)) != picture.getpixel((360, 2))
    assert sum(picture.getpixel((360, 478))) < 300  # type: ignore[arg-type]


def test_robot_and_way_are_drawn_where_they_are(room: MapPicture) -> None:
    away = room.draw(MapView(actor="A", pose=PoseInfo(x=0.5, y=0.5)))
    here = room.draw(MapView(actor="A", pose=PoseInfo(x=1.5, y=1.0), path=((1.5, 1.0), (2.5, 1.0))))
    assert here.getpixel((360, 240)) != away.getpixel((360, 240))
    assert here.getpixel((480, 240)) != away.getpixel((480, 240))
    assert here.getpixel((240, 100)) == away.getpixel((240, 100))


class Cart(RobotBase):
    """One whose base did not answer at first."""

    asked = 0

    def pose(self) -> Pose2D:
        self.asked += 1
        if self.asked == 1:
            raise ActionFailure(FailureCode.HARDWARE, "silent")
        return Pose2D(1.0, 2.0)

    def velocity(self) -> Velocity:
        return Velocity()

    def send(self, velocity: Velocity) -> None: ...


async def test_where_a_robot_is_is_told_again_once_its_base_answers_again() -> None:
    seen: list[MapView] = []
    async with (
        LocalTransport() as transport,
        MapViews(transport, Cart("Kim"), "floor", WallClock()),
    ):
        await transport.subscribe(topics.MAP_VIEW, lambda told: seen.append(decode(MapView, told.data)))
        await until(lambda: seen)
    assert seen[0].pose == PoseInfo(x=1.0, y=2.0)
