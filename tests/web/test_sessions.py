"""Who is signed in, over restarts too; pairing codes are for one device and not for long."""

from __future__ import annotations

import asyncio
from pathlib import Path

import httpx
import pytest

from parley.clock import WallClock
from parley.messages.chat import ChatInput
from parley.web.models import ChatEntry
from parley.web.people.codes import CODE_S, TRIES, Codes
from parley.web.people.records import Gadget
from parley.web.people.store import PeopleStore
from parley.web.problems import WebProblem
from parley.web.sessions import SESSION_S, Sessions, Visitor
from parley.web.store import WebStore
from tests.web.rig import HandClock, Rig, served

SOMEBODY = Visitor(Gadget(address="192.0.2.1"))
PASSWORD = "correct horse battery"


async def sign_in(rig: Rig, secret: str = PASSWORD, name: str = "") -> httpx.Response:
    return await rig.http.post("/api/session", json={"secret": secret, "name": name})


async def is_in(rig: Rig, cookies: dict[str, str]) -> bool:
    header = "; ".join(f"{name}={value}" for name, value in cookies.items())
    return (await rig.http.get("/api/snapshot", headers={"Cookie": header})).status_code == 200


async def test_a_restart_signs_nobody_out_but_another_password_does(tmp_path: Path) -> None:
    async with served(lan=True, password=PASSWORD, data_dir=tmp_path) as rig:
        await sign_in(rig, name="Kim")
        cookies = dict(rig.http.cookies)
    async with served(lan=True, password=PASSWORD, data_dir=tmp_path) as rig:
        assert await is_in(rig, cookies)
        rig.http.cookies.update(cookies)
        assert (await rig.http.get("/api/session")).json()["name"] == "Kim"
    async with served(lan=True, password="another password", data_dir=tmp_path) as rig:
        assert not await is_in(rig, cookies)
    async with served(lan=True, data_dir=tmp_path) as rig:
        assert not await is_in(rig, cookies)


async def test_who_signed_out_stays_out_after_a_restart(tmp_path: Path) -> None:
    async with served(lan=True, password=PASSWORD, data_dir=tmp_path) as rig:
        await sign_in(rig)
        cookies = dict(rig.http.cookies)
        await rig.http.delete("/api/session")
        assert not await is_in(rig, cookies)
    async with served(lan=True, password=PASSWORD, data_dir=tmp_path) as rig:
        assert not await is_in(rig, cookies)


async def test_a_name_told_on_this_machine_opens_nothing_in_the_network(tmp_path: Path) -> None:
    async with served(data_dir=tmp_path) as rig:
        await rig.http.post("/api/session", json={"name": "Kim"})
        (token,) = dict(rig.http.cookies).values()
    async with served(lan=True, data_dir=tmp_path) as rig:
        assert not await is_in(rig, {"__Host-parley_session": token, "parley_session": token})


async def test_a_pairing_code_lets_one_device_in_and_the_next_one_is_told() -> None:
    async with served(lan=True) as rig:
        told: list[str] = []
        first = rig.server.pairing_code
        rig.server.backend.sessions.codes.on_new = told.append
        answers = await asyncio.gather(*[sign_in(rig, first) for _ in range(3)])
        assert sorted(answer.status_code for answer in answers) == [200, 401, 401]
        assert told == [rig.server.pairing_code] != [first]
        assert (await sign_in(rig, told[0])).status_code == 200


async def test_a_code_that_nobody_used_gives_way_to_another_after_an_hour() -> None:
    clock = HandClock()
    sessions = Sessions(clock, pairs=True)
    async with await PeopleStore.open(":memory:", clock) as store:
        await sessions.restore(store)
        old = sessions.code
        clock.ahead_s = CODE_S - 10
        assert sessions.code == old
        clock.ahead_s = CODE_S + 10
        with pytest.raises(WebProblem):
            await sessions.sign_in(old, "", SOMEBODY)
        assert await sessions.sign_in(sessions.code, "", SOMEBODY)


async def test_a_session_ends_by_itself() -> None:
    clock = HandClock()
    sessions = Sessions(clock)
    async with await PeopleStore.open(":memory:", clock) as store:
        await sessions.restore(store)
        token = await sessions.sign_in("", "Kim", SOMEBODY)
        assert sessions.get(token)
        clock.ahead_s = SESSION_S + 1
        assert sessions.get(token) is None
        assert (await store.roll()).devices == {}


async def test_a_cookie_that_somebody_planted_is_not_taken_over() -> None:
    async with served(lan=True, password=PASSWORD) as rig:
        planted = {"__Host-parley_session": "planted"}
        header = {"Cookie": "__Host-parley_session=planted"}
        await rig.http.post("/api/session", json={"secret": PASSWORD}, headers=header)
        first = dict(rig.http.cookies)
        assert first["__Host-parley_session"] != "planted"
        assert not await is_in(rig, planted)
        await sign_in(rig)
        assert dict(rig.http.cookies) != first
        assert not await is_in(rig, first), "signing in anew ends the session before"


async def test_nothing_that_is_kept_can_be_used_to_sign_in(tmp_path: Path) -> None:
    async with served(lan=True, password=PASSWORD, data_dir=tmp_path) as rig:
        await sign_in(rig)
        token = dict(rig.http.cookies)["__Host-parley_session"]
        kept = {file: file.read_bytes() for file in [tmp_path / "people.db", tmp_path / "people.db-wal"]}
        for file, content in kept.items():
            assert token.encode() not in content
            assert PASSWORD.encode() not in content
            assert file.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize(("fresh", "age_ms"), [(True, 1000), (False, 3_600_000)])
async def test_a_message_of_long_ago_that_may_not_have_gone_out_is_told_of_and_not_sent(
    tmp_path: Path, fresh: bool, age_ms: int
) -> None:
    clock = WallClock()
    async with await WebStore.open(tmp_path / "web.db", clock) as store:
        entry = ChatEntry(
            id="m1", seq=1, unix_ms=clock.unix_ms() - age_ms, who="operator", targets=("Ada",),
            type="request", message="go home",
        )  # fmt: skip
        await store.keep([entry], messages=[ChatInput(message="go home", targets=("Ada",), id="m1")])
    for _ in range(2):  # once, however often it is started
        async with served("Ada", data_dir=tmp_path, fresh_robots=fresh) as rig:
            await rig.heard()
            assert rig.robots.inputs == []
    async with served("Ada", data_dir=tmp_path) as rig:
        entries = (await rig.http.get("/api/chat")).json()["entries"]
        assert [(entry["who"], entry["type"]) for entry in entries] == [
            ("operator", "request"),
            ("robot", "error"),
        ]
        assert "go home" in entries[1]["message"]


@pytest.mark.parametrize(("fresh", "found"), [(True, "interrupted"), (False, "open")])
async def test_a_question_whose_robot_starts_anew_is_not_called_needless(
    tmp_path: Path, fresh: bool, found: str
) -> None:
    async with served("Ada", data_dir=tmp_path) as rig:
        rig.robots.ask("Is it on me?")
        await rig.until(lambda: rig.server.backend.state.chat.entries)
    async with served("Ada", data_dir=tmp_path, fresh_robots=fresh) as rig:
        (entry,) = (await rig.http.get("/api/chat")).json()["entries"]
        assert entry["question"] == found


def test_after_many_wrong_tries_a_code_gives_way_to_another_whoever_tried() -> None:
    told: list[str] = []
    codes = Codes("viewer")
    codes.on_new = told.append
    first = codes.shown(0.0)
    for _ in range(TRIES - 1):
        assert codes.take("2222-2222", 0.0, is_shown=True) is None
    assert codes.shown(0.0) == first
    assert codes.take("2222-2222", 0.0, is_shown=True) is None
    assert codes.take(first, 0.0, is_shown=True) is None
    assert told[-1] == codes.shown(0.0) != first
    assert codes.take(told[-1], 0.0, is_shown=True) == "viewer"


async def test_a_stranger_who_guesses_locks_nobody_else_out() -> None:
    sessions = Sessions(HandClock(), pairs=True)
    async with await PeopleStore.open(":memory:", HandClock()) as store:
        await sessions.restore(store)
        for place in ("192.0.2.9", "2001:db8::1"):
            stranger = Visitor(Gadget(address=place))
            for _ in range(5):
                with pytest.raises(WebProblem, match="not right"):
                    await sessions.sign_in("2222-2222", "", stranger)
            with pytest.raises(WebProblem, match="too many"):
                await sessions.sign_in(sessions.code, "", stranger)
        with pytest.raises(WebProblem, match="too many"):
            await sessions.sign_in(sessions.code, "", Visitor(Gadget(address="2001:db8::ffff")))
        assert await sessions.sign_in(sessions.code, "", SOMEBODY)
