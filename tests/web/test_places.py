"""Rooms and things over real HTTP: put on a map, taken off, kept as a file."""

from __future__ import annotations

from typing import Any

from parley.agents.places import Places
from parley.clock import SimClock
from parley.gate.book import RuleBook
from parley.sim.floor_plan import survey
from parley.world.object_map import ObjectMap
from parley.world.telling import Surroundings
from tests.sim.worlds import two_rooms
from tests.web.rig import served

LAB = {"name": "lab", "corners": [[3.2, 0.2], [5.8, 0.2], [5.8, 3.8]]}


async def test_a_room_is_put_on_the_map_and_all_of_it_is_kept_as_a_file_and_taken_over() -> None:
    world = two_rooms()
    maps = {"A": Surroundings(survey(world, 0.3), world.object_map())}
    async with (
        served("A") as rig,
        Places(rig.robots.transport, maps, RuleBook(SimClock()), SimClock()),
    ):
        url = "/api/map/A/places"
        tried = await rig.http.post(url, json={"put": LAB, "only_try": True})
        assert tried.status_code == 200 and tried.json()["notes"] == [], tried.text
        assert "areas" not in (await rig.http.get("/api/map/A/file")).json()
        assert (await rig.http.post(url, json={"put": LAB})).json()["put"]["name"] == "lab"
        kept = await rig.http.get("/api/map/A/file")
        assert 'filename="object_map.json"' in kept.headers["content-disposition"]
        assert [area.name for area in ObjectMap.parse(kept.text).areas] == ["lab"]
        late = await rig.http.post(url, json={"was": LAB | {"name": "shed"}, "language": "et"})
        assert late.status_code == 409 and "Keegi teine" in late.json()["detail"]
        empty: dict[str, Any] = {"classes": [], "items": {}}
        assert (await rig.http.put("/api/map/A/file", json=empty)).status_code == 200
        assert (await rig.http.get("/api/map/A/file")).json() == empty
        wrong = await rig.http.put("/api/map/A/file", json={"classes": []})
        assert wrong.status_code == 409 and "items" in wrong.json()["detail"]
