"""What people put on a map in a running system: understood at once, kept, and told to who comes second."""

from __future__ import annotations

import json
import math
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.observer import Observer
from parley.engines import WorldView
from parley.errors import FileFormatError
from parley.gate.audit_text import told
from parley.language.base import Language
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.map import GetMap, MapInfo, MapRoom, MapThing, PlaceChange, PlaceChanged
from parley.messages.principal import Principal, person
from parley.messages.ros import ChatRequest, String
from parley.messages.rule_requests import RuleRequest
from parley.messages.status import PoseInfo
from parley.messages.wire import decode, encode
from parley.system import System
from parley.world.object_map import MapObject, ObjectMap
from parley.world.whereabouts import Footprint
from tests.demos.house import House
from tests.sim.worlds import two_rooms

EAST = {"id": "east", "name": "east room", "kind": "keep_out", "rectangle": (2.9, -1.0, 9.0, 9.0)}
KIM = person("Kim", role="supervisor")
LAB = MapRoom(name="lab", corners=((3.2, 0.2), (5.8, 0.2), (5.8, 3.8), (3.2, 3.8)))
PUMP = MapThing(id="", kind="place", description="pump", x=4.5, y=3.0)


class Crew(House):
    """A robot in two rooms, and its map."""

    async def ask(self, by: Principal | None = KIM, **more: Any) -> PlaceChanged:
        request = PlaceChange.model_validate({"robot": "A", "by": by} | more)
        response = await self.system.transport.call(topics.PLACES, ChatRequest(encode(request)), timeout_s=10)
        return decode(PlaceChanged, response.response)

    async def map(self) -> MapInfo:
        request = ChatRequest(encode(GetMap(robot="A")))
        response = await self.system.transport.call(topics.GET_MAP, request, timeout_s=10)
        return decode(MapInfo, response.response)

    async def names(self) -> set[str]:
        shown = await self.map()
        return {thing.description for thing in shown.objects} | {room.name for room in shown.rooms}


@asynccontextmanager
async def crew(config: SystemConfig | None = None, language: Language | None = None) -> AsyncIterator[Crew]:
    config = config or SystemConfig(speed=None)
    system = System(two_rooms(), config, actions=BUILTIN_ACTIONS, language=language)
    async with system, Observer(system.transport, system.clock) as observer:
        await observer.until(lambda: "A" in observer.robots, timeout_s=10)
        yield Crew(system, observer, "A")


async def test_what_is_put_on_the_map_is_understood_at_once_and_driven_to() -> None:
    async with crew() as it:
        assert await it.ask(put=LAB) == PlaceChanged(put=LAB)
        put = (await it.ask(put=with_stand(4.5, 2.6))).put
        assert isinstance(put, MapThing) and put.id == "pump_1"
        assert {"lab", "pump"} <= await it.names()
        await it.say("go to the pump")
        assert await it.done() == ["finished", "finished"]
        pose = it.system.robots["A"].pose()
        assert math.dist((pose.x_m, pose.y_m), (4.5, 2.6)) < 0.15
        assert abs(pose.yaw_rad - 1.57) < 0.15
        assert (await it.say("go to the lab")).type == "response" and it.actions()


async def test_what_was_renamed_moved_and_taken_off_is_so_in_the_next_message() -> None:
    async with crew() as it:
        crate = next(thing for thing in (await it.map()).objects if thing.id == "crate_1")
        tank = crate.model_copy(update={"description": "tank", "x": 1.0, "y": 3.0})
        assert (await it.ask(was=crate, put=tank)).put == tank
        assert "tank" in await it.names()
        await it.say("go to the tank")
        assert await it.done() == ["finished", "finished"]
        assert it.system.robots["A"].pose().x_m < 3
        assert (await it.ask(was=tank)).problem == ""
        reply = await it.say("go to the tank")
        assert reply.message.startswith("I do not know any “tank” here")
        # An undo: it comes back with the id it had.
        assert (await it.ask(put=tank)).put == tank


async def test_who_comes_second_is_told() -> None:
    async with crew() as it:
        put = (await it.ask(put=PUMP)).put
        assert isinstance(put, MapThing)
        first = put.model_copy(update={"x": 4.0})
        assert (await it.ask(was=put, put=first)).problem == ""
        for late in (put.model_copy(update={"x": 5.0}), None):
            assert "Somebody else" in (await it.ask(was=put, put=late)).problem
        assert "muutis" in (await it.ask(was=put, language="et")).problem
        assert "Somebody else" in (await it.ask(put=put)).problem, "an id is there once"
        shown = next(thing for thing in (await it.map()).objects if thing.id == put.id)
        assert shown == first


async def test_a_name_that_is_there_already_asks_which() -> None:
    async with crew() as it:
        await it.ask(put=LAB)
        put = (await it.ask(put=PUMP)).put
        for name in ("Pump", "the pump"):
            asked = await it.ask(put=PUMP.model_copy(update={"description": name, "x": 1.0}))
            assert asked.same == (put,) and asked.put is None
        assert (await it.ask(put=PUMP.model_copy(update={"description": "lab"}))).same == (LAB,)
        second = (await it.ask(put=PUMP.model_copy(update={"x": 1.0}), anyway=True)).put
        assert isinstance(second, MapThing) and second.id == "pump_2"
        assert (await it.ask(put=LAB, anyway=True)).same == (LAB,), "rooms are known by their names"


async def test_what_no_robot_gets_to_or_may_enter_is_told_at_once() -> None:
    async with crew() as it:
        walled = await it.ask(what="try", put=with_stand(3.0, 2.0))
        assert walled.notes == ("Nobody can stand there: the map shows no free floor.",)
        outside = await it.ask(what="try", put=PUMP.model_copy(update={"x": 9.0, "y": 9.0}))
        assert outside.notes == ("A finds no free spot there that it can get to.",)
        assert (await it.ask(what="try", put=LAB)).notes == ()
        rule = RuleRequest.model_validate({"what": "put", "rule": EAST, "by": KIM})
        await it.system.transport.call(topics.RULES, ChatRequest(encode(rule)), timeout_s=10)
        for place in (LAB, PUMP, with_stand(4.5, 2.4)):
            closed = await it.ask(what="try", put=place)
            assert closed.notes == ("It lies in “east room”, where A may not go.",)
        assert "pump" not in await it.names(), "nothing was done yet"


@pytest.mark.parametrize(
    "by",
    [None, Principal(kind="engine"), person("Bo"), person("Bo", role="viewer"), Principal(kind="program")],
)
async def test_only_supervisors_change_the_map(by: Principal | None) -> None:
    async with crew() as it:
        for change in ({"put": PUMP}, {"what": "load", "whole": ObjectMap().to_json()}):
            assert "Only supervisors" in (await it.ask(by, **change)).problem
        assert await it.names() == {"green crate"}


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("", "1 to 80"),
        ("stop", "keeps its meaning"),
        ("pump A", "“pump A” calls a robot"),
        ("x" * 81, "1 to 80"),
    ],
)
async def test_a_name_that_would_mean_two_things_is_refused(name: str, why: str) -> None:
    async with crew() as it:
        assert why in (await it.ask(put=PUMP.model_copy(update={"description": name}))).problem


async def test_what_was_put_there_is_there_after_a_restart_and_in_the_log(tmp_path: Path) -> None:
    config = SystemConfig(speed=None, data_dir=tmp_path)
    events: list[AuditEvent] = []
    async with crew(config) as it:
        heard = await it.system.transport.subscribe(topics.AUDIT, lambda m: events.append(audit(m)))
        crate = next(thing for thing in (await it.map()).objects if thing.id == "crate_1")
        await it.ask(put=LAB, words="this is the lab")
        await it.ask(was=crate)
        await it.observer.until(lambda: len(mapped(events)) == 2)
        await heard.close()
    assert [(event.by and event.by.name, event.detail) for event in mapped(events)] == [
        ("Kim", {"put": {"id": "room lab", "name": "lab", "x": 4.5, "y": 2.0}, "map": "two rooms"}),
        ("Kim", {"was": {"id": "crate_1", "name": "green crate", "x": 5.2, "y": 2.0}, "map": "two rooms"}),
    ]
    assert [*map(told, mapped(events))] == [
        "Kim put “lab” on the map.",
        "Kim took “green crate” off the map.",
    ]
    async with crew(config) as it:
        assert await it.names() == {"lab"}
        whole = (await it.ask(what="whole")).whole
        assert whole is not None and ObjectMap.parse(json.dumps(whole)).areas[0].name == "lab"
    (tmp_path / "places.json").write_text('{"maps": 1}')
    with pytest.raises(FileFormatError, match=r"places\.json"):
        async with crew(config):
            pass


async def test_a_whole_object_map_takes_the_place_of_what_was_there() -> None:
    async with crew() as it:
        await it.ask(put=PUMP)
        whole = ObjectMap((MapObject("cup_1", "cup", 1.0, 3.0, "cup"),)).to_json()
        assert (await it.ask(what="load", whole=whole)).problem == ""
        assert await it.names() == {"cup"}
        assert "items" in (await it.ask(what="load", whole={"classes": []})).problem
        assert await it.names() == {"cup"}


async def test_a_narrow_room_stays_narrow_when_it_is_called_otherwise() -> None:
    async with crew() as it:
        corners = [list(corner) for corner in LAB.corners]
        narrow = {"classes": [], "items": {}, "areas": [{"name": "lab", "corners": corners, "capacity": 1}]}
        await it.ask(what="load", whole=narrow)
        assert (await it.ask(was=LAB, put=LAB.model_copy(update={"name": "bay"}))).problem == ""
        kept = (await it.ask(what="whole")).whole or {}
        assert [(area["name"], area["capacity"]) for area in kept["areas"]] == [("bay", 1)]


async def test_what_a_robot_saw_is_put_on_the_map_or_not() -> None:
    async with crew() as it:
        sees = WorldView(it.system.engines, "A", it.system.engines.occupancy("A"))
        await sees.note("trolley", Footprint(1.5, 3.0, 0.4, 0.4))
        (trolley,) = (thing for thing in (await it.map()).objects if thing.found)
        put = trolley.model_copy(update={"found": False, "description": "tea trolley"})
        assert (await it.ask(was=trolley, put=put)).put == put
        assert not any(thing.found for thing in (await it.map()).objects)
        # Seen elsewhere later: it was moved, and a person may say that it was not.
        await sees.note("tea trolley", Footprint(1.5, 2.0, 0.4, 0.4))
        (moved,) = (thing for thing in (await it.map()).objects if thing.found)
        assert (moved.id, moved.y) == (trolley.id, 2.0)
        assert (await it.ask(was=moved)).problem == ""
        assert await it.names() == {"green crate"}
        await sees.note("trolley", Footprint(1.5, 1.0, 0.4, 0.4))
        assert await it.names() == {"green crate", "trolley"}


async def test_furniture_that_the_map_has_no_name_for_is_put_there_and_what_stands_on_it_is_not() -> None:
    async with crew() as it:
        sees = WorldView(it.system.engines, "A", it.system.engines.occupancy("A"))
        assert not sees.occupancy.is_free(6.1, 1.0), "a wall, or what stands there"
        assert await sees.note("shelf", Footprint(6.1, 1.0))
        (shelf,) = (thing for thing in (await it.map()).objects if thing.found)
        assert sees.occupancy.is_free(shelf.x - shelf.width / 2, shelf.y), "one can stand before it"
        assert (await it.ask(was=shelf, put=shelf.model_copy(update={"found": False}))).notes == ()
        assert await sees.note("lamp", Footprint(6.1, 1.1)) is None
        assert (await sees.note("TV in the lab", Footprint(2.0, 1.0))).class_name == "tv"  # type: ignore[union-attr]
        assert await sees.note("shelf", Footprint(6.1, 1.0))
        assert await it.names() == {"green crate", "shelf", "TV in the lab"}


def with_stand(x: float, y: float) -> MapThing:
    """The pump, with where to stand for it."""
    return PUMP.model_copy(update={"stand": PoseInfo(x=x, y=y, yaw=1.57)})


def audit(message: String) -> AuditEvent:
    return decode(AuditEvent, message.data)


def mapped(events: list[AuditEvent]) -> list[AuditEvent]:
    return [event for event in events if event.effect == "map"]
