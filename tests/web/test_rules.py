"""Rules over real HTTP: looked at, changed, tried."""

from __future__ import annotations

import json
from typing import Any

from pytest import approx

from parley.agents.audit_log import AuditLog
from parley.agents.rules.rules import RuleNode
from parley.clock import SimClock
from parley.gate.audit_store import AuditStore
from parley.gate.book import RuleBook
from parley.gate.rules import RuleKeeper
from parley.language.builtin.engine import BuiltinLanguage
from parley.sim.floor_plan import survey
from parley.world.telling import Surroundings
from tests.sim.worlds import two_rooms
from tests.web.rig import served

DOOR = {"id": "door", "kind": "keep_out", "name": "north door", "rectangle": [2.6, 2.5, 3.4, 3.5]}


POINT = ("position::x", "position::y")


def to(*at: float) -> dict[str, Any]:
    """A drive to a point."""
    values = {name: {"pvf_type": "number", "pvf_value": value} for name, value in zip(POINT, at, strict=True)}
    return {"drive": {"input_parameters": values}}


async def test_rules_are_looked_at_changed_and_tried() -> None:
    world = two_rooms()
    floor = Surroundings(survey(world, 0.3), world.object_map())
    async with served("A") as rig:
        clock = SimClock()
        book = RuleBook(clock)
        node = RuleNode(
            rig.robots.transport,
            RuleKeeper(book),
            book,
            clock,
            ground=BuiltinLanguage().ground,
            maps={"A": floor},
        )
        async with (
            await AuditStore.open(":memory:", clock) as store,
            AuditLog(rig.robots.transport, store, clock),
            node,
        ):
            assert (await rig.http.get("/api/rules")).json()["rules"] == []
            worded = await rig.http.post("/api/rules/words", json=DOOR)
            assert worded.json()["text"] == "Stays out of “north door”: every robot."
            assert (await rig.http.get("/api/rules")).json()["rules"] == []
            put = await rig.http.put("/api/rules/door", json=DOOR)
            assert put.status_code == 200, put.text
            shown = (await rig.http.get("/api/rules?language=et")).json()["rules"]
            assert [(item["rule"]["id"], item["holds_now"]) for item in shown] == [("door", True)]
            assert "north door" in shown[0]["text"] and "ei sõida" in shown[0]["text"]

            async def tried(**body: Any) -> dict[str, Any]:
                return dict((await rig.http.post("/api/rules/try", json={"robot": "A"} | body)).json())

            inside = await tried(goal=[3.0, 3.0])
            assert [item["code"] for item in inside["forbidden"]] == ["zone_entered"]
            assert (await tried(words=["green crate"]))["forbidden"] == []
            assert (await tried(words=["moon"]))["unknown"] == ["moon"]
            drive = {"name": "drive", "effects": ["moves"], "inputs": dict.fromkeys(POINT, "number")}
            rig.robots.appear("A", pose={"x": 1.0, "y": 1.0, "yaw": 0.0}, catalogue=[drive])
            await rig.heard()
            second = await tried(steps=[to(1.0, 3.0)], after=[to(5.0, 1.0)])
            assert second["way"][0] == approx([5.0, 1.0], abs=0.1) and len(second["goals"]) == 1
            assert (await tried(steps=[to(1.0, 3.0)]))["way"][0] == approx([1.0, 1.0], abs=0.1)
            wrong = await rig.http.put("/api/rules/door", json=DOOR | {"rectangle": [0, 0, 0, 1]})
            assert wrong.status_code == 422 and "rectangle" in json.dumps(wrong.json())
            assert (await rig.http.put("/api/rules/gate", json=DOOR)).status_code == 422
            assert (await rig.http.delete("/api/rules/none")).status_code == 409
            assert (await rig.http.delete("/api/rules/door")).json()["rules"] == []

            log = rig.server.backend.state.log
            await rig.until(lambda: any(change.kind == "rules" for change in log.since(0) or ()))
            told = (await rig.http.get("/api/history/handover?since=1")).json()["rules"]
            assert [text.partition(") ")[2] for _, text in told] == [
                "let this rule hold: Stays out of “north door”: every robot.",
                "dropped this rule: Stays out of “north door”: every robot.",
            ]


async def test_where_nobody_keeps_rules_it_says_so() -> None:
    async with served("A") as rig:
        answer = await rig.http.get("/api/rules")
        assert (answer.status_code, answer.json()["detail"]) == (503, "Nobody keeps rules here.")
