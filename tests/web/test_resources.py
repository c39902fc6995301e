"""Robots, plans, stop, memory, maps, incidents, feeds and the page: each resource over real HTTP."""

from __future__ import annotations

import asyncio
import base64
from pathlib import Path
from typing import Any

import pytest

from parley.agents.audit_log import AuditLog
from parley.agents.memory import MemoryNode
from parley.errors import FailureCode, StoreError
from parley.gate.audit_store import AuditStore
from parley.language.builtin.engine import BuiltinLanguage
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import ActionCall
from parley.messages.incident import Incident
from parley.messages.map import MapInfo
from parley.messages.memory import AddToMemory, MemoryBody, MemoryEntry
from parley.messages.principal import person
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.status import (
    PlanProposal,
    PlanUpdate,
    PoseInfo,
    Rejection,
    RejectionProblem,
    StopCommand,
    StopReport,
)
from parley.messages.wire import encode
from parley.web.config import MODULES
from parley.web.robot_state import STOP_DEADLINE_S
from parley.web.routes.models import KEYS
from tests.web.rig import JPEG, HandClock, Page, served

GO = ActionCall(name="NavigateTo", reason="go there")


def stop_of(page: Page, name: str = "Ada") -> str:
    states = [change["robot"] for change in page.of("robot") if change["robot"]["name"] == name]
    return str(states[-1]["stop"]["state"]) if states else "none"


async def until_stop(page: Page, state: str) -> None:
    await page.until(lambda: stop_of(page) == state)


async def test_a_stop_is_sent_then_received_then_at_rest_and_stays_until_it_is_reset() -> None:
    async with served("Ada", "Bob") as rig:
        page = await rig.page()
        await rig.http.post("/api/stop", json={"command": "stop", "targets": ["ada"], "id": "s1"})
        await page.until(lambda: stop_of(page) == "sent")
        assert rig.robots.stops[0].targets == ("Ada",)
        for state in ("received", "at_rest"):
            report = StopReport.model_validate({"actor": "Ada", "id": "s1", "state": state})
            rig.robots.tell(topics.STOP_REPORT, report)
            await until_stop(page, state)
        late = await rig.page()
        robots = {robot["name"]: robot["stop"]["state"] for robot in late.snapshots[0]["robots"]}
        assert robots == {"Ada": "at_rest", "Bob": "none"}
        await rig.http.post("/api/stop", json={"command": "reset", "targets": ["Ada"]})
        rig.robots.tell(topics.STOP_REPORT, StopReport(actor="Ada", state="reset"))
        await page.until(lambda: stop_of(page) == "none")


async def test_a_stop_without_targets_is_for_all() -> None:
    async with served("Ada", "Bob") as rig:
        page = await rig.page()
        await rig.http.post("/api/stop", json={})
        await page.until(lambda: stop_of(page, "Ada") == stop_of(page, "Bob") == "sent")
        assert rig.robots.stops[0].targets == ()


async def test_a_robot_of_which_nothing_is_heard_after_a_stop_does_not_answer() -> None:
    clock = HandClock()
    async with served("Ada", clock=clock) as rig:
        page = await rig.page()
        await rig.http.post("/api/stop", json={"targets": ["Ada"]})
        await page.until(lambda: stop_of(page) == "sent")
        clock.ahead_s = STOP_DEADLINE_S + 0.1
        await page.until(lambda: stop_of(page) == "silent")


async def test_a_robot_added_by_name_stays_until_it_is_taken_off(tmp_path: Path) -> None:
    async with served("Ada", data_dir=tmp_path) as rig:
        added = (await rig.http.post("/api/robots", json={"name": "Bob"})).json()
        assert (added["name"], added["connection"]) == ("Bob", "never_seen")
        assert (await rig.http.get("/api/robots/bob")).json()["name"] == "Bob"
        assert (await rig.http.delete("/api/robots/Ada")).status_code == 409
    async with served(data_dir=tmp_path) as rig:
        assert [robot["name"] for robot in (await rig.http.get("/api/robots")).json()] == ["Bob"]
        assert (await rig.http.delete("/api/robots/Bob")).status_code == 200
        assert (await rig.http.get("/api/robots/Bob")).status_code == 404


async def test_a_second_page_on_the_same_folder_is_refused_and_told_what_to_do(tmp_path: Path) -> None:
    async with served(data_dir=tmp_path):
        with pytest.raises(StoreError, match=r"is in use by process .* End that one first"):
            async with served(data_dir=tmp_path):
                pass
    async with served(data_dir=tmp_path):  # it is free again
        pass


@pytest.mark.parametrize(
    ("command", "sent"),
    [("pause", "stop"), ("resume", "start"), ("skip", "skip"), ("clear", "clear"), ("pop", "pop")],
)
async def test_plans_are_controlled_as_by_words(command: str, sent: str) -> None:
    async with served("Ada") as rig:
        body = {"command": command, "index": 2 if command == "pop" else None, "step": "s1"}
        assert (await rig.http.post("/api/plans/ada/command", json=body)).status_code == 200
        await rig.heard()
        (order,) = rig.robots.orders
        assert order.targets == ("Ada",)
        assert order.system_cmd[0].command == sent
        assert order.system_cmd[0].pop_index == (2 if command == "pop" else None)
        assert order.system_cmd[0].arguments.get("step") == ("s1" if command == "skip" else None)


async def test_a_proposal_is_shown_decided_once_and_gone() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.tell(topics.PLAN, PlanProposal(id="p1", target="Ada", message="Shall I?", steps=(GO,)))
        await page.until(lambda: page.of("proposal"))
        step = page.of("proposal")[0]["proposal"]["steps"][0]
        assert (step["action"], step["label"], step["reason"]) == ("NavigateTo", "navigate to", "go there")
        edit = {"id": "p1", "decision": "edit", "steps": [step["call"], step["call"]]}
        assert (await rig.http.post("/api/plans/Ada/decision", json=edit)).status_code == 200
        await rig.heard()
        assert rig.robots.decisions[0].steps == (GO, GO)
        yes = {"id": "p1", "decision": "approve"}
        assert (await rig.http.post("/api/plans/Ada/decision", json=yes)).status_code == 409
        refused = Rejection(source="planner", target="Ada", what="/parley/plan_decision")
        rig.robots.tell(topics.REJECTION, refused)
        await rig.heard()
        assert not page.of("rejection"), "whoever pressed is told, and so is the chat"
        assert (await rig.http.post("/api/plans/Ada/decision", json=yes)).status_code == 200
        rig.robots.tell(topics.PLAN, PlanUpdate(target="Ada", graph_name="g", state="running"))
        await page.until(lambda: page.of("proposal_gone"))
        assert (await rig.http.post("/api/plans/Ada/decision", json=yes)).status_code == 409


async def test_pending_steps_are_edited_if_the_plan_is_still_the_one_that_was_seen() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        update = PlanUpdate.model_validate(
            {
                "target": "Ada",
                "graph_name": "g",
                "state": "running",
                "revision": 4,
                "policy": "ask_when_risky",
                "steps": [{"action": GO.model_dump(), "node": "NavigateTo_0", "state": "running"}],
            }
        )
        rig.robots.tell(topics.PLAN, update)
        await page.until(lambda: page.of("plan") and page.of("robot"))
        assert page.of("robot")[-1]["robot"]["policy"] == "ask_when_risky"
        steps = [GO.model_dump()]
        stale = await rig.http.put("/api/plans/Ada/steps", json={"steps": steps, "revision": 3})
        assert (stale.status_code, stale.json()["path"]) == (409, "revision")
        good = await rig.http.put("/api/plans/Ada/steps", json={"steps": steps, "revision": 4})
        assert good.status_code == 200
        await rig.heard()
        (decision,) = rig.robots.decisions
        assert (decision.id, decision.revision, decision.steps) == ("", 4, (GO,))
        later = update.model_copy(update={"revision": 5, "state": "paused"})
        rig.robots.tell(topics.PLAN, later)
        await page.until(lambda: page.of("plan")[-1]["plan"]["revision"] == 5)
        same = await rig.http.put("/api/plans/Ada/steps", json={"steps": steps, "revision": 4})
        assert same.status_code == 200, "what has not begun is as it was"


async def test_a_policy_is_sent_and_told_again_to_a_robot_that_comes_later(tmp_path: Path) -> None:
    async with served("Ada", data_dir=tmp_path) as rig:
        await rig.http.put("/api/plans/Ada/policy", json={"policy": "ask_first"})
        await rig.heard()
        assert rig.robots.decisions[-1].policy == "ask_first"
    async with served(data_dir=tmp_path) as rig:
        rig.robots.appear("Ada")
        await rig.heard()
        await rig.heard()  # what the first message brought about was published before this one
        assert [decision.policy for decision in rig.robots.decisions] == ["ask_first"]


async def test_memories_are_kept_found_shown_and_forgotten() -> None:
    async with (
        served("Ada") as rig,
        await MemoryStore.open(":memory:") as store,
        MemoryNode(rig.robots.transport, store, BuiltinLanguage()),
    ):
        page = await rig.page()
        picture = base64.b64encode(JPEG).decode()
        note = {"data": "The box is by the door.", "info": "where the box is"}
        assert (await rig.http.put("/api/memory?name=box", json=note)).status_code == 200
        photo = {"type": "image", "data": picture, "info": "my desk"}
        assert (await rig.http.put("/api/memory?name=my desk", json=photo)).status_code == 200
        await page.until(lambda: len(page.of("memory")) == 2)
        items = {item["name"]: item for item in (await rig.http.get("/api/memory")).json()}
        assert items["box"]["data"] == "The box is by the door."
        assert (await rig.http.get(items["my desk"]["data"])).content == JPEG
        assert (await rig.http.get("/api/memory/one?name=box")).json()["source"] == "operator"
        assert (await rig.http.get("/api/memory/image?name=box")).status_code == 404
        found = (await rig.http.get("/api/memory", params={"q": "door"})).json()
        assert [item["name"] for item in found] == ["box"]
        assert (await rig.http.delete("/api/memory?name=box")).status_code == 200
        history = (await rig.http.get("/api/memory/history?name=box")).json()
        assert [item["data"] for item in history] == ["The box is by the door."]
        assert (await rig.http.delete("/api/memory?name=box")).status_code == 404
        noted = "I saw the box at the point (1.1, -2.0), by the door."
        seen = MemoryBody(data=noted, info="", way="seen")
        rig.robots.tell(topics.ADD_TO_MEMORY, AddToMemory({"sighting": seen}))
        await rig.heard()
        for language, told in (("en", "I saw the box, by the door."), ("et", "Nägin: box, koht: door.")):
            one = await rig.http.get("/api/memory/one?name=sighting", headers={"accept-language": language})
            assert (one.json()["data"], one.json()["told"]) == (noted, told)
        assert (await rig.http.get("/api/memory/one?name=box")).status_code == 404


NAMES = ("boxes/left", "/", "..", ".", "a?b#c&d=e%2F", "one", "history", "küche 厨房", "+ +", "x" * 200)


async def test_memories_of_any_name_can_be_reached() -> None:
    async with (
        served("Ada") as rig,
        await MemoryStore.open(":memory:") as store,
        MemoryNode(rig.robots.transport, store, BuiltinLanguage()),
    ):
        photo = {"type": "image", "data": base64.b64encode(JPEG).decode()}
        for name in NAMES:
            asked = {"name": name}
            assert (await rig.http.put("/api/memory", params=asked, json=photo)).status_code == 200
            item = (await rig.http.get("/api/memory/one", params=asked)).json()
            assert item["name"] == name
            assert (await rig.http.get(item["data"])).content == JPEG
            assert (await rig.http.delete("/api/memory", params=asked)).status_code == 200
            assert len((await rig.http.get("/api/memory/history", params=asked)).json()) == 1
        assert (await rig.http.get("/api/memory")).json() == []


async def test_a_forgotten_memory_that_is_brought_back_keeps_where_it_came_from() -> None:
    async with (
        served("Ada") as rig,
        await MemoryStore.open(":memory:") as store,
        MemoryNode(rig.robots.transport, store, BuiltinLanguage()),
    ):
        seen = MemoryEntry(
            name="box", data="The box is by the door.", info="the box", source="Ada/Inspect", way="seen"
        )
        await store.add(seen)
        assert (await rig.http.delete("/api/memory?name=box")).status_code == 200
        back = {"data": seen.data, "info": seen.info, "again": True}
        assert (await rig.http.put("/api/memory?name=box", json=back)).status_code == 200
        known = (await rig.http.get("/api/memory/one?name=box")).json()
        assert (known["source"], known["way"]) == ("Ada/Inspect", "seen"), "an undo makes nothing told"
        assert (await rig.http.delete("/api/memory?name=box")).status_code == 200
        changed = {**back, "data": "The box is gone."}
        assert (await rig.http.put("/api/memory?name=box", json=changed)).status_code == 200
        assert (await rig.http.get("/api/memory/one?name=box")).json()["source"] == "operator"


async def test_what_is_not_running_is_said_in_plain_words() -> None:
    async with served("Ada") as rig:
        for path in ("/api/memory", "/api/map/Ada"):
            answer = await rig.http.get(path)
            assert answer.status_code == 503
            assert "not running" in answer.json()["detail"]
        assert (await rig.http.get("/api/incidents")).json() == []


async def test_a_map_is_handed_on() -> None:
    async with served("Ada") as rig:
        shown = MapInfo(robot="Ada", resolution=0.05, width=2, height=1, origin=PoseInfo(x=0, y=0), image="x")

        async def answer(_: ChatRequest) -> ChatResponse:
            return ChatResponse(encode(shown))

        await rig.robots.transport.serve(topics.GET_MAP, answer)
        assert (await rig.http.get("/api/map/ada")).json()["width"] == 2


async def test_an_order_is_kept_under_a_name_told_to_every_page_and_still_there_after_a_restart(
    tmp_path: Path,
) -> None:
    async with served("Ada", data_dir=tmp_path) as rig:
        page = await rig.page()

        async def put(name: str, words: str, was: str = "") -> int:
            body = {"words": words, "was": was}
            return (await rig.http.put("/api/favourites", params={"name": name}, json=body)).status_code

        assert await put("round", "go to the box") == 200
        assert await put("evening", "go to the door") == 200
        assert [await put("Round", "x"), await put("emergency stop", "x")] == [409, 422]
        assert await put("Morning round", "go to the box\ngo to the door", was="round") == 200
        assert (await rig.http.delete("/api/favourites?name=evening")).status_code == 200
        kept = [{"name": "Morning round", "words": "go to the box\ngo to the door"}]
        await page.until(lambda: page.of("favourites") and page.of("favourites")[-1]["favourites"] == kept)
    async with served("Ada", data_dir=tmp_path) as rig:
        assert (await rig.http.get("/api/snapshot")).json()["favourites"] == kept
        assert (await rig.http.get("/api/favourites")).json() == kept


async def test_incidents_are_told_live_and_listed() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        happened = Incident(id="i1", robot="Ada", step=GO, code=FailureCode.BLOCKED, message="No way.")
        rig.robots.tell(topics.INCIDENT, happened)
        await page.until(lambda: page.of("incident"))
        assert [item["id"] for item in (await rig.http.get("/api/incidents?robot=Ada")).json()] == ["i1"]
        assert (await rig.http.get("/api/incidents?robot=Bob")).json() == []


async def test_the_log_is_told_in_sentences_of_a_language_page_by_page() -> None:
    async with served("Ada") as rig:
        assert (await rig.http.get("/api/audit")).status_code == 503
        clock, transport = HandClock(), rig.robots.transport
        async with await AuditStore.open(":memory:", clock) as store, AuditLog(transport, store, clock):
            rig.robots.tell(topics.STOP, StopCommand(targets=("Ada",), by=person("Kim", device="phone")))
            await rig.until(lambda: rig.robots.stops)
            newest = (await rig.http.get("/api/audit?limit=1&verify=true")).json()
            assert [line["text"] for line in newest["lines"]] == ["Kim (phone) stopped Ada."]
            assert (newest["complete"], newest["chain"]["problem"]) == (False, "")
            path = f"/api/audit?before={newest['lines'][0]['number']}&language=et"
            older = (await rig.http.get(path)).json()
            assert [line["text"] for line in older["lines"]] == ["Parley käivitati, logi jätkub."]
            assert older["complete"]


async def test_the_last_picture_of_a_feed_can_be_fetched() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.show("Ada", "inspection")
        await page.until(lambda: page.of("feed"))
        (feed,) = (await rig.http.get("/api/feeds")).json()
        assert (feed["robot"], feed["name"], feed["continuous"]) == ("Ada", "inspection", False)
        answer = await rig.http.get("/api/feeds/Ada/inspection.jpg")
        assert (answer.content, answer.headers["content-type"]) == (JPEG, "image/jpeg")
        assert (await rig.http.get("/api/feeds/Ada/none.jpg")).status_code == 404


@pytest.mark.parametrize(
    ("rejection", "told"),
    [
        ({"source": "Ada", "what": "umrf_graph_start", "problems": ["stop_latched"]}, "emergency stop"),
        ({"source": "Ada", "what": "/parley/stop", "problems": ["still_moving"]}, "Please press"),
        (
            {"source": "Ada", "what": "umrf_graph_start", "problems": ["unknown_action"]},
            "nothing was changed",
        ),
    ],
)
async def test_refusals_are_told_in_plain_words(rejection: dict[str, Any], told: str) -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        problems = [
            RejectionProblem(message="Ada still moves", remedy="press the switch", code=code)
            for code in rejection["problems"]
        ]
        rig.robots.tell(
            topics.REJECTION, Rejection.model_validate({**rejection, "target": "Ada", "problems": problems})
        )
        await page.until(lambda: page.of("rejection"))
        assert told in page.of("rejection")[0]["message"]


@pytest.mark.parametrize("module", MODULES)
async def test_a_module_that_is_switched_off_is_not_there(module: str) -> None:
    paths = {
        "chat": "/api/chat",
        "plan": "/api/plans/Ada",
        "display": "/api/feeds",
        "map": "/api/map/Ada",
        "memory": "/api/memory",
        "robots": "/api/robots",
        "rules": "/api/rules",
        "incidents": "/api/incidents",
        "log": "/api/audit",
    }
    async with served("Ada", without=frozenset({module})) as rig:
        assert (await rig.http.get(paths[module])).status_code == 404
        modules = (await rig.http.get("/api/info")).json()["modules"]
        assert [name for name, is_on in modules.items() if not is_on] == [module]


async def test_the_page_is_served_from_its_folder_and_nothing_else_is(tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("secret")
    built = tmp_path / "built"
    (built / "assets").mkdir(parents=True)
    (built / "index.html").write_text('<meta property="csp-nonce" nonce="__CSP_NONCE__">page')
    (built / "assets" / "page-1a2b.js").write_text("run()")
    async with served(static_dir=built) as rig:
        page = await rig.http.get("/")
        nonce = page.text.split('nonce="')[1].split('"')[0]
        assert f"'nonce-{nonce}'" in page.headers["content-security-policy"]
        assert (await rig.http.get("/plan/of/Ada")).text.endswith("page")
        script = await rig.http.get("/assets/page-1a2b.js")
        assert script.headers["content-encoding"] == "gzip"
        unpacked = await rig.http.get("/assets/page-1a2b.js", headers={"Accept-Encoding": "identity"})
        assert (unpacked.text, unpacked.headers.get("content-encoding")) == ("run()", None)
        assert (script.text, script.headers["cache-control"]) == (
            "run()",
            "public, max-age=31536000, immutable",
        )
        assert (await rig.http.get("/assets/other.js")).status_code == 404
        for path in ("/../secret.txt", "/%2e%2e/secret.txt", "/assets/..%2f..%2fsecret.txt"):
            assert "secret" not in (await rig.http.get(path)).text


async def test_where_the_page_is_not_built_it_says_how(tmp_path: Path) -> None:
    async with served(static_dir=tmp_path) as rig:
        assert "make page" in (await rig.http.get("/")).text


async def test_the_address_is_shown_as_a_picture_for_phones() -> None:
    async with served() as rig:
        answer = await rig.http.get("/api/qr.svg")
        assert answer.headers["content-type"].startswith("image/svg+xml")
        assert answer.text.startswith("<svg")


async def test_models_on_this_machine_are_offered_and_only_looked_for_when_asked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[str] = []

    async def ollama(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        asked.append((await reader.readline()).decode().split()[1])
        body = b'{"models": [{"name": "qwen3:8b"}, {"name": 7}, "x"]}'
        writer.write(b"HTTP/1.0 200 OK\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
        await writer.drain()
        writer.close()

    for name in KEYS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MISTRAL_API_KEY", "secret-key")
    async with await asyncio.start_server(ollama, "127.0.0.1", 0) as server:
        address = f"http://127.0.0.1:{server.sockets[0].getsockname()[1]}"
        async with served("Ada", local_models=address) as rig:
            assert asked == []
            found = await rig.http.get("/api/models")
            assert [(one["language"], one["found"]) for one in found.json()] == [
                (f"auto:ollama:qwen3:8b@{address}/v1", "Ollama"), ("auto:mistral:", "MISTRAL_API_KEY"),
            ]  # fmt: skip
            assert "secret" not in found.text
        async with served("Ada", local_models=address, offline_language=False) as rig:
            assert (await rig.http.get("/api/models")).json() == []
        assert asked == ["/api/tags"]
    async with served("Ada", local_models=address) as rig:  # nobody listens any more
        assert [one["found"] for one in (await rig.http.get("/api/models")).json()] == ["MISTRAL_API_KEY"]
