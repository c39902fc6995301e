"""kill -9 while people say, agree, remember and stop: what was acknowledged holds, nothing begins by itself.

The real process, over HTTP; each life begins with what the one before left in the folder.
"""

from __future__ import annotations

import itertools
import random
import subprocess
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import httpx
import pytest

from tests.web.test_process import demo

ROBOT: Final = "David"
OPTIONS: Final = ("--ask-first", "--speed", "20")
PATIENCE_S: Final = 30.0
IN_THE_GATE: Final = 1
IN_ALL: Final = 20


@dataclass
class Promised:
    """What people were told that has happened."""

    texts: list[str] = field(default_factory=list)
    """Messages that were taken."""
    memories: list[str] = field(default_factory=list)
    """What is to be remembered."""
    latched: bool | None = False
    """Whether the robot is stopped for safety; None: a command was under way."""
    numbers: itertools.count[int] = field(default_factory=itertools.count)


class People:
    """Operators of one life of the process, over HTTP."""

    def __init__(self, client: httpx.Client, promised: Promised) -> None:
        self._client, self._promised = client, promised

    def says(self, text: str) -> str:
        """Say something; the id once it is acknowledged."""
        key = f"k{next(self._promised.numbers)}"
        body = {"id": key, "text": text, "targets": [ROBOT]}
        self._client.post("/api/chat", json=body).raise_for_status()
        self._promised.texts.append(text)
        return key

    def reply(self, key: str) -> str:
        """What the robot answers."""

        def found() -> str:
            entries = self._client.get("/api/chat?limit=500").raise_for_status().json()["entries"]
            return next((entry["message"] for entry in entries if entry["reply_to"] == key), "")

        return str(until(found))

    def tells(self) -> None:
        """Tell something and wait until it is remembered."""
        number = next(self._promised.numbers)
        text = f"The key number {number} is in the bedroom"
        if "remember" in self.reply(self.says(text + ".")):
            self._promised.memories.append(text)

    def orders(self) -> None:
        """Order something, which waits for a yes."""
        self.reply(self.says("go to the dining table"))

    def agrees(self) -> None:
        """Say yes to what waits, if anything does."""
        self.says("yes")

    def stops(self) -> None:
        """Press the emergency stop."""
        self._promised.latched = None
        self._client.post("/api/stop", json={"command": "stop", "targets": [ROBOT]}).raise_for_status()
        until(lambda: self.robot()["state"] == "stopped")
        self._promised.latched = True

    def releases(self) -> None:
        """Release it."""
        self._promised.latched = None
        self._client.post("/api/stop", json={"command": "reset", "targets": [ROBOT]}).raise_for_status()
        until(lambda: self.robot()["state"] != "stopped")
        self._promised.latched = False

    def robot(self) -> dict[str, Any]:
        """How the robot is."""
        return dict(self._client.get(f"/api/robots/{ROBOT}").raise_for_status().json())

    def plan(self) -> str:
        """The state of its newest plan."""
        plans = self._client.get(f"/api/plans/{ROBOT}").raise_for_status().json()
        return str(plans[-1]["state"]) if plans else ""

    def heard(self) -> set[str]:
        """All that was ever said to the robot, page by page."""
        found: set[str] = set()
        page: dict[str, Any] = {"entries": [{"seq": 2**53}], "complete": False}
        while not page["complete"]:
            query = {"limit": 500, "before": page["entries"][0]["seq"]}
            page = self._client.get("/api/chat", params=query).raise_for_status().json()
            found |= {entry["message"] for entry in page["entries"] if entry["who"] == "operator"}
        return found

    def checks(self) -> None:
        """Nothing that was acknowledged is lost, and nothing goes on that nobody told to go on."""
        until(lambda: any(r["name"] == ROBOT for r in self._client.get("/api/robots").json()))
        heard = self.heard()
        assert [text for text in self._promised.texts if text not in heard] == []
        kept = self._client.get("/api/memory").raise_for_status().text
        assert [text for text in self._promised.memories if text not in kept] == []
        if self._promised.latched is not None:
            stopped = until(lambda: self.robot()["state"]) == "stopped"
            assert stopped is self._promised.latched
        before = self.robot()["pose"]
        self.reply(self.says("what can you do?"))  # as much time passes as it takes to understand something
        time.sleep(0.2)  # four seconds of the robot's time
        assert self.robot()["pose"] == before
        assert self.plan() != "running"


def until(found: Callable[[], Any]) -> Any:
    """Ask until there is an answer."""
    ends_s = time.monotonic() + PATIENCE_S
    while not (answer := found()):
        assert time.monotonic() < ends_s
        time.sleep(0.01)
    return answer


def live(people: People, process: subprocess.Popen[str], rng: random.Random) -> None:
    """Do what people do until the process is killed."""
    deeds = [people.tells, people.tells, people.orders, people.agrees, people.stops, people.releases]
    people.orders()
    killer = threading.Timer(rng.uniform(0.05, 1.5), process.kill)
    killer.start()
    try:
        while True:
            rng.choice(deeds)()
    except httpx.TransportError:
        pass  # killed
    finally:
        killer.join()
        process.wait(15)


def lives(folder: Path, count: int, seed: int) -> Promised:
    """As many lives as there are kills, and one more."""
    promised, rng = Promised(), random.Random(seed)
    for life in range(count + 1):
        with demo(folder, *OPTIONS) as (process, client):
            people = People(client, promised)
            people.checks()
            if life < count:
                live(people, process, rng)
    return promised


@pytest.mark.timeout(180)
def test_a_few_kills_lose_nothing_and_set_nothing_going(tmp_path: Path) -> None:
    promised = lives(tmp_path, IN_THE_GATE, seed=12)
    assert promised.texts


@pytest.mark.soak
@pytest.mark.timeout(900)
def test_twenty_kills_lose_nothing_and_set_nothing_going(tmp_path: Path) -> None:
    promised = lives(tmp_path, IN_ALL, seed=21)
    assert len(promised.memories) >= IN_ALL / 2
