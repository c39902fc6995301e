"""The server is killed between keeping, sending and noting that: nothing is lost, nothing is said twice."""

from __future__ import annotations

import itertools
import json
import random
import sqlite3
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import httpx
import pytest

from parley.agents.questions import SeenIds


@contextmanager
def server(folder: Path, moment: str) -> Iterator[tuple[subprocess.Popen[str], httpx.Client]]:
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.web.killed_server", str(folder), moment],
        stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert process.stdout is not None
        url = next(line for line in process.stdout if line.startswith("http")).strip()
        with httpx.Client(base_url=url, timeout=20) as client:
            yield process, client
    finally:
        process.kill()
        process.communicate(timeout=15)


def post(client: httpx.Client, key: str) -> bool:
    """Whether it was acknowledged."""
    try:
        answer = client.post("/api/chat", json={"id": key, "text": f"go to {key}", "targets": ["Ada"]})
    except httpx.TransportError:
        return False
    assert answer.status_code == 200, answer.text
    return True


def heard(folder: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in (folder / "heard.jsonl").read_text().splitlines()]


def until_heard(folder: Path) -> None:
    """Wait until a robot's side has heard something."""
    assert until(lambda: bool(heard(folder)))


def until(true: Callable[[], bool]) -> bool:
    """Whether it becomes true in time."""
    ends_s = time.monotonic() + 30
    while not (is_true := true()) and time.monotonic() < ends_s:
        time.sleep(0.01)
    return is_true


def acted_on(folder: Path) -> list[object]:
    """The messages that a robot acts on: its side drops ids that it has seen."""
    seen = SeenIds()
    return [said["message"] for said in heard(folder) if seen.is_new(str(said["id"]))]


def shown(client: httpx.Client) -> list[str]:
    entries = client.get("/api/chat?limit=500").json()["entries"]
    return [entry["message"] for entry in entries if entry["who"] == "operator"]


@pytest.mark.parametrize("moment", ["kept", "heard"])
def test_a_message_that_the_page_sends_again_after_a_kill_is_acted_on_once(
    tmp_path: Path, moment: str
) -> None:
    with server(tmp_path, moment) as (process, client):
        assert not post(client, "m1")
        process.wait(15)
    with server(tmp_path, "never") as (_, client):
        assert post(client, "m1")
        assert post(client, "m2")
        assert shown(client) == ["go to m1", "go to m2"]
    assert acted_on(tmp_path) == ["go to m1", "go to m2"]
    copies = [said for said in heard(tmp_path) if said["id"] == "m1"]
    assert all(said == copies[0] for said in copies), "what goes again is what went before"


@pytest.mark.parametrize("moment", ["kept", "heard"])
def test_a_message_that_was_kept_just_before_a_kill_goes_out_by_itself(tmp_path: Path, moment: str) -> None:
    with server(tmp_path, moment) as (process, client):
        assert not post(client, "m1")
        process.wait(15)
    for _ in range(2):  # and the next restart does not do it again
        with server(tmp_path, "never") as (_, client):
            assert shown(client) == ["go to m1"]
            until_heard(tmp_path)
    assert acted_on(tmp_path) == ["go to m1"]
    assert len(heard(tmp_path)) <= 2


def test_a_button_that_was_acknowledged_before_a_kill_works_after_it_or_is_told_of(tmp_path: Path) -> None:
    with server(tmp_path, "deaf") as (process, client):

        def press(name: str) -> bool:
            return client.post(f"/api/plans/{name}/command", json={"command": "resume"}).status_code == 200

        assert all(until(partial(press, name)) for name in ("Ada", "Bob"))
        process.kill()
        process.wait(15)
    with sqlite3.connect(tmp_path / "web.db") as kept:
        kept.execute("UPDATE press SET unix_ms = unix_ms - 60000 WHERE message LIKE '%Bob%'")
    with server(tmp_path, "never") as (_, client):
        entries = client.get("/api/chat").json()["entries"]
        assert [entry["targets"] for entry in entries if "interrupted" in entry["message"]] == [["Bob"]]
        until_heard(tmp_path)
        assert [said["targets"] for said in heard(tmp_path)] == [["Ada"]]
        assert until(lambda: not kept.execute("SELECT * FROM press").fetchall()), (
            "nor once more the next time"
        )
    kept.close()


def test_everything_that_was_acknowledged_before_a_kill_is_there(tmp_path: Path) -> None:
    rng, acknowledged = random.Random(5), list[str]()
    for attempt in range(3):
        with server(tmp_path, "never") as (process, client):
            assert set(shown(client)) >= {f"go to {key}" for key in acknowledged}
            keys = (f"m{attempt}-{number}" for number in itertools.count())
            acknowledged += [key for key in itertools.islice(keys, rng.randrange(5, 20)) if post(client, key)]
            killer = threading.Timer(rng.uniform(0.0, 0.05), process.kill)  # in the middle of what follows
            killer.start()
            acknowledged += itertools.takewhile(lambda key: post(client, key), keys)
            killer.join()
    assert len(acknowledged) >= 15
    with server(tmp_path, "never") as (_, client):
        # One more of each attempt may be there: kept, but killed before it was acknowledged.
        kept = {f"go to {key}" for key in acknowledged}
        assert [text for text in shown(client) if text in kept] == [f"go to {key}" for key in acknowledged]
        numbers = [entry["seq"] for entry in client.get("/api/chat?limit=500").json()["entries"]]
        assert numbers == sorted(set(numbers))
