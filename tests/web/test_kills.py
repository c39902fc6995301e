"""The server is killed between keeping, sending and noting that: nothing is lost, nothing is said twice."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from parley.nodes.questions import SeenIds


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
    assert acted_on(tmp_path) == ["go to m1"]
    assert len(heard(tmp_path)) <= 2
