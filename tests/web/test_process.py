"""The demonstration as a process: it serves, ends in order, and keeps what waits for a yes."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

from parley.cli.web import page_settings
from parley.config import SystemConfig
from parley.errors import ConfigError
from parley.web.app import openapi_text
from parley.web.config import WebConfig

ENDS_WITHIN_S = 15
STEPS = "Go to “dining table”"
ASKED = f"This is what I would do: {STEPS}. Shall I?"
"""How long a test waits for an end; how quick it is, is not a test's business."""


@contextmanager
def demo(data: Path, *options: str) -> Iterator[tuple[subprocess.Popen[str], httpx.Client]]:
    """A running demonstration with a client to it."""
    command = [sys.executable, "-m", "parley", "demo", "nursing-home", "--robots", "David", "--no-open"]
    process = subprocess.Popen(
        [*command, "--port", "0", "--data", str(data), *options],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert process.stdout is not None
        first = process.stdout.readline()
        assert "http" in first, process.stderr.read() if process.stderr else ""
        with httpx.Client(base_url=first.split()[-1], timeout=20) as client:
            yield process, client
    finally:
        process.kill()
        process.communicate(timeout=ENDS_WITHIN_S)


def post(client: httpx.Client, key: str, text: str) -> dict[str, Any]:
    body = {"id": key, "text": text, "targets": ["David"]}
    answer = client.post("/api/chat", json=body)
    assert answer.status_code == 200, answer.text
    return dict(answer.json())


def until(client: httpx.Client, key: str) -> list[dict[str, Any]]:
    """The conversation, once the message `key` was replied to."""
    ends_s = time.monotonic() + 30
    while time.monotonic() < ends_s:
        entries: list[dict[str, Any]] = client.get("/api/chat").json()["entries"]
        if any(entry["reply_to"] == key for entry in entries):
            return entries
        time.sleep(0.05)
    raise AssertionError("no reply")


def test_the_demo_serves_a_page_and_the_robot_drives(tmp_path: Path) -> None:
    with demo(tmp_path) as (process, client):
        assert client.get("/").status_code == 200
        ends_s = time.monotonic() + 30
        while not (snapshot := client.get("/api/snapshot").json())["robots"]:
            assert time.monotonic() < ends_s
            time.sleep(0.1)
        assert [robot["name"] for robot in snapshot["robots"]] == ["David"]
        assert len(snapshot["info"]["examples"]) == 3
        before = snapshot["robots"][0]["pose"]
        post(client, "m1", "go to the dining table")
        until(client, "m1")
        ends_s = time.monotonic() + 30
        while client.get("/api/robots/David").json()["pose"] == before:
            assert time.monotonic() < ends_s
            time.sleep(0.1)
        assert client.get("/api/feeds/David/camera.jpg").content.startswith(b"\xff\xd8")
        process.send_signal(signal.SIGINT)
        process.wait(ENDS_WITHIN_S)
        assert process.stdout is not None and process.stderr is not None
        # Not `communicate`: it would miss what `readline` had already taken from the pipe.
        assert "start it with --lan" in process.stdout.read()
        errors = process.stderr.read()
        assert process.returncode == 130
        assert "Traceback" not in errors


def snapshot_with(client: httpx.Client, what: str) -> dict[str, Any]:
    """The state of things, once there is some of `what`."""
    ends_s = time.monotonic() + 30
    while not (snapshot := dict(client.get("/api/snapshot").json()))[what]:
        assert time.monotonic() < ends_s
        time.sleep(0.05)
    return snapshot


@pytest.mark.timeout(200)
def test_a_plan_that_waits_for_a_yes_is_on_the_page_again_after_kill_9(tmp_path: Path) -> None:
    options = ("--ask-first", "--speed", "20")
    with demo(tmp_path, *options) as (process, client):
        snapshot_with(client, "robots")
        post(client, "m1", "go to the dining table")
        entries = until(client, "m1")
        assert entries[-1]["message"] == ASKED
        (before,) = snapshot_with(client, "proposals")["proposals"]
        post(client, "m2", "what can you do?")  # what the robot says later is kept later
        until(client, "m2")
        process.kill()
    with demo(tmp_path, *options) as (_, client):
        snapshot_with(client, "robots")
        (again,) = snapshot_with(client, "proposals")["proposals"]
        assert again == before
        decision = {"id": again["id"], "decision": "approve", "digest": again["digest"]}
        assert client.post("/api/plans/David/decision", json=decision).status_code == 200
        ends_s = time.monotonic() + 60
        while not any("I have finished" in said["message"] for said in entries):
            assert time.monotonic() < ends_s
            entries = client.get("/api/chat").json()["entries"]
            time.sleep(0.1)
        said = [entry["message"] for entry in entries]
        assert any("started anew" in message for message in said)
        assert said.index(f"All right: {STEPS}.") > said.index(ASKED)
        assert client.get("/api/snapshot").json()["proposals"] == []


@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGINT])
def test_it_ends_in_order_while_pages_are_open(tmp_path: Path, sent: signal.Signals) -> None:
    with demo(tmp_path) as (process, client):
        with client.stream("GET", "/socket.io/?EIO=4&transport=polling") as answer:
            answer.read()
            process.send_signal(sent)
            _, errors = process.communicate(timeout=ENDS_WITHIN_S)
        assert process.returncode == 128 + sent
        assert errors == ""


def test_a_password_file_that_is_missing_or_too_short_is_named(tmp_path: Path) -> None:
    short = tmp_path / "short"
    short.write_text("abc")
    for file, word in ((tmp_path / "none", "cannot be read"), (short, "shorter")):
        with pytest.raises(ConfigError, match=word):
            page_settings(
                port=None,
                lan=True,
                password_file=file,
                pair_as="operator",
                certificate=None,
                key=None,
                origins=(),
                without="",
            )


@pytest.mark.parametrize(
    ("language", "label", "works_alone"),
    [
        ("builtin", "built in, works without a model", True),
        ("ollama:small-one:8b@http://192.0.2.7:11434", "small-one:8b (ollama)", False),
    ],
)
def test_people_are_told_which_language_engine_there_is(language: str, label: str, works_alone: bool) -> None:
    page = WebConfig.of(SystemConfig(language=language))
    assert (page.language, page.offline_language) == (label, works_alone)


def test_the_interface_is_described_always_the_same() -> None:
    command = [sys.executable, "-m", "parley", "web", "openapi"]
    one = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert one == openapi_text()
    assert all(
        f'"{name}"' in one for name in ("Snapshot", "ChatChange", "FrameMeta", "ProblemDetail", "MapView")
    )
