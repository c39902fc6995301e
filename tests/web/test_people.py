"""Accounts, devices and what becomes of those who are signed in when somebody changes them."""

from __future__ import annotations

import asyncio
from pathlib import Path

import httpx
import pytest

from parley.clock import WallClock
from parley.errors import StoreError
from parley.messages import topics
from parley.messages.chat import ActionCall
from parley.messages.principal import person
from parley.messages.status import PlanProposal
from parley.web.people.passwords import Passwords
from parley.web.people.store import FILE, PeopleError, PeopleStore
from tests.web.rig import Page, Rig, served

PASSWORD = "correct horse battery"
SETTER = person("Ada", device="command line", role="supervisor")


class Guest:
    """Somebody with a browser of their own."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.http = httpx.AsyncClient(base_url=rig.url, verify=False, timeout=20)

    async def __aenter__(self) -> Guest:
        return self

    async def __aexit__(self, *exc: object) -> None:
        await self.http.aclose()

    async def enter(self, name: str, secret: str = PASSWORD) -> httpx.Response:
        """Sign in."""
        return await self.http.post("/api/session", json={"name": name, "secret": secret})

    async def make(self, name: str, role: str = "operator") -> httpx.Response:
        """Make an account."""
        return await self.http.post("/api/people", json={"name": name, "role": role, "password": PASSWORD})

    async def status(self) -> int:
        """What comes of looking."""
        return (await self.http.get("/api/robots")).status_code

    async def page(self) -> tuple[Page, asyncio.Event, list[object]]:
        """Their page: open, whether it was hung up on, and what it heard of its own session."""
        cookie = "; ".join(f"{name}={value}" for name, value in self.http.cookies.items())
        page = await self.rig.page(**({"headers": {"Cookie": cookie}} if cookie else {}))
        gone, told = asyncio.Event(), list[object]()

        def hear(data: object) -> None:
            told.append(data)
            page._changed.set()

        page.io.on("disconnect", lambda *_: gone.set())
        page.io.on("session", hear)
        return page, gone, told


async def wait_for(event: asyncio.Event) -> None:
    async with asyncio.timeout(10):
        await event.wait()


async def test_the_first_account_is_a_supervisors_and_from_then_on_everybody_signs_in() -> None:
    async with served("Ada") as rig, Guest(rig) as kim, Guest(rig) as stranger:
        session = (await kim.http.get("/api/session")).json()
        assert (session["way"], session["role"], "people" in session["may"]) == ("open", "supervisor", True)
        _, gone, _ = await stranger.page()
        made = await kim.make("Kim", "viewer")
        assert made.json()["role"] == "supervisor"
        await wait_for(gone)
        assert (await kim.status(), await stranger.status()) == (200, 401)
        assert (await stranger.make("Eve", "supervisor")).status_code == 401
        assert (await stranger.enter("Kim", "wrong password")).status_code == 401
        assert (await stranger.enter("Nobody")).status_code == 401
        assert (await stranger.enter(" KIM ")).json()["name"] == "Kim"
        assert await stranger.status() == 200
        assert (await kim.make("kim")).status_code == 409
        assert (await kim.make("a/b")).status_code == 409
        assert (await kim.make("K\u202eim")).status_code == 409


async def test_the_last_supervisor_stays_one() -> None:
    async with served() as rig, Guest(rig) as kim:
        await kim.make("Kim")
        for change in ({"role": "viewer"}, {"disabled": True}):
            answer = await kim.http.put("/api/people/Kim", json=change)
            assert (answer.status_code, "last supervisor" in answer.json()["detail"]) == (409, True)
        assert (await kim.http.delete("/api/people/Kim")).status_code == 409
        await kim.make("Ann", "supervisor")
        assert (await kim.http.put("/api/people/Kim", json={"role": "viewer"})).status_code == 200
        assert (await kim.make("Ben")).status_code == 403, "the new role counts at once"


async def test_whoever_is_disabled_revoked_or_signed_out_is_off_the_live_stream_at_once() -> None:
    async with served("Ada") as rig, Guest(rig) as kim, Guest(rig) as ann:
        await kim.make("Kim")
        await kim.make("Ann", "operator")

        async def leaves(how: str) -> None:
            _, gone, _ = await ann.page()
            match how:
                case "disabled":
                    await kim.http.put("/api/people/Ann", json={"disabled": True})
                case "password":
                    await kim.http.put("/api/people/Ann", json={"password": PASSWORD})
                case "revoked":
                    devices = (await kim.http.get("/api/people")).json()["devices"]
                    (key,) = [device["id"] for device in devices if device["name"] == "Ann"]
                    assert (await kim.http.delete(f"/api/people/devices/{key}")).status_code == 200
                case "signed out":
                    await ann.http.delete("/api/session")
                case "everywhere":
                    await ann.http.delete("/api/me/devices")
                case "removed":
                    await kim.http.delete("/api/people/Ann")
            await wait_for(gone)
            assert await ann.status() == 401

        for how in ("revoked", "signed out", "everywhere", "password", "disabled", "removed"):
            assert (await ann.enter("Ann")).status_code == 200, how
            await leaves(how)
            if how == "disabled":
                assert (await ann.enter("Ann")).status_code == 401
                await kim.http.put("/api/people/Ann", json={"disabled": False})
        assert await kim.status() == 200


async def test_another_role_counts_at_once_on_the_same_live_stream() -> None:
    async with served("Ada") as rig, Guest(rig) as kim, Guest(rig) as ann:
        await kim.make("Kim")
        await kim.make("Ann", "operator")
        await ann.enter("Ann")
        page, gone, told = await ann.page()
        await kim.http.put("/api/people/Ann", json={"role": "viewer"})
        await page.until(lambda: told)
        post = {"id": "m1", "text": "go", "targets": ["Ada"]}
        assert (await ann.http.post("/api/chat", json=post)).status_code == 403
        assert (await ann.http.post("/api/stop", json={})).status_code == 200
        assert (await ann.http.get("/api/session")).json()["role"] == "viewer"
        assert not gone.is_set()


async def test_what_the_command_line_changes_counts_in_a_running_server_and_is_told_of(
    tmp_path: Path,
) -> None:
    hashed = Passwords().hashed(PASSWORD)
    async with (
        served("Ada", data_dir=tmp_path) as rig,
        await PeopleStore.open(tmp_path / FILE, WallClock()) as outside,
        Guest(rig) as ann,
    ):
        _, gone, _ = await ann.page()
        await outside.add("Kim", "supervisor", hashed, SETTER)
        await outside.add("Ann", "operator", hashed, SETTER)
        await rig.server.backend.sessions.look()
        await wait_for(gone)
        await ann.enter("Ann")
        _, gone, _ = await ann.page()
        await outside.set_disabled("ann", True, SETTER)
        await rig.server.backend.sessions.look()
        await wait_for(gone)
        assert await ann.status() == 401
        await rig.heard()
        assert [(e.effect, e.words, e.by.device if e.by else "") for e in rig.robots.audited] == [
            ("people", "added Kim as supervisor", "command line"),
            ("people", "added Ann as operator", "command line"),
            ("sign_in", "", "a program"),
            ("people", "disabled Ann", "command line"),
        ]


async def test_a_revoked_device_stays_out_and_another_one_in_over_a_restart(tmp_path: Path) -> None:
    async with served(data_dir=tmp_path) as rig, Guest(rig) as kim, Guest(rig) as phone:
        await kim.make("Kim")
        await phone.enter("Kim")
        mine = (await kim.http.get("/api/me")).json()["devices"]
        assert [device["here"] for device in mine] == [True, False]
        await kim.http.delete(f"/api/me/devices/{mine[1]['id']}")
        kept, lost = dict(kim.http.cookies), dict(phone.http.cookies) or {"parley_session": "x"}
    async with served(data_dir=tmp_path) as rig, Guest(rig) as kim, Guest(rig) as phone:
        kim.http.cookies.update(kept)
        phone.http.cookies.update(lost)
        assert (await kim.status(), await phone.status()) == (200, 401)


async def test_who_changes_their_password_stays_in_here_and_nowhere_else() -> None:
    async with served() as rig, Guest(rig) as kim, Guest(rig) as phone:
        await kim.make("Kim")
        await phone.enter("Kim")
        wrong = await kim.http.put("/api/me/password", json={"old": "wrong", "new": "another password"})
        assert (wrong.status_code, wrong.json()["path"]) == (422, "old")
        done = await kim.http.put("/api/me/password", json={"old": PASSWORD, "new": "another password"})
        assert done.status_code == 200
        assert (await kim.status(), await phone.status()) == (200, 401)
        assert (await phone.enter("Kim")).status_code == 401
        assert (await phone.enter("Kim", "another password")).status_code == 200


async def test_a_code_gives_the_role_it_was_made_for_and_nobody_elses_name() -> None:
    async with served(lan=True, pair_as="viewer") as rig, Guest(rig) as wall:
        await wall.enter("Hall", rig.server.pairing_code)
        assert (await wall.http.get("/api/session")).json()["role"] == "viewer"
        assert (await wall.http.post("/api/people/code", json={"role": "operator"})).status_code == 403
    async with served() as rig, Guest(rig) as kim, Guest(rig) as wall:
        await kim.make("Kim")
        code = (await kim.http.post("/api/people/code", json={"role": "operator"})).json()["code"]
        assert (await wall.enter("KIM", code)).status_code == 401, "that is somebody else"
        assert (await wall.enter("Hall", code)).json()["role"] == "operator"
        assert (await wall.enter("Hall", code)).status_code == 401, "it lets one device in"


async def test_the_picture_for_phones_carries_a_code_only_for_who_may_as_much() -> None:
    async with served(lan=True, pair_as="viewer") as rig, Guest(rig) as wall:
        await wall.enter("Hall", rig.server.pairing_code)
        with_code = (await wall.http.get("/api/qr.svg")).text
        rig.server.backend.sessions.codes.role = "operator"
        assert (await wall.http.get("/api/qr.svg")).text != with_code


async def test_a_password_of_all_counts_on_this_machine_too() -> None:
    async with served(password=PASSWORD) as rig, Guest(rig) as kim:
        assert rig.url.startswith("http://127.0.0.1")
        assert await kim.status() == 401
        assert (await kim.enter("Kim")).json()["role"] == "supervisor"
        assert await kim.status() == 200


async def test_a_yes_counts_only_for_the_plan_that_was_shown() -> None:
    async with served("Ada") as rig:
        steps = (ActionCall(name="look"), ActionCall(name="drive"))
        rig.robots.tell(
            topics.PLAN,
            PlanProposal(
                id="p1", target="Ada", steps=steps, labels=("Look at the door",), digest="d1",
                by=person("Kim"), why="it is far",
            ),
        )  # fmt: skip
        await rig.heard()
        (shown,) = (await rig.http.get("/api/snapshot")).json()["proposals"]
        assert [step["label"] for step in shown["steps"]] == ["Look at the door", "drive"]
        assert (shown["digest"], shown["why"], shown["by"]["name"]) == ("d1", "it is far", "Kim")
        url = "/api/plans/Ada/decision"
        for digest in ("", "d2"):
            answer = await rig.http.post(url, json={"id": "p1", "decision": "approve", "digest": digest})
            assert answer.status_code == 409
        await rig.http.post(url, json={"id": "p1", "decision": "approve", "digest": "d1"})
        await rig.heard()
        (decision,) = rig.robots.decisions
        assert (decision.digest, decision.by and decision.by.kind) == ("d1", "person")


async def test_who_came_and_who_was_refused_is_told_of() -> None:
    async with served("Ada") as rig, Guest(rig) as kim:
        await kim.make("Kim")
        await kim.make("Ann", "viewer")
        await kim.http.delete("/api/session")
        await kim.enter("Kim", "wrong password")
        await kim.enter("Ann")
        await kim.http.post("/api/robots", json={"name": "Bob"})
        await rig.heard()
        told = [(e.effect, e.outcome, e.by.name if e.by else None) for e in rig.robots.audited]
        assert told == [
            ("people", "done", ""),
            ("sign_in", "done", "Kim"),
            ("people", "done", "Kim"),
            ("sign_out", "done", "Kim"),
            ("sign_in", "refused", None),
            ("sign_in", "done", "Ann"),
            ("setting", "refused", "Ann"),
        ]
        assert rig.robots.audited[4].detail["name"] == "Kim"


async def test_a_damaged_file_of_people_opens_no_door(tmp_path: Path) -> None:
    async with await PeopleStore.open(tmp_path / FILE, WallClock()) as store:
        await store.add("Kim", "supervisor", "x", SETTER)
    (tmp_path / FILE).write_bytes(b"nothing of the kind" * 100)
    for _ in range(2):
        with pytest.raises(StoreError, match="people"):
            await PeopleStore.open(tmp_path / FILE, WallClock())


async def test_a_passkey_that_nobody_asked_for_opens_nothing() -> None:
    async with served() as rig, Guest(rig) as kim:
        await kim.make("Kim")
        local = {"Host": rig.url.split("/")[2].replace("127.0.0.1", "localhost")}
        asked = await kim.http.post("/api/session/passkey/options", headers=local)
        assert asked.json()["options"]["rpId"] == "localhost"
        assert (await kim.http.post("/api/session/passkey/options")).status_code == 409
        kim.http.cookies.clear()
        body = {"id": asked.json()["id"], "credential": {"id": "abc", "type": "public-key"}}
        assert (await kim.http.post("/api/session/passkey", json=body, headers=local)).status_code == 401


async def test_the_store_names_who_is_not_there() -> None:
    async with await PeopleStore.open(":memory:", WallClock()) as store:
        with pytest.raises(PeopleError, match="Kim"):
            await store.set_role("Kim", "viewer", SETTER)
