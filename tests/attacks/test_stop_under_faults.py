"""The stop while something is wrong: of the real process, pressed on a page that is open, robot in motion.

`soak` runs each fault on its own, with a kill right behind the press; the others run in one process.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import pytest

from parley.language.llm.scripted_server import Say, ScriptedServer
from tests.attacks.driving import (
    System,
    databases_locked,
    disk_full,
    frozen,
    loop_blocked,
    running,
    sockets,
    strangers,
    uploads,
)

WITHIN_S = 1.0
"""From the press until the robot stands, as measured: this is what people are promised."""

Fault = Callable[[System], AbstractContextManager[None]]
FAULTS: dict[str, Fault] = {
    "databases locked": databases_locked,
    "disk full": disk_full,
    "1500 strangers": strangers,
    "20 uploads": uploads,
    "150 live streams of strangers": sockets,
}


def stands(system: System, fault: str) -> None:
    """Press, and print how long it took: what `make soak` is run for."""
    took_s = system.press()
    print(json.dumps({"stop": fault, "stands_after_s": round(took_s, 3)}))  # noqa: T201
    assert took_s < WITHIN_S, fault


def usable(system: System) -> None:
    """The page gets what it asks for, on a new connection too, and is never told that the server is busy."""
    assert system.http.get("/api/snapshot").status_code == 200
    answer = system.anew("GET", "/api/snapshot")
    assert answer.status_code == 200, answer.text


def stands_after_a_start(folder: Path) -> None:
    """Whoever was stopped when the process was killed is so again, and does not move."""
    with running(folder) as system:
        system.until(lambda: system.robot()["state"] == "stopped")
        assert system.robot()["at_rest"] is True


@pytest.mark.timeout(240)
def test_a_press_stops_the_robot_whatever_is_wrong(tmp_path: Path) -> None:
    with running(tmp_path) as system:
        for name, fault in FAULTS.items():
            system.drive()
            with fault(system):
                usable(system)
                stands(system, name)
        system.drive()
        with databases_locked(system), disk_full(system):
            assert system.say("stop!! you are on my foot") == 200
            system.until(lambda: system.robot()["at_rest"], WITHIN_S)
        with loop_blocked(system):
            stands(system, "loop blocked, then killed")
            system.kill()
    stands_after_a_start(tmp_path)


@pytest.mark.soak
@pytest.mark.timeout(240)
@pytest.mark.parametrize("name", [*FAULTS, "loop blocked"])
def test_what_was_stopped_stays_so_over_a_kill(tmp_path: Path, name: str) -> None:
    with running(tmp_path) as system:
        system.drive()
        with {**FAULTS, "loop blocked": loop_blocked}[name](system):
            stands(system, f"{name}, then killed")
            system.kill()
    stands_after_a_start(tmp_path)


@pytest.mark.soak
@pytest.mark.timeout(240)
def test_a_press_while_the_process_is_frozen_takes_effect_as_soon_as_it_runs_again(tmp_path: Path) -> None:
    with running(tmp_path) as system:
        system.drive()
        with frozen(system):
            system.line.send(json.dumps({"id": "frozen", "targets": []}))
            with pytest.raises(TimeoutError):
                while True:
                    assert system.line.recv(timeout=WITHIN_S) == "{}"  # of before; nothing answers now
        stands(system, "frozen before, then killed")
        system.kill()
    stands_after_a_start(tmp_path)


@pytest.mark.soak
@pytest.mark.timeout(240)
def test_after_a_kill_of_a_frozen_process_nothing_moves_by_itself(tmp_path: Path) -> None:
    with running(tmp_path) as system:
        system.drive()
        with frozen(system):
            system.kill()
    with running(tmp_path) as system:
        assert system.robot()["at_rest"] is True
        assert system.robot()["state"] in ("idle", "paused", "stopped")


@pytest.mark.soak
@pytest.mark.timeout(240)
def test_a_page_that_is_closed_right_behind_the_press_has_stopped_the_robot(tmp_path: Path) -> None:
    with running(tmp_path) as system:
        system.drive()
        system.line.send(json.dumps({"id": "last", "targets": []}))
        system.line.close()
        system.until(lambda: system.robot()["state"] == "stopped" and system.robot()["at_rest"], WITHIN_S)
        system.kill()
    stands_after_a_start(tmp_path)


@pytest.mark.soak
@pytest.mark.timeout(240)
async def test_a_press_and_a_word_stop_the_robot_while_the_model_hangs(tmp_path: Path) -> None:
    order = {
        "message_response": "I patrol.",
        "queue": [{"action": "Patrol", "parameters": {}, "reason": "told"}],
    }
    async with ScriptedServer() as server:
        server.will(Say(answer=order), *[Say(gate=asyncio.Event())] * 8)

        def play() -> None:
            with running(tmp_path, "--language", f"local:m@{server.url}") as system:
                system.drive()
                system.say("and how are you today, all in all?")
                stands(system, "model hangs, then killed")
                system.kill()
            stands_after_a_start(tmp_path)

        await asyncio.to_thread(play)
